// SPDX-License-Identifier: GPL-3.0-or-later
//
// The properties that features have for map programs, and the types of their values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "store/solid_store.h"

namespace watertight::pipeline {

/// The integer that a JSON text is, of 64 bits; nothing for another text.
std::optional<std::int64_t> integer_of(std::string_view value);

/// The kinds of the values of a property; null is none of them.
struct ValueKinds {
  bool has_truths = false;
  bool has_integers = false;  // of 64 bits
  bool has_reals = false;
  bool has_texts = false;
  bool has_arrays = false;
  bool has_objects = false;

  /// Takes note of a value, a JSON text.
  void note(std::string_view value);
};

/// A property and the kinds of its values in all features.
using PropertyKinds = std::pair<std::string, ValueKinds>;

/// The attributes of the features of a collection, as ShownFeatureReader gives them, in the order
/// in which they are found. Reads the texts of all features, decodes no solid. Errors: those of
/// SolidStore::walk(); malformed for a damaged text; limit_exceeded above 100,000 names; cancelled.
Result<std::vector<PropertyKinds>> found_properties(SolidStore& store,
                                                    const std::string& collection,
                                                    const CancelPoll& is_cancelled = {});

}  // namespace watertight::pipeline
