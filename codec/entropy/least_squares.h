// SPDX-License-Identifier: GPL-3.0-or-later
//
// A linear prediction whose coefficients follow the data: recursive sums of the normal equations,
// solved anew every few samples. Computes with doubles in a fixed order, so that every machine gets
// the same.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace watertight::codec {

template <std::size_t Size>
class LeastSquares {
 public:
  using Features = std::array<double, Size>;

  /// Starts from `coefficients`, which count as much as `confidence` samples of feature size 1.
  LeastSquares(const Features& coefficients, double confidence) : coefficients_(coefficients) {
    for (std::size_t i = 0; i < Size; ++i) {
      products_[i][i] = confidence;
      targets_[i] = confidence * coefficients[i];
    }
  }

  double predict(const Features& features) const {
    double sum = 0;
    for (std::size_t i = 0; i < Size; ++i) sum += coefficients_[i] * features[i];
    return sum;
  }

  void learn(const Features& features, double target, double weight) {
    for (std::size_t i = 0; i < Size; ++i) {
      const double weighted = weight * features[i];
      for (std::size_t j = 0; j <= i; ++j) products_[i][j] += weighted * features[j];
      targets_[i] += weighted * target;
    }
  }
  /// Solves for the coefficients, then multiplies the weight of all samples so far by `memory`.
  void solve(double memory) {
    std::array<Features, Size> lower{};  // the lower factor of the Cholesky decomposition
    for (std::size_t i = 0; i < Size; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = products_[i][j];
        if (i == j) sum += 1e-6 * products_[i][i] + 1e-12;
        for (std::size_t k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
        if (i == j) {
          if (!(sum > 0)) return;
          lower[i][i] = std::sqrt(sum);
        } else {
          lower[i][j] = sum / lower[j][j];
        }
      }
    }
    Features x{};
    for (std::size_t i = 0; i < Size; ++i) {
      double sum = targets_[i];
      for (std::size_t k = 0; k < i; ++k) sum -= lower[i][k] * x[k];
      x[i] = sum / lower[i][i];
    }
    for (std::size_t i = Size; i-- > 0;) {
      double sum = x[i];
      for (std::size_t k = i + 1; k < Size; ++k) sum -= lower[k][i] * x[k];
      x[i] = sum / lower[i][i];
    }
    coefficients_ = x;
    for (std::size_t i = 0; i < Size; ++i) {
      for (std::size_t j = 0; j <= i; ++j) products_[i][j] *= memory;
      targets_[i] *= memory;
    }
  }

 private:
  Features coefficients_;
  std::array<Features, Size> products_{};  // weighted sums of products of features; lower triangle
                                           // only
  Features targets_{};
};

}  // namespace watertight::codec
