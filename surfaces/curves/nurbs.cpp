// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/curves/nurbs.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace watertight::surfaces {
namespace {

constexpr double kSameEnd = 1e-9;  // of the size: ends at one place

Error malformed(std::string message) {
  return Error{ErrorCode::malformed, std::move(message), {}, {}};
}

Status check_knots(const Knots& knots, std::size_t points) {
  const std::vector<double>& values = knots.values;
  const std::size_t degree = knots.degree;
  if (degree == 0) return malformed("a B-spline of degree 0");
  if (degree > kMostDegree) {
    return Error{ErrorCode::limit_exceeded,
                 "a B-spline of degree " + std::to_string(degree) + "; the limit is " +
                     std::to_string(kMostDegree),
                 {},
                 {}};
  }
  if (points <= degree) {
    return malformed("a B-spline of degree " + std::to_string(degree) + " with " +
                     std::to_string(points) + " control points");
  }
  if (values.size() != points + degree + 1) {
    return malformed("a B-spline of degree " + std::to_string(degree) + " with " +
                     std::to_string(points) + " control points and " +
                     std::to_string(values.size()) + " knots instead of " +
                     std::to_string(points + degree + 1));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return malformed("a knot that is not finite");
    if (i > 0 && values[i] < values[i - 1]) return malformed("knots decrease");
  }
  const double start = values[degree];
  const double end = values[points];
  if (!(start < end)) return malformed("all knots are equal");
  for (std::size_t i = 0; i + degree < values.size(); ++i) {
    const bool is_inner = values[i] > start && values[i] < end;
    if (is_inner && values[i] == values[i + degree]) {
      return malformed("a knot inside occurs more often than the degree");
    }
  }
  return Done{};
}

Status check_points(const std::vector<Vector3>& points, const std::vector<double>& weights) {
  if (weights.size() != points.size()) {
    return malformed(std::to_string(weights.size()) + " weights for " +
                     std::to_string(points.size()) + " control points");
  }
  for (const Vector3& point : points) {
    for (const double x : point) {
      if (!std::isfinite(x)) return malformed("a control point that is not finite");
    }
  }
  for (const double weight : weights) {
    if (!std::isfinite(weight) || weight <= 0) return malformed("a weight that is not positive");
  }
  return Done{};
}

/// The spans of positive length within the domain, by the knot with which they start.
std::vector<std::size_t> spans_of(const Knots& knots) {
  std::vector<std::size_t> spans;
  const std::size_t end = knots.values.size() - knots.degree - 1;
  for (std::size_t k = knots.degree; k < end; ++k) {
    if (knots.values[k] < knots.values[k + 1]) spans.push_back(k);
  }
  return spans;
}

std::vector<double> breaks_of(const Knots& knots, const std::vector<std::size_t>& spans) {
  std::vector<double> breaks;
  for (const std::size_t k : spans) breaks.push_back(knots.values[k]);
  breaks.push_back(knots.values[spans.back() + 1]);
  return breaks;
}

/// The control points of one span: those with `stride` between them, from `first`.
std::vector<WeightedPoint> span_points(const Knots& knots, std::size_t span,
                                       const WeightedPoint* first, std::size_t stride) {
  const std::size_t degree = knots.degree;
  const std::vector<double>& knot = knots.values;
  std::vector<WeightedPoint> result;
  std::vector<WeightedPoint> work(degree + 1);
  for (std::size_t ends = 0; ends <= degree; ++ends) {
    for (std::size_t i = 0; i <= degree; ++i) work[i] = first[(span - degree + i) * stride];
    for (std::size_t round = 1; round <= degree; ++round) {
      // The blossom takes the end of the span `ends` times, and its start otherwise.
      const double argument = round <= ends ? knot[span + 1] : knot[span];
      for (std::size_t i = degree; i >= round; --i) {
        const double low = knot[span - degree + i];
        const double high = knot[span + i + 1 - round];
        work[i] = between(work[i - 1], work[i], (argument - low) / (high - low));
      }
    }
    result.push_back(work[degree]);
  }
  return result;
}

double size_of(const std::vector<Vector3>& points) {
  double size = 0;
  for (const Vector3& p : points) size = std::max(size, length(p - points.front()));
  return size;
}

bool are_one_place(const WeightedPoint& a, const WeightedPoint& b, double size) {
  return length(a.place() - b.place()) <= kSameEnd * size;
}

std::vector<WeightedPoint> weighted_points(const std::vector<Vector3>& points,
                                           const std::vector<double>& weights) {
  std::vector<WeightedPoint> result;
  for (std::size_t i = 0; i < points.size(); ++i) result.push_back(weighted(points[i], weights[i]));
  return result;
}

/// Whether the start and the end of a surface along a direction are one curve.
bool closes(const Surface& surface, int direction, double size) {
  const std::size_t columns = surface.u_breaks.size() - 1;
  const std::size_t rows = surface.v_breaks.size() - 1;
  for (std::size_t i = 0; i < (direction == 0 ? rows : columns); ++i) {
    const BezierPatch& first = surface.patches[direction == 0 ? i * columns : i];
    const BezierPatch& last =
        surface.patches[direction == 0 ? i * columns + columns - 1 : (rows - 1) * columns + i];
    const std::size_t side = direction == 0 ? first.rows() : first.columns;
    for (std::size_t k = 0; k < side; ++k) {
      const std::size_t one = direction == 0 ? k * first.columns : k;
      const std::size_t other = direction == 0 ? k * last.columns + last.columns - 1
                                               : (last.rows() - 1) * last.columns + k;
      if (!are_one_place(first.points[one], last.points[other], size)) return false;
    }
  }
  return true;
}

}  // namespace

Result<Curve> curve_of(const Knots& knots, const std::vector<Vector3>& points,
                       const std::vector<double>& weights) {
  if (Status status = check_knots(knots, points.size()); !status) return status.error();
  if (Status status = check_points(points, weights); !status) return status.error();
  const std::vector<std::size_t> spans = spans_of(knots);
  const std::vector<WeightedPoint> control = weighted_points(points, weights);
  Curve curve;
  curve.breaks = breaks_of(knots, spans);
  for (const std::size_t span : spans) {
    curve.pieces.push_back({span_points(knots, span, control.data(), 1)});
  }
  curve.is_closed = are_one_place(curve.pieces.front().points.front(),
                                  curve.pieces.back().points.back(), size_of(points));
  return curve;
}

Result<Surface> surface_of(const Knots& u, const Knots& v, const std::vector<Vector3>& points,
                           const std::vector<double>& weights) {
  const std::size_t columns = u.values.size() - std::min(u.values.size(), u.degree + 1);
  if (columns == 0 || points.size() % columns != 0) {
    return malformed("a B-spline surface whose control points do not fit its knots");
  }
  if (Status status = check_knots(u, columns); !status) return status.error();
  if (Status status = check_knots(v, points.size() / columns); !status) return status.error();
  if (Status status = check_points(points, weights); !status) return status.error();
  const std::vector<std::size_t> spans_u = spans_of(u);
  const std::vector<std::size_t> spans_v = spans_of(v);
  const std::vector<WeightedPoint> control = weighted_points(points, weights);
  Surface surface;
  surface.u_breaks = breaks_of(u, spans_u);
  surface.v_breaks = breaks_of(v, spans_v);
  for (const std::size_t span_v : spans_v) {
    for (const std::size_t span_u : spans_u) {
      // Along v for each column of the span, then along u for each row.
      std::vector<WeightedPoint> half((u.degree + 1) * (v.degree + 1));
      for (std::size_t i = 0; i <= u.degree; ++i) {
        const auto column =
            span_points(v, span_v, control.data() + (span_u - u.degree + i), columns);
        for (std::size_t k = 0; k <= v.degree; ++k) half[k * (u.degree + 1) + i] = column[k];
      }
      BezierPatch patch{u.degree + 1, {}};
      Knots local = u;
      local.values.assign(u.values.begin() + static_cast<std::ptrdiff_t>(span_u - u.degree),
                          u.values.begin() + static_cast<std::ptrdiff_t>(span_u + u.degree + 2));
      for (std::size_t k = 0; k <= v.degree; ++k) {
        const auto row = span_points(local, u.degree, half.data() + k * (u.degree + 1), 1);
        patch.points.insert(patch.points.end(), row.begin(), row.end());
      }
      surface.patches.push_back(std::move(patch));
    }
  }
  const double size = size_of(points);
  surface.is_closed = {closes(surface, 0, size), closes(surface, 1, size)};
  return surface;
}

}  // namespace watertight::surfaces
