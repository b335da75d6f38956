// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mesh/interior_shells.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

// Appends the shells of a solid to the arrays, the exact coordinates of its vertices to
// `positions`, and the vertices whose digits are rounded to `rounded`.
Status append_solid(const Solid& solid, SolidArrays& arrays,
                    std::vector<std::array<GridNumber, 3>>& positions,
                    std::vector<Index>& rounded) {
  const auto first_vertex = static_cast<Index>(positions.size());
  for (const Point& p : solid.vertices()) {
    std::array<GridNumber, 3> position;
    bool is_rounded = false;
    for (int axis = 0; axis < 3; ++axis) {
      auto exact = exact_number(solid.lattice().world_text(p[axis], axis));
      if (!exact) return std::move(exact).error();
      position[static_cast<std::size_t>(axis)] = exact->value;
      is_rounded = is_rounded || exact->is_rounded;
    }
    if (is_rounded) rounded.push_back(static_cast<Index>(positions.size()));
    positions.push_back(position);
  }
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const IndexRange facets = solid.facets_of(shell);
    for (Index facet = facets.begin; facet < facets.end; ++facet) {
      const IndexRange rings = solid.rings_of(facet);
      for (Index ring = rings.begin; ring < rings.end; ++ring) {
        for (const Index vertex : solid.ring(ring)) {
          arrays.ring_vertices.push_back(first_vertex + vertex);
        }
        arrays.end_ring();
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  return Done{};
}

}  // namespace

Result<SubmittedSolid> with_interior_shells(const SubmittedSolid& exterior,
                                            std::span<const SubmittedSolid> interior,
                                            const Limits& limits) {
  std::uint64_t vertex_count = exterior.solid.vertex_count();
  for (const SubmittedSolid& solid : interior) vertex_count += solid.solid.vertex_count();
  if (vertex_count > limits.vertices) {
    return Error{ErrorCode::limit_exceeded, std::to_string(vertex_count) +
                                                " vertices in all shells; the limit is " +
                                                std::to_string(limits.vertices)};
  }
  SolidArrays arrays;
  std::vector<std::array<GridNumber, 3>> positions;
  positions.reserve(vertex_count);
  std::vector<Index> rounded = exterior.rounded;
  std::vector<Index> unclosed = exterior.unclosed_rings;
  if (auto status = append_solid(exterior.solid, arrays, positions, rounded); !status) {
    return status.error();
  }
  for (const SubmittedSolid& solid : interior) {
    const auto first_vertex = static_cast<Index>(positions.size());
    const auto first_ring = static_cast<Index>(arrays.ring_offsets.size() - 1);
    for (const Index vertex : solid.rounded) rounded.push_back(first_vertex + vertex);
    for (const Index ring : solid.unclosed_rings) unclosed.push_back(first_ring + ring);
    if (auto status = append_solid(solid.solid, arrays, positions, rounded); !status) {
      return status.error();
    }
  }
  auto points = geometry::lattice_of_decimals(positions);
  if (!points) return std::move(points).error();
  // The common lattice of all shells may round further vertices; both lists are short or empty.
  rounded.insert(rounded.end(), points->rounded.begin(), points->rounded.end());
  std::sort(rounded.begin(), rounded.end());
  rounded.erase(std::unique(rounded.begin(), rounded.end()), rounded.end());
  arrays.vertices = std::move(points->points);
  auto solid = Solid::make(std::move(arrays), points->lattice, exterior.solid.srid(), limits);
  if (!solid) return std::move(solid).error();
  return SubmittedSolid{std::move(*solid), exterior.source, std::move(rounded),
                        std::move(unclosed)};
}

}  // namespace watertight::formats
