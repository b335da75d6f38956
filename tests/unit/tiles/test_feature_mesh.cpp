// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "formats/city_json/city_json.h"
#include "tiles/feature_mesh.h"

namespace watertight {
namespace {

using Catch::Approx;
using formats::CityFeature;
using tiles::FeatureMesh;
using tiles::Frame;
using tiles::Look;

Frame local_frame() {
  const auto frame = Frame::at(0, {0, 0, 0});
  REQUIRE(frame);
  return *frame;
}

FeatureMesh mesh_of(CityFeature feature, const std::string& type = "Building") {
  feature.shapes.kinds.resize(feature.shapes.polygons.size());
  auto mesh = tiles::mesh_of(std::move(feature), "a", type, 0, local_frame());
  REQUIRE(mesh);
  return *std::move(mesh);
}

/// Square metres of all triangles.
double area_of(const FeatureMesh& mesh) {
  double area = 0;
  for (const auto& list : mesh.triangles) {
    for (const Triangle& triangle : list) {
      std::array<std::array<double, 3>, 2> way{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < 2; ++k) {
          way[k][axis] = (static_cast<double>(mesh.vertices[triangle[k + 1]][axis]) -
                          mesh.vertices[triangle[0]][axis]) /
                         tiles::kStepsOfAMetre;
        }
      }
      area += std::hypot(way[0][1] * way[1][2] - way[0][2] * way[1][1],
                         way[0][2] * way[1][0] - way[0][0] * way[1][2],
                         way[0][0] * way[1][1] - way[0][1] * way[1][0]) /
              2;
    }
  }
  return area;
}

CityFeature facet_of(std::vector<std::array<double, 3>> positions,
                     formats::CityShapes::Polygon polygon) {
  CityFeature feature;
  feature.shapes.positions = std::move(positions);
  feature.shapes.polygons.push_back(std::move(polygon));
  return feature;
}

TEST_CASE("triangles of a facet with a hole cover what the facet covers") {
  const FeatureMesh mesh = mesh_of(
      facet_of({{0, 0, 1}, {8, 0, 1}, {8, 8, 1}, {0, 8, 1}, {2, 2, 1}, {2, 4, 1}, {4, 4, 1}},
               {{0, 1, 2, 3}, {4, 5, 6}}));
  CHECK(area_of(mesh) == Approx(64 - 2));
  CHECK(mesh.triangles[static_cast<std::size_t>(Look::building)].size() == mesh.triangle_count());
  CHECK(mesh.unfilled_facets == 0);
}

TEST_CASE("a ring that crosses itself is filled by the even-odd rule") {
  // An upright bow tie in the plane x = y: its lobes turn against each other, and its area vector
  // is zero.
  const FeatureMesh mesh =
      mesh_of(facet_of({{0, 0, 0}, {3, 3, 4}, {3, 3, 0}, {0, 0, 4}}, {{0, 1, 2, 3}}));
  CHECK(area_of(mesh) == Approx(2 * (std::sqrt(18.0) / 2 * 4 / 2)).epsilon(1e-3));
  for (const auto& vertex : mesh.vertices) CHECK(vertex[0] == vertex[1]);
}

TEST_CASE("a hole that reaches out of its facet is filled where one ring covers") {
  const FeatureMesh mesh = mesh_of(facet_of(
      {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {2, 1, 0}, {6, 1, 0}, {6, 3, 0}, {2, 3, 0}},
      {{0, 1, 2, 3}, {4, 5, 6, 7}}));
  CHECK(area_of(mesh) == Approx(16 + 8 - 2 * 4));
}

TEST_CASE("a facet on a line has no triangles, one whose edges cross too often is counted") {
  CHECK(mesh_of(facet_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}})).is_empty());
  std::vector<std::array<double, 3>> star;
  formats::CityShapes::Ring ring;
  constexpr std::size_t kPoints = 2001;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double turn = static_cast<double>(i * (kPoints / 2)) * 6.283185307179586 / kPoints;
    star.push_back({std::round(1e6 * std::cos(turn)), std::round(1e6 * std::sin(turn)), 0});
    ring.push_back(i);
  }
  const FeatureMesh mesh = mesh_of(facet_of(star, {ring}));
  CHECK(mesh.unfilled_facets == 1);
  CHECK(mesh.triangle_count() == 0);
}

TEST_CASE("a position beyond all numbers takes its facet away, and no other") {
  CityFeature feature =
      facet_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {std::numeric_limits<double>::infinity(), 0, 0}},
               {{0, 1, 2}});
  feature.shapes.polygons.push_back({{0, 1, 3}});
  CHECK(mesh_of(std::move(feature)).triangle_count() == 1);
}

TEST_CASE("lines and points are kept") {
  CityFeature feature;
  feature.shapes.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  feature.shapes.lines = {{0, 1, 2}};
  feature.shapes.points = {2};
  const FeatureMesh mesh = mesh_of(std::move(feature));
  CHECK(mesh.lines.size() == 2);
  CHECK(mesh.points.size() == 1);
  CHECK_FALSE(mesh.is_empty());
}

TEST_CASE("surfaces look like their semantics, without them like their object") {
  const std::string header =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
      R"("CityObjects":{},"vertices":[]})";
  const std::string text =
      R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"WaterBody","geometry":[)"
      R"({"type":"Solid","lod":"2","boundaries":[[[[0,1,2]],[[0,1,3]],[[1,2,3]],[[0,2,3]]]],)"
      R"("semantics":{"surfaces":[{"type":"RoofSurface"},{"type":"WallSurface"},)"
      R"({"type":"Window"}],"values":[[0,1,null,2]]}}]}},)"
      R"("vertices":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]})";
  const auto reader = formats::CityFeatureReader::make(header);
  REQUIRE(reader);
  auto feature = reader->read(text);
  REQUIRE(feature);
  const auto mesh = tiles::mesh_of(*std::move(feature), "a", "WaterBody", 0, local_frame());
  REQUIRE(mesh);
  CHECK(mesh->triangles[static_cast<std::size_t>(Look::roof)].size() == 1);
  CHECK(mesh->triangles[static_cast<std::size_t>(Look::wall)].size() == 1);
  CHECK(mesh->triangles[static_cast<std::size_t>(Look::water)].size() == 2);
}

TEST_CASE("the frame of a place in the Netherlands leads back to the centre of the Earth") {
  // Amersfoort, the origin of EPSG:28992; position and radius by PROJ's cs2cs.
  const auto frame = Frame::at(28992, {155000, 463000, 0});
  REQUIRE(frame);
  CHECK(frame->is_on_earth());
  const auto matrix = frame->matrix();
  const double radius = std::hypot(matrix[12], matrix[13], matrix[14]);
  CHECK(radius == Approx(6364905).margin(200));
  const std::vector<Frame::Position> positions{
      {155000, 463000, 10}, {155100, 463000, 0}, {155000, 463100, 0}};
  const auto placed = frame->place(28992, positions);
  REQUIRE(placed);
  const auto metres = [&](std::size_t i, std::size_t axis) {
    return (*placed)[i][axis] / tiles::kStepsOfAMetre;
  };
  CHECK(metres(0, 2) == Approx(10).margin(0.001));
  CHECK(metres(1, 0) == Approx(100).margin(0.05));
  CHECK(metres(2, 1) == Approx(100).margin(0.05));
}

TEST_CASE("positions that are not in the stated system, or far away, are refused") {
  CHECK_FALSE(Frame::at(4326, {1670.4, 339279.0, 18}));
  CHECK_FALSE(Frame::at(1, {0, 0, 0}));
  const std::vector<Frame::Position> far{{3e6, 0, 0}};
  CHECK_FALSE(local_frame().place(0, far));
  const auto on_earth = Frame::at(28992, {155000, 463000, 0});
  REQUIRE(on_earth);
  CHECK_FALSE(on_earth->place(0, far));
}

}  // namespace
}  // namespace watertight
