// SPDX-License-Identifier: GPL-3.0-or-later
//
// Volumes are summed exactly and rounded once: in 128-bit integers on lattices whose coordinates
// allow it, in integers of any length elsewhere. mass/area.h has the areas.
#include "geometry/measures.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/lattice/grid_number.h"
#include "geometry/mass/area.h"
#include "geometry/predicates/exact_quotient.h"

namespace watertight::geometry {
namespace {

/// The number numerator * 2^exponent.
struct ExactVolume {
  mpz_class numerator = 0;
  std::int64_t exponent = 0;
};

mpz_class to_big(Wide value) {
  const bool is_negative = value < 0;
  const auto magnitude =
      is_negative ? -static_cast<UnsignedWide>(value) : static_cast<UnsignedWide>(value);
  mpz_class result(static_cast<unsigned long>(static_cast<std::uint64_t>(magnitude >> 64U)));
  result <<= 64U;
  result += static_cast<unsigned long>(static_cast<std::uint64_t>(magnitude));
  return is_negative ? mpz_class(-result) : result;
}

/// True if all coordinates are integers and the sum of all determinants fits 127 bits: 6 *
/// distance^3 * count < 2^126, with the largest distance from the first vertex along an axis.
bool fits_wide(std::span<const Point> vertices, std::span<const Triangle> triangles) {
  double distance = 1;
  for (const Triangle& triangle : triangles) {
    for (const Index vertex : triangle) {
      for (int axis = 0; axis < 3; ++axis) {
        const double coordinate = vertices[vertex][axis];
        constexpr double kExactEnd = 9007199254740992.0;  // 2^53
        if (!(std::abs(coordinate) < kExactEnd) || coordinate != std::trunc(coordinate)) {
          return false;
        }
        distance = std::max(distance, std::abs(coordinate - vertices[triangles[0][0]][axis]));
      }
    }
  }
  const double bound = 6.0 * distance * distance * distance * static_cast<double>(triangles.size());
  return bound < std::ldexp(1.0, 126);
}

Wide wide_sum_of_determinants(std::span<const Point> vertices,
                              std::span<const Triangle> triangles) {
  Wide total = 0;
  const Point& origin = vertices[triangles[0][0]];
  const auto from_origin = [&](Index vertex, int axis) {
    return Wide{static_cast<std::int64_t>(vertices[vertex][axis] - origin[axis])};
  };
  for (const auto& [a, b, c] : triangles) {
    const Wide bx = from_origin(b, 0), by = from_origin(b, 1), bz = from_origin(b, 2);
    const Wide cx = from_origin(c, 0), cy = from_origin(c, 1), cz = from_origin(c, 2);
    total += from_origin(a, 0) * (by * cz - bz * cy) + from_origin(a, 1) * (bz * cx - bx * cz) +
             from_origin(a, 2) * (bx * cy - by * cx);
  }
  return total;
}

/// The exponent of the lowest set bit of a finite, non-zero double.
int lowest_bit(double value) {
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  auto mantissa = static_cast<std::uint64_t>(std::abs(std::ldexp(fraction, 53)));
  exponent -= 53;
  for (; mantissa % 2 == 0; mantissa /= 2) ++exponent;
  return exponent;
}

mpz_class big_sum_of_determinants(std::span<const Point> vertices,
                                  std::span<const Triangle> triangles, int unit) {
  const auto big = [&](Index vertex, int axis) {
    const double coordinate = vertices[vertex][axis];
    if (coordinate == 0) return mpz_class(0);
    int exponent = 0;
    const double fraction = std::frexp(coordinate, &exponent);
    mpz_class value(static_cast<long>(std::ldexp(fraction, 53)));
    const int shift = exponent - 53 - unit;
    if (shift >= 0) return mpz_class(value << static_cast<unsigned long>(shift));
    return mpz_class(value >> static_cast<unsigned long>(-shift));  // only zero bits are lost
  };
  const std::array origin{big(triangles[0][0], 0), big(triangles[0][0], 1),
                          big(triangles[0][0], 2)};
  mpz_class total = 0;
  for (const Triangle& triangle : triangles) {
    std::array<std::array<mpz_class, 3>, 3> p;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        p[corner][axis] = big(triangle[corner], static_cast<int>(axis)) - origin[axis];
      }
    }
    total += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
             p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
             p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
  }
  return total;
}

/// Six times the signed volume in lattice units, exactly.
ExactVolume exact_six_volume(std::span<const Point> vertices, std::span<const Triangle> triangles) {
  if (triangles.empty()) return {};
  if (fits_wide(vertices, triangles)) {
    return {to_big(wide_sum_of_determinants(vertices, triangles)), 0};
  }
  int unit = std::numeric_limits<int>::max();
  for (const Triangle& triangle : triangles) {
    for (const Index vertex : triangle) {
      for (int axis = 0; axis < 3; ++axis) {
        const double coordinate = vertices[vertex][axis];
        if (coordinate != 0) unit = std::min(unit, lowest_bit(coordinate));
      }
    }
  }
  if (unit == std::numeric_limits<int>::max()) return {};
  return {big_sum_of_determinants(vertices, triangles, unit), 3 * std::int64_t{unit}};
}

/// The volume in world units: lattice volume times the three exact steps.
double world_volume(const ExactVolume& six_volume, const Lattice& lattice) {
  mpz_class numerator = six_volume.numerator;
  mpz_class denominator = 6;
  std::int64_t exponent = six_volume.exponent;
  for (const GridNumber& step : lattice.step) {
    numerator *= static_cast<long>(step.mantissa);
    if (lattice.kind == LatticeKind::binary) {
      exponent += step.exponent;
      continue;
    }
    mpz_class power;
    mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(std::abs(step.exponent)));
    (step.exponent < 0 ? denominator : numerator) *= power;
  }
  return nearest_quotient(std::move(numerator), denominator, exponent);
}

/// The number of vertices of a shell, less the number of edges, plus the number of facets. Each
/// interior ring subtracts one more: a cut from the ring to the exterior ring would add an edge.
std::int64_t euler_characteristic(const Solid& solid, Index shell) {
  std::vector<Index> vertices;
  std::vector<std::pair<Index, Index>> edges;
  std::int64_t interior_rings = 0;
  const IndexRange facets = solid.facets_of(shell);
  for (Index facet = facets.begin; facet < facets.end; ++facet) {
    const IndexRange rings = solid.rings_of(facet);
    interior_rings += std::max<std::int64_t>(std::int64_t{rings.size()} - 1, 0);
    for (Index ring = rings.begin; ring < rings.end; ++ring) {
      const auto corners = solid.ring(ring);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Index next = corners[i + 1 == corners.size() ? 0 : i + 1];
        vertices.push_back(corners[i]);
        edges.emplace_back(std::min(corners[i], next), std::max(corners[i], next));
      }
    }
  }
  const auto distinct = [](auto& values) {
    std::sort(values.begin(), values.end());
    return std::unique(values.begin(), values.end()) - values.begin();
  };
  return distinct(vertices) - distinct(edges) + std::int64_t{facets.size()} - interior_rings;
}

}  // namespace

int volume_sign(std::span<const Point> vertices, std::span<const Triangle> triangles) {
  return sgn(exact_six_volume(vertices, triangles).numerator);
}

double six_volume(std::span<const Point> vertices, std::span<const Triangle> triangles) {
  const ExactVolume exact = exact_six_volume(vertices, triangles);
  return nearest_quotient(exact.numerator, 1, exact.exponent);
}

Measures measure(const Solid& solid, std::span<const Triangle> triangles) {
  Measures measures;
  measures.volume = world_volume(exact_six_volume(solid.vertices(), triangles), solid.lattice());
  measures.area = area_of(solid, triangles);
  if (solid.vertex_count() > 0) {
    const Box box = solid.box();
    measures.box_min = solid.lattice().world(box.min);
    measures.box_max = solid.lattice().world(box.max);
  }
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    measures.genus += (2 - euler_characteristic(solid, shell)) / 2;
  }
  measures.vertices = solid.vertex_count();
  measures.facets = solid.facet_count();
  measures.rings = solid.ring_count();
  measures.shells = solid.shell_count();
  return measures;
}

}  // namespace watertight::geometry
