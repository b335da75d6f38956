// SPDX-License-Identifier: GPL-3.0-or-later
//
// The connectivity of a solid in mode `polygon`: oriented surfaces without boundary, each half-edge
// with its twin. A vertex where several fans of facets meet counts once per fan, so that the
// surface is a manifold also where parts of it touch. The walk over its facets codes it
// (docs/format-polygon.md). For the mode only.
#pragma once

#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/page/integer_solid.h"

namespace watertight::codec::polygon {

/// The half-edges of a ring are consecutive and in order. `vertex` of a half-edge is its origin.
struct PolygonSurface {
  std::vector<Index> vertex;            // half-edge -> vertex (one per fan)
  std::vector<Index> twin;              // half-edge -> its twin
  std::vector<Index> ring_of;           // half-edge -> ring
  std::vector<Index> facet_of;          // ring -> facet
  std::vector<Index> ring_offsets{0};   // ring -> its first half-edge; one more entry at the end
  std::vector<Index> facet_offsets{0};  // facet -> its first ring; one more entry at the end
  std::vector<Index> shell_offsets{0};  // shell -> its first facet; one more entry at the end
  std::vector<Index> degree;            // vertex -> number of its half-edges
  std::vector<Index> out_half;          // vertex -> the first of its half-edges in the walk

  Index vertex_count() const { return static_cast<Index>(degree.size()); }
  Index facet_count() const { return static_cast<Index>(facet_offsets.size() - 1); }
  Index ring_size(Index ring) const { return ring_offsets[ring + 1] - ring_offsets[ring]; }
  Index next(Index half) const {
    const Index ring = ring_of[half];
    return half + 1 == ring_offsets[ring + 1] ? ring_offsets[ring] : half + 1;
  }
  Index previous(Index half) const {
    const Index ring = ring_of[half];
    return half == ring_offsets[ring] ? ring_offsets[ring + 1] - 1 : half - 1;
  }
};

/// The surface of a solid as it is given: half-edge i starts at ring_vertices[i].
struct SurfaceTruth {
  PolygonSurface surface;
  std::vector<Index> vertex_of;   // fan -> vertex of the solid
  std::vector<Index> first_half;  // shell -> the half-edge at which the walk begins
};

/// Makes the surface of a solid. Errors: not_encodable if a shell has no facets, or an edge of a
/// ring is not matched by an edge of the same shell. Cost: O(n log n).
Result<SurfaceTruth> surface_of(const IntegerSolid& solid, const PageMemory& memory);

/// The surface in the order of the walk and, when writing, the fans of the truth.
struct WalkedSurface {
  PolygonSurface surface;
  std::vector<Index> exterior;      // facet -> its exterior ring
  std::vector<Index> truth_vertex;  // vertex -> fan of the truth; empty when reading
};

/// Codes a surface. `truth` is null when reading. Errors: malformed, limit_exceeded; not_encodable
/// where too many fans of facets meet in one vertex. Cost: linear.
Result<WalkedSurface> code_surface(EntropyStream& stream, ModelBank& models,
                                   const SurfaceTruth* truth, const Limits& limits);

}  // namespace watertight::codec::polygon
