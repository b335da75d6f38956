// SPDX-License-Identifier: GPL-3.0-or-later
//
// The exact grid on which a solid's coordinates live (docs/decisions/0002-lattice.md). Every
// decision about a solid is made on the lattice coordinates, never on transformed ones; world
// coordinates are for measures, tolerances and output.
//
//   world(axis) = origin(axis) + step(axis) * coordinate(axis)        exactly
//
// Normal form: the origin is the minimum of the feature's box, all three steps are the same power
// of ten (the largest that divides all distances from the origin), and coordinates are
// non-negative integers. So the integers of a CityJSON file and the doubles of the same decimals
// give equal lattices and equal coordinates. Where the common power of ten would push a coordinate
// to 2^30 or beyond, the steps are the first of the following that keep coordinates below 2^30: a
// power of ten for each axis (degrees beside metres); the greatest common divisor of all distances
// (a CityJSON scale of 0.0003048). If neither does, the steps are the first of the following that
// keep coordinates below 2^53: the common power of ten, a power of ten for each axis, the common
// divisor, a divisor for each axis (scales of 17 digits). The form depends on the values alone. An
// origin with more than 18 digits (integers under a scale of 17 digits have one) is rounded to 18:
// all points move together by less than anybody measures, and the shape of the solid is exact.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "geometry/point.h"

namespace watertight::geometry {

/// The number mantissa * radix^exponent, with radix 10 (decimal lattices) or 2 (binary lattices).
/// It is normalized: the mantissa is not divisible by the radix, and zero is {0, 0}.
struct GridNumber {
  std::int64_t mantissa = 0;
  std::int32_t exponent = 0;
  friend auto operator<=>(const GridNumber&, const GridNumber&) = default;
};

/// Parses a decimal number ("-12.50e3", "+.5", "7.") exactly; no blanks around it. Errors:
/// malformed (not a number, not finite); limit_exceeded when more than 18 significant digits are
/// needed or the exponent is outside the range of doubles. Callers that may round then take
/// shortest_decimal() of the nearest double and report the rounding.
Result<GridNumber> parse_decimal(std::string_view text);

/// The shortest decimal that reads back as `value` (at most 17 digits for a double, 9 for a float).
/// Requires a finite value.
GridNumber shortest_decimal(double value);
GridNumber shortest_decimal(float value);

enum class LatticeKind : std::uint8_t {
  decimal = 0,  // steps and origin are decimals; coordinates are integers in [0, 2^53)
  binary = 1,   // the step of all axes is a power of two; coordinates are integers in [0, 2^53)
  float64 = 2   // no common grid: coordinates are the source's doubles, origin 0, step 1
};

struct Lattice {
  LatticeKind kind = LatticeKind::decimal;
  std::array<GridNumber, 3> step{GridNumber{1, 0}, GridNumber{1, 0}, GridNumber{1, 0}};
  std::array<GridNumber, 3> origin{};
  friend auto operator<=>(const Lattice&, const Lattice&) = default;

  /// True if the steps are positive, the exponents are those of doubles (1200 at most) and, for
  /// float64, the origin is 0 and the step is 1. The lattice of every Solid is sane; a decoder must
  /// check the lattice that it reads.
  bool is_sane() const;

  /// The world coordinate as the nearest double (ties to even). The lattice coordinate need not be
  /// an integer: Steiner points and witnesses have others. Requires is_sane(). Cost: constant; a
  /// microsecond or more where 128-bit integers do not suffice.
  double world(double coordinate, int axis) const;
  std::array<double, 3> world(const Point& p) const;
  /// The exact world coordinate as the shortest decimal text without exponent ("84616.468"); for
  /// float64 and binary lattices, and for coordinates that are not integers, the shortest text that
  /// reads back as world(). Reproduces the digits of the source. Requires is_sane().
  std::string world_text(double coordinate, int axis) const;
  /// The step as the nearest double: world units per lattice unit.
  double scale(int axis) const;
};

/// Points on one lattice in normal form, in source order.
struct LatticePoints {
  Lattice lattice;
  std::vector<Point> points;
  /// Indices of points whose source digits did not fit and were rounded (finding 'coordinates
  /// rounded'); empty for nearly every source.
  std::vector<Index> rounded;
  /// True if the origin needs more than 18 digits and was rounded: all points are moved together by
  /// at most half a unit of the 18th digit, and the shape is exact.
  bool is_origin_rounded = false;
};

/// A CityJSON `transform`: exact decimals as written in the document.
struct Transform {
  std::array<GridNumber, 3> scale{GridNumber{1, 0}, GridNumber{1, 0}, GridNumber{1, 0}};
  std::array<GridNumber, 3> translate{};
  friend auto operator<=>(const Transform&, const Transform&) = default;
};

/// Normal form of integer vertices under a transform. Where the exact origin needs more digits than
/// a grid number has (scales of 17 digits), the origin is rounded to 18 and the coordinates are
/// exact; only where the rounded origin is half a scale or more from the exact one (integers beyond
/// 10^17), the points are the nearest doubles and all of them are in `rounded`.
/// Errors: malformed if a scale is not positive; limit_exceeded if the vertices spread over more
/// than 2^53 steps or exceed the range of doubles. Cost: linear.
Result<LatticePoints> lattice_of_integers(std::span<const std::array<std::int64_t, 3>> vertices,
                                          const Transform& transform);

/// Normal form of exact decimals (numbers as text in OBJ, OFF, WKT, untransformed CityJSON).
/// Where no decimal grid has coordinates below 2^53, the lattice is that of the nearest doubles,
/// and `rounded` lists every point of which a decimal differs from the shortest decimal of its
/// double. Errors: limit_exceeded if a coordinate exceeds the range of doubles. Cost: linear.
Result<LatticePoints> lattice_of_decimals(std::span<const std::array<GridNumber, 3>> vertices);

/// Normal form of doubles (WKB): the common decimal grid of their shortest decimals if it fits,
/// else the common binary grid, else float64. Never rounds.
/// Errors: malformed if a value is not finite.
Result<LatticePoints> lattice_of_doubles(std::span<const std::array<double, 3>> vertices);

/// The integers that `points` are under `transform`: the inverse of lattice_of_integers. An origin
/// that lattice_of_integers rounded stands for the integer from which it was made. On binary and
/// float64 lattices a coordinate stands for its shortest decimal. Errors: malformed if a point is
/// not on the transform's grid.
Result<std::vector<std::array<std::int64_t, 3>>> integers_under(const Lattice& lattice,
                                                                std::span<const Point> points,
                                                                const Transform& transform);

}  // namespace watertight::geometry

namespace watertight {

using geometry::GridNumber;
using geometry::Lattice;
using geometry::LatticeKind;

}  // namespace watertight
