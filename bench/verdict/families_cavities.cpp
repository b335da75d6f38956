// SPDX-License-Identifier: GPL-3.0-or-later
//
// Families of cavities that touch other shells of their solid, and of pairs of solids that touch
// from within.
#include <algorithm>
#include <cmath>

#include "bench/verdict/exact.h"
#include "bench/verdict/families.h"

namespace watertight::verdict {
namespace {

constexpr std::int64_t kRoom = 24;

/// The points of a shell, each once.
std::vector<Point> corners_of(const Shell& shell) {
  std::set<Point> corners;
  for (const Facet& facet : shell) {
    for (const Ring& ring : facet) corners.insert(ring.begin(), ring.end());
  }
  return {corners.begin(), corners.end()};
}

template <class Move>
Shell moved(Shell shell, const Move& move) {
  for (Facet& facet : shell) {
    for (Ring& ring : facet) {
      for (Point& p : ring) p = move(p);
    }
  }
  return shell;
}

/// A bipyramid that touches the facets of the room in their middles, or nearly.
Shell octahedron(Random& random) {
  const double half = kRoom / 2;
  const auto reach = [&] { return one_in(random, 3) ? half - random.within(1, 6) : half; };
  const Ring middle{{half - reach(), half, half},
                    {half, half - reach(), half},
                    {half + reach(), half, half},
                    {half, half + reach(), half}};
  return outward(
      solids::bipyramid(middle, {half, half, half + reach()}, {half, half, half - reach()}));
}

Shell cavity_of_room(Random& random) {
  switch (random.below(4)) {
    case 0: {
      const double x = random.within(1, 8), y = random.within(1, 8), z = random.within(1, 8);
      return solids::box({x, y, z}, {x + 6, y + 8, z + 10});
    }
    case 1:
      return octahedron(random);
    default:
      return touching_tetrahedron(random, kRoom);
  }
}

/// A shell related to a cavity: equal, smaller about a corner, with one corner moved, or moved as a
/// whole.
Shell relative_of(const Shell& cavity, Random& random) {
  const std::vector<Point> corners = corners_of(cavity);
  const Point& pivot = corners[random.below(corners.size())];
  switch (random.below(5)) {
    case 0:
    case 1:
      return cavity;
    case 2:  // half as large, about a corner
      return moved(cavity, [&](const Point& p) { return times(plus(p, pivot), 0.5); });
    case 3: {  // another corner is moved towards the middle, or anywhere
      Point target = corners[random.below(corners.size())];
      target =
          one_in(random, 2)
              ? times(plus(target, pivot), 0.5)
              : plus(pivot, {random.within(-4, 4), random.within(-4, 4), random.within(-4, 4)});
      if (cavity.size() != 4) return cavity;
      return outward(moved(cavity, [&](const Point& p) { return p == pivot ? target : p; }));
    }
    default: {
      const Point shift{random.within(-3, 3), random.within(-3, 3), random.within(-3, 3)};
      return moved(cavity, [&](const Point& p) { return plus(p, shift); });
    }
  }
}

Shape second_member(const Shape& first, const Shell& cavity, Random& random) {
  switch (random.below(8)) {
    case 0:
      return first;
    case 1: {  // beside the room, with an area, an edge or a corner in common, or apart
      const auto place = [&] { return random.within(-1, 2) * kRoom / 2; };
      const Point low{random.within(0, 1) * kRoom + place(), place(), kRoom};
      return {solids::box(low, plus(low, {12, 12, 12}))};
    }
    case 2:
      return {touching_tetrahedron(random, kRoom)};
    default:
      return {relative_of(cavity, random)};
  }
}

Shape doubled(Shape shape, double factor) {
  for (Shell& shell : shape) {
    shell = moved(std::move(shell), [&](const Point& p) { return times(p, factor); });
  }
  return shape;
}

Ring square(double half, double z, bool is_diamond) {
  if (is_diamond) return {{half, 0, z}, {0, half, z}, {-half, 0, z}, {0, -half, z}};
  return {{half, -half, z}, {half, half, z}, {-half, half, z}, {-half, -half, z}};
}

}  // namespace

Shell touching_tetrahedron(Random& random, std::int64_t size) {
  while (true) {
    std::array<Point, 4> corners;
    for (Point& p : corners) {
      for (int axis = 0; axis < 3; ++axis) p[axis] = random.within(1, size / 2 - 1) * 2;
      if (one_in(random, 2))
        p[static_cast<int>(random.below(3))] = one_in(random, 2) ? 0 : static_cast<double>(size);
    }
    const Vector ab = difference(exact(corners[1]), exact(corners[0]));
    const Vector ac = difference(exact(corners[2]), exact(corners[0]));
    const Vector ad = difference(exact(corners[3]), exact(corners[0]));
    if (sgn(dot(ab, cross(ac, ad))) == 0) continue;
    bool shares_area = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {0.0, static_cast<double>(size)}) {
        int count = 0;
        for (const Point& p : corners) count += p[axis] == side ? 1 : 0;
        shares_area = shares_area || count > 2;
      }
    }
    if (!shares_area) return outward_tetrahedron(corners);
  }
}

Shape pit_and_cavity(Random& random) {
  const double rim = random.within(2, 4);
  const double half = rim + random.within(1, 6);
  const double rim_z = random.within(8, 12);
  const double top_z = rim_z + (one_in(random, 3) ? 0 : random.within(-2, 3));
  const double tip_z = rim_z - random.within(1, 4);
  const Point tip{random.within(-1, 1), random.within(-1, 1), tip_z};
  const Ring outer_low = square(half + 2, 0, false);
  const Ring outer_high = square(half + 2, top_z, false);
  const Ring hole = square(rim, rim_z, false);
  Shell room{{solids::reversed(outer_low)}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t after = (k + 1) % 4;
    room.push_back({{outer_low[k], outer_low[after], outer_high[after], outer_high[k]}});
    if (top_z != rim_z) {
      room.push_back({{outer_high[k], outer_high[after], hole[after], hole[k]}});
    }
    room.push_back({{hole[k], hole[after], tip}});
  }
  if (top_z == rim_z) room.push_back({outer_high, solids::reversed(hole)});
  const bool is_diamond = one_in(random, 3);
  const double cavity_half = one_in(random, 3) ? rim : random.within(1, 8);
  double cavity_z = one_in(random, 2) ? rim_z : random.within(3, static_cast<int>(rim_z) + 1);
  const Point low{0, 0, std::min(cavity_z - 1, random.within(0, 5))};
  const Ring ring = square(cavity_half, cavity_z, is_diamond);
  if (one_in(random, 3)) {  // the cavity has a tip above, at the pit's tip or near it
    const Point high = one_in(random, 2) ? tip : Point{0, 0, cavity_z + random.within(1, 3)};
    if (high.z > cavity_z) return {room, as_cavity(solids::bipyramid(ring, high, low))};
  }
  return {room, as_cavity(solids::pyramid(solids::reversed(ring), low))};
}

Sample make_pits(Random& random) {
  return sample_of(placed(pit_and_cavity(random), any_map(random), -3, random));
}

Sample make_group(Random& random) {
  const double size = kRoom;
  const Shell cavity = cavity_of_room(random);
  Shape first{solids::box({0, 0, 0}, {size, size, size}), as_cavity(cavity)};
  Shape second = second_member(first, cavity, random);
  if (one_in(random, 4)) std::swap(first, second);
  const AffineMap map = any_map(random);
  Sample sample;
  for (const Shape& shape : {first, second}) {
    sample.members.push_back(placed(doubled(shape, 2), map, -3, random));
  }
  sample.group = one_in(random, 2) ? validate::GroupKind::composite_solid
                                   : validate::GroupKind::building_parts;
  return sample;
}

}  // namespace watertight::verdict
