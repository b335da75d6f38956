// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handlers of schemas: what can be queried, what gives an order, and the properties of features.
#include "server/features/schemas.h"

#include "pipeline/shown/properties.h"
#include "pipeline/shown/shown_feature.h"
#include "server/features/links.h"
#include "server/items/kept_answer.h"

namespace watertight::server {
namespace {

constexpr std::string_view kSchemaType = "application/schema+json";

/// The refusal of a client that takes no JSON Schema.
std::optional<Response> unless_schema(const RoutedRequest& request) {
  const std::string* format = request.target.parameter("f");
  const bool is_taken =
      format != nullptr
          ? *format == "json"
          : negotiate(request.request.header("accept"), {kSchemaType, kJson}).has_value();
  if (is_taken) return std::nullopt;
  return refuse(406, "not-acceptable", "this resource is a JSON Schema");
}

/// The schema under `name` of a collection, without properties.
Json schema_head(const RoutedRequest& request, std::string_view name) {
  const std::string& id = request.target.segments[1];
  std::string address = base_url(request) + "/collections/" + percent_encode(id) + "/";
  return Json{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"$id", address.append(name)},
              {"type", "object"},
              {"title", id},
              {"properties", Json::object()}};
}

/// A property of these types; of any, if there are none.
Json property_of(const std::string& title, Json types) {
  if (types.empty()) types = Json::array({"string", "number", "boolean"});
  return Json{{"title", title}, {"type", types.size() == 1 ? types[0] : types}};
}

/// Adds the attributes that are chosen and complete.
void add_chosen(Json& schema, const std::vector<store::ChosenAttribute>& chosen) {
  for (const store::ChosenAttribute& attribute : chosen) {
    if (!attribute.is_complete()) continue;
    schema["properties"][attribute.name] = property_of(attribute.name, json_types(attribute));
  }
}

Json types_of_values(const pipeline::ValueKinds& kinds) {
  Json types = Json::array();
  if (kinds.has_texts) types.push_back("string");
  // An integer beyond 64 bits counts as a number.
  if (kinds.has_reals) types.push_back("number");
  if (kinds.has_integers && !kinds.has_reals) types.push_back("integer");
  if (kinds.has_truths) types.push_back("boolean");
  if (kinds.has_arrays) types.push_back("array");
  if (kinds.has_objects) types.push_back("object");
  return types;
}

/// The properties that the service adds to the attributes.
void add_own(Json& schema) {
  const auto add = [&schema](const char* name, const char* title, const char* type) {
    std::string full(pipeline::kOwnProperty);
    Json& property = schema["properties"][full.append(name)];
    property = Json{{"title", title}, {"type", type}, {"readOnly", true}};
    return &property;
  };
  (*add("type", "the type of the top-level object", "string"))["x-ogc-role"] = "type";
  add("proven", "whether all solids are proven", "boolean");
  add("solids", "the number of solids", "integer");
  add("unproven_solids", "the number of solids that are not proven", "integer");
  add("repaired_solids", "the number of solids that were repaired before they were stored",
      "integer");
  add("version", "the version of the feature", "integer");
  add("no_geometry", "why there is no geometry", "string");
}

/// The schema of the features of a collection. Reads all of them.
Result<Json> schema_of_features(const RoutedRequest& request) {
  const auto found = pipeline::found_properties(*request.service.store, request.target.segments[1],
                                                request.is_cancelled);
  if (!found) return found.error();
  Json schema = schema_head(request, "schema");
  Json& properties = schema["properties"];
  for (const auto& [name, kinds] : *found)
    properties[name] = property_of(name, types_of_values(kinds));
  // An attribute can have one of these names, which are free then.
  const auto free_name = [&properties](std::string name) {
    while (properties.contains(name)) name.insert(0, pipeline::kOwnProperty);
    return name;
  };
  properties[free_name("id")] =
      Json{{"title", "the id of the feature"}, {"type", "string"}, {"x-ogc-role", "id"}};
  properties[free_name("geometry")] = Json{{"title", "the facets of the feature, lines and points"},
                                           {"format", "geometry-any"},
                                           {"x-ogc-role", "primary-geometry"}};
  add_own(schema);
  return schema;
}

}  // namespace

Json json_types(const store::ChosenAttribute& attribute) {
  Json types = Json::array();
  if (attribute.has_numbers) types.push_back("number");
  if (attribute.has_texts) types.push_back("string");
  if (attribute.has_truths) types.push_back("boolean");
  return types;
}

Response get_queryables(const RoutedRequest& request) {
  if (auto refusal = unless_schema(request)) return *std::move(refusal);
  const auto chosen = request.service.store->attributes(request.target.segments[1]);
  if (!chosen) return to_response(to_problem(chosen.error()));
  Json schema = schema_head(request, "queryables");
  schema["properties"]["geometry"] = {
      {"title", "the box of a feature, for S_INTERSECTS in a filter"},
      {"format", "geometry-any"},
      {"x-ogc-role", "primary-geometry"}};
  add_chosen(schema, *chosen);
  schema["additionalProperties"] = false;
  return json_response(schema, kSchemaType);
}

Response get_sortables(const RoutedRequest& request) {
  if (auto refusal = unless_schema(request)) return *std::move(refusal);
  const auto chosen = request.service.store->attributes(request.target.segments[1]);
  if (!chosen) return to_response(to_problem(chosen.error()));
  Json schema = schema_head(request, "sortables");
  add_chosen(schema, *chosen);
  schema["additionalProperties"] = false;
  return json_response(schema, kSchemaType);
}

Response get_schema(const RoutedRequest& request) {
  if (auto refusal = unless_schema(request)) return *std::move(refusal);
  const auto collection = request.service.store->collection(request.target.segments[1]);
  if (!collection) return to_response(to_problem(collection.error()));
  return kept_or_made(request, *collection, "schema", kSchemaType, [&]() -> Result<std::string> {
    const auto schema = schema_of_features(request);
    if (!schema) return schema.error();
    return schema->dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  });
}

}  // namespace watertight::server
