// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads instances of geometry templates: the template, the matrix and the vertex that place it.
#include <algorithm>
#include <utility>

#include "base/quantity.h"
#include "formats/city_json/model.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

Result<std::array<GridNumber, kMatrixSize>> read_matrix(const Json& geometry,
                                                        const std::string& pointer) {
  const Json* values = find_member(geometry, "transformationMatrix");
  const bool is_matrix = values != nullptr && values->is_array() && values->size() == kMatrixSize &&
                         std::all_of(values->begin(), values->end(), is_number_value);
  if (!is_matrix) return malformed_at("a transformationMatrix needs 16 numbers", pointer);
  std::array<GridNumber, kMatrixSize> matrix;
  for (std::size_t i = 0; i < kMatrixSize; ++i) {
    auto exact = exact_number(json_text((*values)[i]));
    if (!exact) return malformed_at(exact.error().message, pointer + pointer_token(i));
    matrix[i] = exact->value;
  }
  const auto placement = placement_of_matrix(matrix, {});
  if (!placement) return malformed_at(placement.error().message, pointer);
  return matrix;
}

// The world coordinates of the vertex on which the instance stands.
Result<std::array<GridNumber, 3>> anchor_of(const CityModel& model, const InstanceRef& ref,
                                            const CityHeader& header, const std::string& pointer) {
  const auto tokens = model.boundary(ref.boundary);
  const auto vertex =
      std::find_if(tokens.begin(), tokens.end(), [](BoundaryToken t) { return t < kClose; });
  if (vertex == tokens.end()) {
    return malformed_at("a geometry instance needs the vertex it stands on", pointer);
  }
  const VertexList& list = model.vertices;
  if (auto status = check_vertices(tokens, list); !status) {
    return malformed_at(status.error().message, pointer + status.error().pointer);
  }
  auto points = list.are_integers ? geometry::lattice_of_integers(
                                        {&list.integers[*vertex], 1},
                                        header.transform.value_or(geometry::Transform{}))
                                  : geometry::lattice_of_decimals({&list.decimals[*vertex], 1});
  if (!points) return malformed_at(points.error().message, pointer);
  // The origin of a lattice with one point is that point, unless its coordinates are on no decimal
  // grid.
  if (points->lattice.kind == LatticeKind::decimal) return points->lattice.origin;
  std::array<GridNumber, 3> anchor;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = points->lattice.world(points->points.front()[axis], axis);
    anchor[static_cast<std::size_t>(axis)] = geometry::shortest_decimal(place);
  }
  return anchor;
}

}  // namespace

Result<InstanceRef> read_instance(const Json& geometry, const std::string& pointer,
                                  std::uint64_t template_count) {
  const Json* number = find_member(geometry, "template");
  if (number == nullptr || !number->is_number_unsigned()) {
    return malformed_at("a geometry instance needs the index of its template",
                        pointer + "/template");
  }
  InstanceRef ref;
  ref.template_number = number->get<std::uint64_t>();
  if (ref.template_number >= template_count) {
    return malformed_at("template " + std::to_string(ref.template_number) + " is out of range (" +
                            quantity(template_count, "template") + ')',
                        pointer + "/template");
  }
  const Json* boundaries = find_member(geometry, "boundaries");
  if (boundaries == nullptr) {
    return malformed_at("a geometry instance needs the vertex it stands on",
                        pointer + "/boundaries");
  }
  ref.boundary = boundaries->get<std::size_t>();
  auto matrix = read_matrix(geometry, pointer + "/transformationMatrix");
  if (!matrix) return std::move(matrix).error();
  ref.matrix = *matrix;
  return ref;
}

namespace {

Result<TemplateInstance> place_instance(const CityModel& model, const ModelIndex& index,
                                        const InstanceRef& ref, const CityHeader& header) {
  TemplateInstance instance;
  instance.template_number = ref.template_number;
  instance.source = {index.ids[ref.object],
                     "GeometryInstance",
                     {},
                     ref.geometry,
                     0,
                     "/CityObjects" + pointer_token(index.ids[ref.object]) + "/geometry" +
                         pointer_token(ref.geometry)};
  auto anchor = anchor_of(model, ref, header, instance.source.pointer + "/boundaries");
  if (!anchor) return std::move(anchor).error();
  auto placement = placement_of_matrix(ref.matrix, *anchor);
  if (!placement) return std::move(placement).error();
  instance.placement = *placement;
  instance.placement.srid = header.srid;
  const Index building = index.building_of[ref.object];
  if (building != kNone) instance.source.building_id = index.ids[building];
  return instance;
}

}  // namespace

std::vector<TemplateInstance> city_instances(const CityModel& model, ModelIndex& index,
                                             const CityHeader& header) {
  std::vector<TemplateInstance> instances;
  std::vector<InstanceRef> placed;
  for (const InstanceRef& ref : index.instances) {
    auto instance = place_instance(model, index, ref, header);
    if (instance) {
      instances.push_back(*std::move(instance));
      placed.push_back(ref);
      continue;
    }
    UnreadablePart part;
    part.source.object_id = index.ids[ref.object];
    part.source.geometry_type = "GeometryInstance";
    part.source.geometry = ref.geometry;
    part.source.pointer = instance.error().pointer;
    part.error = std::move(instance).error();
    index.unreadable.push_back({ref.object, std::move(part)});
  }
  index.instances = std::move(placed);
  return instances;
}

}  // namespace watertight::formats
