// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangles for a region between polygons, about as large as the edges around them.
//
// Based on: R. Pfeifle, H.-P. Seidel, Triangular B-Splines for Blending and Filling of Polygonal
// Holes, 1996, section 3.1 (Figure 3; the prose has its first comparison the other way round), and
// the method of Weatherill and Hassan that it names.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/result.h"
#include "spline/simplex_spline.h"

namespace watertight::spline {

struct ExtendOptions {
  /// How far a new vertex is from the corners of its triangle at least, in lengths of the edges
  /// around (the paper's alpha): smaller gives more triangles.
  double density = 1;
  /// How far new vertices of one round are from each other at least, likewise (the paper's beta).
  double regularity = 0.7;
  /// How often each new vertex is moved to the middle of its neighbours at the end. The triangles
  /// stay those before the first move.
  int smoothing_rounds = 0;
  std::size_t most_vertices = 1'000'000;
};

struct ExtendedTriangulation {
  std::vector<Point> vertices;      // those of the polygons in their order, then new ones
  std::vector<Triangle> triangles;  // each turns left and has its smallest number first; sorted
};

/// The region inside an odd number of the polygons; they may run either way. Each edge of a polygon
/// is one edge of the result. The triangles are constrained Delaunay. Errors: malformed, naming the
/// polygon that has fewer than three vertices, a number that is not finite or a repeated vertex, or
/// which crosses or touches another one or itself; limit_exceeded above most_vertices;
/// invalid_argument for options that are not positive. Cost: n log n for n vertices, typically.
Result<ExtendedTriangulation> extend_triangulation(std::span<const std::vector<Point>> polygons,
                                                   const ExtendOptions& options = {});

/// One polygon from pieces of it in their order: the end of each is joined to the start of the
/// next. A joining edge that is longer than the mean of its two neighbours is divided into equal
/// parts of about that length. Each piece has two points at least.
Result<std::vector<Point>> complete_boundary(std::span<const std::vector<Point>> pieces);

}  // namespace watertight::spline
