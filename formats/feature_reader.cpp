// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/feature_reader.h"

#include <algorithm>
#include <utility>

#include "formats/text/json.h"

namespace watertight::formats {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 18U;
/// The number of bytes after the first line that show whether the input is a sequence or a document
/// of several lines.
constexpr std::size_t kGlimpse = 4096;

/// The position after the record separator of RFC 8142 and the blanks that precede a text.
std::size_t text_start(std::string_view line) {
  return std::min(line.find_first_not_of("\x1E \t\r"), line.size());
}

/// Whether the first line that is not blank can be a complete JSON text, as far as it is there.
bool has_whole_line(std::string_view text) {
  const std::size_t start = text.find_first_not_of("\x1E \t\r\n\xEF\xBB\xBF");
  if (start == std::string_view::npos || text[start] != '{') return true;
  const std::size_t end = text.find('\n', start);
  if (end == std::string_view::npos) return true;
  return text[text.find_last_not_of(" \t\r", end - 1)] == '}';
}

}  // namespace

Error at_place(Error error, const FeaturePlace& place, const std::string& id) {
  if (place.line == 0) {
    if (!id.empty()) error.pointer = "/CityObjects" + pointer_token(id);
    return error;
  }
  error.message = "line " + std::to_string(place.line) + ": " + error.message;
  error.byte_offset = place.offset;
  return error;
}

Error in_line(Error error, const FeatureText& text) {
  const bool is_cut_off = error.byte_offset && *error.byte_offset + 1 >= text.line.size();
  error.message = "line " + std::to_string(text.place.line) + ": " + error.message;
  if (is_cut_off) {
    error.message += "; each line of a CityJSONSeq must be one complete JSON text";
  }
  error.byte_offset = text.place.offset + error.byte_offset.value_or(0);
  return error;
}

/// Appends the next bytes of the source to the buffer.
Status FeatureReader::fill() {
  if (used_ > 0) {
    buffer_.erase(0, used_);
    searched_ -= used_;
    used_ = 0;
  }
  const Limits& limits = options_.limits;
  const std::uint64_t most =
      is_sequence_ ? std::min(limits.feature_bytes, limits.bytes) : limits.bytes;
  if (buffer_.size() > most) {
    return Error{ErrorCode::limit_exceeded,
                 "longer than " + std::to_string(most) + " bytes without an end", bytes_read_};
  }
  const std::size_t size = buffer_.size();
  buffer_.resize(size + kChunk);
  auto count = source_({reinterpret_cast<std::uint8_t*>(buffer_.data()) + size, kChunk});
  buffer_.resize(size + (count ? std::min(*count, kChunk) : 0));
  if (!count || *count == 0) is_at_end_ = true;
  if (!count) return std::move(count).error();
  bytes_read_ += *count;
  return Done{};
}

/// Reads until the buffer has a line end or the source is at its end.
Status FeatureReader::fill_to_line_end() {
  for (;;) {
    const std::size_t end = buffer_.find('\n', std::max(searched_, used_));
    searched_ = std::min(end, buffer_.size());
    if (end != std::string::npos || is_at_end_) return Done{};
    if (Status status = fill(); !status) return status;
  }
}

Result<FeatureReader> FeatureReader::open(ByteSource source, std::string_view file_name,
                                          const ReadOptions& options,
                                          const HeaderFinder& lone_header) {
  FeatureReader reader;
  reader.source_ = std::move(source);
  reader.options_ = options;
  Status status = reader.fill_to_line_end();
  while (status && !reader.is_at_end_ && reader.buffer_.size() < reader.searched_ + kGlimpse) {
    status = reader.fill();
  }
  if (!status) return std::move(status).error();
  auto format = detect_format(file_name, as_bytes(reader.buffer_));
  if (format && *format == Format::city_json_seq && !has_whole_line(reader.buffer_)) {
    // No sequence, but it can be a CityJSONFeature alone whose type comes late.
    status = reader.fill_all();
    if (!status) return std::move(status).error();
    format = detect_format(file_name, as_bytes(reader.buffer_));
  }
  reader.is_sequence_ = format && *format == Format::city_json_seq;
  status = reader.is_sequence_ ? reader.read_header() : reader.read_whole(file_name, lone_header);
  if (!status) return std::move(status).error();
  return reader;
}

FeatureReader FeatureReader::of(Document document) {
  FeatureReader reader;
  reader.document_ = std::move(document);
  reader.is_at_end_ = true;
  return reader;
}

Status FeatureReader::fill_all() {
  while (!is_at_end_) {
    if (Status status = fill(); !status) return status;
  }
  return Done{};
}

Status FeatureReader::read_whole(std::string_view file_name, const HeaderFinder& lone_header) {
  if (Status status = fill_all(); !status) return status;
  const auto format = detect_format(file_name, as_bytes(buffer_));
  if (!format) return format.error();
  std::string header;
  if (lone_header && *format == Format::city_json && is_lone_feature(buffer_)) {
    auto found = lone_header();
    if (!found) return std::move(found).error();
    header = *std::move(found);
  }
  auto document = header.empty() ? read_document(as_bytes(buffer_), *format, options_)
                                 : read_lone_feature(std::move(buffer_), header, options_);
  if (!document) return std::move(document).error();
  document_ = *std::move(document);
  buffer_ = {};
  return Done{};
}

Status FeatureReader::read_header() {
  document_.format = Format::city_json_seq;
  if (buffer_.starts_with(kByteOrderMark)) {
    used_ = kByteOrderMark.size();
    document_.notes.emplace_back("byte order mark skipped");
    gap_ = kByteOrderMark;
  }
  auto text = next_line();
  if (!text) return std::move(text).error();
  if (!*text) return Error{ErrorCode::malformed, "the sequence is empty", 0};
  auto header = read_city_json_header((*text)->line, options_.limits);
  if (!header) return in_line(std::move(header).error(), **text);
  if (!header->transform) {
    document_.notes.emplace_back(
        "the CityJSONSeq has no transform: the solids in it cannot be read");
  }
  header_ = *std::move(header);
  auto templates = read_geometry_templates(header_, options_.limits, options_.surfaces);
  if (!templates) return in_line(std::move(templates).error(), **text);
  document_.templates = std::move(templates->solids);
  document_.template_surfaces = std::move(templates->surfaces);
  for (std::string& note : templates->notes) document_.notes.push_back(std::move(note));
  document_.header = options_.keep_text ? header_line(*std::move(*text)) : header_.text;
  return Done{};
}

/// The text of the header without the blanks at its end, which go to the framing: files that differ
/// only there (in line ends) have one header.
std::string FeatureReader::header_line(FeatureText text) {
  const std::size_t size = text.line.find_last_not_of(" \t\r") + 1;
  gap_.insert(0, text.line, size);
  text.line.resize(size);
  return std::move(text.line);
}

Result<std::optional<FeatureText>> FeatureReader::next_line() {
  for (;;) {
    if (Status status = fill_to_line_end(); !status) {
      is_at_end_ = true;
      buffer_.clear();
      used_ = searched_ = 0;
      return std::move(status).error();
    }
    if (used_ == buffer_.size()) return std::optional<FeatureText>{};
    const std::string_view rest = std::string_view(buffer_).substr(used_);
    std::string_view line = rest.substr(0, searched_ - used_);
    const std::size_t start = text_start(line);
    const std::uint64_t offset = bytes_read_ - rest.size() + start;
    line.remove_prefix(start);
    FeatureText text{std::string(line), {++line_number_, offset}, {}};
    if (options_.keep_text) note_gap(rest.substr(0, start), !line.empty());
    if (options_.keep_text && searched_ < buffer_.size()) gap_ += '\n';
    used_ = std::min(searched_ + 1, buffer_.size());
    searched_ = used_;
    if (line.empty()) continue;
    return std::optional(std::move(text));
  }
}

/// Adds `blanks`, which stand at the start of a line, to the gap between texts; `has_text`: a text
/// follows in that line.
void FeatureReader::note_gap(std::string_view blanks, bool has_text) {
  gap_ += blanks;
  if (!has_text) return;
  framing_.gap(gap_, false);
  gap_.clear();
}

Bytes FeatureReader::framing() const {
  FramingWriter framing = framing_;
  framing.gap(gap_, true);
  return std::move(framing).finish();
}

Result<std::optional<FeatureText>> FeatureReader::next() {
  if (is_sequence_) return next_line();
  if (given_ == document_.features.size()) return std::optional<FeatureText>{};
  FeatureText text;
  text.ready = std::move(document_.features[given_++]);
  return std::optional(std::move(text));
}

Result<Feature> FeatureReader::read(FeatureText& text) const {
  if (text.ready) return *std::move(text.ready);
  auto feature = read_city_json_feature(header_, text.line, options_);
  if (!feature) return in_line(std::move(feature).error(), text);
  return feature;
}

}  // namespace watertight::formats
