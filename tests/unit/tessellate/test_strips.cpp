// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "tessellate/strips.h"
#include "tessellate/trimmed/grid.h"
#include "tessellate/trimmed/region.h"

namespace watertight {
namespace {

using tessellate::Strip;

// Each triangle from its smallest vertex on, sorted.
std::vector<Triangle> normal_form(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

std::vector<Triangle> all_of(const std::vector<Strip>& strips) {
  std::vector<Triangle> triangles;
  for (const Strip& strip : strips) {
    const auto own = tessellate::triangles_of(strip);
    triangles.insert(triangles.end(), own.begin(), own.end());
  }
  return triangles;
}

double indices_per_triangle(const std::vector<Strip>& strips, std::size_t triangles) {
  std::size_t indices = 0;
  for (const Strip& strip : strips) indices += strip.size();
  return static_cast<double>(indices) / static_cast<double>(triangles);
}

// A disc with inner points, triangulated.
std::vector<Triangle> disc(std::size_t corners, std::size_t inner, std::uint32_t seed,
                           std::size_t& point_count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-0.7, 0.7);
  tessellate::Region region;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(corners);
    region.points.push_back({std::cos(angle), std::sin(angle), 0});
    region.edges.push_back({static_cast<Index>(i), static_cast<Index>((i + 1) % corners)});
  }
  for (std::size_t i = 0; i < inner; ++i)
    region.points.push_back({place(random), place(random), 0});
  auto made = tessellate::sweep_region(region);
  REQUIRE_FALSE(made.conflict);
  tessellate::flip_to_delaunay(region.points, made.triangles);
  point_count = region.points.size();
  return made.triangles;
}

TEST_CASE("strips have each triangle once, the same way round") {
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    std::size_t points = 0;
    const auto triangles = disc(16 + seed % 40, seed % 97, seed, points);
    const auto strips = tessellate::strips_of(triangles, points);
    REQUIRE(normal_form(all_of(strips)) == normal_form(triangles));
    CHECK(tessellate::strips_of(triangles, points) == strips);
  }
}

TEST_CASE("strips of a triangulation of random points take at most 1.4 indices a triangle") {
  std::size_t points = 0;
  const auto triangles = disc(100, 2000, 7, points);
  const double ratio =
      indices_per_triangle(tessellate::strips_of(triangles, points), triangles.size());
  INFO(ratio);
  CHECK(ratio <= 1.4);
}

TEST_CASE("a fan, a lone triangle and nothing become strips") {
  CHECK(tessellate::strips_of({}, 0).empty());
  const std::vector<Triangle> lone{{4, 2, 7}};
  CHECK(normal_form(all_of(tessellate::strips_of(lone, 8))) == normal_form(lone));
  std::vector<Triangle> fan;
  for (Index i = 1; i < 40; ++i) fan.push_back({0, i, i + 1});
  const auto strips = tessellate::strips_of(fan, 41);
  CHECK(strips.size() == 1);
  CHECK(normal_form(all_of(strips)) == normal_form(fan));
}

TEST_CASE("triangles that touch in a vertex, or not at all, become strips") {
  const std::vector<Triangle> apart{{0, 1, 2}, {2, 3, 4}, {5, 6, 7}, {7, 6, 8}};
  CHECK(normal_form(all_of(tessellate::strips_of(apart, 9))) == normal_form(apart));
}

}  // namespace
}  // namespace watertight
