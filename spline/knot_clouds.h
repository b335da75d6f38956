// SPDX-License-Identifier: GPL-3.0-or-later
//
// Knots for the vertices of a triangulation, placed one at a time.
//
// Based on: R. Pfeifle, H.-P. Seidel, Triangular B-Splines for Blending and Filling of Polygonal
// Holes, 1996, section 3.2. Addition: knots of a vertex on the border of a region lie beyond both
// border edges that meet there. Functions of what is put beyond the border are then 0 in the
// region, and the functions of the region sum up to 1 in all of it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "spline/simplex_spline.h"

namespace watertight::spline {

/// The knots of a vertex lie left of the line from one point to another one, which goes through the
/// vertex.
struct SideRule {
  Index vertex = 0;
  Point from;
  Point to;
};

struct CloudOptions {
  int degree = 2;
  std::uint64_t seed = 1;
  /// The distance of the last knot from its vertex, as a share of the vertex's shortest edge.
  double radius = 0.12;
  /// The least distance of a knot from lines through two knots of one function, as a share of its
  /// distance from its vertex. Where 50 places fail, this share and the distance are halved.
  double clearance = 0.15;
};

/// `degree` knots for each vertex, in the order of DomainArrays::clouds. The first vertices have
/// their knots already (`fixed`). Knots of others lie beyond the border edges of the triangles and
/// where `rules` want them. Each triangle must turn left. Errors: malformed, naming the vertex
/// whose knots find no place. Same input, same knots.
Result<std::vector<Point>> make_clouds(std::span<const Point> vertices,
                                       std::span<const Triangle> triangles,
                                       std::span<const Point> fixed = {},
                                       std::span<const SideRule> rules = {},
                                       const CloudOptions& options = {});

/// The vertices, of which those that have no knots yet and are not on a border are moved a little
/// (up to a twentieth of their shortest edge) where they are near a line through two fixed knots of
/// a function. Errors: malformed, naming the vertex that finds no place.
Result<std::vector<Point>> move_off_lines(std::span<const Point> vertices,
                                          std::span<const Triangle> triangles,
                                          std::span<const Point> fixed,
                                          const CloudOptions& options = {});

}  // namespace watertight::spline
