// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>

#include "surfaces/curves/elementary.h"
#include "surfaces/tessellate_boundary.h"
#include "tests/unit/surfaces/checked_solid.h"

namespace watertight {
namespace {

using surfaces::BoundaryRepresentation;
using surfaces::Frame;
using surfaces::Vector3;
using surfaces::operator+;
using surfaces::operator-;
using surfaces::operator*;
using test::check;

/// Two circles around the axis z at heights `low` and `high`, with a face on each plane.
BoundaryRepresentation between_circles(const Frame& frame, double low, double high,
                                       double radius_low, double radius_high) {
  BoundaryRepresentation solid;
  for (const auto& [height, radius] : {std::pair(low, radius_low), std::pair(high, radius_high)}) {
    Frame circle = frame;
    circle.origin = frame.origin + frame.z * height;
    solid.vertices.push_back(circle.origin + circle.x * radius);
    const auto vertex = static_cast<Index>(solid.vertices.size() - 1);
    solid.edges.push_back({vertex, vertex, surfaces::ellipse(circle, radius, radius), true});
  }
  solid.faces.push_back({"bottom", {}, true, {{{0, false}}}, 0, ""});
  solid.faces.push_back({"top", {}, true, {{{1, true}}}, 0, ""});
  solid.shells = {{0, 1, 2}};
  return solid;
}

/// Height and radius of a place about the axis of a frame.
std::pair<double, double> about_axis(const Frame& frame, const Vector3& place) {
  const Vector3 offset = place - frame.origin;
  const double height = surfaces::dot(offset, frame.z);
  return {height, surfaces::length(offset - frame.z * height)};
}

const Frame kTilted = surfaces::frame_of({100, 200, 30}, {1, 2, 2}, {0, 0, 1});
constexpr double kPi = std::numbers::pi;

double from_cylinder(const Vector3& place) {
  return std::abs(about_axis(kTilted, place).second - 2);
}
double from_cone(const Vector3& place) {
  const auto [height, radius] = about_axis(kTilted, place);
  return std::abs(radius - 1 - height) / std::sqrt(2.0);
}
double from_sphere(const Vector3& place) {
  return std::abs(surfaces::length(place - kTilted.origin) - 2);
}
double from_torus(const Vector3& place) {
  const auto [height, radius] = about_axis(kTilted, place);
  return std::abs(std::hypot(radius - 3, height) - 1);
}

}  // namespace

TEST_CASE("a cylinder between two circles, without a seam, becomes a valid solid") {
  for (const double chord : {0.1, 0.01, 0.001}) {
    BoundaryRepresentation solid = between_circles(kTilted, 0, 3, 2, 2);
    solid.faces.push_back(
        {"side", surfaces::cylinder(kTilted, 2), true, {{{0, true}}, {{1, false}}}, 0, ""});
    const auto result = check(solid, chord, {12 * kPi, 12 * kPi + 8 * kPi}, from_cylinder);
    CHECK(result.measures.turned == 0);
  }
}

TEST_CASE("a face whose sense is wrong is turned") {
  BoundaryRepresentation solid = between_circles(kTilted, 0, 3, 2, 2);
  solid.faces.push_back(
      {"side", surfaces::cylinder(kTilted, 2), false, {{{0, true}}, {{1, false}}}, 0, ""});
  check(solid, 0.01, {12 * kPi, 20 * kPi});
  solid.faces[1].loops[0][0].is_forward = false;
  CHECK(check(solid, 0.01, {12 * kPi, 20 * kPi}).measures.turned == 1);
}

TEST_CASE("a truncated cone and a whole one become valid solids") {
  BoundaryRepresentation solid = between_circles(kTilted, 0, 1, 1, 2);
  const auto cone = surfaces::cone(kTilted, 1, 1);
  solid.faces.push_back({"side", cone, true, {{{0, true}}, {{1, false}}}, 0, ""});
  check(solid, 0.01, {kPi * 7 / 3, kPi * (1 + 4 + 3 * std::sqrt(2.0))}, from_cone);
  // The tip is at the pole of the surface, and no vertex of the file.
  solid.faces = {solid.faces[1], {"side", cone, true, {{{1, false}}}, 0, ""}};
  solid.shells = {{0, 1}};
  check(solid, 0.01, {kPi * 8 / 3, kPi * (4 + 4 * std::sqrt(2.0))}, from_cone);
}

TEST_CASE("parts of spheres, with poles inside, become valid solids") {
  BoundaryRepresentation solid = between_circles(kTilted, 0, 1, 2, std::sqrt(3.0));
  const auto sphere = surfaces::sphere(kTilted, 2);
  solid.faces.push_back({"zone", sphere, true, {{{0, true}}, {{1, false}}}, 0, ""});
  check(solid, 0.01, {kPi * (4 - 1.0 / 3), kPi * (4 + 3 + 4)}, from_sphere);
  solid.faces = {solid.faces[0], {"dome", sphere, true, {{{0, true}}}, 0, ""}};
  solid.shells = {{0, 1}};
  check(solid, 0.01, {kPi * 16 / 3, kPi * (4 + 8)}, from_sphere);
  check(solid, 0.1, {kPi * 16 / 3, kPi * (4 + 8)}, from_sphere);
}

TEST_CASE("an octant of a sphere, with a vertex at the pole, becomes a valid solid") {
  BoundaryRepresentation solid;
  const std::array<Vector3, 3> axes{kTilted.x, kTilted.y, kTilted.z};
  solid.vertices = {kTilted.origin, kTilted.origin + axes[0] * 2.0, kTilted.origin + axes[1] * 2.0,
                    kTilted.origin + axes[2] * 2.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const Frame frame{kTilted.origin, axes[i], axes[(i + 1) % 3], axes[(i + 2) % 3]};
    const auto start = static_cast<Index>(i + 1);
    const auto end = static_cast<Index>((i + 1) % 3 + 1);
    solid.edges.push_back({start, end, surfaces::ellipse(frame, 2, 2), true});
  }
  for (Index i = 1; i <= 3; ++i) solid.edges.push_back({0, i, {}, true});
  solid.faces.push_back(
      {"ball", surfaces::sphere(kTilted, 2), true, {{{0, true}, {1, true}, {2, true}}}, 0, ""});
  for (Index i = 0; i < 3; ++i) {
    const Index next = (i + 1) % 3;
    solid.faces.push_back(
        {"plane", {}, true, {{{3 + next, true}, {i, false}, {3 + i, false}}}, 0, ""});
  }
  solid.shells = {{0, 1, 2, 3}};
  check(solid, 0.02, {kPi * 4 / 3, kPi * (2 + 3)}, from_sphere);
}

TEST_CASE("half a torus becomes a valid solid") {
  BoundaryRepresentation solid;
  for (const double side : {1.0, -1.0}) {
    const Frame ring{kTilted.origin + kTilted.x * (3 * side), kTilted.x * side, kTilted.z,
                     kTilted.y * -side};
    solid.vertices.push_back(ring.origin + ring.x * 1.0);
    const auto vertex = static_cast<Index>(solid.vertices.size() - 1);
    solid.edges.push_back({vertex, vertex, surfaces::ellipse(ring, 1, 1), true});
  }
  solid.faces.push_back({"start", {}, true, {{{0, true}}}, 0, ""});
  solid.faces.push_back({"end", {}, true, {{{1, false}}}, 0, ""});
  solid.faces.push_back(
      {"tube", surfaces::torus(kTilted, 3, 1), true, {{{0, false}}, {{1, true}}}, 0, ""});
  solid.shells = {{0, 1, 2}};
  check(solid, 0.02, {kPi * kPi * 3, kPi * (6 * kPi + 2)}, from_torus);
}

TEST_CASE("faces that cannot be tessellated are named, and the others stay") {
  BoundaryRepresentation solid = between_circles(kTilted, 0, 3, 2, 2);
  solid.faces.push_back({"side", surfaces::cylinder(kTilted, 2), true, {{{0, true}}}, 0, ""});
  const auto result = surfaces::tessellate(solid);
  REQUIRE(result);
  REQUIRE(result->left_out.size() == 1);
  CHECK(result->left_out[0].name == "side");
  CHECK(result->arrays.facet_offsets.size() == 3);
  solid.faces[2] = {"side", surfaces::cylinder(kTilted, 9), true, {{{0, true}}, {{1, false}}}, 0,
                    ""};
  REQUIRE(surfaces::tessellate(solid)->left_out.size() == 1);
  CHECK(surfaces::tessellate(solid)->left_out[0].reason.find("off the surface") !=
        std::string::npos);
  solid.faces[2].unreadable = "a surface of a kind that is not read";
  CHECK(surfaces::tessellate(solid)->left_out[0].reason == solid.faces[2].unreadable);
}

TEST_CASE("limits and wrong numbers are errors") {
  BoundaryRepresentation solid = between_circles(kTilted, 0, 3, 2, 2);
  solid.faces.push_back(
      {"side", surfaces::cylinder(kTilted, 2), true, {{{0, true}}, {{1, false}}}, 0, ""});
  surfaces::TessellateOptions options;
  for (const double chord : {0.0, -1.0, std::nan("")}) {
    options.chord = chord;
    CHECK(surfaces::tessellate(solid, options).error().code == ErrorCode::invalid_argument);
  }
  options.chord = 1e-6;
  options.most_triangles = 100;
  CHECK(surfaces::tessellate(solid, options).error().code == ErrorCode::limit_exceeded);
  solid.faces[0].loops[0][0].edge = 7;
  CHECK(surfaces::tessellate(solid).error().code == ErrorCode::malformed);
}

}  // namespace watertight
