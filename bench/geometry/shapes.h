// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangle soups for the benches of this folder: generated shapes whose size and difficulty are
// known by construction. All coordinates are integers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geometry/point.h"

namespace watertight::bench {

struct Soup {
  std::string name;
  std::vector<Point> points;
  std::vector<Triangle> triangles;
};

/// A closed sphere of about `count` triangles on the grid of a cube's faces, with an uneven radius.
Soup bumpy_sphere(std::size_t count);

/// A closed box of about `count` triangles; each of its six faces is a plane grid.
Soup grid_box(std::size_t count);

/// The front of a comb with `teeth` teeth, whose back is a fan around two corners.
Soup comb(std::size_t teeth);

/// `count` triangles around one vertex, on a cone.
Soup cone(std::size_t count);

/// A star with `count` thin spikes at all angles in one oblique plane; no vertex belongs to many
/// triangles.
Soup star(std::size_t count);

/// `count` long thin triangles, parallel to (1, 2, 3), which do not touch; each box overlaps most
/// others.
Soup diagonal_needles(std::size_t count);

/// `count` stacked parallel triangles across the diagonal: every box overlaps every other.
Soup oblique_sheets(std::size_t count);

/// `count` long thin triangles in all directions through one box, without any structure.
Soup random_needles(std::size_t count);

}  // namespace watertight::bench
