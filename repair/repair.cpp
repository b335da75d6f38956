// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repair.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

namespace watertight::repair {
namespace {

// Facets that the metric rules refuse: not flat (203), folded (204).
constexpr std::array<int, 2> kBentFacet{203, 204};

/// A set of remedies that is tried.
struct Attempt {
  bool has_orientation = false;
  bool has_junctions = false;
  double weld_metres = 0;
  bool has_facets = false;
  bool has_fill = false;
  bool prefers_plan = false;  // holes are filled in plan rather than by the least angles
  bool joins_parts = false;   // parts of a shell are joined by tubes
};

bool has(const RepairOptions& options, Remedy remedy) {
  return std::ranges::find(options.remedies, remedy) != options.remedies.end();
}

/// The sets in the order in which they are tried: what guesses nothing, then welding and triangles
/// for bent facets, then all that again with filled holes.
std::vector<Attempt> attempts_of(const RepairOptions& options) {
  std::vector<double> welds{0};
  if (has(options, Remedy::weld) && options.weld_metres > 0) {
    welds.push_back(options.weld_metres / 10);
    welds.push_back(options.weld_metres);
  }
  const bool has_orientation = has(options, Remedy::orientation);
  const bool has_junctions = has(options, Remedy::junctions);
  std::vector<Attempt> attempts;
  attempts.push_back({});
  if (has_orientation) attempts.push_back({true});
  if (has_junctions) attempts.push_back({has_orientation, true});
  for (const bool fill : {false, true}) {
    if (fill && !has(options, Remedy::fill)) break;
    for (const double weld : welds) {
      for (const bool facets : {false, true}) {
        if (facets && !has(options, Remedy::facets)) break;
        if (!fill && !facets && weld == 0) continue;
        Attempt attempt{has_orientation, has_junctions, weld, facets, fill, false, false};
        attempts.push_back(attempt);
        if (!fill) continue;
        attempt.prefers_plan = true;
        attempts.push_back(attempt);
        attempt.prefers_plan = false;
        attempt.joins_parts = true;
        attempts.push_back(attempt);
      }
    }
  }
  return attempts;
}

/// The facets that a report refuses for their shape.
std::vector<Index> bent_facets(const validate::Report& report) {
  std::vector<Index> facets;
  for (const Finding& finding : report.findings) {
    const bool is_bent = std::ranges::find(kBentFacet, finding.code) != kBentFacet.end();
    if (is_bent && finding.place.facet != kNone) facets.push_back(finding.place.facet);
  }
  return facets;
}

class Trial {
 public:
  Trial(const Solid& solid, delaunay::EngineWorkers* workers, const RepairOptions& options)
      : start_(edited(solid)), workers_(workers), options_(options) {}

  /// Applies a set of remedies. True if the result is valid.
  bool run(const Attempt& attempt, Repaired& repaired) {
    EditedSolid work = start_;
    std::vector<Remedy> changed;
    Moves moves;
    const auto note = [&](Remedy remedy, std::size_t changes) {
      if (changes > 0 && std::ranges::find(changed, remedy) == changed.end()) {
        changed.push_back(remedy);
      }
    };
    if (has(options_, Remedy::rings)) note(Remedy::rings, mend_rings(work));
    if (attempt.has_orientation) note(Remedy::orientation, orient(work));
    if (attempt.weld_metres > 0) note(Remedy::weld, weld(work, attempt.weld_metres, moves));
    if (attempt.has_junctions) note(Remedy::junctions, insert_junctions(work));
    std::vector<HoleFill> holes;
    if (attempt.has_fill) {
      holes = fill_holes(work,
                         {options_.certify.tolerances, options_.most_islands, attempt.prefers_plan,
                          attempt.joins_parts, options_.certify.ladder.cancel});
      if (attempt.joins_parts && holes.empty()) return false;
      if (first_holes_.empty()) first_holes_ = holes;
      note(Remedy::fill, static_cast<std::size_t>(std::ranges::count_if(
                             holes, [](const HoleFill& hole) { return hole.facets > 0; })));
    }
    if (attempt.has_orientation) note(Remedy::orientation, orient(work));
    if (attempt.has_facets) note(Remedy::facets, mend_bent_facets(work));
    if (changed.empty() || report_on(work) != nullptr) return false;
    const Result<Solid> solid = solid_of(work);
    if (!solid) return false;
    Inspection inspection = certify(*solid, workers_, options_.certify);
    if (!inspection.certified) {
      tried_.push_back({std::move(work), std::move(inspection.report)});
      return false;
    }
    std::ranges::sort(changed);
    repaired.outcome = Repaired::Outcome::repaired;
    repaired.after = std::move(inspection);
    repaired.edits = std::move(work);
    repaired.remedies = std::move(changed);
    repaired.moves = moves;
    repaired.holes = std::move(holes);
    return true;
  }

  /// The holes of the first set with Remedy::fill.
  std::vector<HoleFill> first_holes() { return std::move(first_holes_); }

 private:
  /// A solid that was judged, and what was found.
  struct Tried {
    EditedSolid solid;
    validate::Report report;
  };

  /// What was found in these facets; null if they were not judged yet.
  const validate::Report* report_on(const EditedSolid& work) const {
    for (const Tried& tried : tried_) {
      const bool is_same =
          tried.solid.shells == work.shells && tried.solid.vertices == work.vertices;
      if (is_same) return &tried.report;
    }
    return nullptr;
  }

  std::size_t mend_bent_facets(EditedSolid& work) const {
    if (const validate::Report* known = report_on(work); known != nullptr) {
      return triangulate(work, bent_facets(*known));
    }
    const Result<Solid> solid = solid_of(work);
    if (!solid) return 0;
    CertifyOptions quick = options_.certify;
    quick.proof = Proof::boundary;
    return triangulate(work, bent_facets(certify(*solid, nullptr, quick).report));
  }

  EditedSolid start_;
  std::vector<Tried> tried_;
  std::vector<HoleFill> first_holes_;
  delaunay::EngineWorkers* workers_;
  const RepairOptions& options_;
};

}  // namespace

std::string_view to_string(Remedy remedy) {
  switch (remedy) {
    case Remedy::rings:
      return "rings";
    case Remedy::orientation:
      return "orientation";
    case Remedy::junctions:
      return "junctions";
    case Remedy::weld:
      return "weld";
    case Remedy::facets:
      return "facets";
    case Remedy::fill:
      return "fill";
  }
  return "";
}

Result<std::vector<Remedy>> remedies_of(std::string_view list) {
  std::vector<bool> is_named(kAllRemedies.size());
  while (true) {
    const std::size_t comma = list.find(',');
    const std::string_view name = list.substr(0, comma);
    bool is_known = name == "all";
    for (std::size_t i = 0; i < kAllRemedies.size(); ++i) {
      if (name != "all" && name != to_string(kAllRemedies[i])) continue;
      is_known = is_named[i] = true;
    }
    if (!is_known) {
      return Error{ErrorCode::invalid_argument,
                   "there is no remedy '" + std::string(name) +
                       "': the remedies are rings, orientation, junctions, weld, facets, fill, or "
                       "all of them by 'all'"};
    }
    if (comma == std::string_view::npos) break;
    list.remove_prefix(comma + 1);
  }
  std::vector<Remedy> remedies;
  for (std::size_t i = 0; i < kAllRemedies.size(); ++i) {
    if (is_named[i]) remedies.push_back(kAllRemedies[i]);
  }
  return remedies;
}

Result<OnSubmittedVertices> on_submitted_vertices(const Solid& submitted,
                                                  const EditedSolid& edits) {
  std::map<Point, Index> number_of;
  for (Index vertex = 0; vertex < submitted.vertex_count(); ++vertex) {
    number_of.emplace(submitted.vertices()[vertex], vertex);
  }
  EditedSolid renumbered = edits;
  renumbered.vertices.assign(submitted.vertices().begin(), submitted.vertices().end());
  std::vector<Index> source;
  for (auto& facets : renumbered.shells) {
    for (EditedFacet& facet : facets) {
      source.push_back(facet.source);
      for (Ring& ring : facet.rings) {
        for (Index& vertex : ring) vertex = number_of.at(edits.vertices[vertex]);
      }
    }
  }
  auto solid = solid_of(renumbered);
  if (!solid) return std::move(solid).error();
  return OnSubmittedVertices{*std::move(solid), std::move(source)};
}

Repaired repair(const Solid& solid, delaunay::EngineWorkers* workers,
                const RepairOptions& options) {
  Repaired repaired;
  const Inspection inspection = certify(solid, workers, options.certify);
  repaired.before = inspection.report;
  if (inspection.report.verdict == Verdict::valid) {
    repaired.outcome = Repaired::Outcome::valid_as_read;
    return repaired;
  }
  Trial trial(solid, workers, options);
  const CancelPoll& is_cancelled = options.certify.ladder.cancel;
  for (const Attempt& attempt : attempts_of(options)) {
    if (trial.run(attempt, repaired)) break;
    repaired.is_stopped = is_cancelled && is_cancelled();
    if (repaired.is_stopped) break;
  }
  if (repaired.outcome != Repaired::Outcome::repaired) repaired.holes = trial.first_holes();
  return repaired;
}

}  // namespace watertight::repair
