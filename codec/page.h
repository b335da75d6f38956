// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pages hold up to 256 solids on one grid in one stream: models go on learning from one solid to
// the next, and solids share columns and positions (docs/format.md, "Container"). A page is read as
// a whole. Pages serve bulk export, and rows that have several solids; single blobs (codec/blob.h)
// serve rows that have one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "codec/blob.h"

namespace watertight::codec {

inline constexpr std::size_t kMaxPageSolids = 256;

/// Decodes each solid of a page as decode() does a blob, in the order in which the solids were
/// written. `limits` hold for all solids together. Errors: malformed; unsupported; limit_exceeded.
Result<std::vector<Decoded>> decode_page(ByteView page, const Limits& limits = {});

/// The solids of blobs as one page. Nothing unless that has fewer bytes than the blobs and
/// blob_in_page() makes these very blobs of it: a single blob, other grids or acceptances, Steiner
/// vertices and options of encode() that are not the default ones have no page. Cost: that of
/// encoding the solids twice. Errors: those of decode().
Result<std::optional<Bytes>> page_of_blobs(std::span<const ByteView> blobs);

/// The blob of the solid at index `number` of a page that page_of_blobs() made: one of the blobs
/// that it was given, so nothing is decoded again to verify it. Cost: decode_page() and a third of
/// encode(). Errors: those of decode_page(); invalid_argument if the page has no such solid.
Result<Bytes> blob_in_page(ByteView page, std::size_t number, const Limits& limits = {});

/// The blob that encode() makes of a decoded solid by default, with the acceptance that it claims.
/// For solids of any page. Cost: that of encode(). Errors: not_encodable.
Result<Bytes> blob_of(const Decoded& decoded);

}  // namespace watertight::codec
