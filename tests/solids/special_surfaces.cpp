// SPDX-License-Identifier: GPL-3.0-or-later
//
// Surfaces with a name: Schönhardt's and Chazelle's polyhedra, a Klein bottle, a Moebius band.
#include <algorithm>

#include "tests/solids/builders.h"

namespace watertight::solids {

Shell schoenhardt() {
  // E. Schönhardt, 1928: a prism whose upper triangle is turned by 30 degrees and whose walls fold
  // inward along their long diagonals.
  const Ring low{{20000, 10000, 0}, {5000, 18660, 0}, {5000, 1340, 0}};
  const Ring high{{18660, 15000, 9000}, {1340, 15000, 9000}, {10000, 0, 9000}};
  Shell shell{{reversed(low)}, {high}};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    shell.push_back({{low[i], low[next], high[next]}});
    shell.push_back({{low[i], high[next], high[i]}});
  }
  return shell;
}

Shell chazelle(int notches) {
  // Based on: B. Chazelle, Convex partitions of polyhedra, 1984. Notches cut from above reach the
  // surface z = x y, those from below z = x y + 1; the two kinds cross at right angles. Departure:
  // the notches are folded quadrilaterals written as triangles, and two units apart at their
  // ridges.
  const int n = notches;
  const double size = 4.0 * n;
  const double height = 8.0 * size * size;
  const auto ridge = [&](double x, double y, double offset) { return Point{x, y, x * y + offset}; };
  Shell shell;
  const auto add = [&](const Ring& ring) { shell.push_back({ring}); };
  // The outlines of the roof and the floor along the sides, for the walls.
  Ring front, back, left, right;
  // The roof: between two ridges that run along y, the surface rises to `height` and falls again.
  for (int i = 0; i < n; ++i) {
    const double x = 4.0 * i + 2;
    const Point low_front = ridge(x, 0, 2), low_back = ridge(x, size, 2);
    const Point a{x - 2, 0, height}, b{x - 2, size, height};
    const Point c{x + 2, 0, height}, d{x + 2, size, height};
    add({a, low_front, low_back});
    add({a, low_back, b});
    add({low_front, c, d});
    add({low_front, d, low_back});
    front.push_back(a);
    front.push_back(low_front);
    back.push_back(b);
    back.push_back(low_back);
  }
  front.push_back({size, 0, height});
  back.push_back({size, size, height});
  // The floor: its ridges run along x.
  for (int j = 0; j < n; ++j) {
    const double y = 4.0 * j + 2;
    const Point high_left = ridge(0, y, 0), high_right = ridge(size, y, 0);
    const Point a{0, y - 2, -height}, b{size, y - 2, -height};
    const Point c{0, y + 2, -height}, d{size, y + 2, -height};
    add({high_left, high_right, b});
    add({a, high_left, b});
    add({c, d, high_right});
    add({high_left, c, high_right});
    left.push_back(a);
    left.push_back(high_left);
    right.push_back(b);
    right.push_back(high_right);
  }
  left.push_back({0, size, -height});
  right.push_back({size, size, -height});
  // The walls: front y = 0 and back y = size end in the zigzag of the roof, left and right in that
  // of the floor.
  Ring wall = reversed(front);
  wall.push_back({0, 0, -height});
  wall.push_back({size, 0, -height});
  add(wall);
  wall = back;
  wall.push_back({size, size, -height});
  wall.push_back({0, size, -height});
  add(wall);
  wall = left;
  wall.push_back({0, size, height});
  wall.push_back({0, 0, height});
  add(reversed(wall));
  wall = reversed(right);
  wall.push_back({size, 0, height});
  wall.push_back({size, size, height});
  add(reversed(wall));
  return shell;
}

Shell moebius_band() {
  // Six squares around a hexagon; between the last and the first square the two rims are exchanged.
  const std::vector<Point> inner{{20, 0, 0},  {10, 18, 2},   {-10, 18, 4},
                                 {-20, 0, 6}, {-10, -18, 8}, {10, -18, 10}};
  const std::vector<Point> outer{{30, 0, 10}, {15, 27, 14},  {-15, 27, 10},
                                 {-32, 0, 8}, {-16, -29, 4}, {17, -30, 1}};
  Shell shell;
  for (std::size_t i = 0; i < 6; ++i) {
    Point next_inner = inner[(i + 1) % 6];
    Point next_outer = outer[(i + 1) % 6];
    if (i == 5) std::swap(next_inner, next_outer);
    shell.push_back({{inner[i], outer[i], next_outer}});
    shell.push_back({{inner[i], next_outer, next_inner}});
  }
  return shell;
}

Shell klein_bottle() {
  // A grid of 6 x 6 whose rows close as rings; the columns close after a reflection of the ring.
  constexpr std::size_t n = 6;
  static constexpr std::array<std::array<int, 2>, n> kRing{
      {{10, 0}, {5, 9}, {-5, 9}, {-10, 0}, {-5, -9}, {5, -9}}};
  const auto at = [&](std::size_t i, std::size_t j) {
    if (i == n) {
      i = 0;
      j = (n - j) % n;
    }
    const auto& around = kRing[i];
    const auto& across = kRing[j % n];
    const int turn = static_cast<int>(i);
    // Each ring is a little skewed, so that no four rings lie in a common plane.
    return Point{double(around[0] * (30 + across[0])), double(around[1] * (30 + across[0])),
                 double(across[1] * (10 - turn) + turn * turn)};
  };
  Shell shell;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      shell.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      shell.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  return shell;
}

}  // namespace watertight::solids
