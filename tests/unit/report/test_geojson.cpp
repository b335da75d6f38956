// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/report/samples.h"

using namespace watertight;
using namespace watertight::test;
using Json = nlohmann::json;

namespace {

Json layer_of(const std::vector<pipeline::ValidatedFeature>& features) {
  Written written;
  const auto report = report::geojson_report(written.sink(), head_without_times());
  write_document(*report, "a.city.json", features);
  REQUIRE(report->finish());
  return Json::parse(written.text);
}

}  // namespace

TEST_CASE("a finding is a point at its witness, or in the middle of its facet") {
  Finding with_witness = finding_of(306, 1, 4);
  with_witness.witness = std::array<double, 3>{84617.25, 447423, 4};
  with_witness.measured = 0.5;
  const Json layer = layer_of({feature_of("b", {with_witness, finding_of(203, 0)})});
  CHECK(layer["type"] == "FeatureCollection");
  CHECK(layer["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::7415");
  const Json& first = layer["features"][0];
  CHECK(first["geometry"] == Json{{"type", "Point"}, {"coordinates", {84617.25, 447423.0, 4.0}}});
  CHECK(first["properties"]["code"] == 306);
  CHECK(first["properties"]["object"] == "b");
  CHECK(first["properties"]["lod"] == "2.2");
  CHECK(first["properties"]["measured"] == 0.5);
  CHECK(first["properties"]["limit"].is_null());
  CHECK(first["properties"]["other_pointer"] == "/CityObjects/b/geometry/0/0/4");
  const Json& middle = layer["features"][1]["geometry"]["coordinates"];
  CHECK(middle[0].get<double>() == 84618);
  CHECK(middle[1].get<double>() == 447423.5);
  CHECK(middle[2].get<double>() == 2);
}

TEST_CASE("a finding without a place has no geometry") {
  Finding finding;
  finding.code = 902;
  const Json layer = layer_of({feature_of("b", {finding})});
  CHECK(layer["features"][0]["geometry"].is_null());
}

TEST_CASE("a layer names no reference system when the document names none") {
  CHECK_FALSE(layer_of({feature_of("b", {finding_of(203, 0)}, 0)}).contains("crs"));
}

TEST_CASE("points of another reference system than the layer's are not drawn in it") {
  const Json layer = layer_of(
      {feature_of("a", {finding_of(203, 0)}), feature_of("b", {finding_of(203, 0)}, 28992)});
  CHECK(layer["features"][1]["geometry"].is_null());
  CHECK(layer["features"][1]["properties"]["crs"] == "urn:ogc:def:crs:EPSG::28992");
  CHECK(layer["features"][1]["properties"]["coordinates"].size() == 3);
}

TEST_CASE("a document without findings gives an empty layer, an unreadable document a feature") {
  CHECK(layer_of({feature_of("a", {})})["features"].empty());
  Written written;
  const auto report = report::geojson_report(written.sink(), head_without_times());
  REQUIRE(report->begin_document({"a", std::nullopt}));
  REQUIRE(report->add_error({ErrorCode::unsupported, "what is this"}));
  REQUIRE(report->end_document({}));
  REQUIRE(report->finish());
  CHECK(Json::parse(written.text)["features"][0]["properties"]["code"] == 904);
}
