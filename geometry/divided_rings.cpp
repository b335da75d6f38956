// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/divided_rings.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "geometry/predicates/predicates.h"

namespace watertight::geometry {
namespace {

/// The largest number of pairs of an edge and a vertex that are tested in one solid: two seconds of
/// work. Only long oblique edges beside many vertices come near this number.
constexpr std::uint64_t kMostPairs = 100'000'000;

/// A facet has at most this number of touches for each ring vertex. Divided rings that share no
/// segments are a planar graph with at most 3 edges for each vertex, and each touch adds an edge.
constexpr std::size_t kMostEdgesPerVertex = 3;

/// A vertex of a ring with a copy of its point, so that a search reads memory in order.
struct RingVertex {
  Point point;
  Index vertex = 0;
  Index ring = 0;
};
using Candidates = std::span<const RingVertex>;

class TouchFinder {
 public:
  explicit TouchFinder(const Solid& solid) : solid_(solid), vertices_(solid.vertices()) {}

  void examine(Index facet) {
    const IndexRange rings = solid_.rings_of(facet);
    if (rings.size() < 2) return;
    sort_vertices(rings);
    const std::size_t before = touches_.size();
    const std::size_t most = before + kMostEdgesPerVertex * by_axis_[0].size();
    const auto goes_on = [&] { return pairs_ <= kMostPairs && touches_.size() <= most; };
    for (Index r = rings.begin; r < rings.end; ++r) {
      for (Index i = 0; i < solid_.ring(r).size() && goes_on(); ++i) find_on_edge(r, i);
    }
    if (!goes_on()) touches_.resize(before);
  }

  std::vector<RingTouch> take() { return std::move(touches_); }

 private:
  void sort_vertices(IndexRange rings);
  Candidates beside(const Point& a, const Point& b) const;
  void find_on_edge(Index ring, Index position);
  bool has(Index ring, Index vertex);

  const Solid& solid_;
  std::span<const Point> vertices_;
  std::array<std::vector<RingVertex>, 3> by_axis_;  // the facet's ring vertices sorted by x, y, z
  std::uint64_t pairs_ = 0;
  std::vector<RingTouch> touches_;
};

void TouchFinder::sort_vertices(IndexRange rings) {
  for (int axis = 0; axis < 3; ++axis) {
    auto& list = by_axis_[static_cast<std::size_t>(axis)];
    list.clear();
    for (Index r = rings.begin; r < rings.end; ++r) {
      for (const Index vertex : solid_.ring(r)) list.push_back({vertices_[vertex], vertex, r});
    }
    std::sort(list.begin(), list.end(), [axis](const RingVertex& a, const RingVertex& b) {
      return std::tuple(a.point[axis], a.vertex, a.ring) <
             std::tuple(b.point[axis], b.vertex, b.ring);
    });
  }
}

/// The vertices between a and b along one axis, the axis along which there are fewest.
Candidates TouchFinder::beside(const Point& a, const Point& b) const {
  Candidates fewest = by_axis_[0];
  for (int axis = 0; axis < 3; ++axis) {
    const auto& list = by_axis_[static_cast<std::size_t>(axis)];
    const auto [low, high] = std::minmax({a[axis], b[axis]});
    const auto begin = std::lower_bound(
        list.begin(), list.end(), low,
        [axis](const RingVertex& v, double bound) { return v.point[axis] < bound; });
    const auto end = std::upper_bound(
        begin, list.end(), high,
        [axis](double bound, const RingVertex& v) { return bound < v.point[axis]; });
    const Candidates between(begin, end);
    if (between.size() < fewest.size()) fewest = between;
  }
  return fewest;
}

bool TouchFinder::has(Index ring, Index vertex) {
  const std::span<const Index> corners = solid_.ring(ring);
  pairs_ += corners.size();
  return std::find(corners.begin(), corners.end(), vertex) != corners.end();
}

void TouchFinder::find_on_edge(Index ring, Index position) {
  const std::span<const Index> corners = solid_.ring(ring);
  const Index from = corners[position];
  const Index to = corners[(position + 1) % corners.size()];
  if (from == to) return;
  const Point& a = vertices_[from];
  const Point& b = vertices_[to];
  std::vector<Index> found;
  const Candidates candidates = beside(a, b);
  pairs_ += candidates.size();
  for (const RingVertex& candidate : candidates) {
    const Index v = candidate.vertex;
    if (candidate.ring == ring || v == from || v == to) continue;
    if (is_on_segment(a, b, candidate.point) && !has(ring, v)) found.push_back(v);
  }
  std::sort(found.begin(), found.end(), [&](Index p, Index q) {
    return a < b ? vertices_[p] < vertices_[q] : vertices_[q] < vertices_[p];
  });
  found.erase(std::unique(found.begin(), found.end()), found.end());
  const Index corner = solid_.arrays().ring_offsets[ring] + position;
  for (const Index v : found) touches_.push_back({corner, v});
}

}  // namespace

std::vector<RingTouch> ring_touches(const Solid& solid, std::span<const Index> facets) {
  TouchFinder finder(solid);
  for (const Index facet : facets) finder.examine(facet);
  return finder.take();
}

std::vector<RingTouch> ring_touches(const Solid& solid) {
  TouchFinder finder(solid);
  for (Index facet = 0; facet < solid.facet_count(); ++facet) finder.examine(facet);
  return finder.take();
}

DividedRings divide_rings(const Solid& solid, std::span<const RingTouch> touches) {
  const SolidArrays& source = solid.arrays();
  SolidArrays arrays = source;
  arrays.ring_vertices.clear();
  arrays.ring_offsets.assign(1, 0);
  std::vector<Index> corner_of;
  auto touch = touches.begin();
  for (Index ring = 0; ring < solid.ring_count(); ++ring) {
    for (Index c = source.ring_offsets[ring]; c < source.ring_offsets[ring + 1]; ++c) {
      arrays.ring_vertices.push_back(source.ring_vertices[c]);
      for (; touch != touches.end() && touch->corner == c; ++touch) {
        arrays.ring_vertices.push_back(touch->vertex);
      }
      corner_of.resize(arrays.ring_vertices.size(), c);
    }
    arrays.end_ring();
  }
  const Limits none{.vertices = kNone, .facets = kNone, .rings = kNone, .shells = kNone};
  auto divided = Solid::make(std::move(arrays), solid.lattice(), solid.srid(), none);
  return {std::move(divided).value(), std::move(corner_of)};
}

}  // namespace watertight::geometry
