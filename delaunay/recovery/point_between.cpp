// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/recovery/point_between.h"

#include <cmath>

#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

/// The most bits of a place.
constexpr int kPlaceBits = 40;

}  // namespace

std::optional<PlacedPoint> point_at(const Point& p, const Point& q, double place) {
  const Point m{p.x * (1 - place) + q.x * place, p.y * (1 - place) + q.y * place,
                p.z * (1 - place) + q.z * place};
  if (m == p || m == q || !geometry::is_on_segment(p, q, m)) return std::nullopt;
  return PlacedPoint{m, place};
}

std::optional<PlacedPoint> point_between(const Point& p, const Point& q,
                                         const std::array<double, 2>& places) {
  const double margin = (places[1] - places[0]) / 8;
  const double least = places[0] + margin;
  const double most = places[1] - margin;
  double part = 1;
  for (int bits = 1; bits <= kPlaceBits; ++bits) {
    part /= 2;
    const double place = std::ceil(least / part) * part;
    if (place > most) continue;
    const std::optional<PlacedPoint> point = point_at(p, q, place);
    if (point) return point;
  }
  return std::nullopt;
}

Point centre_of(const std::vector<Point>& points, const geometry::Tetrahedron& tetrahedron) {
  Point centre{0, 0, 0};
  for (const Index vertex : tetrahedron) {
    const Point& p = points[vertex];
    centre = {centre.x + p.x / 4, centre.y + p.y / 4, centre.z + p.z / 4};
  }
  return centre;
}

double squared_distance(const Point& p, const Point& q) {
  const Point d{p.x - q.x, p.y - q.y, p.z - q.z};
  return d.x * d.x + d.y * d.y + d.z * d.z;
}

}  // namespace watertight::delaunay
