// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_parallelogram/cut_surface.h"

#include <algorithm>
#include <optional>

#include "geometry/disjoint_sets.h"
#include "geometry/mesh/edge_sides.h"
#include "geometry/mesh/fans.h"
#include "geometry/mesh/half_edges.h"

namespace watertight::codec::parallelogram {
namespace {

/// The sides of the triangles of a shell, in the order in which they pair up. Where more than two
/// sides meet in one edge, two of them pair up if their triangles are also connected across other
/// edges. So bodies that touch along an edge are separated.
std::vector<geometry::EdgeSide> sides_of_shell(std::span<const Triangle> triangles, Index first,
                                               Index last) {
  std::vector<geometry::EdgeSide> sides = geometry::sides_of_triangles(triangles, first, last);
  const std::span<geometry::EdgeSide> all(sides);
  const auto triangle_of = [first](const geometry::EdgeSide& side) {
    return side.half_edge / 3 - first;
  };
  geometry::DisjointSets parts(last - first);
  geometry::for_each_edge(all, [&](std::span<geometry::EdgeSide> edge) {
    if (edge.size() == 2) parts.join(triangle_of(edge[0]), triangle_of(edge[1]));
  });
  geometry::for_each_edge(all, [&](std::span<geometry::EdgeSide> edge) {
    if (edge.size() == 2) return;
    std::sort(edge.begin(), edge.end(),
              [&](const geometry::EdgeSide& a, const geometry::EdgeSide& b) {
                if (a.is_downward != b.is_downward) return b.is_downward;
                const Index part_of_a = parts.root(triangle_of(a));
                const Index part_of_b = parts.root(triangle_of(b));
                return part_of_a != part_of_b ? part_of_a < part_of_b : a.half_edge < b.half_edge;
              });
  });
  return sides;
}

/// Gives each fan of triangles around a vertex a vertex of its own.
void cut_fans(CutSurface& surface, const std::vector<GridPoint>& vertices) {
  const geometry::Fans fans = geometry::number_fans(surface.twin, geometry::previous_half_edge);
  for (const Index h : fans.first) {
    surface.positions.push_back(vertices[geometry::start_of(surface.triangles, h)]);
  }
  for (Index h = 0; h < fans.fan_of.size(); ++h) surface.triangles[h / 3][h % 3] = fans.fan_of[h];
}

void find_components(CutSurface& surface, const std::vector<Index>& shell_of) {
  geometry::DisjointSets components(surface.triangles.size());
  for (Index h = 0; h < surface.twin.size(); ++h) components.join(h / 3, surface.twin[h] / 3);
  surface.component_first = components.numbered().first;
  Index shell = kNone;
  for (const Index triangle : surface.component_first) {
    surface.is_new_shell.push_back(shell_of[triangle] != shell);
    shell = shell_of[triangle];
  }
}

}  // namespace

Result<CutSurface> cut_surface(const IntegerSolid& solid) {
  CutSurface surface;
  std::vector<Index> shell_of;
  surface.twin.reserve(solid.ring_vertices.size());
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const auto begin = static_cast<Index>(surface.triangles.size());
    for (Index facet = solid.shell_offsets[shell]; facet < solid.shell_offsets[shell + 1];
         ++facet) {
      const Index ring = solid.facet_offsets[facet];
      if (solid.facet_offsets[facet + 1] != ring + 1 || solid.ring(ring).size() != 3) {
        return Error{ErrorCode::not_encodable,
                     "mode parallelogram codes triangles only: a facet is not a triangle"};
      }
      const auto corners = solid.ring(ring);
      surface.triangles.push_back({corners[0], corners[1], corners[2]});
      shell_of.push_back(shell);
    }
    const auto end = static_cast<Index>(surface.triangles.size());
    const auto twins = geometry::paired(sides_of_shell(surface.triangles, begin, end), 3 * begin);
    if (!twins) return Error{ErrorCode::not_encodable, "the surface of a shell is not closed"};
    surface.twin.insert(surface.twin.end(), twins->begin(), twins->end());
  }
  cut_fans(surface, solid.vertices);
  find_components(surface, shell_of);
  return surface;
}

}  // namespace watertight::codec::parallelogram
