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

/// A coordinate in units of 2^unit, of which it is a multiple.
mpz_class in_units(double coordinate, int unit) {
  if (coordinate == 0) return 0;
  int exponent = 0;
  const double fraction = std::frexp(coordinate, &exponent);
  mpz_class value(static_cast<long>(std::ldexp(fraction, 53)));
  const int shift = exponent - 53 - unit;
  if (shift >= 0) return mpz_class(value << static_cast<unsigned long>(shift));
  return mpz_class(value >> static_cast<unsigned long>(-shift));  // only zero bits are lost
}

/// The vertices of triangles, each once, by the way from the first of all to them.
class BigVertices {
 public:
  BigVertices(std::span<const Point> vertices, std::span<const Triangle> triangles, int unit) {
    for (const Triangle& triangle : triangles) {
      numbers_.insert(numbers_.end(), triangle.begin(), triangle.end());
    }
    std::sort(numbers_.begin(), numbers_.end());
    numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
    const Point& origin = vertices[triangles[0][0]];
    for (int axis = 0; axis < 3; ++axis) {
      const mpz_class start = in_units(origin[axis], unit);
      for (const Index vertex : numbers_) {
        ways_[static_cast<std::size_t>(axis)].push_back(in_units(vertices[vertex][axis], unit) -
                                                        start);
      }
    }
  }

  /// The place of a vertex in the lists.
  std::size_t place(Index vertex) const {
    return static_cast<std::size_t>(std::lower_bound(numbers_.begin(), numbers_.end(), vertex) -
                                    numbers_.begin());
  }
  mpz_srcptr way(std::size_t place, std::size_t axis) const {
    return ways_[axis][place].get_mpz_t();
  }

 private:
  std::vector<Index> numbers_;
  std::array<std::vector<mpz_class>, 3> ways_;
};

mpz_class big_sum_of_determinants(std::span<const Point> vertices,
                                  std::span<const Triangle> triangles, int unit) {
  const BigVertices big(vertices, triangles, unit);
  mpz_class total = 0;
  mpz_class minor;  // one number for all triangles: GMP takes memory for it once
  for (const Triangle& triangle : triangles) {
    const std::size_t a = big.place(triangle[0]);
    const std::size_t b = big.place(triangle[1]);
    const std::size_t c = big.place(triangle[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t next = (axis + 1) % 3;
      const std::size_t last = (axis + 2) % 3;
      mpz_mul(minor.get_mpz_t(), big.way(b, next), big.way(c, last));
      mpz_submul(minor.get_mpz_t(), big.way(b, last), big.way(c, next));
      mpz_addmul(total.get_mpz_t(), big.way(a, axis), minor.get_mpz_t());
    }
  }
  return total;
}

/// The sign of the volume, unless rounded numbers do not show it.
std::optional<int> sign_by_doubles(std::span<const Point> vertices,
                                   std::span<const Triangle> triangles) {
  if (triangles.empty()) return 0;
  const Point& origin = vertices[triangles[0][0]];
  double total = 0;
  double reach = 0;  // the sum of the products of which determinants are made
  for (const Triangle& triangle : triangles) {
    std::array<Point, 3> way;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Point& vertex = vertices[triangle[corner]];
      way[corner] = {vertex.x - origin.x, vertex.y - origin.y, vertex.z - origin.z};
    }
    const auto& [a, b, c] = way;
    total += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
             a.z * (b.x * c.y - b.y * c.x);
    reach += std::abs(a.x) * (std::abs(b.y * c.z) + std::abs(b.z * c.y)) +
             std::abs(a.y) * (std::abs(b.z * c.x) + std::abs(b.x * c.z)) +
             std::abs(a.z) * (std::abs(b.x * c.y) + std::abs(b.y * c.x));
  }
  // A determinant is wrong by less than 8 roundings of its reach, a sum of n numbers by less than
  // n roundings; twice as much allows for the roundings of the reach itself. Products below 2^-500
  // could have lost digits by underflow.
  const double error = (2 * static_cast<double>(triangles.size()) + 20) * 0x1p-53 * reach;
  if (!(std::isfinite(reach) && std::abs(total) > error + 0x1p-500)) return std::nullopt;
  return total > 0 ? 1 : -1;
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
  if (const auto sign = sign_by_doubles(vertices, triangles)) return *sign;
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
