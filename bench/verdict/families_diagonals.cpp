// SPDX-License-Identifier: GPL-3.0-or-later
//
// Families in which the diagonal of a facet decides: diagonals of quadrilaterals that are not quite
// planar, and walls that cross along a diagonal. Lengths are in 0.01 mm before a rotation scales
// them by up to 20, so quadrilaterals stay within 8 mm of their planes.
#include <algorithm>
#include <cmath>

#include "bench/verdict/families.h"

namespace watertight::verdict {
namespace {

constexpr int kExponent = -5;

double off_plane(Random& random) {
  if (one_in(random, 4)) return 0;
  return random.within(-6, 6) * (one_in(random, 3) ? 6 : 1);
}

/// The fourth corner of a quadrilateral with the corners (0,0), (a,0), (0,b): a rectangle, or a
/// kite.
std::array<double, 2> fourth_corner(Random& random, double a, double b) {
  if (one_in(random, 3)) return {a, b};
  const double factor = random.within(60, 140) / 100;
  if (one_in(random, 2)) return {a * factor, b * factor};
  return {a * factor, b * random.within(60, 140) / 100};
}

/// A corner of three quadrilaterals, and a cavity with edges along their diagonals: if these are
/// diagonals of the surface too, the cavity seals the corner off.
Shape corner_and_cavity(Random& random) {
  const bool is_regular = one_in(random, 2);  // false: each corner has offsets of its own
  const auto length = [&] { return random.within(60, 200) * 100; };
  const double a = length();
  const double b = is_regular || one_in(random, 2) ? a : length();
  const double d = is_regular || one_in(random, 2) ? a : length();
  const double inset = off_plane(random);
  const auto off = [&] { return is_regular || one_in(random, 2) ? inset : off_plane(random); };
  const Point o{0, 0, 0};
  const Point pa{a, off(), off()};
  const Point pb{off(), b, off()};
  const Point pd{off(), off(), d};
  const double factor = random.within(90, 130) / 100;
  const auto fourth = [&](double u, double v) {
    return is_regular ? std::array{u * factor, v * factor} : fourth_corner(random, u, v);
  };
  const auto xy = fourth(a, b);
  const auto xz = fourth(a, d);
  const auto yz = fourth(b, d);
  const auto lift = [&] { return is_regular || one_in(random, 2) ? 0 : off(); };
  const Point ab{xy[0], xy[1], lift()};
  const Point ad{xz[0], lift(), xz[1]};
  const Point bd{lift(), yz[0], yz[1]};
  const double far = random.within(20, 30) / 10 * std::max({a, b, d});
  const Point e{far, far, far};
  const Shell outer{{{o, pb, ab, pa}}, {{o, pd, bd, pb}}, {{o, pa, ad, pd}},
                    {{e, ab, pb}},     {{e, pa, ab}},     {{e, bd, pd}},
                    {{e, pb, bd}},     {{e, ad, pa}},     {{e, pd, ad}}};
  const double inner = random.within(40, 80) / 100 * far;
  std::array<Point, 4> cavity{pa, pb, pd, Point{inner, inner, inner}};
  if (one_in(random, 6)) cavity[random.below(3)] = {a / 2, b / 2, d / 2};
  return {outer, as_cavity(outward_tetrahedron(cavity))};
}

/// A box whose corners are a little moved, so that no facet is planar, and an inscribed tetrahedron
/// as cavity, whose edges are one diagonal of each facet.
Shape box_and_inscribed(Random& random) {
  const std::array<double, 3> size{random.within(60, 200) * 100, random.within(60, 200) * 100,
                                   random.within(60, 200) * 100};
  const bool is_cube = one_in(random, 3);
  const double reach = one_in(random, 3) ? 0 : off_plane(random);
  std::array<Point, 8> p;
  for (std::size_t i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double length = size[is_cube ? 0 : static_cast<std::size_t>(axis)];
      const bool is_far = ((i >> static_cast<unsigned>(axis)) & 1U) != 0;
      p[i][axis] = (is_far ? length : 0) + reach * random.within(-1, 1);
    }
  }
  const Shell outer{{{p[0], p[2], p[3], p[1]}}, {{p[4], p[5], p[7], p[6]}},
                    {{p[0], p[1], p[5], p[4]}}, {{p[2], p[6], p[7], p[3]}},
                    {{p[0], p[4], p[6], p[2]}}, {{p[1], p[3], p[7], p[5]}}};
  std::array<Point, 4> cavity{p[0], p[3], p[5], p[6]};
  const Point middle{size[0] / 2, size[is_cube ? 0 : 1] / 2, size[is_cube ? 0 : 2] / 2};
  for (std::uint64_t k = random.below(3); k > 0; --k) {
    Point& corner = cavity[random.below(4)];
    corner = plus(corner, times(plus(middle, times(corner, -1)), 0.5));
    for (int axis = 0; axis < 3; ++axis) corner[axis] = std::trunc(corner[axis]);
  }
  return {outer, as_cavity(outward_tetrahedron(cavity))};
}

/// A loop of a figure eight: a prism over a polygon from the middle along two walls.
struct Loop {
  double low = 0;
  double high = 0;
  std::array<Point, 2> ends;   // the ends of the walls that run to the middle; ends[0] is on wall A
  std::vector<Point> between;  // further corners of the outline
};

Point at(const Point& p, double z) { return {p.x, p.y, z}; }

/// Appends top, bottom and outer walls of a loop; the two walls to the middle are still missing.
void append_loop(Shell& shell, const Loop& loop) {
  std::vector<Point> chain{loop.ends[0]};
  chain.insert(chain.end(), loop.between.begin(), loop.between.end());
  chain.push_back(loop.ends[1]);
  Ring top{{0, 0, loop.high}};
  Ring bottom{{0, 0, loop.low}};
  for (const Point& p : chain) {
    top.push_back(at(p, loop.high));
    bottom.push_back(at(p, loop.low));
  }
  shell.push_back({top});
  shell.push_back({solids::reversed(bottom)});
  for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
    shell.push_back({{at(chain[k], loop.low), at(chain[k + 1], loop.low),
                      at(chain[k + 1], loop.high), at(chain[k], loop.high)}});
  }
}

/// The wall of two loops, from the end of one through the middle to the end of the other.
/// `middle_points`: whether the ring has the points of the middle, at which the wall does not bend.
Ring wall(const Loop& first, const Loop& second, std::size_t end, bool middle_points) {
  const Point& p = first.ends[end];
  const Point& q = second.ends[end];
  const bool is_level_low = first.low == second.low;
  const bool is_level_high = first.high == second.high;
  Ring ring{at(p, first.low)};
  if (!is_level_low || middle_points) ring.push_back({0, 0, first.low});
  if (!is_level_low) ring.push_back({0, 0, second.low});
  ring.push_back(at(q, second.low));
  ring.push_back(at(q, second.high));
  if (!is_level_high || middle_points) ring.push_back({0, 0, second.high});
  if (!is_level_high) ring.push_back({0, 0, first.high});
  ring.push_back(at(p, first.high));
  return ring;
}

Loop loop_of(Random& random, const Point& on_a, const Point& on_b, bool is_level) {
  Loop loop;
  loop.low = is_level ? 0 : random.within(0, 4);
  loop.high = is_level ? 10 : random.within(6, 12);
  loop.ends = {on_a, on_b};
  if (one_in(random, 2)) loop.between.push_back(plus(on_a, on_b));
  return loop;
}

/// A prism over a loop, with two walls of its own.
Shell prism_of(const Loop& loop) {
  Shell shell;
  append_loop(shell, loop);
  const Point low{0, 0, loop.low};
  const Point high{0, 0, loop.high};
  const auto& [a, b] = loop.ends;
  shell.push_back({{low, at(a, loop.low), at(a, loop.high), high}});
  shell.push_back({{at(b, loop.low), low, high, at(b, loop.high)}});
  return shell;
}

/// A prism over a figure eight: two straight walls cross in the line above its middle, and one of
/// its loops is inside out. For comparison: one loop (valid), and two loops with walls of their own
/// (303).
Shape figure_eight(Random& random) {
  const Point u{random.within(3, 9), random.within(-2, 9), 0};
  const Point w{random.within(-2, 2), random.within(10, 14), 0};
  const bool is_level = one_in(random, 2);
  const auto length = [&](double sign) { return sign * random.within(1, 3); };
  const Loop right = loop_of(random, times(u, length(1)), times(w, length(1)), is_level);
  const Loop left = loop_of(random, times(u, length(-1)), times(w, length(-1)), is_level);
  if (one_in(random, 5)) return {prism_of(right)};
  if (one_in(random, 5)) return {solids::join(prism_of(right), prism_of(left))};
  Shell shell;
  append_loop(shell, left);
  shell = solids::inside_out(std::move(shell));
  append_loop(shell, right);
  shell.push_back({wall(left, right, 0, !one_in(random, 8))});
  shell.push_back({wall(right, left, 1, !one_in(random, 8))});
  return {outward(std::move(shell))};
}

}  // namespace

Sample make_diagonals(Random& random) {
  const Shape shape = one_in(random, 3) ? box_and_inscribed(random) : corner_and_cavity(random);
  AffineMap map = integer_rotation(random);
  if (one_in(random, 3)) map = solids::axis_permutation(random, one_in(random, 2));
  return sample_of(placed(shape, map, kExponent, random));
}

/// Two tetrahedra under a quadrilateral, whose diagonal from corner 1 to corner 3 is an edge of
/// both. If it is a diagonal of the surface too, the tetrahedra touch along it; if the other
/// diagonal is one, and is above, a thin hinge joins the tetrahedra.
Sample make_hinge(Random& random) {
  const auto length = [&] { return random.within(40, 200) * 100; };
  const double half = length();
  const double skew = one_in(random, 2) ? half : length();
  const double down = one_in(random, 2) ? half : length();
  const double up = one_in(random, 2) ? down : length();
  const double shift = one_in(random, 2) ? 0 : random.within(-30, 30) * 100;
  const std::array<Point, 4> quad{{{shift, -down, off_plane(random)},
                                   {half, 0, off_plane(random)},
                                   {-shift, up, off_plane(random)},
                                   {-skew, 0, off_plane(random)}}};
  const Point first{random.within(-30, 30) * 100, -down / 2, -length()};
  const Point second{random.within(-30, 30) * 100, up / 2, -length()};
  const Shell shell{{{quad[0], quad[1], quad[2], quad[3]}},
                    {{quad[0], quad[3], first}},
                    {{quad[0], first, quad[1]}},
                    {{quad[3], quad[1], first}},
                    {{quad[3], quad[2], second}},
                    {{quad[2], quad[1], second}},
                    {{quad[3], second, quad[1]}}};
  AffineMap map = integer_rotation(random);
  if (one_in(random, 3)) map = solids::axis_permutation(random, one_in(random, 2));
  return sample_of(placed({outward(shell)}, map, kExponent, random));
}

Sample make_walls(Random& random) {
  return sample_of(placed(figure_eight(random), any_map(random), -3, random));
}

}  // namespace watertight::verdict
