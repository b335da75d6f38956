// SPDX-License-Identifier: GPL-3.0-or-later
//
// The text (or the bytes) of an indexed mesh beside its solids: in place of the coordinates of a
// vertex and of the number of a corner it has a mark of one byte, and both are printed again from
// the solids. What the text has besides (normals, texture coordinates, groups, comments) stays
// text. Internal to formats/.
//
// The reader meets the vertices of the file in another order than the solids have them, so the
// kept form says for each which one it is. A vertex is named by its place among the different
// points of its solid, by first use, which does not depend on how the solid is stored.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "formats/text/kept_text.h"

namespace watertight::formats {

/// Bytes of a text that give a vertex of the file or a corner of a facet.
struct IndexedPlace {
  enum class Kind : std::uint8_t { vertex, corner };
  Kind kind = Kind::vertex;
  std::uint64_t at = 0;
  std::uint64_t size = 0;  // of the three coordinates and what is between them, or of the number
};

/// The vertices and corners of a text: all of them, in the order of the text.
struct IndexedPlaces {
  std::vector<IndexedPlace> places;
  std::uint64_t first_number = 0;  // of the first vertex of the file
  /// Whether a vertex is three little-endian 32-bit floats, and a corner a little-endian 32-bit
  /// integer; else both are decimal texts.
  bool is_binary = false;
};

/// The form of a text whose corners are those of the solids, in their order; nothing if their
/// numbers differ. Cost: O(n log n).
std::optional<Bytes> indexed_form(std::string_view text, const IndexedPlaces& places,
                                  DocumentSolids solids);

/// The text of a form. Errors: malformed if it does not fit the solids; the result has at most
/// `most_bytes` and some digits. Cost: O(n log n).
Result<std::string> text_of_indexed_form(ByteView form, DocumentSolids solids,
                                         std::uint64_t most_bytes);

}  // namespace watertight::formats
