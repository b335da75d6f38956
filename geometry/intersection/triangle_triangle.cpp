// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/intersection/triangle_triangle.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/assert.h"
#include "geometry/intersection/contact_classifier.h"
#include "geometry/predicates/exact_quotient.h"
#include "geometry/predicates/inline_predicates.h"
#include "geometry/vector3.h"

namespace watertight::geometry {
namespace {

using Rational = mpq_class;
using Vector = std::array<Rational, 3>;

Vector vector_of(const Point& p) { return {Rational(p.x), Rational(p.y), Rational(p.z)}; }

/// The part of a convex polygon where normal . (x - origin) >= 0 (Sutherland and Hodgman 1974).
std::vector<Vector> clipped(const std::vector<Vector>& polygon, const Vector& origin,
                            const Vector& normal) {
  std::vector<Vector> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector& from = polygon[i];
    const Vector& to = polygon[i + 1 == polygon.size() ? 0 : i + 1];
    const Rational height_from = dot(normal, from - origin);
    const Rational height_to = dot(normal, to - origin);
    if (sgn(height_from) >= 0) result.push_back(from);
    if (sgn(height_from) * sgn(height_to) < 0) {
      const Rational at = height_from / (height_from - height_to);
      Vector crossing;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        crossing[axis] = from[axis] + at * (to[axis] - from[axis]);
      }
      result.push_back(std::move(crossing));
    }
  }
  return result;
}

/// The corners of the common part of two triangles, without repetition.
std::vector<Vector> common_corners(const std::array<Vector, 3>& a, const std::array<Vector, 3>& b) {
  const Vector normal = cross(b[1] - b[0], b[2] - b[0]);
  const Vector opposite{Rational(-normal[0]), Rational(-normal[1]), Rational(-normal[2])};
  std::vector<Vector> polygon{a[0], a[1], a[2]};
  polygon = clipped(polygon, b[0], normal);
  polygon = clipped(polygon, b[0], opposite);
  for (std::size_t i = 0; i < 3; ++i) {
    polygon = clipped(polygon, b[i], cross(normal, b[i == 2 ? 0 : i + 1] - b[i]));
  }
  std::sort(polygon.begin(), polygon.end());
  polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
  return polygon;
}

}  // namespace

std::string_view to_string(ContactClass contact) {
  constexpr std::array<std::string_view, 12> kNames{
      "disjoint",    "shared-vertex", "shared-edge",      "vertex-vertex",
      "vertex-edge", "vertex-face",   "edge-edge",        "edge-overlap",
      "edge-face",   "crossing",      "coplanar-overlap", "duplicate"};
  const auto index = static_cast<std::size_t>(contact);
  return index < kNames.size() ? kNames[index] : "unknown";
}

ContactClass classify_contact(std::span<const Point> points, const Triangle& first,
                              const Triangle& second) {
  return ContactClassifier<InlinePredicates>(points).classify(first, second);
}

Point contact_witness(std::span<const Point> points, const Triangle& first,
                      const Triangle& second) {
  const auto corners_of = [&](const Triangle& t) {
    return std::array<Vector, 3>{vector_of(points[t[0]]), vector_of(points[t[1]]),
                                 vector_of(points[t[2]])};
  };
  const std::vector<Vector> corners = common_corners(corners_of(first), corners_of(second));
  WATERTIGHT_ASSERT(!corners.empty());
  if (corners.empty()) return points[first[0]];
  Point witness;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Rational sum = 0;
    for (const Vector& corner : corners) sum += corner[axis];
    sum /= static_cast<unsigned long>(corners.size());
    witness[static_cast<int>(axis)] = nearest_quotient(sum.get_num(), sum.get_den(), 0) + 0.0;
  }
  return witness;
}

}  // namespace watertight::geometry
