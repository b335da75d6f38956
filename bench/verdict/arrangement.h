// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arrangement of plane polygons in space as a cell complex: all polygons are cut along each
// other, exactly and by definition (all pairs, rational numbers), into regions, edges and points.
// For small solids; it shares no code with the product's geometry.
#pragma once

#include <vector>

#include "bench/verdict/exact.h"

namespace watertight::verdict {

/// A polygon with holes in a plane: the points between its rings by the even-odd rule.
struct Piece {
  std::size_t facet = 0;  // any number of the facet that has the piece
  std::vector<std::vector<Vector>> rings;
};

/// An open, connected part of a plane that no polygon crosses; all of it belongs to the same
/// facets.
struct Region {
  std::vector<std::size_t> facets;  // the facets that contain the region, sorted
  // The edges of the boundary; twice if the region is on both sides.
  std::vector<std::size_t> edges;
  Vector sample;  // a point of the region
};
/// A place where a region meets a point between two edges of its boundary.
struct Corner {
  std::size_t point = 0;
  std::array<std::size_t, 2> edges{};
  std::size_t region = 0;
};
/// A point inside a region that no edge in its plane reaches.
struct LonePoint {
  std::size_t point = 0;
  std::size_t region = 0;
};
/// The cells of the union of all pieces.
struct Complex {
  std::vector<Vector> points;
  // For each edge, its points, the smaller index first.
  std::vector<std::array<std::size_t, 2>> edges;
  std::vector<Region> regions;
  std::vector<Corner> corners;
  std::vector<LonePoint> lone_points;
};

/// The complex of pieces. Requires that the points of each piece lie in one plane and that it has
/// an area.
Complex arrange(const std::vector<Piece>& pieces);

enum class Side { outside, boundary, inside };
/// The place of a point in the plane of a piece. `axis` is a coordinate in which the normal of the
/// plane is not zero, and which is ignored.
Side locate_in(const Piece& piece, const Vector& p, int axis);
/// A coordinate in which the normal of the piece is not zero.
int dropped_axis(const Piece& piece);

/// The number of components of space without the complex: 1 + the dimension of its second homology
/// over the field of two elements (Alexander duality). A 2-cycle contains all of a region or
/// nothing, so regions with holes need no triangulation.
std::size_t complement_components(const Complex& complex);

}  // namespace watertight::verdict
