// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arrangement of plane polygons in space as a cell complex: all polygons are cut along each
// other, exactly and by definition (all pairs, rational numbers), into regions, edges and points.
// For small solids; nothing is shared with the product's geometry.
#pragma once

#include <vector>

#include "bench/verdict/exact.h"

namespace watertight::verdict {

/// A polygon with holes in a plane; the points between its rings by the even-odd rule.
struct Piece {
  std::size_t facet = 0;  // the facet that it is a part of, by any number
  std::vector<std::vector<Vector>> rings;
};

/// An open, connected part of a plane that no polygon crosses; all of it is in the same facets.
struct Region {
  std::vector<std::size_t> facets;  // sorted
  std::vector<std::size_t> edges;   // of its boundary; twice when both sides are in the region
  Vector sample;                    // a point of the region
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
  std::vector<std::array<std::size_t, 2>> edges;  // the smaller point index first
  std::vector<Region> regions;
  std::vector<Corner> corners;
  std::vector<LonePoint> lone_points;
};

/// Requires pieces whose points lie in one plane and that have an area.
Complex arrange(const std::vector<Piece>& pieces);

enum class Side { outside, boundary, inside };
/// Where a point of the plane of a piece is. `axis` is a coordinate in which the plane's normal is
/// not zero: it is ignored.
Side locate_in(const Piece& piece, const Vector& p, int axis);
/// A coordinate in which the piece's normal is not zero.
int dropped_axis(const Piece& piece);

/// The components of what remains of space without the complex: 1 + the dimension of its second
/// homology over the field of two elements (Alexander duality). A 2-cycle holds all of a region or
/// nothing, so regions with holes need not be triangulated.
std::size_t complement_components(const Complex& complex);

}  // namespace watertight::verdict
