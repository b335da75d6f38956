// SPDX-License-Identifier: GPL-3.0-or-later
//
// What filters mean, by another way than SQL: for stores in memory, and to compare.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "store/filter.h"

namespace watertight::samples {

using Truth = std::optional<bool>;  // nothing: unknown
using Values = std::map<std::string, std::vector<AttributeValue>>;

/// Whether a text is one that a pattern describes.
inline bool is_like(std::string_view text, std::string_view pattern) {
  if (pattern.empty()) return text.empty();
  if (pattern[0] == '%') {
    for (std::size_t i = 0; i <= text.size(); ++i) {
      if (is_like(text.substr(i), pattern.substr(1))) return true;
    }
    return false;
  }
  const bool is_any = pattern[0] == '_';
  if (pattern[0] == '\\') pattern.remove_prefix(1);
  if (text.empty() || (!is_any && text[0] != pattern[0])) return false;
  return is_like(text.substr(1), pattern.substr(1));
}

/// -1, 0 or 1; nothing for values of different types. Numbers are small.
inline std::optional<int> compared(const AttributeValue& a, const AttributeValue& b) {
  if (a.type != b.type) return std::nullopt;
  if (a.type != AttributeValue::Type::number) return (a.text > b.text) - (a.text < b.text);
  const double x = std::strtod(a.text.c_str(), nullptr);
  const double y = std::strtod(b.text.c_str(), nullptr);
  return (x > y) - (x < y);
}

inline bool holds(store::Comparison comparison, const AttributeValue& a, const AttributeValue& b) {
  const auto order = compared(a, b);
  if (!order) return false;
  switch (comparison) {
    case store::Comparison::equal:
      return *order == 0;
    case store::Comparison::different:
      return *order != 0;
    case store::Comparison::less:
      return *order < 0;
    case store::Comparison::at_most:
      return *order <= 0;
    case store::Comparison::greater:
      return *order > 0;
    case store::Comparison::at_least:
      return *order >= 0;
  }
  return false;
}

/// The truth of a filter for a feature with these values of attributes and this box.
inline Truth truth_of(const store::Filter& filter, const Values& values,
                      const std::optional<store::StoredBox>& box) {
  using Kind = store::Filter::Kind;
  const auto found = values.find(filter.name);
  const auto of_values = [&](const auto& is_right) -> Truth {
    if (found == values.end() || found->second.empty()) return std::nullopt;
    return std::any_of(found->second.begin(), found->second.end(), is_right);
  };
  switch (filter.kind) {
    case Kind::constant:
      return filter.truth;
    case Kind::is_null:
      return found == values.end() || found->second.empty();
    case Kind::no: {
      const Truth part = truth_of(filter.parts.front(), values, box);
      return part ? Truth(!*part) : part;
    }
    case Kind::all:
    case Kind::any: {
      const bool decisive = filter.kind == Kind::any;
      bool is_known = true;
      for (const store::Filter& part : filter.parts) {
        const Truth truth = truth_of(part, values, box);
        if (truth == decisive) return decisive;
        is_known = is_known && truth.has_value();
      }
      return is_known ? Truth(!decisive) : std::nullopt;
    }
    case Kind::box:
      if (!box) return false;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box->min[axis] > filter.box.max[axis] || box->max[axis] < filter.box.min[axis]) {
          return false;
        }
      }
      return true;
    case Kind::compare:
      return of_values([&](const AttributeValue& value) {
        return std::any_of(filter.values.begin(), filter.values.end(), [&](const auto& other) {
          return holds(filter.comparison, value, other);
        });
      });
    case Kind::between:
      return of_values([&](const AttributeValue& value) {
        return holds(store::Comparison::at_least, value, filter.values[0]) &&
               holds(store::Comparison::at_most, value, filter.values[1]);
      });
    case Kind::like:
      return of_values([&](const AttributeValue& value) {
        return value.type == AttributeValue::Type::text &&
               is_like(value.text, filter.values[0].text);
      });
  }
  return std::nullopt;
}

}  // namespace watertight::samples
