// SPDX-License-Identifier: GPL-3.0-or-later
//
// Warnings about vertices and very narrow facets (801, 802, 803, 805): the solid may be valid, but
// probably is not what was meant. Measured in metres.
#include <algorithm>
#include <cmath>

#include "base/quantity.h"
#include "validate/overlap/near_vertices.h"
#include "validate/planarity.h"
#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

/// Vertices closer than this get a warning: val3dity's default snap tolerance.
constexpr double kNearMetres = 0.001;
/// Facets narrower than this get a warning.
constexpr double kSliverMetres = 0.001;

void check_near(ExaminedSolid& examined) {
  const Solid& solid = examined.solid();
  if (solid.vertex_count() < 2) return;
  // Different vertices of a coarse lattice cannot be near: they differ by a step on some axis.
  const std::array<double, 3> step = examined.metres(Point{}, Point{1, 1, 1});
  const auto is_integer = [](const Point& p) {
    return p.x == std::trunc(p.x) && p.y == std::trunc(p.y) && p.z == std::trunc(p.z);
  };
  const bool is_integral =
      std::all_of(solid.vertices().begin(), solid.vertices().end(), is_integer);
  if (is_integral && examined.metric_map().keeps_axes() &&
      *std::min_element(step.begin(), step.end()) >= kNearMetres)
    return;
  std::vector<Point> places;
  places.reserve(solid.vertex_count());
  for (Index v = 0; v < solid.vertex_count(); ++v) {
    const std::array<double, 3> metres = examined.metres(0, v);
    places.push_back({metres[0], metres[1], metres[2]});
  }
  const NearPoints near = near_points(places, std::nextafter(kNearMetres, 0.0),
                                      [&] { return examined.is_cancelled(); });
  if (examined.was_cancelled()) {
    examined.findings.skip({kNearDuplicateVertices}, "the search was cancelled");
  }
  if (near.first == kNone) return;
  Finding finding;
  finding.code = kNearDuplicateVertices;
  finding.place.vertex = examined.submitted_vertex(near.first);
  finding.other = Place{};
  finding.other->vertex = examined.submitted_vertex(near.second);
  finding.witness = examined.world(near.first);
  finding.measured = near.distance;
  finding.limit = kNearMetres;
  finding.unit = std::string(1, 'm');
  finding.detail = std::to_string(near.points.size()) +
                   " vertices nearly coincide with another vertex; these two are the closest";
  examined.findings.add(std::move(finding));
}

/// Warning 802. `left_out` are the unused vertices that the reader has left out of the solid.
void check_unused(ExaminedSolid& examined, const geometry::UnusedVertices& left_out) {
  Index first = kNone;
  std::uint64_t count = left_out.count;
  for (Index vertex = 0; vertex < examined.submitted().vertex_count(); ++vertex) {
    if (examined.merged_of()[vertex] != kNone) continue;
    if (first == kNone) first = vertex;
    ++count;
  }
  if (count == 0) return;
  Finding finding;
  finding.code = kUnusedVertices;
  finding.place.vertex = first;
  finding.witness = left_out.count > 0 ? left_out.place : examined.submitted().world(first);
  finding.measured = static_cast<double>(count);
  finding.limit = 0;
  finding.unit = "vertices";
  finding.detail = quantity(count, "vertex is", "vertices are") + " used by no ring; " +
                   (left_out.count > 0 ? "the first is number " + std::to_string(left_out.first) +
                                             " of the file, counted from 0"
                                       : "this is the first");
  examined.findings.add(std::move(finding));
}

/// Warning 803. The width of a facet is twice its area, divided by its longest triangle edge (of a
/// triangle: its least height).
void check_slivers(ExaminedSolid& examined) {
  const tessellate::FacetTriangles& all = examined.triangles();
  for (Index facet = 0; facet < examined.solid().facet_count(); ++facet) {
    if (examined.is_cancelled()) return;
    if (all.state[facet] != tessellate::FacetState::triangulated) continue;
    double doubled_area = 0;
    double extent = 0;
    for (Index t = all.first[facet]; t < all.first[facet + 1]; ++t) {
      const Triangle& triangle = all.triangles[t];
      const Vector a = examined.metres(triangle[0], triangle[1]);
      const Vector b = examined.metres(triangle[0], triangle[2]);
      doubled_area += length(cross(a, b));
      extent = std::max(
          {extent, length(a), length(b), length(examined.metres(triangle[1], triangle[2]))});
    }
    if (!(extent > 0) || doubled_area >= kSliverMetres * extent || extent < kSliverMetres) continue;
    examined.findings.add({.code = kSliverFacet,
                           .place = examined.at_facet(facet),
                           .witness = examined.world(all.triangles[all.first[facet]][0]),
                           .measured = doubled_area / extent,
                           .limit = kSliverMetres,
                           .unit = std::string(1, 'm'),
                           .detail = "the facet is very narrow for its length"});
  }
}

}  // namespace

void check_vertices(ExaminedSolid& examined, const geometry::UnusedVertices& left_out) {
  check_near(examined);
  check_unused(examined, left_out);
  check_slivers(examined);
}

void check_rounded(ExaminedSolid& examined, std::span<const Index> rounded) {
  if (rounded.empty() || rounded[0] >= examined.submitted().vertex_count()) return;
  Finding finding;
  finding.code = kCoordinatesRounded;
  finding.place.vertex = rounded[0];
  finding.witness = examined.submitted().world(rounded[0]);
  finding.measured = static_cast<double>(rounded.size());
  finding.limit = 0;
  finding.unit = "vertices";
  finding.detail = "the digits of " + quantity(rounded.size(), "vertex", "vertices") +
                   " fit no grid and were rounded; this is the first";
  examined.findings.add(std::move(finding));
}

void report_rounded_origin(ExaminedSolid& examined) {
  examined.findings.add({.code = kCoordinatesRounded,
                         .detail = "the origin of the solid needs more than 18 digits and was "
                                   "rounded to 18; the shape is exact"});
}

}  // namespace watertight::validate
