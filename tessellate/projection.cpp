// SPDX-License-Identifier: GPL-3.0-or-later
//
// Decides exactly along which axis a facet is projected.
#include <algorithm>
#include <cmath>
#include <optional>

#include <CGAL/Exact_rational.h>

#include "geometry/crs/crs.h"
#include "tessellate/facets.h"

namespace watertight::tessellate {
namespace {

__extension__ typedef __int128 Wide;  // NOLINT(modernize-use-using)

// Integer coordinates up to 2^53 give differences of at most 2^54 and terms of at most 2^109. Sums
// of fewer terms than this do not overflow 127 bits.
constexpr std::size_t kMostWideTerms = 1U << 17;
constexpr double kLargestInteger = 9007199254740992.0;  // 2^53
// The largest difference of exponents of steps that counts. With a larger difference, one axis has
// the largest component whatever the coordinates are (finite doubles span fewer than 2^2100).
constexpr std::int32_t kMostStepSpread = 5000;
// Metres per degree: 2 pi * 6,378,137 m / 360 = 111,320 m = 2^16.76 on the equator, rounded to a
// power of two. One constant serves all latitudes, both axes, grads (100,188 m) and heights in
// feet: a factor of a few only changes the slope at which the axis changes.
constexpr double kDegree = 131072.0;  // 2^17
// The filter in floating point: powers of ten up to this one have no rounding.
constexpr std::int64_t kMostRoundedSpread = 22;
constexpr double kHalfUlp = 1.0 / 9007199254740992.0;  // 2^-53
constexpr double kUnderflow = 1e-200;                  // more than underflow can cause
constexpr double kOverflow = 1e300;

bool is_wide_enough(const Point& p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::fabs(p[axis]) <= kLargestInteger)) return false;
    if (static_cast<double>(static_cast<std::int64_t>(p[axis])) != p[axis]) return false;
  }
  return true;
}

/// Calls a function with an axis and the two products whose difference a vertex of a ring adds to
/// the doubled area along it, in lattice units.
template <class Number, class Function>
void for_each_product(std::span<const Point> vertices, std::span<const Index> ring,
                      const Function& function) {
  const Point& base = vertices[ring[0]];
  const std::array<Number, 3> origin{Number(base.x), Number(base.y), Number(base.z)};
  const auto relative = [&](Index vertex) {
    const Point& p = vertices[vertex];
    return std::array<Number, 3>{Number(p.x) - origin[0], Number(p.y) - origin[1],
                                 Number(p.z) - origin[2]};
  };
  std::array<Number, 3> from = relative(ring[1]);
  for (std::size_t i = 2; i < ring.size(); ++i) {
    const std::array<Number, 3> to = relative(ring[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      function(axis, Number(from[u] * to[v]), Number(from[v] * to[u]));
    }
    from = to;
  }
}

/// The components of the exact doubled area vector of a ring.
template <class Number>
std::array<Number, 3> doubled_area(std::span<const Point> vertices, std::span<const Index> ring) {
  std::array<Number, 3> area{Number(0), Number(0), Number(0)};
  for_each_product<Number>(
      vertices, ring,
      [&](std::size_t axis, const Number& one, const Number& other) { area[axis] += one - other; });
  return area;
}

/// The projection along the axis of the largest component of a doubled area vector. `weight` has
/// the factors that bring the components into world scale.
template <class Number>
Projection largest_component(const std::array<Number, 3>& area,
                             const std::array<Number, 3>& weight) {
  Projection projection;
  projection.axis = 0;
  Number largest(0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Number size = (area[axis] < Number(0) ? -area[axis] : area[axis]) * weight[axis];
    if (size > largest) {
      largest = size;
      projection.axis = static_cast<int>(axis);
    }
  }
  projection.is_degenerate = largest == Number(0);
  projection.is_mirrored = area[static_cast<std::size_t>(projection.axis)] < Number(0);
  return projection;
}

CGAL::Exact_rational power(int radix, std::int32_t exponent) {
  CGAL::Exact_rational result(1);
  CGAL::Exact_rational square(radix);
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 != 0) result *= square;
    square *= square;
  }
  return result;
}

/// True if the horizontal axes of a ring are angles. As for measures, coordinates beyond a full
/// turn cannot be angles. Only the coordinates of the ring decide, not those of the whole solid.
bool is_in_angles(const Solid& solid, std::span<const Index> ring) {
  const double largest = geometry::largest_angle(solid.srid());
  if (largest == 0) return false;
  return std::all_of(ring.begin(), ring.end(), [&](Index vertex) {
    const Point& p = solid.vertices()[vertex];
    return std::fabs(solid.lattice().world(p.x, 0)) <= largest &&
           std::fabs(solid.lattice().world(p.y, 1)) <= largest;
  });
}

/// The factors that bring the components of an area vector into world scale. The component along an
/// axis scales with the product of the units of the two other axes, that is, up to a common factor,
/// with one over the unit of the axis itself: its lattice step, times kDegree for an angle.
std::array<CGAL::Exact_rational, 3> world_weights(const Lattice& lattice, bool is_in_angles) {
  std::int32_t largest = lattice.step[0].exponent;
  for (const GridNumber& step : lattice.step) largest = std::max(largest, step.exponent);
  std::array<CGAL::Exact_rational, 3> weights;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const GridNumber& step = lattice.step[axis];
    const std::int64_t spread = std::int64_t{largest} - step.exponent;
    const auto exponent =
        static_cast<std::int32_t>(std::min<std::int64_t>(spread, kMostStepSpread));
    const std::int64_t mantissa = step.mantissa == 0 ? 1 : std::abs(step.mantissa);
    weights[axis] = power(lattice.kind == LatticeKind::decimal ? 10 : 2, exponent) /
                    CGAL::Exact_rational(static_cast<double>(mantissa));
  }
  if (is_in_angles) weights[2] *= CGAL::Exact_rational(kDegree);
  return weights;
}

/// world_weights() within a few roundings; none for steps that are far apart.
std::optional<std::array<double, 3>> rounded_weights(const Lattice& lattice, bool is_in_angles) {
  std::int32_t largest = lattice.step[0].exponent;
  for (const GridNumber& step : lattice.step) largest = std::max(largest, step.exponent);
  std::array<double, 3> weights{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const GridNumber& step = lattice.step[axis];
    const std::int64_t spread = std::int64_t{largest} - step.exponent;
    if (spread > kMostRoundedSpread) return std::nullopt;
    const double radix = lattice.kind == LatticeKind::decimal ? 10 : 2;
    double weight = 1;
    for (std::int64_t i = 0; i < spread; ++i) weight *= radix;
    const std::int64_t mantissa = step.mantissa == 0 ? 1 : std::abs(step.mantissa);
    weights[axis] = weight / static_cast<double>(mantissa);
  }
  if (is_in_angles) weights[2] *= kDegree;
  return weights;
}

/// The projection where floating point is sure of it.
std::optional<Projection> filtered_projection(std::span<const Point> vertices,
                                              std::span<const Index> ring,
                                              const std::array<double, 3>& weight) {
  std::array<double, 3> area{};
  std::array<double, 3> terms{};  // the sums of the terms' sizes
  for_each_product<double>(vertices, ring, [&](std::size_t axis, double one, double other) {
    area[axis] += one - other;
    terms[axis] += std::fabs(one) + std::fabs(other);
  });
  // A term has at most four roundings, a sum one for each term; twice that covers the bound itself,
  // the weights and the products with them.
  const double error_of_term = 2 * (static_cast<double>(ring.size()) + 8) * kHalfUlp;
  std::array<double, 3> size{};
  std::array<double, 3> error{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    size[axis] = std::fabs(area[axis]) * weight[axis];
    error[axis] = terms[axis] * weight[axis] * error_of_term + kUnderflow;
  }
  const auto most = static_cast<std::size_t>(std::ranges::max_element(size) - size.begin());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double rest = axis == most ? 0 : size[axis] + error[axis];
    if (!(size[most] - error[most] > rest) || !(size[most] < kOverflow)) return std::nullopt;
  }
  return Projection{static_cast<int>(most), area[most] < 0, false};
}

}  // namespace

Projection facet_projection(const Solid& solid, Index facet) {
  Projection none;
  none.is_degenerate = true;
  const IndexRange rings = solid.rings_of(facet);
  if (rings.size() == 0 || solid.ring(rings.begin).size() < 3) return none;
  const std::span<const Index> ring = solid.ring(rings.begin);
  const std::span<const Point> vertices = solid.vertices();

  const bool has_angles = is_in_angles(solid, ring);
  const auto& step = solid.lattice().step;
  const bool has_equal_steps = step[0] == step[1] && step[1] == step[2];
  const bool is_wide =
      !has_angles && has_equal_steps && ring.size() < kMostWideTerms &&
      std::all_of(ring.begin(), ring.end(), [&](Index v) { return is_wide_enough(vertices[v]); });
  if (is_wide) return largest_component<Wide>(doubled_area<Wide>(vertices, ring), {1, 1, 1});
  if (const auto weights = rounded_weights(solid.lattice(), has_angles)) {
    if (const auto filtered = filtered_projection(vertices, ring, *weights)) return *filtered;
  }
  return largest_component<CGAL::Exact_rational>(doubled_area<CGAL::Exact_rational>(vertices, ring),
                                                 world_weights(solid.lattice(), has_angles));
}

}  // namespace watertight::tessellate
