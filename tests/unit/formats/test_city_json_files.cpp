// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests real files (tests/data/README.md): good files come back equal, broken ones give the right
// error.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/document.h"
#include "samples.h"

namespace watertight::test_city_json_files {
namespace {

using OrderedJson = nlohmann::ordered_json;

// The error that each broken file must give: a JSON Pointer or a part of the message.
const std::map<std::string, std::string> kBroken{
    {"invalid_missing_type.json", "/type"},
    {"invalid_out_of_range_vertex_index.json",
     "/CityObjects/invalid_out_of_range_vertex_index/geometry/0/boundaries/0/0/0/2"},
    {"invalid_u64_f64_bounds.json", "/vertices/1/0"},
    {"invalid_cityjsonfeature_root_id_unresolved.city.jsonl", "/id"},
    {"with-errors.json", "line 1934"},
    {"notransform.city.jsonl", "the first line of the sequence has no transform"},
    {"unclosedbracket.city.jsonl", "line 1"},
};

std::vector<std::string> city_files() {
  std::vector<std::string> names;
  const std::string folder = test::source_path("tests/data/cityjson");
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<OrderedJson> json_lines(std::string_view text, Format format) {
  if (format == Format::city_json) return {OrderedJson::parse(text)};
  std::vector<OrderedJson> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (text.substr(0, end).find_first_not_of(" \r\t") != std::string_view::npos) {
      lines.push_back(OrderedJson::parse(text.substr(0, end)));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

TEST_CASE("real city models come back equal, with the order of their members") {
  for (const std::string& name : city_files()) {
    if (kBroken.contains(name)) continue;
    INFO(name);
    const std::string text = test::file_text("cityjson/" + name);
    const auto format = formats::detect_format(name, as_bytes(text));
    REQUIRE(format);
    const auto document = test::read(text, *format, false);
    REQUIRE(document);
    const auto again = formats::write_document(*document, *format);
    REQUIRE(again);
    CHECK(json_lines(as_text(*again), *format) == json_lines(text, *format));
  }
}

TEST_CASE("broken city models give an error that names the place") {
  for (const auto& [name, expected] : kBroken) {
    INFO(name);
    const std::string text = test::file_text("cityjson/" + name);
    const auto format = formats::detect_format(name, as_bytes(text));
    REQUIRE(format);
    const auto document = test::read(text, *format);
    std::vector<Error> errors;
    if (!document) errors.push_back(document.error());
    for (const Feature& feature : document ? document->features : std::vector<Feature>{}) {
      for (const auto& part : feature.unreadable) errors.push_back(part.error);
    }
    REQUIRE_FALSE(errors.empty());
    const Error& error = errors.front();
    INFO(to_string(error));
    const bool is_expected =
        error.pointer == expected || error.message.find(expected) != std::string::npos;
    CHECK(is_expected);
  }
}

// Replaces vertex and appearance indices by the elements that they name, so that two city models
// compare equal if they differ in these numbers only.
OrderedJson resolved(const OrderedJson& nested, const OrderedJson& list) {
  if (nested.is_array()) {
    OrderedJson out = OrderedJson::array();
    for (const OrderedJson& element : nested) out.push_back(resolved(element, list));
    return out;
  }
  return nested.is_null() ? nested : list.at(nested.get<std::size_t>());
}

OrderedJson resolved_texture(const OrderedJson& nested, const OrderedJson& appearance) {
  if (!nested.empty() && nested[0].is_array()) {
    OrderedJson out = OrderedJson::array();
    for (const OrderedJson& element : nested) out.push_back(resolved_texture(element, appearance));
    return out;
  }
  OrderedJson out = OrderedJson::array();
  for (std::size_t i = 0; i < nested.size(); ++i) {
    out.push_back(resolved(nested[i],
                           i == 0 ? appearance.at("textures") : appearance.at("vertices-texture")));
  }
  return out;
}

void resolve_geometry(OrderedJson& geometry, const OrderedJson& vertices,
                      const OrderedJson& appearance) {
  if (geometry.contains("boundaries")) {
    geometry["boundaries"] = resolved(geometry["boundaries"], vertices);
  }
  if (geometry.contains("material") && geometry["material"].is_object()) {
    for (auto& [name, theme] : geometry["material"].items()) {
      for (const char* key : {"value", "values"}) {
        if (theme.contains(key)) theme[key] = resolved(theme[key], appearance.at("materials"));
      }
    }
  }
  if (geometry.contains("texture") && geometry["texture"].is_object()) {
    for (auto& [name, theme] : geometry["texture"].items()) {
      if (theme.contains("values")) theme["values"] = resolved_texture(theme["values"], appearance);
    }
  }
}

OrderedJson resolved_model(std::string_view text) {
  OrderedJson model = OrderedJson::parse(text);
  const OrderedJson vertices = model["vertices"];
  const OrderedJson appearance =
      model.contains("appearance") ? model["appearance"] : OrderedJson::object();
  for (auto& [id, object] : model["CityObjects"].items()) {
    if (object.contains("geometry")) {
      for (OrderedJson& geometry : object["geometry"])
        resolve_geometry(geometry, vertices, appearance);
    }
    if (object.contains("address")) {
      for (OrderedJson& address : object["address"]) {
        if (!address.is_object() || !address.contains("location")) continue;
        OrderedJson& boundaries = address["location"]["boundaries"];
        boundaries = resolved(boundaries, vertices);
      }
    }
  }
  model.erase("vertices");
  model.erase("appearance");
  return model;
}

TEST_CASE("a city model put together from its features is equivalent") {
  for (const std::string& name : city_files()) {
    if (kBroken.contains(name) || !name.ends_with(".json")) continue;
    INFO(name);
    const std::string text = test::file_text("cityjson/" + name);
    // The test's own parser takes no byte order mark.
    if (text.starts_with("\xEF\xBB\xBF")) continue;
    const auto document = test::read(text, Format::city_json);
    REQUIRE(document);
    const auto again = formats::write_document(*document, Format::city_json);
    REQUIRE(again);
    // Objects are grouped by feature, and members of the root are not in source order.
    CHECK(nlohmann::json(resolved_model(as_text(*again))) == nlohmann::json(resolved_model(text)));
  }
}

}  // namespace
}  // namespace watertight::test_city_json_files
