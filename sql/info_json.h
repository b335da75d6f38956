// SPDX-License-Identifier: GPL-3.0-or-later
//
// The facts about a blob that need no decoding of its solid, as JSON for wt_info.
#pragma once

#include <string>

#include "codec/blob.h"

namespace watertight::sql {

/// The facts as UTF-8 JSON: format, mode, acceptance, SRID, lattice, counts, and the bytes of each
/// part. Deterministic.
std::string info_json(const codec::BlobInfo& info, std::size_t bytes);

/// The rules under which a solid was accepted, as wt_rules() writes them; `snap` (metres) only if
/// the solid was snapped, which this program never does.
std::string rules_json(const Acceptance& acceptance);

}  // namespace watertight::sql
