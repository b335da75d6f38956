// SPDX-License-Identifier: GPL-3.0-or-later
//
// One CityJSONSeq for features that came with different headers: one header for as many of them as
// can share one, and the exact change of their vertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/city_json/city_json.h"

namespace watertight::formats {

/// A change of integer vertices on each axis: factor * vertex + shift. Exact.
struct VertexMap {
  std::array<std::int64_t, 3> factor{1, 1, 1};
  std::array<std::int64_t, 3> shift{};
  friend bool operator==(const VertexMap&, const VertexMap&) = default;
  bool is_identity() const { return *this == VertexMap{}; }
};

/// A header that several others can share.
struct SharedHeader {
  std::string text;                  // the very text of a header that is alone
  std::vector<std::size_t> members;  // the numbers of the headers, ascending
  std::vector<VertexMap> maps;       // of the vertices under each member, to those under `text`
  std::vector<std::string> losses;   // paths of values that the members do not agree on, sorted
  std::string reason;  // why its first member is not under the first header; "" for the first
};

/// Puts headers of sequences together, each under the first header that can take it. Headers share
/// one if they agree on version, reference system, appearance and geometry templates, have no
/// extension of one name with two definitions, and if a grid of decimals holds the vertices of all
/// of them: its step divides their scales and the distances of their translations, and is at most
/// 2^20 times finer than each scale. The shared header has the translation of the first one, all
/// extensions, the union of the extents, and the other members and metadata on which all agree.
/// Errors: those of read_city_json_header(); unsupported for a header without transform. Cost:
/// linear in the texts, times the number of shared headers.
Result<std::vector<SharedHeader>> merge_headers(std::span<const std::string> headers);

/// The text of write_city_json_feature() with the vertices under another header. The very text that
/// came in if `map` changes nothing. Errors: those of write_city_json_feature(); limit_exceeded
/// when a vertex would be 2^53 or more, which JSON cannot hold safely.
Result<std::string> write_city_json_feature(const CityHeader& header, const Feature& feature,
                                            const VertexMap& map);

}  // namespace watertight::formats
