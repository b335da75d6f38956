// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>

#include "formats/city_json/city_json.h"

namespace watertight::formats {
namespace {

using OrderedJson = nlohmann::ordered_json;

// A tetrahedron and, in the same geometry, another one, with values for each facet.
constexpr std::string_view kTwoSolids =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
    R"("CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSolid","lod":"2",)"
    R"("boundaries":[[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]],)"
    R"([[[[4,6,5]],[[4,5,7]],[[5,6,7]],[[6,4,7]]]]],)"
    R"("semantics":{"surfaces":[{"type":"WallSurface"},{"type":"RoofSurface"}],)"
    R"("values":[[[0,1,0,1]],[[1,1,0,null]]]},)"
    R"("material":{"t":{"values":[[[0,0,0,0]],[[0,1,2,3]]]},"u":{"value":0}},)"
    R"("texture":{"t":{"values":[[[[[null]],[[null]],[[null]],[[null]]]],)"
    R"([[[[0,1,2,3]],[[0,4,5,6]],[[0,7,8,9]],[[null]]]]]}}}]}},)"
    R"("vertices":[[0,0,0],[4,0,0],[0,4,0],[0,0,4],[9,0,0],[13,0,0],[9,4,0],[9,0,4]]})";

Document two_solids() {
  ReadOptions options;
  options.split_features = false;
  options.keep_text = true;
  auto document = read_document(as_bytes(kTwoSolids), Format::city_json, options);
  REQUIRE(document);
  return *std::move(document);
}

OrderedJson geometry_of(const Document& document) {
  const auto bytes = write_document(document, Format::city_json);
  REQUIRE(bytes);
  const OrderedJson json = OrderedJson::parse(bytes->begin(), bytes->end());
  return json["CityObjects"]["a"]["geometry"][0];
}

/// The second solid with its facets in the order 2, new, 0 (turned over).
SolidEdit changed(const Solid& solid) {
  SolidArrays arrays;
  arrays.vertices.assign(solid.vertices().begin(), solid.vertices().end());
  const auto add = [&](std::vector<Index> ring) {
    arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
    arrays.end_ring();
    arrays.end_facet();
  };
  const auto ring = [&](Index facet) {
    const auto vertices = solid.ring(solid.rings_of(facet).begin);
    return std::vector<Index>(vertices.begin(), vertices.end());
  };
  add(ring(2));
  add(ring(3));
  std::vector<Index> turned = ring(0);
  std::reverse(turned.begin(), turned.end());
  add(turned);
  arrays.end_shell();
  auto made = Solid::make(std::move(arrays), solid.lattice(), solid.srid());
  REQUIRE(made);
  return {1, *std::move(made), {2, kNone, 0}};
}

TEST_CASE("values follow the facets of a solid that is replaced") {
  Document document = two_solids();
  REQUIRE(document.features[0].solids.size() == 2);
  std::vector<SolidEdit> edits{changed(document.features[0].solids[1].solid)};
  REQUIRE(replace_solids(document.features[0], std::move(edits)));
  const OrderedJson geometry = geometry_of(document);
  CHECK(geometry["boundaries"] == OrderedJson::parse("[[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]],"
                                                     "[[[[5,6,7]],[[6,4,7]],[[5,6,4]]]]]"));
  CHECK(geometry["semantics"]["values"] == OrderedJson::parse("[[[0,1,0,1]],[[0,2,1]]]"));
  CHECK(geometry["semantics"]["surfaces"][2]["type"] == "ClosureSurface");
  CHECK(geometry["material"]["t"]["values"] == OrderedJson::parse("[[[0,0,0,0]],[[2,null,0]]]"));
  CHECK(geometry["material"]["u"]["value"] == 0);
  CHECK(geometry["texture"]["t"]["values"] ==
        OrderedJson::parse("[[[[[null]],[[null]],[[null]],[[null]]]],"
                           "[[[[0,7,8,9]],[[null]],[[null]]]]]"));
}

TEST_CASE("the closure surface is added once") {
  Document document = two_solids();
  for (int round = 0; round < 2; ++round) {
    const Solid solid = document.features[0].solids[1].solid;
    SolidEdit edit{1, solid, std::vector<Index>(solid.facet_count(), kNone)};
    REQUIRE(replace_solids(document.features[0], {edit}));
  }
  CHECK(geometry_of(document)["semantics"]["surfaces"].size() == 3);
}

TEST_CASE("a damaged skeleton is an error") {
  Document document = two_solids();
  document.features[0].skeleton = "{\"CityObjects\":";
  const Solid solid = document.features[0].solids[1].solid;
  SolidEdit edit{1, solid, std::vector<Index>(solid.facet_count(), kNone)};
  CHECK(!replace_solids(document.features[0], {edit}));
}

}  // namespace
}  // namespace watertight::formats
