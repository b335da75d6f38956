// SPDX-License-Identifier: GPL-3.0-or-later
//
// The attributes of stored features: those of all city objects of a feature, the root and its
// parts. Features without a city model (meshes, WKT) have none.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "store/solid_store.h"

namespace watertight::pipeline {

/// A store::AttributeReader. Cost: that of reading the text as JSON; solids are not decoded.
/// Errors: malformed for a damaged text.
Result<std::vector<store::FeatureAttribute>> read_attributes(const StoredFeature& feature,
                                                             std::span<const std::string> names);

/// How often an attribute has a value, by AttributeValue::Type, and how often none that can be
/// compared.
struct AttributeCount {
  std::array<std::uint64_t, 3> by_type{};
  std::uint64_t others = 0;
};

/// The attributes of all features of a collection, by name. Reads them all. Errors: those of the
/// store; cancelled; limit_exceeded above 100,000 names.
Result<std::map<std::string, AttributeCount>> found_attributes(SolidStore& store,
                                                               const std::string& collection,
                                                               const CancelPoll& is_cancelled = {});

/// The condition NAME=VALUE, written without a type: the text VALUE; the number, if VALUE is one in
/// JSON; true or false. Errors: invalid_argument for a name that no attribute can have.
Result<store::AttributeCondition> condition_of(const std::string& name, const std::string& value);

}  // namespace watertight::pipeline
