// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/lattice/rational_lattice.h"

#include <cstdlib>

#include "geometry/lattice/grid_number.h"
#include "geometry/predicates/exact_quotient.h"

namespace watertight::geometry {
namespace {

mpq_class rational(const GridNumber& number, unsigned long radix) {
  mpz_class power;
  mpz_ui_pow_ui(power.get_mpz_t(), radix, static_cast<unsigned long>(std::abs(number.exponent)));
  const mpz_class mantissa(static_cast<long>(number.mantissa));
  mpq_class value = number.exponent < 0 ? mpq_class(mantissa, power) : mpq_class(mantissa * power);
  value.canonicalize();
  return value;
}

unsigned long radix_of(const Lattice& lattice) {
  return lattice.kind == LatticeKind::binary ? 2 : 10;
}

}  // namespace

mpq_class step_of(const Lattice& lattice, std::size_t axis) {
  return rational(lattice.step[axis], radix_of(lattice));
}

mpq_class origin_of(const Lattice& lattice, std::size_t axis) {
  return rational(lattice.origin[axis], radix_of(lattice));
}

mpq_class decimal(double number) { return rational(shortest_decimal(number), 10); }

mpq_class world_coordinate(const Lattice& lattice, double coordinate) {
  return lattice.kind == LatticeKind::decimal ? decimal(coordinate) : mpq_class(coordinate);
}

mpq_class lattice_coordinate(const Lattice& lattice, std::size_t axis, double coordinate) {
  return (world_coordinate(lattice, coordinate) - origin_of(lattice, axis)) /
         step_of(lattice, axis);
}

RationalPoint world_point(const Lattice& lattice, const Point& point) {
  const auto world = [&](double coordinate, std::size_t axis) {
    return mpq_class(origin_of(lattice, axis) + step_of(lattice, axis) * mpq_class(coordinate));
  };
  return {world(point.x, 0), world(point.y, 1), world(point.z, 2)};
}

double nearest(const mpq_class& value) {
  return nearest_quotient(value.get_num(), value.get_den(), 0);
}

}  // namespace watertight::geometry
