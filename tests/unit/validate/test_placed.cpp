// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests geometry templates that are judged where an instance puts them.
#include "tests/unit/validate/solids.h"

using namespace watertight;
using namespace watertight::test;

using Codes = std::set<int>;

namespace {

geometry::Placement linear(const std::array<double, 9>& numbers) {
  geometry::Placement placement;
  for (std::size_t i = 0; i < 9; ++i) {
    placement.linear[i / 3][i % 3] = geometry::shortest_decimal(numbers[i]);
  }
  return placement;
}

geometry::Placement scaled(double x, double y, double z) {
  return linear({x, 0, 0, 0, y, 0, 0, 0, z});
}

Report placed_report(const std::vector<Shell>& shells, const geometry::Placement& placement,
                     CertifyOptions options = {}) {
  options.placement = &placement;
  return certify(solid_of(shells), nullptr, options).report;
}

/// A cube with one corner of its top raised.
Shell bent_cube(double size, double raised) {
  Shell shell = cube(size);
  for (Facet& facet : shell) {
    for (Point& p : facet[0]) {
      if (p == Point{size, size, size}) p.z += raised;
    }
  }
  return shell;
}

}  // namespace

TEST_CASE("planarity is measured in metres where the instance stands") {
  const std::vector<Shell> metres{bent_cube(1000, 36)};
  CHECK(error_codes(report_of(metres)) == Codes{203});
  CHECK(error_codes(placed_report(metres, scaled(0.001, 0.001, 0.001))).empty());
  const std::vector<Shell> flat{bent_cube(1000, 1)};
  CHECK(error_codes(placed_report(flat, scaled(1, 1, 0.01))).empty());
  CHECK(error_codes(placed_report(flat, scaled(1, 1, 1))) == Codes{203});
  // A shear of 45 degrees brings the corner of the tilted top nearer to its plane, by 1 / sqrt(2).
  const std::vector<Shell> raised{bent_cube(1000, 0.05)};  // 12.5 mm off the plane
  CHECK(error_codes(placed_report(raised, geometry::Placement{})) == Codes{203});
  CHECK(error_codes(placed_report(raised, linear({1, 0, 0, 0, 1, 0, 1, 0, 1}))).empty());
  // 204 depends on the shape: the roof becomes steep where z is stretched.
  CHECK(error_codes(placed_report({bent_cube(1000, 100)}, scaled(1e-6, 1e-6, 1e-4))).count(204) ==
        1);
  CHECK(error_codes(placed_report({bent_cube(1000, 100)}, scaled(1e-6, 1e-6, 1e-6))).empty());
}

TEST_CASE("an oblique measure is that of the placed points") {
  // The z axis of the lattice lies along x of the world, so the corner is raised along x.
  const geometry::Placement turned = linear({0, 0, 0.001, 1, 0, 0, 0, 1, 0});
  CHECK(error_codes(placed_report({bent_cube(1000, 36)}, turned)).empty());
  CHECK(error_codes(placed_report({bent_cube(1000, 36)}, linear({0, 0, 1, 1, 0, 0, 0, 1, 0}))) ==
        Codes{203});
}

TEST_CASE("a mirrored solid is inside out, and one that was inside out is not") {
  CHECK(error_codes(placed_report({cube(4)}, scaled(-1, 1, 1))) == Codes{405});
  CHECK(error_codes(placed_report({inside_out(cube(4))}, geometry::Placement{})) == Codes{405});
  CHECK(placed_report({inside_out(cube(4))}, scaled(1, -2, 1)).verdict == Verdict::valid);
  CHECK(placed_report({cube(4)}, scaled(-1, -1, 1)).verdict == Verdict::valid);
}

TEST_CASE("a determinant of zero is 306 and 806, whatever the template") {
  for (const Shell& shell : {cube(4), bent_cube(4, 1)}) {
    const Report report = placed_report({shell}, linear({0.1, 0.2, 0, 0.7, 1.4, 0, 0, 0, 1}));
    CHECK(report.verdict == Verdict::invalid);
    CHECK(error_codes(report) == Codes{306});
    REQUIRE(report.findings.size() == 2);
    CHECK(report.findings[1].code == 806);
    CHECK(report.findings[1].severity == Severity::warning);
  }
  CHECK(error_codes(placed_report({}, scaled(1, 1, 0))) == Codes{902});
}

TEST_CASE("snapping, warnings, measures and witnesses are those of the placed solid") {
  Shell gap = cube(1000);
  gap[1][0][2].x = 1001;
  CertifyOptions options;
  options.tolerances.snap_metres = 0.0015;
  CHECK(placed_report({gap}, scaled(0.001, 0.001, 0.001), options).verdict == Verdict::valid);
  CHECK(placed_report({gap}, linear({0, 0, 0.001, 0.001, 0, 0, 0, 0.001, 0}), options).verdict ==
        Verdict::valid);
  CHECK(placed_report({gap}, scaled(1, 1, 1), options).verdict == Verdict::invalid);

  geometry::Placement tiny = scaled(0.0001, 0.0001, 0.0001);
  tiny.anchor = {{{5, 1}, {6, 1}, {7, 1}}};
  const Report near = placed_report({cube(4)}, tiny);
  CHECK(near.verdict == Verdict::valid);
  REQUIRE_FALSE(near.findings.empty());
  CHECK(near.findings[0].code == 801);
  REQUIRE(near.findings[0].witness);
  CHECK((*near.findings[0].witness)[2] >= 70);
  REQUIRE(near.measures);
  CHECK(near.measures->box_min == std::array<double, 3>{50, 60, 70});

  const Report large = placed_report({cube(4)}, scaled(2, 3, 5));
  REQUIRE(large.measures);
  CHECK(large.measures->volume == 64 * 30);
  CHECK(large.measures->area == 2 * (8 * 12 + 8 * 20 + 12 * 20));
}

TEST_CASE("the units where the instance stands count: feet and degrees") {
  geometry::Placement placement;
  placement.srid = 2229;  // a system in US survey feet
  const std::vector<Shell> shells{bent_cube(1000, 0.1)};
  CHECK(error_codes(placed_report(shells, placement)).empty());  // 0.025 feet are 7.6 mm
  CHECK(error_codes(report_of(shells)) == Codes{203});
}

TEST_CASE("a template that is proven at one placement needs only the exact tests at others") {
  CertifyOptions options;
  options.is_proven = true;
  const Report valid = placed_report({cube(4)}, scaled(2, 2, 2), options);
  CHECK(valid.verdict == Verdict::valid);
  CHECK(valid.rung == delaunay::Rung::none);
  CHECK(placed_report({bent_cube(4, 1)}, scaled(2, 2, 2), options).verdict == Verdict::invalid);
}
