// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pages: up to 256 solids on one grid in one entropy coded stream, whose models go on learning and
// which shares columns and positions (docs/format.md, "Container"). A page is read as a whole. For
// bulk export; single blobs (codec/blob.h) are for rows.
#pragma once

#include <span>
#include <vector>

#include "codec/blob.h"

namespace watertight::codec {

inline constexpr std::size_t kMaxPageSolids = 256;

/// True if both may stand in one page: the same lattice steps and phase, reference system and
/// acceptance.
bool share_page(const ValidSolid& one, const ValidSolid& other);

/// Encodes, decodes, compares, and only then returns. `options` are those of encode(), without a
/// certificate. Requires 1 to kMaxPageSolids solids that share a page. Errors: not_encodable;
/// invalid_argument.
Result<Bytes> encode_page(std::span<const ValidSolid* const> solids,
                          const EncodeOptions& options = {});

/// As decode(), for each solid of the page in the order given to encode_page(). `limits` hold
/// for all of them together. Errors: malformed; unsupported;
/// limit_exceeded.
Result<std::vector<Decoded>> decode_page(ByteView page, const Limits& limits = {});

}  // namespace watertight::codec
