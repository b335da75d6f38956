// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/hole_groups.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "geometry/disjoint_sets.h"
#include "geometry/predicates/predicates.h"
#include "geometry/vector3.h"
#include "repair/turn.h"
#include "validate/overlap/box_tree.h"

namespace watertight::repair {
namespace {

/// Whether a point is inside a ring in the projection along an axis, by the number of edges to its
/// left; a point on the ring may be either.
bool is_inside(const EditedSolid& solid, const Ring& ring, const Point& point, int axis) {
  const int up = axis == 0 ? 2 : axis == 1 ? 0 : 1;
  bool is_in = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point* low = &solid.vertices[ring[i]];
    const Point* high = &solid.vertices[ring[(i + 1) % ring.size()]];
    if ((*low)[up] > (*high)[up]) std::swap(low, high);
    if ((*low)[up] > point[up] || (*high)[up] <= point[up]) continue;
    if (geometry::orient2d(*low, *high, point, axis) < 0) is_in = !is_in;
  }
  return is_in;
}

/// A loop that may have islands.
class OuterLoop {
 public:
  OuterLoop(const EditedSolid& solid, const Ring& loop)
      : solid_(solid), loop_(loop), axis_(projection_axis(solid, {{loop}, kNone})) {
    if (axis_) turn_ = turn_of(solid, loop, *axis_);
  }
  /// Whether loops in two boxes may lie above each other in the projection of this one.
  bool is_near(const Box& a, const Box& b) const {
    if (turn_ == 0) return false;
    for (int side = 0; side < 3; ++side) {
      if (side != *axis_ && (a.min[side] > b.max[side] || a.max[side] < b.min[side])) return false;
    }
    return true;
  }
  /// Whether another loop lies inside and runs the other way.
  bool has_island(const Ring& other) const {
    if (turn_of(solid_, other, *axis_) != -turn_) return false;
    return std::ranges::all_of(other, [&](Index vertex) {
      return is_inside(solid_, loop_, solid_.vertices[vertex], *axis_);
    });
  }

 private:
  const EditedSolid& solid_;
  const Ring& loop_;
  std::optional<int> axis_;
  int turn_ = 0;
};

// With more holes in a shell their parts are not joined.
constexpr std::size_t kMostJoinedHoles = 8;

/// Two holes that may become one.
struct JoinedPair {
  double cost = 0;
  std::size_t first = 0;
  std::size_t second = 0;
};

geometry::DisjointSets parts_of(std::span<const EditedFacet> facets, std::size_t vertex_count) {
  geometry::DisjointSets parts(vertex_count);
  for (const EditedFacet& facet : facets) {
    Index first = kNone;  // a ring may be empty
    for (const Ring& ring : facet.rings) {
      for (const Index vertex : ring) {
        if (first == kNone) first = vertex;
        parts.join(first, vertex);
      }
    }
  }
  return parts;
}

HoleLoops both(const HoleLoops& first, const HoleLoops& second) {
  HoleLoops loops = first;
  loops.insert(loops.end(), second.begin(), second.end());
  return loops;
}

Box box_of(const EditedSolid& solid, const Ring& loop) {
  Box box;
  for (const Index vertex : loop) box.include(solid.vertices[vertex]);
  return box;
}

}  // namespace

std::vector<HoleLoops> group_loops(const EditedSolid& solid, std::vector<Ring> loops) {
  const auto units = metres_per_unit(solid);
  std::vector<std::pair<double, Ring>> by_size;
  for (Ring& loop : loops) {
    const double size = geometry::length(area_vector(solid, loop, units));
    by_size.emplace_back(-size, std::move(loop));
  }
  std::sort(by_size.begin(), by_size.end());
  std::vector<Box> boxes;
  for (const auto& [size, loop] : by_size) boxes.push_back(box_of(solid, loop));
  const validate::BoxTree tree(boxes);
  std::vector<HoleLoops> groups;
  std::vector<bool> is_taken(by_size.size());
  for (std::size_t i = 0; i < by_size.size(); ++i) {
    if (is_taken[i]) continue;
    HoleLoops& group = groups.emplace_back();
    group.push_back(by_size[i].second);
    const OuterLoop outer(solid, by_size[i].second);
    std::vector<std::size_t> near;
    tree.visit([&](const Box& box) { return outer.is_near(box, boxes[i]); },
               [&](Index j) {
                 const bool is_smaller = j > i && !is_taken[j];
                 if (is_smaller && outer.is_near(boxes[j], boxes[i])) near.push_back(j);
               });
    std::sort(near.begin(), near.end());
    for (const std::size_t j : near) {
      if (!outer.has_island(by_size[j].second)) continue;
      group.push_back(by_size[j].second);
      is_taken[j] = true;
    }
  }
  return groups;
}

std::vector<HoleLoops> join_parts(std::span<const EditedFacet> facets, std::size_t vertex_count,
                                  std::vector<HoleLoops> holes, const HoleCost& cost) {
  if (holes.size() < 2 || holes.size() > kMostJoinedHoles) return holes;
  geometry::DisjointSets parts = parts_of(facets, vertex_count);
  const auto part_of = [&](std::size_t hole) { return parts.root(holes[hole][0][0]); };
  std::vector<JoinedPair> pairs;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    for (std::size_t j = i + 1; j < holes.size(); ++j) {
      if (part_of(i) == part_of(j)) continue;
      const auto own = cost(both(holes[i], holes[j]));
      if (own) pairs.push_back({*own, i, j});
    }
  }
  std::ranges::sort(pairs, {}, [](const JoinedPair& pair) {
    return std::tuple(pair.cost, pair.first, pair.second);
  });
  for (const auto& [own, first, second] : pairs) {
    if (holes[first].empty() || holes[second].empty() || part_of(first) == part_of(second))
      continue;
    parts.join(part_of(first), part_of(second));
    holes.push_back(both(holes[first], holes[second]));
    holes[first].clear();
    holes[second].clear();
  }
  std::erase_if(holes, [](const HoleLoops& hole) { return hole.empty(); });
  return holes;
}

}  // namespace watertight::repair
