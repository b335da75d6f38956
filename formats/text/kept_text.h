// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bytes of a whole document beside its solids: pieces of the text itself, and references to
// rings of the solids, whose numbers are printed again. So no coordinate of a solid is stored
// twice. Internal to formats/.
//
// The text keeps one byte instead of the numbers of a ring or of one of its positions; bytes of
// the same value in the text are escaped. Three lists of exceptions accompany the text: from the
// order of the rings, from the white space (or any other text) between numbers, and from the style
// in which numbers are printed. Each prediction is learned from the text before, so that a regular
// text needs few exceptions, and every text comes back exactly.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "formats/document.h"
#include "geometry/solid.h"

namespace watertight::formats {

struct IndexedPlaces;

/// Bytes of a document that hold the positions of a ring of a solid, or one of them.
struct RingText {
  std::uint64_t at = 0;
  std::uint64_t size = 0;
  Index solid = 0;             // the number of the solid in the document
  Index ring = 0;              // the number of the ring in the solid
  std::uint64_t position = 0;  // the number of the position in the ring, unless is_whole
  bool is_whole = true;        // all positions, of which the last may repeat the first
  bool is_binary = false;      // all positions as little-endian 32-bit floats
  bool is_reversed = false;    // after the first position the others are in the opposite order
  bool is_y_first = false;     // x and y are exchanged
};

/// The solids of a document, in order.
using DocumentSolids = std::span<const Solid* const>;
std::vector<const Solid*> solids_of(const Document& document);

/// The kept form of `bytes`. `rings` ascend by `at` and do not overlap; a ring whose text does not
/// hold the numbers of its positions is kept as it is written. Cost: linear.
Bytes keep_with_rings(ByteView bytes, std::span<const RingText> rings, DocumentSolids solids);

/// The kept form of bytes that resemble `written`, which write_document() gives for the document.
Bytes keep_as_written(ByteView bytes, ByteView written);

/// The kept form of the text of an indexed mesh (formats/text/indexed_text.h); nothing if the
/// corners of the text are not those of the solids.
std::optional<Bytes> keep_with_indices(ByteView bytes, const IndexedPlaces& places,
                                       DocumentSolids solids);

/// The kept form of bytes alone.
Bytes keep_whole(ByteView bytes);

/// True if restored_bytes() needs the bytes that write_document() gives for the document.
bool needs_written(ByteView kept);

/// The bytes that were kept. Errors: malformed if the solids are not those of the document or if
/// the result does not have the size and hash that the kept form states; limit_exceeded if it is
/// longer than `most_bytes`. Cost: linear in the result.
Result<Bytes> restored_bytes(ByteView kept, DocumentSolids solids, ByteView written,
                             std::uint64_t most_bytes);

}  // namespace watertight::formats
