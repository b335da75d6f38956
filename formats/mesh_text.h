// SPDX-License-Identifier: GPL-3.0-or-later
//
// OBJ, OFF, WKT and EWKB between bytes and documents. Internal to formats/; the public face is
// formats/document.h and formats/ewkb.h.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/document.h"

namespace watertight {

struct DecimalVertices;

Result<Document> read_obj(std::string_view text, const Limits& limits);
Result<Document> read_off(std::string_view text, const Limits& limits);
/// One geometry after the other; each is a feature.
Result<Document> read_wkt_document(std::string_view text, const Limits& limits);
Result<Document> read_ewkb_document(ByteView bytes, const Limits& limits);

/// Objects named after what the solids were. Errors: unsupported for holes and cavities.
Result<std::string> write_obj(std::span<const Feature> features);
/// Errors: unsupported for anything but one solid without holes and cavities.
Result<std::string> write_off(std::span<const Feature> features);

/// A line of a text file with the comment cut off.
struct TextLine {
  std::string_view text;
  std::size_t offset = 0;  // of the line in the file
  std::size_t number = 0;  // from 1
};

/// The words of a line, separated by blanks.
std::vector<std::string_view> words_of(std::string_view line);

/// malformed, with "line 7: " and the byte where `word`, a part of `line`, starts.
Error error_at(const TextLine& line, std::string_view word, std::string message);

/// Three words as exact coordinates, appended with whether they were rounded.
Status append_vertex(const TextLine& line, std::span<const std::string_view> words,
                     DecimalVertices& vertices);

}  // namespace watertight
