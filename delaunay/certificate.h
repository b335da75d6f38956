// SPDX-License-Identifier: GPL-3.0-or-later
//
// The independent certificate (docs/robustness.md, "What is proven"): checks, without trusting the
// engine, that a tetrahedralization is an embedded complex that conforms to a solid's boundary and
// leaves exactly one interior region. Source: Verbree & Si 2008, section 3.1.
#pragma once

#include <string>
#include <vector>

#include "base/cancel.h"
#include "delaunay/tetrahedralization.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::delaunay {

/// Which rung of the ladder produced the tetrahedralization.
enum class Rung : std::uint8_t {
  none = 255,
  delaunay = 0,      // the canonical DT itself
  patch = 1,         // CGAL, facets as patches
  patch_scaled = 2,  // the same after power-of-two scaling per axis
  triangles_scaled = 3,
  tetgen = 4
};
std::string_view to_string(Rung rung);

/// The accepted tetrahedralization with its proof data.
struct Certificate {
  Rung rung = Rung::none;
  Tetrahedralization tetrahedralization;
  std::vector<bool> is_interior;  // per tetrahedron
  double largest_deviation = 0;   // of a Steiner point from its facet, world units
  /// Facets that are not exactly planar and that the faces fill otherwise than the canonical
  /// triangulation: "valid within tolerance".
  std::vector<Index> refilled_facets;
};

/// Outcome of the check. Not accepted = `refusal` names the first failed item and the place.
enum class CertificateRefusal : std::uint8_t {
  none,
  not_a_complex,          // tetrahedra do not pair into a manifold, or one is not positive
  not_convex,             // the outer surface is not the convex hull
  vertex_missing,         // an input vertex is absent, moved or doubled
  not_a_boundary,         // a constrained face has one region on both sides, or parity conflicts
  interior_disconnected,  // more than one interior region (a property of the solid)
  cavity_mismatch,        // cavities and declared inner shells differ (a property of the solid)
  facet_not_conforming,   // a facet's faces are no disc with its rings as boundary
  not_a_manifold,         // faces of one shell meet at more edges or vertices than neighbours do
  foreign_face,           // a constrained face that belongs to no facet
  wrong_orientation,      // a declared normal points inward (a property of the solid)
  volume_mismatch,
  cancelled  // the caller did not want to know; says nothing
};
std::string_view to_string(CertificateRefusal refusal);

struct CertificateResult {
  CertificateRefusal refusal = CertificateRefusal::none;
  std::string detail;
  Index facet = kNone;
  /// As in the certificate, also with a refusal that comes after the facets were examined: then it
  /// speaks of another surface than the canonical triangulation, and is no property of the solid.
  std::vector<Index> refilled_facets;
  Certificate certificate;  // when refusal is none
};

/// Requires merged vertices, rings that are divided as the triangles are (divided_solid), `facets`
/// = triangulate_facets(solid), and a solid that passed the exact tests. `is_cancelled` is asked
/// every few thousand steps. Cost: O(n log n) in tetrahedra.
CertificateResult check_certificate(const Solid& solid, const tessellate::FacetTriangles& facets,
                                    Tetrahedralization tetrahedralization, Rung rung,
                                    const CancelPoll& is_cancelled = {});

}  // namespace watertight::delaunay
