// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/curves/bezier.h"

#include <algorithm>
#include <cmath>
#include <memory_resource>
#include <utility>

#include "base/work_memory.h"

namespace watertight::surfaces {

WeightedPoint weighted(const Vector3& place, double weight) { return {place * weight, weight}; }

namespace {

WeightedPoint minus(const WeightedPoint& a, const WeightedPoint& b) {
  return {a.moment - b.moment, a.weight - b.weight};
}

/// The derivative of moment / weight, from the derivatives of both.
Vector3 quotient_derivative(const WeightedPoint& value, const Vector3& place,
                            const WeightedPoint& change) {
  return (change.moment - place * change.weight) * (1 / value.weight);
}

/// Replaces control points by those of the part over [0, t], or [t, 1]. `stride` separates them.
void cut(WeightedPoint* first, std::size_t count, std::size_t stride, double t, bool keeps_start) {
  for (std::size_t level = 1; level < count; ++level) {
    if (keeps_start) {
      for (std::size_t i = count - 1; i >= level; --i) {
        first[i * stride] = between(first[(i - 1) * stride], first[i * stride], t);
      }
    } else {
      for (std::size_t i = 0; i + level < count; ++i) {
        first[i * stride] = between(first[i * stride], first[(i + 1) * stride], t);
      }
    }
  }
}

void cut_to(WeightedPoint* first, std::size_t count, std::size_t stride, double from, double to) {
  if (to != 1) cut(first, count, stride, to, true);
  if (from != 0) cut(first, count, stride, from / to, false);
}

/// The largest length and weight of differences of control points.
struct Largest {
  double moment = 0;
  double weight = 0;
  void include(const WeightedPoint& point, double factor) {
    moment = std::max(moment, factor * length(point.moment));
    weight = std::max(weight, factor * std::abs(point.weight));
  }
};

}  // namespace

CurvePoint point_at(const BezierCurve& curve, double t) {
  WorkMemory memory;
  std::pmr::vector<WeightedPoint> points(curve.points.begin(), curve.points.end(), memory.get());
  std::size_t count = points.size();
  if (count == 1) return {points[0].place(), {}};
  for (; count > 2; --count) {
    for (std::size_t i = 0; i + 1 < count; ++i) points[i] = between(points[i], points[i + 1], t);
  }
  const WeightedPoint value = between(points[0], points[1], t);
  const Vector3 place = value.place();
  const auto degree = static_cast<double>(curve.degree());
  const Vector3 derivative = quotient_derivative(value, place, minus(points[1], points[0]));
  return {place, derivative * degree};
}

BezierCurve part_of(const BezierCurve& curve, double from, double to) {
  BezierCurve part = curve;
  cut_to(part.points.data(), part.points.size(), 1, from, to);
  return part;
}

double chord_error_bound(const BezierCurve& curve) {
  const std::size_t degree = curve.degree();
  if (degree < 2) return 0;
  const Vector3 start = curve.points.front().place();
  const Vector3 chord = curve.points.back().place() - start;
  const double squared = dot(chord, chord);
  double farthest = 0;
  double heaviest = 0;
  for (std::size_t i = 1; i < degree; ++i) {
    const Vector3 offset = curve.points[i].place() - start;
    const double along = squared > 0 ? std::clamp(dot(offset, chord) / squared, 0.0, 1.0) : 0.0;
    farthest = std::max(farthest, length(offset - chord * along));
    heaviest = std::max(heaviest, curve.points[i].weight);
  }
  // Of the Bernstein polynomials, the inner ones together are at most 1 - 2^(1 - degree).
  const double inner = 1 - std::ldexp(1.0, 1 - static_cast<int>(degree));
  const double end = std::min(curve.points.front().weight, curve.points.back().weight);
  return farthest * (heaviest * inner) / (heaviest * inner + end * (1 - inner));
}

SurfacePoint point_at(const BezierPatch& patch, double u, double v) {
  const std::size_t columns = patch.columns;
  const std::size_t rows = patch.rows();
  // Along u first: for each row the value and its change.
  WorkMemory memory;
  std::pmr::vector<WeightedPoint> values(rows, memory.get());
  std::pmr::vector<WeightedPoint> changes(rows, memory.get());
  std::pmr::vector<WeightedPoint> work(columns, memory.get());
  for (std::size_t k = 0; k < rows; ++k) {
    std::copy_n(patch.points.begin() + static_cast<std::ptrdiff_t>(k * columns), columns,
                work.begin());
    for (std::size_t count = columns; count > 2; --count) {
      for (std::size_t i = 0; i + 1 < count; ++i) work[i] = between(work[i], work[i + 1], u);
    }
    values[k] = columns > 1 ? between(work[0], work[1], u) : work[0];
    changes[k] = columns > 1 ? minus(work[1], work[0]) : WeightedPoint{{}, 0};
  }
  for (std::size_t count = rows; count > 2; --count) {
    for (std::size_t k = 0; k + 1 < count; ++k) {
      values[k] = between(values[k], values[k + 1], v);
      changes[k] = between(changes[k], changes[k + 1], v);
    }
  }
  const WeightedPoint value = rows > 1 ? between(values[0], values[1], v) : values[0];
  const WeightedPoint by_u = rows > 1 ? between(changes[0], changes[1], v) : changes[0];
  const WeightedPoint by_v = rows > 1 ? minus(values[1], values[0]) : WeightedPoint{{}, 0};
  const Vector3 place = value.place();
  return {place, quotient_derivative(value, place, by_u) * static_cast<double>(columns - 1),
          quotient_derivative(value, place, by_v) * static_cast<double>(rows - 1)};
}

SecondDerivatives second_derivatives(const BezierPatch& patch) {
  // Places count from a control point, so that weights matter little (S = A / w, |S''| <=
  // (|A''| + 2 |w'| |S'| + |w''| |S|) / w).
  const std::size_t columns = patch.columns;
  const std::size_t rows = patch.rows();
  const Vector3 middle = patch.points[(rows / 2) * columns + columns / 2].place();
  std::vector<WeightedPoint> points = patch.points;
  double reach = 0;
  double lightest = points.front().weight;
  for (WeightedPoint& point : points) {
    point.moment = point.moment - middle * point.weight;
    reach = std::max(reach, length(point.place()));
    lightest = std::min(lightest, point.weight);
  }
  const auto at = [&](std::size_t i, std::size_t k) { return points[k * columns + i]; };
  const double p = static_cast<double>(columns) - 1;
  const double q = static_cast<double>(rows) - 1;
  Largest u;
  Largest v;
  Largest uu;
  Largest uv;
  Largest vv;
  for (std::size_t k = 0; k < rows; ++k) {
    for (std::size_t i = 0; i < columns; ++i) {
      const bool has_u = i + 1 < columns;
      const bool has_v = k + 1 < rows;
      if (has_u) u.include(minus(at(i + 1, k), at(i, k)), p);
      if (has_v) v.include(minus(at(i, k + 1), at(i, k)), q);
      if (i + 2 < columns) {
        uu.include(minus(minus(at(i + 2, k), at(i + 1, k)), minus(at(i + 1, k), at(i, k))),
                   p * (p - 1));
      }
      if (k + 2 < rows) {
        vv.include(minus(minus(at(i, k + 2), at(i, k + 1)), minus(at(i, k + 1), at(i, k))),
                   q * (q - 1));
      }
      if (has_u && has_v) {
        uv.include(minus(minus(at(i + 1, k + 1), at(i, k + 1)), minus(at(i + 1, k), at(i, k))),
                   p * q);
      }
    }
  }
  const double along_u = (u.moment + u.weight * reach) / lightest;
  const double along_v = (v.moment + v.weight * reach) / lightest;
  return {(uu.moment + 2 * u.weight * along_u + uu.weight * reach) / lightest,
          (uv.moment + u.weight * along_v + v.weight * along_u + uv.weight * reach) / lightest,
          (vv.moment + 2 * v.weight * along_v + vv.weight * reach) / lightest};
}

BezierPatch part_of(const BezierPatch& patch, double from_u, double to_u, double from_v,
                    double to_v) {
  BezierPatch part = patch;
  const std::size_t columns = part.columns;
  for (std::size_t k = 0; k < part.rows(); ++k) {
    cut_to(part.points.data() + k * columns, columns, 1, from_u, to_u);
  }
  for (std::size_t i = 0; i < columns; ++i) {
    cut_to(part.points.data() + i, part.rows(), columns, from_v, to_v);
  }
  return part;
}

}  // namespace watertight::surfaces
