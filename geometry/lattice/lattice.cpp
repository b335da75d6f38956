// SPDX-License-Identifier: GPL-3.0-or-later
//
// Computes normal forms: the lattice points of integers under a transform, of exact decimals or of
// doubles. lattice_world.cpp goes from lattice points back to numbers of the source.
#include "geometry/lattice/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/assert.h"
#include "geometry/lattice/grid_number.h"

namespace watertight::geometry {
namespace {

constexpr std::int32_t kDecimal = 10;
constexpr std::int32_t kBinary = 2;
/// Doubles hold all integers below this value exactly.
constexpr UnsignedWide kCoordinateEnd = UnsignedWide{1} << 53U;
/// Mode walk of the codec takes relative coordinates below this value (docs/format-walk.md).
constexpr UnsignedWide kCompactEnd = UnsignedWide{1} << 30U;

/// The coordinates of points on one axis: each is origin + offset * radix^exponent, exactly.
struct AxisValues {
  std::vector<UnsignedWide> offsets;  // the smallest is 0
  std::int32_t exponent = 0;
  GridNumber origin;
  UnsignedWide largest = 0;
  UnsignedWide unit = 1;  // a common divisor of the offsets that fits the mantissa of a grid number
  bool is_origin_rounded = false;
};

/// The grid of one axis: the coordinate of an offset is offset / divisor * factor. The divisor
/// divides all offsets, and it or the factor is 1.
struct AxisGrid {
  GridNumber step{1, 0};
  UnsignedWide divisor = 1;
  UnsignedWide factor = 1;
};

using Axes = std::array<AxisValues, 3>;
using Grids = std::array<AxisGrid, 3>;
constexpr AxisGrid kNoGrid{{1, 0}, 1, 0};  // the factor 0 means that no grid fits
constexpr Grids kNoGrids{kNoGrid, kNoGrid, kNoGrid};

UnsignedWide power(std::int32_t radix, std::int32_t exponent) {
  const auto value = scaled_up(1, radix, exponent);
  return value ? static_cast<UnsignedWide>(*value) : 0;
}

/// The largest count such that radix^count divides all offsets; requires a non-zero offset.
std::int32_t common_zeros(const AxisValues& axis, std::int32_t radix) {
  std::int32_t count = 0;
  while (power(radix, count + 1) != 0 && power(radix, count + 1) <= axis.largest) ++count;
  UnsignedWide divisor = power(radix, count);
  for (const UnsignedWide offset : axis.offsets) {
    while (count > 0 && offset % divisor != 0) {
      --count;
      divisor /= static_cast<UnsignedWide>(radix);
    }
    if (count == 0) break;
  }
  return count;
}

UnsignedWide greatest_common_divisor(UnsignedWide a, UnsignedWide b) {
  while (b != 0) {
    a %= b;
    std::swap(a, b);
  }
  return a;
}

UnsignedWide common_divisor(const AxisValues& axis) {
  UnsignedWide divisor = 0;
  for (const UnsignedWide offset : axis.offsets) {
    divisor = greatest_common_divisor(offset, divisor);
    if (divisor == 1) break;
  }
  return divisor;
}

/// The largest coordinate of an axis on a grid, but kCoordinateEnd at most.
UnsignedWide largest_coordinate(const AxisValues& axis, const AxisGrid& grid) {
  const UnsignedWide reduced = axis.largest / grid.divisor;
  if (grid.factor == 0 || reduced >= kCoordinateEnd) return kCoordinateEnd;
  if (reduced != 0 && grid.factor > kCoordinateEnd / reduced) return kCoordinateEnd;
  return std::min(kCoordinateEnd, reduced * grid.factor);
}

bool fits(const Axes& axes, const Grids& grids, UnsignedWide end) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (largest_coordinate(axes[axis], grids[axis]) >= end) return false;
  }
  return true;
}

/// One step for the three axes: the largest power of the radix that divides all offsets.
Grids common_power_grid(const Axes& axes, std::int32_t radix) {
  std::optional<std::int32_t> exponent;
  std::array<std::int32_t, 3> zeros{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axes[axis].largest == 0) continue;
    zeros[axis] = common_zeros(axes[axis], radix);
    const std::int32_t own = axes[axis].exponent + zeros[axis];
    exponent = exponent ? std::min(*exponent, own) : own;
  }
  Grids grids;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grids[axis].step = {1, exponent.value_or(0)};
    if (axes[axis].largest == 0) continue;
    const std::int32_t raise = axes[axis].exponent - *exponent;
    // power() is 0 beyond 128 bits, and fits() then finds that no coordinate fits.
    if (raise >= 0) {
      grids[axis].factor = power(radix, raise);
    } else {
      grids[axis].divisor = power(radix, -raise);
    }
  }
  return grids;
}

/// A step for each axis: the largest power of the radix that divides the offsets of this axis.
Grids own_power_grid(const Axes& axes, std::int32_t radix) {
  Grids grids;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axes[axis].largest == 0) continue;
    const std::int32_t zeros = common_zeros(axes[axis], radix);
    grids[axis].step = {1, axes[axis].exponent + zeros};
    grids[axis].divisor = power(radix, zeros);
  }
  return grids;
}

/// A step for each axis: the greatest common divisor of its offsets, or their unit where a grid
/// number does not hold that divisor.
Grids own_divisor_grid(const Axes& axes) {
  Grids grids;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axes[axis].largest == 0) continue;
    grids[axis] = kNoGrid;
    for (const UnsignedWide divisor : {common_divisor(axes[axis]), axes[axis].unit}) {
      const auto step = normalized({static_cast<Wide>(divisor), axes[axis].exponent}, kDecimal);
      if (!step) continue;
      grids[axis] = {*step, divisor, 1};
      break;
    }
  }
  return grids;
}

/// One step for the three axes: the greatest common divisor of all offsets. kNoGrids if the axes
/// have different exponents; under a transform with equal scales they have one.
Grids common_divisor_grid(const Axes& axes) {
  Grids grids = own_divisor_grid(axes);
  std::optional<std::int32_t> exponent;
  UnsignedWide divisor = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axes[axis].largest == 0) continue;
    if (exponent.value_or(axes[axis].exponent) != axes[axis].exponent) return kNoGrids;
    exponent = axes[axis].exponent;
    divisor = greatest_common_divisor(divisor, grids[axis].divisor);
  }
  const auto step = normalized({static_cast<Wide>(divisor), exponent.value_or(0)}, kDecimal);
  if (!step) return kNoGrids;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grids[axis] = {*step, axes[axis].largest == 0 ? 1 : divisor, 1};
  }
  return grids;
}

LatticePoints points_on(const Axes& axes, const Grids& grids, LatticeKind kind) {
  LatticePoints result;
  result.lattice.kind = kind;
  result.points.resize(axes[0].offsets.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.lattice.step[axis] = grids[axis].step;
    result.lattice.origin[axis] = axes[axis].origin;
    result.is_origin_rounded = result.is_origin_rounded || axes[axis].is_origin_rounded;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
      const UnsignedWide reduced = axes[axis].offsets[i] / grids[axis].divisor;
      result.points[i][static_cast<int>(axis)] =
          static_cast<double>(static_cast<std::uint64_t>(reduced * grids[axis].factor));
    }
  }
  return result;
}

/// The normal form on a decimal grid, if there is one; a function of the values alone. Forms with
/// one step for all axes keep the shape of the solid, so a step for each axis that is no power of
/// ten comes last.
std::optional<LatticePoints> on_decimal_grid(const Axes& axes) {
  const Grids common = common_power_grid(axes, kDecimal);
  if (fits(axes, common, kCompactEnd)) return points_on(axes, common, LatticeKind::decimal);
  const Grids own = own_power_grid(axes, kDecimal);
  if (fits(axes, own, kCompactEnd)) return points_on(axes, own, LatticeKind::decimal);
  const Grids divisor = common_divisor_grid(axes);
  if (fits(axes, divisor, kCompactEnd)) return points_on(axes, divisor, LatticeKind::decimal);
  for (const Grids& grids : {common, own, divisor, own_divisor_grid(axes)}) {
    if (fits(axes, grids, kCoordinateEnd)) return points_on(axes, grids, LatticeKind::decimal);
  }
  return std::nullopt;
}

std::optional<LatticePoints> on_binary_grid(const Axes& axes) {
  const Grids common = common_power_grid(axes, kBinary);
  if (fits(axes, common, kCoordinateEnd)) return points_on(axes, common, LatticeKind::binary);
  return std::nullopt;
}

/// The offsets of the points' coordinates on one axis from the smallest coordinate. Nothing if the
/// offsets do not fit 128 bits: the coordinates then spread over far more than 2^53 steps of any
/// grid.
std::optional<AxisValues> axis_values(std::span<const std::array<GridNumber, 3>> points,
                                      std::size_t axis, std::int32_t radix) {
  AxisValues values;
  std::optional<std::int32_t> exponent;
  for (const auto& point : points) {
    const GridNumber& number = point[axis];
    if (number.mantissa == 0) continue;
    exponent = exponent ? std::min(*exponent, number.exponent) : number.exponent;
  }
  values.exponent = exponent.value_or(0);
  std::vector<Wide> aligned;
  aligned.reserve(points.size());
  constexpr Wide kBound = Wide{1} << 125U;  // then differences of two numbers fit 128 bits
  for (const auto& point : points) {
    const GridNumber& number = point[axis];
    const auto raised =
        scaled_up(number.mantissa, radix, std::int64_t{number.exponent} - values.exponent);
    if (!raised || *raised > kBound || *raised < -kBound) return std::nullopt;
    aligned.push_back(*raised);
  }
  if (aligned.empty()) return values;
  const auto smallest = std::min_element(aligned.begin(), aligned.end());
  values.origin = points[static_cast<std::size_t>(smallest - aligned.begin())][axis];
  const Wide minimum = *smallest;
  values.offsets.reserve(points.size());
  for (const Wide value : aligned) {
    values.offsets.push_back(static_cast<UnsignedWide>(value - minimum));
    values.largest = std::max(values.largest, values.offsets.back());
  }
  return values;
}

std::optional<Axes> axes_of(std::span<const std::array<GridNumber, 3>> points, std::int32_t radix) {
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto values = axis_values(points, axis, radix);
    if (!values) return std::nullopt;
    axes[axis] = std::move(*values);
  }
  return axes;
}

GridNumber renormalized(const GridNumber& number) {
  return normalized({number.mantissa, number.exponent}, kDecimal).value_or(GridNumber{});
}

/// One axis of integers under a transform. An offset is the scale's mantissa times a difference of
/// integers, below 10^19 * 2^64 < 2^128. Nothing if grid_origin() gives nothing.
std::optional<AxisValues> transformed_values(std::span<const std::array<std::int64_t, 3>> vertices,
                                             std::size_t axis, const GridNumber& scale,
                                             const GridNumber& translate) {
  AxisValues values;
  values.exponent = scale.exponent;
  if (vertices.empty()) return values;
  std::int64_t smallest = vertices[0][axis];
  for (const auto& vertex : vertices) smallest = std::min(smallest, vertex[axis]);
  const auto origin = grid_origin(scale, smallest, translate);
  if (!origin) return std::nullopt;
  values.origin = origin->number;
  values.is_origin_rounded = origin->is_rounded;
  const auto factor = static_cast<UnsignedWide>(scale.mantissa);
  values.unit = factor;
  values.offsets.reserve(vertices.size());
  for (const auto& vertex : vertices) {
    values.offsets.push_back(factor * static_cast<UnsignedWide>(Wide{vertex[axis]} - smallest));
    values.largest = std::max(values.largest, values.offsets.back());
  }
  return values;
}

Status check_transform(const Transform& transform) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (transform.scale[axis].mantissa <= 0) {
      return Error{ErrorCode::malformed, "a transform's scale must be positive"};
    }
    for (const GridNumber* number : {&transform.scale[axis], &transform.translate[axis]}) {
      if (std::abs(std::int64_t{number->exponent}) > kLargestExponent) {
        return Error{ErrorCode::limit_exceeded, "a transform's exponent is out of range"};
      }
    }
  }
  return Done{};
}

/// Fails if a world coordinate is beyond the range of doubles: measures and boxes are doubles.
Status check_world(const LatticePoints& points) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto less = [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; };
    const auto [least, most] =
        std::minmax_element(points.points.begin(), points.points.end(), less);
    if (least == points.points.end()) break;
    if (!std::isfinite(points.lattice.world((*least)[axis], axis)) ||
        !std::isfinite(points.lattice.world((*most)[axis], axis))) {
      return Error{ErrorCode::limit_exceeded,
                   "a transformed coordinate is beyond the range of doubles"};
    }
  }
  return Done{};
}

/// The lattice of the doubles nearest to the transformed integers. For origins that a decimal of 18
/// digits cannot distinguish from the points next to them.
Result<LatticePoints> rounded_transform(std::span<const std::array<std::int64_t, 3>> vertices,
                                        const Transform& transform) {
  std::vector<std::array<double, 3>> doubles(vertices.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const GridNumber& scale = transform.scale[axis];
    const GridNumber& translate = transform.translate[axis];
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto exact = wide_sum({Wide{scale.mantissa} * vertices[i][axis], scale.exponent},
                                  {translate.mantissa, translate.exponent}, kDecimal);
      doubles[i][axis] =
          exact ? nearest_double(*exact)
                : nearest_double({Wide{scale.mantissa} * vertices[i][axis], scale.exponent}) +
                      nearest_double({translate.mantissa, translate.exponent});
      if (!std::isfinite(doubles[i][axis])) {
        return Error{ErrorCode::limit_exceeded,
                     "a transformed coordinate is beyond the range of doubles"};
      }
    }
  }
  auto result = lattice_of_doubles(doubles);
  if (!result) return result;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    result->rounded.push_back(static_cast<Index>(i));
  return result;
}

}  // namespace

Result<LatticePoints> lattice_of_integers(std::span<const std::array<std::int64_t, 3>> vertices,
                                          const Transform& transform) {
  if (auto status = check_transform(transform); !status) return status.error();
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto values = transformed_values(vertices, axis, renormalized(transform.scale[axis]),
                                     renormalized(transform.translate[axis]));
    if (!values) return rounded_transform(vertices, transform);
    axes[axis] = std::move(*values);
  }
  if (auto points = on_decimal_grid(axes)) {
    if (auto status = check_world(*points); !status) return status.error();
    return *std::move(points);
  }
  return Error{ErrorCode::limit_exceeded,
               "the vertices spread over more than 2^53 steps of the transform"};
}

Result<LatticePoints> lattice_of_decimals(std::span<const std::array<GridNumber, 3>> vertices) {
  std::vector<std::array<GridNumber, 3>> normal(vertices.begin(), vertices.end());
  for (auto& vertex : normal) {
    for (GridNumber& number : vertex) {
      if (std::abs(std::int64_t{number.exponent}) > kLargestExponent) {
        return Error{ErrorCode::limit_exceeded, "a coordinate's exponent is out of range"};
      }
      number = renormalized(number);
    }
  }
  if (const auto axes = axes_of(normal, kDecimal)) {
    if (auto points = on_decimal_grid(*axes)) return *std::move(points);
  }
  std::vector<std::array<double, 3>> doubles(normal.size());
  std::vector<Index> rounded;
  for (std::size_t i = 0; i < normal.size(); ++i) {
    bool has_changed = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = nearest_double({normal[i][axis].mantissa, normal[i][axis].exponent});
      if (!std::isfinite(value)) {
        return Error{ErrorCode::limit_exceeded, "a coordinate is beyond the range of doubles"};
      }
      doubles[i][axis] = value;
      has_changed = has_changed || shortest_decimal(value) != normal[i][axis];
    }
    if (has_changed) rounded.push_back(static_cast<Index>(i));
  }
  auto result = lattice_of_doubles(doubles);
  if (result) result->rounded = std::move(rounded);
  return result;
}

Result<LatticePoints> lattice_of_doubles(std::span<const std::array<double, 3>> vertices) {
  std::vector<std::array<GridNumber, 3>> numbers(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(vertices[i][axis])) {
        return Error{ErrorCode::malformed,
                     "a coordinate of vertex " + std::to_string(i) + " is not a finite number"};
      }
      numbers[i][axis] = shortest_decimal(vertices[i][axis]);
    }
  }
  if (const auto axes = axes_of(numbers, kDecimal)) {
    if (auto points = on_decimal_grid(*axes)) return *std::move(points);
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      numbers[i][axis] = binary_number(vertices[i][axis]);
    }
  }
  if (const auto axes = axes_of(numbers, kBinary)) {
    if (auto points = on_binary_grid(*axes)) return *std::move(points);
  }
  LatticePoints result;
  result.lattice.kind = LatticeKind::float64;
  result.points.reserve(vertices.size());
  for (const auto& v : vertices) result.points.push_back({v[0] + 0.0, v[1] + 0.0, v[2] + 0.0});
  return result;
}

}  // namespace watertight::geometry
