// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/geometry/triangle_oracle.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <sstream>
#include <variant>
#include <vector>

#include "geometry/intersection/box_partition.h"
#include "geometry/predicates/predicates.h"

namespace watertight::test {
namespace {

using Kernel = CGAL::Simple_cartesian<CGAL::Exact_rational>;
using Exact = Kernel::Point_3;

Exact exact(const Point& p) { return {p.x, p.y, p.z}; }

Kernel::Triangle_3 exact(const TrianglePair& pair, const Triangle& t) {
  return {exact(pair.points[t[0]]), exact(pair.points[t[1]]), exact(pair.points[t[2]])};
}

/// The corners of the common part: none, a point, the ends of a segment or the corners of a
/// polygon.
std::vector<Exact> common_part(const TrianglePair& pair) {
  const auto common = CGAL::intersection(exact(pair, pair.first), exact(pair, pair.second));
  std::vector<Exact> corners;
  if (!common) return corners;
  if (const auto* point = std::get_if<Kernel::Point_3>(&*common)) {
    corners = {*point};
  } else if (const auto* segment = std::get_if<Kernel::Segment_3>(&*common)) {
    corners = {segment->source(), segment->target()};
  } else if (const auto* triangle = std::get_if<Kernel::Triangle_3>(&*common)) {
    corners = {triangle->vertex(0), triangle->vertex(1), triangle->vertex(2)};
  } else if (const auto* polygon = std::get_if<std::vector<Kernel::Point_3>>(&*common)) {
    corners = *polygon;
  }
  return corners;
}

enum class Feature { vertex, edge, inside };

/// The feature of a triangle in which a point lies: a barycentric coordinate is zero on the
/// opposite edge.
Feature feature_of(const Kernel::Triangle_3& triangle, const Exact& point) {
  int zeros = 0;
  for (int i = 0; i < 3; ++i) {
    const auto area =
        CGAL::cross_product(triangle.vertex(i + 1) - point, triangle.vertex(i + 2) - point);
    if (area == CGAL::NULL_VECTOR) ++zeros;
  }
  return zeros == 0 ? Feature::inside : zeros == 1 ? Feature::edge : Feature::vertex;
}

std::size_t common_indices(const TrianglePair& pair) {
  return static_cast<std::size_t>(
      std::count_if(pair.first.begin(), pair.first.end(), [&](Index vertex) {
        return std::find(pair.second.begin(), pair.second.end(), vertex) != pair.second.end();
      }));
}

geometry::ContactClass class_of_point(const TrianglePair& pair, Feature a, Feature b) {
  if (common_indices(pair) > 0) return geometry::ContactClass::shared_vertex;
  if (a == Feature::vertex && b == Feature::vertex) return geometry::ContactClass::vertex_vertex;
  if (a == Feature::inside || b == Feature::inside) return geometry::ContactClass::vertex_face;
  if (a == Feature::edge && b == Feature::edge) return geometry::ContactClass::edge_edge;
  return geometry::ContactClass::vertex_edge;
}

geometry::ContactClass class_of_segment(const TrianglePair& pair, Feature a, Feature b) {
  if (common_indices(pair) == 2) return geometry::ContactClass::shared_edge;
  if (a == Feature::inside && b == Feature::inside) return geometry::ContactClass::crossing;
  if (a == Feature::inside || b == Feature::inside) return geometry::ContactClass::edge_face;
  return geometry::ContactClass::edge_overlap;
}

geometry::ContactClass class_of_area(const TrianglePair& pair) {
  const auto sorted = [&](const Triangle& t) {
    std::array<Point, 3> points{pair.points[t[0]], pair.points[t[1]], pair.points[t[2]]};
    std::sort(points.begin(), points.end());
    return points;
  };
  return sorted(pair.first) == sorted(pair.second) ? geometry::ContactClass::duplicate
                                                   : geometry::ContactClass::coplanar_overlap;
}

bool is_degenerate(const TrianglePair& pair, const Triangle& t) {
  return geometry::are_collinear(pair.points[t[0]], pair.points[t[1]], pair.points[t[2]]);
}

/// Moves a vertex of the second triangle into the plane of the first one, whose vertices are
/// multiples of 6: its weights are sixths, so that vertices, edges, insides and outsides all occur.
void place_on_first(TrianglePair& pair, std::size_t vertex, Random& random) {
  const std::int64_t u = random.between(-2, 8);
  const std::int64_t v = random.below(2) == 0 ? 0 : random.between(-2, 8);
  const std::int64_t w = 6 - u - v;
  for (int axis = 0; axis < 3; ++axis) {
    pair.points[vertex][axis] = (static_cast<double>(u) * pair.points[0][axis] +
                                 static_cast<double>(v) * pair.points[1][axis] +
                                 static_cast<double>(w) * pair.points[2][axis]) /
                                6;
  }
}

TrianglePair candidate(Random& random) {
  // 6 x 2^16 and 6 x 2^17 are about the size up to which planes are exact.
  constexpr std::array<std::uint64_t, 9> kGrids{2,    3,         4,         6,        10,
                                                1000, 1U << 16U, 1U << 17U, 1U << 28U};
  TrianglePair pair{{}, {0, 1, 2}, {3, 4, 5}};
  const std::uint64_t grid = kGrids[random.below(kGrids.size())];
  for (Point& p : pair.points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = 6.0 * static_cast<double>(random.below(grid));
  }
  if (random.below(5) == 0) {
    for (Point& p : pair.points) p[2] = 6;
  }
  const std::uint64_t placed = random.below(4);
  for (std::uint64_t i = 0; i < placed; ++i) place_on_first(pair, 3 + i, random);
  // The triangles get up to three common vertices, or equal vertices with different indices.
  const std::uint64_t common = random.below(3) == 0 ? random.below(4) : 0;
  const bool is_by_index = random.below(4) != 0;
  std::array<Index, 3> chosen{0, 1, 2};
  shuffle(chosen, random);
  for (std::uint64_t i = 0; i < common; ++i) {
    pair.points[3 + i] = pair.points[chosen[i]];
    if (is_by_index) pair.second[i] = chosen[i];
  }
  shuffle(pair.first, random);
  shuffle(pair.second, random);
  return pair;
}

std::string description(const TrianglePair& pair, geometry::ContactClass expected,
                        geometry::ContactClass found) {
  std::ostringstream text;
  text << "constructed " << geometry::to_string(expected) << ", classified "
       << geometry::to_string(found) << ":";
  for (const Triangle* t : {&pair.first, &pair.second}) {
    for (const Index vertex : *t) {
      const Point& p = pair.points[vertex];
      text << " " << vertex << "(" << p.x << " " << p.y << " " << p.z << ")";
    }
    text << ";";
  }
  return text.str();
}

}  // namespace

TrianglePair random_pair(Random& random) {
  TrianglePair pair = candidate(random);
  while (is_degenerate(pair, pair.first) || is_degenerate(pair, pair.second)) {
    pair = candidate(random);
  }
  return pair;
}

geometry::ContactClass constructed_class(const TrianglePair& pair) {
  if (common_indices(pair) == 3) return geometry::ContactClass::duplicate;
  const std::vector<Exact> corners = common_part(pair);
  if (corners.empty()) return geometry::ContactClass::disjoint;
  if (corners.size() > 2) return class_of_area(pair);
  const Exact middle = CGAL::midpoint(corners.front(), corners.back());
  const Feature a = feature_of(exact(pair, pair.first), middle);
  const Feature b = feature_of(exact(pair, pair.second), middle);
  return corners.size() == 1 ? class_of_point(pair, a, b) : class_of_segment(pair, a, b);
}

std::optional<std::string> disagreement(const TrianglePair& pair, Random& random) {
  const geometry::ContactClass expected = constructed_class(pair);
  const auto found = geometry::classify_contact(pair.points, pair.first, pair.second);
  if (found != expected) return description(pair, expected, found);
  Triangle first = pair.first;
  Triangle second = pair.second;
  shuffle(first, random);
  shuffle(second, random);
  const auto turned = geometry::classify_contact(pair.points, second, first);
  if (turned != expected) return "turned: " + description(pair, expected, turned);
  // The box partition decides most pairs without a full classification.
  const std::array<Triangle, 2> both{first, second};
  const auto searched = geometry::intersecting_pairs(pair.points, both);
  const bool is_found = searched && searched->size() == 1;
  const geometry::ContactClass contact =
      is_found ? searched->front().contact : geometry::ContactClass::disjoint;
  if (is_found != geometry::is_intersection(expected) || (is_found && contact != expected)) {
    return "searched: " + description(pair, expected, contact);
  }
  return std::nullopt;
}

}  // namespace watertight::test
