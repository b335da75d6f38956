// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checks of the promise that every reader makes for any bytes: an Error with a message, or a
// document that can be written and then gives the same solids when read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "formats/document.h"

namespace watertight::fuzz {

inline Limits small_limits() {
  return {.bytes = 1U << 20U,
          .vertices = 10'000,
          .facets = 10'000,
          .rings = 10'000,
          .shells = 1000,
          .nesting = 64};
}

inline void require(bool condition) {
  if (!condition) std::abort();
}

inline void require_same_solids(const Document& a, const Document& b) {
  require(a.features.size() == b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    require(a.features[i].solids.size() == b.features[i].solids.size());
    for (std::size_t j = 0; j < a.features[i].solids.size(); ++j) {
      require(a.features[i].solids[j].solid == b.features[i].solids[j].solid);
    }
  }
}

/// Writes a document as CityGML, which must be one that the reader reads or refuses for its
/// geometry.
inline void check_city_gml(const Document& document) {
  const auto written = formats::write_document(document, Format::gml);
  if (!written) {
    require(!written.error().message.empty());
    return;
  }
  const auto again = formats::read_document(*written, Format::gml);
  require(again.has_value() || again.error().message.find("not well-formed") == std::string::npos);
}

/// Reads a document, writes it in the same format, and reads the result. The writer may refuse a
/// document only as unsupported.
inline void check_reader(ByteView bytes, Format format, bool is_split) {
  formats::ReadOptions options;
  options.limits = small_limits();
  options.split_features = is_split;
  const auto document = formats::read_document(bytes, format, options);
  if (!document) {
    require(!document.error().message.empty());
    return;
  }
  const auto written = formats::write_document(*document, format);
  if (!written) {
    require(written.error().code == ErrorCode::unsupported);
    return;
  }
  options.limits.bytes = 1U << 26U;  // numbers with large exponents are printed with many digits
  options.limits.vertices = 1'000'000;
  const auto again = formats::read_document(*written, format, options);
  require(again.has_value());
  require_same_solids(*document, *again);
  if (format == Format::city_json || format == Format::city_json_seq) check_city_gml(*document);
}

/// A document that keeps its bytes gives them back. CityJSON is left to check_reader().
inline void check_kept(ByteView bytes, Format format) {
  formats::ReadOptions options;
  options.limits = small_limits();
  options.split_features = false;
  options.keep_text = true;
  const auto document = formats::read_document(bytes, format, options);
  if (!document) return;
  const auto written = formats::write_document(*document, format);
  require(written.has_value() && as_text(*written) == as_text(bytes));
}

/// Checks a format that is read only: two readings give the same document, the document states its
/// format, and solids that WKT can hold come back from WKT.
inline void check_read_only(ByteView bytes, Format format) {
  formats::ReadOptions options;
  options.limits = small_limits();
  (void)formats::detect_format("", bytes);
  const auto document = formats::read_document(bytes, format, options);
  if (!document) {
    require(!document.error().message.empty());
    return;
  }
  require(document->format == format);
  const auto again = formats::read_document(bytes, format, options);
  require(again.has_value());
  require_same_solids(*document, *again);
  const auto written = formats::write_document(*document, format);
  require(!written && written.error().code == ErrorCode::unsupported);
  check_kept(bytes, format);
  const auto text = formats::write_document(*document, Format::wkt);
  require(text.has_value() || !text.error().message.empty());
}

}  // namespace watertight::fuzz
