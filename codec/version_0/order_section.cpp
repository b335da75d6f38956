// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/version_0/order_section.h"

#include <bit>
#include <optional>
#include <vector>

#include "base/assert.h"
#include "codec/mode_bitmap/bit_coder.h"

namespace watertight::codec {
namespace {

/// The elements 0 .. size-1 that are left, with rank and selection (a Fenwick tree). O(log size).
class Remaining {
 public:
  explicit Remaining(Index size) : tree_(size + 1, 0), left_(size) {
    for (std::size_t i = 1; i < tree_.size(); ++i) tree_[i] = static_cast<Index>(i & (~i + 1));
  }
  Index left() const { return left_; }

  /// How many smaller elements are left.
  Index rank(Index element) const {
    Index sum = 0;
    for (std::size_t i = element; i > 0; i &= i - 1) sum += tree_[i];
    return sum;
  }

  /// The element with that many smaller ones left. Requires rank < left().
  Index select(Index rank) const {
    std::size_t position = 0;
    for (std::size_t step = std::bit_floor(tree_.size() - 1); step > 0; step /= 2) {
      if (position + step < tree_.size() && tree_[position + step] <= rank) {
        position += step;
        rank -= tree_[position];
      }
    }
    return static_cast<Index>(position);
  }

  void remove(Index element) {
    for (std::size_t i = std::size_t{element} + 1; i < tree_.size(); i += i & (~i + 1)) --tree_[i];
    --left_;
  }

 private:
  std::vector<Index> tree_;
  Index left_;
};

/// Models of one kind of permutation: does the next element follow the last one, given whether the
/// last one did?
struct PermutationModel {
  bitmap::AdaptiveBit jumps[2];
};

/// One pass over the order section, writing or reading: both must take the same steps.
class Coder {
 public:
  explicit Coder(bitmap::BitEncoder& encoder) : encoder_(&encoder) {}
  explicit Coder(bitmap::BitDecoder& decoder) : decoder_(&decoder) {}

  bool failed() const { return decoder_ != nullptr && decoder_->failed(); }

  /// Codes `sequence`, a permutation of 0 .. size-1, element by element: "the one that follows the
  /// last among those left", or which of the others.
  void permutation(std::vector<Index>& sequence, PermutationModel& model) {
    Remaining remaining(static_cast<Index>(sequence.size()));
    Index expected = 0;
    bool jumped = false;
    for (Index& element : sequence) {
      const Index left = remaining.left();
      Index distance = 0;
      if (encoder_ != nullptr) distance = (remaining.rank(element) + left - expected) % left;
      if (left > 1) {
        jumped = flag(distance != 0, model.jumps[jumped ? 1 : 0]);
        distance = jumped ? uniform(distance - 1, left - 1) + 1 : 0;
      }
      const Index rank = (expected + distance) % left;
      if (decoder_ != nullptr) element = remaining.select(rank);
      remaining.remove(element);
      expected = left > 1 ? rank % (left - 1) : 0;
      if (failed()) return;
    }
  }

  bool flag(bool value, bitmap::AdaptiveBit& model) {
    if (decoder_ != nullptr) return decoder_->bit(model);
    encoder_->bit(value, model);
    return value;
  }

  Index uniform(Index value, Index size) {
    if (decoder_ != nullptr) return static_cast<Index>(decoder_->uniform(size));
    encoder_->uniform(value, size);
    return value;
  }

 private:
  bitmap::BitEncoder* encoder_ = nullptr;
  bitmap::BitDecoder* decoder_ = nullptr;
};

std::vector<Index> inverse_of(const std::vector<Index>& order) {
  std::vector<Index> inverse(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) inverse[order[i]] = static_cast<Index>(i);
  return inverse;
}

/// Codes the arrangement of the members [begin, end) of one shell or facet of the canonical solid.
/// The first `fixed` members stay first. `source` gets or gives their places in the source, which
/// start at `source_begin`.
void code_members(Coder& coder, std::vector<Index>& source, IndexRange members, Index source_begin,
                  Index fixed, PermutationModel& model) {
  const Index size = members.size() > fixed ? members.size() - fixed : 0;
  std::vector<Index> sequence(size, 0);  // source place -> canonical member
  for (Index i = 0; i < members.size(); ++i) {
    const Index place = source[members.begin + i] - source_begin;
    if (i >= fixed && source[members.begin + i] != kNone) sequence[place - fixed] = i - fixed;
  }
  coder.permutation(sequence, model);
  if (coder.failed()) return;
  for (Index i = 0; i < fixed && i < members.size(); ++i)
    source[members.begin + i] = source_begin + i;
  for (Index place = 0; place < size; ++place) {
    source[members.begin + fixed + sequence[place]] = source_begin + fixed + place;
  }
}

void code_shells_and_facets(Coder& coder, const Solid& solid, geometry::SourceOrder& order) {
  PermutationModel shell_model;
  PermutationModel facet_model;
  PermutationModel ring_model;
  code_members(coder, order.shell, {0, solid.shell_count()}, 0, 1, shell_model);
  if (coder.failed()) return;
  Index source_facet = 0;
  for (const Index shell : inverse_of(order.shell)) {
    const IndexRange facets = solid.facets_of(shell);
    code_members(coder, order.facet, facets, source_facet, 0, facet_model);
    if (coder.failed()) return;
    source_facet += facets.size();
  }
  Index source_ring = 0;
  for (const Index facet : inverse_of(order.facet)) {
    const IndexRange rings = solid.rings_of(facet);
    code_members(coder, order.ring, rings, source_ring, 1, ring_model);
    if (coder.failed()) return;
    source_ring += rings.size();
  }
}

void code_ring_starts(Coder& coder, const Solid& solid, geometry::SourceOrder& order) {
  bitmap::AdaptiveBit is_moved;
  for (const Index ring : inverse_of(order.ring)) {
    const auto size = static_cast<Index>(solid.ring(ring).size());
    Index& start = order.ring_start[ring];
    const bool moved = coder.flag(start != 0, is_moved);
    start = moved ? coder.uniform(start - 1, size - 1) + 1 : 0;
    if (coder.failed()) return;
  }
}

/// Canonical vertices in the order in which the source's rings first use them; then unused ones.
std::vector<Index> first_use(const Solid& solid, const geometry::SourceOrder& order) {
  std::vector<Index> sequence;
  sequence.reserve(solid.vertex_count());
  std::vector<bool> is_seen(solid.vertex_count(), false);
  const auto see = [&](Index vertex) {
    if (!is_seen[vertex]) sequence.push_back(vertex);
    is_seen[vertex] = true;
  };
  for (const Index ring : inverse_of(order.ring)) {
    const auto vertices = solid.ring(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      see(vertices[(order.ring_start[ring] + i) % vertices.size()]);
    }
  }
  for (Index vertex = 0; vertex < solid.vertex_count(); ++vertex) see(vertex);
  return sequence;
}

void code_vertices(Coder& coder, const Solid& solid, geometry::SourceOrder& order) {
  const std::vector<Index> predicted = first_use(solid, order);
  const std::vector<Index> place = inverse_of(predicted);
  std::vector<Index> sequence(order.vertex.size(), 0);  // source vertex -> place in `predicted`
  for (Index vertex = 0; vertex < order.vertex.size(); ++vertex) {
    if (order.vertex[vertex] != kNone) sequence[order.vertex[vertex]] = place[vertex];
  }
  PermutationModel model;
  coder.permutation(sequence, model);
  if (coder.failed()) return;
  for (Index source = 0; source < sequence.size(); ++source) {
    order.vertex[predicted[sequence[source]]] = source;
  }
}

void code_order(Coder& coder, const Solid& solid, geometry::SourceOrder& order) {
  code_shells_and_facets(coder, solid, order);
  if (!coder.failed()) code_ring_starts(coder, solid, order);
  if (!coder.failed()) code_vertices(coder, solid, order);
}

}  // namespace

Bytes write_order(const Solid& canonical, const geometry::SourceOrder& order) {
  bitmap::BitEncoder encoder(bitmap::BitCoding::arithmetic);
  Coder coder(encoder);
  geometry::SourceOrder copy = order;
  code_order(coder, canonical, copy);
  WATERTIGHT_ASSERT(copy == order);
  return std::move(encoder).finish();
}

Result<geometry::SourceOrder> read_order(ByteView section, const Solid& canonical) {
  bitmap::BitDecoder decoder(section, bitmap::BitCoding::arithmetic);
  Coder coder(decoder);
  geometry::SourceOrder order;
  order.vertex.assign(canonical.vertex_count(), kNone);
  order.shell.assign(canonical.shell_count(), kNone);
  order.facet.assign(canonical.facet_count(), kNone);
  order.ring.assign(canonical.ring_count(), kNone);
  order.ring_start.assign(canonical.ring_count(), 0);
  code_order(coder, canonical, order);
  if (!decoder.is_finished()) {
    return Error{ErrorCode::malformed, "truncated or malformed order section"};
  }
  return order;
}

}  // namespace watertight::codec
