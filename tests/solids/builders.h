// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shapes made by formula and by seed, on integer coordinates: shells that are valid by
// construction, and shapes whose truth an oracle must find.
#pragma once

#include <string>
#include <vector>

#include "tests/solids/shape.h"

namespace watertight::solids {

Shell box(const Point& low, const Point& high);
/// A prism over a simple polygon that turns counter-clockwise seen from above (z is ignored).
Shell prism(const Ring& outline, double low, double high);
/// A pyramid over a simple polygon, counter-clockwise seen from the apex; its base is one facet.
Shell pyramid(const Ring& base, const Point& apex);
/// Triangles from a ring of points to two tips: `top` is on the side from which it turns
/// counter-clockwise.
Shell bipyramid(const Ring& middle, const Point& top, const Point& bottom);
Shell tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d);
/// A house with a gable roof; the ridge runs along x.
Shell gable_house(double length, double width, double eaves, double ridge);
/// A box with `holes` square tunnels in a row from bottom to top: genus `holes`.
Shell pierced_box(std::size_t holes);
/// A box with a square tunnel: the rings at the bottom and at the top and the walls of the tunnel
/// are given to the caller as facets of the shell, in this order: bottom, top, 4 sides, 4 walls.
Shell tunnelled_box(const Point& low, const Point& high, const Point& hole_low,
                    const Point& hole_high);
/// A surface over a grid of heights with walls and a floor; triangles above.
Shell terrain(Random& random, std::size_t size, double step);
/// The boundary of the unit cubes (scaled by `size`) whose number is set, in an n x n x n grid;
/// squares as facets, all of them in one shell.
Shell voxels(const std::vector<bool>& is_filled, std::size_t n, double size);
/// Schönhardt's polyhedron: the smallest that needs a Steiner point.
Shell schoenhardt();
/// Chazelle's polyhedron: 2 n notches from above and below; needs many Steiner points.
Shell chazelle(int notches);
/// A closed surface of triangles that has only one side: a Klein bottle with an immersion that
/// crosses itself.
Shell klein_bottle();
/// A band with a half twist: not closed and not orientable.
Shell moebius_band();

struct Made {
  std::string family;
  Shape shape;
};
/// A valid solid, exactly planar, on integers below 2^20.
Made random_valid(Random& random);
/// A shape whose verdict is open: voxels, triangulated solids with vertices moved on a small grid,
/// boxes joined at random.
Made random_open(Random& random);
/// A cavity or two in a box, near, on or through each other and the walls.
Made random_cavities(Random& random);
/// Every facet with more than three corners becomes triangles (the canonical ones).
Shape triangulated(const Shape& shape);
/// `count` vertices moved by at most `reach` along each axis; all facets that use them follow.
Shape with_moved_vertices(const Shape& shape, Random& random, std::size_t count,
                          std::int64_t reach);

}  // namespace watertight::solids
