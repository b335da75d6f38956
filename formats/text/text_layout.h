// SPDX-License-Identifier: GPL-3.0-or-later
//
// The differences between a text of a JSON value and the text that Watertight prints for the value:
// white space, spellings of numbers and escapes of strings. With them the very bytes of a document
// come back. Internal to formats/.
//
// Both texts have the same tokens in the same order. The white space before a token is predicted to
// be the same as before the last token at the same depth between the same kinds of neighbours. The
// spelling of a token is predicted from the last token that was not spelled as predicted. A layout
// holds only the exceptions from the predictions. So it takes a few bytes if the text has a regular
// style, and it is exact for every text.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/bytes.h"
#include "base/result.h"

namespace watertight::formats {

/// The layout that turns `plain` into `text`, with 16 bits of the hash of `text`. For two texts
/// without the same tokens it holds all of `text`. Cost: linear.
Bytes describe_layout(std::string_view plain, std::string_view text);

/// The text that was given to describe_layout(plain, text), if `layout` is its result. Errors:
/// malformed if the layout does not fit `plain`, or if the text does not have the hash that the
/// layout states; limit_exceeded if it is longer than `most_bytes`.
Result<std::string> apply_layout(std::string_view plain, ByteView layout, std::uint64_t most_bytes);

/// True if the layout holds the whole text, so that apply_layout() does not read `plain`.
bool holds_whole_text(ByteView layout);

/// Writes a sequence of texts, most of which the reader expects. The bytes hold pairs: the number
/// of expected texts, then the one text after them that is not expected.
class ExceptionWriter {
 public:
  void expected() { ++run_; }
  void exception(std::string_view text);
  Bytes finish() && { return std::move(writer_).bytes(); }

 private:
  ByteWriter writer_;
  std::uint64_t run_ = 0;
};

/// Reads what ExceptionWriter wrote.
class ExceptionReader {
 public:
  explicit ExceptionReader(ByteView bytes) : reader_(bytes) { start_run(); }
  /// False when the next text is as expected; else sets `text` to the next text, a view of the
  /// bytes.
  bool next(std::string_view& text);
  /// True if all bytes were read and none was malformed.
  bool is_finished() const { return is_last_run_ && !reader_.failed(); }

 private:
  void start_run();
  ByteReader reader_;
  std::uint64_t run_ = 0;
  bool is_last_run_ = false;
};

/// The bytes that follow their number (varint); fewer if there are fewer, which fails the reader.
inline ByteView take_list(ByteReader& reader) {
  const std::uint64_t size = reader.varint();
  return reader.take(static_cast<std::size_t>(std::min<std::uint64_t>(size, SIZE_MAX)));
}

/// Writes the bytes before, between and after the lines of a text. The reader expects one line feed
/// after each line.
class FramingWriter {
 public:
  /// Writes the gap before the next line, or the gap after the last line if `is_last`.
  void gap(std::string_view text, bool is_last);
  Bytes finish() && { return std::move(gaps_).finish(); }

 private:
  ExceptionWriter gaps_;
  std::string likely_;
  bool is_first_ = true;
};

class FramingReader {
 public:
  explicit FramingReader(ByteView framing) : gaps_(framing) {}
  std::string_view next_gap(bool is_last);
  bool is_finished() const { return gaps_.is_finished(); }

 private:
  ExceptionReader gaps_;
  std::string_view likely_;
  bool is_first_ = true;
};

}  // namespace watertight::formats
