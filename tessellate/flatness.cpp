// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/flatness.h"

#include <cmath>
#include <optional>

#include "geometry/predicates/predicates.h"

namespace watertight::tessellate {
namespace {

__extension__ using Wide = __int128;
/// A sum of six products of three differences below this value stays below 2^127.
constexpr std::int64_t kMostDifference = std::int64_t{1} << 40U;

/// The difference b - a if both points are integers and the difference is small; else nothing.
std::optional<std::array<std::int64_t, 3>> integer_difference(const Point& a, const Point& b) {
  std::array<std::int64_t, 3> result{};
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double kExact = 9007199254740992.0;  // 2^53: neither cast nor difference overflows
    if (!(std::abs(a[axis]) < kExact) || !(std::abs(b[axis]) < kExact)) return std::nullopt;
    const auto from = static_cast<std::int64_t>(a[axis]);
    const auto to = static_cast<std::int64_t>(b[axis]);
    if (static_cast<double>(from) != a[axis] || static_cast<double>(to) != b[axis]) {
      return std::nullopt;
    }
    if (std::abs(to - from) >= kMostDifference) return std::nullopt;
    result[static_cast<std::size_t>(axis)] = to - from;
  }
  return result;
}

/// The vertices of all rings of a facet, in order.
std::span<const Index> corners_of(const Solid& solid, Index facet) {
  const SolidArrays& arrays = solid.arrays();
  const IndexRange rings = solid.rings_of(facet);
  const Index begin = arrays.ring_offsets[rings.begin];
  return std::span<const Index>(arrays.ring_vertices)
      .subspan(begin, arrays.ring_offsets[rings.end] - begin);
}

}  // namespace

bool are_coplanar(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto u = integer_difference(a, b);
  const auto v = integer_difference(a, c);
  const auto w = integer_difference(a, d);
  if (!u || !v || !w) return geometry::orient3d(a, b, c, d) == 0;
  const auto minor = [&](std::size_t i, std::size_t j) {
    return Wide{(*u)[i]} * (*v)[j] - Wide{(*u)[j]} * (*v)[i];
  };
  return minor(1, 2) * (*w)[0] + minor(2, 0) * (*w)[1] + minor(0, 1) * (*w)[2] == 0;
}

bool is_flat(const Solid& solid, Index facet) {
  const std::span<const Index> corners = corners_of(solid, facet);
  const auto at = [&](std::size_t i) -> const Point& { return solid.vertices()[corners[i]]; };
  std::size_t b = 1;
  while (b < corners.size() && at(b) == at(0)) ++b;
  std::size_t c = b + 1;
  while (c < corners.size() &&
         (at(c) == at(0) || at(c) == at(b) || geometry::are_collinear(at(0), at(b), at(c)))) {
    ++c;
  }
  for (std::size_t i = c + 1; i < corners.size(); ++i) {
    if (!are_coplanar(at(0), at(b), at(c), at(i))) return false;
  }
  return true;
}

}  // namespace watertight::tessellate
