// SPDX-License-Identifier: GPL-3.0-or-later
//
// Curves and surfaces of rational Bezier pieces: every kind of curve and surface that a file names
// becomes one of these (nurbs.h, elementary.h).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "surfaces/curves/bezier.h"

namespace watertight::surfaces {

/// Breaks are ascending; piece i reaches from break i to break i + 1.
struct Curve {
  std::vector<double> breaks;
  std::vector<BezierCurve> pieces;
  bool is_closed = false;  // the end is the start, and parameters count modulo period()
  double period() const { return is_closed ? breaks.back() - breaks.front() : 0; }
};
CurvePoint point_at(const Curve& curve, double t);

/// The parameter of the point of a curve that is nearest to a place.
double nearest_parameter(const Curve& curve, const Vector3& place);

/// Coordinates (u, v) on a surface.
using Parameters = std::array<double, 2>;

/// Patch (i, k) is patches[k * (u_breaks.size() - 1) + i].
struct Surface {
  std::vector<double> u_breaks;
  std::vector<double> v_breaks;
  std::vector<BezierPatch> patches;
  std::array<bool, 2> is_closed{};   // along u, along v: as Curve::is_closed
  std::array<bool, 2> is_endless{};  // lines along u or v: they go on beyond their ends
  const std::vector<double>& breaks(int direction) const {
    return direction == 0 ? u_breaks : v_breaks;
  }
  double period(int direction) const {
    const auto axis = static_cast<std::size_t>(direction);
    return is_closed[axis] ? breaks(direction).back() - breaks(direction).front() : 0;
  }
};
SurfacePoint point_at(const Surface& surface, const Parameters& at);

/// A side of a surface that is one point: the sides u = `at` (direction 0) or v = `at` (1).
struct Pole {
  int direction = 1;
  double at = 0;
  bool is_upper = false;  // the end of the surface, not its start
  Vector3 place{};
};
std::vector<Pole> poles_of(const Surface& surface);

/// Bounds of the second derivatives over the rectangle from `low` to `high`, which may reach beyond
/// the ends.
class Bends {
 public:
  explicit Bends(const Surface& surface);
  SecondDerivatives over(const Parameters& low, const Parameters& high) const;

 private:
  static constexpr std::size_t kParts = 4;  // of a patch along u and v, each with its own bounds

  const Surface& surface_;
  std::vector<SecondDerivatives> parts_;  // as a table, along u first
};

/// S(u, v) becomes S(v, u), with the other side up.
Surface transposed(const Surface& surface);

/// x becomes columns * x + shift.
struct Affine {
  std::array<Vector3, 3> columns{Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  Vector3 shift{};
};
Vector3 moved(const Affine& affine, const Vector3& place);
/// First `inner`, then `outer`.
Affine composed(const Affine& outer, const Affine& inner);
/// The inverse of a map whose columns are unit vectors across each other.
Affine inverse_of_motion(const Affine& motion);
bool is_mirror(const Affine& affine);
void move(const Affine& affine, Curve& curve);
void move(const Affine& affine, Surface& surface);

}  // namespace watertight::surfaces
