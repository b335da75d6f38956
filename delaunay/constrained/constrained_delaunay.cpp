// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/constrained/constrained_delaunay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "delaunay/axis_scale.h"
#include "delaunay/canonical/follow_delaunay.h"
#include "delaunay/constrained/insert_facets.h"
#include "delaunay/constrained/protect_edges.h"
#include "delaunay/recovery/coordinate_order.h"
#include "delaunay/recovery/tetrahedron_mesh.h"

namespace watertight::delaunay {
namespace {

/// The triangles of each facet in the numbering of an order, so that what follows does not depend
/// on that of the solid.
std::vector<FlatFacet> flat_facets(const FollowingTriangles& following,
                                   const CoordinateOrder& order) {
  std::vector<FlatFacet> facets;
  for (Index facet = 0; facet + 1 < following.first.size(); ++facet) {
    FlatFacet flat{{}, facet};
    for (Index t = following.first[facet]; t < following.first[facet + 1]; ++t) {
      Triangle triangle = following.triangles[t];
      for (Index& vertex : triangle) vertex = order.rank_of[vertex];
      flat.triangles.push_back(sorted(triangle));
    }
    std::sort(flat.triangles.begin(), flat.triangles.end());
    facets.push_back(std::move(flat));
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

/// The solid under a scaling; none where a coordinate would not come back.
std::optional<Solid> scaled_solid(const Solid& solid, const AxisScale& scale) {
  std::optional<std::vector<Point>> vertices = scaled(solid.vertices(), scale);
  if (!vertices) return std::nullopt;
  SolidArrays arrays = solid.arrays();
  arrays.vertices = *std::move(vertices);
  Result<Solid> result = Solid::make(std::move(arrays), solid.lattice(), solid.srid());
  if (!result) return std::nullopt;
  return *std::move(result);
}

}  // namespace

Result<ConstrainedDelaunay> constrained_delaunay(const Solid& given,
                                                 const tessellate::FacetTriangles& triangles,
                                                 const std::vector<bool>& is_taken_apart,
                                                 const CancelPoll& is_cancelled) {
  AxisScale scale = equal_extents(given.box());
  std::optional<Solid> with_equal_extents = scaled_solid(given, scale);
  if (!with_equal_extents) scale = {1, 1, 1};
  const Solid& solid = with_equal_extents ? *with_equal_extents : given;
  Result<ProtectedSolid> divided = protect_edges(solid, triangles, is_taken_apart, is_cancelled);
  if (!divided) return divided.error();
  const auto points = divided->solid.vertices();
  const Result<FollowingTriangles> following =
      follow_delaunay(divided->solid, tessellate::triangulate_facets(divided->solid),
                      divided->delaunay, {}, is_cancelled);
  if (!following) return following.error();
  const CoordinateOrder order = order_of(points);
  std::vector<Point> sorted_points;
  for (const Index vertex : order.vertex_at) sorted_points.push_back(points[vertex]);
  std::vector<geometry::Tetrahedron> tetrahedra = std::move(divided->delaunay.tetrahedra);
  for (geometry::Tetrahedron& t : tetrahedra) {
    for (Index& vertex : t) vertex = order.rank_of[vertex];
    t = normalized(t);
  }
  std::sort(tetrahedra.begin(), tetrahedra.end());
  Result<InsertedFacets> inserted = insert_facets(sorted_points, std::move(tetrahedra),
                                                  flat_facets(*following, order), is_cancelled);
  if (!inserted) return inserted.error();
  ConstrainedDelaunay result;
  result.points.assign(points.begin(), points.end());
  unscale(result.points, scale);
  result.tetrahedra = std::move(inserted->tetrahedra);
  result.missing = inserted->missing;
  for (const FlatFacet& facet : inserted->facets) {
    result.triangles.insert(result.triangles.end(), facet.triangles.begin(), facet.triangles.end());
    result.facet_of.resize(result.triangles.size(), divided->facet_of[facet.source]);
  }
  const auto renumber = [&](auto& vertices) {
    for (Index& vertex : vertices) vertex = order.vertex_at[vertex];
  };
  for (geometry::Tetrahedron& t : result.tetrahedra) renumber(t);
  for (Triangle& t : result.triangles) renumber(t);
  return result;
}

}  // namespace watertight::delaunay
