// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rules of facets: planar within tolerance (203, 204), connected interior (205), interior rings
// that turn against the exterior ring (208). 203 and 204 are measured in metres and degrees; a
// facet that is exactly planar has neither finding, whatever rounding does to the measured values.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/disjoint_sets.h"
#include "geometry/fitted_plane.h"
#include "geometry/predicates/predicates.h"
#include "tessellate/flatness.h"
#include "tessellate/ring_problems.h"
#include "validate/overlap/box_tree.h"
#include "validate/planarity.h"
#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

struct Corner {
  Index ring = 0;
  std::size_t position = 0;
  Index vertex = 0;
};

/// The corners of the rings as submitted, without the vertices that split edges.
std::vector<Corner> corners_of(const ExaminedSolid& examined, Index facet) {
  std::vector<Corner> corners;
  const Solid& solid = examined.solid();
  const IndexRange rings = solid.rings_of(facet);
  for (Index r = rings.begin; r < rings.end; ++r) {
    const std::span<const Index> ring = solid.ring(r);
    const Index first = solid.arrays().ring_offsets[r];
    for (Index i = 0; i < ring.size(); ++i) {
      if (!examined.is_inserted(first + i)) corners.push_back({r - rings.begin, i, ring[i]});
    }
  }
  return corners;
}

std::span<const Triangle> triangles_of(const ExaminedSolid& examined, Index facet) {
  const tessellate::FacetTriangles& all = examined.triangles();
  return std::span<const Triangle>(all.triangles)
      .subspan(all.first[facet], all.first[facet + 1] - all.first[facet]);
}

/// False if a distance in the facet is beyond the range of doubles.
bool is_measurable(const ExaminedSolid& examined, const std::vector<Corner>& corners) {
  return std::all_of(corners.begin(), corners.end(), [&](const Corner& corner) {
    const Vector d = examined.metres(corners.front().vertex, corner.vertex);
    return std::all_of(d.begin(), d.end(), [](double x) { return std::isfinite(x); });
  });
}

/// Applies rule 203. False if there is a finding.
bool check_distance(ExaminedSolid& examined, Index facet, const std::vector<Corner>& corners) {
  const double limit = examined.tolerances().planarity_metres;
  std::vector<Vector> points;
  points.reserve(corners.size());
  for (const Corner& corner : corners) {
    points.push_back(examined.metres(corners.front().vertex, corner.vertex));
  }
  const geometry::PlaneDistance measured = geometry::distance_to_fitted_plane(points, limit);
  if (measured.distance <= limit) return true;
  const Corner& corner = corners[measured.point];
  examined.findings.add({.code = kNonPlanarDistance,
                         .place = examined.at_corner(facet, corner.ring, corner.position),
                         .witness = examined.world(corner.vertex),
                         .measured = measured.distance,
                         .limit = limit,
                         .unit = std::string(1, 'm'),
                         .detail = "the point is off the plane fitted through the facet"});
  examined.mark_faulty(facet);
  return false;
}

struct WidestPair {
  double cosine = 1;
  std::size_t a = 0;
  std::size_t b = 0;
};

/// The pair of normals with the smallest cosine of the angle between them. Cost: near linear except
/// for normals arranged to defeat the search.
WidestPair widest_pair(const std::vector<Vector>& normals) {
  std::vector<Box> boxes;
  boxes.reserve(normals.size());
  for (const Vector& n : normals) boxes.push_back({{n[0], n[1], n[2]}, {n[0], n[1], n[2]}});
  const BoxTree tree(boxes);
  WidestPair widest;
  const auto compare = [&](std::size_t a, std::size_t b) {
    const double cosine = dot(normals[a], normals[b]);
    if (cosine < widest.cosine) widest = {cosine, std::min(a, b), std::max(a, b)};
  };
  // A first guess: the normal farthest from the first normal, then the one farthest from that one.
  for (int round = 0; round < 2; ++round) {
    const std::size_t from = widest.b;
    for (std::size_t i = 0; i < normals.size(); ++i) compare(from, i);
  }
  for (std::size_t a = 0; a < normals.size(); ++a) {
    const Vector& n = normals[a];
    tree.visit(
        [&](const Box& box) {
          double least = 0;
          for (int axis = 0; axis < 3; ++axis) {
            const double component = n[static_cast<std::size_t>(axis)];
            least += std::min(component * box.min[axis], component * box.max[axis]);
          }
          return least < widest.cosine;
        },
        [&](Index b) { compare(a, b); });
  }
  return widest;
}

double degrees_of(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * (180.0 / std::numbers::pi);
}

void check_normals(ExaminedSolid& examined, Index facet) {
  const std::span<const Triangle> triangles = triangles_of(examined, facet);
  if (triangles.size() < 2) return;
  const double limit = examined.tolerances().planarity_degrees;
  std::vector<Vector> normals;
  Vector mean{};
  for (const Triangle& t : triangles) {
    normals.push_back(unit_normal(examined.metres(t[0], t[1]), examined.metres(t[0], t[2])));
    for (std::size_t axis = 0; axis < 3; ++axis) mean[axis] += normals.back()[axis];
  }
  // If all normals are within half the limit of one direction, any two are within the limit.
  mean = direction_of(mean);
  const double half = std::cos(limit / 2 * (std::numbers::pi / 180.0));
  if (std::all_of(normals.begin(), normals.end(),
                  [&](const Vector& normal) { return dot(normal, mean) >= half; })) {
    return;
  }
  const WidestPair widest = widest_pair(normals);
  const double measured = degrees_of(widest.cosine);
  if (!(measured > limit)) return;
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

/// The number of parts of a facet whose triangles are connected through edges.
std::size_t count_parts(std::span<const Triangle> triangles) {
  geometry::DisjointSets sets(triangles.size());
  struct FacetSide {
    Index low, high, triangle;
  };
  std::vector<FacetSide> sides;
  for (Index t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax({triangles[t][i], triangles[t][(i + 1) % 3]});
      sides.push_back({low, high, t});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const FacetSide& a, const FacetSide& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  std::size_t parts = triangles.size();
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].low != sides[i - 1].low || sides[i].high != sides[i - 1].high) continue;
    const Index a = sides[i - 1].triangle;
    const Index b = sides[i].triangle;
    if (sets.root(a) == sets.root(b)) continue;
    sets.join(a, b);
    --parts;
  }
  return parts;
}

void check_connected(ExaminedSolid& examined, Index facet) {
  // Rings that share no vertex cannot divide the interior.
  const Solid& solid = examined.solid();
  std::vector<Index> vertices;
  for (Index r = solid.rings_of(facet).begin; r < solid.rings_of(facet).end; ++r) {
    vertices.insert(vertices.end(), solid.ring(r).begin(), solid.ring(r).end());
  }
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
  const tessellate::Projection projection = tessellate::facet_projection(solid, facet);
  const int exterior = projection.is_mirrored ? -1 : 1;
  for (Index r = rings.begin + 1; r < rings.end; ++r) {
    if (tessellate::ring_turn(solid, r, projection.axis) != exterior) continue;
    examined.findings.add({.code = kOrientationRingsSame,
                           .place = examined.at_ring(facet, r - rings.begin),
                           .detail = "the interior ring turns the same way as the exterior ring"});
    examined.mark_faulty(facet);
  }
}

/// False if the facet has finding 101 or 102.
bool has_good_points(const Solid& solid, IndexRange rings) {
  for (Index r = rings.begin; r < rings.end; ++r) {
    const std::span<const Index> ring = solid.ring(r);
    if (ring.size() < 3 || ring.front() == ring.back()) return false;
    if (std::adjacent_find(ring.begin(), ring.end()) != ring.end()) return false;
  }
  return rings.size() > 0;
}

/// Applies the rules to one facet. False if the facet is too large to be measured.
bool check_facet(ExaminedSolid& examined, Index facet, bool is_triangulated) {
  const Solid& solid = examined.solid();
  bool is_measured = true;
  if (!tessellate::is_flat(solid, facet)) {
    const std::vector<Corner> corners = corners_of(examined, facet);
    if (is_triangulated) examined.mark_not_planar(facet);
    is_measured = is_measurable(examined, corners);
    if (is_measured && check_distance(examined, facet, corners) && is_triangulated) {
      check_normals(examined, facet);
    }
  }
  if (!is_triangulated || solid.rings_of(facet).size() < 2) return is_measured;
  check_connected(examined, facet);
  check_turns(examined, facet);
  return is_measured;
}

}  // namespace

std::string check_facets(ExaminedSolid& examined) {
  const Solid& solid = examined.solid();
  std::string too_large;
  Index unmeasured = kNone;
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    if (examined.is_cancelled()) {
      examined.findings.skip({203, 204, 205, 208}, "the search was cancelled");
      break;
    }
    const IndexRange rings = solid.rings_of(facet);
    const bool is_triangulated =
        examined.triangles().state[facet] == tessellate::FacetState::triangulated;
    if (!is_triangulated && unmeasured == kNone) unmeasured = facet;
    if (rings.size() == 1 && solid.ring(rings.begin).size() == 3) continue;
    if (is_triangulated || has_good_points(solid, rings)) {
      if (check_facet(examined, facet, is_triangulated) || !too_large.empty()) continue;
      too_large = "facet " + std::to_string(facet) + " is too large to be measured";
      examined.findings.skip({203, 204}, too_large);
    }
  }
  if (unmeasured != kNone) {
    examined.findings.skip({204, 205, 208},
                           "not on facets whose rings bound no region (first: facet " +
                               std::to_string(unmeasured) + ")");
  }
  return too_large;
}

}  // namespace watertight::validate
