// SPDX-License-Identifier: GPL-3.0-or-later
//
// The four scenes of the paper on triangular B-splines: old surfaces given by formula, holes
// between them, and the closed solid that a sampled scene bounds.
//
// Based on: R. Pfeifle, H.-P. Seidel, Triangular B-Splines for Blending and Filling of Polygonal
// Holes, 1996, Figures 8 to 11. The paper states no measures; these are ours.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "geometry/solid.h"
#include "spline/dms_surface.h"
#include "spline/thin_plate.h"

namespace watertight::samples {

using spline::Index;
using spline::Point;
using spline::Triangle;
using Polygon = std::vector<Point>;

/// A hole that was filled, in numbers.
struct FilledHole {
  std::vector<Index> triangles;
  spline::ThinPlate plate;
};

class Scene {
 public:
  using Embedding = std::function<Point(const Point&)>;

  /// Adds an old region: the inside of an odd number of polygons. Regions share the points of their
  /// polygons.
  Status add_old(std::span<const Polygon> polygons, const Embedding& embedding);
  /// A border that a later hole leaves free: knots of its ends lie left of it, from one to the
  /// other.
  struct FreeBorder {
    Point from;
    Point to;
  };
  /// Fits a surface to all old regions. Comes after add_old() and before add_hole().
  Status fit(std::span<const FreeBorder> free_borders = {});
  /// Fills a hole; it is old for the next one.
  Status add_hole(std::span<const Polygon> polygons, double density = 1);

  const spline::DomainArrays& arrays() const { return arrays_; }
  const std::vector<Point>& coefficients() const { return coefficients_; }
  const std::vector<FilledHole>& holes() const { return holes_; }
  std::size_t old_triangles() const { return old_triangles_; }
  double largest_fit_distance() const { return fit_distance_; }
  Result<spline::DmsDomain> domain() const { return spline::DmsDomain::make(arrays_); }

  /// The place of each vertex: by formula in old regions and on their borders, else on the surface.
  std::vector<Point> places() const;
  /// The vertices of a border as numbers: those at the points of a polygon.
  std::vector<Index> numbers_of(const Polygon& polygon) const;

 private:
  Status add_triangles(std::span<const Polygon> polygons, double density);

  spline::DomainArrays arrays_{2, {}, {}, {}};
  std::vector<Point> coefficients_;
  std::vector<FilledHole> holes_;
  std::vector<Embedding> embeddings_;
  std::vector<std::size_t> embedding_of_;  // triangle -> embedding
  std::size_t old_triangles_ = 0;
  double fit_distance_ = 0;
};

/// A scene with the facets that close it: rings of points in space, the first one exterior.
struct ClosedScene {
  std::string name;
  Scene scene;
  std::vector<std::vector<std::vector<Point>>> closing;
};

/// The cone z = 2 - r between r = 1 and 2, and its cap. `edges` of the inner circle.
Result<ClosedScene> cone_cap(int edges = 16);
/// Three rectangles in different planes, three blends between them, and the hole of five sides: one
/// rectangle reaches it with a corner only.
Result<ClosedScene> five_sided_hole();
/// An opening in a horizontal pipe, and a vertical pipe of half its radius above.
Result<ClosedScene> tee_joint();
/// Three pipes and the flat bottom of a basin.
Result<ClosedScene> junction();

/// The solid that a scene bounds, on a lattice of micrometres. Errors: as Solid::make().
Result<Solid> solid_of(const ClosedScene& scene);

/// The largest jumps across the borders between triangles of a scene: of the value, and of the
/// first derivatives, as limits from both sides.
struct Jumps {
  double value = 0;
  double derivative = 0;
};
Jumps jumps_of(const Scene& scene);

}  // namespace watertight::samples
