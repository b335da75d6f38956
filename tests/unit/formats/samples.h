// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small city models for the tests of formats/.
#pragma once

#include <catch2/catch_test_macros.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "formats/document.h"
#include "tests/files.h"

namespace watertight::test {

inline std::string file_text(const std::string& name) {
  return read_text(test::source_path("tests/data/" + name));
}

inline Result<Document> read(std::string_view text, Format format, bool is_split = true) {
  formats::ReadOptions options;
  options.split_features = is_split;
  return formats::read_document(as_bytes(text), format, options);
}

/// The error of the one part of a CityJSON that cannot be read. Requires exactly one.
inline Error part_of(std::string_view text) {
  const auto document = read(text, Format::city_json);
  REQUIRE(document);
  std::vector<Error> errors;
  for (const Feature& feature : document->features) {
    for (const auto& part : feature.unreadable) errors.push_back(part.error);
  }
  REQUIRE(errors.size() == 1);
  return errors.front();
}

/// Two top-level objects: the first has a Solid, a tetrahedron, and a MultiSurface that uses a
/// fifth vertex; the second has a child with a MultiSolid of two tetrahedra.
inline const std::string kTwoBuildings =
    R"({"type":"CityJSON","version":"2.0",)"
    R"("transform":{"scale":[0.001,0.001,0.001],"translate":[85000.5,447000.25,-3.0]},)"
    R"("metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415"},)"
    R"("CityObjects":{)"
    R"("a":{"type":"Building","attributes":{"height":12.50,"big":123456789012345678901234567890},)"
    R"("geometry":[)"
    R"({"type":"MultiSurface","lod":"0","boundaries":[[[0,1,7]]]},)"
    R"({"type":"Solid","lod":"2.2","boundaries":[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]],)"
    R"("semantics":{"surfaces":[{"type":"WallSurface"}],"values":[[0,null,0,0]]}}]},)"
    R"("b":{"type":"Building","children":["b-1"]},)"
    R"("b-1":{"type":"BuildingPart","parents":["b"],"geometry":[)"
    R"({"type":"MultiSolid","lod":"1","boundaries":[)"
    R"([[[[4,6,5]],[[4,5,3]],[[5,6,3]],[[6,4,3]]]],)"
    R"([[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]]]}]}},)"
    R"("vertices":[[0,0,0],[1000,0,0],[0,1000,0],[0,0,1000],[5000,0,0],[6000,0,0],[5000,1000,0],)"
    R"([99,98,97],[1,2,3]]})";

/// Truncated kept forms of a document are errors, and forms with a changed bit are errors or give
/// the text.
inline void check_damaged_framing(Document document, std::string_view text) {
  const Bytes framing = document.framing;
  for (std::size_t size = 1; size < framing.size(); ++size) {
    document.framing.assign(framing.begin(), framing.begin() + static_cast<std::ptrdiff_t>(size));
    const auto result = formats::write_document(document, document.format);
    REQUIRE_FALSE(result);
    CHECK_FALSE(result.error().message.empty());
  }
  for (std::size_t i = 0; i < framing.size(); ++i) {
    for (const unsigned bit : {1U, 2U, 4U, 16U, 128U}) {
      document.framing = framing;
      document.framing[i] = static_cast<std::uint8_t>(framing[i] ^ bit);
      const auto result = formats::write_document(document, document.format);
      if (result) CHECK(as_text(*result) == text);
    }
  }
}

}  // namespace watertight::test
