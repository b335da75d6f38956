// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/planarity.h"

#include <cmath>

namespace watertight {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Cyclic Jacobi converges quadratically; 3 x 3 matrices need 5 to 8 sweeps in double precision.
constexpr int kMostSweeps = 30;

Vector mean_of(std::span<const Vector> points) {
  Vector sum{};
  for (const Vector& p : points) {
    for (std::size_t i = 0; i < 3; ++i) sum[i] += p[i];
  }
  for (double& component : sum) component /= static_cast<double>(points.size());
  return sum;
}

Matrix covariance(std::span<const Vector> points, const Vector& mean) {
  Matrix m{};
  for (const Vector& p : points) {
    const Vector d{p[0] - mean[0], p[1] - mean[1], p[2] - mean[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) m[i][j] += d[i] * d[j];
    }
  }
  return m;
}

/// One Jacobi rotation that zeroes m[p][q].
void rotate(Matrix& m, Matrix& vectors, std::size_t p, std::size_t q) {
  if (m[p][q] == 0) return;
  const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double t = (theta >= 0 ? 1.0 : -1.0) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  for (std::size_t k = 0; k < 3; ++k) {
    const double kp = m[k][p];
    const double kq = m[k][q];
    m[k][p] = c * kp - s * kq;
    m[k][q] = s * kp + c * kq;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double pk = m[p][k];
    const double qk = m[q][k];
    m[p][k] = c * pk - s * qk;
    m[q][k] = s * pk + c * qk;
    const double vp = vectors[k][p];
    const double vq = vectors[k][q];
    vectors[k][p] = c * vp - s * vq;
    vectors[k][q] = s * vp + c * vq;
  }
}

Vector smallest_eigenvector(Matrix m) {
  Matrix vectors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    if (m[0][1] == 0 && m[0][2] == 0 && m[1][2] == 0) break;
    rotate(m, vectors, 0, 1);
    rotate(m, vectors, 0, 2);
    rotate(m, vectors, 1, 2);
  }
  std::size_t smallest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (m[i][i] < m[smallest][smallest]) smallest = i;
  }
  return unit({vectors[0][smallest], vectors[1][smallest], vectors[2][smallest]});
}

}  // namespace

Vector unit(const Vector& v) {
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0)) return {};
  return {v[0] / length, v[1] / length, v[2] / length};
}

PlaneDistance distance_to_plane(std::span<const Vector> points, const Vector& normal) {
  PlaneDistance result;
  if (points.empty()) return result;
  const Vector mean = mean_of(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector d{points[i][0] - mean[0], points[i][1] - mean[1], points[i][2] - mean[2]};
    const double distance = std::fabs(dot(d, normal));
    if (distance > result.metres) result = {distance, i};
  }
  return result;
}

PlaneDistance distance_to_fitted_plane(std::span<const Vector> points) {
  if (points.size() < 4) return {};
  return distance_to_plane(points, smallest_eigenvector(covariance(points, mean_of(points))));
}

}  // namespace watertight
