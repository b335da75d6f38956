// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the two implementations of the canonical Delaunay tetrahedralization: the golden digests of
// the tie rule, and equal results.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "base/checksum.h"
#include "delaunay/canonical/cgal_delaunay.h"
#include "delaunay/canonical/small_delaunay.h"
#include "point_sets.h"
#include "tests/files.h"

namespace watertight {
namespace {

struct Golden {
  std::string formula;
  std::size_t points = 0;
  std::size_t tetrahedra = 0;
  std::size_t faces = 0;
  std::string digest;
};

std::vector<Golden> read_goldens() {
  std::istringstream file(test::read_text(test::source_path("tests/golden/delaunay/digests.csv")));
  std::vector<Golden> goldens;
  std::string line;
  std::getline(file, line);
  REQUIRE(line == "set,points,tetrahedra,faces,crc32c");
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ' ', '_');
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    Golden golden;
    fields >> golden.formula >> golden.points >> golden.tetrahedra >> golden.faces >> golden.digest;
    REQUIRE_FALSE(fields.fail());
    std::replace(golden.formula.begin(), golden.formula.end(), '_', ' ');
    goldens.push_back(golden);
  }
  return goldens;
}

std::string digest(const delaunay::CanonicalDelaunay& delaunay) {
  ByteWriter writer;
  for (const Triangle& face : delaunay.faces) {
    for (const Index vertex : face) writer.u32(vertex);
  }
  constexpr char kDigits[] = "0123456789abcdef";
  const std::uint32_t crc = crc32c(writer.bytes());
  std::string text;
  for (int shift = 28; shift >= 0; shift -= 4) text.push_back(kDigits[(crc >> shift) & 15]);
  return text;
}

bool is_same(const delaunay::CanonicalDelaunay& a, const delaunay::CanonicalDelaunay& b) {
  return a.tetrahedra == b.tetrahedra && a.faces == b.faces && a.apexes == b.apexes;
}

/// True if both implementations refuse the points, or both give the same result.
bool is_same_from_both(const std::vector<Point>& points) {
  const auto expected = delaunay::cgal_delaunay(points);
  const auto found = delaunay::small_delaunay(points);
  if (expected.has_value() != found.has_value()) return false;
  return expected ? is_same(*expected, *found) : expected.error().code == found.error().code;
}

TEST_CASE("the golden digests of the tie rule come from both implementations") {
  const std::vector<Golden> goldens = read_goldens();
  CHECK(goldens.size() >= 50);
  for (const Golden& golden : goldens) {
    INFO(golden.formula);
    const std::vector<Point> points = point_sets::make(golden.formula);
    REQUIRE(points.size() == golden.points);
    REQUIRE(delaunay::is_small_grid(points));
    for (const auto& delaunay :
         {delaunay::cgal_delaunay(points), delaunay::small_delaunay(points)}) {
      REQUIRE(delaunay.has_value());
      CHECK(delaunay->tetrahedra.size() == golden.tetrahedra);
      CHECK(delaunay->faces.size() == golden.faces);
      CHECK(digest(*delaunay) == golden.digest);
    }
  }
}

TEST_CASE("both implementations agree on sets of every kind in any order") {
  for (std::uint64_t number = 0; number < 3000; ++number) {
    const std::string formula = point_sets::any_formula(number);
    const auto points = point_sets::shuffled(point_sets::make(formula), number);
    INFO(number << ": " << formula);
    REQUIRE(delaunay::is_small_grid(points));
    REQUIRE(is_same_from_both(points));
  }
}

TEST_CASE("both implementations agree on every set of corners of small cubes") {
  // All subsets of a cube's corners, with and without its centre: they have as many ties as
  // possible.
  const std::vector<Point> corners = point_sets::make("grid 2 2 2 2");
  for (unsigned chosen = 0; chosen < 512; ++chosen) {
    std::vector<Point> points;
    for (unsigned i = 0; i < 8; ++i) {
      if ((chosen >> i & 1) != 0) points.push_back(corners[i]);
    }
    if ((chosen >> 8 & 1) != 0) points.push_back({1, 1, 1});
    INFO(chosen);
    REQUIRE(is_same_from_both(points));
  }
}

TEST_CASE("both implementations agree on coplanar and collinear sets and on few points") {
  for (const char* formula :
       {"grid 1 1 1 1", "grid 3 1 1 1", "grid 4 4 1 1", "grid 1 5 3 1000", "flat 50 1000 0 3",
        "circles 65 1 1", "lines 3 100 1", "sheared 2 1 1", "sheared 3 3 1"}) {
    const std::vector<Point> points = point_sets::make(formula);
    INFO(formula);
    const auto found = delaunay::small_delaunay(points);
    REQUIRE(found.has_value());
    CHECK(found->tetrahedra.empty());
    CHECK(found->faces.empty());
    CHECK(is_same_from_both(points));
  }
  CHECK(is_same_from_both({}));
}

TEST_CASE("both implementations refuse equal points, in flat sets too") {
  for (const char* formula : {"grid 2 2 2 1", "grid 3 3 1 1", "grid 3 1 1 1", "random 200 9 1"}) {
    const std::vector<Point> points = point_sets::make(formula);
    for (std::size_t i = 0; i < points.size(); i += 3) {
      std::vector<Point> equal = points;
      equal.push_back(points[i]);
      const auto refused = delaunay::small_delaunay(point_sets::shuffled(equal, i));
      REQUIRE_FALSE(refused.has_value());
      CHECK(refused.error().code == ErrorCode::invalid_argument);
      CHECK(is_same_from_both(equal));
    }
  }
}

TEST_CASE("a small Delaunay may be anywhere among the integers of doubles") {
  constexpr double kEnd = 9007199254740992.0;  // 2^53
  for (const char* formula : {"grid 3 3 3 1", "random 60 1000 5", "extreme 60 2"}) {
    const std::vector<Point> points = point_sets::make(formula);
    const auto expected = delaunay::small_delaunay(points);
    REQUIRE(expected.has_value());
    for (const Point& origin : {Point{-kEnd, -kEnd, -kEnd}, Point{85'000'000, 447'000'000, -13},
                                Point{kEnd - 0x1p30, 0, 1 - 0x1p30}}) {
      std::vector<Point> moved = points;
      for (Point& p : moved) p = {p.x + origin.x, p.y + origin.y, p.z + origin.z};
      REQUIRE(delaunay::is_small_grid(moved));
      const auto found = delaunay::small_delaunay(moved);
      REQUIRE(found.has_value());
      CHECK(is_same(*found, *expected));
      CHECK(is_same_from_both(moved));
    }
  }
}

TEST_CASE("a small grid has integers in a box with sides below 2^30") {
  const double most = 0x1p30 - 1;
  CHECK(delaunay::is_small_grid({}));
  CHECK(delaunay::is_small_grid(std::vector<Point>{{0, 0, 0}, {most, most, most}}));
  CHECK(delaunay::is_small_grid(
      std::vector<Point>{{-5, -0x1p53, 0x1p53}, {most - 5, 0 - 0x1p53, 0x1p53}}));
  for (int axis = 0; axis < 3; ++axis) {
    for (const double wrong :
         {0x1p30, -1.0, 0.5, 1e-300, most - 0.5, 0x1p54, 1e300,
          std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::quiet_NaN()}) {
      std::vector<Point> points{{0, 0, 0}, {most, most, most}, {1, 1, 1}};
      points[2][axis] = wrong;
      INFO(axis << " " << wrong);
      CHECK_FALSE(delaunay::is_small_grid(points));
      CHECK_FALSE(
          delaunay::is_small_grid(std::vector<Point>{points[2], {0, 0, 0}, {most, most, most}}));
    }
    std::vector<Point> same(3, {7, 7, 7});
    for (Point& p : same) p[axis] = std::numeric_limits<double>::infinity();
    CHECK_FALSE(delaunay::is_small_grid(same));
  }
}

TEST_CASE(
    "canonical Delaunay takes the same way for integers and for the same set made fractions") {
  // CGAL takes the sets that have a coordinate that is no integer.
  for (const char* formula : {"grid 3 3 3 1", "houses 3", "spheres 9 25", "tower 20 1024 1"}) {
    std::vector<Point> points = point_sets::make(formula);
    const auto expected = delaunay::canonical_delaunay(points);
    for (Point& p : points) p = {p.x / 1024, p.y / 1024, p.z / 1024};
    CHECK_FALSE(delaunay::is_small_grid(points));
    const auto found = delaunay::canonical_delaunay(points);
    REQUIRE(expected.has_value());
    REQUIRE(found.has_value());
    CHECK(is_same(*expected, *found));
  }
}

TEST_CASE("a small Delaunay keeps to the limit of tetrahedra") {
  const std::vector<Point> points = point_sets::make("skew 50");
  const auto whole = delaunay::small_delaunay(points);
  REQUIRE(whole.has_value());
  CHECK(whole->tetrahedra.size() == 49 * 49);
  const auto refused = delaunay::small_delaunay(points, whole->tetrahedra.size() - 1);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  CHECK(delaunay::small_delaunay(points, whole->tetrahedra.size()).has_value());
}

TEST_CASE("a small Delaunay stops when the caller cancels") {
  const std::vector<Point> points = point_sets::make("random 3000 1073741824 1");
  int questions = 0;
  const auto cancelled =
      delaunay::small_delaunay(points, 64'000'000, [&] { return ++questions == 3; });
  REQUIRE_FALSE(cancelled.has_value());
  CHECK(cancelled.error().code == ErrorCode::cancelled);
  CHECK(questions == 3);
}

}  // namespace
}  // namespace watertight
