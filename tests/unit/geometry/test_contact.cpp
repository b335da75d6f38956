// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "geometry/contact/distance.h"
#include "geometry/contact/shared_area.h"
#include "geometry/mass/mass.h"
#include "tests/unit/geometry/meshes.h"

namespace watertight::test {
namespace {

using geometry::cross;
using geometry::distance;
using geometry::dot;
using geometry::length;
using geometry::meets_segment;
using geometry::operator-;
using geometry::operator+;
using geometry::operator*;
using geometry::shared_area;
using geometry::Surface;
using geometry::Vector3;

Surface surface_of(const Mesh& mesh) { return {&mesh.solid, mesh.triangles}; }

Lattice grid(std::int64_t mantissa, std::int32_t exponent) {
  Lattice lattice;
  lattice.step.fill(GridNumber{mantissa, exponent});
  return lattice;
}

double shared(const Mesh& one, const Mesh& other, double tolerance = 0) {
  const double area = shared_area(surface_of(one), surface_of(other), tolerance);
  CHECK(shared_area(surface_of(other), surface_of(one), tolerance) == area);
  return area;
}

double between(const Mesh& one, const Mesh& other) {
  const double least = distance(surface_of(one), surface_of(other));
  CHECK(distance(surface_of(other), surface_of(one)) == least);
  return least;
}

/// The squared length of the shortest vector of a triangle, by its corners, edges and inside.
double shortest_square(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto of_edge = [](const Vector3& from, const Vector3& to) {
    const Vector3 way = to - from;
    const double square = dot(way, way);
    const double share = square == 0 ? 0 : std::clamp(-dot(from, way) / square, 0.0, 1.0);
    const Vector3 point = from + way * share;
    return dot(point, point);
  };
  double least = std::min({of_edge(a, b), of_edge(b, c), of_edge(c, a)});
  const Vector3 normal = cross(b - a, c - a);
  const double square = dot(normal, normal);
  if (square == 0) return least;
  const double turns[] = {dot(cross(b - a, a * -1), normal), dot(cross(c - b, b * -1), normal),
                          dot(cross(a - c, c * -1), normal)};
  if (std::ranges::all_of(turns, [](double turn) { return turn >= 0; })) {
    least = std::min(least, dot(a, normal) * dot(a, normal) / square);
  }
  return least;
}

/// The distance of two tetrahedra as that of the origin from the differences of their corners, of
/// which any three span a triangle and any four a tetrahedron. Exact where it is 0: corners are
/// small integers.
double distance_of_differences(const Mesh& one, const Mesh& other) {
  std::vector<Vector3> points;
  for (const Point& p : one.solid.vertices()) {
    for (const Point& q : other.solid.vertices()) points.push_back(geometry::difference(p, q));
  }
  const auto turn = [](const Vector3& a, const Vector3& b, const Vector3& c) {
    return dot(cross(a, b), c);
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        least = std::min(least, shortest_square(points[i], points[j], points[k]));
        for (std::size_t l = 0; l < k; ++l) {
          const auto [a, b, c, d] = std::array{points[i], points[j], points[k], points[l]};
          const double whole = turn(b - a, c - a, d - a);
          const double sign = whole > 0 ? 1 : -1;
          const double parts[] = {-turn(b, c, d), turn(a, c, d), -turn(a, b, d), turn(a, b, c)};
          if (whole != 0 &&
              std::ranges::all_of(parts, [&](double part) { return part * -sign >= 0; })) {
            return 0;
          }
        }
      }
    }
  }
  return std::sqrt(least);
}

/// Whether a segment meets a convex solid, by cutting it at the planes of the facets.
bool does_cut(const Mesh& mesh, const Vector3& from, const Vector3& to) {
  // Shares of the segment as fractions of small integers, whose products doubles hold.
  std::pair<double, double> first{0, 1};
  std::pair<double, double> last{1, 1};
  const auto is_less = [](const auto& a, const auto& b) {
    return a.first * b.second < b.first * a.second;
  };
  for (const auto& [i, j, k] : mesh.triangles) {
    const auto corner = [&](Index index) {
      const Point& p = mesh.solid.vertices()[index];
      return Vector3{p.x, p.y, p.z};
    };
    const Vector3 normal = cross(corner(j) - corner(i), corner(k) - corner(i));
    const double at_from = dot(from - corner(i), normal);  // positive outside
    const double at_to = dot(to - corner(i), normal);
    if (at_from > 0 && at_to > 0) return false;
    if (at_from <= 0 && at_to <= 0) continue;
    const std::pair share{std::abs(at_from), std::abs(at_from - at_to)};
    if (at_from > 0) {
      if (is_less(first, share)) first = share;
    } else if (is_less(share, last)) {
      last = share;
    }
  }
  return !is_less(last, first);
}

}  // namespace

TEST_CASE("boxes share the area of the rectangle in which they stand wall to wall") {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> place(0, 20);
  const auto overlap = [](int a, int b, int c, int d) {
    return std::max(0, std::min(b, d) - std::max(a, c));
  };
  for (int round = 0; round < 500; ++round) {
    const auto range = [&] {
      const int from = place(random);
      return std::pair(from, from + 1 + place(random));
    };
    const auto [y, y_to] = range();
    const auto [z, z_to] = range();
    const auto [v, v_to] = range();
    const auto [w, w_to] = range();
    // One box in steps of 0.1, the other one in steps of 0.05: coordinates are twice as large.
    const Mesh left = box_mesh({0, 1.0 * y, 1.0 * z}, {7, 1.0 * y_to, 1.0 * z_to}, grid(1, -1));
    const Mesh right = box_mesh({14, 2.0 * v, 2.0 * w}, {40, 2.0 * v_to, 2.0 * w_to}, grid(5, -2));
    CHECK(shared(left, right) == overlap(y, y_to, v, v_to) * overlap(z, z_to, w, w_to) / 100.0);
  }
}

TEST_CASE("tetrahedra on both sides of a triangle share its area, whatever the plane") {
  std::mt19937 random(13);
  for (int round = 0; round < 200; ++round) {
    const Mesh one = random_tetrahedron(random, grid(1, -3), 1000);
    const auto corners = one.solid.vertices();
    const Point& a = corners[0];
    const Point& b = corners[1];
    const Point& c = corners[2];
    const Point& d = corners[3];
    const Point away{a.x + b.x - d.x, a.y + b.y - d.y, a.z + b.z - d.z};
    const Mesh other = tetrahedron(a, c, b, away, grid(1, -3));
    const Vector3 normal = cross(geometry::difference(b, a), geometry::difference(c, a));
    const double area = length(normal) / 2e6;
    CHECK(std::abs(shared(one, other) - area) <= 4e-16 * area);
    CHECK(shared(one, one) == 0);
    CHECK(between(one, other) == 0);
  }
}

TEST_CASE("walls on one side of a plane are not shared") {
  const Mesh outer = box_mesh({0, 0, 0}, {10, 10, 10}, Lattice());
  CHECK(shared(outer, box_mesh({0, 2, 2}, {5, 5, 5}, Lattice())) == 0);
  CHECK(shared(outer, box_mesh({10, 2, 2}, {15, 5, 5}, Lattice())) == 9);
  CHECK(shared(outer, box_mesh({10, 10, 0}, {15, 15, 10}, Lattice())) == 0);  // an edge
}

TEST_CASE("walls within a tolerance are shared") {
  const Mesh left = box_mesh({0, 0, 0}, {100, 100, 100}, grid(1, -2));
  const Mesh right = box_mesh({103, 50, 0}, {200, 200, 50}, grid(1, -2));
  CHECK(shared(left, right) == 0);
  CHECK(shared(left, right, 0.02) == 0);
  CHECK(std::abs(shared(left, right, 0.03) - 0.25) < 1e-15);
  CHECK(std::abs(shared(left, right, 0.05) - 0.25) < 1e-15);
  // A wall that turns away from the other: half of it is within the tolerance.
  const Mesh wedge = mesh_of({{100, 0, 0},
                              {200, 0, 0},
                              {200, 100, 0},
                              {104, 100, 0},
                              {100, 0, 100},
                              {200, 0, 100},
                              {200, 100, 100},
                              {104, 100, 100}},
                             {{0, 3, 2},
                              {0, 2, 1},
                              {4, 5, 6},
                              {4, 6, 7},
                              {0, 1, 5},
                              {0, 5, 4},
                              {1, 2, 6},
                              {1, 6, 5},
                              {2, 3, 7},
                              {2, 7, 6},
                              {3, 0, 4},
                              {3, 4, 7}},
                             grid(1, -2));
  CHECK(shared(left, wedge) == 0);
  CHECK(std::abs(shared(left, wedge, 0.02) - 0.5) < 1e-3);
  CHECK(std::abs(shared(left, wedge, 0.05) - 1) < 1e-3);
}

TEST_CASE("tetrahedra are as far apart as the differences of their points are from the origin") {
  std::mt19937 random(17);
  int apart = 0;
  for (int round = 0; round < 600; ++round) {
    const Mesh one = random_tetrahedron(random, Lattice(), 12);
    const Mesh other = random_tetrahedron(random, Lattice(), 12);
    const double expected = distance_of_differences(one, other);
    const double found = between(one, other);
    apart += expected > 0 ? 1 : 0;
    CHECK((found == 0) == (expected == 0));
    CHECK(std::abs(found - expected) <= 1e-12 * expected);
  }
  CHECK(apart > 50);
}

TEST_CASE("distances of boxes are exact to the last digit, also far from the origin") {
  Lattice far = grid(1, -3);
  far.origin = {GridNumber{5, 5}, GridNumber{45, 5}, GridNumber{0, 0}};
  const Mesh one = box_mesh({0, 0, 0}, {1000, 1000, 1000}, far);
  CHECK(between(one, box_mesh({1003, 1004, 0}, {2000, 2000, 1000}, far)) == 0.005);
  CHECK(between(one, box_mesh({1000, 1000, 1000}, {2000, 2000, 2000}, far)) == 0);
  CHECK(between(one, box_mesh({200, 200, 200}, {300, 300, 300}, far)) == 0);
  CHECK(distance(surface_of(one), {500001.002, 4500001.003, 1.006}) == 0.007);
  CHECK(distance(surface_of(one), {500000.5, 4500000.5, 1}) == 0);
  CHECK(distance(surface_of(one), {500000.5, 4500000.5, 0.5}) == 0);
}

TEST_CASE("a place is as far from a tetrahedron as a tiny distance of differences says") {
  std::mt19937 random(19);
  std::uniform_int_distribution<int> place(0, 12);
  for (int round = 0; round < 600; ++round) {
    const Mesh mesh = random_tetrahedron(random, Lattice(), 12);
    const std::array<double, 3> point{1.0 * place(random), 1.0 * place(random),
                                      1.0 * place(random)};
    const double found = distance(surface_of(mesh), point);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [i, j, k] : mesh.triangles) {
      const auto way = [&](Index index) {
        const Point& p = mesh.solid.vertices()[index];
        return Vector3{p.x, p.y, p.z} - point;
      };
      least = std::min(least, shortest_square(way(i), way(j), way(k)));
    }
    const double expected =
        geometry::locate(mesh.solid, mesh.triangles, point) >= 0 ? 0 : std::sqrt(least);
    CHECK((found == 0) == (expected == 0));
    CHECK(std::abs(found - expected) <= 1e-12 * expected);
  }
}

TEST_CASE("a segment meets a tetrahedron where the planes of its facets leave some of it") {
  std::mt19937 random(23);
  std::uniform_int_distribution<int> place(0, 8);
  int met = 0;
  for (int round = 0; round < 4000; ++round) {
    const Mesh mesh = random_tetrahedron(random, Lattice(), 8);
    const auto end = [&] {
      return Vector3{1.0 * place(random), 1.0 * place(random), 1.0 * place(random)};
    };
    const Vector3 from = end();
    const Vector3 to = end();
    const bool is_met = does_cut(mesh, from, to);
    met += is_met ? 1 : 0;
    CHECK(meets_segment(surface_of(mesh), from, to) == is_met);
    CHECK(meets_segment(surface_of(mesh), to, from) == is_met);
  }
  CHECK(met > 500);
}

}  // namespace watertight::test
