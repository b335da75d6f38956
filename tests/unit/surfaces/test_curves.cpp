// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>

#include "surfaces/curves/elementary.h"
#include "surfaces/curves/nurbs.h"
#include "surfaces/invert_point.h"

namespace watertight {
namespace {

using surfaces::Curve;
using surfaces::Frame;
using surfaces::Parameters;
using surfaces::Surface;
using surfaces::Vector3;
using surfaces::operator-;
using surfaces::operator+;
using surfaces::operator*;

Frame tilted() { return surfaces::frame_of({1, 2, 3}, {1, 2, 2}, {0, 0, 1}); }

double radius_at(const Frame& frame, const Vector3& place) {
  const Vector3 offset = place - frame.origin;
  return surfaces::length(offset - frame.z * surfaces::dot(offset, frame.z));
}

// A curve or surface by its definition: the B-spline basis of Cox and de Boor.
double basis(const std::vector<double>& knots, std::size_t i, std::size_t degree, double t) {
  if (degree == 0) return knots[i] <= t && t < knots[i + 1] ? 1 : 0;
  const auto part = [](double top, double bottom) { return bottom > 0 ? top / bottom : 0; };
  return part(t - knots[i], knots[i + degree] - knots[i]) * basis(knots, i, degree - 1, t) +
         part(knots[i + degree + 1] - t, knots[i + degree + 1] - knots[i + 1]) *
             basis(knots, i + 1, degree - 1, t);
}

}  // namespace

TEST_CASE("a circle has its radius everywhere and closes") {
  const Frame frame = tilted();
  const Curve circle = surfaces::ellipse(frame, 2.5, 2.5);
  for (double t = -4; t < 8; t += 0.037) {
    const auto at = point_at(circle, t);
    CHECK(std::abs(surfaces::length(at.place - frame.origin) - 2.5) < 1e-14);
    const auto next = point_at(circle, t + 1e-6);
    CHECK(surfaces::length((next.place - at.place) * 1e6 - at.derivative) < 1e-5);
  }
  CHECK(std::abs(surfaces::nearest_parameter(circle, point_at(circle, 3.3).place) - 3.3) < 1e-12);
}

TEST_CASE("surfaces have their radii, and inversion finds the coordinates of their points") {
  const Frame frame = tilted();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  const Surface cylinder = surfaces::cylinder(frame, 3);
  const Surface cone = surfaces::cone(frame, 2, surfaces::tangent(0.5));
  const Surface sphere = surfaces::sphere(frame, 4);
  const Surface torus = surfaces::torus(frame, 5, 2);
  for (const Surface* surface : {&cylinder, &cone, &sphere, &torus}) {
    const surfaces::Inverter inverter(*surface, 1e-10);
    for (int round = 0; round < 300; ++round) {
      const Parameters at{
          4 * share(random),
          surface->v_breaks.front() + (0.02 + 0.96 * share(random)) *
                                          (surface->v_breaks.back() - surface->v_breaks.front())};
      const auto point = point_at(*surface, at);
      const Vector3 offset = point.place - frame.origin;
      const double height = surfaces::dot(offset, frame.z);
      const double radius = radius_at(frame, point.place);
      if (surface == &cylinder) CHECK(std::abs(radius - 3) < 1e-13);
      if (surface == &cone) CHECK(std::abs(radius - 2 - height * std::tan(0.5)) < 1e-13);
      if (surface == &sphere) CHECK(std::abs(surfaces::length(offset) - 4) < 1e-13);
      if (surface == &torus) CHECK(std::abs(std::hypot(radius - 5, height) - 2) < 1e-13);
      // The outer side is where u turns left to v.
      const Vector3 normal = surfaces::cross(point.along_u, point.along_v);
      const Vector3 spoke = offset - frame.z * height;
      const Vector3 out = surface == &sphere  ? offset
                          : surface == &torus ? offset - spoke * (5 / radius)
                                              : spoke;
      CHECK(surfaces::dot(normal, out) > 0);
      const auto found = inverter.invert(point.place, {});
      CHECK(found.gap < 1e-10);
      CHECK(surfaces::length(point_at(*surface, found.at).place - point.place) < 1e-10);
    }
  }
  CHECK(poles_of(cylinder).empty());
  CHECK(poles_of(torus).empty());
  CHECK(poles_of(cone).size() == 1);
  CHECK(poles_of(sphere).size() == 2);
}

TEST_CASE("a B-spline is what its basis functions say") {
  const surfaces::Knots knots{3, {0, 0, 0, 0, 1, 1, 2.5, 4, 4, 4, 4}};
  std::vector<Vector3> points;
  std::vector<double> weights;
  for (std::size_t i = 0; i < 7; ++i) {
    const auto x = static_cast<double>(i);
    points.push_back({x, x * x / 3, std::cos(x)});
    weights.push_back(1 + 0.3 * static_cast<double>(i % 3));
  }
  const auto curve = surfaces::curve_of(knots, points, weights);
  REQUIRE(curve);
  for (double t = 0; t < 4; t += 0.11) {
    Vector3 sum{};
    double weight = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double part = basis(knots.values, i, 3, t) * weights[i];
      sum = sum + points[i] * part;
      weight += part;
    }
    CHECK(surfaces::length(point_at(*curve, t).place - sum * (1 / weight)) < 1e-13);
  }
}

TEST_CASE("knots and weights that make no B-spline are refused") {
  const std::vector<Vector3> points{{0, 0, 0}, {1, 0, 0}, {2, 1, 0}};
  const std::vector<double> ones{1, 1, 1};
  CHECK(surfaces::curve_of({2, {0, 0, 0, 1, 1, 1}}, points, ones));
  CHECK_FALSE(surfaces::curve_of({2, {0, 0, 1, 0, 1, 1}}, points, ones));
  CHECK_FALSE(surfaces::curve_of({2, {0, 0, 0, 1, 1}}, points, ones));
  CHECK_FALSE(surfaces::curve_of({2, {0, 0, 0, 0, 0, 0}}, points, ones));
  CHECK_FALSE(surfaces::curve_of({0, {0, 1, 2, 3}}, points, ones));
  CHECK_FALSE(surfaces::curve_of({2, {0, 0, 0, 1, 1, 1}}, points, {1, 0, 1}));
  CHECK_FALSE(surfaces::curve_of({2, {0, 0, 0, 1, 1, 1}}, points, {1, 1}));
  CHECK_FALSE(surfaces::curve_of({2, {0, 0, 0, 1, 1, std::nan("")}}, points, ones));
  CHECK_FALSE(surfaces::curve_of({40, {0, 1}}, points, ones));
}

TEST_CASE("bounds of second derivatives hold, and chords are as near as their bound says") {
  const Surface torus = surfaces::torus(tilted(), 5, 2);
  const surfaces::Bends bends(torus);
  const auto most = bends.over({0, 0}, {4, 4});
  const double h = 1e-4;
  for (double u = 0.01; u < 4; u += 0.17) {
    for (double v = 0.01; v < 4; v += 0.23) {
      const auto second = [&](double du, double dv) {
        const Vector3 one = point_at(torus, {u + du, v + dv}).place;
        const Vector3 other = point_at(torus, {u - du, v - dv}).place;
        return surfaces::length(one + other - point_at(torus, {u, v}).place * 2) / (h * h);
      };
      CHECK(second(h, 0) < most.uu * 1.001);
      CHECK(second(0, h) < most.vv * 1.001);
    }
  }
  CHECK(most.uu < 7 * 7);  // the largest is 7 * 2.9
  const Curve circle = surfaces::ellipse(tilted(), 2, 2);
  for (const double part : {1.0, 0.5, 0.1}) {
    const auto piece = part_of(circle.pieces[0], 0, part);
    const double bound = chord_error_bound(piece);
    const Vector3 start = piece.points.front().place();
    const Vector3 end = piece.points.back().place();
    const double half = surfaces::length(end - start) / 2;
    const double error = 2 - std::sqrt(4 - half * half);
    CHECK(bound >= error);
    CHECK(bound < 1.1 * error);
  }
}

}  // namespace watertight
