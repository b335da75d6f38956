// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sparse systems with a positive definite matrix. Internal to spline/.
#pragma once

#include <Eigen/SparseCholesky>

namespace watertight::spline {

using Matrix = Eigen::SparseMatrix<double>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// The factors of a matrix whose rows and columns are first multiplied by powers of two that bring
/// its diagonal near 1: functions whose knots are close together have much larger second
/// derivatives than others.
class PositiveSystem {
 public:
  explicit PositiveSystem(const Matrix& matrix);

  bool is_positive() const { return is_positive_; }

  /// An estimate of the condition of the scaled matrix in the 1-norm. Requires is_positive().
  double condition() const { return condition_; }

  Columns solve(const Columns& right) const;

 private:
  Eigen::VectorXd scales_;
  Eigen::SimplicialLDLT<Matrix> factors_;
  bool is_positive_ = false;
  double condition_ = 0;
};

}  // namespace watertight::spline
