// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/curves/pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace watertight::surfaces {

namespace {

constexpr int kMostNearerSteps = 60;  // of an iteration for a nearest point
constexpr std::size_t kStarts = 8;    // per piece, from which the nearest point is looked for
constexpr double kSamePlace = 1e-9;   // of the size of a patch: control points at one place

struct PieceAt {
  std::size_t piece = 0;
  double t = 0;      // within the piece
  double width = 1;  // of the piece
};

double wrapped(double at, const std::vector<double>& breaks, bool is_closed) {
  if (!is_closed) return at;
  const double period = breaks.back() - breaks.front();
  return at - period * std::floor((at - breaks.front()) / period);
}

PieceAt piece_at(double at, const std::vector<double>& breaks, bool is_closed) {
  const double place = wrapped(at, breaks, is_closed);
  const auto after = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, place);
  const auto piece = static_cast<std::size_t>(after - breaks.begin()) - 1;
  const double width = breaks[piece + 1] - breaks[piece];
  return {piece, (place - breaks[piece]) / width, width};
}

double squared(const Vector3& a) { return dot(a, a); }

}  // namespace

CurvePoint point_at(const Curve& curve, double t) {
  const PieceAt at = piece_at(t, curve.breaks, curve.is_closed);
  CurvePoint point = point_at(curve.pieces[at.piece], at.t);
  point.derivative = point.derivative * (1 / at.width);
  return point;
}

double nearest_parameter(const Curve& curve, const Vector3& place) {
  double best = curve.breaks.front();
  double least = squared(point_at(curve, best).place - place);
  const auto take = [&](double t) {
    const double distance = squared(point_at(curve, t).place - place);
    if (distance >= least) return false;
    least = distance;
    best = t;
    return true;
  };
  for (std::size_t i = 0; i < curve.pieces.size(); ++i) {
    const double width = curve.breaks[i + 1] - curve.breaks[i];
    for (std::size_t k = 1; k <= kStarts; ++k) {
      take(curve.breaks[i] + width * static_cast<double>(k) / static_cast<double>(kStarts));
    }
  }
  for (int step = 0; step < kMostNearerSteps; ++step) {
    const CurvePoint at = point_at(curve, best);
    const double speed = squared(at.derivative);
    if (speed == 0) break;
    double change = dot(at.derivative, place - at.place) / speed;
    bool is_nearer = false;
    for (int halvings = 0; halvings < 30 && !is_nearer; ++halvings, change /= 2) {
      double next = best + change;
      if (!curve.is_closed) next = std::clamp(next, curve.breaks.front(), curve.breaks.back());
      if (next == best) break;
      is_nearer = take(next);
    }
    if (!is_nearer) break;
  }
  return wrapped(best, curve.breaks, curve.is_closed);
}

SurfacePoint point_at(const Surface& surface, const Parameters& at) {
  const PieceAt u = piece_at(at[0], surface.u_breaks, surface.is_closed[0]);
  const PieceAt v = piece_at(at[1], surface.v_breaks, surface.is_closed[1]);
  SurfacePoint point =
      point_at(surface.patches[v.piece * (surface.u_breaks.size() - 1) + u.piece], u.t, v.t);
  point.along_u = point.along_u * (1 / u.width);
  point.along_v = point.along_v * (1 / v.width);
  return point;
}

std::vector<Pole> poles_of(const Surface& surface) {
  std::vector<Pole> poles;
  const std::size_t columns = surface.u_breaks.size() - 1;
  const std::size_t rows = surface.v_breaks.size() - 1;
  double size = 0;
  const Vector3 origin = surface.patches.front().points.front().place();
  for (const BezierPatch& patch : surface.patches) {
    for (const WeightedPoint& point : patch.points) {
      size = std::max(size, length(point.place() - origin));
    }
  }
  const auto add = [&](int direction, bool is_upper) {
    Vector3 place{};
    bool is_first = true;
    const std::size_t count = direction == 0 ? rows : columns;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t column = direction == 1 ? i : is_upper ? columns - 1 : 0;
      const std::size_t row = direction == 0 ? i : is_upper ? rows - 1 : 0;
      const BezierPatch& patch = surface.patches[row * columns + column];
      const std::size_t side = direction == 0 ? patch.rows() : patch.columns;
      for (std::size_t k = 0; k < side; ++k) {
        const std::size_t in_row = direction == 1 ? k : is_upper ? patch.columns - 1 : 0;
        const std::size_t at_row = direction == 0 ? k : is_upper ? patch.rows() - 1 : 0;
        const Vector3 point = patch.points[at_row * patch.columns + in_row].place();
        if (std::exchange(is_first, false)) place = point;
        if (length(point - place) > kSamePlace * size) return;
      }
    }
    const std::vector<double>& breaks = surface.breaks(direction);
    poles.push_back({direction, is_upper ? breaks.back() : breaks.front(), is_upper, place});
  };
  for (const int direction : {0, 1}) {
    if (surface.is_closed[static_cast<std::size_t>(direction)]) continue;
    add(direction, false);
    add(direction, true);
  }
  return poles;
}

Bends::Bends(const Surface& surface) : surface_(surface) {
  const std::size_t columns = surface.u_breaks.size() - 1;
  const std::size_t rows = surface.v_breaks.size() - 1;
  parts_.resize(columns * rows * kParts * kParts);
  const double step = 1 / static_cast<double>(kParts);
  for (std::size_t k = 0; k < rows * kParts; ++k) {
    for (std::size_t i = 0; i < columns * kParts; ++i) {
      const std::size_t column = i / kParts;
      const std::size_t row = k / kParts;
      const double u = static_cast<double>(i % kParts) * step;
      const double v = static_cast<double>(k % kParts) * step;
      const SecondDerivatives own = second_derivatives(
          part_of(surface.patches[row * columns + column], u, u + step, v, v + step));
      const double width = step * (surface.u_breaks[column + 1] - surface.u_breaks[column]);
      const double height = step * (surface.v_breaks[row + 1] - surface.v_breaks[row]);
      parts_[k * columns * kParts + i] = {own.uu / (width * width), own.uv / (width * height),
                                          own.vv / (height * height)};
    }
  }
}

SecondDerivatives Bends::over(const Parameters& low, const Parameters& high) const {
  // The parts that a range meets, as (first, count) around a closed direction.
  const auto parts = [&](int direction) {
    const auto axis = static_cast<std::size_t>(direction);
    const std::vector<double>& breaks = surface_.breaks(direction);
    const bool is_closed = surface_.is_closed[axis];
    const std::size_t all = (breaks.size() - 1) * kParts;
    if (is_closed && high[axis] - low[axis] >= surface_.period(direction)) {
      return std::pair<std::size_t, std::size_t>(0, all);
    }
    const auto part_at = [&](double at) {
      const PieceAt place = piece_at(at, breaks, is_closed);
      const double inside =
          std::clamp(place.t * static_cast<double>(kParts), 0.0, static_cast<double>(kParts) - 0.5);
      return place.piece * kParts + static_cast<std::size_t>(inside);
    };
    const std::size_t first = part_at(low[axis]);
    const std::size_t last = part_at(high[axis]);
    const bool goes_around =
        is_closed && (last < first ||
                      (last == first && high[axis] - low[axis] > surface_.period(direction) / 2));
    return std::pair(first, goes_around ? last + all - first + 1 : last - first + 1);
  };
  const auto [first_u, count_u] = parts(0);
  const auto [first_v, count_v] = parts(1);
  const std::size_t columns = (surface_.u_breaks.size() - 1) * kParts;
  const std::size_t rows = (surface_.v_breaks.size() - 1) * kParts;
  SecondDerivatives most;
  for (std::size_t k = 0; k < std::min(count_v, rows); ++k) {
    for (std::size_t i = 0; i < std::min(count_u, columns); ++i) {
      const SecondDerivatives& own =
          parts_[((first_v + k) % rows) * columns + (first_u + i) % columns];
      most = {std::max(most.uu, own.uu), std::max(most.uv, own.uv), std::max(most.vv, own.vv)};
    }
  }
  return most;
}

Surface transposed(const Surface& surface) {
  Surface result;
  result.u_breaks = surface.v_breaks;
  result.v_breaks = surface.u_breaks;
  result.is_closed = {surface.is_closed[1], surface.is_closed[0]};
  result.is_endless = {surface.is_endless[1], surface.is_endless[0]};
  const std::size_t columns = surface.u_breaks.size() - 1;
  const std::size_t rows = surface.v_breaks.size() - 1;
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t k = 0; k < rows; ++k) {
      const BezierPatch& patch = surface.patches[k * columns + i];
      BezierPatch turned{patch.rows(), {}};
      for (std::size_t a = 0; a < patch.columns; ++a) {
        for (std::size_t b = 0; b < patch.rows(); ++b) {
          turned.points.push_back(patch.points[b * patch.columns + a]);
        }
      }
      result.patches.push_back(std::move(turned));
    }
  }
  return result;
}

namespace {

Vector3 turned(const Affine& affine, const Vector3& a) {
  return affine.columns[0] * a[0] + affine.columns[1] * a[1] + affine.columns[2] * a[2];
}

void move_points(const Affine& affine, std::vector<WeightedPoint>& points) {
  for (WeightedPoint& point : points) {
    point.moment = turned(affine, point.moment) + affine.shift * point.weight;
  }
}

}  // namespace

Vector3 moved(const Affine& affine, const Vector3& place) {
  return turned(affine, place) + affine.shift;
}

Affine composed(const Affine& outer, const Affine& inner) {
  Affine result;
  for (std::size_t i = 0; i < 3; ++i) result.columns[i] = turned(outer, inner.columns[i]);
  result.shift = moved(outer, inner.shift);
  return result;
}

Affine inverse_of_motion(const Affine& motion) {
  Affine inverse;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < 3; ++i) inverse.columns[axis][i] = motion.columns[i][axis];
  }
  inverse.shift = moved(inverse, motion.shift) * -1.0;
  return inverse;
}

bool is_mirror(const Affine& affine) {
  return dot(cross(affine.columns[0], affine.columns[1]), affine.columns[2]) < 0;
}

void move(const Affine& affine, Curve& curve) {
  for (BezierCurve& piece : curve.pieces) move_points(affine, piece.points);
}

void move(const Affine& affine, Surface& surface) {
  for (BezierPatch& patch : surface.patches) move_points(affine, patch.points);
}

}  // namespace watertight::surfaces
