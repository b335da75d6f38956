// SPDX-License-Identifier: GPL-3.0-or-later
//
// Documents read feature by feature. A CityJSONSeq of any length takes the memory of its longest
// line; other formats are read whole first. For pipelines; stores and services that need the whole
// document use formats/document.h.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "formats/document.h"

namespace watertight {

/// Fills the span from the input and returns how many bytes; 0 at the end of the input.
using ByteSource = std::function<Result<std::size_t>(std::span<std::uint8_t>)>;

class FeatureReader {
 public:
  /// Looks at the start of the input. `file_name` helps to tell the format, as in detect_format().
  /// A lone CityJSONFeature line has no header and is refused.
  /// Errors: those of detect_format(), of the source, and of the header of a sequence; for other
  /// formats those of read_document().
  static Result<FeatureReader> open(ByteSource source, std::string_view file_name,
                                    const ReadOptions& options = {});

  /// The next feature; nothing at the end. After an error that concerns one line of a sequence the
  /// next call goes on with the next line; messages name the line. After an error of the source
  /// the next call gives the end.
  Result<std::optional<Feature>> next();

  /// Format, header and notes; without features.
  const Document& document() const { return document_; }
  std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  FeatureReader() = default;
  Result<std::optional<std::string>> next_line();
  Status fill();

  ByteSource source_;
  ReadOptions options_;
  Document document_;
  CityHeader header_;
  std::string buffer_;  // bytes read and not yet used: [used_, size)
  std::size_t used_ = 0;
  bool is_at_end_ = false;  // of the source
  bool is_whole_ = false;   // not a sequence: document_.features hold what is left
  std::size_t given_ = 0;   // features of a whole document
  std::uint64_t line_ = 0;  // number of the last line, from 1
  std::uint64_t bytes_read_ = 0;
};

}  // namespace watertight
