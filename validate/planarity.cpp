// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/planarity.h"

#include <cmath>
#include <optional>

#include "geometry/predicates.h"

namespace watertight {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Cyclic Jacobi converges quadratically; 3 x 3 matrices need 5 to 8 sweeps in double precision.
constexpr int kMostSweeps = 30;

__extension__ using Wide = __int128;
/// Products of three differences below this, six of them summed, stay below 2^127.
constexpr double kMostDifference = 1099511627776.0;  // 2^40

/// b - a where that is exact and a small integer on all axes.
std::optional<std::array<std::int64_t, 3>> integer_difference(const Point& a, const Point& b) {
  std::array<std::int64_t, 3> result{};
  for (int axis = 0; axis < 3; ++axis) {
    // Doubles below 2^53 are exact where they are integers, and so are their differences.
    constexpr double kExact = 9007199254740992.0;
    if (!(std::abs(a[axis]) < kExact) || !(std::abs(b[axis]) < kExact)) return std::nullopt;
    if (a[axis] != std::trunc(a[axis]) || b[axis] != std::trunc(b[axis])) return std::nullopt;
    const double difference = b[axis] - a[axis];
    if (!(std::abs(difference) < kMostDifference)) return std::nullopt;
    result[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(difference);
  }
  return result;
}

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

bool are_coplanar(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto u = integer_difference(a, b);
  const auto v = integer_difference(a, c);
  const auto w = integer_difference(a, d);
  if (!u || !v || !w) return orient3d(a, b, c, d) == 0;
  const auto minor = [&](std::size_t i, std::size_t j) {
    return Wide{(*u)[i]} * (*v)[j] - Wide{(*u)[j]} * (*v)[i];
  };
  return minor(1, 2) * (*w)[0] + minor(2, 0) * (*w)[1] + minor(0, 1) * (*w)[2] == 0;
}

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
