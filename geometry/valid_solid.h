// SPDX-License-Identifier: GPL-3.0-or-later
//
// Validity as a type (docs/architecture.md): a ValidSolid exists only because the validator made
// it, and it is the only thing that the public encoder takes.
#pragma once

#include <cstdint>
#include <utility>

#include "geometry/solid.h"

namespace watertight::validate {
class Certifier;
}  // namespace watertight::validate

namespace watertight::geometry {

/// The tolerances under which a solid was certified, in the units that their names say. They
/// measure; no decision about side, order or crossing uses them.
struct Tolerances {
  double planarity_metres = 0.01;   // the largest distance of a vertex from its fitted plane
  double planarity_degrees = 20.0;  // the largest angle between two triangles of a facet
  double snap_metres = 0.0;         // the snap distance; with 0, only equal vertices are merged
  friend bool operator==(const Tolerances&, const Tolerances&) = default;
};

/// The kind of proof that the boundary encloses one connected interior.
enum class Proof : std::uint8_t {
  tetrahedralization = 0,  // a certified constrained Delaunay tetrahedralization
  boundary = 1             // exact tests only
};

/// The number of the rule set that this program applies. A changed rule raises the number.
inline constexpr std::uint16_t kRuleSet = 1;

/// The rules and tolerances under which a valid solid was accepted; they are stored with the solid.
struct Acceptance {
  Tolerances tolerances;
  Proof proof = Proof::tetrahedralization;
  std::uint16_t rule_set = kRuleSet;
  friend bool operator==(const Acceptance&, const Acceptance&) = default;
};

/// A boundary that is closed and oriented by edges: every directed edge of a ring is met by its
/// reverse exactly as often, as submitted or with divided rings (geometry/divided_rings.h). The
/// class promises nothing about geometry. The codec works on boundaries, and so do benchmarks on
/// meshes with defects.
class OrientedBoundary {
 public:
  /// Errors: not_encodable, if the solid or a shell has no facets or a facet has no rings, if a
  /// ring has fewer than 3 vertices or a vertex twice, if equal vertices are not merged, or if an
  /// edge is unmatched (the message names the first).
  static Result<OrientedBoundary> make(Solid solid);
  const Solid& solid() const { return solid_; }

 private:
  explicit OrientedBoundary(Solid solid) : solid_(std::move(solid)) {}
  Solid solid_;
};

/// A solid that certify() (validate/certify.h) accepted: oriented outward, equal vertices merged,
/// facets, rings and vertices in source order.
class ValidSolid {
 public:
  const OrientedBoundary& boundary() const { return boundary_; }
  const Solid& solid() const { return boundary_.solid(); }
  const Acceptance& acceptance() const { return acceptance_; }

 private:
  friend class validate::Certifier;  // the only class that makes a ValidSolid
  ValidSolid(OrientedBoundary boundary, Acceptance acceptance)
      : boundary_(std::move(boundary)), acceptance_(acceptance) {}
  OrientedBoundary boundary_;
  Acceptance acceptance_;
};

}  // namespace watertight::geometry

namespace watertight {

using geometry::Acceptance;
using geometry::OrientedBoundary;
using geometry::Proof;
using geometry::Tolerances;
using geometry::ValidSolid;

}  // namespace watertight
