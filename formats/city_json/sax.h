// SPDX-License-Identifier: GPL-3.0-or-later
//
// Parses the text of a CityJSON, a CityJSONFeature or a skeleton in one pass. The `boundaries` of
// geometries and the `vertices` go to flat arrays; everything else becomes a Json value. Checks
// syntax, UTF-8, nesting and duplicate keys, but not whether boundaries make solids. Internal to
// formats/.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "formats/text/json.h"
#include "geometry/lattice/lattice.h"
#include "geometry/point.h"

namespace watertight::formats {

/// A token of nested arrays of vertex indices in a flat sequence: a vertex index, kOpen for the
/// start of an array or kClose for its end.
using BoundaryToken = std::uint32_t;
inline constexpr BoundaryToken kOpen = 0xFFFFFFFF;
inline constexpr BoundaryToken kClose = 0xFFFFFFFE;

/// Vertex indices and the number of vertices are below this.
inline constexpr std::uint64_t kMostVertices = 0xFFFFFFF0;

/// An element of `vertices` that is no vertex. It takes a place in the list, with coordinates 0,
/// which nothing may use.
struct FaultyVertex {
  Index vertex = 0;
  Json value;               // the element as it came
  std::string place;        // the JSON Pointer from the element to the fault, "" for the element
  std::string_view reason;  // one clause; a literal
};

/// The `vertices` of a city model: integers, or exact decimals as soon as one number is no integer.
struct VertexList {
  bool are_integers = true;
  bool is_present = false;
  std::vector<std::array<std::int64_t, 3>> integers;
  std::vector<std::array<GridNumber, 3>> decimals;
  std::vector<Index> rounded;             // vertices with a number of more than 18 digits
  std::vector<FaultyVertex> faulty = {};  // ascending
  /// The fault of a vertex, or null. Cost: logarithmic.
  const FaultyVertex* fault_of(Index vertex) const;
  std::size_t size() const { return are_integers ? integers.size() : decimals.size(); }
};

/// The content of a city model. `root` is the document with `vertices` replaced by null and each
/// boundary, at /CityObjects/*/geometry/*/boundaries, by its index into `boundary_begin`.
struct CityModel {
  Json root;
  VertexList vertices;
  std::vector<BoundaryToken> tokens;
  std::vector<std::size_t> boundary_begin{0};  // the start of each boundary in `tokens`, then their
                                               // end
  std::uint64_t text_bytes = 0;                // the length of the text

  std::span<const BoundaryToken> boundary(std::size_t index) const {
    return std::span<const BoundaryToken>(tokens).subspan(
        boundary_begin[index], boundary_begin[index + 1] - boundary_begin[index]);
  }
};

/// A vertex of decimals as a JSON array.
Json json_of(const std::array<GridNumber, 3>& vertex);

/// Whether a text is a document from outside or a skeleton (formats/city_json/model.h), in which
/// `vertices` and the boundaries of solids are objects, which stay Json values.
enum class CityText : std::uint8_t { document, skeleton };

/// Parses a city model. Errors: malformed with byte offset (syntax, UTF-8) or JSON Pointer
/// (content); limit_exceeded. Cost: linear.
Result<CityModel> parse_city_model(std::string_view text, CityText kind, const Limits& limits);

}  // namespace watertight::formats
