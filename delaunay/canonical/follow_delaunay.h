// SPDX-License-Identifier: GPL-3.0-or-later
//
// The triangulation of each facet that follows the canonical Delaunay tetrahedralization: as many
// of its triangles as possible are Delaunay faces. A facet's triangulation is no part of a solid,
// so the codec's bitmap mode is free to take this one (fewer unrecovered faces), and rung 0 of the
// CDT ladder asks whether every facet is a union of Delaunay faces. Decoding does not need it: the
// marks and the list of unrecovered faces say which triangles were taken.
#pragma once

#include <span>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "delaunay/canonical_delaunay.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::delaunay {

/// Triangles grouped by facet, with the facet's orientation. Each triangle starts with its smallest
/// index; the triangles of one facet are sorted.
struct FollowingTriangles {
  std::vector<Triangle> triangles;
  std::vector<Index> facet_of;  // triangle -> facet
  std::vector<Index> first{0};  // facet -> first triangle; facet_count + 1 entries
  /// Facet -> the number of its triangles that are no faces of the Delaunay tetrahedralization.
  std::vector<Index> missing;
  /// Triangle -> its index in CanonicalDelaunay::faces, or kNone.
  std::vector<Index> delaunay_face;
  /// The sum of `missing` over all facets.
  Index missing_total = 0;
};

/// Triangulates each facet along the Delaunay tetrahedralization. Requires merged vertices,
/// `canonical` = triangulate_facets(merged), or those divided at contacts (divide_at_contacts),
/// rings that are divided as the triangles are (divided_solid), and `delaunay` =
/// canonical_delaunay(merged.vertices()). A facet without canonical triangles gets none here.
/// Guarantees: the triangles of a facet use exactly the vertices of `canonical` and cover, in the
/// projection facet_projection(), the region between its rings exactly once. A facet that lies
/// exactly in a plane and is a union of Delaunay faces is found with missing = 0, as is every other
/// such facet of one ring with at most 60 vertices, where `missing` is the least possible. The set
/// of triangles is the same for every numbering of vertices, facets and rings. Cost: O(n log n) for
/// facets that are unions of Delaunay faces, O(k^3) for one ring of k <= 60 vertices; all others
/// take the canonical triangles, improved by at most 3 k edge flips. Source: research of this
/// project; Verbree & Si 2008, section 5, leave the choice of the facets' triangulation open.
FollowingTriangles follow_delaunay(const Solid& merged, const tessellate::FacetTriangles& canonical,
                                   const CanonicalDelaunay& delaunay);

/// Does the same as the function above, but asks every few thousand triangles whether to go on, and
/// keeps the canonical triangles of each facet for which `is_kept` is true (empty: of none).
/// Errors: cancelled.
Result<FollowingTriangles> follow_delaunay(const Solid& merged,
                                           const tessellate::FacetTriangles& canonical,
                                           const CanonicalDelaunay& delaunay,
                                           const std::vector<bool>& is_kept,
                                           const CancelPoll& is_cancelled);

/// Two facets that are not planar may follow the same Delaunay face; their canonical triangles
/// differ wherever the solid is valid. Adds each facet that has a triangle in common with another
/// one to `is_kept` (an entry for each facet). False if there is none to add. Cost: O(n log n).
bool part_equal_triangles(std::span<const Triangle> triangles, std::span<const Index> facet_of,
                          std::vector<bool>& is_kept);

}  // namespace watertight::delaunay
