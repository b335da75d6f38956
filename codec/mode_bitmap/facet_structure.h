// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads the compact facet section of mode bitmap (docs/format-plain.md, "Mode bitmap"):
// one bit for each joint says whether it lies inside a facet; a few more bits say how components
// turn, and which components and rings are exterior. If the section cannot bring the solid back,
// the caller lists facets.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "codec/mode_bitmap/bit_coder.h"
#include "geometry/solid.h"

namespace watertight::codec::bitmap {

/// A triangulated boundary: strictly increasing triangles of three increasing vertices, and the
/// facet of the solid that each belongs to.
struct MarkedFaces {
  std::vector<Triangle> triangles;
  std::vector<Index> facet_of;
};

struct CodedFacets {
  BitCoding coding = BitCoding::plain;
  Bytes bytes;
};

/// Writes the facet section in the shorter of the two codings. Returns nothing if the section would
/// not bring `canonical` back. `points` are the vertices of the solid, then the Steiner vertices.
/// Cost: O(n log n).
std::optional<CodedFacets> write_facet_structure(std::span<const Point> points,
                                                 const MarkedFaces& faces, const Solid& canonical);

/// Reads the arrays of facets, rings and shells of the solid bounded by `triangles`; the result has
/// no vertices. The exterior shell and exterior rings come first; the rest is in no particular
/// order. Errors: malformed.
Result<SolidArrays> read_facet_structure(ByteView section, BitCoding coding,
                                         std::span<const Point> points,
                                         std::span<const Triangle> triangles, Index vertex_count);

}  // namespace watertight::codec::bitmap
