// SPDX-License-Identifier: GPL-3.0-or-later
//
// Options and measures of smooth patches over holes.
#pragma once

#include <cstddef>

namespace watertight::repair {

struct CollarOptions {
  int rings = 2;               // of triangles around the hole
  double crease_degrees = 40;  // rings after the first end at edges that turn more
  std::size_t most_triangles = 20'000;
};

/// What users may ask for.
inline constexpr double kLeastDensity = 0.1;
inline constexpr double kMostDensity = 100;
inline constexpr int kMostRings = 10;

struct SmoothOptions {
  /// How far apart new vertices of the domain are at least, in lengths of the edges around the hole
  /// (spline/extend_triangulation.h): smaller gives more.
  double density = 1;
  double regularity = 0.7;
  CollarOptions collar;
  /// The largest distance in metres of the middle of an edge inside of the patch from the surface;
  /// 0: a twentieth of the mean edge of the border.
  double chord_metres = 0;
  bool keeps_lattice = false;  // new vertices are rounded to the lattice of the solid as it is
  bool keeps_surface = false;  // fill SmoothPatch::spline
  /// The domain has this many at most; its new vertices stand farther apart where it would have
  /// more.
  std::size_t most_triangles = 3000;
  std::size_t most_vertices = 200'000;  // of the patch
};

/// Measures of a patch. Lengths in metres, angles in degrees.
struct SmoothMeasures {
  std::size_t vertices = 0;  // new ones, at which the surface was sampled
  std::size_t unknowns = 0;
  double energy = 0;             // spline/thin_plate.h, of the hole; without a unit
  double condition = 0;          // estimate, of the system of the patch
  double stretch = 1;            // Flattened::stretch
  double value_jump = 0;         // of the surface across the border
  double normal_jump = 0;        // of its normal, likewise
  double border_distance = 0;    // of the surface from vertices of the border
  double least_curvature = 0;    // Gaussian, 1 / metres^2, at new vertices
  double largest_curvature = 0;  // likewise
  double mean_turn = 0;          // of the triangles across edges of the border
  double largest_turn = 0;       // likewise
};

}  // namespace watertight::repair
