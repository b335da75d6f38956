// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solid as submitted: immutable flat arrays of vertices, rings, facets and shells. The class
// guarantees that indices are in range, and nothing about geometry. For all other folders.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "geometry/lattice/lattice.h"
#include "geometry/point.h"

namespace watertight::geometry {

/// A half-open range of indices: those of the rings of a facet, or of the facets of a shell.
struct IndexRange {
  Index begin = 0;
  Index end = 0;
  Index size() const { return end - begin; }
};

/// The parts of a solid in flat arrays. Offsets start with 0 and end with the number of elements to
/// which they point: ring r is ring_vertices[ring_offsets[r] .. ring_offsets[r+1]).
struct SolidArrays {
  std::vector<Point> vertices;
  std::vector<Index> ring_vertices;
  std::vector<Index> ring_offsets{0};   // ring -> index of its first vertex in ring_vertices
  std::vector<Index> facet_offsets{0};  // facet -> rings; the first ring of a facet is exterior
  std::vector<Index> shell_offsets{0};  // shell -> facets; shell 0 is exterior

  void end_ring() { ring_offsets.push_back(static_cast<Index>(ring_vertices.size())); }
  void end_facet() { facet_offsets.push_back(static_cast<Index>(ring_offsets.size() - 1)); }
  void end_shell() { shell_offsets.push_back(static_cast<Index>(facet_offsets.size() - 1)); }
  friend bool operator==(const SolidArrays&, const SolidArrays&) = default;
};

/// Vertices that a source lists and no ring uses, where a reader leaves them out of the solid.
struct UnusedVertices {
  std::uint64_t count = 0;
  std::uint64_t first = 0;  // the index of the first unused vertex in the source
  std::array<double, 3> place{};
};

/// A solid with its lattice and coordinate reference system. The closing vertex of a ring is not
/// repeated. Rings may be short, facets may be empty, vertices may repeat or be unused: the
/// validator reports such defects as findings. Cheap to move, thread-safe to read.
class Solid {
 public:
  /// Errors: malformed if offsets are not monotone, an index is out of range, a coordinate is not
  /// finite or the lattice is not sane; limit_exceeded. A coordinate -0 becomes +0. Cost: linear.
  static Result<Solid> make(SolidArrays arrays, Lattice lattice, std::uint32_t srid,
                            const Limits& limits = {});

  std::span<const Point> vertices() const { return arrays_.vertices; }
  Index vertex_count() const { return static_cast<Index>(arrays_.vertices.size()); }
  Index ring_count() const { return static_cast<Index>(arrays_.ring_offsets.size() - 1); }
  Index facet_count() const { return static_cast<Index>(arrays_.facet_offsets.size() - 1); }
  Index shell_count() const { return static_cast<Index>(arrays_.shell_offsets.size() - 1); }

  /// The vertices of a ring, in order.
  std::span<const Index> ring(Index ring) const {
    return std::span<const Index>(arrays_.ring_vertices)
        .subspan(arrays_.ring_offsets[ring],
                 arrays_.ring_offsets[ring + 1] - arrays_.ring_offsets[ring]);
  }
  IndexRange rings_of(Index facet) const {
    return {arrays_.facet_offsets[facet], arrays_.facet_offsets[facet + 1]};
  }
  IndexRange facets_of(Index shell) const {
    return {arrays_.shell_offsets[shell], arrays_.shell_offsets[shell + 1]};
  }
  /// The shell that holds a facet. Cost: logarithmic.
  Index shell_of(Index facet) const;

  const SolidArrays& arrays() const { return arrays_; }
  const Lattice& lattice() const { return lattice_; }
  /// The EPSG code of the reference system, 0 when not stated.
  std::uint32_t srid() const { return srid_; }
  Box box() const { return box_of(arrays_.vertices); }
  std::array<double, 3> world(Index vertex) const {
    return lattice_.world(arrays_.vertices[vertex]);
  }

  friend bool operator==(const Solid&, const Solid&) = default;

 private:
  Solid(SolidArrays arrays, Lattice lattice, std::uint32_t srid)
      : arrays_(std::move(arrays)), lattice_(lattice), srid_(srid) {}

  SolidArrays arrays_;
  Lattice lattice_;
  std::uint32_t srid_ = 0;
};

/// A solid in which exactly equal vertices are merged (the first one is kept) and unused vertices
/// are dropped. `vertex_of[i]` is the new index of source vertex i, or kNone if it is unused.
struct MergedSolid {
  Solid solid;
  std::vector<Index> vertex_of;
};
MergedSolid merge_equal_vertices(const Solid& solid);

}  // namespace watertight::geometry

namespace watertight {

using geometry::IndexRange;
using geometry::Solid;
using geometry::SolidArrays;

}  // namespace watertight
