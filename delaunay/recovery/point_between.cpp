// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/recovery/point_between.h"

#include <cmath>

#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

/// The most bits of a place.
constexpr int kPlaceBits = 16;

/// The point at a place of a segment, if doubles hold it.
std::optional<Point> exact_point(const Point& p, const Point& q, double place) {
  const Point m{p.x * (1 - place) + q.x * place, p.y * (1 - place) + q.y * place,
                p.z * (1 - place) + q.z * place};
  if (m == p || m == q || !geometry::is_on_segment(p, q, m)) return std::nullopt;
  return m;
}

}  // namespace

std::optional<Point> point_between(const Point& p, const Point& q,
                                   const std::array<double, 2>& places) {
  const double margin = (places[1] - places[0]) / 8;
  const double least = places[0] + margin;
  const double most = places[1] - margin;
  double part = 1;
  for (int bits = 1; bits <= kPlaceBits; ++bits) {
    part /= 2;
    const double place = std::ceil(least / part) * part;
    if (place > most) continue;
    const std::optional<Point> point = exact_point(p, q, place);
    if (point) return point;
  }
  return exact_point(p, q, 0.5);
}

double squared_distance(const Point& p, const Point& q) {
  const Point d{p.x - q.x, p.y - q.y, p.z - q.z};
  return d.x * d.x + d.y * d.y + d.z * d.z;
}

}  // namespace watertight::delaunay
