// SPDX-License-Identifier: GPL-3.0-or-later
//
// The area of a triangle is half the length of a cross product. Lengths are square roots, so that
// the sum is enclosed between two numbers. When both have the same nearest double, it is that of
// the sum; else the numbers get more digits. First they are pairs of doubles, then integers of any
// length.
#include "geometry/mass/area.h"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/lattice/grid_number.h"
#include "geometry/lattice/rational_lattice.h"
#include "geometry/predicates/exact_quotient.h"

namespace watertight::geometry {
namespace {

/// A number as the sum of two doubles, of which the second is at most half a unit in the last
/// place of the first.
struct DoublePair {
  double high = 0;
  double low = 0;
};

/// a + b, exactly (Knuth 1969).
DoublePair exact_sum(double a, double b) {
  const double sum = a + b;
  const double share = sum - a;
  return {sum, (a - (sum - share)) + (b - share)};
}

/// a * b, exactly, without overflow and underflow.
DoublePair exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

/// The double nearest to a number up to 2^127, and what is left, rounded.
DoublePair pair_of(UnsignedWide number) {
  const auto high = static_cast<double>(number);
  const Wide rest = static_cast<Wide>(number) - static_cast<Wide>(high);
  return {high, static_cast<double>(rest)};
}

/// The square root of a number up to 2^127 with a relative error of less than 2^-102.
DoublePair root_of(UnsignedWide number) {
  if (number == 0) return {};
  const DoublePair exact = pair_of(number);
  const double root = std::sqrt(exact.high);
  const DoublePair square = exact_product(root, root);
  const double rest = (exact.high - square.high) + (exact.low - square.low);
  return exact_sum(root, rest / (2 * root));
}

/// Coordinates below this are integers whose differences are exact doubles.
constexpr double kExactEnd = 4503599627370496.0;  // 2^52
/// Differences below this have cross products below 2^62, with squares that add up to 2^126.
constexpr double kDifferenceEnd = 1073741824.0;  // 2^30

/// The square of the length of the cross product of two edges, in lattice units. Nothing if the
/// coordinates are no integers, or are too large.
std::optional<UnsignedWide> squared_cross_product(const Point& a, const Point& b, const Point& c) {
  std::array<std::int64_t, 3> u{};
  std::array<std::int64_t, 3> v{};
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = a[axis];
    if (!(std::abs(origin) < kExactEnd && std::abs(b[axis]) < kExactEnd &&
          std::abs(c[axis]) < kExactEnd) ||
        origin != std::trunc(origin) || b[axis] != std::trunc(b[axis]) ||
        c[axis] != std::trunc(c[axis])) {
      return std::nullopt;
    }
    const double first = b[axis] - origin;
    const double second = c[axis] - origin;
    if (!(std::abs(first) < kDifferenceEnd && std::abs(second) < kDifferenceEnd)) {
      return std::nullopt;
    }
    u[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(first);
    v[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(second);
  }
  UnsignedWide square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3;
    const std::size_t last = (axis + 2) % 3;
    const Wide component = Wide{u[next] * v[last]} - Wide{u[last] * v[next]};
    square += static_cast<UnsignedWide>(component * component);
  }
  return square;
}

/// The area of a square of the lattice: a quotient of two integers.
struct UnitArea {
  double numerator = 1;
  double denominator = 1;
};

/// Nothing if the steps are not alike or the integers are too large.
std::optional<UnitArea> unit_area(const Lattice& lattice) {
  const GridNumber& step = lattice.step[0];
  for (const GridNumber& other : lattice.step) {
    if (other.mantissa != step.mantissa || other.exponent != step.exponent) return std::nullopt;
  }
  if (lattice.kind != LatticeKind::decimal) return std::nullopt;
  constexpr std::int64_t kMostMantissa = 1 << 26;  // its square is a double
  constexpr std::int32_t kMostDigits = 22;         // 10^22 is a double
  if (step.exponent > 0 || -2 * step.exponent > kMostDigits || step.mantissa >= kMostMantissa) {
    return std::nullopt;
  }
  const auto mantissa = static_cast<double>(step.mantissa);
  return UnitArea{mantissa * mantissa, static_cast<double>(power_of_ten(-2 * step.exponent))};
}

/// The area by pairs of doubles. Nothing if they do not decide the rounding.
std::optional<double> area_by_pairs(const Solid& solid, std::span<const Triangle> triangles) {
  const auto unit = unit_area(solid.lattice());
  if (!unit) return std::nullopt;
  DoublePair sum;
  for (const auto& [a, b, c] : triangles) {
    const auto square =
        squared_cross_product(solid.vertices()[a], solid.vertices()[b], solid.vertices()[c]);
    if (!square) return std::nullopt;
    const DoublePair root = root_of(*square);
    const DoublePair high = exact_sum(sum.high, root.high);
    sum = exact_sum(high.high, high.low + (sum.low + root.low));
  }
  // The sum times numerator / denominator / 2: a quotient, and what is left of it.
  const DoublePair scaled = exact_product(sum.high, unit->numerator);
  const double rest = scaled.low + sum.low * unit->numerator;
  const double quotient = scaled.high / unit->denominator;
  const DoublePair back = exact_product(quotient, unit->denominator);
  const double left = ((scaled.high - back.high) + (rest - back.low)) / unit->denominator;
  const DoublePair twice = exact_sum(quotient, left);
  // Each term and each step of the sum is within 2^-101 of the sum, the quotient within 2^-100.
  const double error = twice.high * (static_cast<double>(triangles.size()) + 4) * 0x1p-100;
  if (twice.high + (twice.low + error) != twice.high ||
      twice.high + (twice.low - error) != twice.high) {
    return std::nullopt;
  }
  return twice.high / 2;
}

/// The square of the length of the cross product of two edges in world units, exactly.
mpq_class exact_square(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
  RationalPoint u;
  RationalPoint v;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    u[axis] = b[axis] - a[axis];
    v[axis] = c[axis] - a[axis];
  }
  mpq_class square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3;
    const std::size_t last = (axis + 2) % 3;
    const mpq_class component = u[next] * v[last] - u[last] * v[next];
    square += component * component;
  }
  return square;
}

/// A sum of square roots, of which those that are rational numbers are added up.
struct RootSum {
  mpq_class rational = 0;
  std::vector<mpq_class> squares;  // of roots that are irrational

  void add(const mpq_class& square) {
    if (mpz_perfect_square_p(square.get_num_mpz_t()) != 0 &&
        mpz_perfect_square_p(square.get_den_mpz_t()) != 0) {
      rational += mpq_class(sqrt(square.get_num()), sqrt(square.get_den()));
    } else {
      squares.push_back(square);
    }
  }
};

/// floor(number * 2^bits) for a number that is not negative.
mpz_class scaled_floor(const mpq_class& number, std::size_t bits) {
  return mpz_class(number.get_num() << bits) / number.get_den();
}

/// Half the sum, rounded once. The loop ends: a sum of irrational roots of positive rational
/// numbers is irrational, so that it is no place where the rounding changes.
double nearest_half(const RootSum& sum) {
  for (std::size_t bits = 160;; bits *= 2) {
    mpz_class low = scaled_floor(sum.rational, bits);
    for (const mpq_class& square : sum.squares) low += sqrt(scaled_floor(square, 2 * bits));
    if (sum.squares.empty()) return nearest(sum.rational / 2);
    const mpz_class high = low + 1 + static_cast<unsigned long>(sum.squares.size());
    const auto exponent = -static_cast<std::int64_t>(bits) - 1;
    const double least = nearest_quotient(low, 1, exponent);
    if (least == nearest_quotient(high, 1, exponent)) return least;
  }
}

double area_by_integers(const Solid& solid, std::span<const Triangle> triangles) {
  const auto at = [&](Index vertex) {
    RationalPoint point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = step_of(solid.lattice(), axis) *
                    mpq_class(solid.vertices()[vertex][static_cast<int>(axis)]);
    }
    return point;
  };
  RootSum sum;
  for (const auto& [a, b, c] : triangles) sum.add(exact_square(at(a), at(b), at(c)));
  return nearest_half(sum);
}

}  // namespace

double area_of(const Solid& solid, std::span<const Triangle> triangles) {
  const auto rounded = area_by_pairs(solid, triangles);
  return rounded ? *rounded : area_by_integers(solid, triangles);
}

}  // namespace watertight::geometry
