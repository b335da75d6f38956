// SPDX-License-Identifier: GPL-3.0-or-later
//
// Repairs as JSON.
#pragma once

#include <string>

#include "repair/summary.h"

namespace watertight::repair {

/// A repair as compact UTF-8 JSON (docs/report.md, "Repairs"). Deterministic.
std::string summary_json(const RepairSummary& summary);

}  // namespace watertight::repair
