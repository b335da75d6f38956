// SPDX-License-Identifier: GPL-3.0-or-later
//
// Reads documents feature by feature. A CityJSONSeq of any length takes the memory of its longest
// line; other formats are read whole first. For pipelines; stores and services that need the whole
// document use formats/document.h.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "base/byte_source.h"
#include "formats/city_json/city_json.h"
#include "formats/document.h"
#include "formats/text/text_layout.h"

namespace watertight::formats {

using watertight::ByteSource;

/// The place of a feature in the input.
struct FeaturePlace {
  std::uint64_t line = 0;    // number of the line of a sequence, from 1; 0 in other documents
  std::uint64_t offset = 0;  // start of that line in the input, bytes
};

/// Adds the place to an error of a feature whose id could be read: the line with its byte offset,
/// else a JSON Pointer to the city object.
Error at_place(Error error, const FeaturePlace& place, const std::string& id);

/// A feature found but not yet read: a line of a sequence, or a feature of a document that was read
/// whole.
struct FeatureText {
  std::string line;
  FeaturePlace place;
  std::optional<Feature> ready;
};

/// Adds the line and its place in the input to an error of reading the line of a sequence.
Error in_line(Error error, const FeatureText& text);

class FeatureReader {
 public:
  /// Finds the header under which a CityJSONFeature alone is read; "" for none. Errors: any.
  using HeaderFinder = std::function<Result<std::string>()>;

  /// Opens a reader and looks at the start of the input. `file_name` helps to detect the format, as
  /// in detect_format(). `lone_header` is called for a CityJSONFeature alone; without a header it
  /// is read as read_city_json() does. Errors: those of detect_format(), of the source, and of the
  /// header of a sequence; for other formats those of read_document().
  static Result<FeatureReader> open(ByteSource source, std::string_view file_name,
                                    const ReadOptions& options = {},
                                    const HeaderFinder& lone_header = {});
  /// A reader of a document that is in memory already.
  static FeatureReader of(Document document);

  /// Finds the next feature; nullopt at the end. After an error the input is at its end. Errors:
  /// those of the source; limit_exceeded for a line longer than Limits::bytes. Cost: linear in the
  /// line. Not thread-safe.
  Result<std::optional<FeatureText>> next();

  /// Reads a feature that next() found; its line stays as it is. Thread-safe, also while next()
  /// runs. Errors: those of read_city_json_feature(), with the line number; byte offsets are those
  /// of the input.
  Result<Feature> read(FeatureText& text) const;
  Result<Feature> read(FeatureText&& text) const { return read(text); }

  /// The format, header and notes of the document; next() takes its features.
  const Document& document() const { return document_; }
  /// The bytes between the lines of a sequence that was read to its end, with
  /// ReadOptions::keep_text (Document::framing).
  Bytes framing() const;
  std::uint64_t bytes_read() const { return bytes_read_; }
  /// The number of all features; nullopt for a sequence.
  std::optional<std::size_t> feature_count() const {
    if (is_sequence_) return std::nullopt;
    return document_.features.size();
  }

 private:
  FeatureReader() = default;
  Status fill();
  Status fill_to_line_end();
  Status fill_all();
  Status read_whole(std::string_view file_name, const HeaderFinder& lone_header);
  Status read_header();
  Result<std::optional<FeatureText>> next_line();
  std::string header_line(FeatureText text);
  void note_gap(std::string_view blanks, bool has_text);

  ByteSource source_;
  ReadOptions options_;
  Document document_;
  CityHeader header_;
  std::string buffer_;  // bytes that were read; those from used_ on are not used yet
  std::size_t used_ = 0;
  std::size_t searched_ = 0;  // end of the part of buffer_ without a line end
  FramingWriter framing_;
  std::string gap_;                // the bytes since the last line that was not blank
  std::uint64_t line_number_ = 0;  // number of the last line, from 1
  std::uint64_t bytes_read_ = 0;
  std::size_t given_ = 0;  // the number of features that next() has returned
  bool is_sequence_ = false;
  bool is_at_end_ = false;  // the source has ended
};

}  // namespace watertight::formats
