// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decomposes a polyhedron into vertices, Steiner vertices, a bitmap of Delaunay faces and a list of
// unrecovered faces, step by step as in the paper. This is how the encoder writes mode bitmap.
// Source: Verbree & Si 2008, section 4.1, decomposition steps 1-7.
#pragma once

#include <optional>
#include <vector>

#include "codec/mode_bitmap/bit_coder.h"
#include "codec/mode_bitmap/face_marks.h"
#include "codec/mode_bitmap/facet_structure.h"
#include "delaunay/canonical_delaunay.h"
#include "delaunay/certificate.h"
#include "geometry/canonical_form.h"

namespace watertight::codec::bitmap {

/// The nodes of the CDT and its faces on the boundary.
struct BoundaryComplex {
  std::vector<Point> points;  // canonical vertices, then Steiner vertices, sorted
  Index vertex_count = 0;
  std::vector<Triangle> triangles;  // in no particular order, each of increasing vertices
  std::vector<Index> facet_of;      // triangle -> its facet in the canonical solid
  /// The tetrahedralization of step 4, if step 1 has made it already.
  std::optional<delaunay::CanonicalDelaunay> delaunay;
};

/// The sections that the decomposition makes.
struct Decomposition {
  Bytes vertices;
  Bytes steiner;  // empty without Steiner vertices
  BitCoding bitmap_coding = BitCoding::plain;
  Bytes bitmap;
  Bytes unrecovered;                  // empty if every boundary face is a Delaunay face
  std::optional<CodedFacets> facets;  // if nothing, the caller lists the facets
  FaceCounts counts;
};

/// True if the canonical Delaunay tetrahedralization of these points may be part of a blob: each
/// coordinate is 0 or of a magnitude in [2^-100, 2^100], integers or not.
bool has_storable_delaunay(std::span<const Point> points);

/// The most tetrahedra that a decoder accepts for `point_count` points, so that its time stays in
/// proportion to the blob.
std::uint64_t storable_tetrahedra(std::size_t point_count);

/// 1. Create a CDT of the polyhedron. With a certificate, this is the certified tetrahedralization.
/// Without one, the facets are triangulated along the Delaunay tetrahedralization, which needs no
/// Steiner vertex. Errors: not_encodable if a facet has no triangulation or the certificate is not
/// of this solid.
Result<BoundaryComplex> create_cdt(const geometry::CanonicalSolid& solid,
                                   const delaunay::Certificate* certificate,
                                   const CancelPoll& is_cancelled = {});

/// 2. Store the CDT's nodes: vertices and Steiner vertices.
void store_nodes(const BoundaryComplex& complex, Decomposition& result);

/// 3. Mark the CDT's faces on the boundary. Returns the marked faces, sorted.
/// Errors: not_encodable if two boundary triangles coincide.
Result<MarkedFaces> mark_cdt_faces(const BoundaryComplex& complex);

/// 4. Create the Delaunay tetrahedralization of the nodes.
/// Errors: not_encodable if it is flat or has too many tetrahedra.
Result<delaunay::CanonicalDelaunay> create_delaunay(const BoundaryComplex& complex,
                                                    const CancelPoll& is_cancelled = {});

/// 5. Mark the Delaunay faces that are marked CDT faces.
std::vector<bool> mark_delaunay_faces(const MarkedFaces& marked,
                                      const delaunay::CanonicalDelaunay& delaunay);

/// 6. Store the bitmap of marked and non-marked Delaunay faces, in the shorter of the two codings.
void store_bitmap(const delaunay::CanonicalDelaunay& delaunay, const std::vector<bool>& marks,
                  Decomposition& result);

/// 7. Store the marked CDT faces that are no Delaunay faces.
void store_unrecovered_faces(const MarkedFaces& marked, const delaunay::CanonicalDelaunay& delaunay,
                             Decomposition& result);

/// Does all steps and codes the facet structure. Errors: not_encodable, also when cancelled.
Result<Decomposition> decompose(const geometry::CanonicalSolid& solid,
                                const delaunay::Certificate* certificate,
                                const CancelPoll& is_cancelled = {});

}  // namespace watertight::codec::bitmap
