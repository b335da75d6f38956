// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: E. Verbree and H. Si, Validation and Storage of Polyhedra through Constrained Delaunay
// Tetrahedralization, 2008, section 3.
// Departures: all exact tests are made first, and the tetrahedralization only for solids that pass
// them (on other solids engines crash, hang or succeed); the result of an engine is a proof only
// after our own check (delaunay/certificate.h).
#include "validate/certify.h"

#include <algorithm>
#include <chrono>

#include "base/quantity.h"
#include "validate/rules/rules.h"
#include "validate/snap.h"

namespace watertight::validate {

/// One run of all rules on a solid. Only this class makes a ValidSolid.
class Certifier {
 public:
  Certifier(const Solid& solid, const CertifyOptions& options)
      : options_(options),
        examined_(solid, options.tolerances, options.limits, options.ladder.cancel,
                  options.placement) {}

  Inspection run(delaunay::EngineWorkers* workers) {
    apply_exact_rules();
    measure_solid();
    if (examined_.findings.has_errors()) {
      if (!examined_.findings.has(kSolidInteriorDisconnected)) {
        examined_.findings.skip({kSolidInteriorDisconnected},
                                "the tetrahedralization is built only for solids that pass the "
                                "exact tests");
      }
      verdict_ = Verdict::invalid;
    } else if (!incomplete_.empty()) {
      inspection_.report.undecided_reason = incomplete_;
    } else if (options_.is_proven) {
      verdict_ = Verdict::valid;
    } else {
      prove(workers);
    }
    return finish();
  }

  /// Applies the exact rules only.
  TolerantVerdict run_exact_rules() {
    apply_exact_rules();
    return exact_verdict();
  }
  /// The verdict of the exact rules, whatever the tetrahedralization shows later.
  TolerantVerdict exact_verdict() const { return exact_; }

  void add_note(std::string note) { inspection_.report.notes.push_back(std::move(note)); }

 private:
  void apply_exact_rules();
  void measure_solid();
  void prove(delaunay::EngineWorkers* workers);
  bool is_sound() const;
  void examine_interior(const ShellContacts& contacts);
  void climb(delaunay::EngineWorkers* workers);
  void report_property(const delaunay::LadderResult& result);
  void accept(std::optional<delaunay::Certificate> certificate);
  Inspection finish();

  const CertifyOptions& options_;
  ExaminedSolid examined_;
  std::vector<ShellTopology> shells_;
  std::string incomplete_;  // the reason why the exact tests did not finish, or ""
  std::optional<delaunay::ContactTriangles>
      divided_;                     // the triangles where shells touch, for several shells
  bool is_interior_known_ = false;  // the exact tests show whether the interior is connected
  TolerantVerdict exact_;
  Verdict verdict_ = Verdict::undecided;
  Inspection inspection_;
};

void Certifier::apply_exact_rules() {
  check_not_empty(examined_);
  check_rings(examined_);
  check_closed_rings(examined_, options_.unclosed_rings);
  const std::string unmeasured = check_facets(examined_);
  shells_ = check_shells(examined_);
  const std::vector<Index> duplicate_of = check_duplicate_shells(examined_);
  const ShellContacts contacts =
      check_intersections(examined_, duplicate_of, options_.ladder.cancel, options_.threads);
  incomplete_ = contacts.incomplete.empty() ? unmeasured : contacts.incomplete;
  check_diagonals(examined_, contacts);
  const std::string unlocated = check_solid(examined_, shells_, duplicate_of, contacts);
  if (incomplete_.empty()) incomplete_ = unlocated;
  examine_interior(contacts);
  check_vertices(examined_, options_.unused);
  check_rounded(examined_, options_.rounded);
  if (options_.is_origin_rounded) report_rounded_origin(examined_);
  if (examined_.was_cancelled() && incomplete_.empty())
    incomplete_ = "the validation was cancelled";
  const bool has_errors = examined_.findings.has_errors();
  if (!has_errors && incomplete_.empty() && !is_sound()) {
    incomplete_ = "the exact tests contradict each other; please report this solid as a defect";
  }
  exact_.first_level = first_level_codes(examined_.findings.all());
  exact_.verdict = has_errors            ? Verdict::invalid
                   : incomplete_.empty() ? Verdict::valid
                                         : Verdict::undecided;
}

/// Applies rule 404. Requires that every other rule of shells and solids was applied.
void Certifier::examine_interior(const ShellContacts& contacts) {
  if (examined_.findings.has_errors() || !incomplete_.empty() || !is_sound()) return;
  is_interior_known_ = true;
  if (examined_.solid().shell_count() == 1) return;
  divided_.emplace();
  const auto& touching = contacts.is_touching;
  if (std::find(touching.begin(), touching.end(), true) == touching.end()) return;
  auto divided = delaunay::divide_at_contacts(examined_.solid(), examined_.triangles(),
                                              [this] { return examined_.ask_cancelled(); });
  if (!divided) {
    divided_.reset();
    is_interior_known_ = false;
    return;
  }
  *divided_ = *std::move(divided);
  is_interior_known_ = check_interior(examined_, *divided_);
}

/// True if the facts hold that must hold for a solid without findings.
bool Certifier::is_sound() const {
  const auto& states = examined_.triangles().state;
  return !shells_.empty() &&
         std::all_of(shells_.begin(), shells_.end(),
                     [](const ShellTopology& shell) { return shell.is_sound(); }) &&
         std::all_of(states.begin(), states.end(),
                     [](tessellate::FacetState state) {
                       return state == tessellate::FacetState::triangulated;
                     }) &&
         !examined_.findings.has(kZeroVolume);
}

void Certifier::measure_solid() {
  const auto& states = examined_.triangles().state;
  const bool has_measures =
      !shells_.empty() &&
      std::all_of(shells_.begin(), shells_.end(),
                  [](const ShellTopology& shell) { return shell.is_closed; }) &&
      std::all_of(states.begin(), states.end(), [](tessellate::FacetState state) {
        return state == tessellate::FacetState::triangulated;
      });
  if (!has_measures) return;
  const auto& triangles = examined_.triangles().triangles;
  if (options_.placement == nullptr) {
    inspection_.report.measures = geometry::measure(examined_.solid(), triangles);
  } else if (const auto solid = geometry::placed(examined_.solid(), *options_.placement); solid) {
    std::vector<Triangle> in_place = triangles;
    if (geometry::determinant_sign(*options_.placement) <
        0) {  // the examined solid was turned over
      for (Triangle& t : in_place) std::swap(t[1], t[2]);
    }
    inspection_.report.measures = geometry::measure(*solid, in_place);
  }
}

void Certifier::prove(delaunay::EngineWorkers* workers) {
  if (options_.proof == Proof::tetrahedralization) {
    climb(workers);
  } else if (is_interior_known_) {
    if (examined_.solid().shell_count() == 1) {
      examined_.findings.skip(
          {kSolidInteriorDisconnected},
          "one closed 2-manifold shell that does not meet itself bounds one "
          "interior (Jordan-Brouwer); the option asked for a proof by boundary");
    }
    accept(std::nullopt);
  } else {
    inspection_.report.undecided_reason =
        "only a tetrahedralization can show whether the interior is in parts";
    if (divided_ && !divided_->obstacle.empty()) {
      inspection_.report.undecided_reason += " (" + divided_->obstacle + ")";
    }
  }
}

void Certifier::climb(delaunay::EngineWorkers* workers) {
  delaunay::LadderOptions options = options_.ladder;
  if (divided_) options.contacts = &*divided_;
  options.is_interior_known = is_interior_known_;
  delaunay::LadderResult result =
      delaunay::climb_ladder(examined_.solid(), examined_.triangles(), workers, options);
  Report& report = inspection_.report;
  report.attempts = std::move(result.attempts);
  if (result.certificate) {
    report.rung = result.certificate->rung;
    report.refilled_facets = result.certificate->refilled_facets;
    accept(std::move(result.certificate));
  } else if (result.property != delaunay::CertificateRefusal::none) {
    report_property(result);
  } else {
    report.undecided_reason = "no rung of the tetrahedralization ladder finished";
    if (!result.obstacle.empty()) report.undecided_reason += " (" + result.obstacle + ")";
    if (!report.attempts.empty()) {
      report.undecided_reason += "; the last attempt: " + report.attempts.back().outcome;
    }
  }
}

/// Reports the property for which a certificate was refused. The certificate is about the canonical
/// triangles, as the exact tests are. Where the exact tests have decided about the interior, a
/// contradiction of the certificate shows a defect of this program, not of the solid.
void Certifier::report_property(const delaunay::LadderResult& result) {
  if (is_interior_known_) {
    inspection_.report.undecided_reason = "the exact tests and the tetrahedralization disagree (";
    inspection_.report.undecided_reason += delaunay::to_string(result.property);
    inspection_.report.undecided_reason += "); please report this solid as a defect";
    return;
  }
  Finding finding;
  switch (result.property) {
    case delaunay::CertificateRefusal::interior_disconnected:
      finding.code = kSolidInteriorDisconnected;
      break;
    case delaunay::CertificateRefusal::cavity_mismatch:
      finding.code = kInnerShellOutside;
      break;
    default:  // each shell alone is turned the right way, so two shells cross
      finding.code = kIntersectionShells;
      break;
  }
  if (result.facet != kNone && result.facet < examined_.solid().facet_count()) {
    finding.place = examined_.at_facet(result.facet);
    const Solid& solid = examined_.solid();
    finding.witness = examined_.world(solid.ring(solid.rings_of(result.facet).begin).front());
  }
  finding.detail = result.detail;
  examined_.findings.add(std::move(finding));
  verdict_ = Verdict::invalid;
}

void Certifier::accept(std::optional<delaunay::Certificate> certificate) {
  auto boundary = OrientedBoundary::make(examined_.merged());
  if (!boundary) {
    inspection_.report.undecided_reason = to_string(boundary.error());
    return;
  }
  const Acceptance acceptance{options_.tolerances, options_.proof, geometry::kRuleSet};
  inspection_.certified =
      Certified{ValidSolid(*std::move(boundary), acceptance), std::move(certificate)};
  verdict_ = Verdict::valid;
}

Inspection Certifier::finish() {
  Report& report = inspection_.report;
  report.verdict = verdict_;
  report.acceptance = {options_.tolerances, options_.proof, geometry::kRuleSet};
  if (!examined_.unit_note().empty()) report.notes.push_back(examined_.unit_note());
  report.first_level = first_level_codes(examined_.findings.all());
  std::move(examined_.findings).move_to(report);
  return std::move(inspection_);
}

namespace {

/// val3dity's defaults, with the snap distance asked for.
Tolerances tolerant_tolerances(const CertifyOptions& options) {
  return {.planarity_metres = 0.01,
          .planarity_degrees = 20,
          .snap_metres = options.tolerant_snap_metres};
}

/// The verdict under tolerant_tolerances(). `exact` is the verdict of the exact rules under
/// `options`; both verdicts are the same if the tolerances differ at most in snapping and snapping
/// moves nothing.
TolerantVerdict tolerant_verdict(const Solid& solid, const CertifyOptions& options,
                                 const TolerantVerdict& exact) {
  CertifyOptions tolerant = options;
  tolerant.tolerances = tolerant_tolerances(options);
  if (options.tolerances == tolerant.tolerances) return exact;
  const auto snapped =
      snap_vertices(solid, options.tolerant_snap_metres, options.ladder.cancel, options.placement);
  if (!snapped) return {};
  Tolerances unsnapped = tolerant.tolerances;
  unsnapped.snap_metres = 0;
  if (snapped->moved == 0 && options.tolerances == unsnapped) return exact;
  return Certifier(snapped->solid, tolerant).run_exact_rules();
}

Inspection examine(const Solid& solid, delaunay::EngineWorkers* workers,
                   const CertifyOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Inspection inspection;
  TolerantVerdict exact;
  const double snap = options.tolerances.snap_metres;
  if (!(snap > 0)) {
    Certifier certifier(solid, options);
    inspection = certifier.run(workers);
    exact = certifier.exact_verdict();
  } else if (auto snapped = snap_vertices(solid, snap, options.ladder.cancel, options.placement);
             snapped) {
    Certifier certifier(snapped->solid, options);
    certifier.add_note("the snap tolerance moved " +
                       quantity(snapped->moved, "vertex", "vertices") +
                       "; the verdict is about the snapped solid");
    inspection = certifier.run(workers);
    exact = certifier.exact_verdict();
  } else {
    inspection.report.undecided_reason = to_string(snapped.error());
    inspection.report.acceptance = {options.tolerances, options.proof, geometry::kRuleSet};
  }
  if (options.also_tolerant) {
    inspection.report.tolerant = tolerant_verdict(solid, options, exact);
  }
  inspection.report.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return inspection;
}

/// The result for a solid that is invalid by findings made without an examination.
Inspection invalid_by(FindingCollector findings, const CertifyOptions& options) {
  Inspection inspection;
  Report& report = inspection.report;
  report.verdict = Verdict::invalid;
  report.acceptance = {options.tolerances, options.proof, geometry::kRuleSet};
  report.first_level = first_level_codes(findings.all());
  if (options.also_tolerant) {
    report.tolerant = TolerantVerdict{Verdict::invalid, report.first_level};
  }
  std::move(findings).move_to(report);
  return inspection;
}

/// The result for a solid of which nothing is known, because the reader could not read it.
Inspection unread(const CertifyOptions& options) {
  FindingCollector findings(options.limits.findings);
  findings.add({.code = kInvalidInputFile, .detail = options.unreadable});
  return invalid_by(std::move(findings), options);
}

/// The result for a solid that its placement flattens: a closed surface pressed into a plane meets
/// itself and encloses nothing.
Inspection flattened(const CertifyOptions& options) {
  FindingCollector findings(options.limits.findings);
  for (const int code : {kShellSelfIntersection, kZeroVolume}) {
    findings.add(
        {.code = code,
         .detail = "the determinant of the transformation is zero: it flattens the solid"});
  }
  findings.skip({kSolidInteriorDisconnected}, "the solid is flat where it is placed");
  return invalid_by(std::move(findings), options);
}

Inspection examine_placed(const Solid& solid, delaunay::EngineWorkers* workers,
                          const CertifyOptions& options) {
  const int sign = geometry::determinant_sign(*options.placement);
  if (sign == 0 && solid.facet_count() > 0) return flattened(options);
  Inspection inspection = sign < 0 ? examine(geometry::turned_over(solid), workers, options)
                                   : examine(solid, workers, options);
  if (inspection.certified) inspection.unplaced = std::move(inspection.certified->solid);
  inspection.certified.reset();
  for (Finding& finding : inspection.report.findings) {
    if (finding.witness) finding.witness = geometry::place(*options.placement, *finding.witness);
  }
  return inspection;
}

}  // namespace

bool has_crossing_facets(const Solid& solid) {
  ExaminedSolid examined(solid, {}, {});
  check_rings(examined);
  check_facets(examined);
  check_shells(examined);
  check_intersections(examined, check_duplicate_shells(examined), {}, 1);
  return examined.findings.has(kShellSelfIntersection) ||
         examined.findings.has(kIntersectionShells);
}

Inspection certify(const Solid& solid, delaunay::EngineWorkers* workers,
                   const CertifyOptions& options) {
  Inspection inspection = !options.unreadable.empty()    ? unread(options)
                          : options.placement == nullptr ? examine(solid, workers, options)
                                                         : examine_placed(solid, workers, options);
  for (Finding& finding : inspection.report.findings) {
    name_elements(solid, options.elements, finding);
  }
  return inspection;
}

}  // namespace watertight::validate
