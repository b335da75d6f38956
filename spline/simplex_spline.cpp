// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/simplex_spline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/assert.h"
#include "geometry/predicates/turn.h"

namespace watertight::spline {
namespace {

/// Knots without the one at a place.
struct FewerKnots {
  std::array<Point, kMostKnots> points{};
  std::size_t size = 0;

  FewerKnots(std::span<const Point> knots, int place) {
    for (std::size_t i = 0; i < knots.size(); ++i) {
      if (i != static_cast<std::size_t>(place)) points[size++] = knots[i];
    }
  }
  std::span<const Point> span() const { return {points.data(), size}; }
};

std::array<Point, 3> corners_of(std::span<const Point> knots, const BaseTriple& triple) {
  std::array<Point, 3> corners;
  for (std::size_t j = 0; j < 3; ++j)
    corners[j] = knots[static_cast<std::size_t>(triple.places[j])];
  return corners;
}

double constant_spline(const Point& u, std::span<const Point> knots) {
  Point b = knots[1];
  Point c = knots[2];
  const int sense = geometry::turn(knots[0], b, c);
  const double area = std::abs(twice_area(knots[0], b, c));
  if (sense == 0 || area == 0) return 0;
  if (sense < 0) std::swap(b, c);
  return is_in_triangle(knots[0], b, c, u) ? 1 / area : 0;
}

/// The sum over the splines of one degree less, each times its gradient in a direction and what
/// `lower` makes of it.
template <class Lower>
double derived(std::span<const Point> knots, const Point& direction, const Lower& lower) {
  const BaseTriple triple = base_triple(knots);
  if (triple.doubled_area == 0) return 0;
  const auto gradients = barycentric_gradients(corners_of(knots, triple), triple.doubled_area);
  double sum = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const double factor = gradients[j].x * direction.x + gradients[j].y * direction.y;
    sum += factor * lower(FewerKnots(knots, triple.places[j]).span());
  }
  return static_cast<double>(knots.size() - 3) * sum;
}

}  // namespace

bool is_in_triangle_from(const Point& a, const Point& b, const Point& c, const Point& u,
                         const Point& from) {
  const auto is_left = [&](const Point& p, const Point& q) {
    if (const int side = geometry::turn(p, q, u)) return side > 0;
    if (const int side = geometry::turn(p, q, from)) return side > 0;
    return shifted_side(p, q, u) > 0;
  };
  return is_left(a, b) && is_left(b, c) && is_left(c, a);
}

BaseTriple base_triple(std::span<const Point> knots) {
  BaseTriple best;
  const int count = static_cast<int>(knots.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      for (int k = j + 1; k < count; ++k) {
        const auto at = [&](int place) { return knots[static_cast<std::size_t>(place)]; };
        const double area = twice_area(at(i), at(j), at(k));
        if (std::abs(area) > std::abs(best.doubled_area)) best = {{i, j, k}, area};
      }
    }
  }
  return best;
}

std::array<Point, 3> barycentric_gradients(const std::array<Point, 3>& corners,
                                           double doubled_area) {
  std::array<Point, 3> gradients;
  for (std::size_t j = 0; j < 3; ++j) {
    const Point& next = corners[(j + 1) % 3];
    const Point& last = corners[(j + 2) % 3];
    gradients[j] = {(next.y - last.y) / doubled_area, (last.x - next.x) / doubled_area, 0};
  }
  return gradients;
}

double simplex_spline(const Point& u, std::span<const Point> knots) {
  WATERTIGHT_ASSERT(knots.size() >= 3 && knots.size() <= static_cast<std::size_t>(kMostKnots));
  if (knots.size() == 3) return constant_spline(u, knots);
  const BaseTriple triple = base_triple(knots);
  if (triple.doubled_area == 0) return 0;
  const auto corners = corners_of(knots, triple);
  double sum = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const double share =
        twice_area(u, corners[(j + 1) % 3], corners[(j + 2) % 3]) / triple.doubled_area;
    sum += share * simplex_spline(u, FewerKnots(knots, triple.places[j]).span());
  }
  return sum;
}

double simplex_spline_derivative(const Point& u, std::span<const Point> knots,
                                 const Point& direction) {
  WATERTIGHT_ASSERT(knots.size() >= 4);
  return derived(knots, direction,
                 [&](std::span<const Point> fewer) { return simplex_spline(u, fewer); });
}

double simplex_spline_second_derivative(const Point& u, std::span<const Point> knots,
                                        const Point& first, const Point& second) {
  WATERTIGHT_ASSERT(knots.size() >= 5);
  return derived(knots, first, [&](std::span<const Point> fewer) {
    return simplex_spline_derivative(u, fewer, second);
  });
}

}  // namespace watertight::spline
