// SPDX-License-Identifier: GPL-3.0-or-later
//
// Features of a collection from which a dictionary of their texts can be made.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "store/solid_store.h"

namespace watertight::pipeline {

/// At most `number` features, those with the least hashes of their ids: a choice that has nothing
/// to do with place, type or time. Cost: that of reading each. Errors: those of the store.
Result<std::vector<StoredFeature>> sample_features(SolidStore& store, const std::string& collection,
                                                   std::uint64_t number);

}  // namespace watertight::pipeline
