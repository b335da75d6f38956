// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/page/source_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "geometry/mesh/edge_sides.h"

namespace watertight::codec {

// The families of the source order, with the names, the order and the sizes of docs/format.md,
// "Order".
enum OrderFamily : std::uint32_t { kStraight, kCandidate, kScan, kStart };

constexpr FamilyShape kOrderFamilies[] = {
    {kStraight, 1, {8}},
    {kCandidate, 6, {216, 150, 576}},
    {kScan, 1, {50, 80, 64}},
    {kStart, 5, {720, 120, 135, 648, 256, 144}},
};

constexpr const FamilyShape& shape_of(OrderFamily family) { return kOrderFamilies[family]; }

namespace {

/// The rule by which a candidate for the next facet was found.
enum Habit : std::uint32_t { kNextEdge, kLastEdge, kNeighbour, kSuccessor, kFirstLeft, kNoHabit };
constexpr Index kMostScanned = 64;
constexpr Index kMostNeighbours = 12;

// The contexts of family Straight: the things that are arranged.
constexpr Context<8> kShells{0U};
constexpr Context<8> kRings{1U};
constexpr Context<8> kVertices{2U};
using HabitContext = Context<6>;
using Facing = Context<5>;    // of a facet: up, down, upright, slanting up, slanting down
using Relation = Context<9>;  // the result of relation() for a corner

std::vector<Index> inverse_of(const std::vector<Index>& order) {
  std::vector<Index> inverse(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) inverse[order[i]] = static_cast<Index>(i);
  return inverse;
}

/// A set of consecutive indices that only loses elements. Finds the next element left in O(log n)
/// amortized.
class Left {
 public:
  Left(Index begin, Index end)
      : begin_(begin), next_(end - begin + 1), is_left_(end - begin, true) {
    std::iota(next_.begin(), next_.end(), Index{0});
    left_ = end - begin;
  }
  Index count() const { return left_; }
  bool has(Index element) const {
    return element >= begin_ && element - begin_ < is_left_.size() && is_left_[element - begin_];
  }
  void remove(Index element) {
    is_left_[element - begin_] = false;
    next_[element - begin_] = element - begin_ + 1;
    --left_;
  }
  /// The first element that is left, from `element` on; the end if there is none.
  Index from(Index element) {
    Index root = element - begin_;
    while (next_[root] != root) root = next_[root];
    for (Index at = element - begin_; next_[at] != at;) {
      const Index after = next_[at];
      next_[at] = root;
      at = after;
    }
    return begin_ + root;
  }

 private:
  Index begin_;
  std::vector<Index> next_;
  std::vector<bool> is_left_;
  Index left_ = 0;
};

/// 0, 1 or 2: `to` is less than, equal to or greater than `from`.
Context<3> sign_of(double from, double to) {
  return Context<3>(to < from ? 0U : to > from ? 2U : 1U);
}

class OrderCoder {
 public:
  OrderCoder(EntropyStream& stream, ModelBank& bank, const Solid& solid,
             geometry::SourceOrder& order)
      : stream_(stream), bank_(bank), solid_(solid), order_(order) {}

  void run() {
    stream_.enter(StreamPart::order);
    prepare();
    const std::vector<Index> shells = shells_in_source_order();
    Index facet = 0;
    Index ring = 0;
    for (const Index shell : shells) code_facets(shell, facet, ring);
    code_vertices();
  }

 private:
  void prepare() {
    if (stream_.is_reading()) {
      order_.vertex.resize(solid_.vertex_count());
      order_.shell.resize(solid_.shell_count());
      order_.facet.resize(solid_.facet_count());
      order_.ring.resize(solid_.ring_count());
      for (auto* list : {&order_.vertex, &order_.shell, &order_.facet, &order_.ring}) {
        std::iota(list->begin(), list->end(), Index{0});
      }
      order_.ring_start.assign(solid_.ring_count(), 0);
    }
    source_facet_ = inverse_of(order_.facet);
    source_ring_ = inverse_of(order_.ring);
    is_seen_.assign(solid_.vertex_count(), false);
    number_.assign(solid_.vertex_count(), kNone);
    link_corners();
    measure_facets();
  }

  /// Finds for each corner the facet on the other side of the edge from this corner to the next.
  void link_corners() {
    facet_of_ring_.resize(solid_.ring_count());
    std::vector<Index> facet_of_corner;
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      const IndexRange rings = solid_.rings_of(facet);
      for (Index ring = rings.begin; ring < rings.end; ++ring) {
        facet_of_ring_[ring] = facet;
        facet_of_corner.insert(facet_of_corner.end(), solid_.ring(ring).size(), facet);
      }
    }
    across_.assign(facet_of_corner.size(), kNone);
    const auto sides = geometry::sides_of_rings(
        solid_.arrays().ring_vertices, solid_.arrays().ring_offsets, 0, solid_.ring_count());
    geometry::for_each_edge(
        std::span<const geometry::EdgeSide>(sides), [&](std::span<const geometry::EdgeSide> edge) {
          const std::size_t upward = geometry::upward_count(edge);
          if (upward == 0 || upward == edge.size()) return;
          for (const geometry::EdgeSide& side : edge) {
            const geometry::EdgeSide& twin = side.is_downward ? edge.front() : edge[upward];
            across_[side.half_edge] = facet_of_corner[twin.half_edge];
          }
        });
  }

  /// Finds the facing and the size of each facet by Newell's sums over its exterior ring. The size
  /// is twice the sum of the areas of the ring projected along x, y and z.
  void measure_facets() {
    facing_.resize(solid_.facet_count());
    size_.resize(solid_.facet_count());
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      const auto ring = solid_.ring(solid_.rings_of(facet).begin);
      std::array<double, 3> normal{};
      const Point origin = solid_.vertices()[ring[0]];
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point& p = solid_.vertices()[ring[i]];
        const Point& q = solid_.vertices()[ring[(i + 1) % ring.size()]];
        for (int axis = 0; axis < 3; ++axis) {
          const int u = (axis + 1) % 3;
          const int v = (axis + 2) % 3;
          const double one = (p[u] - origin[u]) * (q[v] - origin[v]);
          const double other = (p[v] - origin[v]) * (q[u] - origin[u]);
          normal[static_cast<std::size_t>(axis)] += one - other;
        }
      }
      const double flat = std::fabs(normal[0]) + std::fabs(normal[1]);
      const double upright = std::fabs(normal[2]);
      std::uint32_t& facing = facing_[facet];
      facing = normal[2] > 0 ? 3 : 4;
      if (upright * 16 <= flat) facing = 2;
      if (flat * 16 <= upright) facing = normal[2] > 0 ? 0 : 1;
      size_[facet] = flat + upright;
    }
  }

  std::vector<Index> shells_in_source_order() {
    std::vector<Index> source = inverse_of(order_.shell);
    code_arrangement(source, 1, kShells);
    if (stream_.is_reading()) order_.shell = inverse_of(source);
    return source;
  }

  /// Codes a permutation of 0 .. size-1 whose first `fixed` elements stay. One decision says
  /// whether it is the identity; if it is not, plain bits follow.
  void code_arrangement(std::vector<Index>& sequence, Index fixed, Context<8> what) {
    if (sequence.size() < std::size_t{fixed} + 2) return;
    const bool is_straight =
        bank_.code<kStraight>(stream_, {what}, std::is_sorted(sequence.begin(), sequence.end()));
    if (is_straight || stream_.failed()) {
      std::iota(sequence.begin(), sequence.end(), Index{0});
      return;
    }
    // The permutation is coded as the exchanges that make it: for each index, the present index of
    // the element that belongs there.
    std::vector<Index> rest(sequence.size());
    std::iota(rest.begin(), rest.end(), Index{0});
    std::vector<Index> index_of = rest;  // element -> its index in `rest`
    for (std::size_t i = fixed; i + 1 < sequence.size(); ++i) {
      const std::size_t wanted = stream_.is_reading() ? i : index_of[sequence[i]];
      const auto chosen =
          i + static_cast<std::size_t>(stream_.code_uniform(wanted - i, sequence.size() - i));
      std::swap(rest[i], rest[chosen]);
      index_of[rest[i]] = static_cast<Index>(i);
      index_of[rest[chosen]] = static_cast<Index>(chosen);
    }
    sequence = rest;
  }

  void code_facets(Index shell, Index& source_facet, Index& source_ring) {
    const IndexRange facets = solid_.facets_of(shell);
    Left left(facets.begin, facets.end);
    reference_ = kNone;
    last_ = kNone;
    habits_ = {HabitContext(kNoHabit), HabitContext(kNoHabit)};
    for (Index i = 0; i < facets.size(); ++i) {
      Index facet = source_facet_[source_facet];
      facet = next_facet(left, facets, facet);
      left.remove(facet);
      source_facet_[source_facet] = facet;
      order_.facet[facet] = source_facet++;
      last_ = facet;
      code_rings(facet, source_ring);
    }
  }

  struct Candidate {
    Index facet, reference, edge;
    Habit habit;
  };

  /// Lists the facets that a habit would take next, each once.
  void collect_candidates(Left& left, IndexRange facets) {
    candidates_.clear();
    if (last_ == kNone) return;
    const auto add = [&](Index facet, Index reference, Index edge, Habit habit) {
      if (facet == kNone || !left.has(facet)) return;
      for (const Candidate& known : candidates_) {
        if (known.facet == facet) return;
      }
      candidates_.push_back({facet, reference, edge, habit});
    };
    const auto across = [&](Index reference, Index edge) {
      const Index ring = solid_.rings_of(reference).begin;
      const auto size = static_cast<Index>(solid_.ring(ring).size());
      return across_[solid_.arrays().ring_offsets[ring] + (order_.ring_start[ring] + edge) % size];
    };
    const auto ring_size = [&](Index facet) {
      return static_cast<Index>(solid_.ring(solid_.rings_of(facet).begin).size());
    };
    if (reference_ != kNone) {
      const Index size = ring_size(reference_);
      const Index next = (reference_edge_ + 1) % size;
      const Index previous = (reference_edge_ + size - 1) % size;
      add(across(reference_, next), reference_, next, kNextEdge);
      add(across(reference_, previous), reference_, previous, kLastEdge);
    }
    const Index most = std::min(ring_size(last_), kMostNeighbours);
    for (Index edge = 0; edge < most; ++edge) {
      add(across(last_, edge), last_, edge, kNeighbour);
    }
    const Index successor = left.from(last_);
    if (successor < facets.end) add(successor, kNone, 0, kSuccessor);
    add(left.from(facets.begin), kNone, 0, kFirstLeft);
  }

  Index next_facet(Left& left, IndexRange facets, Index wanted) {
    if (left.count() == 1) return left.from(facets.begin);
    collect_candidates(left, facets);
    const Facing last_facing(last_ == kNone ? 0U : facing_[last_]);
    std::uint32_t index = 0;
    for (const Candidate& candidate : candidates_) {
      const HabitContext habit(candidate.habit);
      const Facing facing(facing_[candidate.facet]);
      const bool is_it = bank_.code<kCandidate>(
          stream_, habit,
          {combine(habits_[0], habits_[1], habit), combine(last_facing, facing, habit),
           combine(capped<16>(index), habit, habits_[0])},
          candidate.facet == wanted);
      if (stream_.failed()) return left.from(facets.begin);
      ++index;
      if (!is_it) continue;
      habits_ = {habit, habits_[0]};
      // The neighbours of the old reference were asked about first: the reference changes only if
      // none of them is next.
      reference_ = candidate.reference;
      reference_edge_ = candidate.edge;
      return candidate.facet;
    }
    habits_ = {HabitContext(kNoHabit), habits_[0]};
    reference_ = kNone;
    return scanned_facet(left, facets, wanted, last_facing);
  }

  bool is_candidate(Index facet) const {
    return std::any_of(candidates_.begin(), candidates_.end(),
                       [facet](const Candidate& candidate) { return candidate.facet == facet; });
  }

  /// Codes a facet that follows no habit: it is looked for among the facets that are left, by
  /// facing and size.
  Index scanned_facet(Left& left, IndexRange facets, Index wanted, Facing last_facing) {
    scanned_.clear();
    for (Index facet = left.from(facets.begin);
         facet < facets.end && scanned_.size() <= kMostScanned; facet = left.from(facet + 1)) {
      if (!is_candidate(facet)) scanned_.push_back(facet);
    }
    if (scanned_.empty()) {  // only when reading: all facets left were candidates and denied
      stream_.fail();
      return left.from(facets.begin);
    }
    if (scanned_.size() > kMostScanned) return any_facet(left, facets, wanted);
    std::array<double, 5> largest{};  // facing -> the size of the largest facet left
    for (const Index facet : scanned_) {
      largest[facing_[facet]] = std::max(largest[facing_[facet]], size_[facet]);
    }
    for (std::size_t i = 0; i + 1 < scanned_.size(); ++i) {
      const Index facet = scanned_[i];
      const Facing facing(facing_[facet]);
      const Context<2> is_largest(size_[facet] >= largest[facing.value]);
      const Context<2> is_first(last_ == kNone);
      const std::size_t rest = scanned_.size() - i;
      const bool is_it = bank_.code<kScan>(
          stream_,
          {combine(last_facing, facing, is_largest),
           combine(facing, is_largest, is_first, capped<4>(rest / 4)), capped<64>(rest)},
          facet == wanted);
      if (is_it || stream_.failed()) return facet;
    }
    return scanned_.back();
  }

  Index any_facet(Left& left, IndexRange facets, Index wanted) {
    const std::uint64_t index = stream_.code_uniform(wanted - facets.begin, facets.size());
    const Index facet =
        facets.begin + static_cast<Index>(std::min<std::uint64_t>(index, facets.size() - 1));
    if (left.has(facet)) return facet;
    stream_.fail();
    return left.from(facets.begin);
  }

  void code_rings(Index facet, Index& source_ring) {
    const IndexRange rings = solid_.rings_of(facet);
    std::vector<Index> arrangement(rings.size());
    for (Index i = 0; i < rings.size(); ++i) {
      arrangement[i] = stream_.is_reading() ? i : source_ring_[source_ring + i] - rings.begin;
    }
    code_arrangement(arrangement, 1, kRings);
    for (const Index member : arrangement) {
      const Index ring = rings.begin + member;
      order_.ring[ring] = source_ring;
      source_ring_[source_ring++] = ring;
      code_start(ring, facet);
      see(ring);
    }
  }

  /// The class of a corner by the two facets across the edges after and before the corner. Each of
  /// the two facets counts 1 if the last ring coded is a ring of this facet, else 2 if any coded
  /// ring is, else 0. A facet that does not exist, or whose ring is being coded, counts 0.
  Relation relation(Index across_this, Index across_last) const {
    const auto of = [this](Index facet) {
      if (facet == kNone || facet == last_) return Context<3>(0U);
      if (facet == before_last_) return Context<3>(1U);
      return Context<3>(order_known(facet) ? 2U : 0U);
    };
    return combine(of(across_this), of(across_last));
  }
  bool order_known(Index facet) const { return is_placed_[facet]; }

  void code_start(Index ring, Index facet) {
    const auto vertices = solid_.ring(ring);
    const auto size = static_cast<Index>(vertices.size());
    Index& start = order_.ring_start[ring];
    Index oldest = kNone;
    double low = solid_.vertices()[vertices[0]].z;
    for (const Index vertex : vertices) {
      oldest = std::min(oldest, number_[vertex]);
      low = std::min(low, solid_.vertices()[vertex].z);
    }
    const Facing facing(facing_[facet]);
    Index corner = 0;
    for (; corner + 1 < size; ++corner) {
      const Index before = vertices[(corner + size - 1) % size];
      const Index here = vertices[corner];
      const Index after = vertices[(corner + 1) % size];
      const Point& p = solid_.vertices()[here];
      const Point& q = solid_.vertices()[after];
      const auto seen =
          combine(Context<2>(bool{is_seen_[before]}), Context<2>(bool{is_seen_[here]}),
                  Context<2>(bool{is_seen_[after]}));
      const auto seen_from_here =
          combine(Context<2>(bool{is_seen_[here]}), Context<2>(bool{is_seen_[after]}));
      const Context<2> is_oldest(oldest != kNone && number_[here] == oldest);
      const Relation related =
          relation(across_[solid_.arrays().ring_offsets[ring] + corner],
                   across_[solid_.arrays().ring_offsets[ring] + (corner + size - 1) % size]);
      const Context<2> first(corner == 0);
      const Context<2> is_low(p.z <= low);
      const auto rise = sign_of(p.z, q.z);
      const auto fall = sign_of(solid_.vertices()[before].z, p.z);
      const auto turn = combine(sign_of(p.x, q.x), sign_of(p.y, q.y), rise);
      const bool is_it = bank_.code<kStart>(
          stream_, facing,
          {combine(seen, is_oldest, facing, related),
           combine(first, is_low, rise, facing, is_oldest), combine(turn, facing),
           combine(last_relation_, related, seen), combine(capped<16>(corner), capped<16>(size)),
           combine(first, is_low, rise, fall, seen_from_here)},
          corner == start);
      if (stream_.failed()) {
        corner = 0;
        break;
      }
      if (is_it) {
        last_relation_ = related;
        break;
      }
    }
    start = corner;
  }

  void see(Index ring) {
    const auto vertices = solid_.ring(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Index vertex = vertices[(order_.ring_start[ring] + i) % vertices.size()];
      if (is_seen_[vertex]) continue;
      is_seen_[vertex] = true;
      number_[vertex] = static_cast<Index>(first_use_.size());
      first_use_.push_back(vertex);
    }
    const Index facet = facet_of_ring_[ring];
    is_placed_[facet] = true;
    before_last_ = facet;
  }

  /// Codes the permutation of the vertices relative to the order of their first use.
  void code_vertices() {
    for (Index vertex = 0; vertex < solid_.vertex_count(); ++vertex) {
      if (!is_seen_[vertex]) {
        number_[vertex] = static_cast<Index>(first_use_.size());
        first_use_.push_back(vertex);
      }
    }
    std::vector<Index> sequence(solid_.vertex_count());  // source vertex -> index in first_use_
    for (Index vertex = 0; vertex < solid_.vertex_count(); ++vertex) {
      if (!stream_.is_reading()) sequence[order_.vertex[vertex]] = number_[vertex];
    }
    code_arrangement(sequence, 0, kVertices);
    for (Index source = 0; source < sequence.size(); ++source) {
      order_.vertex[first_use_[sequence[source]]] = source;
    }
  }

  EntropyStream& stream_;
  ModelBank& bank_;
  const Solid& solid_;
  geometry::SourceOrder& order_;
  std::vector<Index> source_facet_;   // source facet -> canonical facet
  std::vector<Index> source_ring_;    // source ring -> canonical ring
  std::vector<Index> facet_of_ring_;  // canonical ring -> canonical facet
  std::vector<Index> across_;  // corner -> facet across the edge from this corner to the next
  std::vector<std::uint32_t> facing_;
  std::vector<double> size_;
  std::vector<bool> is_seen_;  // vertex -> whether a ring coded so far has this vertex
  std::vector<bool> is_placed_ = std::vector<bool>(solid_.facet_count(), false);
  std::vector<Index> number_;  // vertex -> index in first_use_
  std::vector<Index> first_use_;
  std::vector<Candidate> candidates_;
  std::vector<Index> scanned_;
  Index last_ = kNone;
  Index before_last_ = kNone;
  Index reference_ = kNone;
  Index reference_edge_ = 0;  // the index of an edge of reference_, counted from the start of its
                              // ring
  std::array<HabitContext, 2> habits_{HabitContext(kNoHabit), HabitContext(kNoHabit)};
  Relation last_relation_{0U};
};

}  // namespace

const ModelLayout& order_layout() {
  static constexpr ModelLayout layout{kOrderFamilies, {}};
  return layout;
}

void code_order(EntropyStream& stream, ModelBank& bank, const Solid& canonical,
                geometry::SourceOrder& order) {
  OrderCoder(stream, bank, canonical, order).run();
}

}  // namespace watertight::codec
