// SPDX-License-Identifier: GPL-3.0-or-later
//
// Families of solids that are hard to tetrahedralize: their boundaries are rarely part of the
// Delaunay tetrahedralization of their vertices. Made by seed, with integer coordinates only.
#pragma once

#include <span>

#include "tests/solids/shape.h"

namespace watertight::solids {

struct HardFamily {
  const char* name;
  /// A solid of the family. Most are valid; the exact tests tell which.
  Solid (*make)(Random& random);
};

/// twisted towers (Schönhardt's polyhedron is the smallest), Chazelle's polyhedra, cavities of all
/// these shapes, plates with holes, sets of cospherical points, needles, shells that touch,
/// terrains and stars, and solids near degeneracy on lattices of 2^50 steps.
std::span<const HardFamily> hard_families();

/// The solid of a seed; every machine makes the same one.
Solid hard_solid(const HardFamily& family, std::uint64_t seed);

}  // namespace watertight::solids
