// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <numeric>
#include <vector>

#include "spline/dms_surface.h"
#include "tests/unit/spline/grid_with_hole.h"
#include "tests/unit/spline/scenes.h"
#include "validate/certify.h"

namespace watertight {
namespace {

using samples::ClosedScene;
using samples::Point;

/// Every hole of a scene has the least energy among surfaces with other coefficients.
void check_least_energy(const samples::Scene& scene) {
  const auto domain = scene.domain();
  REQUIRE(domain);
  const auto& hole = scene.holes().back();
  const double least = spline::thin_plate_energy(*domain, hole.triangles, scene.coefficients());
  samples::Numbers numbers(13);
  for (int round = 0; round < 20; ++round) {
    std::vector<Point> moved = scene.coefficients();
    for (const samples::Index t : hole.triangles) {
      for (std::size_t i = 0; i < domain->functions_per_triangle(); ++i) {
        Point& c = moved[t * domain->functions_per_triangle() + i];
        c.z += numbers.between(-1e-3, 1e-3);
      }
    }
    CHECK(spline::thin_plate_energy(*domain, hole.triangles, moved) > least);
  }
}

void check_scene(const Result<ClosedScene>& closed) {
  INFO((closed ? closed->name : to_string(closed.error())));
  REQUIRE(closed);
  const auto jumps = samples::jumps_of(closed->scene);
  CHECK(jumps.value <= 1e-9);
  CHECK(jumps.derivative <= 1e-9);
  check_least_energy(closed->scene);
  const auto solid = samples::solid_of(*closed);
  REQUIRE(solid);
  CertifyOptions rules;
  rules.proof = Proof::boundary;
  const Inspection inspection = certify(*solid, nullptr, rules);
  for (const Finding& finding : inspection.report.findings) UNSCOPED_INFO(finding.code);
  CHECK(inspection.report.verdict == Verdict::valid);
}

/// The Gaussian curvature at places.
std::vector<double> curvatures(const ClosedScene& closed, const std::vector<Point>& places) {
  const auto domain = closed.scene.domain();
  const auto surface = spline::DmsSurface::make(*domain, closed.scene.coefficients());
  std::vector<double> found;
  for (const auto& at : surface->values(places, 2)) {
    REQUIRE(at);
    found.push_back(spline::gaussian_curvature(*at));
  }
  return found;
}

TEST_CASE("the cap of a truncated cone is rounded") {
  const auto closed = samples::cone_cap();
  check_scene(closed);
  std::vector<Point> places;
  for (int i = -4; i <= 4; ++i) {
    for (int j = -4; j <= 4; ++j) places.push_back({0.1 * i, 0.1 * j, 0});
  }
  CHECK(std::ranges::min(curvatures(*closed, places)) > 0.1);
}

TEST_CASE("a hole of five sides between three rectangles is a saddle in its middle") {
  const auto closed = samples::five_sided_hole();
  check_scene(closed);
  REQUIRE(closed->scene.holes().size() == 4);
  CHECK(curvatures(*closed, {{0, 0, 0}})[0] < 0);
  // Second derivatives jump from piece to piece: the mean around the middle says more.
  std::vector<Point> places;
  for (int i = -6; i <= 6; ++i) {
    for (int j = -6; j <= 6; ++j) {
      if (i * i + j * j <= 36) places.push_back({0.04 * i, 0.04 * j, 0});
    }
  }
  const std::vector<double> found = curvatures(*closed, places);
  CHECK(std::accumulate(found.begin(), found.end(), 0.0) / static_cast<double>(found.size()) <
        -0.02);
}

TEST_CASE("a vertical pipe is joined to an opening in a horizontal one") {
  check_scene(samples::tee_joint());
}

TEST_CASE("three pipes are joined to the flat bottom of a basin") {
  check_scene(samples::junction());
}

}  // namespace
}  // namespace watertight
