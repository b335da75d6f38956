// SPDX-License-Identifier: GPL-3.0-or-later
//
// Readers of OBJ, OFF, STL, PLY, POLY, WKT and EWKB, and writers of OBJ and OFF. Internal to
// formats/; the public interfaces are formats/document.h and formats/ewkb.h.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/document.h"
#include "formats/text/kept_text.h"

namespace watertight::formats {

struct DecimalVertices;

Result<Document> read_obj(std::string_view text, const Limits& limits);
Result<Document> read_off(std::string_view text, const Limits& limits);
/// Reads text or binary; corners with equal coordinates become one vertex.
Result<Document> read_stl(ByteView bytes, const Limits& limits);
bool is_binary_stl(ByteView bytes);
/// The places of the triangles in a binary STL, which are the rings of its one solid, in order.
std::vector<RingText> binary_stl_rings(ByteView bytes);
Result<Document> read_ply(ByteView bytes, const Limits& limits);
Result<Document> read_poly(std::string_view text, const Limits& limits);
/// Reads a text of geometries, one after the other. Each geometry becomes a feature.
Result<Document> read_wkt_document(std::string_view text, const Limits& limits);
Result<Document> read_ewkb_document(ByteView bytes, const Limits& limits);

/// Writes each solid as an object with the id of its source. Errors: unsupported for facets with
/// holes and for cavities.
Result<std::string> write_obj(std::span<const Feature> features);
/// Errors: unsupported for anything but one solid without holes and cavities.
Result<std::string> write_off(std::span<const Feature> features);

/// A line of a text file with the comment cut off.
struct TextLine {
  std::string_view text;
  std::size_t offset = 0;  // start of the line in the file, bytes
  std::size_t number = 0;  // number of the line, from 1
};

/// The words of a line, separated by blanks.
void words_of(std::string_view line, std::vector<std::string_view>& words);

/// Goes through the lines of a text that have words besides a comment, which starts with '#'.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : text_(text) {}
  /// Goes to the next line; false at the end of the text.
  bool next();
  const TextLine& line() const { return line_; }
  /// The words of the line, at least one.
  std::span<const std::string_view> words() const { return words_; }
  /// The error malformed: the file ends before `what`.
  Error ended(const std::string& what) const;

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  TextLine line_;
  std::vector<std::string_view> words_;
};

/// The word as an unsigned integer, if it is one.
std::optional<std::uint64_t> unsigned_word(std::string_view word);

/// The error malformed, with "line 7: " and the byte where `word`, a part of `line`, starts.
Error error_at(const TextLine& line, std::string_view word, std::string message);

/// Appends three words as exact coordinates, and whether a coordinate was rounded.
Status append_vertex(const TextLine& line, std::span<const std::string_view> words,
                     DecimalVertices& vertices);

}  // namespace watertight::formats
