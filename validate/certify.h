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

namespace watertight::validate {

struct CertifyOptions {
  Tolerances tolerances;
  Proof proof = Proof::tetrahedralization;
  Limits limits;
  delaunay::LadderOptions ladder;
  /// Submitted vertices whose source digits were rounded (SubmittedSolid::rounded): warning 805.
  std::span<const Index> rounded = {};
  /// Rounding its origin moved the whole, not its shape (SubmittedSolid::is_origin_rounded): 805.
  bool is_origin_rounded = false;
  /// Vertices that the reader left out (SubmittedSolid::unused): warning 802.
  geometry::UnusedVertices unused = {};
  /// Rings that their source left open (SubmittedSolid::unclosed_rings): finding 103.
  std::span<const Index> unclosed_rings = {};
  /// Where an instance puts a geometry template; null for other solids. The solid is judged as
  /// placed: the determinant's exact sign gives the orientation, metres are measured there; a
  /// determinant of zero is 306 and 806. Kept by the caller.
  const geometry::Placement* placement = nullptr;
  /// True if the same template has passed with proof under another placement with a determinant of
  /// the same sign: no proof depends on a measurement, so the exact tests suffice. `certified` is
  /// then absent.
  bool is_proven = false;
  bool also_tolerant = false;  // fill Report::tolerant
  /// For the search of intersections within one solid; the report does not depend on it.
  unsigned threads = 1;
};

/// A solid that passed, with what proves it.
struct Certified {
  ValidSolid solid;
  std::optional<delaunay::Certificate> certificate;  // absent when proof is `boundary`
};

struct Inspection {
  Report report;
  /// Present exactly when the verdict is valid and the solid stands where it is.
  std::optional<Certified> certified;
  /// With a placement, present when the verdict is valid but for `is_proven`: the solid as the
  /// template has it, turned over by a mirroring placement. For comparisons with other solids.
  std::optional<ValidSolid> unplaced;
};

/// Never fails: the report says what could not be evaluated. Deterministic but for `seconds` and
/// time-outs of engines. `workers` may be null (rung 0 only). Thread-safe.
Inspection certify(const Solid& solid, delaunay::EngineWorkers* workers,
                   const CertifyOptions& options = {});

}  // namespace watertight::validate

namespace watertight {

using validate::certify;
using validate::CertifyOptions;
using validate::Inspection;

}  // namespace watertight
