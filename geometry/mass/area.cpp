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

/// a * b, exactly, unless a number is too large or too small.
DoublePair exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

/// The double nearest to a number, and the rest of the number, rounded.
DoublePair pair_of(UnsignedWide number) {
  const auto high = static_cast<double>(number);
  return {high, static_cast<double>(static_cast<Wide>(number) - static_cast<Wide>(high))};
}

/// a * b with a relative error of less than 2^-103.
DoublePair product_of(const DoublePair& a, const DoublePair& b) {
  const DoublePair high = exact_product(a.high, b.high);
  return {high.high, high.low + (a.high * b.low + a.low * b.high)};
}

/// a * b - c * d with an error of less than 2^-102 of |a * b| + |c * d|.
DoublePair determinant(const DoublePair& a, const DoublePair& b, const DoublePair& c,
                       const DoublePair& d) {
  const DoublePair first = product_of(a, b);
  const DoublePair second = product_of(c, d);
  const DoublePair high = exact_sum(first.high, -second.high);
  return exact_sum(high.high, high.low + (first.low - second.low));
}

/// a + b of numbers that are not negative, with a relative error of less than 2^-103.
DoublePair sum_of(const DoublePair& a, const DoublePair& b) {
  const DoublePair high = exact_sum(a.high, b.high);
  return exact_sum(high.high, high.low + (a.low + b.low));
}

/// The square of a number with a relative error of less than 2^-103.
DoublePair square_of(const DoublePair& number) {
  const DoublePair square = exact_product(number.high, number.high);
  return exact_sum(square.high, square.low + 2 * number.high * number.low);
}

/// The square root of a number that is not negative, with a relative error of less than 2^-102.
DoublePair root_of(const DoublePair& number) {
  if (number.high <= 0) return {};
  const double root = std::sqrt(number.high);
  const DoublePair square = exact_product(root, root);
  const double rest = (number.high - square.high) + (number.low - square.low);
  return exact_sum(root, rest / (2 * root));
}

/// The steps of a lattice as integers times a common unit, whose square is a quotient.
struct CommonUnit {
  std::array<double, 3> steps{};
  DoublePair numerator{1, 0};
  DoublePair denominator{1, 0};
};

/// radix^exponent, or nothing if it is large.
std::optional<DoublePair> power_of(std::int32_t radix, std::int32_t exponent) {
  constexpr std::int32_t kMostDigits = 38;
  constexpr std::int32_t kMostBits = 200;
  if (exponent > (radix == 2 ? kMostBits : kMostDigits)) return std::nullopt;
  return radix == 2 ? DoublePair{std::ldexp(1.0, exponent), 0} : pair_of(power_of_ten(exponent));
}

/// Nothing if a step would have to be rounded, or the unit is very small or large.
std::optional<CommonUnit> common_unit(const Lattice& lattice) {
  const std::int32_t radix = lattice.kind == LatticeKind::binary ? 2 : 10;
  const std::int32_t exponent =
      std::min({lattice.step[0].exponent, lattice.step[1].exponent, lattice.step[2].exponent});
  CommonUnit unit;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto power = power_of(radix, lattice.step[axis].exponent - exponent);
    constexpr std::int64_t kExactEnd = std::int64_t{1} << 53U;
    if (!power || power->low != 0 || lattice.step[axis].mantissa > kExactEnd) return std::nullopt;
    const auto step = exact_product(static_cast<double>(lattice.step[axis].mantissa), power->high);
    if (step.low != 0) return std::nullopt;
    unit.steps[axis] = step.high;
  }
  const auto square = power_of(radix, 2 * std::abs(exponent));
  if (!square) return std::nullopt;
  (exponent < 0 ? unit.denominator : unit.numerator) = *square;
  return unit;
}

/// Numbers of this size, and zero, have products of four without overflow and lost digits.
bool is_moderate(double number) {
  return number == 0 || (std::abs(number) < 0x1p100 && std::abs(number) > 0x1p-100);
}

using Way = std::array<DoublePair, 3>;

/// The way from one vertex to another in common units, each number with a relative error of less
/// than 2^-104. Nothing if a number is very small or large.
std::optional<Way> way_between(const Point& from, const Point& to, const CommonUnit& unit) {
  Way way{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<int>(axis);
    way[axis] = product_of(exact_sum(to[at], -from[at]), {unit.steps[axis], 0});
    if (!is_moderate(way[axis].high)) return std::nullopt;
  }
  return way;
}

/// A sum with the largest error that it may have.
struct BoundedSum {
  DoublePair sum;
  double error = 0;
};

/// The sum of the lengths of cross products in squared common units.
std::optional<BoundedSum> sum_by_pairs(std::span<const Point> vertices,
                                       std::span<const Triangle> triangles,
                                       const CommonUnit& unit) {
  BoundedSum total;
  double reach = 0;  // the sum of the products of which determinants are made
  for (const auto& [a, b, c] : triangles) {
    const auto u = way_between(vertices[a], vertices[b], unit);
    const auto v = way_between(vertices[a], vertices[c], unit);
    if (!u || !v) return std::nullopt;
    DoublePair square;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t next = (axis + 1) % 3;
      const std::size_t last = (axis + 2) % 3;
      square =
          sum_of(square, square_of(determinant((*u)[next], (*v)[last], (*u)[last], (*v)[next])));
      reach +=
          std::abs((*u)[next].high * (*v)[last].high) + std::abs((*u)[last].high * (*v)[next].high);
    }
    total.sum = sum_of(total.sum, root_of(square));
  }
  // Each root, and each step of the sum, is within 2^-101 of the sum.
  const auto steps = static_cast<double>(triangles.size()) + 4;
  total.error = reach * 0x1p-100 + total.sum.high * steps * 0x1p-100;
  return total;
}

/// The area by pairs of doubles. Nothing if they do not decide the rounding.
std::optional<double> area_by_pairs(const Solid& solid, std::span<const Triangle> triangles) {
  const auto unit = common_unit(solid.lattice());
  if (!unit) return std::nullopt;
  const auto total = sum_by_pairs(solid.vertices(), triangles, *unit);
  if (!total) return std::nullopt;
  // The sum times numerator / denominator: a quotient, and what is left of it.
  const DoublePair scaled = product_of(total->sum, unit->numerator);
  const double quotient = scaled.high / unit->denominator.high;
  const DoublePair back = product_of({quotient, 0}, unit->denominator);
  const double left =
      ((scaled.high - back.high) + (scaled.low - back.low)) / unit->denominator.high;
  const DoublePair twice = exact_sum(quotient, left);
  const double error =
      total->error * (unit->numerator.high / unit->denominator.high) * (1 + 0x1p-40) +
      twice.high * 0x1p-99;
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
