// SPDX-License-Identifier: GPL-3.0-or-later
//
// Curved solids as polyhedra without cracks: each edge is sampled once, and its points are vertices
// of both faces.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "geometry/solid.h"
#include "surfaces/boundary_representation.h"
#include "surfaces/face_strips.h"

namespace watertight::surfaces {

struct TessellateOptions {
  double chord = 0.01;  // metres: how far triangles may be from the surface, and chords from edges
  /// The step of the lattice of vertices, as a power of ten of a metre; nothing: the largest that
  /// is not above a hundredth of the chord.
  std::optional<int> lattice_exponent = {};
  bool keeps_strips = false;                // in TessellatedBoundary::strips
  std::size_t most_triangles = 10'000'000;  // of a solid
};

/// A face that is missing in the result, and why.
struct LeftOutFace {
  std::string name;
  std::string reason;
};

struct TessellationMeasures {
  std::uint64_t faces = 0;
  std::uint64_t edges = 0;
  std::uint64_t samples = 0;    // vertices on edges, ends included
  std::uint64_t triangles = 0;  // of curved faces
  double chord_error = 0;       // metres: the largest measured distance from a surface
  double gap = 0;             // metres: the largest distance of an edge from a surface of its faces
  int rounds = 1;             // of sampling edges
  std::uint64_t turned = 0;   // faces whose loops run against those of their neighbours
  std::uint64_t strips = 0;   // of the triangles of curved faces
  std::uint64_t indices = 0;  // of all strips
  double mean_least_angle = 0;  // degrees: of the triangles of curved faces; 0 without any
  double worst_least_angle = 0;
};

struct TessellatedBoundary {
  /// Planar faces as polygons with rings, curved faces as triangles. Ring vertices are indices into
  /// `positions`; SolidArrays::vertices is empty.
  SolidArrays arrays;
  std::vector<std::array<std::int64_t, 3>> positions;  // in steps of the lattice, all different
  int lattice_exponent = -4;
  TessellationMeasures measures;
  std::vector<LeftOutFace> left_out;
  /// The strips of each curved face, whose vertices are indices into `positions`.
  std::vector<FaceStrips> strips;
};

/// Tessellates a solid. Edges whose chords cross in a face are sampled more densely, at most 8
/// times. Errors: invalid_argument for a chord that is not positive; limit_exceeded; malformed for
/// an index that names nothing. Cost: O(n log n) for n triangles.
Result<TessellatedBoundary> tessellate(const BoundaryRepresentation& solid,
                                       const TessellateOptions& options = {});

}  // namespace watertight::surfaces
