// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/smooth/flatten.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/predicates/turn.h"
#include "geometry/vector3.h"
#include "spline/plane/conformal_map.h"

namespace watertight::repair {
namespace {

using geometry::operator-;
using geometry::operator+;
using geometry::operator*;
using geometry::Vector3;

/// Twice the area vector of the hole.
Vector3 hole_normal(const Collar& collar, std::span<const Vector3> metres) {
  Vector3 sum{};
  for (const Ring& loop : collar.loops) {
    for (std::size_t i = 2; i < loop.size(); ++i) {
      sum = sum + geometry::cross(metres[loop[i - 1]] - metres[loop[0]],
                                  metres[loop[i]] - metres[loop[0]]);
    }
  }
  return sum;
}

/// The places along a direction; none for a direction of length 0.
std::vector<Point> along(const Vector3& direction, std::span<const Vector3> metres) {
  const double size = geometry::length(direction);
  if (!(size > 0)) return {};
  const Vector3 normal = direction * (1 / size);
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(normal[i]) < std::abs(normal[axis])) axis = i;
  }
  Vector3 first{};
  first[axis] = 1;
  first = first - normal * normal[axis];
  first = first * (1 / geometry::length(first));
  const Vector3 second = geometry::cross(normal, first);
  std::vector<Point> places;
  for (const Vector3& place : metres) {
    const Vector3 way = place - metres[0];
    places.push_back({geometry::dot(way, first), geometry::dot(way, second), 0});
  }
  return places;
}

std::vector<Point> conformal(const Collar& collar, std::span<const Triangle> closing,
                             std::span<const Vector3> metres) {
  std::vector<Triangle> triangles = collar.triangles;
  triangles.insert(triangles.end(), closing.begin(), closing.end());
  std::vector<Point> places;
  for (const Vector3& place : metres) {
    const Vector3 way = place - metres[0];
    places.push_back({way[0], way[1], way[2]});
  }
  auto map = spline::conformal_map(places, triangles);
  return map ? *std::move(map) : std::vector<Point>();
}

/// The squared singular values of the map of a triangle from space to the plane, the larger one
/// first; zeros where the triangle has no area.
std::array<double, 2> squared_stretches(const Triangle& t, std::span<const Vector3> metres,
                                        std::span<const Point> places) {
  const Vector3 first = metres[t[1]] - metres[t[0]];
  const Vector3 second = metres[t[2]] - metres[t[0]];
  const double length = geometry::length(first);
  if (!(length > 0)) return {};
  const double x = geometry::dot(first, second) / length;
  const double y = geometry::length(geometry::cross(first, second)) / length;
  if (!(y > 0)) return {};
  const Vector3 p = geometry::difference(places[t[1]], places[t[0]]) * (1 / length);
  const Vector3 q = (geometry::difference(places[t[2]], places[t[0]]) - p * x) * (1 / y);
  const double half = (geometry::dot(p, p) + geometry::dot(q, q)) / 2;
  const double rest = (geometry::dot(p, p) - geometry::dot(q, q)) / 2;
  const double mixed = geometry::dot(p, q);
  const double root = std::sqrt(rest * rest + mixed * mixed);
  return {half + root, half - root};
}

/// Nothing if a triangle of the collar turns over.
std::optional<Flattened> measured(std::vector<Point> places, const Collar& collar,
                                  std::span<const Vector3> metres) {
  if (places.empty()) return std::nullopt;
  double largest = 0;
  double least = 0;
  for (const Triangle& t : collar.triangles) {
    if (geometry::turn(places[t[0]], places[t[1]], places[t[2]]) <= 0) return std::nullopt;
    const auto [long_one, short_one] = squared_stretches(t, metres, places);
    if (!(short_one > 0)) return std::nullopt;
    largest = std::max(largest, long_one);
    least = least == 0 ? short_one : std::min(least, short_one);
  }
  // The scale that makes the largest and the least factor equal.
  const double scale = 1 / std::sqrt(std::sqrt(largest * least));
  for (Point& p : places) p = {p.x * scale, p.y * scale, 0};
  return Flattened{std::move(places), std::sqrt(std::sqrt(largest / least))};
}

}  // namespace

std::vector<Flattened> flatten(const Collar& collar, std::span<const Triangle> closing,
                               std::span<const Vector3> metres) {
  std::vector<Flattened> maps;
  const auto add = [&](std::vector<Point> places) {
    if (auto map = measured(std::move(places), collar, metres)) maps.push_back(*std::move(map));
  };
  add(along(hole_normal(collar, metres), metres));
  add(conformal(collar, closing, metres));
  std::ranges::stable_sort(maps, {}, &Flattened::stretch);
  if (maps.empty()) add(conformal(collar, {}, metres));  // the filling may be folded
  return maps;
}

}  // namespace watertight::repair
