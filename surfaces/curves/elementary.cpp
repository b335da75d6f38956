// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/curves/elementary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace watertight::surfaces {

namespace {

constexpr double kSmallestPart = 1e-9;    // of a piece
const double kHalfRoot = std::sqrt(0.5);  // the weight of the middle point of a quarter turn

Vector3 unit(const Vector3& a) { return a * (1 / length(a)); }

/// A curve over [0, 1], ..., [n - 1, n].
Curve with_unit_breaks(std::vector<BezierCurve> pieces, bool is_closed) {
  Curve curve;
  for (std::size_t i = 0; i <= pieces.size(); ++i) curve.breaks.push_back(static_cast<double>(i));
  curve.pieces = std::move(pieces);
  curve.is_closed = is_closed;
  return curve;
}

/// The quarter turn from `from` to `to`, which are vectors from the centre.
BezierCurve quarter(const Vector3& centre, const Vector3& from, const Vector3& to) {
  return {{weighted(centre + from, 1), weighted(centre + from + to, kHalfRoot),
           weighted(centre + to, 1)}};
}

}  // namespace

Frame frame_of(const Vector3& origin, const Vector3& axis, const Vector3& reference) {
  Frame frame;
  frame.origin = origin;
  frame.z = unit(axis);
  Vector3 across = reference - frame.z * dot(reference, frame.z);
  if (!(length(across) > 1e-9 * length(reference))) {
    const Vector3 other = std::abs(frame.z[0]) < 0.9 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    across = other - frame.z * dot(other, frame.z);
  }
  frame.x = unit(across);
  frame.y = cross(frame.z, frame.x);
  return frame;
}

Affine affine_of(const Frame& frame) { return {{frame.x, frame.y, frame.z}, frame.origin}; }

Curve polyline(const std::vector<Vector3>& points) {
  std::vector<BezierCurve> pieces;
  for (std::size_t i = 1; i < points.size(); ++i) {
    pieces.push_back({{weighted(points[i - 1], 1), weighted(points[i], 1)}});
  }
  return with_unit_breaks(std::move(pieces), false);
}

Curve ellipse(const Frame& frame, double radius_x, double radius_y) {
  const std::array<Vector3, 4> spokes{frame.x * radius_x, frame.y * radius_y, frame.x * -radius_x,
                                      frame.y * -radius_y};
  std::vector<BezierCurve> pieces;
  for (std::size_t i = 0; i < 4; ++i) {
    pieces.push_back(quarter(frame.origin, spokes[i], spokes[(i + 1) % 4]));
  }
  return with_unit_breaks(std::move(pieces), true);
}

Curve part_of(const Curve& curve, double from, double to) {
  const double period = curve.period();
  const std::size_t count = curve.pieces.size();
  if (curve.is_closed) {
    while (to <= from) to += period;
  }
  Curve part;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    const double turns = period * static_cast<double>(i / count);
    if (i >= count && !curve.is_closed) break;
    const double start = curve.breaks[i % count] + turns;
    const double end = curve.breaks[i % count + 1] + turns;
    const double low = std::max(start, from);
    const double high = std::min(end, to);
    // A rest that rounding leaves beside a break is no piece.
    if (!(high - low > kSmallestPart * (end - start))) continue;
    if (part.breaks.empty()) part.breaks.push_back(low);
    part.pieces.push_back(part_of(curve.pieces[i % count], (low - start) / (end - start),
                                  high == end ? 1 : (high - start) / (end - start)));
    part.breaks.push_back(high);
  }
  return part;
}

Curve reversed(const Curve& curve) {
  Curve result;
  result.is_closed = curve.is_closed;
  for (std::size_t i = curve.breaks.size(); i-- > 0;) result.breaks.push_back(-curve.breaks[i]);
  for (std::size_t i = curve.pieces.size(); i-- > 0;) {
    result.pieces.push_back(curve.pieces[i]);
    std::reverse(result.pieces.back().points.begin(), result.pieces.back().points.end());
  }
  return result;
}

Surface revolved(const Curve& curve, const Frame& frame) {
  Surface surface;
  surface.u_breaks = {0, 1, 2, 3, 4};
  surface.v_breaks = curve.breaks;
  surface.is_closed = {true, curve.is_closed};
  for (const BezierCurve& piece : curve.pieces) {
    for (int turn = 0; turn < 4; ++turn) {
      BezierPatch patch{3, {}};
      for (const WeightedPoint& point : piece.points) {
        const Vector3 place = point.place();
        const Vector3 foot = frame.origin + frame.z * dot(place - frame.origin, frame.z);
        const Vector3 spoke = place - foot;
        const Vector3 across = cross(frame.z, spoke);
        const std::array<Vector3, 4> spokes{spoke, across, spoke * -1, across * -1};
        const auto first = static_cast<std::size_t>(turn);
        BezierCurve arc = quarter(foot, spokes[first], spokes[(first + 1) % 4]);
        for (WeightedPoint& corner : arc.points) {
          patch.points.push_back({corner.moment * point.weight, corner.weight * point.weight});
        }
      }
      surface.patches.push_back(std::move(patch));
    }
  }
  return surface;
}

Surface extruded(const Curve& curve, const Vector3& direction) {
  Surface surface;
  surface.u_breaks = curve.breaks;
  surface.v_breaks = {0, 1};
  surface.is_closed = {curve.is_closed, false};
  surface.is_endless = {false, true};
  for (const BezierCurve& piece : curve.pieces) {
    BezierPatch patch{piece.points.size(), piece.points};
    for (const WeightedPoint& point : piece.points) {
      patch.points.push_back({point.moment + direction * point.weight, point.weight});
    }
    surface.patches.push_back(std::move(patch));
  }
  return surface;
}

Surface cylinder(const Frame& frame, double radius) {
  const Vector3 start = frame.origin + frame.x * radius;
  Surface surface = revolved(polyline({start, start + frame.z * radius}), frame);
  surface.is_endless[1] = true;
  return surface;
}

Surface cone(const Frame& frame, double radius, double slope) {
  const Vector3 tip = frame.origin - frame.z * (radius / slope);
  const double height = radius > 0 ? radius / slope : 1;
  const Vector3 end = tip + frame.z * height + frame.x * (height * slope);
  Surface surface = revolved(polyline({tip, end}), frame);
  surface.is_endless[1] = true;
  return surface;
}

Surface sphere(const Frame& frame, double radius) {
  const Vector3 up = frame.z * radius;
  const Vector3 out = frame.x * radius;
  return revolved(with_unit_breaks(
                      {quarter(frame.origin, up * -1, out), quarter(frame.origin, out, up)}, false),
                  frame);
}

Surface torus(const Frame& frame, double major, double minor) {
  const Frame ring{frame.origin + frame.x * major, frame.x, frame.z, frame.y * -1};
  return revolved(ellipse(ring, minor, minor), frame);
}

double tangent(double angle) {
  // Sine and cosine of an eighth of the angle by their series, doubled three times.
  const double part = angle / 8;
  const double square = part * part;
  double sine = 0;
  double cosine = 0;
  for (int n = 12; n >= 1; --n) {
    sine = square / ((2.0 * n) * (2.0 * n + 1)) * (1 - sine);
    cosine = square / ((2.0 * n - 1) * (2.0 * n)) * (1 - cosine);
  }
  sine = part * (1 - sine);
  cosine = 1 - cosine;
  for (int i = 0; i < 3; ++i) {
    const double doubled = 2 * sine * cosine;
    cosine = (cosine - sine) * (cosine + sine);
    sine = doubled;
  }
  return sine / cosine;
}

}  // namespace watertight::surfaces
