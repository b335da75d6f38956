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

/// The border of a disc that grows from a random triangle until it has so many vertices; nothing if
/// it cannot grow on, or meets a taken vertex.
inline std::optional<fill::Loop> random_loop(const Mesh& mesh, std::size_t size,
                                             const std::set<Index>& taken, test::Random& random) {
  const Triangle& first = mesh.triangles[random.below(mesh.triangles.size())];
  fill::Loop loop(first.begin(), first.end());
  for (int attempt = 0; attempt < 100'000 && loop.size() < size; ++attempt) {
    const std::size_t at = random.below(loop.size());
    const MeshEdge edge{loop[(at + 1) % loop.size()], loop[at]};  // as the triangle outside has it
    const auto found = mesh.triangle_of.find(edge);
    if (found == mesh.triangle_of.end()) continue;
    const Triangle& triangle = mesh.triangles[found->second];
    const Index tip = *std::ranges::find_if(
        triangle, [&](Index v) { return v != edge.first && v != edge.second; });
    const auto place = std::ranges::find(loop, tip);
    if (place == loop.end()) {
      loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(at) + 1, tip);
      continue;
    }
    // The triangle fills a corner: the vertex in the corner leaves the border.
    const auto corner = [&](std::size_t gone) {
      const std::size_t n = loop.size();
      if (n > 3) loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(gone % n));
    };
    if (loop[(at + 2) % loop.size()] == tip) {
      corner(at + 1);
    } else if (loop[(at + loop.size() - 1) % loop.size()] == tip) {
      corner(at);
    }
  }
  const bool is_free =
      std::ranges::none_of(loop, [&](Index vertex) { return taken.contains(vertex); });
  if (loop.size() < size || !is_free) return std::nullopt;
  std::ranges::reverse(loop);  // with the disc missing on its left it runs the other way
  return loop;
}

}  // namespace watertight::bench
