// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/triangulate_loops.h"

#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "exhaustive.h"

namespace watertight::fill {
namespace {

struct Curves {
  std::vector<Point> points;
  std::vector<Loop> loops;
};

Curves monkey_saddle(std::size_t n) {
  Curves input;
  Loop& loop = input.loops.emplace_back();
  for (std::size_t i = 0; i < n; ++i) {
    const double t = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(n);
    loop.push_back(static_cast<Index>(i));
    input.points.push_back({std::cos(t), std::sin(t), 0.5 * std::cos(3 * t)});
  }
  return input;
}

/// Squares around the z axis, at different heights; the second one runs against the first.
Curves two_squares(double inner) {
  const auto square = [](double half, double z) {
    return std::vector<Point>{
        {-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  };
  Curves input;
  input.points = square(2, 0);
  const std::vector<Point> other = square(inner, 1);
  input.points.insert(input.points.end(), other.begin(), other.end());
  input.loops = {{0, 1, 2, 3}, {7, 6, 5, 4}};
  return input;
}

ErrorCode error_of(const Result<LoopFill>& result) {
  REQUIRE(!result);
  return result.error().code;
}

}  // namespace

TEST_CASE("the monkey saddle has the sums of angles of the literature") {
  FillOptions options;
  options.space = CandidateSpace::all;
  for (const auto& [n, angle] : {std::pair{50, 4.0505717}, {100, 4.0549389}}) {
    const Curves input = monkey_saddle(static_cast<std::size_t>(n));
    const auto filled = triangulate_loops(input.points, input.loops, options);
    REQUIRE(filled);
    CHECK(std::abs(filled->angle - angle) < 1e-6);
    CHECK(test::is_filling(input.loops, filled->triangles, false));
  }
  options.objective = Objective::area;
  const Curves input = monkey_saddle(100);
  const auto filled = triangulate_loops(input.points, input.loops, options);
  REQUIRE(filled);
  CHECK(std::abs(filled->area - 4.6170119) < 1e-6);
}

TEST_CASE("Delaunay triangles fill a saddle of 2,000 points") {
  const Curves input = monkey_saddle(2000);
  const auto filled = triangulate_loops(input.points, input.loops, {});
  REQUIRE(filled);
  CHECK(filled->triangles.size() == 1998);
  CHECK(filled->angle < 4.06);
}

TEST_CASE("a border with an island becomes a ring") {
  const Curves input = two_squares(1);
  const auto filled = triangulate_loops(input.points, input.loops, {});
  REQUIRE(filled);
  CHECK(filled->triangles.size() == 8);
  CHECK(test::is_filling(input.loops, filled->triangles, false));
  CHECK(filled->area == Catch::Approx(4 * 3 * std::sqrt(2.0)));
}

TEST_CASE("a loop that runs the wrong way is passed against its sense only if that is allowed") {
  Curves input = two_squares(2);  // a tube
  std::ranges::reverse(input.loops[1]);
  FillOptions options;
  const auto in_border_sense = triangulate_loops(input.points, input.loops, options);
  options.has_both_senses = true;
  const auto in_both_senses = triangulate_loops(input.points, input.loops, options);
  REQUIRE(in_both_senses);
  CHECK(test::is_filling(input.loops, in_both_senses->triangles, true));
  CHECK(in_both_senses->area == Catch::Approx(16));
  if (in_border_sense) CHECK(in_border_sense->angle > in_both_senses->angle);
}

TEST_CASE("the facets behind a border bend the filling") {
  // A square: without facets both diagonals are flat; the facets behind make no difference to its
  // plane, and the sum of angles is that of the four edges.
  Curves input;
  input.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  input.loops = {{0, 1, 2, 3}};
  FillOptions options;
  options.space = CandidateSpace::all;
  const auto alone = triangulate_loops(input.points, input.loops, options);
  REQUIRE(alone);
  CHECK(alone->angle == 0);
  options.behind = {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}}};
  const auto on_walls = triangulate_loops(input.points, input.loops, options);
  REQUIRE(on_walls);
  CHECK(on_walls->angle == Catch::Approx(6.283185307179586));
}

TEST_CASE("the filling does not depend on the order of points, loops or starts") {
  std::mt19937 numbers(7);
  Curves input = two_squares(1);
  input.points[2] = {2.25, 2, 0.5};
  const auto expected = triangulate_loops(input.points, input.loops, {});
  REQUIRE(expected);
  const auto places = [](const Curves& in, const LoopFill& fill) {
    std::vector<std::array<Point, 3>> result;
    for (const Triangle& t : fill.triangles) {
      std::array<Point, 3> corners{in.points[t[0]], in.points[t[1]], in.points[t[2]]};
      std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
      result.push_back(corners);
    }
    std::ranges::sort(result);
    return result;
  };
  for (int round = 0; round < 20; ++round) {
    std::vector<Index> order(input.points.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::ranges::shuffle(order, numbers);
    Curves mixed = input;
    for (std::size_t i = 0; i < order.size(); ++i) mixed.points[order[i]] = input.points[i];
    for (Loop& loop : mixed.loops) {
      for (Index& point : loop) point = order[point];
      std::rotate(loop.begin(), loop.begin() + round % 4, loop.end());
    }
    if (round % 2 == 1) std::swap(mixed.loops[0], mixed.loops[1]);
    const auto found = triangulate_loops(mixed.points, mixed.loops, {});
    REQUIRE(found);
    CHECK(places(mixed, *found) == places(input, *expected));
  }
}

TEST_CASE("loops that are no loops are refused") {
  const Curves input = monkey_saddle(8);
  const auto fill = [&](std::vector<Loop> loops) {
    return error_of(triangulate_loops(input.points, loops, {}));
  };
  CHECK(fill({}) == ErrorCode::invalid_argument);
  CHECK(fill({{0, 1}}) == ErrorCode::invalid_argument);
  CHECK(fill({{0, 1, 8}}) == ErrorCode::invalid_argument);
  CHECK(fill({{0, 1, 2, 1}}) == ErrorCode::invalid_argument);
  CHECK(fill({{0, 1, 2}, {2, 3, 4}}) == ErrorCode::invalid_argument);
  CHECK(fill({{0, 1, 2}, {2, 1, 0}, {0, 1, 2}, {2, 1, 0}, {0, 1, 2}, {2, 1, 0}, {0, 1, 2}}) ==
        ErrorCode::limit_exceeded);
  std::vector<Point> infinite = input.points;
  infinite[3].y = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Loop> all_points{{0, 1, 2, 3, 4}};
  CHECK(error_of(triangulate_loops(infinite, all_points, {})) == ErrorCode::invalid_argument);
  const std::vector<Point> line{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  const std::vector<Loop> on_line{{0, 1, 2, 3}};
  CHECK(error_of(triangulate_loops(line, on_line, {})) == ErrorCode::invalid_argument);
}

TEST_CASE("facets behind that do not match the loops are refused") {
  const Curves input = monkey_saddle(8);
  FillOptions options;
  options.behind = {{{0, 0, 1}}};
  CHECK(error_of(triangulate_loops(input.points, input.loops, options)) ==
        ErrorCode::invalid_argument);
}

TEST_CASE("a budget ends the work") {
  const Curves input = monkey_saddle(60);
  FillOptions options;
  options.space = CandidateSpace::all;
  options.max_domains = 100;
  CHECK(error_of(triangulate_loops(input.points, input.loops, options)) ==
        ErrorCode::limit_exceeded);
  options.max_domains = 1'000'000;
  options.max_bytes = 1000;
  CHECK(error_of(triangulate_loops(input.points, input.loops, options)) ==
        ErrorCode::limit_exceeded);
  options.max_bytes = std::size_t{400} << 20U;
  int polls = 0;
  options.is_cancelled = [&] { return ++polls > 3; };
  CHECK(error_of(triangulate_loops(input.points, input.loops, options)) == ErrorCode::cancelled);
}

TEST_CASE("a loop of 100,000 points is refused at once") {
  const Curves input = monkey_saddle(100'000);
  CHECK(error_of(triangulate_loops(input.points, input.loops, {})) == ErrorCode::limit_exceeded);
}

TEST_CASE("a hole without a triangulation from the candidates is reported") {
  const Curves input = monkey_saddle(8);
  FillOptions options;
  options.is_allowed = [](const Triangle&) { return false; };
  CHECK(error_of(triangulate_loops(input.points, input.loops, options)) == ErrorCode::not_found);
  // All points in one plane have no Delaunay tetrahedralization, but triples do.
  Curves flat = monkey_saddle(6);
  for (Point& point : flat.points) point.z = 0;
  CHECK(error_of(triangulate_loops(flat.points, flat.loops, {})) == ErrorCode::not_found);
  options = {};
  options.space = CandidateSpace::all;
  CHECK(triangulate_loops(flat.points, flat.loops, options));
}

}  // namespace watertight::fill
