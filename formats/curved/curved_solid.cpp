// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/curved/curved_solid.h"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/surface.h"
#include "surfaces/tessellate_boundary.h"

namespace watertight::formats {
namespace {

constexpr int kMostHalvings = 4;  // of the chord of a solid whose facets cross
/// A solid whose facets cross at every chord must not cost many times as much as others.
constexpr std::size_t kMostTrialTriangles = 20'000;

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
  Tessellation account;
  account.faces = measures.faces;
  account.edges = measures.edges;
  account.samples = measures.samples;
  account.triangles = measures.triangles;
  account.chord = chord;
  account.chord_error = measures.chord_error;
  account.gap = measures.gap;
  account.rounds = measures.rounds;
  account.turned = measures.turned;
  account.strips = measures.strips;
  account.indices = measures.indices;
  account.mean_least_angle = measures.mean_least_angle;
  account.worst_least_angle = measures.worst_least_angle;
  for (const surfaces::LeftOutFace& face : result.left_out) {
    account.left_out.push_back({face.name, face.reason});
  }
  return account;
}

DecimalVertices decimals_of(const surfaces::TessellatedBoundary& result) {
  DecimalVertices vertices;
  vertices.is_rounded.assign(result.positions.size(), false);
  for (const auto& position : result.positions) {
    std::array<GridNumber, 3> decimals;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      GridNumber number{position[axis], position[axis] == 0 ? 0 : result.lattice_exponent};
      while (number.mantissa != 0 && number.mantissa % 10 == 0) {
        number = {number.mantissa / 10, number.exponent + 1};
      }
      decimals[axis] = number;
    }
    vertices.positions.push_back(decimals);
  }
  return vertices;
}

/// The strips with the vertices of the solid: those of its rings are in the order of `corners`.
std::vector<Tessellation::FaceStrips> strips_of(std::vector<surfaces::FaceStrips> faces,
                                                const std::vector<Index>& corners,
                                                std::size_t positions, const Solid& solid) {
  std::vector<Index> vertex_of(positions, kNone);
  const auto& own = solid.arrays().ring_vertices;
  for (std::size_t i = 0; i < corners.size(); ++i) vertex_of[corners[i]] = own[i];
  std::vector<Tessellation::FaceStrips> all;
  for (surfaces::FaceStrips& face : faces) {
    for (auto& strip : face.strips) {
      for (Index& vertex : strip) vertex = vertex_of[vertex];
    }
    all.push_back({std::move(face.face), std::move(face.strips)});
  }
  return all;
}

/// Makes a solid of a boundary in metres. Errors: those of tessellate() and of Solid::make().
Result<SubmittedSolid> solid_of(const surfaces::BoundaryRepresentation& boundary,
                                const CurvedSource& from,
                                const surfaces::TessellateOptions& options, const Limits& limits) {
  auto result = surfaces::tessellate(boundary, options);
  if (!result) return std::move(result).error();
  DecimalVertices vertices = decimals_of(*result);
  const std::vector<Index> corners =
      options.keeps_strips ? result->arrays.ring_vertices : std::vector<Index>();
  auto solid = indexed_solid(std::move(result->arrays), vertices, from.source, limits);
  if (!solid) return solid;
  solid->tessellation = account_of(*result, options.chord);
  if (options.keeps_strips) {
    solid->tessellation->face_strips =
        strips_of(std::move(result->strips), corners, result->positions.size(), solid->solid);
  }
  if (from.srid == 0) return solid;
  auto placed = Solid::make(solid->solid.arrays(), solid->solid.lattice(), from.srid, limits);
  if (!placed) return std::move(placed).error();
  solid->solid = *std::move(placed);
  return solid;
}

/// solid_of() at the chord that was asked for; at half of it, and so on, while facets cross. A
/// solid without all faces is no better at a smaller chord.
Result<SubmittedSolid> uncrossed_solid(const surfaces::BoundaryRepresentation& boundary,
                                       const CurvedSource& from,
                                       surfaces::TessellateOptions options,
                                       const CurvedReading& reading, const Limits& limits) {
  auto first = solid_of(boundary, from, options, limits);
  if (!first || reading.has_crossing == nullptr || !first->tessellation->left_out.empty() ||
      !reading.has_crossing(first->solid)) {
    return first;
  }
  options.most_triangles = std::min(options.most_triangles, kMostTrialTriangles);
  for (int halvings = 1; halvings <= kMostHalvings; ++halvings) {
    options.chord /= 2;
    auto next = solid_of(boundary, from, options, limits);
    if (!next) break;  // as when the lattice is too coarse, or triangles are too many
    if (reading.has_crossing(next->solid)) continue;
    next->tessellation->halvings = halvings;
    return next;
  }
  return first;
}

}  // namespace

Status add_curved_solid(Result<surfaces::BoundaryRepresentation> boundary, CurvedSource from,
                        const ReadOptions& options, std::uint64_t& budget, Feature& feature) {
  if (!boundary) {
    if (boundary.error().code == ErrorCode::limit_exceeded) return boundary.error();
    feature.unreadable.push_back({std::move(from.source), std::move(boundary).error()});
    return Done{};
  }
  move_boundary(from.placement, *boundary);
  surfaces::TessellateOptions tessellate;
  tessellate.chord = options.curved.chord;
  tessellate.lattice_exponent = options.curved.lattice_exponent;
  tessellate.keeps_strips = options.curved.keeps_strips;
  tessellate.most_triangles = std::min({options.limits.facets, options.limits.vertices, budget});
  auto solid = uncrossed_solid(*boundary, from, tessellate, options.curved, options.limits);
  if (!solid) {
    if (solid.error().code == ErrorCode::invalid_argument) return solid.error();
    feature.unreadable.push_back({std::move(from.source), std::move(solid).error()});
    return Done{};
  }
  budget -= std::min<std::uint64_t>(budget, solid->solid.facet_count());
  feature.solids.push_back(*std::move(solid));
  return Done{};
}

}  // namespace watertight::formats
