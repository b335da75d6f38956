// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checks that the faces that a tetrahedralization gives to a facet are that facet: a disc, with
// holes, that has the facet's rings as its boundary, made of the facet's own vertices, of vertices
// of other shells that lie on it exactly, and of Steiner points that differ from the facet by
// rounding only. For the certificate.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "delaunay/certificate/small_faces.h"
#include "delaunay/tetrahedralization.h"
#include "geometry/solid.h"
#include "tessellate/facets.h"

namespace watertight::delaunay {

/// Engines round Steiner points to doubles. Each Steiner point is constructed from points of the
/// input or from earlier Steiner points, and each construction adds a few units in the last place
/// of the largest coordinate; chains of constructions add up. The largest error measured on 1,800
/// city solids was 32 units; the bound leaves room for chains of thirty. The bound is about 2e-13
/// of the solid's size.
inline constexpr double kSteinerUnits = 1024;

/// The bound on each axis: kSteinerUnits units in the last place of the largest coordinate.
std::array<double, 3> steiner_rounding(std::span<const Point> vertices);

/// A facet's faces, turned so that their boundary is the facet's rings.
struct FacetSurface {
  std::span<const Triangle> faces;  // in the order of the faces checked; until the next check
  /// True if every diagonal of the canonical triangulation is a chain of edges of the faces: then
  /// both are the same surface.
  bool follows_canonical = true;
  double largest_deviation = 0;  // the largest distance of a Steiner point from the plane, world
                                 // units
  double volume_slack = 0;       // at least six times the volume between this surface and the
                                 // canonical triangles; coordinates divided by `unit`
};

/// The reason why faces are not their facet, as a clause about the facet.
struct FacetFault {
  std::string reason;
};

/// Works on one facet after the other. Not thread-safe; cheap to make for each solid.
class FacetSurfaces {
 public:
  /// Keeps references to the first three; `unit` is a power of two per axis near the solid's size.
  FacetSurfaces(const Solid& solid, const tessellate::FacetTriangles& canonical,
                const Tetrahedralization& tetrahedralization, const std::array<double, 3>& unit);
  ~FacetSurfaces();
  FacetSurfaces(const FacetSurfaces&) = delete;
  FacetSurfaces& operator=(const FacetSurfaces&) = delete;

  /// Checks `faces`, which are all faces of `facet`. Cost: O(k log k) for k faces.
  std::variant<FacetSurface, FacetFault> check(Index facet, std::span<const ConstrainedFace> faces);

 private:
  struct Plane;
  class Mesh;

  Plane plane_of(Index facet) const;
  bool is_steiner(Index vertex) const { return vertex >= data_.input_count; }
  bool has_chain(Index facet, Mesh& mesh, Index from, Index to) const;
  double height(const Plane& plane, Index vertex) const;
  std::optional<double> place_near_segment(Index vertex, Index from, Index to) const;
  bool is_contact(Index facet, Index vertex) const;
  std::optional<double> place_on_chain(Index facet, Index vertex, Index from, Index to) const;
  std::optional<FacetFault> check_vertices(Index facet, const Plane& plane, const Mesh& mesh);
  double largest_deviation(const Plane& plane, const Mesh& mesh) const;
  std::size_t boundary_step(Index facet, const Mesh& mesh, Index current, Index from,
                            Index to) const;
  std::optional<FacetFault> check_rings(Index facet, const Mesh& mesh);
  std::optional<FacetFault> check_area(Index facet, std::span<const Triangle> faces) const;
  std::span<const Triangle> canonical_of(Index facet) const;

  const Solid& solid_;
  const tessellate::FacetTriangles& canonical_;
  const Tetrahedralization& data_;
  std::array<double, 3> unit_;
  std::array<double, 3> rounding_;
  std::unique_ptr<Mesh> mesh_;      // of the facet at work; its memory serves all facets
  SmallFaces small_faces_;          // of the last facet with few
  std::vector<char> is_used_;       // edge of the boundary -> a ring runs along it
  std::vector<Index> facet_stamp_;  // vertex -> the last facet whose rings have it
};

}  // namespace watertight::delaunay
