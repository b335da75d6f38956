// SPDX-License-Identifier: GPL-3.0-or-later
//
// The columns of a layer.
#include <charconv>
#include <nlohmann/json.hpp>

#include "base/ascii.h"
#include "geopackage/layer.h"

namespace watertight::geopackage {
namespace {

/// The characters of a JSON string; another JSON text as it is.
std::string text_of(std::string_view value) {
  if (value.empty() || value.front() != '"') return std::string(value);
  const auto parsed = nlohmann::json::parse(value, nullptr, false);
  return parsed.is_string() ? parsed.get<std::string>() : std::string(value);
}

}  // namespace

std::string_view Columns::Column::type() const {
  const bool has_numbers = kinds.has_integers || kinds.has_reals;
  const bool has_others = kinds.has_texts || kinds.has_arrays || kinds.has_objects;
  if (has_others || has_numbers == kinds.has_truths) return "TEXT";
  if (kinds.has_truths) return "BOOLEAN";
  return kinds.has_reals ? "REAL" : "INTEGER";
}

std::size_t Columns::add(const std::string& name) {
  std::string column = name.empty() ? "attribute" : name;
  const std::string wanted = column;
  // "fid" and "geom" are the layer's own, "further_attributes" is for what has no column.
  const auto is_taken = [&](const std::string& text) {
    const std::string lower = lower_case(text);
    return lower == "fid" || lower == "geom" || lower == "further_attributes" ||
           taken_.contains(lower);
  };
  for (int number = 2; is_taken(column); ++number) {
    column = wanted;
    column.append("_").append(std::to_string(number));
  }
  columns_.push_back({column});
  taken_.emplace(lower_case(column), columns_.size() - 1);
  return columns_.size() - 1;
}

std::optional<std::size_t> Columns::note(std::string_view name, std::string_view value) {
  auto known = numbers_.find(name);
  if (known == numbers_.end()) {
    if (columns_.size() >= kMost) return std::nullopt;
    known = numbers_.emplace(std::string(name), add(std::string(name))).first;
  }
  columns_[known->second].kinds.note(value);
  return known->second;
}

void Columns::bind(Statement& statement, int number, const Column& column, std::string_view value) {
  if (value == "null") {
    statement.bind_null(number);
    return;
  }
  const std::string_view type = column.type();
  if (type == "BOOLEAN") {
    statement.bind(number, std::int64_t{value == "true" ? 1 : 0});
  } else if (type == "INTEGER") {
    statement.bind(number, pipeline::integer_of(value).value_or(0));
  } else if (type == "REAL") {
    double real = 0;
    std::from_chars(value.data(), value.data() + value.size(), real);
    statement.bind(number, real);
  } else {
    statement.bind(number, text_of(value));
  }
}

}  // namespace watertight::geopackage
