// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/plane/conformal_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>

#include "spline/energy/positive_system.h"

namespace watertight::spline {
namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

Eigen::Vector3d vector_between(const Point& from, const Point& to) {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}

Status check_corners(std::size_t vertices, std::span<const Triangle> triangles) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const Index corner : triangles[t]) {
      if (corner < vertices) continue;
      return Error{ErrorCode::malformed,
                   "triangle " + std::to_string(t) + " has a corner that is no vertex"};
    }
  }
  return Done{};
}

/// The vertex of a triangle farthest from a place.
Index farthest_from(const Point& from, std::span<const Point> places,
                    std::span<const Triangle> triangles) {
  Index farthest = triangles[0][0];
  double largest = -1;
  for (const Triangle& t : triangles) {
    for (const Index vertex : t) {
      const double distance = vector_between(from, places[vertex]).squaredNorm();
      if (!(distance > largest)) continue;
      largest = distance;
      farthest = vertex;
    }
  }
  return farthest;
}

/// A triangle in the frame of its first edge: what its corners are multiplied by in the derivative
/// of a map, as complex numbers.
struct ConformalTerms {
  std::array<std::array<double, 2>, 3> weights{};
  double area = 0;  // of the triangle
};

ConformalTerms terms_of(const Triangle& t, std::span<const Point> places) {
  ConformalTerms terms;
  const Eigen::Vector3d first = vector_between(places[t[0]], places[t[1]]);
  const Eigen::Vector3d second = vector_between(places[t[0]], places[t[2]]);
  const double length = first.norm();
  if (!(length > 0)) return terms;
  const double along = first.dot(second) / length;
  const double across = (second - first * (along / length)).norm();
  terms.area = length * across / 2;
  if (!(terms.area > 0)) return terms;
  const double scale = 1 / std::sqrt(2 * terms.area);
  terms.weights = {{{(along - length) * scale, across * scale},
                    {-along * scale, -across * scale},
                    {length * scale, 0}}};
  return terms;
}

/// The sum of squares |sum of weight * place|^2 over triangles as a quadratic form in the places of
/// the vertices that are not held.
class ConformalSystem {
 public:
  ConformalSystem(std::span<const Point> places, std::span<const Triangle> triangles)
      : rows_(places.size(), geometry::kNone), held_(places.size()) {
    const Index first = farthest_from(places[triangles[0][0]], places, triangles);
    const Index second = farthest_from(places[first], places, triangles);
    held_[second].x = vector_between(places[first], places[second]).norm();
    for (Index vertex = 0; vertex < places.size(); ++vertex) {
      if (vertex != first && vertex != second) rows_[vertex] = 2 * count_++;
    }
    right_ = Columns::Zero(size(), 3);
    for (const Triangle& t : triangles) add(t, terms_of(t, places));
  }

  Result<std::vector<Point>> solve() {
    if (size() == 0) return held_;
    Matrix matrix(size(), size());
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    const PositiveSystem system(matrix);
    if (!system.is_positive())
      return Error{ErrorCode::malformed, "the triangles do not hold all vertices in the plane"};
    const Columns found = system.solve(right_);
    std::vector<Point> places = held_;
    for (std::size_t vertex = 0; vertex < places.size(); ++vertex) {
      if (rows_[vertex] == geometry::kNone) continue;
      const auto row = static_cast<Eigen::Index>(rows_[vertex]);
      places[vertex] = {found(row, 0), found(row + 1, 0), 0};
    }
    return places;
  }

 private:
  Eigen::Index size() const { return 2 * static_cast<Eigen::Index>(count_); }

  void add(const Triangle& t, const ConformalTerms& terms) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (rows_[t[i]] == geometry::kNone) continue;
      for (std::size_t j = 0; j < 3; ++j) {
        const auto [a, b] = terms.weights[i];
        const auto [c, d] = terms.weights[j];
        add_product(t[i], t[j], a * c + b * d, a * d - b * c);
      }
    }
  }

  /// Adds conj(weight of i) * weight of j, which is (real, imaginary).
  void add_product(Index i, Index j, double real, double imaginary) {
    const auto row = static_cast<int>(rows_[i]);
    if (rows_[j] == geometry::kNone) {
      right_(row, 0) -= real * held_[j].x - imaginary * held_[j].y;
      right_(row + 1, 0) -= imaginary * held_[j].x + real * held_[j].y;
      return;
    }
    const auto column = static_cast<int>(rows_[j]);
    entries_.emplace_back(row, column, real);
    entries_.emplace_back(row + 1, column + 1, real);
    entries_.emplace_back(row, column + 1, -imaginary);
    entries_.emplace_back(row + 1, column, imaginary);
  }

  std::vector<Index> rows_;  // of the x of each vertex; y is the next one
  std::vector<Point> held_;
  Index count_ = 0;
  Entries entries_;
  Columns right_;
};

}  // namespace

Result<std::vector<Point>> conformal_map(std::span<const Point> places,
                                         std::span<const Triangle> triangles) {
  for (const Point& p : places) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      return Error{ErrorCode::malformed, "a vertex is not finite"};
  }
  if (Status checked = check_corners(places.size(), triangles); !checked)
    return std::move(checked).error();
  double area = 0;
  for (const Triangle& t : triangles) area += terms_of(t, places).area;
  if (!(area > 0) || !std::isfinite(area))
    return Error{ErrorCode::malformed, "the triangles have no area"};
  auto map = ConformalSystem(places, triangles).solve();
  if (!map) return map;
  double mapped = 0;
  for (const auto& [a, b, c] : triangles) mapped += twice_area((*map)[a], (*map)[b], (*map)[c]) / 2;
  const double scale = std::sqrt(area / std::abs(mapped));
  if (!(scale > 0) || !std::isfinite(scale))
    return Error{ErrorCode::malformed, "the triangles have no area in the plane"};
  for (Point& p : *map) p = {p.x * scale, p.y * scale, 0};
  return map;
}

Result<std::vector<Point>> spread_inward(std::span<const Point> values, std::size_t vertex_count,
                                         std::span<const Triangle> triangles) {
  if (Status checked = check_corners(vertex_count, triangles); !checked)
    return std::move(checked).error();
  std::set<std::pair<Index, Index>> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.emplace(std::minmax(t[i], t[(i + 1) % 3]));
  }
  std::vector<Point> spread(values.begin(), values.end());
  spread.resize(vertex_count);
  const auto unknowns = static_cast<Eigen::Index>(vertex_count - values.size());
  if (unknowns == 0) return spread;
  Entries entries;
  Columns right = Columns::Zero(unknowns, 3);
  const auto known = static_cast<Index>(values.size());
  const auto add = [&](Index vertex, Index neighbour) {
    if (vertex < known) return;
    const auto row = static_cast<int>(vertex - known);
    entries.emplace_back(row, row, 1);
    if (neighbour < known) {
      const Point& value = values[neighbour];
      right.row(row) += Eigen::RowVector3d(value.x, value.y, value.z);
    } else {
      entries.emplace_back(row, static_cast<int>(neighbour - known), -1);
    }
  };
  for (const auto& [a, b] : edges) {
    add(a, b);
    add(b, a);
  }
  Matrix matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const PositiveSystem system(matrix);
  if (!system.is_positive())
    return Error{ErrorCode::malformed, "a vertex is connected to none with a value"};
  const Columns found = system.solve(right);
  for (Eigen::Index row = 0; row < unknowns; ++row)
    spread[values.size() + static_cast<std::size_t>(row)] = {found(row, 0), found(row, 1),
                                                             found(row, 2)};
  return spread;
}

}  // namespace watertight::spline
