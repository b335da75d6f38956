// SPDX-License-Identifier: GPL-3.0-or-later
//
// Repairs as JSON.
#pragma once

#include <string>

#include "repair/changes.h"

namespace watertight::repair {

/// A repair as UTF-8 JSON (docs/sql.md, wt_repair_report): outcome, remedies, codes_before, counts
/// of changes, and the holes. Deterministic.
std::string repair_json(const Repaired& repaired, const Changes& changes);

}  // namespace watertight::repair
