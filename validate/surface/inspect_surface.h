// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surfaces: geometries whose facets need not close. The rules of rings and facets apply to them;
// whether they would be a solid is information (docs/decisions/0024-surfaces.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh/closure.h"
#include "validate/certify.h"

namespace watertight::validate {

/// What is known about a surface beside its findings.
struct SurfaceFacts {
  geometry::Closure closure;
  /// The verdict on the solid that the surface bounds; present if its facets are one closed shell.
  std::optional<Verdict> as_solid = {};
  std::vector<int> solid_codes = {};  // the errors of that solid, ascending
};

struct SurfaceInspection {
  /// The findings. The verdict is valid where they are warnings; else invalid if there is one, and
  /// undecided if a facet could not be measured.
  Report report;
  SurfaceFacts facts;
};

/// Applies rules 101 to 208, 901 and 902 to a surface, whose facets are in one shell of `surface`.
/// Findings have the severity options.severity_of_surfaces. A surface that is one closed shell is
/// also judged as a solid, by the exact tests alone (Proof::boundary): they prove one shell. Never
/// fails. Deterministic except for `seconds`. Thread-safe. Cost: of an open surface O(n log n).
SurfaceInspection inspect_surface(const Solid& surface, const CertifyOptions& options);

/// The facts in words: "closed: would be a valid solid", "open: 12 edges that two facets do not
/// share".
std::string surface_words(const SurfaceFacts& facts);

}  // namespace watertight::validate
