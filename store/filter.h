// SPDX-License-Identifier: GPL-3.0-or-later
//
// A condition on features, put together of conditions on attributes and places.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/attribute_value.h"
#include "store/attributes.h"

namespace watertight::store {

struct StoredBox {
  std::array<double, 3> min{};
  std::array<double, 3> max{};
};

/// A tree of conditions. A condition on an attribute is true if one of the feature's objects has a
/// value for which it holds, false if there are values and it holds for none, and unknown if there
/// are none; `no` of unknown is unknown, and only features for which the whole is true are
/// selected, as in SQL.
struct Filter {
  enum class Kind : std::uint8_t {
    all,      // all of `parts`
    any,      // one of `parts`
    no,       // not the one of `parts`
    compare,  // the attribute `name` compares so with one of `values`, of the same type
    between,  // the attribute is at least the first and at most the second of `values`
    like,     // the attribute is a text that the first of `values` describes: % any text, _ one
              // character, a backslash before one of them itself
    is_null,  // no object has a value of the attribute
    box,      // the closed box of the feature has a point in common with `box`
    constant  // `truth`
  };
  Kind kind = Kind::constant;
  std::vector<Filter> parts = {};
  std::string name = {};
  Comparison comparison = Comparison::equal;
  std::vector<AttributeValue> values = {};
  StoredBox box = {};
  bool truth = true;
};

/// The limits of a filter.
constexpr std::size_t kMostFilterParts = 200;  // conditions and values in the whole tree
constexpr std::size_t kDeepestFilter = 32;

/// The filter that is true if all conditions hold.
Filter filter_of(std::span<const AttributeCondition> conditions);

/// The names of the attributes in a filter, each once.
std::vector<std::string> names_in(const Filter& filter);

/// Ok within the limits. Errors: limit_exceeded.
Status check_filter(const Filter& filter);

}  // namespace watertight::store
