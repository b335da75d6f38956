// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangles in space laid into the plane, and values carried from the border of triangles into
// their inside.
//
// Based on: B. Lévy, S. Petitjean, N. Ray, J. Maillot, Least Squares Conformal Maps for Automatic
// Texture Atlas Generation, 2002, section 2.
#pragma once

#include <span>
#include <vector>

#include "base/result.h"
#include "spline/simplex_spline.h"

namespace watertight::spline {

/// The places in the plane that keep the angles of triangles best, with the area of the triangles
/// in space. Two vertices far from each other are held. Triangles may turn over in the map: the
/// caller looks. Errors: malformed without a triangle that has an area, for a number that is not
/// finite, for a corner that is no vertex and where vertices or parts are in no triangle with
/// others. Cost: that of a sparse Cholesky factorization with two unknowns for each vertex.
Result<std::vector<Point>> conformal_map(std::span<const Point> places,
                                         std::span<const Triangle> triangles);

/// Gives each vertex after the first `values.size()` the mean of its neighbours' values; the first
/// ones keep theirs. Errors: malformed where a vertex is connected to none of these
/// and for a corner that is no vertex. Requires vertex_count of values.size() at least. Cost: that
/// of a sparse Cholesky factorization.
Result<std::vector<Point>> spread_inward(std::span<const Point> values, std::size_t vertex_count,
                                         std::span<const Triangle> triangles);

}  // namespace watertight::spline
