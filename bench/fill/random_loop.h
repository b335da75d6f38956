// SPDX-License-Identifier: GPL-3.0-or-later
//
// Random loops of edges of a mesh.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fill/triangulate_loops.h"
#include "geometry/solid.h"
#include "geometry/vector3.h"
#include "tests/random.h"

namespace watertight::bench {

using MeshEdge = std::pair<Index, Index>;

struct Mesh {
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  std::map<MeshEdge, std::size_t> triangle_of;  // directed edge -> triangle
};

inline Mesh mesh_of(const Solid& solid) {
  Mesh mesh;
  mesh.points.assign(solid.vertices().begin(), solid.vertices().end());
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    const auto ring = solid.ring(solid.rings_of(facet).begin);
    if (ring.size() != 3) continue;
    const Triangle triangle{ring[0], ring[1], ring[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      mesh.triangle_of[{triangle[i], triangle[(i + 1) % 3]}] = mesh.triangles.size();
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

/// How a disc grows, and with it its border.
enum class Growth {
  ragged,  // at a random edge
  round,   // where the new triangle is nearest to the first one
};

/// What the triangle outside an edge of the border would do to it.
struct GrowthStep {
  Index tip = kNone;  // the third vertex of the triangle; kNone: it cannot be added
  std::optional<std::size_t>
      gone;  // the place of the vertex that leaves the border; none: the tip comes
};

inline GrowthStep growth_step(const Mesh& mesh, const fill::Loop& loop, std::size_t at) {
  const std::size_t n = loop.size();
  const MeshEdge edge{loop[(at + 1) % n], loop[at]};  // as the triangle outside has it
  const auto found = mesh.triangle_of.find(edge);
  if (found == mesh.triangle_of.end()) return {};
  const Triangle& triangle = mesh.triangles[found->second];
  const Index tip =
      *std::ranges::find_if(triangle, [&](Index v) { return v != edge.first && v != edge.second; });
  if (std::ranges::find(loop, tip) == loop.end()) return {tip, std::nullopt};
  // A triangle that fills a corner takes the vertex in the corner out of the border.
  if (n > 3 && loop[(at + 2) % n] == tip) return {tip, (at + 1) % n};
  if (n > 3 && loop[(at + n - 1) % n] == tip) return {tip, at};
  return {};
}

inline void grow(fill::Loop& loop, std::size_t at, const GrowthStep& step) {
  const std::size_t place = step.gone.value_or(at + 1);
  const auto where = loop.begin() + static_cast<std::ptrdiff_t>(place);
  step.gone ? loop.erase(where) : loop.insert(where, step.tip);
}

/// The edge of the border at which the triangle outside is nearest to a place.
inline std::optional<std::size_t> nearest_growth(const Mesh& mesh, const fill::Loop& loop,
                                                 const Point& middle) {
  std::optional<std::size_t> nearest;
  double least = 0;
  for (std::size_t at = 0; at < loop.size(); ++at) {
    const GrowthStep step = growth_step(mesh, loop, at);
    if (step.tip == kNone) continue;
    const geometry::Vector3 way = geometry::difference(mesh.points[step.tip], middle);
    const double distance = geometry::dot(way, way);
    if (nearest && distance >= least) continue;
    nearest = at;
    least = distance;
  }
  return nearest;
}

/// The border of a disc that grows from a random triangle until it has so many vertices; nothing if
/// it cannot grow on, or meets a taken vertex.
inline std::optional<fill::Loop> random_loop(const Mesh& mesh, std::size_t size,
                                             const std::set<Index>& taken, test::Random& random,
                                             Growth growth = Growth::ragged) {
  const Triangle& first = mesh.triangles[random.below(mesh.triangles.size())];
  fill::Loop loop(first.begin(), first.end());
  for (int attempt = 0; attempt < 100'000 && loop.size() < size; ++attempt) {
    const std::optional<std::size_t> at = growth == Growth::ragged
                                              ? random.below(loop.size())
                                              : nearest_growth(mesh, loop, mesh.points[first[0]]);
    if (!at) break;
    const GrowthStep step = growth_step(mesh, loop, *at);
    if (step.tip != kNone) grow(loop, *at, step);
  }
  const bool is_free =
      std::ranges::none_of(loop, [&](Index vertex) { return taken.contains(vertex); });
  if (loop.size() < size || !is_free) return std::nullopt;
  std::ranges::reverse(loop);  // with the disc missing on its left it runs the other way
  return loop;
}

}  // namespace watertight::bench
