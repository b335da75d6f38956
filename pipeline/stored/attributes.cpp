// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/stored/attributes.h"

#include <utility>

#include "formats/attributes/city_attributes.h"
#include "pipeline/pipeline.h"
#include "pipeline/stored/feature_facts.h"

namespace watertight::pipeline {
namespace {

constexpr std::uint64_t kAttributeBatch = 200;
constexpr std::size_t kMostNames = 100'000;

/// Whether a text is a number as JSON writes it.
bool is_number(std::string_view text) {
  const auto digits = [&text] {
    std::size_t count = 0;
    while (count < text.size() && text[count] >= '0' && text[count] <= '9') ++count;
    text.remove_prefix(count);
    return count;
  };
  const auto take = [&text](std::string_view any_of) {
    const bool has = !text.empty() && any_of.find(text.front()) != std::string_view::npos;
    if (has) text.remove_prefix(1);
    return has;
  };
  take("-");
  const bool has_zero = text.starts_with('0');
  const std::size_t whole = digits();
  if (whole == 0 || (has_zero && whole > 1)) return false;
  if (take(".") && digits() == 0) return false;
  if (take("eE")) {
    take("+-");
    if (digits() == 0) return false;
  }
  return text.empty();
}

}  // namespace

Result<std::vector<store::FeatureAttribute>> read_attributes(const StoredFeature& feature,
                                                             std::span<const std::string> names) {
  const auto encoded = unpack(feature, {}, Reports::none);
  if (!encoded) return encoded.error();
  std::vector<store::FeatureAttribute> values;
  for (auto& found : formats::attribute_values(model_text(*encoded), names)) {
    values.push_back({std::move(found.object), found.name, std::move(found.value)});
  }
  return values;
}

Result<std::map<std::string, AttributeCount>> found_attributes(SolidStore& store,
                                                               const std::string& collection,
                                                               const CancelPoll& is_cancelled) {
  std::map<std::string, AttributeCount> counts;
  for (std::string after;;) {
    if (is_cancelled && is_cancelled()) return Error{ErrorCode::cancelled, "stopped"};
    auto batch = store.walk(collection, kAttributeBatch, after);
    if (!batch) return std::move(batch).error();
    for (StoredFeature& feature : batch->features) {
      const auto encoded = unpack(std::move(feature), {}, Reports::none);
      if (!encoded) return encoded.error();
      for (formats::AttributeName& found : formats::attribute_names(model_text(*encoded))) {
        AttributeCount& count = counts[std::move(found.name)];
        ++(found.type ? count.by_type[static_cast<std::size_t>(*found.type)] : count.others);
      }
      if (counts.size() > kMostNames) {
        return Error{
            ErrorCode::limit_exceeded,
            "the features have more than " + std::to_string(kMostNames) + " different attributes"};
      }
    }
    if (batch->next.empty()) return counts;
    after = std::move(batch->next);
  }
}

Result<store::AttributeCondition> condition_of(const std::string& name, const std::string& value) {
  using Type = AttributeValue::Type;
  if (Status checked = store::check_attribute_name(name); !checked) {
    return std::move(checked).error();
  }
  store::AttributeCondition condition{name, store::Comparison::equal, {{Type::text, value}}};
  if (is_number(value)) condition.values.push_back({Type::number, value});
  if (value == "true" || value == "false") condition.values.push_back({Type::truth, value});
  return condition;
}

}  // namespace watertight::pipeline
