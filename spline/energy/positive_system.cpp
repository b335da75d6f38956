// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/energy/positive_system.h"

#include <algorithm>
#include <cmath>

namespace watertight::spline {
namespace {

double one_norm(const Matrix& matrix) {
  double largest = 0;
  for (Eigen::Index column = 0; column < matrix.outerSize(); ++column) {
    double sum = 0;
    for (Matrix::InnerIterator entry(matrix, column); entry; ++entry)
      sum += std::abs(entry.value());
    largest = std::max(largest, sum);
  }
  return largest;
}

/// An estimate of the 1-norm of the inverse from below, mostly exact.
/// Based on: W. W. Hager, Condition estimates, 1984.
double inverse_one_norm(const Eigen::SimplicialLDLT<Matrix>& factors, Eigen::Index size) {
  constexpr int kMostRounds = 5;
  Eigen::VectorXd x = Eigen::VectorXd::Constant(size, 1.0 / static_cast<double>(size));
  double estimate = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::VectorXd y = factors.solve(x);
    estimate = std::max(estimate, y.lpNorm<1>());
    const Eigen::VectorXd signs = y.unaryExpr([](double value) { return value < 0 ? -1.0 : 1.0; });
    const Eigen::VectorXd z = factors.solve(signs);
    Eigen::Index place = 0;
    const double largest = z.cwiseAbs().maxCoeff(&place);
    if (round > 0 && largest <= z.dot(x)) break;
    x = Eigen::VectorXd::Unit(size, place);
  }
  return estimate;
}

}  // namespace

PositiveSystem::PositiveSystem(const Matrix& matrix)
    : scales_(matrix.diagonal().unaryExpr(
          [](double value) { return value > 0 ? std::ldexp(1.0, -std::ilogb(value) / 2) : 1.0; })) {
  const Matrix scaled = scales_.asDiagonal() * matrix * scales_.asDiagonal();
  factors_.compute(scaled);
  is_positive_ = factors_.info() == Eigen::Success && factors_.vectorD().minCoeff() > 0;
  if (is_positive_) condition_ = one_norm(scaled) * inverse_one_norm(factors_, scaled.rows());
}

Columns PositiveSystem::solve(const Columns& right) const {
  const Columns scaled = scales_.asDiagonal() * right;
  return scales_.asDiagonal() * factors_.solve(scaled).eval();
}

}  // namespace watertight::spline
