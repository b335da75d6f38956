// SPDX-License-Identifier: GPL-3.0-or-later
//
// Predicts the third vertex of the triangle beyond a gate as a sum of offsets between the vertices
// around the gate, with coefficients that follow the surface. For mode parallelogram.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "codec/entropy/context.h"
#include "codec/entropy/least_squares.h"
#include "codec/mode_parallelogram/front.h"
#include "codec/mode_parallelogram/vectors.h"

namespace watertight::codec::parallelogram {

class TipPrediction {
 public:
  static constexpr std::uint32_t kGuesses = 6;
  static constexpr std::uint32_t kSpanClasses = 16;
  static constexpr std::uint32_t kBendClasses = 64;
  /// The prediction at a gate.
  struct Tip {
    /// First the sum of offsets with the coefficients; then, each alone: the parallelogram beyond
    /// the gate, the one beyond the next gate, the apex mirrored in the gate, the parallelogram of
    /// the triangle of the next gate, and the previous gate prolonged.
    std::array<Vector, kGuesses> guesses{};
    Vector normal{};                  // the normal of the known triangle
    double size = 0;                  // the length of the gate
    Context<kBendClasses> bends{0U};  // how flat the surface is at both ends of the gate
    Context<kSpanClasses> spans{0U};  // how far both corners of the gate are open
  };

  /// Predicts the tip beyond the gate of `corner`. `centres` are the positions of the vertices.
  const Tip& predict(const SurfaceFront& front, const std::vector<Vector>& centres, Index corner);
  const Tip& tip() const { return tip_; }

  /// Returns the shift of the prediction along the axis that is coded last, if the coordinates
  /// coded before leave the plane of the known triangle by `slope`.
  double shift_along(std::size_t axis, double slope);
  /// Learns from the coordinate on that axis, which is `missed` away from the prediction without
  /// shift; `expected` is the expected miss.
  void learn_shift(double missed, double expected);
  /// Learns from the predicted tip, which is at `centre`; `expected` is the expected miss.
  void learn(const Vector& centre, double expected);

 private:
  static constexpr std::size_t kOffsets = 9;
  static constexpr double kMemory =
      0.995;  // the weight that earlier vertices keep after each vertex
  using Predictor = LeastSquares<kOffsets>;

  Tip tip_;
  std::array<Predictor::Features, 3> features_{};  // axis -> the offsets on this axis
  Vector middle_{};                                // the middle of the gate
  double shift_ = 0;                               // the shift to the plane of the known triangle
  double predicted_shift_ = 0;
  std::vector<Predictor> predictors_{kSpanClasses, Predictor{{1, 0, 0, 0, 0, 0, 0, 0, 0}, 3}};
  std::vector<LeastSquares<1>> shift_predictors_{kBendClasses, LeastSquares<1>{{0.5}, 4}};
};

/// Clamps to -9e15 to 9e15; NaN becomes -9e15.
inline double tamed(double x) { return x > -9e15 ? (x < 9e15 ? x : 9e15) : -9e15; }

}  // namespace watertight::codec::parallelogram
