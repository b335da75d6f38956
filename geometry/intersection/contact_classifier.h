// SPDX-License-Identifier: GPL-3.0-or-later
//
// The triangle-triangle classification as an inline template over its two orientation predicates,
// so that the box partition runs it with the predicates' filters inlined. Private to geometry/.
//
// Based on: P. Guigue and O. Devillers, Fast and Robust Triangle-Triangle Overlap Test Using
// Orientation Predicates, Journal of Graphics Tools 8(1), 2003; E. Verbree and H. Si, Validation
// and Storage of Polyhedra through Constrained Delaunay Tetrahedralization, 2008, section 3.2.
// Departures: the classifier names every kind of contact, knows vertices by index, and never calls
// a predicate with a repeated vertex (for an exact zero the predicate's filter fails, which costs a
// hundred times more).
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "geometry/intersection/triangle_triangle.h"
#include "geometry/point.h"

namespace watertight::geometry {

/// Predicates gives orient3d(a, b, c, d) and orient2d(a, b, c, axis) on Points, as
/// geometry/predicates/predicates.h defines them.
template <class Predicates>
class ContactClassifier {
 public:
  explicit ContactClassifier(std::span<const Point> points) : points_(points.data()) {}

  ContactClass classify(const Triangle& first, const Triangle& second) const {
    // The common vertices are moved to the front of both triangles, in the same order.
    Triangle a = first;
    Triangle b = second;
    std::size_t common = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = common; j < 3; ++j) {
        if (a[i] != b[j]) continue;
        std::swap(a[common], a[i]);
        std::swap(b[common], b[j]);
        ++common;
        break;
      }
    }
    switch (common) {
      case 0:
        return without_common_vertex(a, b);
      case 1:
        return with_common_vertex(a, b);
      case 2:
        return with_common_edge(a, b);
      default:
        return ContactClass::duplicate;
    }
  }

 private:
  using Signs = std::array<int, 3>;

  int orient3d(Index a, Index b, Index c, Index d) const {
    return Predicates::orient3d(points_[a], points_[b], points_[c], points_[d]);
  }
  /// The orient2d of three vertices; zero, without a call of the predicate, if two are the same.
  int orient2d(Index a, Index b, Index c, int axis) const {
    if (a == b || b == c || c == a) return 0;
    return Predicates::orient2d(points_[a], points_[b], points_[c], axis);
  }

  /// The contact of a = (p, q, x) and b = (p, q, y), which have the edge pq in common.
  ContactClass with_common_edge(const Triangle& a, const Triangle& b) const {
    if (orient3d(a[0], a[1], a[2], b[2]) != 0) return ContactClass::shared_edge;
    const int axis = projection(a);
    if (orient2d(a[0], a[1], a[2], axis) != orient2d(a[0], a[1], b[2], axis)) {
      return ContactClass::shared_edge;
    }
    return overlap(a, b);
  }

  /// The contact of a = (p, a1, a2) and b = (p, b1, b2), which have the vertex p in common. Unless
  /// the triangles are in one plane, each meets the plane of the other along a ray from p (or in p
  /// alone). With p as the origin, s_i = det(a1, a2, b_i) and t_i = det(b1, b2, a_i), the line in
  /// which the planes meet has the direction
  ///   N = (a1 x a2) x (b1 x b2) = s2 b1 - s1 b2 = t1 a2 - t2 a1,
  /// so the ray of b points along sign(s2 - s1) N and the ray of a along sign(t1 - t2) N.
  ContactClass with_common_vertex(const Triangle& a, const Triangle& b) const {
    const int s1 = orient3d(a[0], a[1], a[2], b[1]);
    const int s2 = orient3d(a[0], a[1], a[2], b[2]);
    if (s1 * s2 > 0) return ContactClass::shared_vertex;
    if (s1 == 0 && s2 == 0) return coplanar(a, b);
    const int t1 = orient3d(b[0], b[1], b[2], a[1]);
    const int t2 = orient3d(b[0], b[1], b[2], a[2]);
    if (t1 * t2 > 0 || (s2 > s1) != (t1 > t2)) return ContactClass::shared_vertex;
    return along_segment(t1 == 0 || t2 == 0, s1 == 0 || s2 == 0);
  }

  ContactClass without_common_vertex(Triangle a, Triangle b) const {
    Signs of_b = sides(a, b);
    if (are_on_one_side(of_b)) return ContactClass::disjoint;
    if (of_b == Signs{0, 0, 0}) return coplanar(a, b);
    Signs of_a = sides(b, a);
    if (are_on_one_side(of_a)) return ContactClass::disjoint;
    isolate(a, of_a);
    isolate(b, of_b);
    return on_common_line(a, of_a, b, of_b);
  }

  /// The signs of the sides of the plane of `plane` on which the vertices of `triangle` lie.
  Signs sides(const Triangle& plane, const Triangle& triangle) const {
    return {orient3d(plane[0], plane[1], plane[2], triangle[0]),
            orient3d(plane[0], plane[1], plane[2], triangle[1]),
            orient3d(plane[0], plane[1], plane[2], triangle[2])};
  }

  static bool are_on_one_side(const Signs& signs) {
    return signs[0] != 0 && signs[0] == signs[1] && signs[1] == signs[2];
  }

  /// Moves to the front the vertex whose two edges reach the plane of the other triangle: the
  /// vertex whose sign differs from the two other signs, or the positive one if all three differ.
  static void isolate(Triangle& triangle, Signs& signs) {
    std::size_t alone = 0;
    if (signs[0] == signs[1]) {
      alone = 2;
    } else if (signs[0] == signs[2]) {
      alone = 1;
    } else if (signs[1] != signs[2]) {
      while (signs[alone] != 1) ++alone;
    }
    std::swap(triangle[0], triangle[alone]);
    std::swap(signs[0], signs[alone]);
  }

  /// The contact of two triangles whose planes meet in a line. The edges a0a1 and a0a2 reach the
  /// line at p1 and p2, the edges b0b1 and b0b2 at q1 and q2; with the line suitably directed,
  /// sign(q_l - p_j) = orient3d(a0, a_j, b0, b_l).
  ContactClass on_common_line(const Triangle& a, const Signs& of_a, const Triangle& b,
                              const Signs& of_b) const {
    std::array<std::array<int, 2>, 2> order{};
    bool has_positive = false;
    bool has_negative = false;
    std::size_t meeting_a = 0;  // the index j of a pair with p_j == q_l, or 0
    std::size_t meeting_b = 0;  // the index l of that pair, or 0
    for (std::size_t j = 0; j < 2; ++j) {
      for (std::size_t l = 0; l < 2; ++l) {
        order[j][l] = orient3d(a[0], a[j + 1], b[0], b[l + 1]);
        has_positive = has_positive || order[j][l] > 0;
        has_negative = has_negative || order[j][l] < 0;
        if (order[j][l] == 0) {
          meeting_a = j + 1;
          meeting_b = l + 1;
        }
      }
    }
    if (!has_positive || !has_negative) {
      if (meeting_a == 0) return ContactClass::disjoint;
      return at_point(of_a[0] == 0 || of_a[meeting_a] == 0, of_b[0] == 0 || of_b[meeting_b] == 0);
    }
    // The intervals p1p2 and q1q2 overlap. An interval is a single point if the first vertex of its
    // triangle lies in the plane of the other triangle.
    const bool is_a_along_edge = of_a[1] == 0 && of_a[2] == 0;
    const bool is_b_along_edge = of_b[1] == 0 && of_b[2] == 0;
    if (of_a[0] == 0) {
      return is_b_along_edge ? ContactClass::vertex_edge : ContactClass::vertex_face;
    }
    if (of_b[0] == 0) {
      return is_a_along_edge ? ContactClass::vertex_edge : ContactClass::vertex_face;
    }
    return along_segment(is_a_along_edge, is_b_along_edge);
  }

  static ContactClass at_point(bool is_vertex_of_a, bool is_vertex_of_b) {
    if (is_vertex_of_a && is_vertex_of_b) return ContactClass::vertex_vertex;
    return is_vertex_of_a || is_vertex_of_b ? ContactClass::vertex_edge : ContactClass::edge_edge;
  }

  static ContactClass along_segment(bool is_edge_of_a, bool is_edge_of_b) {
    if (is_edge_of_a && is_edge_of_b) return ContactClass::edge_overlap;
    return is_edge_of_a || is_edge_of_b ? ContactClass::edge_face : ContactClass::crossing;
  }

  /// An axis along which the projection of the triangle is not degenerate.
  int projection(const Triangle& t) const {
    for (const int axis : {2, 1}) {
      if (orient2d(t[0], t[1], t[2], axis) != 0) return axis;
    }
    return 0;
  }

  /// The contact of two triangles with a common area.
  ContactClass overlap(const Triangle& a, const Triangle& b) const {
    std::array<Point, 3> of_a{points_[a[0]], points_[a[1]], points_[a[2]]};
    std::array<Point, 3> of_b{points_[b[0]], points_[b[1]], points_[b[2]]};
    std::sort(of_a.begin(), of_a.end());
    std::sort(of_b.begin(), of_b.end());
    return of_a == of_b ? ContactClass::duplicate : ContactClass::coplanar_overlap;
  }

  /// The contact of two triangles in one plane with at most one common vertex. Their insides are
  /// disjoint exactly if the line of an edge separates them; the triangles then meet on that line
  /// only.
  ContactClass coplanar(const Triangle& a, const Triangle& b) const {
    const int axis = projection(a);
    if (const auto contact = across_an_edge(a, b, axis)) return *contact;
    if (const auto contact = across_an_edge(b, a, axis)) return *contact;
    return overlap(a, b);
  }

  /// The contact if the line of an edge of `a` separates the triangles; else nothing.
  std::optional<ContactClass> across_an_edge(const Triangle& a, const Triangle& b, int axis) const {
    const int inside = orient2d(a[0], a[1], a[2], axis);
    for (std::size_t i = 0; i < 3; ++i) {
      const Index from = a[i];
      const Index to = a[i == 2 ? 0 : i + 1];
      std::array<Index, 3> on_line{};
      std::size_t count = 0;
      bool is_separating = true;
      for (const Index vertex : b) {
        const int side = orient2d(from, to, vertex, axis);
        if (side == inside) is_separating = false;
        if (side == 0) on_line[count++] = vertex;
      }
      if (!is_separating) continue;
      if (count == 0) return ContactClass::disjoint;
      // A triangle that is not degenerate has at most two vertices on a line.
      return on_edge_line(from, to, on_line[0], on_line[count - 1], a[0] == b[0]);
    }
    return std::nullopt;
  }

  /// The contact of the edge (from, to) with the edge or vertex (first, last) on its line. Points
  /// of a line follow each other in lexicographic order.
  ContactClass on_edge_line(Index from, Index to, Index first, Index last,
                            bool have_common_vertex) const {
    const auto [a_min, a_max] = std::minmax(points_[from], points_[to]);
    const auto [b_min, b_max] = std::minmax(points_[first], points_[last]);
    const Point& low = std::max(a_min, b_min);
    const Point& high = std::min(a_max, b_max);
    if (low > high) return ContactClass::disjoint;
    if (low < high) return ContactClass::edge_overlap;
    if (have_common_vertex) return ContactClass::shared_vertex;
    return at_point(low == a_min || low == a_max, low == b_min || low == b_max);
  }

  const Point* points_;
};

}  // namespace watertight::geometry
