// SPDX-License-Identifier: GPL-3.0-or-later
//
// Packs the features of a collection again, with a dictionary that fits them all.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "base/cancel.h"
#include "base/result.h"
#include "store/solid_store.h"

namespace watertight::pipeline {

struct CompactCounts {
  std::uint64_t features = 0;  // that were looked at
  std::uint64_t repacked = 0;
  std::uint64_t bytes_before = 0;  // of the packed texts
  std::uint64_t bytes_after = 0;   // those of features that changed meanwhile are counted as packed
};

/// Makes a new dictionary for a collection if one is worth it, and packs every feature with the
/// newest dictionary that was not. Documents, versions and tags stay. Others may read and write the
/// collection meanwhile; a feature that they change is left as it is. Small transactions: what was
/// done before a failure stays done, and another call goes on. Errors: not_found; cancelled; those
/// of the store; malformed when a stored feature is damaged.
Result<CompactCounts> compact(
    SolidStore& store, const std::string& collection, const CancelPoll& is_cancelled = {},
    const std::function<void(std::uint64_t, std::uint64_t)>& progress = {});

}  // namespace watertight::pipeline
