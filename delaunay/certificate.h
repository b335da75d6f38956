// SPDX-License-Identifier: GPL-3.0-or-later
//
// The independent certificate (docs/robustness.md, "What is proven"): checks, without trusting the
// engine, that a tetrahedralization is an embedded complex that conforms to a solid's boundary and
// leaves exactly one interior region. Source: Verbree & Si 2008, section 3.1.
#pragma once

#include <string>
#include <vector>

#include "base/cancel.h"
#include "delaunay/rung.h"
#include "delaunay/tetrahedralization.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::delaunay {

/// The accepted tetrahedralization with its proof data.
struct Certificate {
  Rung rung = Rung::none;
  Tetrahedralization tetrahedralization;
  std::vector<bool> is_interior;  // tetrahedron -> whether it is in the interior
  double largest_deviation = 0;   // the largest distance of a Steiner point from its facet, world
                                  // units
  /// Facets that are not exactly planar and that the faces fill with other triangles than the
  /// canonical ones: "valid within tolerance".
  std::vector<Index> refilled_facets;
  /// True if the tetrahedralization is that of a solid with the same surface, in which neighbouring
  /// facets in one plane are one facet, and vertices inside such a facet are left out.
  bool has_merged_facets = false;
};

/// Outcome of the check. Unless accepted, `refusal` names the first item that fails, and `detail`
/// and `facet` name the place.
struct CertificateResult {
  CertificateRefusal refusal = CertificateRefusal::none;
  std::string detail;
  Index facet = kNone;
  /// The same as Certificate::refilled_facets. If this list is not empty after a refusal, the
  /// refusal concerns another surface than the canonical one, so the refusal says nothing about the
  /// solid. (A refusal before the facets are examined leaves the list empty.)
  std::vector<Index> refilled_facets;
  Certificate certificate;  // set if `refusal` is none
};

/// Checks a tetrahedralization of a solid. Requires merged vertices, rings that are divided as the
/// triangles are (divided_solid), `facets` = triangulate_facets(solid), and a solid that passed the
/// exact tests. `is_cancelled` is asked every few thousand steps. Cost: O(n log n) in tetrahedra.
CertificateResult check_certificate(const Solid& solid, const tessellate::FacetTriangles& facets,
                                    Tetrahedralization tetrahedralization, Rung rung,
                                    const CancelPoll& is_cancelled = {});

}  // namespace watertight::delaunay
