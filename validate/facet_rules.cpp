// SPDX-License-Identifier: GPL-3.0-or-later
//
// Facets: planar within tolerance (203, 204), connected interior (205), interior rings turning
// against the exterior ring (208). 203 and 204 are measured in metres and degrees; a facet that is
// exactly planar has neither, whatever the rounding of the measurement says.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/predicates.h"
#include "tessellate/ring_problems.h"
#include "validate/planarity.h"
#include "validate/rules.h"

namespace watertight {
namespace {

/// Pairs of triangles compared per facet for rule 204: about a second of work. Facets with more
/// (above 6,000 triangles) whose triangles all face within half the limit need no pairs at all.
constexpr std::size_t kMostTrianglePairs = 20'000'000;

struct Corner {
  Index ring = 0;
  std::size_t position = 0;
  Index vertex = 0;
};

std::vector<Corner> corners_of(const Solid& solid, Index facet) {
  std::vector<Corner> corners;
  const IndexRange rings = solid.rings_of(facet);
  for (Index r = rings.begin; r < rings.end; ++r) {
    const std::span<const Index> ring = solid.ring(r);
    for (std::size_t i = 0; i < ring.size(); ++i) corners.push_back({r - rings.begin, i, ring[i]});
  }
  return corners;
}

std::span<const Triangle> triangles_of(const ExaminedSolid& examined, Index facet) {
  const FacetTriangles& all = examined.triangles();
  return std::span<const Triangle>(all.triangles)
      .subspan(all.first[facet], all.first[facet + 1] - all.first[facet]);
}

/// Exact. Requires a triangulated facet.
bool is_exactly_planar(const ExaminedSolid& examined, Index facet,
                       const std::vector<Corner>& corners) {
  const std::span<const Point> vertices = examined.solid().vertices();
  const Triangle& t = triangles_of(examined, facet).front();
  return std::all_of(corners.begin(), corners.end(), [&](const Corner& corner) {
    const Index v = corner.vertex;
    return v == t[0] || v == t[1] || v == t[2] ||
           orient3d(vertices[t[0]], vertices[t[1]], vertices[t[2]], vertices[v]) == 0;
  });
}

/// Newell's normal of the exterior ring, in metres squared.
Vector ring_normal(const std::vector<Corner>& corners, const std::vector<Vector>& points) {
  Vector normal{};
  std::size_t count = 0;
  while (count < corners.size() && corners[count].ring == 0) ++count;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector part = cross(points[i], points[(i + 1) % count]);
    for (std::size_t axis = 0; axis < 3; ++axis) normal[axis] += part[axis];
  }
  return unit(normal);
}

/// False if 203 was found.
bool check_distance(ExaminedSolid& examined, Index facet, const std::vector<Corner>& corners) {
  const double limit = examined.tolerances().planarity_metres;
  std::vector<Vector> points;
  for (const Corner& corner : corners) {
    points.push_back(examined.metres(corners.front().vertex, corner.vertex));
  }
  PlaneDistance measured = distance_to_fitted_plane(points);
  if (measured.metres <= limit) return true;
  // Least squares lose digits on long and narrow facets; the plane across the ring's own normal
  // is as good a witness of planarity.
  const PlaneDistance other = distance_to_plane(points, ring_normal(corners, points));
  if (other.metres < measured.metres) measured = other;
  if (measured.metres <= limit || is_exactly_planar(examined, facet, corners)) return true;
  const Corner& corner = corners[measured.point];
  Finding finding;
  finding.code = kNonPlanarDistance;
  finding.place = examined.at_corner(facet, corner.ring, corner.position);
  finding.witness = examined.world(corner.vertex);
  finding.measured = measured.metres;
  finding.limit = limit;
  finding.unit = std::string(1, 'm');
  finding.detail = "the point is off the plane fitted through the facet";
  examined.findings.add(std::move(finding));
  examined.mark_faulty(facet);
  return false;
}

struct WidestPair {
  double cosine = 1;
  std::size_t a = 0;
  std::size_t b = 0;
};

WidestPair widest_pair(const std::vector<Vector>& normals) {
  WidestPair widest;
  std::size_t pairs = 0;
  for (std::size_t a = 0; a < normals.size(); ++a) {
    pairs += normals.size() - a;
    if (pairs > kMostTrianglePairs) break;
    for (std::size_t b = a + 1; b < normals.size(); ++b) {
      const double cosine = dot(normals[a], normals[b]);
      if (cosine < widest.cosine) widest = {cosine, a, b};
    }
  }
  return widest;
}

double degrees_of(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * (180.0 / std::numbers::pi);
}

void check_normals(ExaminedSolid& examined, Index facet, const std::vector<Corner>& corners) {
  const std::span<const Triangle> triangles = triangles_of(examined, facet);
  if (triangles.size() < 2) return;
  const double limit = examined.tolerances().planarity_degrees;
  std::vector<Vector> normals;
  Vector mean{};
  for (const Triangle& t : triangles) {
    normals.push_back(unit(cross(examined.metres(t[0], t[1]), examined.metres(t[0], t[2]))));
    for (std::size_t axis = 0; axis < 3; ++axis) mean[axis] += normals.back()[axis];
  }
  // Two normals within half the limit of a third direction are within the limit of each other.
  mean = unit(mean);
  const double half = std::cos(limit / 2 * (std::numbers::pi / 180.0));
  if (std::all_of(normals.begin(), normals.end(),
                  [&](const Vector& normal) { return dot(normal, mean) >= half; })) {
    return;
  }
  const WidestPair widest = widest_pair(normals);
  const double measured = degrees_of(widest.cosine);
  if (!(measured > limit) || is_exactly_planar(examined, facet, corners)) return;
  Finding finding;
  finding.code = kNonPlanarNormals;
  finding.place = examined.at_facet(facet);
  // The corner of the second triangle that the first does not have shows where the fold is.
  const Triangle& a = triangles[widest.a];
  for (const Index vertex : triangles[widest.b]) {
    if (std::find(a.begin(), a.end(), vertex) != a.end()) continue;
    finding.place.vertex = examined.submitted_vertex(vertex);
    finding.witness = examined.world(vertex);
    break;
  }
  finding.measured = measured;
  finding.limit = limit;
  finding.unit = "degree";
  finding.detail = "two triangles of the facet face different ways";
  examined.findings.add(std::move(finding));
  examined.mark_faulty(facet);
}

/// Number of parts the triangles of a facet fall into when joined over edges.
std::size_t count_parts(std::span<const Triangle> triangles) {
  std::vector<std::size_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  struct Side {
    Index low, high;
    std::size_t triangle;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax({triangles[t][i], triangles[t][(i + 1) % 3]});
      sides.push_back({low, high, t});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  std::size_t parts = triangles.size();
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].low != sides[i - 1].low || sides[i].high != sides[i - 1].high) continue;
    const std::size_t a = root(sides[i - 1].triangle);
    const std::size_t b = root(sides[i].triangle);
    if (a == b) continue;
    parent[b] = a;
    --parts;
  }
  return parts;
}

void check_connected(ExaminedSolid& examined, Index facet, const std::vector<Corner>& corners) {
  // Rings that share no vertex cannot cut the interior apart.
  std::vector<Index> vertices;
  for (const Corner& corner : corners) vertices.push_back(corner.vertex);
  std::sort(vertices.begin(), vertices.end());
  const auto shared = std::adjacent_find(vertices.begin(), vertices.end());
  if (shared == vertices.end()) return;
  const std::size_t parts = count_parts(triangles_of(examined, facet));
  if (parts == 1) return;
  Finding finding;
  finding.code = kInteriorDisconnected;
  finding.place = examined.at_facet(facet);
  finding.place.vertex = examined.submitted_vertex(*shared);
  finding.witness = examined.world(*shared);
  finding.measured = static_cast<double>(parts);
  finding.limit = 1;
  finding.unit = "parts";
  finding.detail = "rings that touch cut the interior of the facet apart";
  examined.findings.add(std::move(finding));
  examined.mark_faulty(facet);
}

void check_turns(ExaminedSolid& examined, Index facet) {
  const Solid& solid = examined.solid();
  const IndexRange rings = solid.rings_of(facet);
  const Projection projection = facet_projection(solid, facet);
  const int exterior = projection.is_mirrored ? -1 : 1;
  for (Index r = rings.begin + 1; r < rings.end; ++r) {
    if (ring_turn(solid, r, projection.axis) != exterior) continue;
    Finding finding;
    finding.code = kOrientationRingsSame;
    finding.place = examined.at_ring(facet, r - rings.begin);
    finding.detail = "the interior ring turns the same way as the exterior ring";
    examined.findings.add(std::move(finding));
    examined.mark_faulty(facet);
  }
}

}  // namespace

void check_facets(ExaminedSolid& examined) {
  const Solid& solid = examined.solid();
  Index unmeasured = kNone;
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    const IndexRange rings = solid.rings_of(facet);
    if (examined.triangles().state[facet] != FacetState::triangulated) {
      if (unmeasured == kNone) unmeasured = facet;
      continue;
    }
    if (rings.size() == 1 && solid.ring(rings.begin).size() == 3) continue;
    const std::vector<Corner> corners = corners_of(solid, facet);
    if (check_distance(examined, facet, corners)) check_normals(examined, facet, corners);
    if (rings.size() < 2) continue;
    check_connected(examined, facet, corners);
    check_turns(examined, facet);
  }
  if (unmeasured != kNone) {
    examined.findings.skip({203, 204, 205, 208},
                           "not on facets whose rings bound no region (first: facet " +
                               std::to_string(unmeasured) + ")");
  }
}

}  // namespace watertight
