// SPDX-License-Identifier: GPL-3.0-or-later
//
// The validator (docs/robustness.md, "What is proven"; Verbree & Si 2008, section 3): runs every
// rule on a solid, reports all findings, and is the only maker of a ValidSolid.
#pragma once

#include <optional>
#include <span>

#include "delaunay/ladder.h"
#include "geometry/placement.h"
#include "geometry/valid_solid.h"
#include "validate/report.h"
#include "validate/source/source_elements.h"

namespace watertight::validate {

struct CertifyOptions {
  Tolerances tolerances;
  Proof proof = Proof::tetrahedralization;
  Limits limits;
  delaunay::LadderOptions ladder;
  /// Submitted vertices whose source digits were rounded (SubmittedSolid::rounded): warning 805.
  std::span<const Index> rounded = {};
  /// True if the origin was rounded, which moved all points of the solid together
  /// (SubmittedSolid::is_origin_rounded): warning 805.
  bool is_origin_rounded = false;
  /// Vertices that the reader left out (SubmittedSolid::unused): warning 802.
  geometry::UnusedVertices unused = {};
  /// Rings that their source left open (SubmittedSolid::unclosed_rings): finding 103.
  std::span<const Index> unclosed_rings = {};
  /// Why the reader could not read the solid (SubmittedSolid::unreadable), "" if it did: finding
  /// 901 and no other.
  std::string unreadable = {};
  /// The elements that findings name.
  SourceElements elements = {};
  /// The placement of an instance of a geometry template; null for other solids. The solid is
  /// judged as placed: the exact sign of the determinant gives the orientation, metres are measured
  /// in the world; a determinant of zero gives 306 and 806. The caller keeps the object alive.
  const geometry::Placement* placement = nullptr;
  /// True if the template has passed with proof under another placement with a determinant of the
  /// same sign: no proof depends on a measurement, so the exact tests suffice.
  /// Inspection::certified is then absent.
  bool is_proven = false;
  bool also_tolerant = false;  // true: also fill Report::tolerant
  /// The snap distance of Report::tolerant, metres, above 0; val3dity's default.
  double tolerant_snap_metres = 0.001;
  /// The severity of findings in surfaces (validate/surface/inspect_surface.h): warnings leave the
  /// verdict of the feature as it is.
  Severity severity_of_surfaces = Severity::warning;
  /// The number of threads that search for intersections within the solid; the report does not
  /// depend on this number.
  unsigned threads = 1;
};

/// A solid that passed, with its proof.
struct Certified {
  ValidSolid solid;
  std::optional<delaunay::Certificate> certificate;  // absent when proof is `boundary`
};

struct Inspection {
  Report report;
  /// Present if the verdict is valid and there is neither a placement nor `is_proven`.
  std::optional<Certified> certified;
  /// Present if the verdict is valid and there is a placement, but not `is_proven`: the solid in
  /// the coordinates of the template, turned over if the placement mirrors. For comparisons with
  /// other solids.
  std::optional<ValidSolid> unplaced;
};

/// Whether the facets of a solid intersect where they must not (findings 306 and 401). Exact. Cost:
/// O(n log n) for n triangles.
bool has_crossing_facets(const Solid& solid);

/// Validates a solid. Never fails: the report lists the rules that could not be evaluated.
/// Deterministic except for `seconds` and time-outs of engines. `workers` may be null (rung 0
/// only). Thread-safe.
Inspection certify(const Solid& solid, delaunay::EngineWorkers* workers,
                   const CertifyOptions& options = {});

}  // namespace watertight::validate

namespace watertight {

using validate::certify;
using validate::CertifyOptions;
using validate::Inspection;

}  // namespace watertight
