// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <utility>

#include "formats/city_json/model.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

constexpr std::string_view kTemplates = "/geometry-templates/templates";

// Makes the templates' boundaries and vertices a model of their own, so that solids are cut, and
// errors found, as in a document.
class TemplateReader {
 public:
  TemplateReader(const Json& section, std::uint64_t text_bytes) : section_(section) {
    model_.text_bytes = text_bytes;
  }

  Result<ModelIndex> read() {
    const Json* templates = find_member(section_, "templates");
    if (templates == nullptr || !templates->is_array()) {
      return malformed_at("templates is missing or not an array", std::string(kTemplates));
    }
    if (auto status = read_vertices(); !status) return status.error();
    ModelIndex index;
    index.are_templates = true;
    for (std::uint32_t i = 0; i < templates->size(); ++i) {
      index.ids.emplace_back();
      index.root_of.push_back(i);
      const auto status = read_template((*templates)[i], i, index);
      if (!status) add_empty(i, status.error(), index);
    }
    return index;
  }

  CityModel& model() { return model_; }

 private:
  /// Adds a solid without facets in place of a template that cannot be read.
  void add_empty(std::uint32_t number, const Error& error, ModelIndex& index) {
    index.notes.push_back("the template cannot be read: " + error.message + " at " + error.pointer);
    model_.tokens.resize(model_.boundary_begin.back());
    index.geometries.push_back({number, number, model_.boundary_begin.size() - 1, "Solid", {}});
    model_.tokens.push_back(kOpen);
    model_.tokens.push_back(kClose);
    model_.boundary_begin.push_back(model_.tokens.size());
  }

  Status read_vertices() {
    const std::string pointer = "/geometry-templates/vertices-templates";
    const Json* vertices = find_member(section_, "vertices-templates");
    if (vertices == nullptr || !vertices->is_array()) {
      return malformed_at("vertices-templates is missing or not an array", pointer);
    }
    VertexList& list = model_.vertices;
    list.are_integers = false;
    list.is_present = true;
    list.decimals.reserve(vertices->size());
    for (std::size_t i = 0; i < vertices->size(); ++i) {
      const Json& vertex = (*vertices)[i];
      if (!vertex.is_array() || vertex.size() != 3) {
        return malformed_at("a vertex is an array of three numbers", pointer + pointer_token(i));
      }
      std::array<GridNumber, 3> position;
      bool is_rounded = false;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        auto exact = exact_member(vertex[axis]);
        if (!exact) {
          return malformed_at(exact.error().message,
                              pointer + pointer_token(i) + pointer_token(axis));
        }
        position[axis] = exact->value;
        is_rounded = is_rounded || exact->is_rounded;
      }
      if (is_rounded) list.rounded.push_back(static_cast<Index>(i));
      list.decimals.push_back(position);
    }
    return Done{};
  }

  static Result<ExactNumber> exact_member(const Json& value) {
    if (!is_number_value(value)) return Error{ErrorCode::malformed, "not a number", {}, {}};
    return exact_number(json_text(value));
  }

  Status read_template(const Json& geometry, std::uint32_t number, ModelIndex& index) {
    const std::string pointer = std::string(kTemplates) + pointer_token(number);
    GeometryRef ref{
        number, number, model_.boundary_begin.size() - 1, string_member(geometry, "type"), {}};
    if (ref.type.empty()) return malformed_at("the template has no type", pointer);
    ref.lod = level_of(geometry);
    const Json* boundaries = find_member(geometry, "boundaries");
    if (boundaries == nullptr || !boundaries->is_array()) {
      return malformed_at("the template has no boundaries", pointer);
    }
    if (auto status = append_tokens(*boundaries, pointer + "/boundaries"); !status) return status;
    model_.boundary_begin.push_back(model_.tokens.size());
    index.geometries.push_back(std::move(ref));
    return Done{};
  }

  // Appends nested arrays of indices as tokens. The parser has limited the depth of the nesting.
  Status append_tokens(const Json& boundaries, const std::string& pointer) {
    struct Level {
      const Json* array;
      std::size_t next;
    };
    std::vector<Level> open{{&boundaries, 0}};
    model_.tokens.push_back(kOpen);
    while (!open.empty()) {
      Level& top = open.back();
      if (top.next == top.array->size()) {
        model_.tokens.push_back(kClose);
        open.pop_back();
        continue;
      }
      const Json& value = (*top.array)[top.next++];
      if (value.is_array()) {
        model_.tokens.push_back(kOpen);
        open.push_back({&value, 0});
      } else if (value.is_number_unsigned() && value.get<std::uint64_t>() < kClose) {
        model_.tokens.push_back(static_cast<BoundaryToken>(value.get<std::uint64_t>()));
      } else {
        std::string path = pointer;
        for (const Level& level : open) path += pointer_token(level.next - 1);
        return malformed_at("boundaries are nested arrays of vertex indices", std::move(path));
      }
    }
    return Done{};
  }

  const Json& section_;
  CityModel model_;
};

}  // namespace

Result<TemplateSolids> read_geometry_templates(const CityHeader& header, const Limits& limits,
                                               Surfaces surfaces) {
  TemplateSolids found;
  if (header.template_count == 0) return found;
  Limits unlimited = limits;
  unlimited.bytes = ~0ULL;  // the header was within the limit when it was read
  const auto root = parse_json(header.text, unlimited);
  if (!root) return root.error();
  const Json* section = find_member(*root, "geometry-templates");
  if (section == nullptr) return found;
  TemplateReader reader(*section, header.text.size());
  auto index = reader.read();
  if (!index) return std::move(index).error();
  auto solids = city_solids(reader.model(), *index, CityHeader{}, limits, surfaces);
  if (!solids) return std::move(solids).error();
  found.notes = std::move(index->notes);
  found.solids.reserve(solids->size());
  for (CitySolid& solid : *solids) found.solids.push_back(std::move(solid.submitted));
  for (SurfaceRef& ref : index->surfaces) found.surfaces.push_back(std::move(ref.surface));
  for (UnreadableRef& ref : index->unreadable) {
    auto nothing = Solid::make(SolidArrays{}, Lattice{}, 0);
    if (!nothing) return std::move(nothing).error();
    found.notes.push_back("the template cannot be read: " + ref.part.error.message + " at " +
                          ref.part.error.pointer);
    found.solids.push_back({*std::move(nothing), std::move(ref.part.source), {}});
  }
  std::stable_sort(found.solids.begin(), found.solids.end(),
                   [](const SubmittedSolid& a, const SubmittedSolid& b) {
                     return a.source.geometry < b.source.geometry;
                   });
  return found;
}

}  // namespace watertight::formats
