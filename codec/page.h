// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pages: up to 256 solids on one grid in one entropy coded stream, whose models go on learning and
// which shares columns and positions (docs/format.md, "Container"). A page is read as a whole. For
// bulk export; single blobs (codec/blob.h) are for rows.
#pragma once

#include <vector>

#include "codec/blob.h"

namespace watertight::codec {

inline constexpr std::size_t kMaxPageSolids = 256;

/// As decode(), for each solid of the page in the order in which it was written. `limits` hold
/// for all of them together. Errors: malformed; unsupported; limit_exceeded.
Result<std::vector<Decoded>> decode_page(ByteView page, const Limits& limits = {});

}  // namespace watertight::codec
