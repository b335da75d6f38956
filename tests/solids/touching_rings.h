// SPDX-License-Identifier: GPL-3.0-or-later
//
// Blocks with pits whose rims touch other rings of their facet: a vertex of one ring lies inside an
// edge of another. A block is valid if the facet across that edge has the vertex too.
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

/// One shape for each way in which rings touch, and for each way in which a touch is wrong.
std::vector<TouchingRings> touching_rings();

/// A block with pits in rows: some pits touch the outline, some each other, some the pits of the
/// front wall; notches of the outline touch pits. A few shapes have a facet across an edge that
/// lacks a vertex (302), or a row that cuts the upper facet in two (205).
TouchingRings random_touching_rings(Random& random);

/// A random block with one corner of the upper facet 3 mm higher: that facet is not planar, and
/// there is no finding 205.
TouchingRings uneven_touching_rings(Random& random);

}  // namespace watertight::solids
