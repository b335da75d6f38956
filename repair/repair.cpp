// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/repair.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "repair/smooth/finer_lattice.h"

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
  bool has_smooth = false;    // holes get smooth patches
};

bool has(const RepairOptions& options, Remedy remedy) {
  return std::ranges::find(options.remedies, remedy) != options.remedies.end();
}

/// The sets in the order in which they are tried: what guesses nothing, then welding and triangles
/// for bent facets, then all that again with filled holes. Smooth patches come before fillings, and
/// fillings after them even where only `smooth` is asked for.
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
  const bool has_smooth = has(options, Remedy::smooth);
  for (const bool fill : {false, true}) {
    if (fill && !has(options, Remedy::fill) && !has_smooth) break;
    for (const double weld : welds) {
      for (const bool facets : {false, true}) {
        if (facets && !has(options, Remedy::facets)) break;
        if (!fill && !facets && weld == 0) continue;
        Attempt attempt{has_orientation, has_junctions, weld, facets, fill};
        attempt.has_smooth = fill && has_smooth;
        if (attempt.has_smooth) attempts.push_back(attempt);
        attempt.has_smooth = false;
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

/// A solid after some remedies.
struct Treated {
  EditedSolid solid;
  std::vector<Remedy> changed;  // the remedies that changed something
  Moves moves;
  std::vector<HoleFill> holes;
  std::optional<std::vector<Index>> bent;  // its bent facets, once they were asked for

  void note(Remedy remedy, std::size_t changes) {
    if (changes > 0 && std::ranges::find(changed, remedy) == changed.end()) {
      changed.push_back(remedy);
    }
  }
};

class Trial {
 public:
  Trial(const Solid& solid, delaunay::EngineWorkers* workers, const RepairOptions& options)
      : start_(edited(solid)), workers_(workers), options_(options) {}

  /// Applies a set of remedies. True if the result is valid.
  bool run(const Attempt& attempt, Repaired& repaired) {
    Treated& closed = attempt.has_fill ? with_fill(attempt) : without_fill(attempt);
    if (attempt.joins_parts && closed.holes.empty()) return false;
    Treated work = closed;
    if (attempt.has_facets) work.note(Remedy::facets, triangulate(work.solid, bent_in(closed)));
    if (work.changed.empty() || report_on(work.solid) != nullptr) return false;
    const Result<Solid> solid = solid_of(work.solid);
    if (!solid) return false;
    Inspection inspection = certify(*solid, workers_, options_.certify);
    if (!inspection.certified) {
      if (undecided_reason_.empty()) undecided_reason_ = inspection.report.undecided_reason;
      tried_.push_back({std::move(work.solid), std::move(inspection.report)});
      return false;
    }
    std::ranges::sort(work.changed);
    repaired.outcome = Repaired::Outcome::repaired;
    repaired.after = std::move(inspection);
    repaired.edits = std::move(work.solid);
    repaired.remedies = std::move(work.changed);
    repaired.moves = work.moves;
    repaired.holes = std::move(work.holes);
    return true;
  }

  const std::string& undecided_reason() const { return undecided_reason_; }

  /// The holes of the first set with Remedy::fill.
  std::vector<HoleFill> first_holes() { return std::move(first_holes_); }

 private:
  /// A solid that was judged, and what was found.
  struct Tried {
    EditedSolid solid;
    validate::Report report;
  };

  /// The solid after the remedies of a set that come before holes are filled.
  const Treated& before_fill(const Attempt& attempt) {
    const auto [found, is_new] = before_fill_.try_emplace(
        {attempt.has_orientation, attempt.has_junctions, attempt.weld_metres});
    Treated& work = found->second;
    if (!is_new) return work;
    work.solid = start_;
    if (has(options_, Remedy::rings)) work.note(Remedy::rings, mend_rings(work.solid));
    if (attempt.has_orientation) work.note(Remedy::orientation, orient(work.solid));
    if (attempt.weld_metres > 0) {
      work.note(Remedy::weld, weld(work.solid, attempt.weld_metres, work.moves));
    }
    if (attempt.has_junctions) work.note(Remedy::junctions, insert_junctions(work.solid));
    return work;
  }

  /// The solid of a set without fillings, but for its bent facets.
  Treated& without_fill(const Attempt& attempt) {
    const auto [found, is_new] = without_fill_.try_emplace(
        {attempt.has_orientation, attempt.has_junctions, attempt.weld_metres});
    if (is_new) found->second = oriented(before_fill(attempt), attempt);
    return found->second;
  }

  /// The same with filled holes.
  Treated& with_fill(const Attempt& attempt) {
    const auto [found, is_new] = with_fill_.try_emplace(
        {attempt.weld_metres, attempt.has_smooth, attempt.prefers_plan, attempt.joins_parts});
    if (!is_new) return found->second;
    Treated work = before_fill(attempt);
    work.holes = filled(work.solid, attempt);
    for (const HoleFill& hole : work.holes) {
      work.note(hole.smooth ? Remedy::smooth : Remedy::fill, hole.facets);
    }
    if (first_holes_.empty()) first_holes_ = work.holes;
    found->second = oriented(std::move(work), attempt);
    return found->second;
  }

  static Treated oriented(Treated work, const Attempt& attempt) {
    if (attempt.has_orientation) work.note(Remedy::orientation, orient(work.solid));
    return work;
  }

  std::vector<HoleFill> filled(EditedSolid& work, const Attempt& attempt) const {
    FillHolesOptions filling;
    filling.tolerances = options_.certify.tolerances;
    filling.most_islands = options_.most_islands;
    filling.prefers_plan = attempt.prefers_plan;
    filling.joins_parts = attempt.joins_parts;
    filling.is_cancelled = options_.certify.ladder.cancel;
    if (attempt.has_smooth) filling.smooth = options_.smooth;
    std::vector<HoleFill> holes = fill_holes(work, filling);
    if (!has(options_, Remedy::smooth) || attempt.has_smooth) return holes;
    // The set with smooth patches was tried before.
    for (HoleFill& hole : holes) {
      hole.smooth_refusal = "not_valid";
      hole.smooth_detail = "the solid with smooth patches is not valid";
    }
    return holes;
  }

  /// What was found in these facets; null if they were not judged yet.
  const validate::Report* report_on(const EditedSolid& work) const {
    for (const Tried& tried : tried_) {
      const bool is_same =
          tried.solid.shells == work.shells && tried.solid.vertices == work.vertices;
      if (is_same) return &tried.report;
    }
    return nullptr;
  }

  const std::vector<Index>& bent_in(Treated& treated) const {
    if (treated.bent) return *treated.bent;
    treated.bent.emplace();
    if (const validate::Report* known = report_on(treated.solid); known != nullptr) {
      treated.bent = bent_facets(*known);
    } else if (const Result<Solid> solid = solid_of(treated.solid); solid) {
      CertifyOptions quick = options_.certify;
      quick.proof = Proof::boundary;
      treated.bent = bent_facets(certify(*solid, nullptr, quick).report);
    }
    return *treated.bent;
  }

  EditedSolid start_;
  // Sets have their first remedies in common; each of these is applied once.
  std::map<std::tuple<bool, bool, double>, Treated> before_fill_;
  std::map<std::tuple<bool, bool, double>, Treated> without_fill_;
  std::map<std::tuple<double, bool, bool, bool>, Treated> with_fill_;
  std::vector<Tried> tried_;
  std::vector<HoleFill> first_holes_;
  std::string undecided_reason_;  // of the first set that made an undecided solid
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
    case Remedy::smooth:
      return "smooth";
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
      const bool is_in_all = name == "all" && kAllRemedies[i] != Remedy::smooth;
      if (!is_in_all && name != to_string(kAllRemedies[i])) continue;
      is_known = is_named[i] = true;
    }
    if (!is_known) {
      return Error{ErrorCode::invalid_argument,
                   "there is no remedy '" + std::string(name) +
                       "': the remedies are rings, orientation, junctions, weld, facets, fill, "
                       "all of these by 'all', and smooth"};
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

namespace {

/// The vertices of a submitted solid and, after them, those of edits with other places.
struct JoinedVertices {
  Lattice lattice;
  std::vector<Point> points;
  std::vector<Index> number_of;  // vertex of the edits -> point
};

Result<JoinedVertices> join_vertices(const Solid& submitted, const EditedSolid& edits) {
  const std::size_t count = submitted.vertex_count();
  JoinedVertices joined{edits.lattice, {}, {}};
  std::vector<Point> all(submitted.vertices().begin(), submitted.vertices().end());
  if (edits.lattice == submitted.lattice()) {
    all.insert(all.end(), edits.vertices.begin(), edits.vertices.end());
  } else {
    auto both =
        on_one_lattice(submitted.lattice(), submitted.vertices(), edits.lattice, edits.vertices);
    if (!both) return std::move(both).error();
    joined.lattice = both->lattice;
    all = std::move(both->points);
  }
  joined.points.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  std::map<Point, Index> number_of;
  for (Index vertex = 0; vertex < count; ++vertex) number_of.emplace(all[vertex], vertex);
  for (const Point& point : std::span(all).subspan(count)) {
    const auto [found, is_new] = number_of.emplace(point, static_cast<Index>(joined.points.size()));
    if (is_new) joined.points.push_back(point);
    joined.number_of.push_back(found->second);
  }
  return joined;
}

}  // namespace

Result<OnSubmittedVertices> on_submitted_vertices(const Solid& submitted,
                                                  const EditedSolid& edits) {
  auto joined = join_vertices(submitted, edits);
  if (!joined) return std::move(joined).error();
  EditedSolid renumbered = edits;
  renumbered.vertices = std::move(joined->points);
  renumbered.lattice = joined->lattice;
  std::vector<Index> source;
  for (auto& facets : renumbered.shells) {
    for (EditedFacet& facet : facets) {
      source.push_back(facet.source);
      for (Ring& ring : facet.rings) {
        for (Index& vertex : ring) vertex = joined->number_of[vertex];
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
  const auto is_cancelled = [&] {
    return options.certify.ladder.cancel && options.certify.ladder.cancel();
  };
  for (const Attempt& attempt : attempts_of(options)) {
    if (is_cancelled() || trial.run(attempt, repaired)) break;
  }
  if (repaired.outcome == Repaired::Outcome::repaired) return repaired;
  repaired.is_stopped = is_cancelled();
  repaired.undecided_reason = trial.undecided_reason();
  repaired.holes = trial.first_holes();
  return repaired;
}

}  // namespace watertight::repair
