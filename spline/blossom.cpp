// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/blossom.h"

#include <cstddef>

#include "base/assert.h"

namespace watertight::spline {
namespace {

constexpr std::array<double, kMostDegree + 1> kFactorials{1, 1, 2, 6};

}  // namespace

double Polynomial::value(const Point& u) const {
  double sum = 0;
  double power = 1;
  for (const auto& row : c) {
    double inner = 0;
    for (std::size_t b = row.size(); b-- > 0;) inner = inner * u.y + row[b];
    sum += power * inner;
    power *= u.x;
  }
  return sum;
}

double blossom(const Polynomial& polynomial, std::span<const Point> points) {
  const std::size_t degree = points.size();
  WATERTIGHT_ASSERT(degree <= static_cast<std::size_t>(kMostDegree));
  // product[a][b]: the coefficient of s^a t^b in the product of all 1 + s x + t y.
  std::array<std::array<double, kMostDegree + 1>, kMostDegree + 1> product{};
  product[0][0] = 1;
  for (const Point& point : points) {
    for (std::size_t a = degree + 1; a-- > 0;) {
      for (std::size_t b = degree + 1; b-- > 0;) {
        if (a > 0) product[a][b] += product[a - 1][b] * point.x;
        if (b > 0) product[a][b] += product[a][b - 1] * point.y;
      }
    }
  }
  double sum = 0;
  for (std::size_t a = 0; a <= degree; ++a) {
    for (std::size_t b = 0; a + b <= degree; ++b) {
      const double choices =
          kFactorials[degree] / (kFactorials[a] * kFactorials[b] * kFactorials[degree - a - b]);
      sum += polynomial.c[a][b] * product[a][b] / choices;
    }
  }
  return sum;
}

std::vector<double> polynomial_coefficients(const DmsDomain& domain, const Polynomial& polynomial) {
  std::vector<double> coefficients;
  coefficients.reserve(domain.function_count());
  for (Index function = 0; function < domain.function_count(); ++function) {
    coefficients.push_back(blossom(polynomial, domain.blossom_arguments(function)));
  }
  return coefficients;
}

}  // namespace watertight::spline
