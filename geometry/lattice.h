// SPDX-License-Identifier: GPL-3.0-or-later
//
// The exact grid on which a solid's coordinates live (design section 3). Every decision about a
// solid is made on the lattice coordinates, never on transformed ones; world coordinates are for
// measures, tolerances and output.
//
//   world(axis) = origin(axis) + step(axis) * coordinate(axis)        exactly
//
// Normal form: the origin is the minimum of the feature's box, all three steps are the same power
// of ten (the largest that all coordinates share), and coordinates are non-negative integers. So
// the integers of a CityJSON file and the doubles of the same decimals give equal lattices and
// equal coordinates.
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

namespace watertight {

/// mantissa * radix^exponent, radix 10 (decimal lattices) or 2 (binary ones). Normalized: the
/// mantissa is not divisible by the radix, and zero is {0, 0}.
struct GridNumber {
  std::int64_t mantissa = 0;
  std::int32_t exponent = 0;
  friend auto operator<=>(const GridNumber&, const GridNumber&) = default;
};

/// Parses a decimal number ("-12.50e3") exactly. Errors: malformed (not a number, not finite);
/// limit_exceeded when more than 18 significant digits are needed.
Result<GridNumber> parse_decimal(std::string_view text);

/// The shortest decimal that reads back as `value` (at most 17 digits).
/// Requires a finite value.
GridNumber shortest_decimal(double value);

enum class LatticeKind : std::uint8_t {
  decimal = 0,  // steps and origin are decimals; coordinates are integers in [0, 2^53)
  binary = 1,   // the same with powers of two
  float64 = 2   // no common grid: coordinates are the source's doubles, origin 0, step 1
};

struct Lattice {
  LatticeKind kind = LatticeKind::decimal;
  std::array<GridNumber, 3> step{GridNumber{1, 0}, GridNumber{1, 0}, GridNumber{1, 0}};
  std::array<GridNumber, 3> origin{};
  friend auto operator<=>(const Lattice&, const Lattice&) = default;

  /// The world coordinate as the nearest double. Cost: slow path with exact decimals.
  double world(double coordinate, int axis) const;
  std::array<double, 3> world(const Point& p) const;
  /// The exact decimal, shortest text without exponent ("84616.468"); for float64 lattices the
  /// shortest text that reads back as the double. Source digits are reproduced.
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
};

/// A CityJSON `transform`: exact decimals as written in the document.
struct Transform {
  std::array<GridNumber, 3> scale{GridNumber{1, 0}, GridNumber{1, 0}, GridNumber{1, 0}};
  std::array<GridNumber, 3> translate{};
  friend auto operator<=>(const Transform&, const Transform&) = default;
};

/// Normal form of integer vertices under a transform.
/// Errors: limit_exceeded if the exact coordinates do not fit a lattice.
Result<LatticePoints> lattice_of_integers(std::span<const std::array<std::int64_t, 3>> vertices,
                                          const Transform& transform);

/// Normal form of exact decimals (numbers as text in OBJ, OFF, WKT, untransformed CityJSON).
/// Where no common decimal grid below 2^53 exists, the nearest doubles are taken on a float64
/// lattice and every point that changed is listed in `rounded`.
Result<LatticePoints> lattice_of_decimals(std::span<const std::array<GridNumber, 3>> vertices);

/// Normal form of doubles (WKB): the common decimal grid of their shortest decimals if it fits,
/// else the common binary grid, else float64. Never rounds.
/// Errors: malformed if a value is not finite.
Result<LatticePoints> lattice_of_doubles(std::span<const std::array<double, 3>> vertices);

/// The integers that `points` were under `transform`: the inverse of lattice_of_integers.
/// Errors: malformed if a point is not on the transform's grid.
Result<std::vector<std::array<std::int64_t, 3>>> integers_under(const Lattice& lattice,
                                                               std::span<const Point> points,
                                                               const Transform& transform);

}  // namespace watertight
