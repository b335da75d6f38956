// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/part21/curved_solid.h"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/part21/boundary_reader.h"
#include "formats/surface.h"
#include "surfaces/tessellate_boundary.h"

namespace watertight::formats {
namespace {

void move_boundary(const surfaces::Affine& placement, surfaces::BoundaryRepresentation& boundary) {
  for (surfaces::Vector3& vertex : boundary.vertices) vertex = moved(placement, vertex);
  for (surfaces::BoundaryEdge& edge : boundary.edges) move(placement, edge.curve);
  const bool is_mirrored = is_mirror(placement);
  for (surfaces::BoundaryFace& face : boundary.faces) {
    if (face.surface) move(placement, *face.surface);
    if (!is_mirrored) continue;
    face.is_along_surface = !face.is_along_surface;
    for (surfaces::EdgeLoop& loop : face.loops) surfaces::turn(loop);
  }
}

Tessellation account_of(const surfaces::TessellatedBoundary& result, double chord) {
  const surfaces::TessellationMeasures& measures = result.measures;
  Tessellation account{
      measures.faces,       measures.edges, measures.samples, measures.triangles, chord,
      measures.chord_error, measures.gap,   measures.rounds,  measures.turned,    {}};
  for (const surfaces::LeftOutFace& face : result.left_out) {
    account.left_out.push_back({face.name, face.reason});
  }
  return account;
}

Result<SubmittedSolid> curved_solid(surfaces::BoundaryRepresentation boundary,
                                    const surfaces::Affine& placement, SolidSource source,
                                    std::uint32_t srid, double chord, std::uint64_t& budget,
                                    const Limits& limits) {
  move_boundary(placement, boundary);
  surfaces::TessellateOptions options;
  options.chord = chord;
  options.most_triangles = std::min({limits.facets, limits.vertices, budget});
  auto result = surfaces::tessellate(boundary, options);
  if (!result) return std::move(result).error();
  budget -= std::min<std::uint64_t>(budget, result->arrays.facet_offsets.size() - 1);
  DecimalVertices vertices;
  vertices.is_rounded.assign(result->positions.size(), false);
  for (const auto& position : result->positions) {
    std::array<GridNumber, 3> decimals;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      GridNumber number{position[axis], position[axis] == 0 ? 0 : result->lattice_exponent};
      while (number.mantissa != 0 && number.mantissa % 10 == 0) {
        number = {number.mantissa / 10, number.exponent + 1};
      }
      decimals[axis] = number;
    }
    vertices.positions.push_back(decimals);
  }
  auto solid = indexed_solid(std::move(result->arrays), vertices, std::move(source), limits);
  if (!solid) return solid;
  solid->tessellation = account_of(*result, chord);
  if (srid == 0) return solid;
  auto placed = Solid::make(solid->solid.arrays(), solid->solid.lattice(), srid, limits);
  if (!placed) return std::move(placed).error();
  solid->solid = *std::move(placed);
  return solid;
}

}  // namespace

Status add_curved_solid(const Part21& file, CurvedSource from, const ReadOptions& options,
                        std::uint64_t& budget, Document& document, Feature& feature) {
  auto boundary = read_boundary(file, from.id, from.radian, options.limits);
  if (!boundary) {
    if (boundary.error().code == ErrorCode::limit_exceeded) return boundary.error();
    feature.unreadable.push_back({std::move(from.source), std::move(boundary).error()});
    return Done{};
  }
  document.notes.insert(document.notes.end(), boundary->notes.begin(), boundary->notes.end());
  if (from.tolerance) boundary->solid.tolerance = *from.tolerance;
  auto solid = curved_solid(std::move(boundary->solid), from.placement, from.source, from.srid,
                            options.chord, budget, options.limits);
  if (!solid) {
    if (solid.error().code == ErrorCode::invalid_argument) return solid.error();
    feature.unreadable.push_back({std::move(from.source), std::move(solid).error()});
    return Done{};
  }
  feature.solids.push_back(*std::move(solid));
  return Done{};
}

}  // namespace watertight::formats
