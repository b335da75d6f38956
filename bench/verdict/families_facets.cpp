// SPDX-License-Identifier: GPL-3.0-or-later
//
// Families in which rings of one facet touch, or an edge of a hole lies in the middle of a facet.
#include <algorithm>
#include <cmath>
#include <set>

#include "bench/verdict/families.h"

namespace watertight::verdict {
namespace {

Point lifted(const Point& p, double z) { return {p.x, p.y, z}; }

double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// True if p is inside the segment from a to b; all three are in one horizontal plane.
bool is_inside_edge(const Point& p, const Point& a, const Point& b) {
  const double along = (p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y);
  const double length = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
  return turn(a, b, p) == 0 && along > 0 && along < length;
}

Ring counter_clockwise(Ring ring) {
  double area = 0;
  for (std::size_t k = 1; k + 1 < ring.size(); ++k) area += turn(ring[0], ring[k], ring[k + 1]);
  return area < 0 ? solids::reversed(std::move(ring)) : ring;
}

/// The ring with those of the points inserted that lie inside its edges and for which `takes` is
/// true.
template <class Takes>
Ring with_points(const Ring& ring, const std::vector<Point>& points, const Takes& takes) {
  Ring result;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Point& a = ring[k];
    const Point& b = ring[(k + 1) % ring.size()];
    std::vector<Point> on;
    for (const Point& p : points) {
      if (is_inside_edge(p, a, b) && takes(p)) on.push_back(p);
    }
    std::sort(on.begin(), on.end(), [&](const Point& p, const Point& q) {
      return std::abs(p.x - a.x) + std::abs(p.y - a.y) < std::abs(q.x - a.x) + std::abs(q.y - a.y);
    });
    result.push_back(a);
    result.insert(result.end(), on.begin(), on.end());
  }
  return result;
}

/// The polygon of a hole in the square from (0,0) to (size,size), counter-clockwise: its first
/// point is on the side y = 0, or `clear` away from it.
Ring hole_outline(Random& random, double size, double clear) {
  const double x = random.within(3, 9);
  const double y = random.within(4, 8);
  Ring ring{{x, clear, 0}, {x + random.within(1, 2), y - 1, 0}};
  if (one_in(random, 2)) ring.push_back({x, y + random.within(1, 3), 0});
  ring.push_back({x - random.within(1, 2), one_in(random, 2) ? y - 1 : y, 0});
  for (Point& p : ring) p = {std::min(p.x, size - 1), p.y, 0};
  return counter_clockwise(std::move(ring));
}

/// Appends the walls of a hole from its upper outline to its lower one, turned towards the hole;
/// walls that are not upright become triangles.
void append_hole_walls(Shell& shell, const Ring& upper, const Ring& lower) {
  for (std::size_t k = 0; k < upper.size(); ++k) {
    const std::size_t after = (k + 1) % upper.size();
    if (upper[k].y == lower[k].y && upper[after].y == lower[after].y) {
      shell.push_back({{upper[k], upper[after], lower[after], lower[k]}});
    } else {
      shell.push_back({{upper[k], upper[after], lower[after]}});
      shell.push_back({{upper[k], lower[after], lower[k]}});
    }
  }
}

Ring lifted(Ring ring, double z) {
  for (Point& p : ring) p.z = z;
  return ring;
}

/// The side y = 0 of a box, with the given points of its upper and lower edge.
Ring front(double size, double height, const std::vector<Point>& upper,
           const std::vector<Point>& lower) {
  const auto all = [](const Point&) { return true; };
  Ring ring = with_points({{0, 0, 0}, {size, 0, 0}}, lower, all);
  ring = {ring.begin(), std::find(ring.begin(), ring.end(), Point{size, 0, 0}) + 1};
  const Ring top = with_points({{size, 0, height}, {0, 0, height}}, upper, all);
  for (const Point& p : top) {
    ring.push_back(p);
    if (p == Point{0, 0, height}) break;
  }
  return ring;
}

/// The points to insert into the ring of the front: most points of the rings above and below it,
/// and some of the hole's upper outline.
std::vector<Point> points_in_front(Random& random, const Ring& upper,
                                   std::initializer_list<const Ring*> neighbours) {
  std::set<Point> found;
  for (const Ring* ring : neighbours) {
    for (const Point& p : *ring) {
      if (p.y == 0 && !one_in(random, 10)) found.insert(p);
    }
  }
  for (const Point& p : upper) {
    if (one_in(random, 2)) found.insert(p);
  }
  return {found.begin(), found.end()};
}

/// A block with a hole from its top: through the block, to some depth, or narrowing so that it
/// leaves the front at once. The ring of the front may or may not have the points where the hole
/// meets it.
Shell pierced_block(Random& random) {
  const double size = 12;
  const double height = random.within(4, 12);
  const bool is_through = one_in(random, 2);
  const bool narrows = one_in(random, 3);
  const Ring outline = hole_outline(random, size, one_in(random, 4) ? 1 : 0);
  const double floor = is_through ? 0 : random.within(1, 3);
  Ring lower = lifted(outline, floor);
  if (narrows) {
    for (Point& p : lower) p.y = std::max(p.y, 2.0);
    if (lower[0].y == lower[1].y) lower[0].y = 1;  // keeps the area of the ring above zero
  }
  const Ring upper = lifted(outline, height);
  const auto some = [&](const Point&) { return !one_in(random, 3); };
  const Ring top_outer{{0, 0, height}, {size, 0, height}, {size, size, height}, {0, size, height}};
  const Ring bottom_outer{{0, 0, 0}, {0, size, 0}, {size, size, 0}, {size, 0, 0}};
  Facet top{with_points(top_outer, upper, some), solids::reversed(upper)};
  Facet bottom{is_through ? with_points(bottom_outer, lower, some) : bottom_outer};
  if (is_through) bottom.push_back(lower);
  const std::vector<Point> in_front = points_in_front(random, upper, {&top[0], &bottom[0]});
  std::vector<Point> above;
  std::vector<Point> below;
  for (const Point& p : in_front) (p.z == 0 ? below : above).push_back(p);
  Shell shell{std::move(top), std::move(bottom), {front(size, height, above, below)}};
  shell.push_back({{{size, 0, 0}, {size, size, 0}, {size, size, height}, {size, 0, height}}});
  shell.push_back({{{size, size, 0}, {0, size, 0}, {0, size, height}, {size, size, height}}});
  shell.push_back({{{0, size, 0}, {0, 0, 0}, {0, 0, height}, {0, size, height}}});
  append_hole_walls(shell, upper, lower);
  if (!is_through) shell.push_back({lower});
  return shell;
}

/// The ring of a hole in the square of a top facet; more corners than by chance are on the outline
/// or on other rings.
Ring random_hole(Random& random, double size, const std::vector<Ring>& others) {
  const double x = random.within(3, 9);
  const double y = random.within(3, 9);
  const double reach = random.within(1, 3);
  Ring ring{{x - reach, y - reach, 0},
            {x + reach, y - random.within(0, 2), 0},
            {x + random.within(0, 2) - 1, y + reach, 0}};
  if (one_in(random, 2)) ring = {ring[0], ring[1], {x + reach, y + reach, 0}, ring[2]};
  for (Point& p : ring) {
    if (!one_in(random, 4)) continue;
    const Ring& other = others[random.below(others.size())];
    const std::size_t k = random.below(other.size());
    const Point middle = times(plus(other[k], other[(k + 1) % other.size()]), 0.5);
    p = one_in(random, 3) ? other[k] : Point{std::trunc(middle.x), std::trunc(middle.y), 0};
    if (one_in(random, 3)) p.y = 0;
  }
  for (Point& p : ring) {
    p.x = std::clamp(p.x, one_in(random, 12) ? -1.0 : 0.0, size);
    p.y = std::clamp(p.y, 0.0, size);
  }
  return counter_clockwise(std::move(ring));
}

std::vector<Point> all_points(const std::vector<Ring>& rings) {
  std::set<Point> points;
  for (const Ring& ring : rings) points.insert(ring.begin(), ring.end());
  return {points.begin(), points.end()};
}

/// The mean of the points of a ring, at the height z.
Point tip_of(const Ring& ring, double z) {
  Point tip{0, 0, 0};
  for (const Point& p : ring) tip = plus(tip, p);
  return lifted(times(tip, 1.0 / static_cast<double>(ring.size())), z);
}

/// A box whose top facet has pits with a tip each; the rings of the pits touch each other and the
/// outline, and the facets across may or may not have the points of contact.
Shell box_with_pits(Random& random) {
  const double size = 12;
  const double top = 12;
  std::vector<Ring> rings{{{0, 0, 0}, {size, 0, 0}, {size, size, 0}, {0, size, 0}}};
  for (std::uint64_t k = 1 + random.below(3); k > 0; --k) {
    rings.push_back(random_hole(random, size, rings));
  }
  const std::vector<Point> points = all_points(rings);
  const std::uint64_t rare = one_in(random, 4) ? 3 : 40;
  const auto across = [&](const Point&) { return !one_in(random, rare); };
  const auto here = [&](const Point&) { return one_in(random, 3); };
  Shell shell;
  Facet facet;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const Ring own = lifted(with_points(rings[i], points, here), top);
    facet.push_back(i == 0 ? own : solids::reversed(own));
    const Point tip = tip_of(rings[i], top - 3);
    for (std::size_t k = 0; k < rings[i].size(); ++k) {
      const Point& a = rings[i][k];
      const Point& b = rings[i][(k + 1) % rings[i].size()];
      Ring side = with_points({a, b}, points, across);
      side.erase(std::find(side.begin(), side.end(), b) + 1, side.end());
      side = lifted(std::move(side), top);
      if (i == 0) {
        side = solids::reversed(std::move(side));
        side.push_back(lifted(a, 0));
        side.push_back(lifted(b, 0));
      } else {
        side.push_back(tip);
      }
      shell.push_back({std::move(side)});
    }
  }
  shell.push_back(std::move(facet));
  shell.push_back({solids::reversed(rings[0])});
  return shell;
}

Shell scaled(Shell shell, double factor) {
  for (Facet& facet : shell) {
    for (Ring& ring : facet) {
      for (Point& p : ring) {
        p = times(p, factor);
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis]);
      }
    }
  }
  return shell;
}

}  // namespace

Sample make_prisms(Random& random) {
  return sample_of(placed({pierced_block(random)}, any_map(random), -3, random));
}

Sample make_touching_rings(Random& random) {
  // The factor 12 makes tips whole, which are thirds and quarters of whole numbers.
  return sample_of(placed({scaled(box_with_pits(random), 12)}, any_map(random), -3, random));
}

}  // namespace watertight::verdict
