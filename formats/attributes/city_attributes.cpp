// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/attributes/city_attributes.h"

#include <algorithm>

#include "formats/city_json/model.h"

namespace watertight::formats {
namespace {

/// The value of a number, text or truth value; nothing for another JSON value.
std::optional<AttributeValue> scalar_of(const Json& json) {
  using Type = AttributeValue::Type;
  if (json.is_string()) return AttributeValue{Type::text, json.get_ref<const std::string&>()};
  if (json.is_boolean()) return AttributeValue{Type::truth, json.get<bool>() ? "true" : "false"};
  if (is_number_value(json)) return AttributeValue{Type::number, json_text(json)};
  return std::nullopt;
}

/// Calls `visit` with the path and the JSON value of each member that is no object.
template <class Visit>
void visit_members(const Json& object, std::string& path, const Visit& visit) {
  for (const auto& [key, value] : object.get_ref<const Json::object_t&>()) {
    const std::size_t length = path.size();
    if (length + key.size() > kLongestAttributePath) continue;
    path += key;
    if (value.is_object()) {
      path += '.';
      visit_members(value, path, visit);
    } else {
      visit(path, value);
    }
    path.resize(length);
  }
}

/// Calls `visit` with the id of the object, the path and the JSON value of each attribute.
template <class Visit>
void visit_attributes(std::string_view skeleton, const Visit& visit) {
  const auto model = parse_city_model(skeleton, CityText::skeleton, kOwnText);
  const Json* objects = model ? find_member(model->root, "CityObjects") : nullptr;
  if (objects == nullptr || !objects->is_object()) return;
  for (const auto& member : objects->get_ref<const Json::object_t&>()) {
    const Json* attributes = find_member(member.second, "attributes");
    if (attributes == nullptr || !attributes->is_object()) continue;
    if (member.first.size() > kLongestAttributePath) continue;
    std::string path;
    visit_members(*attributes, path, [&](const std::string& name, const Json& value) {
      visit(member.first, name, value);
    });
  }
}

}  // namespace

std::vector<ObjectAttribute> attribute_values(std::string_view skeleton,
                                              std::span<const std::string> names) {
  std::vector<ObjectAttribute> values;
  const auto add = [&](const std::string& object, const std::string& name, const Json& json) {
    const auto found = std::lower_bound(names.begin(), names.end(), name);
    if (found == names.end() || *found != name) return;
    const auto index = static_cast<std::size_t>(found - names.begin());
    const auto add_scalar = [&](const Json& element) {
      if (values.size() >= kMostAttributeValues) return;
      if (auto value = scalar_of(element)) values.push_back({object, index, *std::move(value)});
    };
    if (!json.is_array()) return add_scalar(json);
    for (const Json& element : json.get_ref<const Json::array_t&>()) add_scalar(element);
  };
  visit_attributes(skeleton, add);
  return values;
}

std::vector<AttributeName> attribute_names(std::string_view skeleton) {
  std::vector<AttributeName> names;
  const auto add = [&](const std::string& /*object*/, const std::string& name, const Json& json) {
    const std::size_t before = names.size();
    const auto add_scalar = [&](const Json& element) {
      if (auto value = scalar_of(element)) names.push_back({name, value->type});
    };
    if (json.is_array()) {
      for (const Json& element : json.get_ref<const Json::array_t&>()) add_scalar(element);
    } else {
      add_scalar(json);
    }
    if (names.size() == before) names.push_back({name, std::nullopt});
  };
  visit_attributes(skeleton, add);
  return names;
}

}  // namespace watertight::formats
