// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fills a hole by the best triangulation of all its loops together: a surface with these borders
// that has no handles and the least sum of angles and areas.
// Source: Zou, Ju and Carr, "An algorithm for triangulating multiple 3D polygons" (2013).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "geometry/point.h"
#include "geometry/vector3.h"

namespace watertight::fill {

/// A closed loop of different points by number; the last is joined to the first. A loop has the
/// hole on its left.
using Loop = std::vector<Index>;

/// The triangles from which a filling is chosen.
enum class CandidateSpace : std::uint8_t {
  delaunay,  // the faces of the canonical Delaunay tetrahedralization: they do not cross
  all        // all triples
};

/// The sum that is made least. The paper weighs both together; their units have no common measure.
enum class Objective : std::uint8_t {
  angle,  // of angles between triangles, 0 flat and pi folded; area decides between equal ones
  area
};

struct FillOptions {
  CandidateSpace space = CandidateSpace::delaunay;
  Objective objective = Objective::angle;
  /// Loops but the first may be passed against their sense. For curves that bound no shell.
  bool has_both_senses = false;
  /// The factors from coordinates to metres, by axis.
  std::array<double, 3> metres_per_unit{1, 1, 1};
  /// Loop -> edge -> direction in metres into the facet of the shell at the edge, zero where there
  /// is none. Empty: no facets.
  std::vector<std::vector<geometry::Vector3>> behind;
  /// Whether a triangle of points may be used. Empty: every one.
  std::function<bool(const Triangle&)> is_allowed;
  std::size_t max_domains = 20'000'000;
  std::size_t max_bytes = std::size_t{400} << 20U;
  CancelPoll is_cancelled;
  /// Keep sets of weak edges for which a subset weighs no more. The result has the same weight.
  bool keeps_all_sets = false;
};

struct LoopFill {
  std::vector<Triangle> triangles;  // points by number, in the sense of the loops; sorted
  double angle = 0;                 // the sum of angles on all edges that were weighed, in radians
  double area = 0;                  // square metres
  std::size_t candidates = 0;       // the number of triangles to choose from
  std::size_t domains = 0;          // the number of domains that were weighed
  std::size_t weak_sets = 0;        // the number of sets of weak edges that were kept
  std::size_t bytes = 0;            // the memory of candidates and domains
};

/// The triangulation with the least weight, the same for every order of points and loops. It has
/// n + 2k - 4 triangles for n points in k loops. Does not look for intersections, except through
/// `is_allowed` and the space.
/// Errors: invalid_argument for a loop of fewer than 3 points, repeated or equal points, numbers
/// out of range or not finite, points on one line, facets behind that do not match; limit_exceeded
/// for more than 6 loops, 65,000 points or the budget; not_found if the candidates have no
/// triangulation; cancelled. Cost: with all triples O(n^3) time for one loop, O(n^7) for two; with
/// Delaunay triangles about linear for one loop, quadratic for two.
Result<LoopFill> triangulate_loops(std::span<const Point> points, std::span<const Loop> loops,
                                   const FillOptions& options);

}  // namespace watertight::fill
