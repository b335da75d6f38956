// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "formats/city_json/appearance.h"
#include "formats/city_json/model.h"

namespace watertight::formats {
namespace {

// The vertices of one feature, numbered in order of first use.
class LocalVertices {
 public:
  explicit LocalVertices(std::size_t vertex_count) : local_of_(vertex_count, kNone) {}

  /// An index that is out of range stays as it is: in the feature it is out of range too.
  Index local(Index vertex) {
    if (vertex >= local_of_.size()) return vertex;
    if (local_of_[vertex] == kNone) {
      local_of_[vertex] = static_cast<Index>(vertices_.size());
      vertices_.push_back(vertex);
    }
    return local_of_[vertex];
  }
  std::size_t document_count() const { return local_of_.size(); }
  const std::vector<Index>& vertices() const { return vertices_; }
  void clear() {
    for (const Index vertex : vertices_) local_of_[vertex] = kNone;
    vertices_.clear();
  }

 private:
  std::vector<Index> local_of_;  // the feature's vertex, by document vertex
  std::vector<Index> vertices_;  // the document's vertex, by vertex of the feature
};

class Splitter {
 public:
  Splitter(CityModel model, const ModelIndex& index, std::vector<CitySolid> solids,
           const CityHeader& header)
      : model_(std::move(model)),
        index_(index),
        solids_(std::move(solids)),
        header_(header),
        local_(model_.vertices.size()),
        first_solid_(model_.boundary_begin.size(), 0),
        first_geometry_(index.ids.size() + 1, 0) {
    for (std::size_t i = solids_.size(); i > 0; --i) first_solid_[solids_[i - 1].boundary] = i - 1;
    is_of_solids_.assign(model_.boundary_begin.size(), false);
    for (const GeometryRef& ref : index.geometries) {
      ++first_geometry_[ref.object + 1];
      is_of_solids_[ref.boundary] = ref.is_of_solids();
    }
    for (std::size_t i = 1; i < first_geometry_.size(); ++i) {
      first_geometry_[i] += first_geometry_[i - 1];
    }
  }

  Result<std::vector<Feature>> split() {
    // The objects of each top-level object, in document order.
    std::vector<std::vector<Index>> members(index_.ids.size());
    for (Index object = 0; object < index_.ids.size(); ++object) {
      members[index_.root_of[object]].push_back(object);
    }
    std::vector<Feature> features;
    for (Index root = 0; root < members.size(); ++root) {
      if (members[root].empty()) continue;
      auto feature = make(root, members[root]);
      local_.clear();
      if (!feature) return std::move(feature).error();
      features.push_back(std::move(*feature));
    }
    return features;
  }

 private:
  Json& object(Index number) {
    return (find_member(model_.root, "CityObjects")->get_ref<Json::object_t&>().begin() + number)
        ->second;
  }

  Result<Feature> make(Index root, const std::vector<Index>& members) {
    Feature feature;
    feature.id = index_.ids[root];
    feature.type = string_member(object(root), "type");
    feature.srid = header_.srid;
    vertex_of_.clear();

    AppearanceCollector appearance;
    for (const Index number : members) {
      localize(number, appearance);
    }
    std::string& out = feature.skeleton;
    out = "{\"type\":\"CityJSONFeature\",\"id\":";
    append_json_string(out, feature.id);
    out += ",\"CityObjects\":{";
    const BoundaryPrinter print = [&](const Json& boundaries, std::string& text) {
      if (!boundaries.is_number_unsigned()) return append_json(text, boundaries);
      append_reference(boundaries.get<std::size_t>(), feature, text);
    };
    for (const Index number : members) {
      if (number != members.front()) out += ',';
      append_json_string(out, index_.ids[number]);
      out += ':';
      append_city_object(out, object(number), print);
    }
    out += '}';
    if (const Json local = appearance.take(nullptr); !local.is_null()) {
      out += ",\"appearance\":";
      append_json(out, local);
    }
    out += ",\"vertices\":" + local_vertices() + '}';
    return feature;
  }

  // Numbers the vertices that the object uses within the feature, and makes the object's addresses
  // and appearance refer to the lists of the feature.
  void localize(Index number, AppearanceCollector& appearance) {
    const Json* source = find_member(model_.root, "appearance");
    Json* geometries = find_member(object(number), "geometry");
    if (geometries != nullptr && geometries->is_array()) {
      // note_dangling_references() has told of the indices that refer to nothing.
      for (Json& geometry : *geometries) static_cast<void>(appearance.adopt(geometry, source));
    }
    for (std::size_t i = first_geometry_[number]; i < first_geometry_[number + 1]; ++i) {
      for (const BoundaryToken token : model_.boundary(index_.geometries[i].boundary)) {
        if (token < kClose) local_.local(token);
      }
    }
    const auto renumber = [&](Json& vertex) -> Status {
      const bool exists =
          vertex.is_number_unsigned() && vertex.get<std::uint64_t>() < local_.document_count();
      vertex = exists ? local_.local(vertex.get<Index>()) : kDangling;
      return Done{};
    };
    static_cast<void>(for_each_address_vertex(object(number), renumber));
  }

  void append_reference(std::size_t boundary, Feature& feature, std::string& out) {
    if (!is_of_solids_[boundary]) {
      append_boundary(out, model_.boundary(boundary),
                      [&](Index vertex) { return local_.local(vertex); });
      return;
    }
    const std::size_t first = feature.solids.size();
    std::string type;
    for (std::size_t i = first_solid_[boundary];
         i < solids_.size() && solids_[i].boundary == boundary; ++i) {
      CitySolid& solid = solids_[i];
      for (Index& vertex : solid.vertex_of) vertex = local_.local(vertex);
      type = solid.submitted.source.geometry_type;
      vertex_of_.push_back(std::move(solid.vertex_of));
      feature.solids.push_back(std::move(solid.submitted));
    }
    out += solid_reference(type, first, feature.solids.size() - first);
  }

  std::string local_vertices() {
    const std::vector<Index>& vertices = local_.vertices();
    std::vector<bool> is_used(vertices.size(), false);
    for (const auto& solid : vertex_of_) {
      for (const Index vertex : solid) is_used[vertex] = true;
    }
    std::vector<Index> others;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (!is_used[i]) others.push_back(vertices[i]);
    }
    return skeleton_vertices(model_, vertices.size(), vertex_of_, others);
  }

  CityModel model_;
  const ModelIndex& index_;
  std::vector<CitySolid> solids_;
  const CityHeader& header_;
  LocalVertices local_;
  std::vector<std::size_t> first_solid_;       // the first solid of each boundary
  std::vector<std::size_t> first_geometry_;    // the first entry of each object in
                                               // index_.geometries
  std::vector<bool> is_of_solids_;             // whether a boundary is of solids
  std::vector<std::vector<Index>> vertex_of_;  // the feature's vertices of each of its solids
};

}  // namespace

Result<std::vector<Feature>> split_city_model(CityModel model, const ModelIndex& index,
                                              std::vector<CitySolid> solids,
                                              const CityHeader& header) {
  return Splitter(std::move(model), index, std::move(solids), header).split();
}

}  // namespace watertight::formats
