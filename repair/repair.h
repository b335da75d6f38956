// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes invalid solids valid by the least change. Remedies are tried in growing sets; the first
// result that the validator accepts is taken, and nothing else is called repaired.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "repair/remedies.h"
#include "validate/certify.h"

namespace watertight::repair {

/// The remedies in the order in which they are tried. The first three guess nothing.
enum class Remedy : std::uint8_t { rings, orientation, junctions, weld, facets, fill, smooth };
inline constexpr std::array kAllRemedies{Remedy::rings, Remedy::orientation, Remedy::junctions,
                                         Remedy::weld,  Remedy::facets,      Remedy::fill,
                                         Remedy::smooth};
std::string_view to_string(Remedy remedy);
/// The remedies of a list, parted by commas ("rings,fill"), in their order; "all" stands for all
/// but `smooth`, which makes vertices that nobody measured. Errors: invalid_argument for an unknown
/// or empty name.
Result<std::vector<Remedy>> remedies_of(std::string_view list);

struct RepairOptions {
  std::vector<Remedy> remedies{Remedy::rings, Remedy::orientation, Remedy::junctions};
  double weld_metres = 0;        // the largest move of a vertex by Remedy::weld; 0: none
  std::size_t most_islands = 4;  // the most islands of a hole that is filled by an optimum
  SmoothOptions smooth;          // of Remedy::smooth
  CertifyOptions certify;
};

struct Repaired {
  enum class Outcome : std::uint8_t { valid_as_read, repaired, not_repaired };
  Outcome outcome = Outcome::not_repaired;
  bool is_stopped = false;  // cancelled before all sets of remedies were tried
  /// Of a solid that is not repaired: why the first mended one that is undecided is not known to be
  /// valid; empty if there is none.
  std::string undecided_reason;
  validate::Report before;           // on the solid as it was submitted
  std::optional<Inspection> after;   // on the repaired solid; absent unless it was repaired
  std::optional<EditedSolid> edits;  // the facets of the repaired solid and where they came from
  std::vector<Remedy> remedies;      // those that changed something
  Moves moves;                       // by Remedy::weld
  std::vector<HoleFill> holes;       // without a repair those of the first set that fills holes
};

/// A repaired solid on the vertices of the submitted one, all of them in their order, and after
/// them those that Remedy::smooth made. The lattice is that of the submitted solid or a finer one.
struct OnSubmittedVertices {
  Solid solid;
  std::vector<Index> facet_source;  // facet -> facet of the submitted solid, kNone for a new one
};
/// Requires edits of that solid. Errors: limit_exceeded. Cost: O(n log n).
Result<OnSubmittedVertices> on_submitted_vertices(const Solid& submitted, const EditedSolid& edits);

/// Repairs a solid. Never fails. Deterministic but for time limits of engines and
/// LadderOptions::cancel, which ends the repair. Cost: that of validating it once for each set of
/// remedies.
Repaired repair(const Solid& solid, delaunay::EngineWorkers* workers, const RepairOptions& options);

}  // namespace watertight::repair
