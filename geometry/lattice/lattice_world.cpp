// SPDX-License-Identifier: GPL-3.0-or-later
//
// From lattice coordinates to world coordinates, to the source's digits and to a transform's
// integers. The arithmetic is in 128 bits; where it overflows, in integers of any length.
#include <charconv>
#include <cmath>
#include <limits>

#include "base/assert.h"
#include "geometry/lattice/big_decimal.h"
#include "geometry/lattice/grid_number.h"
#include "geometry/lattice/lattice.h"

namespace watertight::geometry {
namespace {

constexpr double kExactEnd = 9007199254740992.0;  // 2^53

double big_nearest_double(const BigDecimal& decimal) {
  if (decimal.mantissa == 0) return 0.0;
  const std::string digits = decimal.mantissa.get_str();
  const std::string text = digits + "e" + std::to_string(decimal.exponent);
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc::result_out_of_range) return value + 0.0;
  const bool is_large = static_cast<std::int64_t>(digits.size()) + decimal.exponent > 0;
  if (!is_large) return 0.0;
  const double infinity = std::numeric_limits<double>::infinity();
  return decimal.mantissa < 0 ? -infinity : infinity;
}

/// The world coordinate, origin + step * coordinate, exactly.
BigDecimal exact_world(const Lattice& lattice, double coordinate, std::size_t axis) {
  return big_sum(from_grid(lattice.origin[axis], lattice.kind),
                 big_product(from_grid(lattice.step[axis], lattice.kind), from_double(coordinate)));
}

bool is_small_integer(double coordinate) {
  return std::abs(coordinate) <= kExactEnd && coordinate == std::trunc(coordinate);
}

/// The exact world coordinate in 128 bits, if the coordinate is an integer and nothing overflows.
std::optional<WideNumber> wide_world(const Lattice& lattice, double coordinate, std::size_t axis) {
  if (!is_small_integer(coordinate)) return std::nullopt;
  const GridNumber& step = lattice.step[axis];
  const GridNumber& origin = lattice.origin[axis];
  // The product fits: the step's mantissa is below 2^63, the coordinate 2^53 at most.
  const Wide moved = Wide{step.mantissa} * static_cast<std::int64_t>(coordinate);
  return wide_sum({moved, step.exponent}, {origin.mantissa, origin.exponent},
                  lattice.kind == LatticeKind::binary ? 2 : 10);
}

std::string shortest_text(double value) {
  if (!std::isfinite(value)) return std::string(value < 0 ? "-inf" : "inf");
  const GridNumber decimal = shortest_decimal(value);
  return plain_decimal(std::to_string(decimal.mantissa), decimal.exponent);
}

bool is_sane(const GridNumber& number) {
  return std::abs(std::int64_t{number.exponent}) <= kLargestExponent &&
         number.mantissa != std::numeric_limits<std::int64_t>::min();
}

/// The exact decimal scale * integer + translate.
BigDecimal place_of(const GridNumber& scale, std::int64_t integer, const GridNumber& translate) {
  return big_sum(big_product(from_grid(scale, LatticeKind::decimal), {big(integer), 0}),
                 from_grid(translate, LatticeKind::decimal));
}

/// The nearest decimal of 18 digits; halves are rounded away from zero.
GridNumber rounded_to_digits(const BigDecimal& exact) {
  constexpr std::size_t kRoundedDigits = 18;
  const BigInteger magnitude = abs(exact.mantissa);
  const std::size_t digits = magnitude.get_str().size();
  const auto dropped =
      static_cast<std::int64_t>(digits > kRoundedDigits ? digits - kRoundedDigits : 0);
  const BigInteger unit = big_power(10, dropped);
  const BigInteger kept = (2 * magnitude + unit) / (2 * unit);
  const WideNumber number{exact.mantissa < 0 ? -Wide{kept.get_si()} : Wide{kept.get_si()},
                          static_cast<std::int32_t>(exact.exponent + dropped)};
  return normalized(number, 10).value_or(GridNumber{});
}

/// The integer nearest to (world - translate) / scale; nothing if 64 bits do not hold it.
std::optional<std::int64_t> nearest_integer_under(const GridNumber& world, const GridNumber& scale,
                                                  const GridNumber& translate) {
  const BigDecimal moved = big_sum(from_grid(world, LatticeKind::decimal),
                                   {big(-translate.mantissa), translate.exponent});
  const std::int64_t raise = moved.exponent - scale.exponent;
  const BigInteger numerator = moved.mantissa * big_power(10, std::max<std::int64_t>(raise, 0));
  const BigInteger denominator =
      big(scale.mantissa) * big_power(10, std::max<std::int64_t>(-raise, 0));
  BigInteger quotient;
  mpz_fdiv_q(quotient.get_mpz_t(), BigInteger(2 * numerator + denominator).get_mpz_t(),
             BigInteger(2 * denominator).get_mpz_t());
  if (!quotient.fits_slong_p()) return std::nullopt;
  return quotient.get_si();
}

/// The number (world - translate) / scale if it is an integer of 64 bits; else nothing.
std::optional<std::int64_t> integer_under(const BigDecimal& world, const GridNumber& scale,
                                          const GridNumber& translate) {
  const BigDecimal moved = big_sum(world, {big(-translate.mantissa), translate.exponent});
  BigInteger numerator = moved.mantissa;
  BigInteger denominator = big(scale.mantissa);
  const std::int64_t raise = moved.exponent - scale.exponent;
  if (raise >= 0) {
    numerator *= big_power(10, raise);
  } else {
    denominator *= big_power(10, -raise);
  }
  const BigInteger quotient = numerator / denominator;
  if (quotient * denominator != numerator) return std::nullopt;
  if (!quotient.fits_slong_p()) return std::nullopt;
  return quotient.get_si();
}

/// As integer_under(), but in 128 bits: also nothing when these overflow. integer_under() must
/// decide then.
std::optional<std::int64_t> quick_integer_under(const WideNumber& world, const GridNumber& scale,
                                                const GridNumber& translate) {
  const auto moved = wide_sum(world, WideNumber{-translate.mantissa, translate.exponent}, 10);
  if (!moved) return std::nullopt;
  const std::int64_t raise = std::int64_t{moved->exponent} - scale.exponent;
  const auto numerator = scaled_up(moved->mantissa, 10, raise);
  const auto denominator = scaled_up(scale.mantissa, 10, -raise);
  if (!numerator || !denominator || *numerator % *denominator != 0) return std::nullopt;
  const Wide quotient = *numerator / *denominator;
  if (quotient > std::numeric_limits<std::int64_t>::max() ||
      quotient < std::numeric_limits<std::int64_t>::min()) {
    return std::nullopt;
  }
  return static_cast<std::int64_t>(quotient);
}

/// The integers of a transform at the coordinates of a lattice, on one axis.
class AxisIntegers {
 public:
  AxisIntegers(const Lattice& lattice, std::size_t axis, const Transform& transform)
      : lattice_(lattice),
        axis_(axis),
        scale_(transform.scale[axis]),
        translate_(transform.translate[axis]) {
    if (lattice.kind != LatticeKind::decimal) return;
    const GridNumber& step = lattice.step[axis];
    const GridNumber& start = lattice.origin[axis];
    at_origin_ = quick_integer_under({start.mantissa, start.exponent}, scale_, translate_);
    per_step_ = quick_integer_under({step.mantissa, step.exponent}, scale_, GridNumber{});
    if (at_origin_) return;  // then the origin is on the transform's grid: it was not rounded
    const auto integer = nearest_integer_under(lattice.origin[axis], scale_, translate_);
    const auto origin = integer ? grid_origin(scale_, *integer, translate_) : std::nullopt;
    if (origin && origin->is_rounded && origin->number == lattice.origin[axis]) first_ = integer;
  }

  /// The integer at a coordinate; nothing if the coordinate is not on the transform's grid.
  std::optional<std::int64_t> of(double coordinate) const {
    if (!std::isfinite(coordinate)) return std::nullopt;
    if (lattice_.kind != LatticeKind::decimal) return of_shortest(coordinate);
    if (first_) return from_first(coordinate);
    if (at_origin_ && per_step_ && is_small_integer(coordinate)) {
      std::int64_t integer = 0;
      if (!__builtin_mul_overflow(*per_step_, static_cast<std::int64_t>(coordinate), &integer) &&
          !__builtin_add_overflow(integer, *at_origin_, &integer)) {
        return integer;
      }
    }
    if (const auto wide = wide_world(lattice_, coordinate, axis_)) {
      if (const auto quick = quick_integer_under(*wide, scale_, translate_)) return quick;
    }
    return integer_under(exact_world(lattice_, coordinate, axis_), scale_, translate_);
  }

 private:
  /// The integer at a coordinate of a binary or float64 lattice, which stands for the shortest
  /// decimal of its world coordinate.
  std::optional<std::int64_t> of_shortest(double coordinate) const {
    const double world = lattice_.world(coordinate, static_cast<int>(axis_));
    if (!std::isfinite(world)) return std::nullopt;
    return integer_under(from_grid(shortest_decimal(world), LatticeKind::decimal), scale_,
                         translate_);
  }

  /// The integer at a coordinate of a lattice with a rounded origin. The distance from the origin
  /// is exact.
  std::optional<std::int64_t> from_first(double coordinate) const {
    const BigDecimal distance =
        big_product(from_grid(lattice_.step[axis_], LatticeKind::decimal), from_double(coordinate));
    auto steps = integer_under(distance, scale_, GridNumber{});
    if (!steps || __builtin_add_overflow(*steps, *first_, &*steps)) return std::nullopt;
    return steps;
  }

  const Lattice& lattice_;
  std::size_t axis_;
  GridNumber scale_;
  GridNumber translate_;
  std::optional<std::int64_t> at_origin_;  // the integer at the lattice's origin, if it is one
  std::optional<std::int64_t>
      per_step_;                       // the integers in a step of the lattice, if a whole number
  std::optional<std::int64_t> first_;  // the integer that a rounded origin stands for
};

}  // namespace

std::optional<GridOrigin> grid_origin(const GridNumber& scale, std::int64_t integer,
                                      const GridNumber& translate) {
  const auto wide = wide_sum({Wide{scale.mantissa} * integer, scale.exponent},
                             {translate.mantissa, translate.exponent}, 10);
  if (wide) {
    if (const auto exact = normalized(*wide, 10)) return GridOrigin{*exact, false};
  }
  const BigDecimal exact = place_of(scale, integer, translate);
  const GridNumber rounded = rounded_to_digits(exact);
  BigDecimal error = big_sum(exact, {big(-rounded.mantissa), rounded.exponent});
  if (error.mantissa == 0) return GridOrigin{rounded, false};
  error.mantissa = abs(error.mantissa) * 2;
  const BigDecimal room =
      big_sum(from_grid(scale, LatticeKind::decimal), {-error.mantissa, error.exponent});
  if (room.mantissa <= 0) return std::nullopt;
  return GridOrigin{rounded, true};
}

bool Lattice::is_sane() const {
  if (kind != LatticeKind::decimal && kind != LatticeKind::binary && kind != LatticeKind::float64) {
    return false;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!geometry::is_sane(step[axis]) || !geometry::is_sane(origin[axis])) return false;
    if (step[axis].mantissa <= 0) return false;
  }
  if (kind != LatticeKind::float64) return true;
  const Lattice plain{LatticeKind::float64};
  return step == plain.step && origin == plain.origin;
}

double Lattice::world(double coordinate, int axis) const {
  WATERTIGHT_ASSERT(is_sane());
  if (kind == LatticeKind::float64 || !std::isfinite(coordinate)) return coordinate;
  const auto at = static_cast<std::size_t>(axis);
  if (const auto wide = wide_world(*this, coordinate, at)) {
    if (kind == LatticeKind::decimal) return nearest_double(*wide);
    constexpr Wide kExact = Wide{1} << 53U;
    if (wide->mantissa <= kExact && wide->mantissa >= -kExact) {
      return std::ldexp(static_cast<double>(wide->mantissa), wide->exponent) + 0.0;
    }
  }
  return big_nearest_double(exact_world(*this, coordinate, at));
}

std::array<double, 3> Lattice::world(const Point& p) const {
  return {world(p.x, 0), world(p.y, 1), world(p.z, 2)};
}

std::string Lattice::world_text(double coordinate, int axis) const {
  const auto at = static_cast<std::size_t>(axis);
  if (kind == LatticeKind::decimal && is_small_integer(coordinate)) {
    if (const auto wide = wide_world(*this, coordinate, at)) {
      return plain_decimal(digits_of(wide->mantissa), wide->exponent);
    }
    const BigDecimal exact = exact_world(*this, coordinate, at);
    return plain_decimal(exact.mantissa.get_str(), exact.exponent);
  }
  return shortest_text(world(coordinate, axis));
}

double Lattice::scale(int axis) const {
  const GridNumber& number = step[static_cast<std::size_t>(axis)];
  if (kind == LatticeKind::binary) return big_nearest_double(from_grid(number, kind));
  return nearest_double({number.mantissa, number.exponent});
}

Result<std::vector<std::array<std::int64_t, 3>>> integers_under(const Lattice& lattice,
                                                                std::span<const Point> points,
                                                                const Transform& transform) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (transform.scale[axis].mantissa <= 0 || !is_sane(transform.scale[axis]) ||
        !is_sane(transform.translate[axis])) {
      return Error{ErrorCode::malformed, "a transform's scale must be positive"};
    }
  }
  if (!lattice.is_sane())
    return Error{ErrorCode::malformed,
                 "the lattice has a step that is not positive or an exponent out of range"};
  const std::array axes{AxisIntegers(lattice, 0, transform), AxisIntegers(lattice, 1, transform),
                        AxisIntegers(lattice, 2, transform)};
  std::vector<std::array<std::int64_t, 3>> integers(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto integer = axes[axis].of(points[i][static_cast<int>(axis)]);
      if (!integer) {
        return Error{ErrorCode::malformed,
                     "point " + std::to_string(i) + " is not on the transform's grid"};
      }
      integers[i][axis] = *integer;
    }
  }
  return integers;
}

}  // namespace watertight::geometry
