// SPDX-License-Identifier: GPL-3.0-or-later
//
// The compact facet section of mode bitmap: one flag per edge between two boundary triangles says
// whether the edge lies inside a facet; orientation and exterior marks take a few bits more
// (docs/format-plain.md, "Facets"). Where this cannot tell the solid, the caller lists facets.
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

/// The shorter of the plain and the arithmetic coding, or nothing if the section would not bring
/// `canonical` back. `points` are its vertices and the Steiner vertices after them.
/// Cost: O(n log n).
struct CodedFacets {
  BitCoding coding = BitCoding::plain;
  Bytes bytes;
};
std::optional<CodedFacets> write_facet_structure(std::span<const Point> points,
                                                 const MarkedFaces& faces, const Solid& canonical);

/// Facet, ring and shell arrays of the solid bounded by `triangles`; no vertices; facets and shells
/// in no particular order but the exterior first. Errors: malformed.
Result<SolidArrays> read_facet_structure(ByteView section, BitCoding coding,
                                         std::span<const Point> points,
                                         std::span<const Triangle> triangles, Index vertex_count);

}  // namespace watertight::codec::bitmap
