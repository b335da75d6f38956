// SPDX-License-Identifier: GPL-3.0-or-later
// The parts that files of attributes in this folder share.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "store/connection.h"
#include "store/rows/feature_rows.h"

namespace watertight::store {

/// Chosen attributes of a collection, in order of their names.
struct AttributeKeys {
  std::vector<std::int64_t> keys;
  std::vector<std::string> names;
};

/// Replaces the values of these attributes for features of one collection, and waits. Errors: those
/// of the reader; unsupported without one.
Status write_values(DatabaseSession& connection, FeatureRefs features, const AttributeKeys& chosen,
                    const AttributeReader& reader);

}  // namespace watertight::store
