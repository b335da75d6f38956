// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pages hold up to 256 solids on one grid in one stream: models go on learning from one solid to
// the next, and solids share columns and positions (docs/format.md, "Container"). A page is read as
// a whole. Pages serve bulk export; single blobs (codec/blob.h) serve rows of tables.
#pragma once

#include <vector>

#include "codec/blob.h"

namespace watertight::codec {

inline constexpr std::size_t kMaxPageSolids = 256;

/// Decodes each solid of a page as decode() does a blob, in the order in which the solids were
/// written. `limits` hold for all solids together. Errors: malformed; unsupported; limit_exceeded.
Result<std::vector<Decoded>> decode_page(ByteView page, const Limits& limits = {});

}  // namespace watertight::codec
