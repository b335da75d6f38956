// SPDX-License-Identifier: GPL-3.0-or-later
//
// The part of SurfaceWalk that codes the vertices of a ring and updates the chains at them.
#include <algorithm>

#include "codec/mode_polygon/facet_walk.h"
#include "codec/mode_polygon/families.h"

namespace watertight::codec::polygon {

/// Codes the vertices of a ring from its end to its start.
void SurfaceWalk::fill() {
  const Index start = backward_.empty() ? (forward_.empty() ? end_ : forward_.front().vertex)
                                        : backward_.back().vertex;
  auto count = static_cast<Index>(backward_.size() + forward_.size() + 1);
  while (!is_closed_ && !stopped()) {
    const Index own = end_twin_ == kNone ? kNone : chain_with_out(end_, end_twin_);
    const Index followed = chosen_chain(end_, own);
    if (stopped()) return;
    Step step{end_, kNone, end_truth_};
    Index to = kNone;
    if (followed != kNone) {
      step.twin = chains_[followed].in;
      to = result_.surface.vertex[step.twin];
      if ((to == start) != (count == size_)) {
        return fail(ErrorCode::malformed, "a ring ends before or after its coded size");
      }
    } else if (count == size_) {
      to = start;
    }
    end_truth_ = end_truth_ == kNone ? kNone : truth_next(end_truth_);
    if (to == kNone) {
      to = coded_target(size_ - count);
      if (stopped()) return;
    }
    forward_.push_back(step);
    end_ = to;
    end_twin_ = step.twin;
    if (to == start) {
      is_closed_ = true;
      return;
    }
    if (seen_in_ring_[to] == ring_number_ || remaining_[to] == 0) {
      return fail(ErrorCode::malformed, "a ring meets itself");
    }
    seen_in_ring_[to] = ring_number_;
    ++count;
  }
}

/// Codes the chain along whose known edge the ring goes on, or kNone if the ring goes on along a
/// new edge. `own` is the chain along which the ring came to the vertex, or kNone.
Index SurfaceWalk::chosen_chain(Index vertex, Index own) {
  const Index chains = chain_count_[vertex];
  const Index others = own == kNone ? chains : chains - 1;
  const Index remaining = remaining_[vertex];
  const bool is_start = forward_.empty();
  // A new edge leaves as many chains as there are, or one more; each chain needs a facet to come.
  const bool can_be_new = is_start || remaining > (own == kNone ? chains + 1 : chains);
  if (others == 0) {
    if (!can_be_new && own != kNone && remaining == 1) return own;
    return kNone;
  }
  Index truth_chain = kNone;
  if (truth_ != nullptr) {
    for (Index chain = first_chain_[vertex]; chain != kNone; chain = chains_[chain].next) {
      if (truth_->surface.twin[half_truth_[chains_[chain].in]] == end_truth_) truth_chain = chain;
    }
  }
  if (can_be_new &&
      !models_.code<kFollow>(stream_, {capped<8>(size_), capped<4>(remaining - chains)},
                             truth_chain != kNone)) {
    return kNone;
  }
  std::array<Index, kChainLimit> options{};
  std::size_t count = 0;
  std::size_t chosen = 0;
  for (Index chain = first_chain_[vertex]; chain != kNone && count < kChainLimit;
       chain = chains_[chain].next) {
    if (chain == own) continue;
    if (chain == truth_chain) chosen = count;
    options[count++] = chain;
  }
  return options[count == 1 ? 0 : stream_.code_uniform(chosen, count)];
}

/// Codes the next vertex of the ring: the one at the end of a new edge.
Index SurfaceWalk::coded_target(Index slots) {
  PolygonSurface& surface = result_.surface;
  Index truth_target = kNone;
  if (truth_ != nullptr) truth_target = known_as_[truth_vertex(end_truth_)];
  if (surface.vertex_count() == 0) return new_vertex();
  list_loop();
  const auto loop = combine(capped<6>(loop_.size()), Context<2>(loop_reaches_start_));
  const auto left = capped<6>(slots - 1);
  if (models_.code<kNew>(
          stream_,
          {combine(loop, left, level()), combine(capped<12>(size_ - 3), left, level()),
           combine(capped<3>(backward_.size()), capped<3>(forward_.size()), loop)},
          truth_ != nullptr && truth_target == kNone)) {
    return new_vertex();
  }
  const auto found = std::find(loop_.begin(), loop_.end(), truth_target);
  const auto steps = static_cast<std::size_t>(found - loop_.begin());
  const bool on_loop = truth_ != nullptr && steps < loop_.size();
  if (!loop_.empty() && models_.code<kOnLoop>(stream_, {loop}, on_loop)) {
    const std::uint64_t coded =
        models_.code_number<kLoopSteps>(stream_, {left, loop}, truth_ ? steps : 0, kLoopBits);
    if (coded >= loop_.size()) {
      fail(ErrorCode::malformed, "a ring goes beyond the front");
      return kNone;
    }
    return loop_[coded];
  }
  return static_cast<Index>(
      stream_.code_uniform(truth_ ? truth_target : 0, surface.vertex_count()));
}

Index SurfaceWalk::new_vertex() {
  PolygonSurface& surface = result_.surface;
  const Index vertex = surface.vertex_count();
  if (vertex >= limits_.vertices) {
    fail(ErrorCode::limit_exceeded, "a solid has more vertices than allowed");
    return kNone;
  }
  const Index truth_fan = truth_ ? truth_vertex(end_truth_) : kNone;
  const Index truth_degree = truth_ ? truth_->surface.degree[truth_fan] : 0;
  Index degree = 2;
  for (; degree < kUnaryLimit; ++degree) {
    const auto step = capped<8>(degree - 2);
    if (models_.code<kDegree>(stream_,
                              {combine(step, level()), combine(step, capped<8>(size_), level()),
                               combine(step, capped<6>(last_degree_ - 2), level())},
                              degree == truth_degree)) {
      break;
    }
    if (stopped()) return kNone;
  }
  if (degree == kUnaryLimit) {
    const std::uint64_t rest = models_.code_number<kLong>(
        stream_, {kLongDegree}, truth_ ? truth_degree - kUnaryLimit : 0, kCountBits);
    degree += static_cast<Index>(rest);
  }
  last_degree_ = degree;
  surface.degree.push_back(degree);
  surface.out_half.push_back(kNone);
  remaining_.push_back(degree);
  chain_count_.push_back(0);
  first_chain_.push_back(kNone);
  seen_in_ring_.push_back(kNone);
  if (truth_ != nullptr) {
    known_as_[truth_fan] = vertex;
    result_.truth_vertex.push_back(truth_fan);
  }
  return vertex;
}

void SurfaceWalk::append_ring() {
  PolygonSurface& surface = result_.surface;
  const auto first = static_cast<Index>(surface.vertex.size());
  const auto size = static_cast<Index>(backward_.size() + forward_.size());
  if (size > 0x7FFFFFFFU - first) return fail(ErrorCode::limit_exceeded, "too many edges");
  const auto append = [&](const Step& step) {
    const auto half = static_cast<Index>(surface.vertex.size());
    surface.vertex.push_back(step.vertex);
    surface.twin.push_back(step.twin);
    surface.ring_of.push_back(ring_number_);
    half_truth_.push_back(step.truth);
    if (step.twin != kNone) {
      if (surface.twin[step.twin] != kNone) fail(ErrorCode::malformed, "an edge is used twice");
      surface.twin[step.twin] = half;
    }
    if (surface.out_half[step.vertex] == kNone) surface.out_half[step.vertex] = half;
  };
  for (std::size_t i = backward_.size(); i-- > 0;) append(backward_[i]);
  for (const Step& step : forward_) append(step);
  surface.ring_offsets.push_back(first + size);
  surface.facet_of.push_back(surface.facet_count());
  for (Index i = 0; i < size && !stopped(); ++i) {
    turn_corner(first + (i == 0 ? size - 1 : i - 1), first + i);
  }
}

/// Joins a corner of a ring to the chains at its vertex.
void SurfaceWalk::turn_corner(Index in, Index out) {
  const PolygonSurface& surface = result_.surface;
  const Index vertex = surface.vertex[out];
  const Index in_twin = surface.twin[in];
  const Index out_twin = surface.twin[out];
  const Index before = in_twin == kNone ? kNone : chain_with_out(vertex, in_twin);
  const Index after = out_twin == kNone ? kNone : chain_with_in(vertex, out_twin);
  if ((in_twin != kNone && before == kNone) || (out_twin != kNone && after == kNone)) {
    return fail(ErrorCode::malformed, "an edge is used twice");
  }
  if (before != kNone && after != kNone) {
    if (before != after) chains_[before].out = chains_[after].out;
    remove_chain(vertex, after);
  } else if (before != kNone) {
    chains_[before].out = out;
  } else if (after != kNone) {
    chains_[after].in = in;
  } else {
    if (++chain_count_[vertex] > kChainLimit) {
      return fail(ErrorCode::not_encodable, "too many facets meet in a vertex");
    }
    Index chain = static_cast<Index>(chains_.size());
    if (free_chains_.empty()) {
      chains_.emplace_back();
    } else {
      chain = free_chains_.back();
      free_chains_.pop_back();
    }
    chains_[chain] = {in, out, first_chain_[vertex]};
    first_chain_[vertex] = chain;
  }
  if (remaining_[vertex] == 0) return fail(ErrorCode::malformed, "a vertex has too many facets");
  --remaining_[vertex];
  const Index chains = chain_count_[vertex];
  if (remaining_[vertex] < chains || (chains == 0 && remaining_[vertex] > 0)) {
    fail(ErrorCode::malformed, "a vertex has too few facets");
  }
}

Index SurfaceWalk::chain_with_in(Index vertex, Index half) const {
  Index chain = first_chain_[vertex];
  while (chain != kNone && chains_[chain].in != half) chain = chains_[chain].next;
  return chain;
}

Index SurfaceWalk::chain_with_out(Index vertex, Index half) const {
  Index chain = first_chain_[vertex];
  while (chain != kNone && chains_[chain].out != half) chain = chains_[chain].next;
  return chain;
}

void SurfaceWalk::remove_chain(Index vertex, Index chain) {
  Index* link = &first_chain_[vertex];
  while (*link != chain) link = &chains_[*link].next;
  *link = chains_[chain].next;
  free_chains_.push_back(chain);
  --chain_count_[vertex];
}

}  // namespace watertight::codec::polygon
