// SPDX-License-Identifier: GPL-3.0-or-later
#include "sql/model.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/json_text.h"
#include "geometry/measures.h"
#include "geometry/vector3.h"
#include "tessellate/facets.h"
#include "tiles/frame.h"

namespace watertight::sql {
namespace {

// The normal of a roof or a ground is at most 60 degrees from the vertical.
constexpr double kLeastRise = 0.5;

std::string number_json(double number) { return JsonText().value(number).take(); }

tiles::Look look_of(const geometry::Vector3& a, const geometry::Vector3& b,
                    const geometry::Vector3& c) {
  using geometry::operator-;
  const geometry::Vector3 normal = geometry::cross(b - a, c - a);
  const double rise = normal[2] / geometry::length(normal);
  if (rise >= kLeastRise) return tiles::Look::roof;
  return rise <= -kLeastRise ? tiles::Look::ground : tiles::Look::wall;
}

}  // namespace

Result<tiles::FeatureMesh> model_of(const Solid& solid) {
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  const Solid& divided = facets.divided_solid(solid);
  const geometry::Measures measures = geometry::measure(divided, facets.triangles);
  std::vector<geometry::Vector3> positions;
  for (const Point& vertex : divided.vertices()) {
    positions.push_back(divided.lattice().world(vertex));
  }
  const auto frame = tiles::Frame::at(0, measures.box_min);
  if (!frame) return frame.error();
  auto placed = frame->place(0, positions);
  if (!placed) return placed.error();
  tiles::FeatureMesh mesh;
  mesh.id = "solid";
  mesh.type = "Solid";
  mesh.properties = {{"volume", number_json(measures.volume)},
                     {"area", number_json(measures.area)}};
  mesh.vertices = *std::move(placed);
  for (const Triangle& triangle : facets.triangles) {
    const auto& [a, b, c] = triangle;
    const tiles::Look look = look_of(positions[a], positions[b], positions[c]);
    mesh.triangles[static_cast<std::size_t>(look)].push_back(triangle);
  }
  return mesh;
}

}  // namespace watertight::sql
