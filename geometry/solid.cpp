// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/solid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/quantity.h"

namespace watertight::geometry {
namespace {

bool are_offsets(const std::vector<Index>& offsets, std::size_t size) {
  return !offsets.empty() && offsets.front() == 0 && offsets.back() == size &&
         std::is_sorted(offsets.begin(), offsets.end());
}

Status check_sizes(const SolidArrays& arrays, const Limits& limits) {
  const auto over = [](const char* what, std::size_t count, std::uint64_t limit) {
    return Error{ErrorCode::limit_exceeded, std::to_string(count) + " " + what +
                                                " in one solid; the limit is " +
                                                std::to_string(limit)};
  };
  if (arrays.vertices.size() > limits.vertices)
    return over("vertices", arrays.vertices.size(), limits.vertices);
  if (arrays.ring_offsets.size() - 1 > limits.rings)
    return over("rings", arrays.ring_offsets.size() - 1, limits.rings);
  if (arrays.facet_offsets.size() - 1 > limits.facets)
    return over("facets", arrays.facet_offsets.size() - 1, limits.facets);
  if (arrays.shell_offsets.size() - 1 > limits.shells)
    return over("shells", arrays.shell_offsets.size() - 1, limits.shells);
  return Done{};
}

}  // namespace

Result<Solid> Solid::make(SolidArrays arrays, Lattice lattice, std::uint32_t srid,
                          const Limits& limits) {
  if (!are_offsets(arrays.ring_offsets, arrays.ring_vertices.size()) ||
      !are_offsets(arrays.facet_offsets, arrays.ring_offsets.size() - 1) ||
      !are_offsets(arrays.shell_offsets, arrays.facet_offsets.size() - 1)) {
    return Error{ErrorCode::malformed, "ring, facet or shell offsets do not describe a solid"};
  }
  if (!lattice.is_sane())
    return Error{ErrorCode::malformed,
                 "the lattice has a step that is not positive or an exponent out of range"};
  if (auto sizes = check_sizes(arrays, limits); !sizes) return sizes.error();
  for (const Index vertex : arrays.ring_vertices) {
    if (vertex >= arrays.vertices.size()) {
      return Error{ErrorCode::malformed,
                   "vertex index " + std::to_string(vertex) + " is out of range (" +
                       quantity(arrays.vertices.size(), "vertex", "vertices") + ')'};
    }
  }
  for (Point& p : arrays.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(p[axis]))
        return Error{ErrorCode::malformed, "a coordinate is not a finite number"};
      p[axis] += 0.0;  // -0 becomes +0: one number, one representation
    }
  }
  return Solid(std::move(arrays), lattice, srid);
}

Index Solid::shell_of(Index facet) const {
  const auto& offsets = arrays_.shell_offsets;
  return static_cast<Index>(std::upper_bound(offsets.begin(), offsets.end(), facet) -
                            offsets.begin() - 1);
}

MergedSolid merge_equal_vertices(const Solid& solid) {
  const auto vertices = solid.vertices();
  std::vector<bool> is_used(vertices.size(), false);
  for (const Index vertex : solid.arrays().ring_vertices) is_used[vertex] = true;

  // The used vertices with copies of their points, so that the sort reads memory in order.
  std::vector<std::pair<Point, Index>> by_point;
  by_point.reserve(vertices.size());
  for (Index vertex = 0; vertex < vertices.size(); ++vertex) {
    if (is_used[vertex]) by_point.emplace_back(vertices[vertex], vertex);
  }
  std::sort(by_point.begin(), by_point.end());

  // The first used vertex of each group of equal points stands for the group.
  std::vector<Index> first(vertices.size(), kNone);
  for (std::size_t i = 0; i < by_point.size(); ++i) {
    const auto& [point, vertex] = by_point[i];
    first[vertex] =
        i > 0 && by_point[i - 1].first == point ? first[by_point[i - 1].second] : vertex;
  }

  SolidArrays arrays = solid.arrays();
  arrays.vertices.clear();
  std::vector<Index> vertex_of(vertices.size(), kNone);
  for (Index vertex = 0; vertex < vertices.size(); ++vertex) {
    if (first[vertex] == vertex) {
      vertex_of[vertex] = static_cast<Index>(arrays.vertices.size());
      arrays.vertices.push_back(vertices[vertex]);
    }
  }
  for (Index vertex = 0; vertex < vertices.size(); ++vertex) {
    if (first[vertex] != kNone) vertex_of[vertex] = vertex_of[first[vertex]];
  }
  for (Index& vertex : arrays.ring_vertices) vertex = vertex_of[vertex];

  auto merged =
      Solid::make(std::move(arrays), solid.lattice(), solid.srid(),
                  Limits{.vertices = kNone, .facets = kNone, .rings = kNone, .shells = kNone});
  return {std::move(merged).value(), std::move(vertex_of)};
}

}  // namespace watertight::geometry
