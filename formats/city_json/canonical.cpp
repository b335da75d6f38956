// SPDX-License-Identifier: GPL-3.0-or-later
//
// Skeletons for solids in canonical form: semantics, materials and textures follow the order of the
// canonical facets and rings, and the vertices of the document get numbers in the order in which
// the canonical solids use them.
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "formats/city_json/model.h"
#include "geometry/canonical_form.h"

namespace watertight::formats {
namespace {

constexpr std::array<std::string_view, 7> kRootMembers{
    "type", "id", "version", "transform", "metadata", "CityObjects", "vertices"};
constexpr std::array<std::string_view, 4> kObjectMembers{"type", "parents", "children", "geometry"};
constexpr std::array<std::string_view, 3> kGeometryMembers{"type", "lod", "boundaries"};

template <std::size_t kCount>
void keep_members(Json& object, const std::array<std::string_view, kCount>& names) {
  Json kept = Json::object();
  for (auto& [key, value] : object.get_ref<Json::object_t&>()) {
    const bool is_kept = std::find(names.begin(), names.end(), key) != names.end();
    if (is_kept) append_member(kept, key, std::move(value));
  }
  object = std::move(kept);
}

bool is_of_solids(const Json& geometry) {
  const Json* boundaries = find_member(geometry, "boundaries");
  return boundaries != nullptr && boundaries->is_object();
}

/// Removes everything from a city object but its type, its parents and children, and its solids.
void keep_solids_only(Json& object) {
  keep_members(object, kObjectMembers);
  Json* type = find_member(object, "type");
  // a type of an extension
  if (string_member(object, "type").starts_with('+')) *type = "GenericCityObject";
  Json* geometries = find_member(object, "geometry");
  if (geometries == nullptr || !geometries->is_array()) return;
  Json kept = Json::array();
  for (Json& geometry : *geometries) {
    if (!is_of_solids(geometry)) continue;
    keep_members(geometry, kGeometryMembers);
    kept.push_back(std::move(geometry));
  }
  *geometries = std::move(kept);
}

/// Removes the members of a header or document that do not say where the solids are.
void keep_reference(Json& root) {
  keep_members(root, kRootMembers);
  Json* metadata = find_member(root, "metadata");
  if (metadata != nullptr && metadata->is_object()) {
    keep_members(*metadata, std::array<std::string_view, 1>{"referenceSystem"});
  }
}

/// A solid as it was submitted, and the order of its parts in the canonical form.
struct Arranged {
  const Solid* source = nullptr;
  geometry::SourceOrder order;
  std::vector<Index> document_vertex;  // the vertex of the new document, by canonical vertex
};

/// The texture of a ring, in canonical order: [texture, texture vertex, texture vertex, ...], or
/// [null].
Json arranged_ring(const Json& values, const Arranged& solid, Index ring) {
  const auto size = static_cast<Index>(solid.source->ring(solid.order.ring[ring]).size());
  if (!values.is_array() || values.size() != std::size_t{size} + 1) return values;
  Json out = Json::array({values[0]});
  const Index start = solid.order.ring_start[ring];
  for (Index i = 0; i < size; ++i) out.push_back(values[1 + (i + size - start) % size]);
  return out;
}

/// The values of the rings of one facet, in canonical order. `first_ring` is the first ring of the
/// canonical facet.
Json arranged_facet(const Json& values, const Arranged& solid, Index facet, Index first_ring) {
  const IndexRange rings = solid.source->rings_of(solid.order.facet[facet]);
  if (!values.is_array() || values.size() != rings.size()) return values;
  Json out = Json::array();
  for (Index i = 0; i < rings.size(); ++i) {
    const Index ring = first_ring + i;
    out.push_back(arranged_ring(values[solid.order.ring[ring] - rings.begin], solid, ring));
  }
  return out;
}

/// The values of the facets of one solid by shell, in canonical order. Lists of another shape stay
/// as they are.
Json arranged_solid(const Json& values, const Arranged& solid, bool has_rings) {
  if (!values.is_array() || values.size() != solid.source->shell_count()) return values;
  Json out = Json::array();
  Index facet = 0;
  Index ring = 0;
  for (const Index source_shell : solid.order.shell) {
    const Json& of_shell = values[source_shell];
    const IndexRange facets = solid.source->facets_of(source_shell);
    const bool is_listed = of_shell.is_array() && of_shell.size() == facets.size();
    Json shell = Json::array();
    for (Index i = 0; i < facets.size(); ++i, ++facet) {
      const Index source_facet = solid.order.facet[facet];
      if (is_listed) {
        const Json& value = of_shell[source_facet - facets.begin];
        shell.push_back(has_rings ? arranged_facet(value, solid, facet, ring) : value);
      }
      ring += solid.source->rings_of(source_facet).size();
    }
    if (is_listed) {
      out.push_back(std::move(shell));
    } else {
      out.push_back(of_shell);
    }
  }
  return out;
}

class Canonicalizer {
 public:
  Canonicalizer(CityModel model, const Feature& feature)
      : model_(std::move(model)), feature_(feature) {}

  Result<std::string> run(Contract contract) {
    if (Status status = number_vertices(); !status) return status.error();
    Json& root = model_.root;
    Json* objects = find_member(root, "CityObjects");
    if (objects == nullptr || !objects->is_object()) return unfit("no city objects");
    for (auto& [id, object] : objects->get_ref<Json::object_t&>()) {
      if (contract == Contract::boundary && object.is_object()) keep_solids_only(object);
      if (Status status = arrange(object); !status) return status.error();
    }
    if (contract == Contract::boundary) {
      keep_reference(root);
      others_ = Json::array();
    }
    return print();
  }

 private:
  static Error unfit(std::string message) {
    return Error{ErrorCode::malformed, "skeleton and solids do not fit: " + std::move(message)};
  }

  /// Numbers the vertices of the document: first the vertices of the solids, solid by solid and
  /// each solid in its canonical order, each vertex once; then all others.
  Status number_vertices() {
    const Json* vertices = find_member(model_.root, "vertices");
    const Json* count = vertices == nullptr ? nullptr : find_member(*vertices, "count");
    const Json* runs = vertices == nullptr ? nullptr : find_member(*vertices, "solids");
    const Json* others = vertices == nullptr ? nullptr : find_member(*vertices, "others");
    if (count == nullptr || !count->is_number_unsigned() || runs == nullptr || others == nullptr ||
        runs->size() != feature_.solids.size()) {
      return unfit("vertices");
    }
    others_ = *others;
    kind_ = string_member(*vertices, "kind");
    number_of_.assign(count->get<std::size_t>(), kNone);
    for (std::size_t i = 0; i < feature_.solids.size(); ++i) {
      const Solid& source = feature_.solids[i].solid;
      auto document_vertices =
          read_vertex_runs((*runs)[i], number_of_.size(), source.vertex_count());
      if (!document_vertices) return std::move(document_vertices).error();
      if (Status status = add(source, *document_vertices); !status) return status;
    }
    solid_vertices_ = next_;
    for (Index& number : number_of_) {
      if (number == kNone) number = next_++;
    }
    return Done{};
  }

  /// The number of vertices in others_: three numbers each, or an array for an element that is
  /// none.
  std::size_t other_count() const {
    const auto faulty = static_cast<std::size_t>(std::count_if(
        others_.begin(), others_.end(), [](const Json& value) { return value.is_array(); }));
    return faulty + (others_.size() - faulty) / 3;
  }

  /// Adds a solid that has no canonical form, in its own order.
  void add_as_it_came(const Solid& source, const std::vector<Index>& document_vertices) {
    const auto identity = [](std::size_t size) {
      std::vector<Index> order(size);
      std::iota(order.begin(), order.end(), Index{0});
      return order;
    };
    Arranged solid;
    solid.source = &source;
    solid.order.vertex = identity(source.vertex_count());
    solid.order.shell = identity(source.shell_count());
    solid.order.facet = identity(source.facet_count());
    solid.order.ring = identity(source.ring_count());
    solid.order.ring_start.assign(source.ring_count(), 0);
    for (const Index vertex : document_vertices) {
      Index& number = number_of_[vertex];
      if (number == kNone) number = next_++;
      solid.document_vertex.push_back(number);
    }
    solids_.push_back(std::move(solid));
  }

  Status add(const Solid& source, const std::vector<Index>& document_vertices) {
    const geometry::MergedSolid merged = geometry::merge_equal_vertices(source);
    auto boundary = OrientedBoundary::make(merged.solid);
    if (!boundary) {
      add_as_it_came(source, document_vertices);
      return Done{};
    }
    std::vector<Index> number(merged.solid.vertex_count(), kNone);
    for (Index vertex = 0; vertex < source.vertex_count(); ++vertex) {
      if (merged.vertex_of[vertex] == kNone) continue;
      Index& known = number[merged.vertex_of[vertex]];
      known = std::min(known, number_of_[document_vertices[vertex]]);
    }
    Arranged solid{&source, geometry::canonical_form(*boundary).order, {}};
    for (const Index vertex : solid.order.vertex) {
      if (number[vertex] == kNone) number[vertex] = next_++;
      solid.document_vertex.push_back(number[vertex]);
    }
    for (Index vertex = 0; vertex < source.vertex_count(); ++vertex) {
      if (merged.vertex_of[vertex] == kNone) continue;
      number_of_[document_vertices[vertex]] = number[merged.vertex_of[vertex]];
    }
    solids_.push_back(std::move(solid));
    return Done{};
  }

  Status arrange(Json& object) {
    Json* geometries = find_member(object, "geometry");
    if (geometries != nullptr && geometries->is_array()) {
      for (Json& geometry : *geometries) {
        visit_facet_values(geometry, [this](std::size_t i, Json& values, FacetValues kind) {
          if (i >= solids_.size()) return;
          values = arranged_solid(values, solids_[i], kind == FacetValues::texture);
        });
      }
    }
    return for_each_address_vertex(object, [this](Json& vertex) -> Status {
      if (vertex.is_number_unsigned() && vertex.get<std::uint64_t>() < number_of_.size()) {
        vertex = number_of_[vertex.get<std::size_t>()];
      }
      return Done{};
    });
  }

  std::string print() const {
    const BoundaryPrinter print_boundary = [this](const Json& boundaries, std::string& out) {
      if (!boundaries.is_number_unsigned()) return append_json(out, boundaries);
      append_boundary(out, model_.boundary(boundaries.get<std::size_t>()), [this](Index vertex) {
        return vertex < number_of_.size() ? number_of_[vertex] : vertex;
      });
    };
    std::string out = "{";
    for (const auto& [key, value] : model_.root.get_ref<const Json::object_t&>()) {
      if (out.size() > 1) out += ',';
      append_json_string(out, key);
      out += ':';
      if (key == "CityObjects") {
        append_city_objects(out, value, print_boundary);
      } else if (key == "vertices") {
        append_vertices(out);
      } else {
        append_json(out, value);
      }
    }
    return out + '}';
  }

  void append_vertices(std::string& out) const {
    out += "{\"count\":" + std::to_string(solid_vertices_ + other_count()) + ",\"kind\":";
    append_json_string(out, kind_);
    out += ",\"solids\":[";
    for (std::size_t i = 0; i < solids_.size(); ++i) {
      if (i > 0) out += ',';
      append_vertex_runs(out, solids_[i].document_vertex);
    }
    out += "],\"others\":";
    append_json(out, others_);
    out += '}';
  }

  CityModel model_;
  const Feature& feature_;
  std::vector<Index> number_of_;  // the new number of each vertex of the document
  Index next_ = 0;
  Index solid_vertices_ = 0;  // the number of vertices that solids use
  std::string kind_;
  Json others_;
  std::vector<Arranged> solids_;
};

}  // namespace

Result<std::string> canonical_skeleton(const Feature& feature, Contract contract) {
  auto model = parse_city_model(feature.skeleton, CityText::skeleton, kOwnText);
  if (!model) return std::move(model).error();
  return Canonicalizer(std::move(*model), feature).run(contract);
}

Result<std::string> boundary_header(std::string_view header) {
  auto root = parse_json(header, kOwnText);
  if (!root) return std::move(root).error();
  if (root->is_object()) keep_reference(*root);
  return json_text(*root);
}

}  // namespace watertight::formats
