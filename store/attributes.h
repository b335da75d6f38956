// SPDX-License-Identifier: GPL-3.0-or-later
//
// Attributes of the objects of features that the owner of a collection has chosen to be queried.
// The store keeps their values beside the features; a function of the caller reads them from the
// texts, which the store does not understand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/attribute_value.h"
#include "base/result.h"

namespace watertight::store {

struct StoredFeature;

/// A value that an attribute has in an object of a feature.
struct FeatureAttribute {
  std::string object;    // its id
  std::size_t name = 0;  // the index of the attribute's name
  AttributeValue value;
};

/// Reads the values of the attributes of these names, which are in order.
using AttributeReader = std::function<Result<std::vector<FeatureAttribute>>(
    const StoredFeature& feature, std::span<const std::string> names)>;

/// A chosen attribute of a collection.
struct ChosenAttribute {
  std::string name;
  double share = 1;  // of the features whose values are kept; 1: the attribute can be queried
  bool has_numbers = false, has_texts = false, has_truths = false;  // among the values
  bool is_complete() const { return share == 1; }
};

/// A change of the attributes that are chosen. An attribute that is chosen can be added again.
struct AttributeChange {
  std::vector<std::string> add, remove;
};

enum class Comparison : std::uint8_t { equal, different, less, at_most, greater, at_least };

/// Holds for a feature if one of its objects has a value of the attribute that compares so with one
/// of `values`, of the same type. Numbers compare exactly, texts by their bytes.
struct AttributeCondition {
  std::string name;
  Comparison comparison = Comparison::equal;
  std::vector<AttributeValue> values;
};

/// The limits of attributes.
constexpr std::size_t kMostAttributes = 1000;        // that a collection chooses
constexpr std::size_t kLongestAttributeName = 1024;  // bytes
constexpr std::size_t kMostConditions = 16;          // of a query
constexpr std::size_t kLongestNumber = 1000;         // characters
constexpr std::int64_t kLargestExponent = 1000;

/// Ok for a name that an attribute can have: 1 to 1024 bytes of UTF-8 without NUL. Errors:
/// invalid_argument.
Status check_attribute_name(const std::string& name);

/// Whether the store keeps a value: no text with NUL, no number of more than 1,000 characters or
/// with an exponent beyond 1,000.
bool is_kept(const AttributeValue& value);

}  // namespace watertight::store
