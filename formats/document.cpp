// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/document.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "formats/city_json.h"

namespace watertight {
namespace {

Bytes bytes_of(const std::string& text) { return Bytes(text.begin(), text.end()); }

bool is_city(Format format) {
  return format == Format::city_json || format == Format::city_json_seq;
}

}  // namespace

std::string_view to_string(Format format) {
  switch (format) {
    case Format::city_json:
      return "city-json";
    case Format::city_json_seq:
      return "city-json-seq";
    case Format::obj:
      return "obj";
    case Format::off:
      return "off";
    case Format::wkt:
      return "wkt";
    case Format::ewkb:
      return "ewkb";
  }
  return "";
}

Result<Document> read_document(ByteView bytes, Format format, const ReadOptions& options) {
  if (bytes.size() > options.limits.bytes) {
    return Error{ErrorCode::limit_exceeded, std::to_string(bytes.size()) + " bytes; the limit is " +
                                                std::to_string(options.limits.bytes)};
  }
  if (format == Format::city_json) return read_city_json(as_text(bytes), options);
  if (format == Format::city_json_seq) return read_city_json_seq(as_text(bytes), options);
  return Error{ErrorCode::unsupported, "cannot read " + std::string(to_string(format))};
}

Result<std::string> write_feature(const Document& document, const Feature& feature) {
  if (is_city(document.format)) {
    auto header = read_city_json_header(document.header, Limits{.bytes = ~0ULL, .nesting = 256});
    if (!header) return std::move(header).error();
    return write_city_json_feature(*header, feature);
  }
  return Error{ErrorCode::unsupported, "cannot write"};
}

Result<Bytes> write_document(const Document& document, Format format) {
  if (!is_city(format) || !is_city(document.format)) {
    return Error{ErrorCode::unsupported, "cannot write " + std::string(to_string(format))};
  }
  auto text =
      format == Format::city_json ? write_city_json(document) : write_city_json_seq(document);
  if (!text) return std::move(text).error();
  return bytes_of(*text);
}

}  // namespace watertight
