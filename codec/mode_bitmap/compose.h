// SPDX-License-Identifier: GPL-3.0-or-later
//
// Composes a polyhedron from its nodes, the bitmap and the unrecovered faces, step by step as in
// the paper. This is how the decoder reads mode bitmap; it trusts nothing. Source: Verbree & Si
// 2008, section 4.1, composition steps 1-7.
#pragma once

#include <vector>

#include "base/bytes.h"
#include "base/limits.h"
#include "codec/mode_bitmap/bit_coder.h"
#include "codec/mode_bitmap/face_marks.h"
#include "delaunay/canonical_delaunay.h"
#include "geometry/solid.h"

namespace watertight::codec::bitmap {

/// The sections of a solid in mode bitmap, as views.
struct BitmapSections {
  ByteView vertices;
  ByteView steiner;  // empty without Steiner vertices
  BitCoding bitmap_coding = BitCoding::plain;
  ByteView bitmap;
  ByteView unrecovered;  // empty if every boundary face is a Delaunay face
  BitCoding facet_coding = BitCoding::plain;
  bool lists_facets = false;
  ByteView facets;
};

/// The vertices of the solid, then the Steiner points.
struct Nodes {
  std::vector<Point> points;
  Index vertex_count = 0;  // the number of vertices of the solid
};

struct Composition {
  SolidArrays arrays;  // the exterior shell and exterior rings come first
  FaceCounts counts;
};

/// 1. Read the CDT's nodes. Errors: malformed; limit_exceeded.
Result<Nodes> read_nodes(const BitmapSections& sections, const Limits& limits);

/// 2. Create the Delaunay tetrahedralization of the nodes.
/// Errors: malformed where an encoder would not have chosen mode bitmap.
Result<delaunay::CanonicalDelaunay> create_delaunay(const Nodes& nodes, const Limits& limits = {});

/// 3. Read the bitmap: the marks. Errors: malformed.
Result<std::vector<bool>> read_bitmap(const BitmapSections& sections,
                                      const delaunay::CanonicalDelaunay& delaunay);

/// 4. Order the Delaunay faces (canonical_delaunay() returns them in order) and mark each as the
/// bitmap says.
/// 5. Create the polygonal surface out of the marked Delaunay faces. Returns the marked faces,
/// sorted.
std::vector<Triangle> create_surface(const delaunay::CanonicalDelaunay& delaunay,
                                     const std::vector<bool>& marks);

/// 6. Read the unrecovered faces. Errors: malformed.
Result<std::vector<Triangle>> read_unrecovered_faces(const BitmapSections& sections,
                                                     std::size_t point_count);

/// 7. Complete the surface with the unrecovered faces, and make rings, holes and shells of it as
/// the facet section says. Errors: malformed; limit_exceeded.
Result<SolidArrays> complete_boundary(const BitmapSections& sections, const Nodes& nodes,
                                      std::vector<Triangle> surface,
                                      const std::vector<Triangle>& unrecovered,
                                      const Limits& limits);

/// Does all steps. Errors: malformed; limit_exceeded.
Result<Composition> compose(const BitmapSections& sections, const Limits& limits);

}  // namespace watertight::codec::bitmap
