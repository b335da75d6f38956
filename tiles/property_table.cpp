// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiles/property_table.h"

#include <charconv>
#include <optional>
#include <set>
#include <unordered_map>

namespace watertight::tiles {
namespace {

using Json = nlohmann::ordered_json;

std::optional<double> number_of(std::string_view text) {
  if (text.empty() || (text.front() != '-' && (text.front() < '0' || text.front() > '9'))) {
    return std::nullopt;
  }
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// A value as a person reads it: a text without its quotes; "" for null.
std::string plain_text(const std::string& json) {
  if (json == "null") return {};
  if (json.empty() || json.front() != '"') return json;
  const Json value = Json::parse(json, nullptr, false);
  return value.is_string() ? value.get<std::string>() : json;
}

/// A name with letters, digits and underscores only, unlike those in `taken`.
std::string identifier_of(const std::string& name, std::set<std::string>& taken) {
  std::string id;
  for (const char letter : name) {
    const bool is_plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                          (letter >= '0' && letter <= '9');
    id += is_plain ? letter : '_';
  }
  if (id.empty() || (id.front() >= '0' && id.front() <= '9')) id.insert(id.begin(), '_');
  const std::string stem = id;
  for (int number = 2; !taken.insert(id).second; ++number) {
    id = stem;
    id.append("_").append(std::to_string(number));
  }
  return id;
}

/// The values of an attribute, "" (no JSON text) for features without it.
struct Attribute {
  std::string name;
  std::vector<const std::string*> values;
};

std::vector<Attribute> attributes_of(std::span<const FeatureMesh* const> features) {
  std::vector<Attribute> attributes;
  std::unordered_map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (const auto& [name, value] : features[i]->properties) {
      if (value == "null") continue;
      const auto [place, is_new] = places.try_emplace(name, attributes.size());
      if (is_new) {
        if (attributes.size() >= kMostColumns - 2) {
          places.erase(place);
          continue;
        }
        attributes.push_back({name, std::vector<const std::string*>(features.size())});
      }
      attributes[place->second].values[i] = &value;
    }
  }
  return attributes;
}

void append_text(PropertyColumn& column, std::string_view text) {
  column.text += text;
  column.offsets.push_back(static_cast<std::uint32_t>(column.text.size()));
}

PropertyColumn text_column(std::string id, std::string name) {
  PropertyColumn column;
  column.id = std::move(id);
  column.name = std::move(name);
  column.offsets = {0};
  return column;
}

PropertyColumn column_of(const Attribute& attribute, std::string id) {
  PropertyColumn column = text_column(std::move(id), attribute.name);
  column.is_number = true;
  for (const std::string* value : attribute.values) {
    const auto number = value == nullptr ? kNoNumber : number_of(*value);
    if (!number) {
      column.is_number = false;
      break;
    }
    column.numbers.push_back(*number);
  }
  if (column.is_number) return column;
  for (const std::string* value : attribute.values) {
    append_text(column, value == nullptr ? std::string() : plain_text(*value));
  }
  return column;
}

}  // namespace

std::vector<PropertyColumn> property_columns(std::span<const FeatureMesh* const> features) {
  std::set<std::string> taken{"id", "type"};
  std::vector<PropertyColumn> columns{text_column("id", "id"), text_column("type", "type")};
  for (const FeatureMesh* feature : features) {
    append_text(columns[0], feature->id);
    append_text(columns[1], feature->type);
  }
  for (const Attribute& attribute : attributes_of(features)) {
    columns.push_back(column_of(attribute, identifier_of(attribute.name, taken)));
  }
  return columns;
}

Json property_class(std::span<const PropertyColumn> columns) {
  Json properties = Json::object();
  for (const PropertyColumn& column : columns) {
    Json& property = properties[column.id];
    property["name"] = column.name;
    property["type"] = column.is_number ? "SCALAR" : "STRING";
    if (column.is_number) {
      property["componentType"] = "FLOAT64";
      property["noData"] = kNoNumber;
    } else if (column.id == "id") {
      property["semantic"] = "ID";
      property["required"] = true;
      continue;
    } else {
      property["noData"] = "";
    }
  }
  return {{"name", "Feature"}, {"properties", std::move(properties)}};
}

}  // namespace watertight::tiles
