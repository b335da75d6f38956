// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/metamorphic/relations.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>

#include "bench/metamorphic/oracle.h"
#include "geometry/predicates/predicates.h"
#include "tessellate/facets.h"
#include "tests/solids/builders.h"
#include "tests/solids/defects.h"
#include "tests/solids/touching_rings.h"
#include "validate/certify.h"

namespace watertight {
namespace {

using solids::Random;
using Codes = std::set<int>;

/// The solid that a seed makes, and the known facts about it.
struct Subject {
  std::string family;
  Solid solid;
  std::optional<Codes> codes = {};      // the known errors
  std::optional<int> first_level = {};  // known if the errors are
  bool needs_tetrahedra = false;
  bool is_metric = false;  // true: the metric rules stay on
};

bool is_exactly_planar(const Solid& solid, Index facet) {
  std::vector<Point> points;
  for (Index ring = solid.rings_of(facet).begin; ring < solid.rings_of(facet).end; ++ring) {
    for (const Index vertex : solid.ring(ring)) points.push_back(solid.vertices()[vertex]);
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::size_t third = 2;
  while (third < points.size() && geometry::are_collinear(points[0], points[1], points[third]))
    ++third;
  for (std::size_t i = third + 1; i < points.size(); ++i) {
    if (geometry::orient3d(points[0], points[1], points[third], points[i]) != 0) return false;
  }
  return true;
}

bool is_exactly_planar(const Solid& solid) {
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    if (!is_exactly_planar(solid, facet)) return false;
  }
  return true;
}

/// The solid with coordinates rounded down to multiples of `grid`, as in a coarser export.
Solid on_coarse_grid(const Solid& solid, double grid) {
  SolidArrays arrays = solid.arrays();
  for (Point& p : arrays.vertices) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = std::floor(p[axis] / grid) * grid;
  }
  return geometry::merge_equal_vertices(
             solids::solid_of(std::move(arrays), solid.lattice(), solid.srid()))
      .solid;
}

Subject real_subject(Random& random, std::span<const Solid> list) {
  const Solid& source = list[random.below(list.size())];
  const Solid merged = geometry::merge_equal_vertices(source).solid;
  switch (random.below(4)) {
    case 0:
      return {"real, as it is", merged, {}, {}, false, true};
    case 1: {
      // The coordinates are rounded to a grid of 1 mm to about 1 m, if the lattice is millimetres.
      const double grid = std::pow(2.0, random.within(1, 10));
      return {"real, rounded", on_coarse_grid(merged, grid), {}, {}, false, true};
    }
    case 2: {
      const double grid = std::pow(2.0, random.within(1, 10));
      const solids::Shape shape = solids::triangulated(solids::shape_of(merged));
      return {"real, triangulated and rounded",
              on_coarse_grid(solids::solid_of(shape, source.lattice(), source.srid()), grid)};
    }
    default: {
      const solids::Shape shape = solids::triangulated(solids::shape_of(merged));
      const auto reach = static_cast<std::int64_t>(1ULL << random.below(13));
      return {
          "real, triangulated and moved",
          solids::solid_of(solids::with_moved_vertices(shape, random, 1 + random.below(3), reach),
                           source.lattice(), source.srid())};
    }
  }
}

Subject defect_subject(Random& random) {
  const auto makers = solids::defect_makers();
  solids::Defect defect = makers[random.below(makers.size())](random);
  Subject subject{"defect: " + std::string(defect.name),
                  solids::solid_of(defect.shape, solids::millimetres()), defect.codes,
                  defect.first_level};
  subject.needs_tetrahedra = defect.needs_tetrahedra;
  subject.is_metric = defect.is_metric;
  return subject;
}

Subject subject_of(Random& random, std::uint64_t seed, const RelationOptions& options) {
  const auto generated = [](solids::Made made, std::optional<Codes> codes) {
    return Subject{made.family, solids::solid_of(made.shape, solids::millimetres()),
                   std::move(codes)};
  };
  constexpr std::uint64_t kTouchingRings = 40;
  if (seed % kTouchingRings == 0) {
    const solids::TouchingRings made = solids::random_touching_rings(random);
    return generated({made.name, made.shape}, made.errors);
  }
  switch (seed % 5) {
    case 0:
      return generated(solids::random_valid(random), Codes{});
    case 1:
      return defect_subject(random);
    case 2:
      return generated(solids::random_open(random), std::nullopt);
    case 3:
      return generated(solids::random_cavities(random), std::nullopt);
    default:
      return options.real_solids.empty() ? generated(solids::random_open(random), std::nullopt)
                                         : real_subject(random, options.real_solids);
  }
}

std::string text_of(const Codes& codes) {
  std::string text = "{";
  for (const int code : codes) {
    if (text.size() > 1) text += ' ';
    text += std::to_string(code);
  }
  return text + "}";
}

std::string text_of(const std::vector<int>& codes) {
  return text_of(Codes(codes.begin(), codes.end()));
}

Codes errors_of(const Report& report) { return solids::codes_of(report, Severity::error); }

/// The errors without a code that only a tetrahedralization finds: the tetrahedralization may exist
/// under one map and not under the other.
Codes exact_errors_of(const Report& report) {
  Codes codes = errors_of(report);
  codes.erase(404);
  return codes;
}

/// The code of a finding and its two facets, the smaller first.
using FacetFinding = std::tuple<int, Index, Index>;

/// The findings whose facets do not depend on the order of facets.
std::vector<FacetFinding> facets_of(const Report& report, const std::vector<Index>* facet_of) {
  const auto source = [&](Index facet) {
    return facet == kNone || facet_of == nullptr ? facet : (*facet_of)[facet];
  };
  std::vector<FacetFinding> list;
  for (const Finding& finding : report.findings) {
    const int level = finding.code / 100;
    if (level > 2 && finding.code != 306 && finding.code != 401) continue;
    Index first = source(finding.place.facet);
    Index second = finding.other ? source(finding.other->facet) : kNone;
    if (second < first) std::swap(first, second);
    list.emplace_back(finding.code, first, second);
  }
  std::sort(list.begin(), list.end());
  return list;
}

std::vector<int> all_codes(const Report& report) {
  std::vector<int> codes;
  for (const Finding& finding : report.findings) codes.push_back(finding.code);
  std::sort(codes.begin(), codes.end());
  return codes;
}

/// True if two triangles have the same three vertices: PMP does not compare such triangles.
bool has_equal_triangles(ShellTriangles triangles) {
  for (Triangle& t : triangles) std::sort(t.begin(), t.end());
  std::sort(triangles.begin(), triangles.end());
  return std::adjacent_find(triangles.begin(), triangles.end()) != triangles.end();
}

class SeedExaminer {
 public:
  SeedExaminer(std::uint64_t seed, const RelationOptions& options)
      : seed_(seed),
        options_(options),
        random_(seed),
        subject_(subject_of(random_, seed, options)) {
    is_planar_ = is_exactly_planar(subject_.solid);
    if (is_planar_ && !subject_.is_metric) {
      certify_.tolerances.planarity_metres = 1e30;
      certify_.tolerances.planarity_degrees = 360;
    }
    result_.family = subject_.family;
  }

  const Solid& solid() const { return subject_.solid; }

  SeedResult run() {
    report_ = certify(subject_.solid, nullptr, certify_).report;
    result_.outcome =
        std::string(validate::to_string(report_.verdict)) + " " + text_of(errors_of(report_));
    check_known();
    check_order();
    check_maps();
    check_proofs();
    check_oracles();
    if (options_.ladder_every != 0 && seed_ % options_.ladder_every == 0) check_ladder();
    return std::move(result_);
  }

 private:
  void check(const std::string& relation, bool holds, const std::string& expected,
             const std::string& got) {
    ++result_.checks[relation];
    if (holds) return;
    result_.disagreements.push_back(relation + ": expected " + expected + ", got " + got);
  }
  void compare(const std::string& relation, const Codes& expected, const Codes& got) {
    check(relation, expected == got, text_of(expected), text_of(got));
  }
  bool is_invalid() const { return report_.verdict == Verdict::invalid; }
  void check_known();
  void check_order();
  void check_map(const std::string& relation, const solids::AffineMap& map);
  void check_maps();
  void check_proofs();
  void check_ladder();
  void check_oracles();
  void check_shell(Index shell, const ShellFacts& facts);
  void check_solid(const std::vector<ShellTriangles>& shells, const std::vector<ShellFacts>& facts);

  std::uint64_t seed_;
  const RelationOptions& options_;
  Random random_;
  Subject subject_;
  bool is_planar_ = false;
  CertifyOptions certify_;
  Report report_;
  SeedResult result_;
};

void SeedExaminer::check_known() {
  if (!subject_.codes) return;
  if (subject_.needs_tetrahedra && report_.verdict == Verdict::undecided) return;
  compare("known codes", *subject_.codes, errors_of(report_));
  check("known verdict", is_invalid() == !subject_.codes->empty(), text_of(*subject_.codes),
        std::string(validate::to_string(report_.verdict)));
  if (!subject_.first_level) return;
  compare("known first level", {*subject_.first_level},
          Codes(report_.first_level.begin(), report_.first_level.end()));
}

void SeedExaminer::check_order() {
  for (int round = 0; round < 2; ++round) {
    const solids::Rewritten other = solids::rewritten(subject_.solid, random_);
    const Report report = certify(other.solid, nullptr, certify_).report;
    check("order: verdict", report.verdict == report_.verdict,
          std::string(validate::to_string(report_.verdict)),
          std::string(validate::to_string(report.verdict)));
    compare("order: codes", errors_of(report_), errors_of(report));
    compare("order: warnings", solids::codes_of(report_, Severity::warning),
            solids::codes_of(report, Severity::warning));
    check("order: counts", all_codes(report) == all_codes(report_),
          std::to_string(report_.findings.size()) + " findings",
          std::to_string(report.findings.size()));
    check("order: first level", report.first_level == report_.first_level,
          text_of(report_.first_level), text_of(report.first_level));
    if (report_.findings_omitted == 0 && report.findings_omitted == 0) {
      check("order: places", facets_of(report, &other.facet_of) == facets_of(report_, nullptr),
            "the same facets", "others");
    }
  }
}

void SeedExaminer::check_map(const std::string& relation, const solids::AffineMap& map) {
  constexpr double kLargest = 1125899906842624.0;  // 2^50
  if (solids::largest_coordinate(subject_.solid, map) >= kLargest) return;
  CertifyOptions options = certify_;
  options.proof = Proof::boundary;  // runs only the exact tests
  const Report report = certify(solids::mapped(subject_.solid, map), nullptr, options).report;
  compare(relation + ": codes", exact_errors_of(report_), exact_errors_of(report));
  if (errors_of(report_).count(404) != 0) return;
  check(relation + ": first level", report.first_level == report_.first_level,
        text_of(report_.first_level), text_of(report.first_level));
}

void SeedExaminer::check_maps() {
  if (!is_planar_ || subject_.is_metric) return;
  if (subject_.solid.lattice().kind == LatticeKind::float64) return;
  check_map("unimodular map", solids::unimodular_map(random_, 9));
  check_map("affine map", solids::general_map(random_, 9));
  check_map("even permutation", solids::axis_permutation(random_, true));
  check_map("odd permutation, reversed", solids::axis_permutation(random_, false));
}

/// Checks that the exact tests and the certificate of one shell agree.
void SeedExaminer::check_proofs() {
  if (subject_.solid.shell_count() != 1) return;
  CertifyOptions options = certify_;
  options.proof = Proof::boundary;
  const Report report = certify(subject_.solid, nullptr, options).report;
  check("boundary proof and rung 0",
        (report.verdict == Verdict::valid) == !is_invalid() && report.verdict != Verdict::undecided,
        std::string(validate::to_string(report_.verdict)),
        std::string(validate::to_string(report.verdict)));
  // A shell that meets itself or is inside out must have no certificate.
  const Codes errors = errors_of(report_);
  const bool is_closed_but_wrong =
      !errors.empty() && std::all_of(errors.begin(), errors.end(),
                                     [](int code) { return code == 306 || code == 405; });
  if (!is_closed_but_wrong) return;
  const Solid merged = geometry::merge_equal_vertices(subject_.solid).solid;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(merged);
  const delaunay::LadderResult climbed =
      delaunay::climb_ladder(facets.divided_solid(merged), facets, nullptr, {});
  check("no certificate for 306, 405", !climbed.certificate.has_value(), "none", "a certificate");
}

void SeedExaminer::check_ladder() {
  if (options_.workers == nullptr) return;
  const Report report = certify(subject_.solid, options_.workers, certify_).report;
  if (report.verdict == Verdict::undecided) {
    check("full ladder: decided", false, "a verdict", report.undecided_reason);
    return;
  }
  compare("full ladder: exact codes", exact_errors_of(report_), exact_errors_of(report));
  if (subject_.codes) compare("full ladder: known codes", *subject_.codes, errors_of(report));
  if (subject_.solid.shell_count() == 1) {
    check("full ladder and boundary proof", is_invalid() == (report.verdict == Verdict::invalid),
          std::string(validate::to_string(report_.verdict)),
          std::string(validate::to_string(report.verdict)));
  }
}

void SeedExaminer::check_shell(Index shell, const ShellFacts& facts) {
  const auto has = [&](int code) {
    return std::any_of(report_.findings.begin(), report_.findings.end(), [&](const Finding& f) {
      return f.code == code && f.place.shell == shell &&
             (!f.other || f.other->shell == kNone || f.other->shell == shell);
    });
  };
  const auto say = [](bool value) { return std::string(value ? "yes" : "no"); };
  if (!has(302)) {
    check("oracle: 306", has(306) == facts.meets_itself, say(facts.meets_itself), say(has(306)));
  } else if (has(306)) {
    check("oracle: 306", facts.meets_itself, "none", "306");
  }
  const bool is_mesh = !has(303) && !has(307);
  check("oracle: 303, 307", is_mesh == facts.is_mesh, say(facts.is_mesh), say(is_mesh));
  if (!facts.is_mesh || !is_mesh) return;
  check("oracle: 302", has(302) == !facts.is_closed, say(!facts.is_closed), say(has(302)));
  check("oracle: 305", has(305) == (facts.components > 1), std::to_string(facts.components),
        say(has(305)));
  if (!facts.is_closed || facts.meets_itself || facts.components != 1) return;
  check("oracle: bounds a volume", facts.bounds_volume, "yes", "no");
  check("oracle: 405", has(405) == (facts.is_outward != (shell == 0)), say(facts.is_outward),
        say(has(405)));
}

void SeedExaminer::check_solid(const std::vector<ShellTriangles>& shells,
                               const std::vector<ShellFacts>& facts) {
  if (options_.nef_every == 0 || shells.size() < 2 || (seed_ / 5) % options_.nef_every != 0) return;
  std::size_t size = 0;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    size += shells[i].size();
    const ShellFacts& f = facts[i];
    if (!f.is_mesh || !f.is_closed || f.components != 1 || f.meets_itself) return;
    if (f.is_outward != (i == 0)) return;
  }
  if (size > 200) return;
  const NefFacts nef = ask_nef(subject_.solid.vertices(), shells);
  const bool is_apart = nef.cavities_inside && nef.cavities_apart;
  const Codes errors = exact_errors_of(report_);
  check("Nef: shells", is_apart == errors.empty(), is_apart ? "apart" : "not apart",
        text_of(errors));
  if (!is_apart) return;
  Report report = report_;
  if (report.verdict == Verdict::undecided && options_.workers != nullptr) {
    report = certify(subject_.solid, options_.workers, certify_).report;
  }
  if (report.verdict == Verdict::undecided) return;
  check("Nef: interior parts", (nef.interior_parts == 1) == (report.verdict == Verdict::valid),
        std::to_string(nef.interior_parts), text_of(errors_of(report)));
}

void SeedExaminer::check_oracles() {
  // The solid has no equal vertices: solid_of() and merge_equal_vertices() merge them.
  const Solid& solid = subject_.solid;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  for (const tessellate::FacetState state : facets.state) {
    if (state != tessellate::FacetState::triangulated) return;
  }
  // The oracles get triangles only, so they do not judge errors in the rings of a facet.
  for (const int code : errors_of(report_)) {
    if (code < 300) return;
  }
  std::vector<ShellTriangles> shells(solid.shell_count());
  for (std::size_t t = 0; t < facets.triangles.size(); ++t) {
    shells[solid.shell_of(facets.facet_of[t])].push_back(facets.triangles[t]);
  }
  std::vector<ShellFacts> facts;
  for (Index shell = 0; shell < shells.size(); ++shell) {
    if (shells[shell].empty()) return;
    facts.push_back(ask_pmp(solid.vertices(), shells[shell]));
    facts.back().meets_itself |= has_equal_triangles(shells[shell]);
    check_shell(shell, facts.back());
  }
  check_solid(shells, facts);
}

}  // namespace

SeedResult examine_seed(std::uint64_t seed, const RelationOptions& options) {
  return SeedExaminer(seed, options).run();
}

Solid solid_of_seed(std::uint64_t seed, const RelationOptions& options) {
  return SeedExaminer(seed, options).solid();
}

}  // namespace watertight
