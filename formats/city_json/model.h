// SPDX-License-Identifier: GPL-3.0-or-later
//
// The parsed form of CityJSON and CityJSONSeq, between text and features. Internal to formats/; the
// public interface is formats/city_json/city_json.h.
//
// Skeleton of a feature: its CityJSONFeature (or the whole CityJSON) as compact JSON in which
//   - the boundaries of a Solid are {"solid": k} and those of a MultiSolid or CompositeSolid
//     {"solids": [k, n]}: solid k, or solids k to k + n - 1, of the feature; those of a surface
//     that is taken for a solid are {"surface": k};
//   - "vertices" is {"count": N, "kind": "integers" | "decimals", "solids": [runs...],
//     "others": [x, y, z, x, ...]}. "solids" has, for each solid, the vertices of the document that
//     are its vertices, as runs [first, length, first, length, ...]; "others" has the coordinates
//     of the vertices that no solid uses, in their order; an element that is no vertex is there as
//     an array of one value, as it came.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "formats/city_json/city_json.h"
#include "formats/city_json/sax.h"
#include "formats/text/json.h"

namespace watertight::formats {

/// A geometry of a city object whose boundaries were captured.
struct GeometryRef {
  std::uint32_t object = 0;    // index of the city object in the document
  std::uint32_t geometry = 0;  // index in the object's geometry array
  std::size_t boundary = 0;    // index into CityModel::boundary_begin
  std::string type;
  std::string lod;
  bool is_unreadable = false;      // then it has no solids, and its boundaries stay as they came
  bool is_closed_surface = false;  // a surface that is taken for a solid

  bool is_solid() const { return type == "Solid"; }
  bool is_surface() const { return type == "MultiSurface" || type == "CompositeSurface"; }
  bool is_of_solids() const {
    return !is_unreadable &&
           (is_solid() || is_closed_surface || type == "MultiSolid" || type == "CompositeSolid");
  }
};

/// A part of a city object that cannot be read.
struct UnreadableRef {
  std::uint32_t object = 0;
  UnreadablePart part;
};

/// A surface that is no solid.
struct SurfaceRef {
  std::uint32_t object = 0;
  SubmittedSolid surface;
};

/// A geometry of a city object that is an instance of a geometry template.
struct InstanceRef {
  std::uint32_t object = 0;    // index of the city object in the document
  std::uint32_t geometry = 0;  // index in the object's geometry array
  std::size_t boundary = 0;    // index into CityModel::boundary_begin, for the instance's vertex
  std::uint64_t template_number = 0;
  std::array<GridNumber, 16> matrix{};  // the transformation matrix, row by row
};

/// The references within a city model.
struct ModelIndex {
  std::vector<std::string> ids;        // the ids of the city objects, in document order
  std::vector<std::uint32_t> root_of;  // the top-level object of each object
  /// For each object, the number of the Building that it is or is a part of; kNone for others and
  /// templates.
  std::vector<std::uint32_t> building_of;
  std::vector<GeometryRef> geometries;  // sorted by object, then by geometry
  std::vector<InstanceRef> instances;   // sorted by object, then by geometry; also in `geometries`
  std::vector<UnreadableRef> unreadable;
  std::vector<SurfaceRef> surfaces;  // of ReadOptions::surfaces, in document order
  std::vector<std::string> notes;
  bool are_templates = false;  // each "object" is a geometry template without id
};

/// A solid and, for each of its vertices, the vertex of the document.
struct CitySolid {
  SubmittedSolid submitted;
  std::vector<Index> vertex_of;
  std::uint32_t object = 0;
  std::size_t boundary = 0;
};

/// The error malformed with a JSON Pointer.
Error malformed_at(std::string message, std::string pointer);

/// The level of detail of a geometry as its document writes it; "" without one.
std::string level_of(const Json& geometry);
/// The element of a list with this number, of values by solid, shell and facet for example; null
/// where there is none.
const Json* element_of(const Json* list, std::size_t number);

/// The id that a CityJSONFeature states. Errors: malformed (another type, no id).
Result<std::string> feature_id(const Json& root);

/// Checks the shape of the document and finds geometries and top-level objects. Geometry instances
/// may refer to `template_count` templates. Faults of one object become unreadable parts. Errors:
/// malformed with JSON Pointer.
Result<ModelIndex> index_city_model(const CityModel& model, std::uint64_t template_count);

/// Reads a GeometryInstance, except for the members `object` and `geometry` of the result. Errors:
/// malformed with JSON Pointer (a template that does not exist, no vertex, a matrix that is not
/// valid).
Result<InstanceRef> read_instance(const Json& geometry, const std::string& pointer,
                                  std::uint64_t template_count);

/// The model's instances with their placements, in document order. Those that cannot be read leave
/// index.instances and become unreadable parts.
std::vector<TemplateInstance> city_instances(const CityModel& model, ModelIndex& index,
                                             const CityHeader& header);

/// Adds notes about references of materials, textures and addresses to values that do not exist.
/// Cost: linear in the objects that have such references.
void note_dangling_references(const CityModel& model, ModelIndex& index);

/// The solids of the model in document order. Solids whose objects have the same top-level object
/// share one lattice, as do all solids of a CityJSONFeature. Geometries whose boundaries are wrong
/// become unreadable. Surfaces go to index.surfaces, or are solids, as `surfaces` says. Errors:
/// limit_exceeded; not_encodable.
Result<std::vector<CitySolid>> city_solids(const CityModel& model, ModelIndex& index,
                                           const CityHeader& header, const Limits& limits,
                                           Surfaces surfaces);

/// The text that stands in a skeleton for the boundaries of a geometry of solids, `count` solids
/// from number `first` on.
std::string solid_reference(std::string_view geometry_type, std::size_t first, std::size_t count);

/// Turns the vertices into grid integers, which a transform requires; 10.0 is an integer too.
/// Others become faulty.
void require_integers(VertexList& list);
/// Errors: malformed when a boundary has the index of a vertex that does not exist or is faulty;
/// the pointer leads from the boundary to the index.
Status check_vertices(std::span<const BoundaryToken> tokens, const VertexList& list);

/// The header that a document or first line states. Errors: malformed, unsupported.
Result<CityHeader> city_header(const Json& root);

/// One feature per top-level object. Moves the parts out of the model.
Result<std::vector<Feature>> split_city_model(CityModel model, const ModelIndex& index,
                                              std::vector<CitySolid> solids,
                                              const CityHeader& header);

/// Appends the text that stands for the `boundaries` of a geometry.
using BoundaryPrinter = std::function<void(const Json& boundaries, std::string& out)>;
void append_city_object(std::string& out, const Json& object, const BoundaryPrinter& print);
void append_city_objects(std::string& out, const Json& objects, const BoundaryPrinter& print);

/// Calls `visit` with each vertex index in the `location` of the object's addresses, which are the
/// only vertex references outside of geometries.
template <class Visit>
Status for_each_address_vertex(Json& object, Visit visit) {
  Json* addresses = find_member(object, "address");
  if (addresses == nullptr) return Done{};
  const auto each_address = [&](Json& address) -> Status {
    Json* location = find_member(address, "location");
    Json* boundaries = location == nullptr ? nullptr : find_member(*location, "boundaries");
    if (boundaries == nullptr || !boundaries->is_array()) return Done{};
    for (Json& vertex : *boundaries) {
      if (auto status = visit(vertex); !status) return status;
    }
    return Done{};
  };
  if (!addresses->is_array()) return each_address(*addresses);
  for (Json& address : *addresses) {
    if (auto status = each_address(address); !status) return status;
  }
  return Done{};
}

/// The lists of a geometry that have a value for each facet; those of textures have one for each
/// ring of it.
enum class FacetValues : std::uint8_t { semantics, material, texture };
/// Takes the number of a solid of the feature and its values by shell and facet.
using FacetValuesVisit = std::function<void(std::size_t solid, Json& values, FacetValues kind)>;
/// Visits the lists of a geometry of a skeleton, solid by solid; none for other geometries.
void visit_facet_values(Json& geometry, const FacetValuesVisit& visit);

/// Appends boundaries as nested arrays, with `vertex_of(i)` in place of index i.
template <class VertexOf>
void append_boundary(std::string& out, std::span<const BoundaryToken> tokens, VertexOf vertex_of) {
  bool needs_comma = false;
  for (const BoundaryToken token : tokens) {
    if (token == kClose) {
      out += ']';
      needs_comma = true;
      continue;
    }
    if (needs_comma) out += ',';
    if (token == kOpen) {
      out += '[';
    } else {
      append_integer(out, vertex_of(token));
    }
    needs_comma = token != kOpen;
  }
}

/// Appends "[first,length,first,length]": each pair stands for `length` indices from `first` on.
void append_vertex_runs(std::string& out, std::span<const Index> vertices);
/// The inverse of append_vertex_runs(), for a solid with `solid_vertex_count` vertices in a
/// document with `vertex_count` vertices. Errors: malformed.
Result<std::vector<Index>> read_vertex_runs(const Json& runs, std::size_t vertex_count,
                                            std::size_t solid_vertex_count);

/// The members of the skeleton's "vertices". `others` are indices into the model's vertices.
std::string skeleton_vertices(const CityModel& model, std::size_t count,
                              std::span<const std::vector<Index>> vertex_of,
                              std::span<const Index> others);

}  // namespace watertight::formats
