// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests that sequences with different headers are put together without a change of any coordinate.
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "formats/city_json/merge_headers.h"

namespace watertight::formats::test_merge_headers {
namespace {

std::string header(const std::string& scale, const std::string& translate,
                   const std::string& members = "") {
  return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[)" + scale +
         R"(],"translate":[)" + translate + "]}" + (members.empty() ? "" : "," + members) +
         R"(,"CityObjects":{},"vertices":[]})";
}

std::string feature(const std::string& id, const std::string& vertices) {
  return R"({"type":"CityJSONFeature","id":")" + id + R"(","CityObjects":{")" + id +
         R"(":{"type":"Building","attributes":{"height":2.50,"n":1e2},"address":[{"location":)" +
         R"({"type":"MultiPoint","boundaries":[4]}}],"geometry":[{"type":"Solid","lod":"1",)" +
         R"("boundaries":[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]]},{"type":"MultiPoint",)" +
         R"("lod":"1","boundaries":[4]}]}},"vertices":)" + vertices + "}";
}

const std::string kVertices = "[[0,0,0],[1000,0,0],[0,1000,0],[0,0,1000],[-7,13,99]]";

std::vector<SharedHeader> merged(const std::vector<std::string>& headers) {
  auto shared = merge_headers(headers);
  REQUIRE(shared);
  return *std::move(shared);
}

/// The line of `text`, which is under `own`, under a shared header.
Result<std::string> moved(const std::string& own, const std::string& text, const VertexMap& map) {
  const auto city_header = read_city_json_header(own);
  REQUIRE(city_header);
  ReadOptions options;
  options.keep_text = true;
  const auto read = read_city_json_feature(*city_header, text, options);
  REQUIRE(read);
  return write_city_json_feature(*city_header, *read, map);
}

/// Requires that the world coordinates under both headers are the same decimals: a lattice in
/// normal form depends on the values alone.
void check_same(const std::string& own, const std::string& line, const std::string& shared,
                const std::string& moved_line) {
  const auto before = read_city_json_feature(read_city_json_header(own).value(), line);
  const auto after = read_city_json_feature(read_city_json_header(shared).value(), moved_line);
  REQUIRE(before);
  REQUIRE(after);
  REQUIRE(after->solids.size() == before->solids.size());
  CHECK(after->solids[0].solid == before->solids[0].solid);
}

TEST_CASE("headers with other transforms share the finest grid, and no coordinate changes") {
  const std::vector<std::vector<std::string>> cases{
      {header("0.001,0.001,0.001", "100.0,200.0,0"), header("0.001,0.001,0.001", "900,-7.5,3.125")},
      {header("0.001,0.001,0.001", "85013.4840,446500,1.5"), header("0.01,0.1,0.002", "1,2,3")},
      {header("0.01,0.01,0.01", "0,0,0"), header("0.0025,0.001,1", "0.00005,0,-0.5")},
      {header("0.00030480060960121924,0.001,0.001", "0,0,0"),
       header("0.00030480060960121924,0.001,0.001", "0.00030480060960121924,0,0")},
      {header("1e-3,1E-3,0.0010", "1e2,0,0"), header("0.001,0.001,0.001", "100,0,0")}};
  for (const std::vector<std::string>& headers : cases) {
    INFO(headers[1]);
    const std::vector<SharedHeader> shared = merged(headers);
    REQUIRE(shared.size() == 1);
    REQUIRE(shared[0].members == std::vector<std::size_t>{0, 1});
    CHECK(shared[0].losses.empty());
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string line = feature("a", kVertices);
      const auto text = moved(headers[i], line, shared[0].maps[i]);
      REQUIRE(text);
      if (shared[0].maps[i].is_identity()) CHECK(*text == line);
      CHECK(text->find(R"("attributes":{"height":2.50,"n":1e2})") != std::string::npos);
      check_same(headers[i], line, shared[0].text, *text);
    }
  }
}

TEST_CASE("vertices that no solid uses move too") {
  const std::vector<std::string> headers{header("0.001,0.001,0.001", "0,0,0"),
                                         header("0.01,0.001,0.001", "1,0,-2")};
  const std::vector<SharedHeader> shared = merged(headers);
  REQUIRE(shared.size() == 1);
  CHECK(shared[0].maps[1].factor == std::array<std::int64_t, 3>{10, 1, 1});
  CHECK(shared[0].maps[1].shift == std::array<std::int64_t, 3>{1000, 0, -2000});
  const auto text = moved(headers[1], feature("a", kVertices), shared[0].maps[1]);
  REQUIRE(text);
  CHECK(
      text->ends_with("[[1000,0,-2000],[11000,0,-2000],[1000,1000,-2000],[1000,0,-1000],"
                      "[930,13,-1901]]}"));
}

TEST_CASE("a header that is alone stays as it is") {
  const std::string odd = "{ " + header("0.0010,1e-3,0.001", "1.00,2,3").substr(1) + "  ";
  const std::vector<SharedHeader> shared = merged({odd});
  REQUIRE(shared.size() == 1);
  CHECK(shared[0].text == odd);
  CHECK(shared[0].maps[0].is_identity());
  CHECK(shared[0].reason.empty());
}

TEST_CASE("headers that cannot be one say why") {
  const std::string plain = header("0.001,0.001,0.001", "0,0,0");
  const std::string crs =
      R"("metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/)";
  const auto reason = [](const std::string& a, const std::string& b) {
    const std::vector<SharedHeader> shared = merged({a, b});
    if (shared.size() == 1) return std::string();
    CHECK(shared[0].text == a);
    CHECK(shared[1].text == b);
    CHECK(shared[1].members == std::vector<std::size_t>{1});
    return shared[1].reason;
  };
  CHECK(reason(plain, header("0.001,0.001,0.001", "0.123456789012,0,0")).find("common grid") !=
        std::string::npos);
  CHECK(reason(plain, header("0.001,0.001,0.001", "1e15,0,0")).find("common grid") !=
        std::string::npos);
  CHECK(reason(plain, header("1e-30,1,1", "1e30,0,0")).find("common grid") != std::string::npos);
  std::string older = plain;
  older.replace(older.find("2.0"), 3, "1.1");
  CHECK(reason(plain, older) == "another version");
  const std::string dutch = header("1,1,1", "0,0,0", crs + R"(7415"})");
  CHECK(reason(dutch, header("1,1,1", "0,0,0", crs + R"(25832"})")) == "another reference system");
  CHECK(reason(dutch, plain) == "another reference system");
  CHECK(reason(dutch, header("1,1,1", "9,0,0",
                             R"("metadata":{"referenceSystem":"urn:ogc:def:crs:EPSG::7415"})"))
            .empty());
  const std::string noise = R"("extensions":{"Noise":{"url":"https://a","version":"1"}})";
  const std::string other = R"("extensions":{"Noise":{"url":"https://b","version":"1"}})";
  CHECK(reason(header("1,1,1", "0,0,0", noise), header("1,1,1", "0,0,0", other)) ==
        "another definition of the extension Noise");
  CHECK(reason(plain, header("1,1,1", "0,0,0", R"("appearance":{"default-theme-texture":"x"})")) ==
        "another appearance");
  const std::string templates =
      R"("geometry-templates":{"templates":[{"type":"MultiPoint","lod":"1","boundaries":[0]}],)"
      R"("vertices-templates":[[0,0,0]]})";
  CHECK(reason(plain, header("1,1,1", "0,0,0", templates)) == "another geometry-templates");
  CHECK(reason(header("1,1,1", "5,0,0", templates), header("1,1,1", "0,0,0", templates)).empty());
}

TEST_CASE("what headers disagree on is left out and listed; extensions and extents are united") {
  const std::vector<std::string> headers{
      header("1,1,1", "0,0,0",
             R"("metadata":{"title":"A","geographicalExtent":[0,1.50,2,3,4,5],"identifier":"i"},)"
             R"("+mine":1.0,"extensions":{"A":{"url":"a"}})"),
      header("1,1,1", "1,0,0",
             R"("metadata":{"title":"B","geographicalExtent":[-1,7,2,3,9.10,5],"identifier":"i"},)"
             R"("+yours":2,"extensions":{"B":{"url":"b"}})"),
      header("1,1,1", "1,0,0",
             R"("metadata":{"identifier":"i","geographicalExtent":[9,9,9,9,9,9]})")};
  const std::vector<SharedHeader> shared = merged(headers);
  REQUIRE(shared.size() == 1);
  CHECK(shared[0].losses == std::vector<std::string>{"+mine", "+yours", "metadata/title"});
  CHECK(shared[0].text ==
        header("1,1,1", "0,0,0",
               R"("metadata":{"geographicalExtent":[-1,1.50,2,9,9.10,9],"identifier":"i"},)"
               R"("extensions":{"A":{"url":"a"},"B":{"url":"b"}})"));
}

TEST_CASE("three headers need two sequences when the second has another grid") {
  const std::vector<SharedHeader> shared =
      merged({header("0.001,0.001,0.001", "0,0,0"),
              header("0.001,0.001,0.001", "0.12345678901,0,0"), header("0.01,0.01,0.01", "5,5,5")});
  REQUIRE(shared.size() == 2);
  CHECK(shared[0].members == std::vector<std::size_t>{0, 2});
  CHECK(shared[1].members == std::vector<std::size_t>{1});
}

TEST_CASE("a finer grid that a later header needs is checked for the headers before it") {
  // The third header fits the grid of the first two only if their steps become 10^7 times finer.
  const std::vector<SharedHeader> shared =
      merged({header("10,10,10", "0,0,0"), header("1,1,1", "0,0,0"), header("1e-6,1,1", "0,0,0")});
  REQUIRE(shared.size() == 2);
  CHECK(shared[0].members == std::vector<std::size_t>{0, 1});
}

TEST_CASE("a vertex that becomes too large is an error, and so is a header without transform") {
  const std::vector<std::string> headers{header("1,1,1", "0,0,0"), header("1000,1,1", "0,0,0")};
  const std::vector<SharedHeader> shared = merged(headers);
  REQUIRE(shared.size() == 1);
  const auto text =
      moved(headers[1], feature("a", "[[0,0,0],[1,0,0],[0,1,0],[0,0,1],[9007199254741,0,0]]"),
            shared[0].maps[1]);
  REQUIRE_FALSE(text);
  CHECK(text.error().code == ErrorCode::limit_exceeded);
  const auto none = merge_headers(std::vector<std::string>{
      R"({"type":"CityJSON","version":"1.0","CityObjects":{},"vertices":[]})"});
  REQUIRE_FALSE(none);
  CHECK(none.error().code == ErrorCode::unsupported);
}

}  // namespace
}  // namespace watertight::formats::test_merge_headers
