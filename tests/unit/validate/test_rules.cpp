// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests rules on solids made for them: one-sided shells, other diagonals, shells without volume,
// open rings, units, and inputs that would make a simple search quadratic.
#include <cmath>

#include "tests/unit/validate/solids.h"
#include "validate/finding_kinds.h"
#include "validate/rules/rules.h"

using namespace watertight;
using namespace watertight::test;

using Codes = std::set<int>;

namespace {

/// A slab whose top is a quadrilateral between heights `low` and `high`, over a bottom that rises
/// to `middle`. The canonical diagonal of the top runs between the corners of height `high`.
Shell slab(double low, double high, double middle) {
  const Point a{0, 0, 0};
  const Point b{4000, 0, 0};
  const Point c{4000, 4000, 0};
  const Point d{0, 4000, 0};
  const Point m{2000, 2000, middle};
  const Point e{0, 0, low};
  const Point f{4000, 0, high};
  const Point g{4000, 4000, low};
  const Point h{0, 4000, high};
  return {{{e, f, g, h}}, {{b, a, m}},    {{c, b, m}},    {{d, c, m}},   {{a, d, m}},
          {{a, b, f, e}}, {{b, c, g, f}}, {{c, d, h, g}}, {{d, a, e, h}}};
}

Report slab_report(double low, double high, double middle) {
  return certify(solid_of({slab(low, high, middle)}, lattice_of(0.001)), nullptr).report;
}

/// The projective plane as ten triangles.
Shell one_sided() {
  const std::vector<Point> p{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {4, 4, 1}, {1, 4, 4}};
  Shell shell;
  for (const auto& [a, b, c] : std::vector<std::array<std::size_t, 3>>{{0, 1, 2},
                                                                       {0, 2, 3},
                                                                       {0, 3, 4},
                                                                       {0, 4, 5},
                                                                       {0, 5, 1},
                                                                       {1, 2, 4},
                                                                       {2, 3, 5},
                                                                       {3, 4, 1},
                                                                       {4, 5, 2},
                                                                       {5, 1, 3}}) {
    shell.push_back({{p[a], p[b], p[c]}});
  }
  return shell;
}

}  // namespace

TEST_CASE("a closed surface with one side is 300, not 303, and 303 in val3dity's cascade") {
  const Report report = report_of({one_sided()});
  CHECK(error_codes(report).count(300) == 1);
  CHECK(error_codes(report).count(303) == 0);
  CHECK(error_codes(report).count(307) == 0);
  CHECK(report.first_level == std::vector<int>{303});
}

TEST_CASE("a Moebius band is open and has one side") {
  // Three squares form a ring; the last is joined to the first with a twist.
  const std::vector<Point> low{{0, 0, 0}, {9, 0, 0}, {4, 9, 0}};
  const std::vector<Point> high{{0, 0, 4}, {9, 0, 4}, {4, 9, 4}};
  const Shell band{{{low[0], low[1], high[1]}}, {{low[0], high[1], high[0]}},
                   {{low[1], low[2], high[2]}}, {{low[1], high[2], high[1]}},
                   {{low[2], high[0], low[0]}}, {{low[2], high[2], high[0]}}};
  const Codes codes = error_codes(report_of({band}));
  CHECK(codes.count(302) == 1);
  // The last two triangles join low to high: no reversal of facets gives the band two sides.
  CHECK(codes.count(307) == 1);
  CHECK(codes.count(300) == 0);
}

TEST_CASE("a diagonal that would run through another facet is named, and the verdict stays") {
  const Report report = slab_report(2, 8, 5);
  CHECK(report.verdict == Verdict::valid);
  const Finding* finding = first_finding(report, 804);
  REQUIRE(finding);
  CHECK(finding->severity == Severity::warning);
  CHECK(finding->place.facet == 0);
  REQUIRE(finding->other);
  REQUIRE(finding->measured);
  CHECK(std::fabs(*finding->measured - 0.006) < 1e-6);  // the diagonals pass 6 mm apart
  CHECK(finding->detail.find("would intersect") != std::string::npos);
}

TEST_CASE("an intersection that another diagonal would undo is named") {
  const Report report = slab_report(8, 2, 5);
  CHECK(error_codes(report) == Codes{306});
  const Finding* finding = first_finding(report, 804);
  REQUIRE(finding);
  CHECK(finding->place.facet == 0);
  CHECK(finding->detail.find("would not intersect") != std::string::npos);
}

TEST_CASE("diagonals that change nothing are not named") {
  CHECK_FALSE(first_finding(slab_report(6, 8, 5), 804));  // both diagonals are above the bottom
  CHECK_FALSE(first_finding(slab_report(8, 8, 5), 804));  // the top is exactly planar
  CHECK_FALSE(first_finding(report_of({cube(4)}), 804));  // the facets are planar
  const Report through = slab_report(2, 4, 5);            // both diagonals run through the bottom
  CHECK(error_codes(through) == Codes{306});
}

TEST_CASE("a diagonal that would only touch the bottom is named too") {
  CHECK(first_finding(slab_report(5, 8, 5), 804));
}

TEST_CASE("a closed shell without volume is reported as 806, beside the error that flattened it") {
  const Point a{0, 0, 0};
  const Point b{4, 0, 0};
  const Point c{4, 4, 0};
  const Point d{0, 4, 0};
  const Report report = report_of({{{{a, b, c}}, {{a, c, d}}, {{a, d, b}}, {{b, d, c}}}});
  CHECK(report.verdict == Verdict::invalid);
  CHECK(error_codes(report).count(405) == 0);
  CHECK(error_codes(report).count(306) == 1);
  CHECK(first_finding(report, 806));
}

TEST_CASE(
    "a ring that its source left open is 103, and the rest is judged as if the ring were closed") {
  const std::vector<Index> unclosed{2, 4};
  CertifyOptions options;
  options.unclosed_rings = unclosed;
  const Report report = report_of({cube(4)}, options);
  CHECK(error_codes(report) == Codes{103});
  REQUIRE(report.findings.size() == 2);
  CHECK(report.findings[0].place.facet == 2);
  CHECK(report.findings[0].place.ring == 0);
  CHECK(report.findings[1].place.facet == 4);
  CHECK(report.first_level == std::vector<int>{103});
  const std::vector<Index> beyond{99};  // an index out of range must not cause a crash
  options.unclosed_rings = beyond;
  CHECK(report_of({cube(4)}, options).verdict == Verdict::valid);
}

TEST_CASE("the tolerant verdict snaps a millimetre and decides nothing") {
  Shell shell = cube(1000);
  shell[1][0][2].x = 1001;  // one corner of the top is off by one step
  CertifyOptions options;
  options.also_tolerant = true;
  const auto report_at = [&](double step) {
    return certify(solid_of({shell}, lattice_of(step)), nullptr, options).report;
  };
  const Report half = report_at(0.0005);
  CHECK(half.verdict == Verdict::invalid);
  REQUIRE(half.tolerant);
  CHECK(half.tolerant->verdict == Verdict::valid);
  CHECK(half.tolerant->first_level.empty());
  const Report large = report_at(0.01);
  REQUIRE(large.tolerant);
  CHECK(large.tolerant->verdict == Verdict::invalid);
  CHECK(large.tolerant->first_level == large.first_level);
  options.tolerant_snap_metres = 0.02;
  CHECK(report_at(0.01).verdict == Verdict::invalid);
  CHECK(report_at(0.01).tolerant->verdict == Verdict::valid);
  options.tolerant_snap_metres = 0.0001;
  CHECK(report_at(0.0005).tolerant->verdict == Verdict::invalid);
  CHECK_FALSE(report_of({cube(4)}).tolerant);
}

TEST_CASE("a fold of 45 degrees is measured at every size that can be read") {
  for (const double scale : {1e-300, 1e-150, 1e-82, 1e-81, 1e-3, 1e69, 1e77, 1e154, 1e300}) {
    Shell shell = cube(1);
    for (Facet& facet : shell) {
      for (auto& ring : facet) {
        for (Point& p : ring) {
          if (p == Point{1, 1, 1}) p.z = 2;
          p = {p.x * scale, p.y * scale, p.z * scale};
        }
      }
    }
    const Report report = report_of({shell});
    INFO(scale);
    // Small folds are within 0.01 m of a plane; the angle does not depend on the size.
    const Finding* finding = first_finding(report, scale < 0.01 ? 204 : 203);
    REQUIRE(finding);
    if (scale < 0.01) CHECK(std::abs(*finding->measured - 54.7) < 0.1);
  }
}

TEST_CASE("a solid of a size that underflows when it is squared is valid") {
  for (const double scale : {1e-300, 1e-160, 1e-82}) {
    Shell shell = cube(1000);
    for (Facet& facet : shell) {
      for (auto& ring : facet) {
        for (Point& p : ring) {
          if (p == Point{1000, 1000, 1000}) p.z = 1001;
          p = {p.x * scale, p.y * scale, p.z * scale};
        }
      }
    }
    INFO(scale);
    CHECK(error_codes(report_of({shell})).empty());
  }
}

/// A roof of 10 x 10 m with one corner 36 mm up and points along one edge, which pull the plane of
/// least squares towards that edge.
Shell roof_with_points(int count) {
  Shell shell = cube(10000);
  for (Facet& facet : shell) {
    for (auto& ring : facet) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        if (ring[i] == Point{10000, 10000, 10000}) ring[i].z = 10036;
        const Point& a = ring[i];
        const Point b = ring[(i + 1) % ring.size()];
        if (a.y != 0 || b.y != 0 || a.z != 10000 || b.z != 10000) continue;
        std::vector<Point> between;
        for (int k = 1; k <= count; ++k) {
          between.push_back({a.x + (b.x - a.x) * k / (count + 1), 0, 10000});
        }
        ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1, between.begin(),
                    between.end());
        i += between.size();
      }
    }
  }
  return shell;
}

TEST_CASE("203 measures the distance to the plane of least squares, and no smaller one") {
  const Report none = certify(solid_of({roof_with_points(0)}, lattice_of(0.001)), nullptr).report;
  CHECK(error_codes(none).empty());  // 9 mm off the plane
  const Report many = certify(solid_of({roof_with_points(49)}, lattice_of(0.001)), nullptr).report;
  const Finding* finding = first_finding(many, 203);
  REQUIRE(finding);
  CHECK(*finding->measured > 0.0155);
  CHECK(*finding->measured < 0.0170);
}

TEST_CASE(
    "a cube of half a millimetre is valid, and collapses when it is snapped for the tolerant "
    "verdict") {
  CertifyOptions options;
  options.also_tolerant = true;
  const Report report = certify(solid_of({cube(5)}, lattice_of(0.0001)), nullptr, options).report;
  CHECK(report.verdict == Verdict::valid);
  CHECK(first_finding(report, 801));
  REQUIRE(report.tolerant);
  CHECK(report.tolerant->verdict == Verdict::invalid);
  CHECK(report.tolerant->first_level == std::vector<int>{102});
}

TEST_CASE("tolerances are metres in degrees and in feet") {
  // One corner is lifted by 30 units, which is 7.5 units off the fitted plane.
  Shell shell = cube(1000);
  for (Facet& facet : shell) {
    for (Point& p : facet[0]) {
      if (p == Point{1000, 1000, 1000}) p.z = 1030;
    }
  }
  const auto codes = [&](std::uint32_t srid, double horizontal, double vertical) {
    Lattice lattice;
    lattice.step = {geometry::shortest_decimal(horizontal), geometry::shortest_decimal(horizontal),
                    geometry::shortest_decimal(vertical)};
    CertifyOptions options;
    options.proof = Proof::boundary;
    return error_codes(certify(solid_of({shell}, lattice, srid), nullptr, options).report);
  };
  for (const std::uint32_t srid : {4326U, 4979U, 6697U}) {
    INFO(srid);
    CHECK(codes(srid, 1e-7, 0.001).empty());        // a house 0.0001 degrees wide: 7.5 mm off
    CHECK(codes(srid, 1e-7, 0.002) == Codes{203});  // 15 mm off
  }
  CHECK(codes(2263, 0.0033, 0.0033).empty());      // US feet: 7.5 mm off
  CHECK(codes(2263, 0.005, 0.005) == Codes{203});  // 11.4 mm off
}

TEST_CASE("a notch a hundred-thousandth of a micrometre from a wall is no contact") {
  // A notch from above ends one step from the wall x = 0 of a model of 2^52 steps.
  const double size = 4503599627370496.0;
  const auto prism = [&](double gap) {
    const std::vector<std::array<double, 2>> outline{
        {0, 0}, {size, 0}, {size, size}, {gap + 2, size}, {gap + 1, 8}, {gap, size}, {0, size}};
    Shell shell;
    Ring low;
    Ring high;
    for (const auto& [x, y] : outline) {
      low.push_back({x, y, 0});
      high.push_back({x, y, size});
    }
    for (std::size_t i = 0; i < low.size(); ++i) {
      const std::size_t j = (i + 1) % low.size();
      shell.push_back({{low[i], low[j], high[j], high[i]}});
    }
    std::reverse(low.begin(), low.end());
    shell.push_back({low});
    shell.push_back({high});
    return shell;
  };
  CertifyOptions options;
  options.proof = Proof::boundary;
  CHECK(report_of({prism(1)}, options).verdict == Verdict::valid);
  CHECK_FALSE(error_codes(report_of({prism(0)}, options)).empty());
}

TEST_CASE("a vertex far away that no facet uses is a warning") {
  SolidArrays arrays = solid_of({cube(4)}).arrays();
  arrays.vertices.push_back({-1e16, 0, 0});
  const auto solid = Solid::make(std::move(arrays), Lattice{}, 0);
  REQUIRE(solid);
  CertifyOptions options;
  options.also_tolerant = true;
  const Report report = certify(*solid, nullptr, options).report;
  CHECK(report.verdict == Verdict::valid);
  CHECK(first_finding(report, 802));
}

TEST_CASE("dents whose tip lies exactly on the facet across are found, every one") {
  std::mt19937 random(11);
  for (int round = 0; round < 60; ++round) {
    // A dent in the shape of a tetrahedron goes from the bottom of a slanted block to the middle of
    // the top.
    const double s = 2 * (1 + double(random() % 500'000));
    const double z = 2 * (1 + double(random() % 500'000));
    const double lift = 2 * double(random() % 100'000);
    const Point a{0, 0, 0};
    const Point b{2 * s, 0, 0};
    const Point c{2 * s, 2 * s, 0};
    const Point d{0, 2 * s, 0};
    const auto block = [&](double below) {
      const Point tip{s, s, z + lift / 2 - below};
      const Point e{0, 0, z};
      const Point f{2 * s, 0, z + lift};
      const Point g{2 * s, 2 * s, z + lift};
      const Point h{0, 2 * s, z};
      return Shell{{{e, f, g, h}}, {{b, a, tip}},  {{c, b, tip}},  {{d, c, tip}}, {{a, d, tip}},
                   {{a, b, f, e}}, {{b, c, g, f}}, {{c, d, h, g}}, {{d, a, e, h}}};
    };
    CertifyOptions options;
    options.proof = Proof::boundary;
    CHECK(error_codes(report_of({block(0)}, options)) == Codes{306});
    CHECK(report_of({block(1)}, options).verdict == Verdict::valid);
  }
}

TEST_CASE("planarity is measured where rings bound no region, as val3dity does first") {
  Shell shell = cube(8);
  // A bow tie with one corner far off its plane.
  shell[1] = {Ring{{0, 0, 8}, {8, 8, 20}, {8, 0, 8}, {0, 8, 8}}};
  const Report report = report_of({shell});
  CHECK(error_codes(report).count(104) == 1);
  CHECK(error_codes(report).count(203) == 1);
  CHECK(report.first_level == std::vector<int>{203});
}

TEST_CASE("first_level looks at each shell by itself, and 405 ends the tests of the solid") {
  const auto finding = [](int code, Index shell, Index facet) {
    Finding result;
    result.code = code;
    result.place.shell = shell;
    result.place.facet = facet;
    return result;
  };
  using List = std::vector<int>;
  CHECK(validate::first_level_codes({finding(203, 0, 1), finding(306, 0, 2), finding(302, 1, 9)}) ==
        List{203, 302});
  CHECK(validate::first_level_codes({finding(204, 0, 1), finding(303, 1, 9)}) == List{204, 303});
  CHECK(validate::first_level_codes({finding(405, 1, kNone), finding(401, 1, kNone)}) == List{405});
  CHECK(validate::first_level_codes({finding(103, 0, 1), finding(101, 0, 2)}) == List{103});
  CHECK(validate::first_level_codes({finding(300, 0, 1)}) == List{303});
}

TEST_CASE("the farthest pair of normals is found among thousands of triangles") {
  // A disc of 6,000 corners is uneven within the tolerance; one corner makes a steep, thin
  // triangle.
  Ring ring;
  const int n = 6000;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * 3.14159265358979 * i / n;
    ring.push_back({std::nearbyint(1e8 * std::cos(angle)), std::nearbyint(1e8 * std::sin(angle)),
                    double(i * 7919 % 5)});
  }
  Shell shell{{ring}};
  const Point apex{0, 0, -100'000'000};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    shell.push_back({{ring[(i + 1) % ring.size()], ring[i], apex}});
  }
  CertifyOptions options;
  options.proof = Proof::boundary;
  const auto codes = [&](double degrees) {
    options.tolerances.planarity_degrees = degrees;
    return error_codes(certify(solid_of({shell}, lattice_of(0.0001)), nullptr, options).report);
  };
  CHECK(codes(20).empty());
  CHECK(codes(1e-6) == Codes{204});
}

TEST_CASE("a thousand vertices at nearly one place are counted, and the closest two are named") {
  std::vector<Shell> shells{cube(100'000)};
  for (int i = 1; i <= 250; ++i) {  // tetrahedra of 4 to 8 steps, side by side
    shells.push_back(inside_out(corner({1000.0 + 10 * i, 1000, 1000}, 4 + i % 5)));
  }
  const Report report = certify(solid_of(shells, lattice_of(1e-6)), nullptr).report;
  const Finding* finding = first_finding(report, 801);
  REQUIRE(finding);
  CHECK(finding->detail.find("1000 vertices") == 0);
  REQUIRE(finding->measured);
  // The distance from a tetrahedron of 8 steps to the next one.
  CHECK(std::fabs(*finding->measured - 2e-6) < 1e-12);
}

TEST_CASE("many cavities are located, and the one that is nested is found") {
  std::vector<Shell> shells{cube(1000)};
  for (int i = 0; i < 400; ++i) {
    const Point low{10.0 + 40 * (i % 20), 10.0 + 40 * (i / 20), 500};
    shells.push_back(inside_out(box(low, {low.x + 30, low.y + 30, 530})));
  }
  CHECK(error_codes(report_of(shells)).empty());
  shells.push_back(inside_out(box({15, 15, 505}, {20, 20, 510})));
  const Report report = report_of(shells);
  CHECK(error_codes(report) == Codes{401});
  CHECK(report.findings.size() == 1);
}

TEST_CASE("T-junctions are found along edges with thousands of vertices") {
  Shell shell = cube(3000);
  Ring top{{0, 0, 3000}};
  for (int i = 1; i < 3000; ++i) top.push_back({double(i), 0, 3000});
  top.insert(top.end(), {{3000, 0, 3000}, {3000, 3000, 3000}, {0, 3000, 3000}});
  shell[1] = {top};
  CertifyOptions options;
  options.proof = Proof::boundary;
  const Report report = report_of({shell}, options);
  CHECK(error_codes(report) == Codes{302});
  CHECK(report.findings.size() == 2999);
  for (const Finding& finding : report.findings) CHECK(finding.place.facet == 2);
}

TEST_CASE("the search for the problems of one large ring can be cancelled") {
  Ring ring;  // a comb whose teeth overlap in one axis, with a loop in its back
  for (int i = 0; i < 2000; ++i) {
    ring.push_back({0.0, 2.0 * i, 0});
    ring.push_back({1000.0, 2.0 * i + 1, 0});
  }
  for (const auto& [x, y] :
       std::vector<std::array<double, 2>>{{-10, 4000}, {-10, 5}, {-30, 0}, {-30, 5}, {-10, 0}}) {
    ring.push_back({x, y, 0});
  }
  const Solid solid = solid_of({{{ring}}});
  const auto skips_104 = [&](int after) {
    int polls = 0;
    CertifyOptions options;
    options.ladder.cancel = [&] { return ++polls > after; };
    const Report report = certify(solid, nullptr, options).report;
    CHECK(error_codes(report).count(104) == 1);
    return std::any_of(report.not_run.begin(), report.not_run.end(),
                       [](const validate::SkippedRule& rule) {
                         return rule.reason == "the search was cancelled" &&
                                std::count(rule.codes.begin(), rule.codes.end(), 104) == 1;
                       });
  };
  CHECK(skips_104(0));  // cancelled before the search
  CHECK(skips_104(1));  // cancelled in the search
  CHECK_FALSE(skips_104(1000000));
}

TEST_CASE("a cancelled validation is undecided whichever rule is running") {
  std::vector<Shell> shells{cube(100)};
  for (int i = 0; i < 9; ++i) {
    const Point low{10.0 * i + 1, 10, 10};
    shells.push_back(inside_out(box(low, {low.x + 5, 15, 15})));
  }
  const Solid solid = solid_of(shells);
  for (int after = 0; after < 12; ++after) {
    int polls = 0;
    CertifyOptions options;
    options.also_tolerant = true;
    options.ladder.cancel = [&] { return ++polls > after; };
    const Inspection inspection = certify(solid, nullptr, options);
    if (polls <= after) break;
    CHECK(inspection.report.verdict != Verdict::invalid);
    CHECK((inspection.report.verdict == Verdict::valid) == inspection.certified.has_value());
    if (inspection.report.verdict == Verdict::undecided) {
      CHECK_FALSE(inspection.report.undecided_reason.empty());
    }
  }
}
