// SPDX-License-Identifier: GPL-3.0-or-later
//
// The input of the entropy coded modes: a solid whose coordinates are whole numbers of lattice
// steps in the frame of its page, as flat arrays like those of Solid.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/solid.h"

namespace watertight::codec {

/// A grid point: whole lattice steps from the phase of the page's grid, on each axis. Magnitudes
/// are below 2^53.
using GridPoint = std::array<std::int64_t, 3>;

/// A solid whose vertices are grid points. Shell 0 is the exterior shell, and the first ring of a
/// facet is its exterior ring. A solid that is written is in canonical form
/// (geometry/canonical_form.h). A mode may decode vertices, facets, interior shells and interior
/// rings in any order: the caller brings them into canonical form.
struct IntegerSolid {
  std::vector<GridPoint> vertices;
  std::vector<Index> ring_vertices;     // the vertices of all rings, ring by ring
  std::vector<Index> ring_offsets{0};   // ring -> its first index in ring_vertices
  std::vector<Index> facet_offsets{0};  // facet -> its first ring
  std::vector<Index> shell_offsets{0};  // shell -> its first facet

  Index ring_count() const { return static_cast<Index>(ring_offsets.size() - 1); }
  Index facet_count() const { return static_cast<Index>(facet_offsets.size() - 1); }
  Index shell_count() const { return static_cast<Index>(shell_offsets.size() - 1); }
  std::span<const Index> ring(Index number) const {
    return std::span(ring_vertices)
        .subspan(ring_offsets[number], ring_offsets[number + 1] - ring_offsets[number]);
  }
};

/// The grid that the solids of a page share: a step and a phase for each axis. The phase is the
/// rest of the lattice's origin divided by its step (0 if the origin is a multiple of the step).
/// Where coordinates counted from that phase would reach 2^53, the phase is the origin of the
/// solid's lattice.
struct PageGrid {
  LatticeKind kind = LatticeKind::decimal;
  std::array<GridNumber, 3> step{};
  std::array<GridNumber, 3> phase{};
  friend auto operator<=>(const PageGrid&, const PageGrid&) = default;
};

/// A solid on the grid of its page. `origin` is the grid point where the solid's lattice begins.
struct GriddedSolid {
  PageGrid grid;
  GridPoint origin{};
  IntegerSolid solid;
};

/// The lattice of `grid` whose origin is the grid point `origin`. Errors: malformed if a number of
/// the lattice is out of range.
Result<Lattice> lattice_at(const PageGrid& grid, const GridPoint& origin);

/// Puts a canonical solid on the grid of its lattice. Returns nothing if the lattice is of kind
/// float64 or a coordinate is no integer of magnitude below 2^53: only modes raw and bitmap hold
/// such a solid. Cost: linear.
std::optional<GriddedSolid> grid_solid(const Solid& canonical);

/// Returns the solid of `gridded`, with its arrays in the order of `gridded`. Requires indices in
/// range.
/// Errors: malformed if a coordinate or the lattice leaves its range; limit_exceeded.
Result<Solid> ungrid_solid(const GriddedSolid& gridded, std::uint32_t srid, const Limits& limits);

/// The values that the solids of a page so far leave for the next one; empty at the start of a
/// page.
struct PageMemory {
  GridPoint last_position{};  // the smallest vertex of the solid before
  std::vector<std::array<std::int64_t, 2>>
      columns;  // (x, y) of all vertices so far, each once, sorted
  bool is_first() const { return columns.empty(); }
  /// Adds the vertices of a coded solid. Cost: O(columns + n log n) for n vertices.
  void add(const IntegerSolid& solid);
};

}  // namespace watertight::codec
