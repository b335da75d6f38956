// SPDX-License-Identifier: GPL-3.0-or-later
//
// Plane geometry for predictions in mode `polygon`: whole numbers, or IEEE + - * / sqrt in a fixed
// order, so that every machine predicts the same. For the mode only.
#pragma once

#include <array>
#include <cstdint>

#include "codec/page/integer_solid.h"

namespace watertight::codec::polygon {

/// A vector of the xy plane in grid steps.
struct Flat {
  double x = 0;
  double y = 0;
};
inline Flat operator-(Flat a, Flat b) { return {a.x - b.x, a.y - b.y}; }
inline double dot(Flat a, Flat b) { return a.x * b.x + a.y * b.y; }
inline double cross(Flat a, Flat b) { return a.x * b.y - a.y * b.x; }

/// The nearest whole number; halves upward. Magnitudes from 2^62 on become 0: no prediction.
inline std::int64_t to_whole(double value) {
  constexpr double limit = 4611686018427387904.0;  // 2^62
  if (!(value > -limit && value < limit)) return 0;
  const double shifted = value + 0.5;
  auto whole = static_cast<std::int64_t>(shifted);
  if (static_cast<double>(whole) > shifted) --whole;
  return whole;
}

using GridColumn = std::array<std::int64_t, 2>;

/// A rotation of the integer plane that is one to one: quarter turns, then three shears with
/// rounding. It is within about one step of the true rotation.
class Turn {
 public:
  /// Turns `direction` to the first axis. The zero vector gives the identity.
  explicit Turn(Flat direction);
  GridColumn forward(GridColumn offset) const;
  GridColumn back(GridColumn turned) const;

 private:
  int quarters_ = 0;
  double shear_ = 0;  // -tan of half the angle
  double lift_ = 0;   // sine of the angle
};

inline GridColumn Turn::forward(GridColumn offset) const {
  std::int64_t x = offset[0];
  std::int64_t y = offset[1];
  for (int i = 0; i < quarters_; ++i) {
    const std::int64_t old = x;
    x = y;
    y = -old;
  }
  x += to_whole(shear_ * static_cast<double>(y));
  y += to_whole(lift_ * static_cast<double>(x));
  x += to_whole(shear_ * static_cast<double>(y));
  return {x, y};
}

/// The plane of three points: normal . (point - origin) = 0.
struct FacetPlane {
  enum class Kind : std::uint8_t { unknown, level, steep, wall };
  std::array<Index, 3> points{kNone, kNone, kNone};  // the vertices that span the plane, kNone if
                                                     // not known
  int count = 0;
  std::array<double, 3> normal{};
  double area = 0;  // squared length of the normal
  Kind kind = Kind::unknown;
  GridPoint origin{};

  /// Adds a vertex to `points`, or puts it in the place of one of them if that makes their triangle
  /// larger.
  void add(Index vertex, const std::vector<GridPoint>& points_of);
  /// The height of the plane in a column, or the height of `origin` if that height is 2^53 or more
  /// in magnitude. Requires that the plane is level or steep.
  std::int64_t height(GridColumn column) const;
  /// The uncertainty of height() in a column: 16 times the squared distance from the origin,
  /// divided by twice the area of the triangle of `points` seen from above. Requires that the plane
  /// is level or steep.
  double reach(GridColumn column) const;
};

}  // namespace watertight::codec::polygon
