// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/verdict/families.h"

#include "bench/verdict/exact.h"

namespace watertight::verdict {
namespace {

constexpr std::array kFamilies{Family{"diagonals", make_diagonals},
                               Family{"hinges", make_hinge},
                               Family{"walls", make_walls},
                               Family{"prisms", make_prisms},
                               Family{"groups", make_group},
                               Family{"pits", make_pits},
                               Family{"touching_rings", make_touching_rings},
                               Family{"instances", make_instance},
                               Family{"placed_groups", make_placed_group},
                               Family{"large_integers", make_large_integers},
                               Family{"scales", make_scales},
                               Family{"general", make_general}};

Number volume(const Shell& shell) {
  Number sum = 0;
  for (const Facet& facet : shell) {
    for (const Ring& ring : facet) {
      for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
        sum += dot(exact(ring[0]), cross(exact(ring[k]), exact(ring[k + 1])));
      }
    }
  }
  return sum;
}

}  // namespace

std::span<const Family> families() { return kFamilies; }

Sample sample_of_seed(const Family& family, std::uint64_t seed) {
  std::uint64_t hash = 14695981039346656037ULL;  // the hash FNV-1a of the family's name
  for (const char* c = family.name; *c != 0; ++c) {
    hash = (hash ^ static_cast<unsigned char>(*c)) * 1099511628211ULL;
  }
  Random random(hash + seed * 0x9e3779b97f4a7c15ULL);
  return family.make(random);
}

Shell outward(Shell shell) {
  return sgn(volume(shell)) < 0 ? solids::inside_out(std::move(shell)) : shell;
}

Shell as_cavity(Shell shell) { return solids::inside_out(outward(std::move(shell))); }

Shell outward_tetrahedron(const std::array<Point, 4>& corners) {
  return outward(solids::tetrahedron(corners[0], corners[1], corners[2], corners[3]));
}

AffineMap integer_rotation(Random& random) {
  std::int64_t a = 0, b = 0, c = 0, d = 0;  // the four numbers of a quaternion
  do {
    a = random.between(-3, 3);
    b = random.between(-3, 3);
    c = random.between(-3, 3);
    d = random.between(-3, 3);
  } while (a * a + b * b + c * c + d * d == 0 || a * a + b * b + c * c + d * d > 20);
  AffineMap map;
  map.matrix = {{{a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)},
                 {2 * (b * c + a * d), a * a - b * b + c * c - d * d, 2 * (c * d - a * b)},
                 {2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d}}};
  for (std::int64_t& shift : map.shift) shift = random.between(-1'000'000, 1'000'000);
  return map;
}

AffineMap any_map(Random& random) {
  AffineMap map;
  if (!one_in(random, 3)) {
    map = one_in(random, 2) ? solids::unimodular_map(random, 5) : solids::general_map(random, 3);
  } else if (one_in(random, 2)) {
    map = solids::axis_permutation(random, one_in(random, 2));
  }
  if (one_in(random, 2)) {
    for (std::int64_t& entry : map.matrix[random.below(3)]) entry = -entry;
  }
  for (std::int64_t& shift : map.shift) {
    shift = one_in(random, 4) ? random.between(-1'000'000'000, 1'000'000'000) : 0;
  }
  return map;
}

Solid placed(const Shape& shape, const AffineMap& map, int exponent, Random& random) {
  Lattice lattice;
  lattice.step.fill(GridNumber{1, exponent});
  return solids::rewritten(solids::mapped(solids::solid_of(shape, lattice), map), random).solid;
}

Sample sample_of(Solid solid) {
  Sample sample;
  sample.members.push_back(std::move(solid));
  return sample;
}

Sample make_general(Random& random) {
  constexpr std::size_t kLargest = 40;
  while (true) {
    const std::uint64_t kind = random.below(3);
    const solids::Made made = kind == 0   ? solids::random_valid(random)
                              : kind == 1 ? solids::random_open(random)
                                          : solids::random_cavities(random);
    if (solids::facet_count(made.shape) > kLargest) continue;
    return sample_of(
        solids::rewritten(solids::solid_of(made.shape, solids::millimetres()), random).solid);
  }
}

}  // namespace watertight::verdict
