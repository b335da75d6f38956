// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiles/feature_mesh.h"

#include <algorithm>
#include <cmath>

#include "geometry/solid.h"
#include "tessellate/facets.h"
#include "tessellate/fill.h"

namespace watertight::tiles {
namespace {

using Shapes = formats::CityShapes;

constexpr std::uint64_t kMostPairs = 300'000;  // of edges of facets with bad rings, in a feature
constexpr double kMostSteps = 9007199254740992.0;  // 2^53

/// Positions as coordinates of a lattice. Where the document has few decimals these are the whole
/// numbers that it means, so that the triangles are those of the validator.
struct Coordinates {
  Lattice lattice;
  std::array<double, 3> origin{};
  std::array<double, 3> steps{1, 1, 1};  // of a unit

  static Coordinates of(const Shapes& shapes) {
    Coordinates made;
    constexpr int kMostDecimals = 15;
    if (!shapes.decimals || shapes.positions.empty()) return made.as_doubles();
    made.origin = shapes.positions.front();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int decimals = (*shapes.decimals)[axis];
      if (decimals < 0 || decimals > kMostDecimals) return made.as_doubles();
      made.steps[axis] = std::pow(10.0, decimals);
      made.lattice.step[axis] = {1, -decimals};
    }
    for (const auto& position : shapes.positions) {
      const Point point = made.point(position);
      for (int axis = 0; axis < 3; ++axis) {
        if (!(std::abs(point[axis]) < kMostSteps)) return made.as_doubles();
      }
    }
    return made;
  }

  Point point(const std::array<double, 3>& position) const {
    if (lattice.kind == LatticeKind::float64) return {position[0], position[1], position[2]};
    Point made;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      made[static_cast<int>(axis)] = std::round((position[axis] - origin[axis]) * steps[axis]);
    }
    return made;
  }

  std::array<double, 3> position(const Point& point) const {
    std::array<double, 3> made{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      made[axis] = origin[axis] + point[static_cast<int>(axis)] / steps[axis];
    }
    return made;
  }

 private:
  Coordinates as_doubles() {
    *this = Coordinates();
    lattice.kind = LatticeKind::float64;
    return *this;
  }
};

bool is_finite(const std::array<double, 3>& position) {
  return std::isfinite(position[0]) && std::isfinite(position[1]) && std::isfinite(position[2]);
}

/// The polygons of shapes as facets of one shell. `polygons` receives the number of the polygon of
/// each facet: one with a position beyond all numbers is left out.
SolidArrays facets_of(const Shapes& shapes, const Coordinates& coordinates,
                      std::vector<std::size_t>& polygons) {
  SolidArrays arrays;
  arrays.vertices.reserve(shapes.positions.size());
  for (const auto& position : shapes.positions) {
    arrays.vertices.push_back(is_finite(position) ? coordinates.point(position) : Point{});
  }
  const auto is_placed = [&](const Shapes::Polygon& polygon) {
    return std::all_of(polygon.begin(), polygon.end(), [&](const Shapes::Ring& ring) {
      return std::all_of(ring.begin(), ring.end(),
                         [&](std::size_t p) { return is_finite(shapes.positions[p]); });
    });
  };
  for (std::size_t i = 0; i < shapes.polygons.size(); ++i) {
    if (!is_placed(shapes.polygons[i])) continue;
    for (const Shapes::Ring& ring : shapes.polygons[i]) {
      for (const std::size_t position : ring) {
        arrays.ring_vertices.push_back(static_cast<Index>(position));
      }
      arrays.end_ring();
    }
    arrays.end_facet();
    polygons.push_back(i);
  }
  arrays.end_shell();
  return arrays;
}

Look look_of(formats::FacetKind kind, Look of_object) {
  switch (kind) {
    case formats::FacetKind::roof:
      return Look::roof;
    case formats::FacetKind::wall:
      return Look::wall;
    case formats::FacetKind::ground:
      return Look::ground;
    case formats::FacetKind::none:
    case formats::FacetKind::other:
      break;
  }
  return of_object;
}

/// Collects the triangles of a feature with positions of the document.
class MeshBuilder {
 public:
  MeshBuilder(const Shapes& shapes, Look look, FeatureMesh& mesh)
      : shapes_(shapes), look_(look), coordinates_(Coordinates::of(shapes)), mesh_(mesh) {}

  /// The positions of the vertices. Errors: those of Solid::make().
  Result<std::vector<std::array<double, 3>>> build(std::uint32_t srid) {
    if (!shapes_.polygons.empty()) {
      const Status added = add_facets(srid);
      if (!added) return added.error();
    }
    for (const Shapes::Ring& line : shapes_.lines) add_line(line);
    for (const std::size_t point : shapes_.points) {
      if (is_finite(shapes_.positions[point])) mesh_.points.push_back(vertex(point));
    }
    return std::move(positions_);
  }

 private:
  Status add_facets(std::uint32_t srid) {
    std::vector<std::size_t> polygons;
    auto source =
        Solid::make(facets_of(shapes_, coordinates_, polygons), coordinates_.lattice, srid);
    if (!source) return source.error();
    const geometry::MergedSolid merged = geometry::merge_equal_vertices(*source);
    const Solid& solid = merged.solid;
    positions_.resize(solid.vertex_count());
    for (std::size_t i = 0; i < merged.vertex_of.size(); ++i) {
      if (merged.vertex_of[i] != kNone) positions_[merged.vertex_of[i]] = shapes_.positions[i];
    }
    const tessellate::FacetTriangles triangles = tessellate::triangulate_facets(solid);
    std::uint64_t pairs = kMostPairs;
    for (Index facet = 0; facet < solid.facet_count(); ++facet) {
      auto& out =
          mesh_.triangles[static_cast<std::size_t>(look_of(shapes_.kinds[polygons[facet]], look_))];
      for (Index i = triangles.first[facet]; i < triangles.first[facet + 1]; ++i) {
        out.push_back(triangles.triangles[i]);
      }
      if (triangles.state[facet] == tessellate::FacetState::triangulated) continue;
      const auto filled = tessellate::fill_facet(solid, facet, pairs);
      if (!filled) {
        ++mesh_.unfilled_facets;
        continue;
      }
      for (const auto& corners : *filled) add_filled(corners, out);
    }
    return Done{};
  }

  void add_filled(const std::array<Point, 3>& corners, std::vector<Triangle>& out) {
    const auto first = static_cast<Index>(positions_.size());
    for (const Point& corner : corners) positions_.push_back(coordinates_.position(corner));
    out.push_back({first, first + 1, first + 2});
  }

  Index vertex(std::size_t position) {
    positions_.push_back(shapes_.positions[position]);
    return static_cast<Index>(positions_.size() - 1);
  }

  void add_line(const Shapes::Ring& line) {
    for (const std::size_t position : line) {
      if (!is_finite(shapes_.positions[position])) return;
    }
    Index from = vertex(line.front());
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Index to = vertex(line[i]);
      mesh_.lines.push_back({from, to});
      from = to;
    }
  }

  const Shapes& shapes_;
  Look look_;
  Coordinates coordinates_;
  FeatureMesh& mesh_;
  std::vector<std::array<double, 3>> positions_;
};

}  // namespace

std::size_t FeatureMesh::triangle_count() const {
  std::size_t count = 0;
  for (const auto& list : triangles) count += list.size();
  return count;
}

TileBox FeatureMesh::box() const {
  TileBox box;
  for (const GridPosition& vertex : vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::min(box.min[axis], vertex[axis] / kStepsOfAMetre);
      box.max[axis] = std::max(box.max[axis], vertex[axis] / kStepsOfAMetre);
    }
  }
  return box;
}

Look look_of_type(std::string_view type) {
  if (type.starts_with("Building") || type.starts_with("Bridge")) return Look::building;
  if (type == "TINRelief" || type == "LandUse") return Look::terrain;
  if (type == "PlantCover" || type == "SolitaryVegetationObject") return Look::vegetation;
  if (type == "WaterBody" || type == "Waterway") return Look::water;
  if (type == "Road" || type == "Railway" || type == "TransportSquare") return Look::transport;
  return Look::other;
}

Result<FeatureMesh> mesh_of(formats::CityFeature feature, std::string id, std::string type,
                            std::uint32_t srid, const Frame& frame) {
  FeatureMesh mesh;
  const Look look = look_of_type(type);
  mesh.id = std::move(id);
  mesh.type = std::move(type);
  mesh.properties = std::move(feature.attributes);
  const auto positions = MeshBuilder(feature.shapes, look, mesh).build(srid);
  if (!positions) return positions.error();
  auto placed = frame.place(srid, *positions);
  if (!placed) return std::move(placed).error();
  mesh.vertices = *std::move(placed);
  return mesh;
}

}  // namespace watertight::tiles
