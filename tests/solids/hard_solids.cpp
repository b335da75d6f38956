// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solids/hard_solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/solids/builders.h"

namespace watertight::solids {
namespace {

/// The coordinates of families at most; maps keep them below 2^52, where integers are exact.
constexpr double kHugeLattice = 0x1p50;

/// A point at an angle (in 360ths of a circle) in a plane of constant z. The sine is rounded to
/// 1/4096, so that every machine makes the same integers.
Point around(double degrees, double radius, double z) {
  const double angle = degrees * std::numbers::pi / 180;
  const double x = std::round(std::cos(angle) * 4096);
  const double y = std::round(std::sin(angle) * 4096);
  return {std::round(x * radius / 4096), std::round(y * radius / 4096), z};
}

/// A prism over a regular polygon whose top is turned, with walls that fold inward along their long
/// diagonals; several of them stand on each other.
Shell twisted_tower(Random& random) {
  const std::size_t sides = 3 + random.below(6);
  const std::size_t storeys = 1 + random.below(3);
  const double radius = random.within(400, 4000);
  const double most_turn = 180.0 / static_cast<double>(sides);
  std::vector<Ring> rings;
  double turn = random.within(0, 359);
  double height = 0;
  for (std::size_t i = 0; i <= storeys; ++i) {
    Ring& ring = rings.emplace_back();
    for (std::size_t j = 0; j < sides; ++j) {
      ring.push_back(around(turn + 360.0 * static_cast<double>(j) / static_cast<double>(sides),
                            radius, height));
    }
    turn += most_turn * random.within(10, 90) / 100;
    height += random.within(50, 5000);
  }
  Shell shell{{reversed(rings.front())}, {rings.back()}};
  for (std::size_t i = 0; i < storeys; ++i) {
    const Ring& low = rings[i];
    const Ring& high = rings[i + 1];
    for (std::size_t j = 0; j < sides; ++j) {
      const std::size_t next = (j + 1) % sides;
      shell.push_back({{low[j], low[next], high[next]}});
      shell.push_back({{low[j], high[next], high[j]}});
    }
  }
  return shell;
}

/// A star-shaped polygon; its corners are seen from the origin at equal angles.
Ring star(Random& random, std::size_t corners, std::int64_t least, std::int64_t most) {
  Ring ring;
  for (std::size_t i = 0; i < corners; ++i) {
    ring.push_back(around(360.0 * static_cast<double>(i) / static_cast<double>(corners),
                          random.within(least, most), 0));
  }
  return ring;
}

/// A closed surface of triangles that is star-shaped around the origin.
Shell spiky_star(Random& random) {
  const std::size_t across = 1 + random.below(4);
  const std::size_t sides = 3 + random.below(6);
  std::vector<Ring> rings;
  for (std::size_t i = 0; i < across; ++i) {
    const double tilt = 180.0 * (static_cast<double>(i + 1) / static_cast<double>(across + 1)) - 90;
    Ring& ring = rings.emplace_back();
    for (std::size_t j = 0; j < sides; ++j) {
      const double radius = random.within(300, 3000);
      const Point flat = around(tilt, radius, 0);
      Point p = around(360.0 * static_cast<double>(j) / static_cast<double>(sides), flat.x, flat.y);
      ring.push_back(p);
    }
  }
  const Point bottom{0, 0, -random.within(300, 3000)};
  const Point top{0, 0, random.within(300, 3000)};
  Shell shell;
  for (std::size_t j = 0; j < sides; ++j) {
    const std::size_t next = (j + 1) % sides;
    shell.push_back({{rings.front()[next], rings.front()[j], bottom}});
    shell.push_back({{rings.back()[j], rings.back()[next], top}});
    for (std::size_t i = 0; i + 1 < across; ++i) {
      shell.push_back({{rings[i][j], rings[i][next], rings[i + 1][next]}});
      shell.push_back({{rings[i][j], rings[i + 1][next], rings[i + 1][j]}});
    }
  }
  return shell;
}

Shell moved(Shell shell, const Point& by) {
  for (Facet& facet : shell) {
    for (Ring& ring : facet) {
      for (Point& p : ring) p = {p.x + by.x, p.y + by.y, p.z + by.z};
    }
  }
  return shell;
}

/// The solid under a random integer map of determinant 1, which makes needles of what is round.
Solid sheared(const Shape& shape, Random& random, std::int64_t size) {
  const Solid solid = solid_of(shape, millimetres());
  if (size == 0) return solid;
  return mapped(solid, unimodular_map(random, size));
}

Solid make_twisted(Random& random) {
  return sheared({twisted_tower(random)}, random, static_cast<std::int64_t>(random.below(4)));
}

Solid make_chazelle(Random& random) {
  return sheared({chazelle(1 + static_cast<int>(random.below(3)))}, random,
                 static_cast<std::int64_t>(random.below(3)));
}

/// A box with a grid of cavities, each of which is a tower, a star or a tetrahedron.
Solid make_cavities(Random& random) {
  const std::size_t side = 1 + random.below(2);
  const double size = 16000 * static_cast<double>(side);
  Shape shape{box({0, 0, 0}, {size, size, size})};
  for (std::size_t i = 0; i < side * side * side; ++i) {
    if (i > 0 && random.below(3) == 0) continue;
    const auto place = [&](std::size_t step) {
      return 8000 + 16000 * static_cast<double>(i / step % side);
    };
    const Point middle{place(1), place(side), place(side * side)};
    switch (random.below(3)) {
      case 0: {
        Shell tower = twisted_tower(random);
        shape.push_back(inside_out(moved(tower, {middle.x, middle.y, middle.z - 7900})));
        break;
      }
      case 1:
        shape.push_back(inside_out(moved(spiky_star(random), middle)));
        break;
      default:
        shape.push_back(inside_out(
            moved(tetrahedron({-3000, -2000, -random.within(1, 4000)}, {3000, -1500, 0},
                              {0, random.within(100, 4000), 0}, {0, 0, random.within(1, 7000)}),
                  middle)));
    }
  }
  return solid_of(shape, millimetres());
}

/// A plate with star-shaped holes from bottom to top.
Solid make_plate(Random& random) {
  const std::size_t side = 1 + random.below(3);
  const double step = 400;
  const double size = step * static_cast<double>(side);
  const double height = random.within(1, 3000);
  Shell shell = box({0, 0, 0}, {size, size, height});
  for (std::size_t i = 0; i < side * side; ++i) {
    Shell hole = prism(star(random, 3 + random.below(8), 20, 190), 0, height);
    const Point middle{step * (static_cast<double>(i % side) + 0.5),
                       step * (static_cast<double>(i / side) + 0.5), 0};
    hole = inside_out(moved(hole, middle));
    // The lids of the hole are interior rings of the plate's bottom and top.
    shell[0].push_back(hole[0][0]);
    shell[1].push_back(hole[1][0]);
    shell.insert(shell.end(), hole.begin() + 2, hole.end());
  }
  return sheared({shell}, random, static_cast<std::int64_t>(random.below(3)));
}

/// Cells of a cubic grid, as squares or cut into triangles: most points lie on common spheres.
Solid make_cospherical(Random& random) {
  const std::size_t n = 2 + random.below(3);
  std::vector<bool> is_filled(n * n * n);
  for (std::size_t i = 0; i < is_filled.size(); ++i) is_filled[i] = random.below(8) < 6;
  Shell shell = voxels(is_filled, n, 64);
  if (shell.empty()) shell = box({0, 0, 0}, {64, 64, 64});
  Shape shape{shell};
  if (random.below(2) == 0) shape = triangulated(shape);
  return sheared(shape, random, 0);
}

/// Prisms and pyramids that are up to 2^30 times as high as wide, upright and sheared.
Solid make_needle(Random& random) {
  const Ring base = star(random, 3 + random.below(9), 10, 200);
  const double height = std::ldexp(1.0, static_cast<int>(8 + random.below(23)));
  const Shell shell = random.below(2) == 0
                          ? prism(base, 0, height)
                          : bipyramid(base, {random.within(-5, 5), random.within(-5, 5), height},
                                      {0, 0, -random.within(1, 1000)});
  return sheared({shell}, random, static_cast<std::int64_t>(random.below(40)));
}

Solid make_touching(Random& random) {
  return sheared(random_cavities(random).shape, random, static_cast<std::int64_t>(random.below(4)));
}

Solid make_surface(Random& random) {
  const Shell shell =
      random.below(2) == 0 ? terrain(random, 3 + random.below(6), 50) : spiky_star(random);
  return sheared({shell}, random, static_cast<std::int64_t>(random.below(3)));
}

/// A solid of another family that fills a lattice of 2^50 steps; each vertex of its triangles is
/// moved by a step at most, so that what was coplanar or cospherical is so no more, but nearly.
Solid make_huge(Random& random) {
  Shape shape;
  switch (random.below(4)) {
    case 0:
      shape = {twisted_tower(random)};
      break;
    case 1:
      shape = {spiky_star(random)};
      break;
    case 2:
      shape = random_valid(random).shape;
      break;
    default:
      shape = shape_of(make_cospherical(random));
  }
  double largest = 1;
  for (const Shell& shell : shape) {
    for (const Facet& facet : shell) {
      for (const Ring& ring : facet) {
        for (const Point& p : ring) {
          largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        }
      }
    }
  }
  const double factor = std::floor(kHugeLattice / largest);
  for (Shell& shell : shape) {
    for (Facet& facet : shell) {
      for (Ring& ring : facet) {
        for (Point& p : ring) p = {p.x * factor, p.y * factor, p.z * factor};
      }
    }
  }
  const Shape scaled = triangulated(shape);
  const std::size_t vertices = solid_of(scaled, millimetres()).vertex_count();
  return solid_of(with_moved_vertices(scaled, random, vertices, 1), millimetres());
}

constexpr std::array<HardFamily, 9> kFamilies{{{"twisted", make_twisted},
                                               {"chazelle", make_chazelle},
                                               {"cavities", make_cavities},
                                               {"plates", make_plate},
                                               {"cospherical", make_cospherical},
                                               {"needles", make_needle},
                                               {"touching", make_touching},
                                               {"surfaces", make_surface},
                                               {"huge", make_huge}}};

}  // namespace

std::span<const HardFamily> hard_families() { return kFamilies; }

Solid hard_solid(const HardFamily& family, std::uint64_t seed) {
  Random random(seed);
  return family.make(random);
}

}  // namespace watertight::solids
