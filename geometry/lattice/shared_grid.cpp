// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/lattice/shared_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/lattice/big_decimal.h"
#include "geometry/lattice/grid_number.h"

namespace watertight::geometry {
namespace {

/// Coordinates on the grid differ by less than 2^kSpanBits: of the 53 bits of a double, one is left
/// for the rounding of the grid's origin.
constexpr unsigned kSpanBits = 52;
constexpr double kSharedCoordinateEnd = 9007199254740992.0;  // 2^53
constexpr std::size_t kOriginDigits = 18;

/// The number integer * 2^exponent with an odd integer; zero is {0, 0}.
struct BinaryNumber {
  std::int64_t integer = 0;
  int exponent = 0;
};

BinaryNumber binary(double coordinate) {
  if (coordinate == 0) return {};
  int exponent = 0;
  const auto whole = static_cast<std::int64_t>(std::ldexp(std::frexp(coordinate, &exponent), 53));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(whole));
  return {whole / (std::int64_t{1} << zeros), exponent - 53 + zeros};
}

/// The map from a solid's lattice to one axis of the world. The world coordinate of a vertex is
/// (row * p + shift) * 10^exponent, where the three integers p are the vertex's lattice coordinates
/// divided by 2^binary_exponent.
struct WorldAxis {
  std::array<BigInteger, 3> row;
  BigInteger shift;
  std::int64_t exponent = 0;
  int binary_exponent = 0;

  /// The world coordinate of a vertex in units of 10^exponent.
  BigInteger at(const Point& p) const {
    BigInteger sum = shift;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const BinaryNumber number = binary(p[static_cast<int>(axis)]);
      if (number.integer == 0) continue;
      const BigInteger integer = big(number.integer)
                                 << static_cast<unsigned long>(number.exponent - binary_exponent);
      sum += row[axis] * integer;
    }
    return sum;
  }
};

int least_binary_exponent(const Solid& solid) {
  int least = 0;
  for (const Point& p : solid.vertices()) {
    for (int axis = 0; axis < 3; ++axis) least = std::min(least, binary(p[axis]).exponent);
  }
  return least;
}

BigDecimal decimal(const GridNumber& number) { return from_grid(number, LatticeKind::decimal); }

WorldAxis world_axis(const StandingSolid& standing, std::size_t axis, int binary_exponent) {
  const Placement placement = standing.placement == nullptr ? Placement{} : *standing.placement;
  const Lattice& lattice = standing.solid->lattice();
  const BigDecimal unit = from_binary(1, binary_exponent);
  std::array<BigDecimal, 3> row;
  BigDecimal shift = big_sum(decimal(placement.offset[axis]), decimal(placement.anchor[axis]));
  for (std::size_t i = 0; i < 3; ++i) {
    const BigDecimal entry = decimal(placement.linear[axis][i]);
    const BigDecimal step = big_product(from_grid(lattice.step[i], lattice.kind), unit);
    row[i] = big_product(entry, step);
    shift = big_sum(shift, big_product(entry, from_grid(lattice.origin[i], lattice.kind)));
  }
  WorldAxis result;
  result.binary_exponent = binary_exponent;
  result.exponent = shift.exponent;
  for (const BigDecimal& number : row) {
    if (number.mantissa != 0) result.exponent = std::min(result.exponent, number.exponent);
  }
  result.shift = big_mantissa_at(shift, result.exponent);
  for (std::size_t i = 0; i < 3; ++i) {
    if (row[i].mantissa != 0) result.row[i] = big_mantissa_at(row[i], result.exponent);
  }
  return result;
}

/// The least and the largest world coordinate of a solid on one axis, in units of 10^exponent of
/// the WorldAxis.
struct Range {
  BigInteger low;
  BigInteger high;
};

Range range_of(const Solid& solid, const WorldAxis& axis) {
  Range range{axis.at(solid.vertices().front()), axis.at(solid.vertices().front())};
  for (const Point& p : solid.vertices()) {
    const BigInteger value = axis.at(p);
    if (value < range.low) range.low = value;
    if (value > range.high) range.high = value;
  }
  return range;
}

BigInteger floor_quotient(const BigInteger& a, const BigInteger& b) {
  BigInteger quotient;
  mpz_fdiv_q(quotient.get_mpz_t(), a.get_mpz_t(), b.get_mpz_t());
  return quotient;
}

/// One axis of the grid: coordinates are multiples of 10^exponent from the origin.
struct WorldGrid {
  std::int64_t exponent = 0;
  BigInteger origin;  // the origin in units of 10^exponent

  /// The coordinate on the grid of the number value * 10^from, rounded to the nearest if 10^from is
  /// finer than the grid.
  double coordinate(const BigInteger& value, std::int64_t from) const {
    if (from >= exponent) {
      return BigInteger(big_mantissa_at({value, from}, exponent) - origin).get_d();
    }
    const BigInteger unit = big_power(10, exponent - from);
    return BigInteger(floor_quotient(2 * value + unit, 2 * unit) - origin).get_d();
  }
};

WorldGrid grid_of(const std::vector<WorldAxis>& axes, const std::vector<Range>& ranges) {
  std::int64_t exponent = axes.front().exponent;
  for (const WorldAxis& axis : axes) exponent = std::min(exponent, axis.exponent);
  BigInteger low = big_mantissa_at({ranges.front().low, axes.front().exponent}, exponent);
  BigInteger high = low;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const BigInteger own_low = big_mantissa_at({ranges[i].low, axes[i].exponent}, exponent);
    const BigInteger own_high = big_mantissa_at({ranges[i].high, axes[i].exponent}, exponent);
    if (own_low < low) low = own_low;
    if (own_high > high) high = own_high;
  }
  std::int64_t dropped = 0;
  for (BigInteger span = high - low; mpz_sizeinbase(span.get_mpz_t(), 2) > kSpanBits; span /= 10) {
    ++dropped;
  }
  WorldGrid grid{exponent + dropped, floor_quotient(low, big_power(10, dropped))};
  const BigInteger magnitude = abs(grid.origin);
  const std::size_t digits = magnitude.get_str().size();
  if (digits > kOriginDigits) {  // a lattice's origin has at most kOriginDigits digits
    const BigInteger unit = big_power(10, static_cast<std::int64_t>(digits - kOriginDigits));
    grid.origin = floor_quotient(grid.origin, unit) * unit;
  }
  return grid;
}

std::optional<GridNumber> grid_number(BigInteger mantissa, std::int64_t exponent) {
  while (mantissa != 0 && mpz_divisible_ui_p(mantissa.get_mpz_t(), 10) != 0) {
    mantissa /= 10;
    ++exponent;
  }
  if (mantissa == 0) return GridNumber{};
  if (!mantissa.fits_slong_p() || std::abs(exponent) > kLargestExponent) return std::nullopt;
  return GridNumber{mantissa.get_si(), static_cast<std::int32_t>(exponent)};
}

bool have_one_placement(const std::vector<StandingSolid>& solids) {
  const Placement* first = solids.front().placement;
  return std::all_of(solids.begin(), solids.end(), [&](const StandingSolid& standing) {
    if (standing.placement == first) return true;
    return standing.placement != nullptr && first != nullptr && *standing.placement == *first;
  });
}

std::optional<Point> inside_doubles(const std::array<double, 3>& p) {
  if (std::any_of(p.begin(), p.end(),
                  [](double c) { return !(std::abs(c) < kSharedCoordinateEnd); })) {
    return std::nullopt;
  }
  return Point{p[0], p[1], p[2]};
}

}  // namespace

struct SharedGrid::World {
  std::vector<std::array<WorldAxis, 3>> axes;  // the map of each solid to each axis of the world
  std::array<WorldGrid, 3> grid;
};

SharedGrid::SharedGrid(std::vector<StandingSolid> solids)
    : solids_(std::move(solids)), boxes_(solids_.size()), rounded_axes_(solids_.size()) {}

std::optional<SharedGrid> SharedGrid::of_one_placement(std::vector<StandingSolid> solids) {
  SharedGrid grid(std::move(solids));
  if (grid.solids_.empty() || !have_one_placement(grid.solids_)) return std::nullopt;
  if (!grid.share_placement()) return std::nullopt;
  return grid;
}

std::optional<SharedGrid> SharedGrid::in_world(std::vector<StandingSolid> solids) {
  SharedGrid grid(std::move(solids));
  if (grid.solids_.empty() || !grid.put_in_world()) return std::nullopt;
  return grid;
}

bool SharedGrid::is_turned_over(std::size_t solid) const {
  const Placement* placement = solids_[solid].placement;
  return placement_ == nullptr && placement != nullptr && determinant_sign(*placement) < 0;
}

bool SharedGrid::share_placement() {
  placement_ = solids_.front().placement;
  std::vector<Lattice> lattices;
  for (const StandingSolid& standing : solids_) {
    const Lattice& lattice = standing.solid->lattice();
    if (lattices.empty() || lattices.back() != lattice) lattices.push_back(lattice);
  }
  common_ = CommonLattice::of(lattices);
  if (!common_) return false;
  lattice_ = common_->lattice();
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    const Solid& solid = *solids_[i].solid;
    const Box own = solid.box();
    const auto low = common_->moved(own.min, solid.lattice());
    const auto high = common_->moved(own.max, solid.lattice());
    if (!low || !high) return false;
    boxes_[i] = Box{*low, *high};
  }
  return true;
}

bool SharedGrid::put_in_world() {
  std::vector<int> binary_exponents;
  for (const StandingSolid& standing : solids_) {
    binary_exponents.push_back(least_binary_exponent(*standing.solid));
  }
  lattice_ = {};
  World world;
  world.axes.resize(solids_.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<WorldAxis> axes;
    std::vector<Range> ranges;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      axes.push_back(world_axis(solids_[i], axis, binary_exponents[i]));
      ranges.push_back(range_of(*solids_[i].solid, axes.back()));
    }
    const WorldGrid grid = grid_of(axes, ranges);
    const auto step = grid_number(1, grid.exponent);
    const auto origin = grid_number(grid.origin, grid.exponent);
    if (!step || !origin) return false;
    lattice_.step[axis] = *step;
    lattice_.origin[axis] = *origin;
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      const auto at = static_cast<int>(axis);
      boxes_[i].min[at] = grid.coordinate(ranges[i].low, axes[i].exponent);
      boxes_[i].max[at] = grid.coordinate(ranges[i].high, axes[i].exponent);
      if (!(boxes_[i].max[at] < kSharedCoordinateEnd) ||
          !(boxes_[i].min[at] > -kSharedCoordinateEnd)) {
        return false;
      }
      rounded_axes_[i][axis] = axes[i].exponent < grid.exponent;
      world.axes[i][axis] = std::move(axes[i]);
    }
    world.grid[axis] = grid;
  }
  world_ = std::make_shared<const World>(std::move(world));
  return true;
}

std::array<double, 3> SharedGrid::world(const Point& p) const {
  const std::array<double, 3> point = lattice_.world(p);
  return placement_ == nullptr ? point : place(*placement_, point);
}

std::optional<std::vector<Point>> SharedGrid::vertices(std::size_t index) const {
  const Solid& solid = *solids_[index].solid;
  std::vector<Point> points;
  points.reserve(solid.vertex_count());
  if (common_) {
    for (const Point& p : solid.vertices()) {
      const auto moved = common_->moved(p, solid.lattice());
      if (!moved) return std::nullopt;
      points.push_back(*moved);
    }
    return points;
  }
  const std::array<WorldAxis, 3>& axes = world_->axes[index];
  for (const Point& p : solid.vertices()) {
    std::array<double, 3> moved{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moved[axis] = world_->grid[axis].coordinate(axes[axis].at(p), axes[axis].exponent);
    }
    const auto point = inside_doubles(moved);
    if (!point) return std::nullopt;
    points.push_back(*point);
  }
  return points;
}

}  // namespace watertight::geometry
