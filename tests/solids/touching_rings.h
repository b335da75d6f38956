// SPDX-License-Identifier: GPL-3.0-or-later
//
// Blocks with pits whose rims touch other rings of their facet: a vertex of one ring lies inside an
// edge of another. Valid where the facet across that edge has the vertex.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "tests/solids/shape.h"

namespace watertight::solids {

struct TouchingRings {
  std::string name;
  Shape shape;
  std::set<int> errors;
};

/// One shape for each way of touching, and for each way in which it is wrong.
std::vector<TouchingRings> touching_rings();

/// A block with pits in rows: some touch the outline, some each other, some the pits of the front
/// wall; notches of the outline touch pits. Now and then a facet across lacks a vertex (302) or a
/// row cuts the upper facet in two (205).
TouchingRings random_touching_rings(Random& random);

/// The same with one corner of the upper facet 3 mm higher: not planar, and no 205.
TouchingRings uneven_touching_rings(Random& random);

}  // namespace watertight::solids
