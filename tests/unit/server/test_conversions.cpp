// SPDX-License-Identifier: GPL-3.0-or-later
// POST /convert, /encode and /decode: documents in other forms, which nothing stores.
#include <catch2/catch_test_macros.hpp>

#include "tests/files.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_conversions {
namespace {

using samples::Json;

/// Requests with any header fields.
class ConversionRoutes : public samples::RoutesFixture {
 public:
  server::Response send_body(const std::string& target, std::string body,
                             std::vector<server::HeaderField> headers = {}) const {
    return send({"POST", target, std::move(headers), std::move(body)});
  }
};

constexpr const char* kGml = "application/gml+xml";

std::string golden(const std::string& name) {
  return test::read_text(test::source_path("tests/golden/findings/") + name);
}

TEST_CASE_METHOD(ConversionRoutes,
                 "an encoded document is decoded byte for byte, whatever its format") {
  const std::string city = test::read_text(test::source_path("examples/delft.city.jsonl"));
  for (const auto& [text, type] : {std::pair{city, "application/city+json-seq"},
                                   std::pair{golden("102.city.json"), "application/city+json"},
                                   std::pair{golden("103.gml"), kGml}}) {
    INFO(type);
    const auto encoded = send_body("/encode?invalid=keep", text, {{"content-type", type}});
    REQUIRE(encoded.status == 200);
    CHECK(encoded.content_type == "application/vnd.watertight");
    const auto decoded = send_body("/decode", encoded.body, {{"accept", "*/*"}});
    REQUIRE(decoded.status == 200);
    CHECK(decoded.content_type == type);
    CHECK(decoded.body == text);
    const std::string to = type == kGml ? "gml" : text == city ? "cityjsonseq" : "cityjson";
    CHECK(send_body("/decode?to=" + to, encoded.body).body == text);
    if (to == "cityjson") continue;
    CHECK(send_body("/decode?to=cityjson", encoded.body).body ==
          send_body("/convert?to=cityjson", text, {{"content-type", type}}).body);
  }
}

TEST_CASE_METHOD(ConversionRoutes,
                 "a GML document is stored, and its features are given out again") {
  const std::string text = golden("103.gml");
  const auto stored = post("/collections/town/items?invalid=keep", text, kGml);
  INFO(stored.body);
  REQUIRE(stored.status == 201);
  const std::string id = Json::parse(stored.body)["features"][0]["id"];
  const auto list = get("/collections/town/items?crs=http://www.opengis.net/def/nil/OGC/0/unknown");
  REQUIRE(list.status == 200);
  const Json feature = Json::parse(test::whole(list))["features"][0];
  CHECK(feature["id"] == id);
  CHECK(feature["geometry"]["type"] == "MultiPolygon");
  const auto item = get("/collections/town/items/" + id + "?f=gml");
  const std::string gml = test::whole(item);
  CHECK(item.content_type == kGml);
  const auto again = send_body("/convert", gml, {{"content-type", kGml}});
  REQUIRE(again.status == 200);
  const auto first = get("/collections/town/items/" + id + "?f=cityjson");
  CHECK(Json::parse(again.body)["CityObjects"] == Json::parse(test::whole(first))["CityObjects"]);
}

TEST_CASE_METHOD(ConversionRoutes, "invalid solids come back repaired, and what was done") {
  const std::string text = test::read_text(test::source_path("examples/invalid.city.jsonl"));
  const auto report = send_body("/repair?remedies=all&to=report", text);
  INFO(report.body);
  REQUIRE(report.status == 200);
  CHECK(report.content_type == "application/json");
  const Json json = Json::parse(report.body);
  CHECK(json["repairs"] == Json({{"repaired", 6}, {"left", 5}}));
  REQUIRE(json["features"].size() == 11);
  const Json& repair = json["features"][0]["primitives"][0]["repair"];
  CHECK(repair["remedies"] == Json({"fill"}));
  CHECK(repair["holes"][0]["method"] == "facet");
  CHECK(send_body("/repair?remedies=all", text, {{"accept", "application/json"}}).body ==
        report.body);
  const auto mended = send_body("/repair?remedies=all&to=cityjsonseq", text);
  REQUIRE(mended.status == 200);
  CHECK(mended.content_type == "application/city+json-seq");
  const auto judged = send_body("/validate", mended.body);
  REQUIRE(judged.status == 200);
  CHECK(Json::parse(test::whole(judged))["features_overview"][0]["valid"] == 6);
  const auto as_model = send_body("/repair?remedies=all", text);
  CHECK(as_model.content_type == "application/city+json");
  CHECK(Json::parse(as_model.body)["CityObjects"].size() == 11);
  CHECK(Json::parse(send_body("/repair?to=report", text).body)["repairs"]["repaired"] == 3);
  const auto page = send_body("/repair?remedies=all", text, {{"accept", "text/html"}});
  CHECK(page.content_type == "text/html; charset=utf-8");
  CHECK(page.body.find("6 of 11 invalid solids could be repaired") != std::string::npos);
  CHECK(send_body("/repair?remedies=all&to=html", text).body == page.body);
}

TEST_CASE_METHOD(ConversionRoutes, "holes are closed by smooth patches on request") {
  const std::string text = test::read_text(test::source_path("examples/invalid.city.jsonl"));
  const auto report = send_body(
      "/repair?remedies=smooth&density=0.5&regularity=0.6&collar=1&crease=95&chord=0.1&to=report",
      text);
  INFO(report.body);
  REQUIRE(report.status == 200);
  const Json json = Json::parse(report.body);
  CHECK(json["parameters"]["density"] == 0.5);
  CHECK(json["parameters"]["collar"] == 1);
  CHECK(json["parameters"]["smooth_chord"] == 0.1);
  const Json& repair = json["features"][0]["primitives"][0]["repair"];
  CHECK(repair["outcome"] == "repaired");
  CHECK((repair["holes"][0].contains("smooth") || repair["holes"][0].contains("not_smooth")));
  for (const char* wrong : {"density=0.01", "density=101", "regularity=x", "collar=0", "collar=11",
                            "crease=181", "chord=-1"}) {
    INFO(wrong);
    CHECK(send_body(std::string("/repair?remedies=smooth&") + wrong, text).status == 400);
  }
}

TEST_CASE_METHOD(ConversionRoutes, "GML is repaired as GML on request, with its elements and ids") {
  std::string text = test::read_text(test::source_path("tests/data/gml/citygml_2_xlinks.gml"));
  const std::string south = "0,0,0 10,0,0 5,5,10 0,0,0";
  text.replace(text.find(south), south.size(), "0,0,0 5,5,10 10,0,0 0,0,0");
  const auto mended = send_body("/repair?to=gml", text, {{"content-type", kGml}});
  INFO(mended.body);
  REQUIRE(mended.status == 200);
  CHECK(mended.content_type == "application/gml+xml");
  CHECK(mended.body.find("<g:Polygon g:id=\"south\">") != std::string::npos);
  CHECK(send_body("/repair", text, {{"content-type", kGml}, {"accept", "application/gml+xml"}})
            .body == mended.body);
  const Json report =
      Json::parse(send_body("/repair?to=report", text, {{"content-type", kGml}}).body);
  CHECK(report["input_file_type"] == "GML");
  CHECK(report["verdict"] == "valid");
  const std::string city = test::read_text(test::source_path("examples/invalid.city.jsonl"));
  const auto city_mended = send_body("/repair?to=gml", city);
  CHECK(city_mended.status == 200);
  CHECK(city_mended.body.find("<bldg:Building") != std::string::npos);
  CHECK(post("/collections/houses/items", text, kGml).status == 422);
  const auto stored = post("/collections/houses/items?repair=orientation", text, kGml);
  INFO(stored.body);
  REQUIRE(stored.status == 201);
  const auto proven = get("/collections/houses/items/house?f=proof");
  const Json proof = Json::parse(test::whole(proven));
  CHECK(proof["solids"][0]["repair"]["facets_turned"] == 1);
}

TEST_CASE_METHOD(ConversionRoutes,
                 "a document in which solids stay invalid is refused on request") {
  const std::string text = test::read_text(test::source_path("examples/invalid.city.jsonl"));
  const auto refused = send_body("/repair?remedies=all&invalid=refuse", text);
  CHECK(refused.status == 422);
  const Json problem = Json::parse(refused.body);
  CHECK(problem["type"] == "urn:watertight:problem:invalid-solids");
  CHECK(problem["report"]["repairs"]["repaired"] == 6);
  const std::string valid = test::read_text(test::source_path("examples/delft.city.jsonl"));
  const std::string first_two = valid.substr(0, valid.find('\n', valid.find('\n') + 1) + 1);
  const auto kept = send_body("/repair?invalid=refuse&to=cityjsonseq", first_two);
  CHECK(kept.status == 200);
  CHECK(kept.body == first_two);
}

TEST_CASE_METHOD(ConversionRoutes,
                 "what a remedy mends is stored repaired, and the answer says so") {
  const std::string text = test::read_text(test::source_path("examples/invalid.city.jsonl"));
  const auto stored = send_body("/collections/mended/items?repair=all&invalid=skip", text,
                                {{"content-type", "application/city+json-seq"}});
  INFO(stored.body);
  REQUIRE(stored.status == 201);
  const Json answer = Json::parse(stored.body);
  CHECK(answer["stored"] == 6);
  CHECK(answer["counts"]["valid"] == 6);
  const Json& first = answer["features"][0];
  CHECK(first["id"] == "open-box");
  CHECK(first["verdict"] == "valid");
  CHECK(first["repairs"][0]["repair"]["outcome"] == "repaired");
  CHECK(first["repairs"][0]["repair"]["area_added"] == 80.0);
  const auto item = get("/collections/mended/items/open-box");
  REQUIRE(item.status == 200);
  const Json proof = Json::parse(get("/collections/mended/items/open-box?f=proof").body);
  CHECK(proof["solids"][0]["repair"] == first["repairs"][0]["repair"]);
  const Json shown = Json::parse(get("/collections/mended/items/open-box?f=geojson").body);
  CHECK(shown["properties"]["wt_repaired_solids"] == 1);
  const auto judged = send_body("/validate", test::whole(item));
  CHECK(Json::parse(test::whole(judged))["validity"] == true);
  for (const char* query : {"weld=0.1", "islands=2", "repair=glue", "repair=all&weld=-1"}) {
    INFO(query);
    const auto refused = send_body(std::string("/collections/mended/items?") + query, text,
                                   {{"content-type", "application/city+json-seq"}});
    CHECK(refused.status == 400);
  }
  CHECK(send_body("/collections/gml/items?repair=all", golden("103.gml"), {{"content-type", kGml}})
            .status == 422);
}

TEST_CASE_METHOD(ConversionRoutes, "parameters of a repair that are wrong are refused") {
  const std::string text = golden("102.city.json");
  for (const char* query : {"remedies=glue", "remedies=", "weld=-1", "weld=nan", "weld=1001",
                            "islands=6", "invalid=skip", "planarity=0", "overlap=1"}) {
    INFO(query);
    const auto refused = send_body(std::string("/repair?") + query, text);
    CHECK(refused.status == 400);
  }
  CHECK(send_body("/repair?to=pdf", text).status == 406);
  CHECK(send_body("/repair", "no document").status >= 400);
}

TEST_CASE_METHOD(ConversionRoutes,
                 "a document that is not valid is not encoded unless that is wanted") {
  const std::string text = golden("102.city.json");
  const auto refused = send_body("/encode", text);
  CHECK(refused.status == 422);
  const Json problem = Json::parse(refused.body);
  CHECK(problem["type"] == "urn:watertight:problem:invalid-solids");
  CHECK(problem["detail"].get<std::string>().ends_with("nothing was encoded"));
  CHECK(problem["report"]["counts"]["invalid"] == 1);
  CHECK(send_body("/encode?invalid=keep", text).status == 200);
  CHECK(send_body("/encode?invalid=perhaps", text).status == 400);
  CHECK(send_body("/encode?planarity=-1", text).status == 400);
}

TEST_CASE_METHOD(ConversionRoutes,
                 "a GML document becomes a city model, with notes of what has no place") {
  const auto converted = send_body("/convert", golden("103.gml"),
                                   {{"content-type", kGml}, {"accept", "application/city+json"}});
  REQUIRE(converted.status == 200);
  CHECK(converted.content_type == "application/city+json");
  const Json city = Json::parse(converted.body);
  CHECK(city["CityObjects"]["sample"]["geometry"][0]["type"] == "Solid");
}

TEST_CASE_METHOD(ConversionRoutes, "a document is converted to each format that is written") {
  const std::string text = golden("201.city.json");
  for (const char* to : {"cityjson", "cityjsonseq", "obj", "off", "wkt", "ewkb", "gml"}) {
    INFO(to);
    const auto converted = send_body(std::string("/convert?to=") + to, text);
    CHECK((converted.status == 200 || converted.status == 422));  // OFF has no several solids
    CHECK(!converted.body.empty());
  }
  CHECK(send_body("/convert?to=wkt", text).body.starts_with("POLYHEDRALSURFACE Z"));
  CHECK(send_body("/convert?to=stl", text).status == 406);
  CHECK(send_body("/convert", text, {{"accept", "image/png"}}).status == 406);
  CHECK(send_body("/convert", "{\"type\":").status == 400);
  CHECK(send_body("/convert?surfaces=perhaps", text).status == 400);
}

TEST_CASE_METHOD(ConversionRoutes, "a body that is no Watertight file is not decoded") {
  CHECK(send_body("/decode", golden("102.city.json")).status == 415);
  const std::string text = golden("102.city.json");
  std::string file = send_body("/encode?invalid=keep", text).body;
  CHECK(send_body("/convert", file, {{"content-type", "application/vnd.watertight"}}).status ==
        415);
  CHECK(send_body("/decode", file.substr(0, file.size() / 2)).status == 400);
  CHECK(send_body("/decode", file, {{"accept", "image/png"}}).status == 406);
}

TEST_CASE_METHOD(ConversionRoutes,
                 "a body of the type that curl gives to each is known by its first bytes") {
  const char* type = "application/x-www-form-urlencoded";
  CHECK(send_body("/validate", golden("103.gml"), {{"content-type", type}}).status == 200);
  CHECK(send_body("/validate", "a=b", {{"content-type", type}}).status == 415);
}

}  // namespace
}  // namespace watertight::test_conversions
