// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/energy/piece_energy.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "spline/plane/triangle_grid.h"

namespace watertight::spline {
namespace {

/// A function's second derivatives on one of the knot triangles that meet a triangle.
struct Term {
  std::size_t function = 0;  // its place among those of the triangle
  std::size_t leaf = 0;      // its place among the leaves
  std::array<double, 3> second{};
};

struct Leaf {
  std::array<Point, 3> corners;
  ConvexPolygon part;  // in the triangle
  Rectangle rectangle;
};

class TriangleEnergy {
 public:
  TriangleEnergy(const DmsDomain& domain, Index triangle)
      : functions_(domain.functions_at(triangle).size()) {
    const Triangle& corners = domain.arrays().triangles[triangle];
    for (std::size_t j = 0; j < 3; ++j) corners_[j] = domain.knot(corners[j], 0);
    std::size_t place = 0;
    for (const Index function : domain.functions_at(triangle)) {
      for (const ConstantPiece& piece : domain.second_derivatives(function)) {
        const std::size_t leaf = leaf_at(piece.leaf, domain.leaf_corners(piece.leaf));
        if (leaf != kNoPart) terms_.push_back({place, leaf, {piece.xx, piece.xy, piece.yy}});
      }
      ++place;
    }
    std::ranges::stable_sort(terms_, {}, &Term::leaf);
  }

  std::vector<double> products() const {
    std::vector<double> matrix(functions_ * functions_);
    std::size_t row_end = 0;
    for (std::size_t row = 0; row < terms_.size(); row = row_end) {
      row_end = end_of_leaf(row);
      std::size_t column_end = 0;
      for (std::size_t column = row; column < terms_.size(); column = column_end) {
        column_end = end_of_leaf(column);
        const double area =
            common_area(leaves_[terms_[row].leaf], leaves_[terms_[column].leaf], row == column);
        if (area == 0) continue;
        for (std::size_t i = row; i < row_end; ++i) {
          for (std::size_t j = column; j < column_end; ++j) add(matrix, i, j, area, row == column);
        }
      }
    }
    return matrix;
  }

  /// First sums up what all functions have on a leaf: most of it cancels, as in the surface itself.
  double energy(std::span<const Point> coefficients) const {
    std::vector<std::array<Point, 3>> sums(leaves_.size());
    for (const Term& term : terms_) {
      const Point& c = coefficients[term.function];
      for (std::size_t k = 0; k < 3; ++k) {
        Point& sum = sums[term.leaf][k];
        sum.x += term.second[k] * c.x;
        sum.y += term.second[k] * c.y;
        sum.z += term.second[k] * c.z;
      }
    }
    double energy = 0;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      for (std::size_t j = i; j < leaves_.size(); ++j) {
        const double area = common_area(leaves_[i], leaves_[j], i == j);
        if (area != 0) energy += (i == j ? 1 : 2) * area * product(sums[i], sums[j]);
      }
    }
    return energy;
  }

 private:
  static double product(const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += (k == 1 ? 2 : 1) * (a[k].x * b[k].x + a[k].y * b[k].y + a[k].z * b[k].z);
    }
    return sum;
  }

  static constexpr std::size_t kNoPart = ~std::size_t{0};

  std::size_t leaf_at(Index number, const std::array<Point, 3>& corners) {
    const auto [entry, is_new] = places_.emplace(number, leaves_.size());
    if (!is_new) return entry->second;
    ConvexPolygon part = part_in_triangle(ConvexPolygon(corners), corners_);
    if (part.empty()) return entry->second = kNoPart;
    const Rectangle rectangle = Rectangle::around(part.corners());
    leaves_.push_back({corners, std::move(part), rectangle});
    return entry->second;
  }

  std::size_t end_of_leaf(std::size_t term) const {
    std::size_t end = term;
    while (end < terms_.size() && terms_[end].leaf == terms_[term].leaf) ++end;
    return end;
  }

  static double common_area(const Leaf& one, const Leaf& other, bool are_same) {
    if (are_same) return area_of(one.part.corners());
    if (!one.rectangle.meets(other.rectangle)) return 0;
    return area_of(part_in_triangle(one.part, other.corners).corners());
  }

  void add(std::vector<double>& matrix, std::size_t i, std::size_t j, double area,
           bool is_same_leaf) const {
    const Term& a = terms_[i];
    const Term& b = terms_[j];
    const double product = area * (a.second[0] * b.second[0] + 2 * a.second[1] * b.second[1] +
                                   a.second[2] * b.second[2]);
    matrix[a.function * functions_ + b.function] += product;
    if (!is_same_leaf) matrix[b.function * functions_ + a.function] += product;
  }

  std::size_t functions_;
  std::array<Point, 3> corners_;
  std::map<Index, std::size_t> places_;  // of leaves
  std::vector<Leaf> leaves_;
  std::vector<Term> terms_;  // by leaves
};

/// Keeps the part left of the line from a to b.
void cut(ConvexPolygon& polygon, const Point& a, const Point& b) {
  std::array<double, 16> sides{};
  double least = 0;
  double largest = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sides[i] = twice_area(a, b, polygon[i]);
    least = std::min(least, sides[i]);
    largest = std::max(largest, sides[i]);
  }
  if (least == 0) return;
  const ConvexPolygon whole = polygon;
  polygon.clear();
  if (largest == 0) return;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const std::size_t after = i + 1 < whole.size() ? i + 1 : 0;
    const Point& point = whole[i];
    const Point& next = whole[after];
    if (sides[i] >= 0) polygon.push_back(point);
    if ((sides[i] > 0 && sides[after] < 0) || (sides[i] < 0 && sides[after] > 0)) {
      const double share = sides[i] / (sides[i] - sides[after]);
      polygon.push_back(
          {point.x + share * (next.x - point.x), point.y + share * (next.y - point.y), 0});
    }
  }
}

}  // namespace

ConvexPolygon part_in_triangle(const ConvexPolygon& polygon, const std::array<Point, 3>& corners) {
  ConvexPolygon part = polygon;
  for (std::size_t j = 0; j < 3 && !part.empty(); ++j) cut(part, corners[j], corners[(j + 1) % 3]);
  return part;
}

double area_of(std::span<const Point> polygon) {
  double doubled = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    doubled += twice_area(polygon[0], polygon[i - 1], polygon[i]);
  return std::max(doubled / 2, 0.0);
}

std::vector<double> energy_products(const DmsDomain& domain, Index triangle) {
  return TriangleEnergy(domain, triangle).products();
}

double triangle_energy(const DmsDomain& domain, Index triangle,
                       std::span<const Point> coefficients) {
  const std::span<const Index> functions = domain.functions_at(triangle);
  std::vector<Point> own;  // less one of them: the same energy, but smaller numbers lose less
  for (const Index function : functions) {
    const Point& c = coefficients[function];
    const Point& origin = coefficients[functions.front()];
    own.push_back({c.x - origin.x, c.y - origin.y, c.z - origin.z});
  }
  return TriangleEnergy(domain, triangle).energy(own);
}

}  // namespace watertight::spline
