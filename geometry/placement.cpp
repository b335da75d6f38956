// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/placement.h"

#include <algorithm>
#include <limits>

#include "base/assert.h"
#include "geometry/lattice/big_decimal.h"
#include "geometry/lattice/grid_number.h"

namespace watertight::geometry {
namespace {

using Matrix = std::array<std::array<BigInteger, 3>, 3>;

/// The linear part of a placement, times 10^scale, in integers.
struct ScaledMatrix {
  Matrix rows;
  std::int64_t scale = 0;
};

ScaledMatrix scaled(const Placement& placement) {
  std::int32_t least = 0;
  for (const auto& row : placement.linear) {
    for (const GridNumber& number : row) least = std::min(least, number.exponent);
  }
  ScaledMatrix matrix;
  matrix.scale = -std::int64_t{least};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const BigDecimal number = from_grid(placement.linear[i][j], LatticeKind::decimal);
      matrix.rows[i][j] = big_mantissa_at(number, least);
    }
  }
  return matrix;
}

BigInteger determinant(const Matrix& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Makes a solid from the arrays of a solid in which orders or coordinates have been changed.
Result<Solid> remade(SolidArrays arrays, const Lattice& lattice, std::uint32_t srid) {
  Limits limits;  // no limits: the original solid has kept them already
  limits.vertices = limits.facets = limits.rings = limits.shells = kNone;
  return Solid::make(std::move(arrays), lattice, srid, limits);
}

}  // namespace

int determinant_sign(const Placement& placement) {
  return sgn(determinant(scaled(placement).rows));
}

bool is_rotation(const Placement& placement) {
  const ScaledMatrix matrix = scaled(placement);
  const BigInteger one = big_power(10, 2 * matrix.scale);
  const Matrix& m = matrix.rows;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      const BigInteger product = m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2];
      if (product != (i == j ? one : BigInteger(0))) return false;
    }
  }
  return determinant(m) > 0;
}

double rounded(const GridNumber& decimal) {
  return nearest_double({decimal.mantissa, decimal.exponent});
}

std::array<std::array<double, 3>, 3> linear_part(const Placement& placement) {
  std::array<std::array<double, 3>, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      linear[i][j] = rounded(placement.linear[i][j]);
    }
  }
  return linear;
}

std::array<double, 3> shift_of(const Placement& placement) {
  std::array<double, 3> shift{};
  for (std::size_t i = 0; i < 3; ++i) {
    shift[i] = rounded(placement.anchor[i]) + rounded(placement.offset[i]);
  }
  return shift;
}

std::array<double, 3> place(const Placement& placement, const std::array<double, 3>& point) {
  const auto linear = linear_part(placement);
  std::array<double, 3> result = shift_of(placement);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[i] += linear[i][j] * point[j];
  }
  return result;
}

Result<Solid> placed(const Solid& solid, const Placement& placement) {
  SolidArrays arrays = solid.arrays();
  for (Point& vertex : arrays.vertices) {
    const auto world = place(placement, solid.lattice().world(vertex));
    vertex = {world[0], world[1], world[2]};
  }
  return remade(std::move(arrays), Lattice{LatticeKind::float64}, placement.srid);
}

Solid turned_over(const Solid& solid) {
  SolidArrays arrays = solid.arrays();
  for (std::size_t ring = 0; ring + 1 < arrays.ring_offsets.size(); ++ring) {
    std::reverse(arrays.ring_vertices.begin() + arrays.ring_offsets[ring],
                 arrays.ring_vertices.begin() + arrays.ring_offsets[ring + 1]);
  }
  auto result = remade(std::move(arrays), solid.lattice(), solid.srid());
  WATERTIGHT_ASSERT(result.has_value());
  return *std::move(result);
}

}  // namespace watertight::geometry
