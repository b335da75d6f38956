// SPDX-License-Identifier: GPL-3.0-or-later
//
// GML documents with other solids in the place of some.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "formats/city_json/city_json.h"
#include "formats/document.h"

namespace watertight::formats {

/// A GML document after its edits.
struct EditedGml {
  Bytes text;
  /// The solids that stay as they were, by number, with the reason.
  std::vector<std::pair<std::size_t, Error>> refused;
};

/// Puts other solids into a GML document; SolidEdit::number counts the solids of all features, as
/// read_document() gives them with these options. The text changes where facets do:
///   - a polygon keeps its element and its ids, and gets the positions of its rings; one that other
///     solids use too is replaced in this solid by a new polygon;
///   - a facet that is gone is taken out of its shell;
///   - parts of a facet become polygons with new ids beside it, in the shell and in the thematic
///     surface whose polygon the shell refers to;
///   - a new facet becomes a polygon with a new gml:id, the last of its shell.
/// Textures of changed polygons are taken out. The document is read again, and its solids are
/// compared with those that were asked for. Errors: those of read_document(); unsupported for
/// encodings without ASCII and where the comparison fails. Cost: that of reading, three times;
/// without edits that of a copy.
Result<EditedGml> edit_gml(ByteView bytes, const ReadOptions& options,
                           std::span<const SolidEdit> edits);

}  // namespace watertight::formats
