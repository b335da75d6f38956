// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "formats/city_json/model.h"
#include "formats/feature_reader.h"
#include "formats/text/text_layout.h"

namespace watertight::formats {
namespace {

struct ReadModel {
  CityModel model;
  ModelIndex index;
  std::vector<CitySolid> solids;
  std::vector<TemplateInstance> instances;
};

constexpr std::string_view kFeatureAlone =
    "a CityJSONFeature alone has no transform, so its coordinates are not known: send the CityJSON "
    "line of its sequence first";
constexpr std::string_view kSequenceWithout =
    "the first line of the sequence has no transform, so the coordinates are not known";

/// Makes the solids of a CityJSONFeature without transform unreadable, for the reason.
void forget_solids(ModelIndex& index, std::string_view reason) {
  for (GeometryRef& ref : index.geometries) {
    if (!ref.is_of_solids()) continue;
    UnreadablePart part;
    part.source = {index.ids[ref.object],
                   ref.type,
                   ref.lod,
                   ref.geometry,
                   0,
                   "/CityObjects" + pointer_token(index.ids[ref.object]) + "/geometry" +
                       pointer_token(ref.geometry) + "/boundaries"};
    part.error = {ErrorCode::malformed, std::string(reason), {}, part.source.pointer};
    ref.is_unreadable = true;
    index.unreadable.push_back({ref.object, std::move(part)});
  }
}

Result<ReadModel> read_model(CityModel model, const CityHeader& header, const ReadOptions& options,
                             std::string_view without_transform = {}) {
  auto index = index_city_model(model, header.template_count);
  if (!index) return std::move(index).error();
  const bool is_feature = string_member(model.root, "type") == "CityJSONFeature";
  if (is_feature && !header.transform) forget_solids(*index, without_transform);
  if (header.transform) require_integers(model.vertices);
  // Without a transform the coordinates of surfaces are not known either.
  const bool is_placed = !is_feature || header.transform.has_value();
  const Surfaces surfaces = is_placed ? options.surfaces : Surfaces::ignore;
  auto solids = city_solids(model, *index, header, options.limits, surfaces);
  if (!solids) return std::move(solids).error();
  auto instances = city_instances(model, *index, header);
  return ReadModel{std::move(model), std::move(*index), std::move(*solids), std::move(instances)};
}

// For each boundary, the part of the skeleton that stands for it; "" where that is not solids.
std::vector<std::string> solid_references(const ReadModel& read) {
  std::vector<std::string> references(read.model.boundary_begin.size() - 1);
  for (const GeometryRef& ref : read.index.geometries) {
    if (ref.is_of_solids()) references[ref.boundary] = "{\"solids\":[0,0]}";
  }
  for (std::size_t begin = 0; begin < read.solids.size();) {
    std::size_t end = begin;
    const std::size_t boundary = read.solids[begin].boundary;
    while (end < read.solids.size() && read.solids[end].boundary == boundary) ++end;
    references[boundary] =
        solid_reference(read.solids[begin].submitted.source.geometry_type, begin, end - begin);
    begin = end;
  }
  return references;
}

// The skeleton of a whole document or feature, with the document's own vertex numbers.
std::string whole_skeleton(const ReadModel& read) {
  const std::vector<std::string> references = solid_references(read);
  const BoundaryPrinter print = [&](const Json& boundaries, std::string& out) {
    if (!boundaries.is_number_unsigned()) return append_json(out, boundaries);
    const auto boundary = boundaries.get<std::size_t>();
    if (!references[boundary].empty()) {
      out += references[boundary];
    } else {
      append_boundary(out, read.model.boundary(boundary), [](Index vertex) { return vertex; });
    }
  };
  std::vector<bool> is_used(read.model.vertices.size(), false);
  std::vector<std::vector<Index>> vertex_of;
  for (const CitySolid& solid : read.solids) {
    for (const Index vertex : solid.vertex_of) is_used[vertex] = true;
    vertex_of.push_back(solid.vertex_of);
  }
  std::vector<Index> others;
  for (Index vertex = 0; vertex < is_used.size(); ++vertex) {
    if (!is_used[vertex]) others.push_back(vertex);
  }

  std::string out = "{";
  for (const auto& [key, value] : read.model.root.get_ref<const Json::object_t&>()) {
    if (out.size() > 1) out += ',';
    append_json_string(out, key);
    out += ':';
    if (key == "CityObjects") {
      append_city_objects(out, value, print);
    } else if (key == "vertices") {
      out += skeleton_vertices(read.model, is_used.size(), vertex_of, others);
    } else {
      append_json(out, value);
    }
  }
  return out + '}';
}

void take_solids(std::vector<CitySolid>& solids, Feature& feature) {
  feature.solids.reserve(solids.size());
  for (CitySolid& solid : solids) feature.solids.push_back(std::move(solid.submitted));
}

// Gives the one feature of a text all that its objects have beside solids.
void take_others(ReadModel& read, Feature& feature) {
  feature.instances = std::move(read.instances);
  for (UnreadableRef& ref : read.index.unreadable) {
    feature.unreadable.push_back(std::move(ref.part));
  }
  for (SurfaceRef& ref : read.index.surfaces) feature.surfaces.push_back(std::move(ref.surface));
}

// Gives each feature the instances, the unreadable parts and the surfaces of its objects.
// `features` are those of split_city_model().
void share_out(std::vector<TemplateInstance> instances, ModelIndex index,
               std::vector<Feature>& features) {
  std::vector<std::size_t> feature_of(index.ids.size(), 0);
  std::size_t count = 0;
  for (std::size_t object = 0; object < index.ids.size(); ++object) {
    if (index.root_of[object] == object) feature_of[object] = count++;
  }
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const std::uint32_t root = index.root_of[index.instances[i].object];
    features[feature_of[root]].instances.push_back(std::move(instances[i]));
  }
  for (UnreadableRef& ref : index.unreadable) {
    features[feature_of[index.root_of[ref.object]]].unreadable.push_back(std::move(ref.part));
  }
  for (SurfaceRef& ref : index.surfaces) {
    features[feature_of[index.root_of[ref.object]]].surfaces.push_back(std::move(ref.surface));
  }
}

// The first line of a CityJSONSeq for the document `root`. The line has the default themes; all
// else of the appearance moves to the features, unless geometry templates, which may refer to it,
// exist.
std::string header_text(const Json& root) {
  std::string out = "{";
  for (const auto& [key, value] : root.get_ref<const Json::object_t&>()) {
    const bool is_local = key == "appearance" && find_member(root, "geometry-templates") == nullptr;
    if (is_local && find_member(value, "default-theme-material") == nullptr &&
        find_member(value, "default-theme-texture") == nullptr) {
      continue;
    }
    if (out.size() > 1) out += ',';
    append_json_string(out, key);
    out += ':';
    if (key == "CityObjects") {
      out += "{}";
    } else if (key == "vertices") {
      out += "[]";
    } else if (is_local) {
      Json themes = Json::object();
      for (const char* theme : {"default-theme-texture", "default-theme-material"}) {
        const Json* name = find_member(value, theme);
        if (name != nullptr) append_member(themes, theme, *name);
      }
      append_json(out, themes);
    } else {
      append_json(out, value);
    }
  }
  return out + '}';
}

/// Sets the feature's layout to the differences between its text and the text that would be written
/// without one. If the feature cannot be written, the layout keeps the whole text.
void keep_text(const CityHeader& header, std::string_view text, Feature& feature) {
  const auto plain = write_city_json_feature(header, feature);
  feature.layout = describe_layout(plain ? *plain : std::string(), text);
}

/// The header of a CityJSONFeature alone. Errors: malformed.
Result<CityHeader> lone_header(const Json& root) {
  Json header = Json::object();
  append_member(header, "type", "CityJSON");
  append_member(header, "version", "2.0");
  if (const Json* transform = find_member(root, "transform"); transform != nullptr) {
    append_member(header, "transform", *transform);
  }
  append_member(header, "CityObjects", Json::object());
  append_member(header, "vertices", Json::array());
  auto made = city_header(header);
  if (made) made->text = json_text(header);
  return made;
}

Error type_error(const Json& root) {
  const std::string type = string_member(root, "type");
  if (type == "CityJSONFeature") {
    return Error{ErrorCode::malformed,
                 "a CityJSONFeature alone has no transform: send the CityJSON line of its "
                 "sequence first",
                 {},
                 "/type"};
  }
  return Error{ErrorCode::malformed, "the type is not \"CityJSON\"", {}, "/type"};
}

void note_vertices_without_transform(const CityHeader& header, std::vector<std::string>& notes) {
  if (!header.transform && !header.version.starts_with("1.0")) {
    notes.push_back("no transform, which CityJSON " + header.version +
                    " requires: vertices read as coordinates");
  }
}

/// `without_transform`: why coordinates are not known if the header has no transform.
Result<Feature> read_feature_model(CityModel model, const CityHeader& header,
                                   const ReadOptions& options, std::string_view without_transform) {
  const auto stated = feature_id(model.root);
  if (!stated) return stated.error();
  const std::string& id = *stated;
  auto read = read_model(std::move(model), header, options, without_transform);
  if (!read) return std::move(read).error();
  const Json* object = find_member(*find_member(read->model.root, "CityObjects"), id);
  Feature feature;
  feature.id = id;
  if (object != nullptr) feature.type = string_member(*object, "type");
  feature.srid = header.srid;
  feature.skeleton = whole_skeleton(*read);
  take_solids(read->solids, feature);
  take_others(*read, feature);
  if (object == nullptr) {
    Error error{
        ErrorCode::malformed, "the id is not that of a city object in CityObjects", {}, "/id"};
    feature.unreadable.push_back({{id, "", "", 0, 0, error.pointer}, std::move(error)});
  }
  return feature;
}

/// The document of a CityJSONFeature alone, in which it is the only feature.
Result<Document> read_feature_document(Document document, CityModel model, std::string_view text,
                                       const ReadOptions& options) {
  auto header = lone_header(model.root);
  if (!header) return std::move(header).error();
  document.header = header->text;
  if (!header->transform && model.vertices.size() > 0) {
    document.notes.emplace_back(
        "a CityJSONFeature alone has no transform: the solids in it cannot be read");
  }
  auto feature = read_feature_model(std::move(model), *header, options, kFeatureAlone);
  if (!feature) return std::move(feature).error();
  if (options.split_features) {
    document.features.push_back(*std::move(feature));
    return document;
  }
  feature->id.clear();
  feature->type = "CityJSON";  // the whole document, as which it is written
  if (options.keep_text) keep_text(*header, text, *feature);
  document.features.push_back(*std::move(feature));
  return document;
}

}  // namespace

Result<Document> read_lone_feature(std::string text, const std::string& header,
                                   const ReadOptions& options) {
  auto city_header = read_city_json_header(header);
  if (!city_header) return std::move(city_header).error();
  // Line ends outside strings are white space, and JSON allows none inside strings.
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  auto feature = read_city_json_feature(*city_header, text, options);
  if (!feature) return std::move(feature).error();
  Document document;
  document.format = Format::city_json_seq;
  document.header = header;
  auto templates = read_geometry_templates(*city_header, options.limits, options.surfaces);
  if (!templates) return std::move(templates).error();
  document.templates = std::move(templates->solids);
  document.template_surfaces = std::move(templates->surfaces);
  document.features.push_back(*std::move(feature));
  return document;
}

Result<CityHeader> read_city_json_header(std::string_view line, const Limits& limits) {
  auto model = parse_city_model(line, CityText::document, limits);
  if (!model) return std::move(model).error();
  if (string_member(model->root, "type") != "CityJSON") return type_error(model->root);
  const Json* objects = find_member(model->root, "CityObjects");
  if (objects != nullptr && !objects->empty()) {
    return Error{ErrorCode::malformed,
                 "the first line of a CityJSONSeq must have no city objects of its own",
                 {},
                 "/CityObjects"};
  }
  auto header = city_header(model->root);
  if (!header) return header;
  if (!model->root.contains("CityObjects"))
    append_member(model->root, "CityObjects", Json::object());
  if (model->vertices.is_present) {
    *find_member(model->root, "vertices") = Json::array();
  } else {
    append_member(model->root, "vertices", Json::array());
  }
  header->text = json_text(model->root);
  return header;
}

Result<Feature> read_city_json_feature(const CityHeader& header, std::string_view line,
                                       const ReadOptions& options) {
  auto model = parse_city_model(line, CityText::document, options.limits);
  if (!model) return std::move(model).error();
  auto feature = read_feature_model(std::move(*model), header, options, kSequenceWithout);
  if (feature) {
    if (Status status = check_solid_count(*feature, options.limits); !status) {
      return std::move(status).error();
    }
  }
  if (feature && options.keep_text) keep_text(header, line, *feature);
  return feature;
}

Result<Document> read_city_json(std::string_view text, const ReadOptions& options) {
  Document document;
  document.format = Format::city_json;
  if (text.starts_with(kByteOrderMark)) document.notes.push_back("byte order mark skipped");
  auto model = parse_city_model(text, CityText::document, options.limits);
  if (!model) return std::move(model).error();
  if (string_member(model->root, "type") == "CityJSONFeature") {
    return read_feature_document(std::move(document), *std::move(model), text, options);
  }
  if (string_member(model->root, "type") != "CityJSON") return type_error(model->root);
  auto header = city_header(model->root);
  if (!header) return std::move(header).error();
  header->text = header_text(model->root);
  document.header = header->text;
  note_vertices_without_transform(*header, document.notes);
  auto templates = read_geometry_templates(*header, options.limits, options.surfaces);
  if (!templates) return std::move(templates).error();
  document.templates = std::move(templates->solids);
  document.template_surfaces = std::move(templates->surfaces);
  for (std::string& note : templates->notes) document.notes.push_back(std::move(note));

  auto read = read_model(std::move(*model), *header, options);
  if (!read) return std::move(read).error();
  note_dangling_references(read->model, read->index);
  for (std::string& note : read->index.notes) document.notes.push_back(std::move(note));
  if (options.split_features) {
    auto features =
        split_city_model(std::move(read->model), read->index, std::move(read->solids), *header);
    if (!features) return std::move(features).error();
    document.features = std::move(*features);
    share_out(std::move(read->instances), std::move(read->index), document.features);
    return document;
  }
  Feature feature;
  feature.type = "CityJSON";
  feature.srid = header->srid;
  feature.skeleton = whole_skeleton(*read);
  take_solids(read->solids, feature);
  take_others(*read, feature);
  if (options.keep_text) keep_text(*header, text, feature);
  document.features.push_back(std::move(feature));
  return document;
}

Result<Document> read_city_json_seq(std::string_view text, const ReadOptions& options) {
  const auto rest_of_text = [&text](std::span<std::uint8_t> bytes) -> Result<std::size_t> {
    const std::size_t count = std::min(text.size(), bytes.size());
    std::copy_n(text.begin(), count, bytes.begin());
    text.remove_prefix(count);
    return count;
  };
  auto reader = FeatureReader::open(rest_of_text, ".jsonl", options);
  if (!reader) return std::move(reader).error();
  std::vector<Feature> features;
  for (;;) {
    auto found = reader->next();
    if (!found) return std::move(found).error();
    if (!*found) break;
    auto feature = reader->read(**std::move(found));
    if (!feature) return std::move(feature).error();
    features.push_back(*std::move(feature));
  }
  Document document = reader->document();
  document.features = std::move(features);
  if (options.keep_text) document.framing = reader->framing();
  return document;
}

}  // namespace watertight::formats
