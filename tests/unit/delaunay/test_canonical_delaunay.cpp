// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "base/checksum.h"
#include "delaunay/canonical_delaunay.h"
#include "geometry/predicates/predicates.h"

namespace watertight {
namespace {

std::vector<Point> grid(int side, double step = 1, Point origin = {}) {
  std::vector<Point> points;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      for (int z = 0; z < side; ++z) {
        points.push_back({origin.x + x * step, origin.y + y * step, origin.z + z * step});
      }
    }
  }
  return points;
}

/// The integer points at the given squared distances from the origin: many are cospherical.
std::vector<Point> integer_spheres(int radius, const std::vector<int>& squares) {
  std::vector<Point> points;
  for (int x = -radius; x <= radius; ++x) {
    for (int y = -radius; y <= radius; ++y) {
      for (int z = -radius; z <= radius; ++z) {
        const int square = x * x + y * y + z * z;
        if (std::find(squares.begin(), squares.end(), square) == squares.end()) continue;
        points.push_back({double(x), double(y), double(z)});
      }
    }
  }
  return points;
}

std::vector<Point> prism(int sides, double height) {
  // The integer points of a circle of radius 65, at two heights.
  const std::vector<std::array<int, 2>> circle = {
      {65, 0},   {63, 16},  {60, 25},  {56, 33},   {52, 39},   {39, 52},   {33, 56},  {25, 60},
      {16, 63},  {0, 65},   {-16, 63}, {-25, 60},  {-33, 56},  {-39, 52},  {-52, 39}, {-56, 33},
      {-60, 25}, {-63, 16}, {-65, 0},  {-63, -16}, {-60, -25}, {-56, -33}, {-52, -39}};
  std::vector<Point> points;
  for (int i = 0; i < sides; ++i) {
    const auto& [x, y] = circle[std::size_t(i)];
    points.push_back({double(x), double(y), 0});
    points.push_back({double(x), double(y), height});
  }
  return points;
}

delaunay::CanonicalDelaunay build(const std::vector<Point>& points) {
  Result<delaunay::CanonicalDelaunay> result = delaunay::canonical_delaunay(points);
  REQUIRE(result.has_value());
  return std::move(*result);
}

/// A digest of the faces, with the indices of the lexicographically sorted points.
std::uint64_t digest(const std::vector<Point>& points) {
  std::vector<Point> sorted = points;
  std::sort(sorted.begin(), sorted.end());
  const delaunay::CanonicalDelaunay delaunay = build(sorted);
  ByteWriter writer;
  for (const Triangle& face : delaunay.faces) {
    for (const Index vertex : face) writer.u32(vertex);
  }
  for (const geometry::Tetrahedron& tetrahedron : delaunay.tetrahedra) {
    for (const Index vertex : tetrahedron) writer.u32(vertex);
  }
  return content_hash(writer.bytes());
}

std::vector<std::array<Point, 3>> faces_as_points(const std::vector<Point>& points,
                                                  const delaunay::CanonicalDelaunay& delaunay) {
  std::vector<std::array<Point, 3>> faces;
  for (const Triangle& face : delaunay.faces) {
    std::array<Point, 3> corners{points[face[0]], points[face[1]], points[face[2]]};
    std::sort(corners.begin(), corners.end());
    faces.push_back(corners);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

struct NamedSet {
  const char* name;
  std::vector<Point> points;
  std::uint64_t digest;
};

/// The golden sets. The tie rule is part of the blob format: their digests never change.
std::vector<NamedSet> golden_sets() {
  return {
      {"cube", grid(2), 0xf0a9f1e5f7102bd2},
      {"3x3x3 grid", grid(3), 0x11bec4989bc977bd},
      {"5x5x5 grid", grid(5, 1000), 0xe3fdf8fefeff982d},
      {"grid far from the origin", grid(4, 7, {85'000'000, 447'000'000, 13}), 0x933fd9432b77ee3a},
      {"spheres of radius 3 and 5", integer_spheres(5, {9, 25}), 0x9dcc0659bb97f8ee},
      {"sphere of squared radius 41", integer_spheres(7, {41}), 0x911cc08233785862},
      {"prism on one circle", prism(23, 30), 0xbfbb5834f79683fa},
      {"flat grid with two apexes",
       [] {
         std::vector<Point> points;
         for (int x = 0; x < 6; ++x) {
           for (int y = 0; y < 6; ++y) points.push_back({double(x), double(y), 0});
         }
         points.push_back({2, 2, 5});
         points.push_back({3, 3, -5});
         return points;
       }(),
       0x899c814aa30bba35},
  };
}

TEST_CASE("canonical Delaunay of golden point sets never changes") {
  for (const NamedSet& set : golden_sets()) {
    INFO(set.name);
    CHECK(digest(set.points) == set.digest);
  }
}

TEST_CASE("canonical Delaunay of a 3x3x3 grid has 120 faces") {
  const delaunay::CanonicalDelaunay delaunay = build(grid(3));
  CHECK(delaunay.faces.size() == 120);
  CHECK(delaunay.tetrahedra.size() == 48);
}

TEST_CASE("canonical Delaunay does not depend on the numbering of the points") {
  std::mt19937 generator(7);
  for (const NamedSet& set : golden_sets()) {
    INFO(set.name);
    const auto expected = faces_as_points(set.points, build(set.points));
    for (int round = 0; round < 12; ++round) {
      std::vector<Point> shuffled = set.points;
      std::shuffle(shuffled.begin(), shuffled.end(), generator);
      CHECK(faces_as_points(shuffled, build(shuffled)) == expected);
    }
  }
}

TEST_CASE("canonical Delaunay does not change under an exact translation or scaling") {
  for (const NamedSet& set : golden_sets()) {
    INFO(set.name);
    const delaunay::CanonicalDelaunay expected = build(set.points);
    std::vector<Point> moved = set.points;
    for (Point& p : moved) p = {p.x * 4 + 1024, p.y * 4 + 4096, p.z * 4 - 512};
    CHECK(build(moved).faces == expected.faces);
    CHECK(build(moved).tetrahedra == expected.tetrahedra);
  }
}

TEST_CASE("canonical Delaunay lists positive tetrahedra and sorted faces") {
  std::mt19937 generator(3);
  std::uniform_int_distribution<int> coordinate(0, 40);
  std::vector<Point> points;
  for (int i = 0; i < 300; ++i) {
    points.push_back({double(coordinate(generator)), double(coordinate(generator)),
                      double(coordinate(generator))});
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const delaunay::CanonicalDelaunay delaunay = build(points);
  std::vector<Triangle> faces;
  for (const geometry::Tetrahedron& t : delaunay.tetrahedra) {
    REQUIRE(geometry::orient3d(points[t[0]], points[t[1]], points[t[2]], points[t[3]]) > 0);
    REQUIRE(t[0] < t[1]);
    REQUIRE(t[1] < std::min(t[2], t[3]));
    for (std::size_t skipped = 0; skipped < 4; ++skipped) {
      Triangle face{};
      for (std::size_t i = 0, used = 0; i < 4; ++i) {
        if (i != skipped) face[used++] = t[i];
      }
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  CHECK(delaunay.faces == faces);
  CHECK(std::is_sorted(delaunay.tetrahedra.begin(), delaunay.tetrahedra.end()));
}

TEST_CASE("canonical Delaunay lists the vertices opposite to a face by side") {
  for (const NamedSet& set : golden_sets()) {
    INFO(set.name);
    const delaunay::CanonicalDelaunay delaunay = build(set.points);
    REQUIRE(delaunay.apexes.size() == delaunay.faces.size());
    std::size_t apex_count = 0;
    for (std::size_t f = 0; f < delaunay.faces.size(); ++f) {
      const auto& [a, b, c] = delaunay.faces[f];
      for (const std::size_t side : {0, 1}) {
        const Index apex = delaunay.apexes[f][side];
        if (apex == kNone) continue;
        ++apex_count;
        const int sign =
            geometry::orient3d(set.points[a], set.points[b], set.points[c], set.points[apex]);
        REQUIRE(sign == (side == 0 ? 1 : -1));
        geometry::Tetrahedron t{a, b, c, apex};
        std::sort(t.begin(), t.end());
        REQUIRE(std::any_of(delaunay.tetrahedra.begin(), delaunay.tetrahedra.end(), [&](auto u) {
          std::sort(u.begin(), u.end());
          return t == u;
        }));
      }
    }
    CHECK(apex_count == 4 * delaunay.tetrahedra.size());
  }
}

/// The sign of the in-sphere determinant of a positively oriented tetrahedron, in integers:
/// positive if `q` is strictly inside the sphere. Exact for coordinates below 2^8.
std::int64_t in_sphere(const std::array<Point, 4>& t, const Point& q) {
  std::array<std::array<std::int64_t, 4>, 4> m{};
  for (std::size_t i = 0; i < 4; ++i) {
    m[i] = {std::int64_t(t[i].x - q.x), std::int64_t(t[i].y - q.y), std::int64_t(t[i].z - q.z), 0};
    m[i][3] = m[i][0] * m[i][0] + m[i][1] * m[i][1] + m[i][2] * m[i][2];
  }
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {  // expands the determinant along the last column
    std::array<std::size_t, 3> r{};
    for (std::size_t k = 0, used = 0; k < 4; ++k) {
      if (k != i) r[used++] = k;
    }
    const auto minor = m[r[0]][0] * (m[r[1]][1] * m[r[2]][2] - m[r[1]][2] * m[r[2]][1]) -
                       m[r[0]][1] * (m[r[1]][0] * m[r[2]][2] - m[r[1]][2] * m[r[2]][0]) +
                       m[r[0]][2] * (m[r[1]][0] * m[r[2]][1] - m[r[1]][1] * m[r[2]][0]);
    sum += (i % 2 == 0 ? 1 : -1) * m[i][3] * minor;
  }
  return sum;
}

TEST_CASE("canonical Delaunay has no point inside a circumsphere") {
  for (const NamedSet& set : golden_sets()) {
    if (std::any_of(set.points.begin(), set.points.end(),
                    [](const Point& p) { return std::abs(p.y) > 200 || std::abs(p.x) > 200; })) {
      continue;
    }
    INFO(set.name);
    for (const geometry::Tetrahedron& t : build(set.points).tetrahedra) {
      const std::array<Point, 4> corners{set.points[t[0]], set.points[t[1]], set.points[t[2]],
                                         set.points[t[3]]};
      for (const Point& q : set.points) REQUIRE(in_sphere(corners, q) <= 0);
    }
  }
}

TEST_CASE("canonical Delaunay of points without volume is empty") {
  CHECK(build({}).tetrahedra.empty());
  CHECK(build({{1, 2, 3}}).faces.empty());
  CHECK(build({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).faces.empty());
  CHECK(build({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {5, 3, 0}}).faces.empty());
}

TEST_CASE("canonical Delaunay refuses equal, infinite and too many points") {
  const std::vector<Point> equal = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  const auto refused = delaunay::canonical_delaunay(equal);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::invalid_argument);

  const std::vector<Point> infinite = {{0, 0, std::numeric_limits<double>::infinity()}};
  CHECK_FALSE(delaunay::canonical_delaunay(infinite).has_value());

  // The points are on two skew lines: every pair of segments spans a tetrahedron.
  std::vector<Point> skew;
  for (int i = 0; i < 100; ++i) {
    skew.push_back({double(i), 0, 0});
    skew.push_back({0, double(i), 50});
  }
  const auto limited = delaunay::canonical_delaunay(skew, 2000);
  REQUIRE_FALSE(limited.has_value());
  CHECK(limited.error().code == ErrorCode::limit_exceeded);
  CHECK(delaunay::canonical_delaunay(skew).has_value());
}

TEST_CASE("canonical Delaunay takes extreme coordinates") {
  const std::vector<Point> extreme = {
      {1e300, 0, 0}, {-1e300, 1e-300, 0}, {0, 1e300, 5e-324}, {0, 0, 1e300}, {1e-308, 3, -1e300}};
  CHECK(delaunay::canonical_delaunay(extreme).has_value());
}

}  // namespace
}  // namespace watertight
