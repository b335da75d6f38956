// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/certificate/complex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "delaunay/canonical/sort_by_vertices.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

/// The number of hull faces at which rays are aimed until one meets no edge.
constexpr std::size_t kRayTargets = 64;

ComplexFault fault(ComplexFault::Kind kind, std::string detail) {
  return {kind, std::move(detail)};
}

/// A face of a tetrahedron and whether the fourth vertex is above it.
struct Side {
  Triangle vertices{};
  Index tetrahedron = kNone;
  bool is_above = false;
};

/// Sorts the triangle. Returns true if that takes an even number of exchanges.
bool sort_counting(Triangle& t) {
  bool is_even = true;
  const auto exchange = [&](std::size_t i, std::size_t j) {
    if (t[i] <= t[j]) return;
    std::swap(t[i], t[j]);
    is_even = !is_even;
  };
  exchange(0, 1);
  exchange(1, 2);
  exchange(0, 1);
  return is_even;
}

/// The four faces of a positive tetrahedron (a, b, c, d): d is above (a, b, c), c above (a, d, b),
/// b above (a, c, d), a above (b, d, c).
std::array<Side, 4> sides_of(const geometry::Tetrahedron& t, Index number) {
  std::array<Side, 4> sides{Side{{t[0], t[1], t[2]}, number}, Side{{t[0], t[3], t[1]}, number},
                            Side{{t[0], t[2], t[3]}, number}, Side{{t[1], t[3], t[2]}, number}};
  for (Side& side : sides) side.is_above = sort_counting(side.vertices);
  return sides;
}

bool has_repeated_vertex(const geometry::Tetrahedron& t) {
  return t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] ||
         t[2] == t[3];
}

std::string name(const Triangle& t) {
  std::string text = "(";
  text += std::to_string(t[0]);
  text += ", ";
  text += std::to_string(t[1]);
  text += ", ";
  text += std::to_string(t[2]);
  text += ")";
  return text;
}

/// The hull faces, oriented outward.
std::vector<Triangle> hull_of(const Complex& complex) {
  std::vector<Triangle> hull;
  for (const ComplexFace& face : complex.faces) {
    const auto& [a, b, c] = face.vertices;
    if (face.above == kNone) hull.push_back({a, b, c});
    if (face.below == kNone) hull.push_back({a, c, b});
  }
  return hull;
}

Point mean(std::span<const Point> points, std::span<const Index> which) {
  Point sum{};
  const double weight = 1.0 / static_cast<double>(which.size());
  for (const Index i : which) {
    for (int axis = 0; axis < 3; ++axis) sum[axis] += points[i][axis] * weight;
  }
  return sum;
}

/// Six times the volume, with rounding errors; for comparisons only.
double rough_volume(std::span<const Point> points, const geometry::Tetrahedron& t) {
  std::array<std::array<double, 3>, 3> m{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (int axis = 0; axis < 3; ++axis) {
      m[row][static_cast<std::size_t>(axis)] = points[t[row + 1]][axis] - points[t[0]][axis];
    }
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

bool is_inside_all(std::span<const Point> points, std::span<const Triangle> hull, const Point& o) {
  return std::all_of(hull.begin(), hull.end(), [&](const Triangle& t) {
    return geometry::orient3d(points[t[0]], points[t[1]], points[t[2]], o) < 0;
  });
}

/// A point strictly on the inner side of every hull face, or nothing.
std::optional<Point> inner_point(const Tetrahedralization& data, std::span<const Triangle> hull) {
  const geometry::Tetrahedron* largest = &data.tetrahedra.front();
  double volume = -1;
  for (const geometry::Tetrahedron& t : data.tetrahedra) {
    const double own = rough_volume(data.points, t);
    if (own > volume) {
      volume = own;
      largest = &t;
    }
  }
  const Point o = mean(data.points, *largest);
  if (is_inside_all(data.points, hull, o)) return o;
  return std::nullopt;
}

/// The number of hull faces that the ray from o through q meets; nothing if the ray meets an edge.
std::optional<std::size_t> faces_met(std::span<const Point> points, std::span<const Triangle> hull,
                                     const Point& o, const Point& q) {
  std::size_t met = 0;
  for (const auto& [a, b, c] : hull) {
    const int first = geometry::orient3d(o, points[a], points[b], q);
    if (first < 0) continue;
    const int second = geometry::orient3d(o, points[b], points[c], q);
    if (second < 0) continue;
    const int third = geometry::orient3d(o, points[c], points[a], q);
    if (third < 0) continue;
    if (first == 0 || second == 0 || third == 0) return std::nullopt;
    ++met;
  }
  return met;
}

/// True if a ray from o meets the hull exactly once.
bool is_met_once(std::span<const Point> points, std::span<const Triangle> hull, const Point& o) {
  const std::size_t step = std::max<std::size_t>(1, hull.size() / kRayTargets);
  for (std::size_t i = 0; i < hull.size(); i += step) {
    const Point q = mean(points, hull[i]);
    if (q == o) continue;
    if (const auto met = faces_met(points, hull, o, q)) return *met == 1;
  }
  return false;
}

/// Fills Complex::first from the sorted faces.
void index_faces(std::size_t vertex_count, Complex& complex) {
  complex.first.reserve(vertex_count + 1);
  for (Index f = 0; f < complex.faces.size(); ++f) {
    while (complex.first.size() <= complex.faces[f].vertices[0]) complex.first.push_back(f);
  }
  complex.first.resize(vertex_count + 1, static_cast<Index>(complex.faces.size()));
}

struct HullEdge {
  Triangle key{};  // the smaller vertex, the larger vertex, the hull face
  Index opposite = 0;
  bool has_edge_of(const HullEdge& other) const {
    return key[0] == other.key[0] && key[1] == other.key[1];
  }
};

std::optional<ComplexFault> check_edges(std::span<const Point> points,
                                        std::span<const Triangle> hull) {
  std::vector<HullEdge> edges;
  edges.reserve(3 * hull.size());
  for (Index f = 0; f < hull.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(hull[f][k], hull[f][(k + 1) % 3]);
      edges.push_back({{low, high, f}, hull[f][(k + 2) % 3]});
    }
  }
  sort_by_vertices(edges, points.size(), [](const HullEdge& edge) { return edge.key; });
  using Kind = ComplexFault::Kind;
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    const bool is_pair = i + 1 < edges.size() && edges[i + 1].has_edge_of(edges[i]) &&
                         (i + 2 == edges.size() || !edges[i + 2].has_edge_of(edges[i]));
    if (!is_pair) return fault(Kind::not_convex, "a hull edge does not have two hull faces");
    const Triangle& t = hull[edges[i].key[2]];
    const Index other = edges[i + 1].opposite;
    if (std::find(t.begin(), t.end(), other) != t.end() ||
        geometry::orient3d(points[t[0]], points[t[1]], points[t[2]], points[other]) > 0) {
      return fault(Kind::not_convex, "the outer surface is not convex at face " + name(t));
    }
  }
  return std::nullopt;
}

}  // namespace

Index Complex::find(Triangle vertices) const {
  sort_counting(vertices);
  if (std::size_t{vertices[0]} + 1 >= first.size()) return kNone;
  const auto begin = faces.begin() + first[vertices[0]];
  const auto end = faces.begin() + first[vertices[0] + 1];
  const auto at = std::lower_bound(
      begin, end, vertices,
      [](const ComplexFace& face, const Triangle& t) { return face.vertices < t; });
  if (at == end || at->vertices != vertices) return kNone;
  return static_cast<Index>(at - faces.begin());
}

std::optional<ComplexFault> build_complex(const Tetrahedralization& data, Complex& complex) {
  using Kind = ComplexFault::Kind;
  if (data.tetrahedra.empty()) return fault(Kind::not_a_complex, "there are no tetrahedra");
  std::vector<Side> sides;
  sides.reserve(4 * data.tetrahedra.size());
  for (Index number = 0; number < data.tetrahedra.size(); ++number) {
    const geometry::Tetrahedron& t = data.tetrahedra[number];
    if (has_repeated_vertex(t) || geometry::orient3d(data.points[t[0]], data.points[t[1]],
                                                     data.points[t[2]], data.points[t[3]]) <= 0) {
      return fault(Kind::not_a_complex,
                   "tetrahedron " + std::to_string(number) + " is not positively oriented");
    }
    for (const Side& side : sides_of(t, number)) sides.push_back(side);
  }
  sort_by_vertices(sides, data.points.size(), [](const Side& side) { return side.vertices; });
  complex.faces.reserve(sides.size());
  for (const Side& side : sides) {
    if (complex.faces.empty() || complex.faces.back().vertices != side.vertices) {
      complex.faces.push_back({side.vertices, kNone, kNone});
    }
    ComplexFace& face = complex.faces.back();
    Index& place = side.is_above ? face.above : face.below;
    if (place != kNone) {
      return fault(Kind::not_a_complex,
                   "face " + name(side.vertices) + " has two tetrahedra on one side");
    }
    place = side.tetrahedron;
  }
  index_faces(data.points.size(), complex);
  return std::nullopt;
}

std::optional<ComplexFault> check_convex(const Tetrahedralization& data, const Complex& complex) {
  using Kind = ComplexFault::Kind;
  const std::vector<Triangle> hull = hull_of(complex);
  if (hull.empty()) return fault(Kind::not_convex, "there is no outer surface");
  const std::optional<Point> o = inner_point(data, hull);
  if (!o) return fault(Kind::not_convex, "no point is inside every outer face");
  if (!is_met_once(data.points, hull, *o)) {
    return fault(Kind::not_convex, "the outer surface winds around the inside more than once");
  }
  return check_edges(data.points, hull);
}

}  // namespace watertight::delaunay
