// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/shown/properties.h"

#include <charconv>
#include <unordered_map>

#include "formats/geo_json/city_shapes.h"
#include "pipeline/pipeline.h"
#include "pipeline/stored/feature_facts.h"

namespace watertight::pipeline {
namespace {

constexpr std::uint64_t kPropertyBatch = 200;
constexpr std::size_t kMostProperties = 100'000;

}  // namespace

std::optional<std::int64_t> integer_of(std::string_view value) {
  std::int64_t integer = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), integer);
  if (error != std::errc{} || end != value.data() + value.size()) return std::nullopt;
  return integer;
}

void ValueKinds::note(std::string_view value) {
  if (value.empty() || value == "null") return;
  switch (value.front()) {
    case '"':
      has_texts = true;
      return;
    case '[':
      has_arrays = true;
      return;
    case '{':
      has_objects = true;
      return;
    case 't':
    case 'f':
      has_truths = true;
      return;
    default:
      (integer_of(value) ? has_integers : has_reals) = true;
  }
}

Result<std::vector<PropertyKinds>> found_properties(SolidStore& store,
                                                    const std::string& collection,
                                                    const CancelPoll& is_cancelled) {
  std::vector<PropertyKinds> found;
  std::unordered_map<std::string, std::size_t> places;
  std::string after;
  do {
    auto batch = store.walk(collection, kPropertyBatch, after);
    if (!batch) return std::move(batch).error();
    for (StoredFeature& feature : batch->features) {
      if (is_cancelled && is_cancelled()) return Error{ErrorCode::cancelled, "stopped"};
      const std::string id = feature.id;
      const auto encoded = unpack(std::move(feature), {}, Reports::none);
      if (!encoded) return encoded.error();
      for (auto& [name, value] : formats::city_attributes(model_text(*encoded), id)) {
        const auto [place, is_new] = places.try_emplace(name, found.size());
        if (is_new) found.emplace_back(name, ValueKinds{});
        found[place->second].second.note(value);
      }
      if (found.size() > kMostProperties) {
        return Error{ErrorCode::limit_exceeded, "the features have more than " +
                                                    std::to_string(kMostProperties) +
                                                    " different attributes"};
      }
    }
    after = std::move(batch->next);
  } while (!after.empty());
  return found;
}

}  // namespace watertight::pipeline
