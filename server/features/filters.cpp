// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/features/filters.h"

#include "base/checksum.h"
#include "cql2/cql2.h"
#include "server/features/systems.h"
#include "server/json_answers.h"

namespace watertight::server {
namespace {

/// Puts the boxes of a filter into the storage CRS.
Status place_boxes(store::Filter& filter, PlaceSystem system,
                   const store::StoredCollection& collection) {
  for (store::Filter& part : filter.parts) {
    if (Status placed = place_boxes(part, system, collection); !placed) return placed;
  }
  if (filter.kind != store::Filter::Kind::box) return Done{};
  const auto choice = choice_of_box(system, filter.box, collection);
  if (!choice) return choice.error();
  if (choice->box) {
    filter.box = *choice->box;
  } else {
    filter.kind = store::Filter::Kind::constant;
    filter.truth = !choice->is_empty;
  }
  return Done{};
}

/// The error of a filter, whose place is said in words.
Error error_in_filter(const Error& error) {
  std::string message = error.message;
  if (error.byte_offset) message += " (at character " + std::to_string(*error.byte_offset) + ")";
  if (!error.pointer.empty()) message += " (at " + error.pointer + ")";
  return {ErrorCode::invalid_argument, message};
}

}  // namespace

Result<std::optional<store::Filter>> filter_of_request(const Target& target,
                                                       const store::StoredCollection& collection) {
  const std::string* language = target.parameter("filter-lang");
  if (language != nullptr && *language != "cql2-text" && *language != "cql2-json") {
    return Error{ErrorCode::invalid_argument, "filter-lang is cql2-text or cql2-json"};
  }
  const auto system = system_of_request(target, "filter-crs", collection.srid);
  if (!system) return system.error();
  const std::string* text = target.parameter("filter");
  if (text == nullptr) return std::optional<store::Filter>();
  const bool is_json = language != nullptr && *language == "cql2-json";
  auto filter = is_json ? cql2::read_json(*text) : cql2::read_text(*text);
  if (!filter) return error_in_filter(filter.error());
  if (Status placed = place_boxes(*filter, *system, collection); !placed) {
    return std::move(placed).error();
  }
  return std::optional(*std::move(filter));
}

Result<std::optional<store::Filter>> selection_of_request(
    const Target& target, const store::StoredCollection& collection) {
  auto filter = filter_of_request(target, collection);
  if (!filter) return filter;
  const auto choice = box_of_request(target, collection);
  if (!choice) return choice.error();
  if (!choice->is_empty && !choice->box) return filter;
  store::Filter box{store::Filter::Kind::constant};
  box.truth = false;
  if (choice->box) {
    box.kind = store::Filter::Kind::box;
    box.box = *choice->box;
  }
  if (!*filter) return std::optional(std::move(box));
  return std::optional(store::Filter{store::Filter::Kind::all, {**std::move(filter), box}});
}

std::string selection_name(const Target& target) {
  std::string text;
  for (const std::string_view name : kSelectionParameters) {
    const std::string* value = target.parameter(name);
    if (value == nullptr) continue;
    text.append(name).append("=").append(percent_encode(*value)).append("&");
  }
  if (text.empty()) return text;
  return std::string("-").append(std::to_string(content_hash(as_bytes(text))));
}

Result<std::optional<store::SortKey>> sort_of_request(const Target& target) {
  const std::string* text = target.parameter("sortby");
  if (text == nullptr) return std::optional<store::SortKey>();
  store::SortKey key{*text, text->starts_with('-')};
  if (key.name.starts_with('-') || key.name.starts_with('+')) key.name.erase(0, 1);
  if (key.name.find(',') != std::string::npos) {
    return Error{ErrorCode::invalid_argument, "sortby is the name of one attribute"};
  }
  if (Status checked = store::check_attribute_name(key.name); !checked) {
    return std::move(checked).error();
  }
  return std::optional(std::move(key));
}

}  // namespace watertight::server
