// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shapes made by formula and by seed, with integer coordinates: shells that are valid by
// construction, and shapes whose verdict an oracle must find.
#pragma once

#include <string>
#include <vector>

#include "tests/solids/shape.h"

namespace watertight::solids {

Shell box(const Point& low, const Point& high);
/// A prism over a simple polygon that turns counter-clockwise seen from above (its z is ignored).
Shell prism(const Ring& outline, double low, double high);
/// A pyramid over a simple polygon that turns counter-clockwise seen from the apex; its base is one
/// facet.
Shell pyramid(const Ring& base, const Point& apex);
/// Triangles from a ring of points to two tips; seen from `top`, the ring turns counter-clockwise.
Shell bipyramid(const Ring& middle, const Point& top, const Point& bottom);
Shell tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d);
/// A house with a gable roof; the ridge runs along x.
Shell gable_house(double length, double width, double eaves, double ridge);
/// A box with `holes` square tunnels in a row from bottom to top: genus `holes`.
Shell pierced_box(std::size_t holes);
/// A box with a square tunnel. Its facets come in the order: bottom, top, 4 sides, 4 walls of the
/// tunnel; the bottom and the top have the tunnel as a hole.
Shell tunnelled_box(const Point& low, const Point& high, const Point& hole_low,
                    const Point& hole_high);
/// A surface of triangles over a grid of random heights, with walls and a floor.
Shell terrain(Random& random, std::size_t size, double step);
/// The boundary of the filled cells (cubes of side `size`) of an n x n x n grid, as one shell; its
/// facets are squares.
Shell voxels(const std::vector<bool>& is_filled, std::size_t n, double size);
/// Schönhardt's polyhedron: the smallest polyhedron that needs a Steiner point.
Shell schoenhardt();
/// Chazelle's polyhedron: 2 n notches from above and below; it needs many Steiner points.
Shell chazelle(int notches);
/// A closed surface of triangles with only one side: a Klein bottle, which crosses itself.
Shell klein_bottle();
/// A band with a half twist: it is neither closed nor orientable.
Shell moebius_band();

struct Made {
  std::string family;
  Shape shape;
};
/// A valid solid, exactly planar, on integers below 2^20.
Made random_valid(Random& random);
/// A shape whose verdict is not known: voxels, triangulated solids with vertices moved on a small
/// grid, boxes joined at random.
Made random_open(Random& random);
/// A box with one or two cavities, which are near, on or through each other and the walls.
Made random_cavities(Random& random);
/// The shape with every facet of more than three corners cut into its canonical triangles.
Shape triangulated(const Shape& shape);
/// The shape with `count` vertices moved by at most `reach` along each axis; all facets with these
/// vertices change.
Shape with_moved_vertices(const Shape& shape, Random& random, std::size_t count,
                          std::int64_t reach);

}  // namespace watertight::solids
