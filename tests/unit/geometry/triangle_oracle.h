// SPDX-License-Identifier: GPL-3.0-or-later
//
// An oracle for the triangle-triangle classification that shares no code with it: the common part
// is constructed in exact rationals (CGAL::intersection), and its dimension and the barycentric
// coordinates of its middle give the class. Also a source of triangle pairs, most of them
// degenerate.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "geometry/intersection/triangle_triangle.h"
#include "tests/random.h"

namespace watertight::test {

struct TrianglePair {
  std::array<Point, 6> points;
  Triangle first;
  Triangle second;
};

/// A pair of triangles, neither degenerate, on integers below 2^31: in general position, on tiny
/// grids, in one plane, with common vertices, with equal vertices of different index, or with
/// vertices placed on vertices, edges, planes and insides of the other triangle.
TrianglePair random_pair(Random& random);

/// The class of the pair by construction.
geometry::ContactClass constructed_class(const TrianglePair& pair);

/// Nothing if the classification agrees with the construction for both orders of the triangles and
/// for shuffled vertices, and if the box partition finds the pair exactly when it intersects; else
/// a description of the difference.
std::optional<std::string> disagreement(const TrianglePair& pair, Random& random);

}  // namespace watertight::test
