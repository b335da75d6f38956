// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/written/attribute_writer.h"

#include <algorithm>
#include <array>

#include "formats/gml/city/names.h"
#include "formats/gml/written/kinds.h"
#include "formats/gml/xml.h"

namespace watertight::formats {
namespace {

constexpr std::string_view kOfGml = "description name";
constexpr std::string_view kOfCityObjects = "creationDate terminationDate";
constexpr std::string_view kOfPlace = "relativeToTerrain relativeToWater";
constexpr std::string_view kOfModules = "class function usage";
constexpr std::string_view kGenericPrefix = "generic:";  // values.cpp puts it before known names

bool is_text_value(const Json& value) {
  return value.is_string() || value.is_boolean() || is_number_value(value);
}

bool is_whole_number(const Json& value) {
  if (!is_number_value(value)) return false;
  return json_text(value).find_first_of(".eE") == std::string::npos;
}

/// Whether a value is a number with its unit: {"value": 3, "uom": "m"}.
bool is_measure(const Json& value) {
  if (!value.is_object() || value.size() != 2) return false;
  const Json* number = find_member(value, "value");
  return number != nullptr && is_number_value(*number) && !string_member(value, "uom").empty();
}

/// Whether a value has the form {"informationSystem": "...", "externalObject": {"name": "..."}},
/// with "uri" as well as "name".
bool is_external_reference(const Json& value) {
  const Json* object = find_member(value, "externalObject");
  if (object == nullptr || !object->is_object() || object->size() != 1 || value.size() > 2) {
    return false;
  }
  const std::string& key = object->begin().key();
  const Json* system = find_member(value, "informationSystem");
  return (key == "name" || key == "uri") && object->begin()->is_string() &&
         (value.size() == 1 || (system != nullptr && system->is_string()));
}

std::string_view generic_element(const Json& value, std::string_view type) {
  if (is_number_value(value)) {
    return is_whole_number(value) ? "gen:intAttribute" : "gen:doubleAttribute";
  }
  if (value.is_string() && type == "date") return "gen:dateAttribute";
  if (value.is_string() && type == "uri") return "gen:uriAttribute";
  return "gen:stringAttribute";
}

}  // namespace

std::string text_of_value(const Json& value) {
  return value.is_string() ? value.get<std::string>() : json_text(value);
}

/// The value of an attribute; null if there is none.
const Json* AttributeWriter::attribute(std::string_view key) const {
  const auto found = attributes_.find(key);
  return found == attributes_.end() ? nullptr : found->second;
}

/// Whether the schemas have a property of this name here.
bool AttributeWriter::is_property(std::string_view key) const {
  return std::ranges::any_of(std::array{kOfGml, kOfCityObjects, kOfPlace, kOfModules, properties_},
                             [&](std::string_view list) { return has_word(list, key); });
}

/// Whether a property can have this value: a text, or several, which are elements of their own.
bool AttributeWriter::can_be_property(std::string_view key, const Json& value) const {
  if (!is_property(key)) return false;
  if (!value.is_array()) return is_text_value(value);
  return !value.empty() && std::ranges::all_of(value, is_text_value);
}

/// Whether an attribute is written with the one that it belongs to: "class_codeSpace".
bool AttributeWriter::is_beside(std::string_view key) const {
  for (const std::string_view end : {"_codeSpace", "_uom", "_type"}) {
    if (!key.ends_with(end)) continue;
    const std::string_view of = key.substr(0, key.size() - end.size());
    const Json* value = attribute(of);
    if (value == nullptr) continue;
    const bool is_generic = !can_be_property(of, *value);
    if (end == "_type" ? is_generic && value->is_string()
                       : (end == "_codeSpace" && value->is_object()) || !is_generic) {
      return true;
    }
  }
  return false;
}

/// The text of the attribute beside an attribute; of a list, that of its element `number`.
std::string AttributeWriter::beside(std::string_view key, std::string_view end,
                                    std::size_t number) const {
  const Json* value = attribute(std::string(key).append(end));
  if (value == nullptr) return {};
  if (value->is_array()) value = number < value->size() ? &(*value)[number] : nullptr;
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

void AttributeWriter::property(std::string_view prefix, std::string_view key) {
  const Json* value = attribute(key);
  if (value == nullptr || !can_be_property(key, *value)) return;
  const std::string name = std::string(prefix).append(":").append(key);
  const auto write_one = [&](const std::string& text, std::size_t number) {
    xml_.leaf(
        name, text,
        {{"codeSpace", beside(key, "_codeSpace", number)}, {"uom", beside(key, "_uom", number)}});
  };
  if (!value->is_array()) return write_one(text_of_value(*value), 0);
  std::string list;
  for (std::size_t i = 0; i < value->size(); ++i) {
    const std::string text = text_of_value((*value)[i]);
    if (!is_list_property(key)) {
      write_one(text, i);
    } else {
      list.append(i == 0 ? "" : " ").append(text);
    }
  }
  if (is_list_property(key)) write_one(list, 0);
}

void AttributeWriter::external_references() {
  const Json* value = attribute("externalReference");
  if (value == nullptr) return;
  const auto write_one = [&](const Json& reference) {
    xml_.open("core:externalReference");
    const std::string system = string_member(reference, "informationSystem");
    if (!system.empty()) xml_.leaf("core:informationSystem", system);
    const Json& object = *find_member(reference, "externalObject");
    xml_.open("core:externalObject");
    xml_.leaf("core:" + object.begin().key(), text_of_value(*object.begin()));
    xml_.close();
    xml_.close();
  };
  if (is_external_reference(*value)) write_one(*value);
  if (!value->is_array() || !std::ranges::all_of(*value, is_external_reference)) return;
  for (const Json& reference : *value) write_one(reference);
}

void AttributeWriter::generic(std::string_view key, const Json& value, std::string_view type,
                              std::string_view code_space) {
  if (value.is_array()) {
    for (const Json& element : value) generic(key, element, type, code_space);
  } else if (value.is_null()) {
    ++left_out_["attributes without a value"];
  } else if (is_measure(value)) {
    xml_.open("gen:measureAttribute", {{"name", key}});
    xml_.leaf("gen:value", text_of_value(*find_member(value, "value")),
              {{"uom", string_member(value, "uom")}});
    xml_.close();
  } else if (value.is_object()) {
    xml_.open("gen:genericAttributeSet", {{"name", key}, {"codeSpace", code_space}});
    for (const auto& [name, member] : value.items()) generic(name, member, {}, {});
    xml_.close();
  } else {
    if (value.is_boolean()) ++left_out_["the type of the values true and false"];
    xml_.open(generic_element(value, type), {{"name", key}});
    xml_.leaf("gen:value", text_of_value(value));
    xml_.close();
  }
}

void AttributeWriter::write(const Json& attributes, std::string_view prefix,
                            std::string_view properties) {
  if (!attributes.is_object()) return;
  attributes_.clear();
  for (const auto& [key, value] : attributes.get_ref<const Json::object_t&>()) {
    attributes_.emplace(key, &value);
  }
  properties_ = properties;
  const auto write_all = [&](std::string_view space, std::string_view list) {
    while (!list.empty()) property(space, take_word(list));
  };
  write_all("gml", kOfGml);
  write_all("core", kOfCityObjects);
  external_references();
  write_all("core", kOfPlace);
  for (const auto& [key, value] : attributes.items()) {
    const bool is_reference =
        key == "externalReference" &&
        (is_external_reference(value) ||
         (value.is_array() && std::ranges::all_of(value, is_external_reference)));
    if (is_reference || can_be_property(key, value) || is_beside(key)) continue;
    std::string_view name = key;
    if (name.starts_with(kGenericPrefix)) name.remove_prefix(kGenericPrefix.size());
    generic(name, value, beside(key, "_type", 0), beside(key, "_codeSpace", 0));
  }
  write_all(prefix, kOfModules);
  write_all(prefix, properties);
}

}  // namespace watertight::formats
