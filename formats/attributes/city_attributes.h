// SPDX-License-Identifier: GPL-3.0-or-later
//
// The attributes of the city objects of a feature. The name of an attribute is the path to its
// value: "a.b" is the member b of the attribute a, or the attribute "a.b". The elements of an array
// are several values of one attribute, unless they are arrays or objects.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/attribute_value.h"

namespace watertight::formats {

constexpr std::size_t kMostAttributeValues = 10'000;  // of a feature; more are left out
/// Paths and ids of objects that are longer, in bytes, are left out.
constexpr std::size_t kLongestAttributePath = 1024;

struct ObjectAttribute {
  std::string object;    // the id of the city object
  std::size_t name = 0;  // the index of the attribute's name
  AttributeValue value;
};

/// The values that the attributes of these names have in the objects of a skeleton; a null is no
/// value. Empty for a text that is no skeleton of a city model. Requires names in order. Cost:
/// linear in the skeleton.
std::vector<ObjectAttribute> attribute_values(std::string_view skeleton,
                                              std::span<const std::string> names);

struct AttributeName {
  std::string name;
  std::optional<AttributeValue::Type> type;  // nothing: null, or an array without values
};

/// The names of all attributes of all objects of a skeleton, once for each value. Cost: linear in
/// the skeleton and in the lengths of the names.
std::vector<AttributeName> attribute_names(std::string_view skeleton);

}  // namespace watertight::formats
