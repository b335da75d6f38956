// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "codec/blob.h"
#include "pipeline/container.h"
#include "server/budget.h"
#include "server/handlers.h"
#include "tests/files.h"
#include "tests/unit/pipeline/samples.h"
#include "tests/unit/server/answers.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_routes {
namespace {

using samples::header_of;
using samples::Json;
using samples::kOneOpen;
using samples::kTwo;
using samples::problem_of;
using Fixture = samples::RoutesFixture;

/// The value, or the part of the document that it refers to.
Json resolved(const Json& document, const Json& value) {
  if (!value.contains("$ref")) return value;
  return document.at(Json::json_pointer(value["$ref"].get<std::string>().substr(1)));
}

TEST_CASE_METHOD(Fixture, "the OpenAPI document describes exactly the routes") {
  const Json api = Json::parse(get("/api").body);
  CHECK(api["info"]["version"] == WATERTIGHT_VERSION);
  std::size_t operations = 0;
  for (const auto& [path, methods] : api["paths"].items()) operations += methods.size();
  CHECK(operations == server::routes().size());
  for (const server::Route& route : server::routes()) {
    INFO(route.method << " " << route.path);
    std::string method(route.method);
    for (char& c : method) c = static_cast<char>(c - 'A' + 'a');
    REQUIRE(api["paths"].contains(std::string(route.path)));
    REQUIRE(api["paths"][std::string(route.path)].contains(method));
    std::vector<std::string> described;
    const Json operation = api["paths"][std::string(route.path)][method];
    for (const Json& given : operation.value("parameters", Json::array())) {
      const Json parameter = resolved(api, given);
      if (parameter["in"] == "query") described.push_back(parameter["name"]);
    }
    std::vector<std::string> known(route.parameters.begin(), route.parameters.end());
    std::sort(described.begin(), described.end());
    std::sort(known.begin(), known.end());
    CHECK(described == known);
  }
}

TEST_CASE("each reference of the OpenAPI document leads to a part, and each part has a reference") {
  const Json api = Json::parse(server::kOpenApi);
  const Json leaves = api.flatten();
  std::set<std::string> references;
  for (const auto& [pointer, value] : leaves.items()) {
    if (pointer.ends_with("/$ref")) references.insert(value.get<std::string>());
  }
  for (const Json& ways : api["security"]) {  // these name their parts without $ref
    for (const auto& [name, scopes] : ways.items()) {
      references.insert("#/components/securitySchemes/" + name);
    }
  }
  for (const std::string& reference : references) {
    INFO(reference);
    CHECK(api.contains(Json::json_pointer(reference.substr(1))));
  }
  for (const auto& [kind, parts] : api["components"].items()) {
    for (const auto& [name, part] : parts.items()) {
      INFO(kind << " " << name);
      CHECK(references.count("#/components/" + kind + "/" + name) == 1);
    }
  }
}

TEST_CASE_METHOD(Fixture, "the landing page is HTML for browsers and JSON for programs") {
  const server::Response json = get("/");
  CHECK(json.content_type == "application/json");
  const server::Response html = get("/?f=html");
  CHECK(html.content_type == "text/html; charset=utf-8");
  const Json page = Json::parse(json.body);
  for (const Json& link : page["links"]) {
    CHECK(html.body.find("href=\"" + link["href"].get<std::string>() + "\"") != std::string::npos);
  }
  CHECK(get("/?f=pdf").status == 406);
}

TEST_CASE_METHOD(Fixture, "a posted document is stored and comes back in each format") {
  const server::Response posted = post("/collections/town/items", kTwo);
  REQUIRE(posted.status == 201);
  CHECK(Json::parse(posted.body)["stored"] == 2);
  const server::Response city = get("/collections/town/items/a");
  REQUIRE(city.status == 200);
  CHECK(city.content_type == "application/city+json");
  CHECK(Json::parse(city.body)["type"] == "CityJSON");
  const server::Response sequence = get("/collections/town/items/a?f=cityjsonseq");
  const std::size_t line = sequence.body.find('\n');
  CHECK(Json::parse(sequence.body.substr(line + 1)) == Json::parse(samples::feature("a")));
  CHECK(get("/collections/town/items/a", {{"accept", "model/obj"}}).content_type == "model/obj");
  CHECK(
      get("/collections/town/items/a", {{"accept", "text/wkt"}}).body.find("POLYHEDRALSURFACE Z") !=
      std::string::npos);
  const server::Response binary = get("/collections/town/items/a?f=ewkb");
  CHECK(binary.content_type == "application/ewkb");
  CHECK(Json::parse(post("/validate?f=ewkb", binary.body, "").body)["verdict"] == "valid");
  CHECK(get("/collections/town/items/a?f=blob").content_type == "application/vnd.watertight.blob");
  CHECK(get("/collections/town/items/a?f=wt").content_type == "application/vnd.watertight");
  problem_of(get("/collections/town/items/a", {{"accept", "image/png"}}));
  CHECK(get("/collections/town/items/a", {{"accept", "image/png"}}).status == 406);
  CHECK(get("/collections/town/items/a?f=ply").status == 406);
}

TEST_CASE_METHOD(Fixture, "a single feature takes the transform of its collection") {
  const server::Response early =
      post("/collections/town/items", samples::feature("c"), "application/json");
  CHECK(early.status == 400);
  problem_of(early);
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  const server::Response posted =
      post("/collections/town/items", samples::feature("c"), "application/city+json");
  REQUIRE(posted.status == 201);
  REQUIRE(header_of(posted, "Location"));
  CHECK(*header_of(posted, "Location") == "/collections/town/items/c");
  CHECK(get("/collections/town/items/c").status == 200);
}

TEST_CASE_METHOD(Fixture, "a single feature is refused where the collection has two transforms") {
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  std::string coarse = samples::sequence({samples::feature("coarse")});
  coarse.replace(coarse.find("0.001,0.001,0.001"), 17, "0.002,0.002,0.002");
  REQUIRE(post("/collections/town/items", coarse).status == 201);
  const server::Response posted =
      post("/collections/town/items", samples::feature("c"), "application/city+json");
  CHECK(posted.status == 409);
  CHECK(problem_of(posted)["detail"].get<std::string>().find("several headers") !=
        std::string::npos);
  CHECK(get("/collections/town/items/c").status == 404);
}

TEST_CASE_METHOD(Fixture, "the export of a collection of two documents can be posted") {
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  std::string coarse = samples::sequence({samples::feature("coarse")});
  coarse.replace(coarse.find("0.001,0.001,0.001"), 17, "0.002,0.002,0.002");
  REQUIRE(post("/collections/town/items", coarse).status == 201);
  const server::Response file = get("/collections/town/export?f=wt");
  REQUIRE(file.status == 200);
  const std::string bytes = test::whole(file);
  for (const std::string& type : {std::string("application/vnd.watertight"), std::string()}) {
    const server::Response posted = post("/collections/copy/items", bytes, type);
    INFO(posted.body);
    REQUIRE(posted.status == 201);
    CHECK(Json::parse(posted.body)["stored"] == 3);
  }
  CHECK(test::whole(get("/collections/copy/export?f=wt")) == bytes);
  CHECK(post("/collections/copy/items", bytes.substr(0, bytes.size() / 2),
             "application/vnd.watertight")
            .status == 400);
}

TEST_CASE_METHOD(Fixture, "an invalid solid is refused with the report and nothing is stored") {
  const server::Response response = post("/collections/town/items", kOneOpen);
  REQUIRE(response.status == 422);
  const Json json = problem_of(response);
  CHECK(json["type"] == "urn:watertight:problem:invalid-solids");
  CHECK(json["report"]["features"][1]["solids"][0]["report"]["verdict"] == "invalid");
  CHECK(get("/collections/town/items/a").status == 404);
}

TEST_CASE_METHOD(Fixture, "invalid=skip stores the valid features and reports the rest") {
  const server::Response response = post("/collections/town/items?invalid=skip", kOneOpen);
  REQUIRE(response.status == 201);
  CHECK(Json::parse(response.body)["verdict"] == "invalid");
  CHECK(get("/collections/town/items/a").status == 200);
  CHECK(get("/collections/town/items/open").status == 404);
  CHECK(post("/collections/town/items?invalid=maybe", kOneOpen).status == 400);
}

TEST_CASE_METHOD(Fixture, "an id that cannot be stored is refused with its place") {
  for (const char* id : {"..", "a"}) {
    const std::string first = samples::sequence({samples::feature("a")});
    const server::Response response =
        post("/collections/town/items", first + samples::feature(id) + "\n");
    REQUIRE(response.status == 400);
    const Json problem = problem_of(response);
    CHECK(problem["detail"].get<std::string>().starts_with("line 3: "));
    CHECK(problem["byteOffset"] == first.size());
  }
}

TEST_CASE_METHOD(Fixture, "documents that are being read share a budget of memory") {
  const std::string wkt = "POLYHEDRALSURFACE Z (((0 0 0,0 1 0,1 0 0,0 0 0)))";
  constexpr std::size_t kText = 2000;  // longer than each line of kTwo
  server::Budget memory(40 * kText);
  const auto send_with_budget = [&](const std::string& body, const std::string& type) {
    server::Service service{&store, nullptr, {}};
    service.document_memory = &memory;
    return server::respond(service, {"POST", "/validate", {{"content-type", type}}, body},
                           [] { return false; });
  };
  CHECK(send_with_budget(wkt, "text/wkt").status == 200);
  const server::Response large = send_with_budget(wkt + std::string(kText, ' '), "text/wkt");
  REQUIRE(large.status == 413);
  CHECK(problem_of(large)["detail"].get<std::string>().find("CityJSONSeq") != std::string::npos);
  std::string sequence(kTwo);
  while (sequence.size() < 2 * kText) sequence += '\n';
  CHECK(send_with_budget(sequence, "application/city+json-seq").status == 200);
  sequence += std::string(kText + 1, ' ') + '\n';
  CHECK(send_with_budget(sequence, "application/city+json-seq").status == 413);
  const server::BudgetShare of_others(memory, 40 * (kText - wkt.size() + 1));
  const server::Response refused = send_with_budget(wkt, "text/wkt");
  CHECK(refused.status == 503);
  CHECK(header_of(refused, "Retry-After") != nullptr);
}

TEST_CASE_METHOD(Fixture, "a report that would be longer than an answer may be is refused") {
  server::Service service{&store, nullptr, {}};
  const server::Request request{
      "POST", "/validate", {{"content-type", "application/city+json-seq"}}, kTwo};
  CHECK(server::respond(service, request, [] { return false; }).status == 200);
  service.options.longest_report = 1000;
  const server::Response refused = server::respond(service, request, [] { return false; });
  CHECK(refused.status == 413);
  CHECK(problem_of(refused)["detail"].get<std::string>().find("1000 bytes") != std::string::npos);
}

TEST_CASE_METHOD(Fixture,
                 "validate gives verdicts for documents of any format and stores nothing") {
  const server::Response response = post("/validate", kOneOpen);
  REQUIRE(response.status == 200);
  CHECK(Json::parse(response.body)["verdict"] == "invalid");
  const std::string wkt = "POLYHEDRALSURFACE Z (((0 0 0,0 1 0,1 0 0,0 0 0)))";
  CHECK(Json::parse(post("/validate", wkt, "text/wkt").body)["verdict"] == "invalid");
  CHECK(Json::parse(post("/validate?f=wkt", wkt, "").body)["verdict"] == "invalid");
  CHECK(get("/collections").body.find("town") == std::string::npos);
}

TEST_CASE_METHOD(Fixture,
                 "each format has its media types and its name; only those with ids are stored") {
  struct Sample {
    std::string f;
    std::vector<std::string> types;
    std::string body;
  };
  const std::string solid =
      R"(<g:Solid xmlns:g="http://www.opengis.net/gml/3.2"><g:exterior><g:Shell><g:surfaceMember>)"
      "<g:Polygon><g:exterior><g:LinearRing><g:posList>0 0 0 0 1 0 1 0 0 0 0 0</g:posList>"
      "</g:LinearRing></g:exterior></g:Polygon></g:surfaceMember></g:Shell></g:exterior></g:Solid>";
  const std::string polyhedron =
      R"({"type":"Feature","id":"a","geometry":null,"properties":{},"time":null,"place":)"
      R"({"type":"Polyhedron","coordinates":[[[[[0,0,0],[0,1,0],[1,0,0],[0,0,0]]]]]}})";
  const std::string stl =
      "solid a\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\n"
      "endloop\nendfacet\nendsolid a\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n0 1 0\n1 0 0\n3 0 1 2\n";
  const std::string poly = "3 3 0 0\n0 0 0 0\n1 0 1 0\n2 1 0 0\n1 0\n1\n3 0 1 2\n0\n0\n";
  const std::vector<Sample> samples{
      {"gml", {"application/gml+xml; version=3.2", "application/xml", "text/xml"}, solid},
      {"jsonfg", {"application/vnd.ogc.fg+json", "application/geo+json"}, polyhedron},
      {"stl", {"model/stl"}, stl},
      {"ply", {"model/x-ply"}, ply},
      {"poly", {}, poly}};
  for (const Sample& sample : samples) {
    INFO(sample.f);
    const auto is_read = [](const server::Response& response) {
      INFO(response.body);
      return response.status == 200 && Json::parse(response.body)["verdict"] == "invalid";
    };
    CHECK(is_read(post("/validate?f=" + sample.f, sample.body, "")));
    // Formats whose features have ids can be stored: one sample has none, the other is not valid.
    const unsigned refusal = sample.f == "gml" ? 400 : sample.f == "jsonfg" ? 422 : 415;
    CHECK(post("/collections/town/items?f=" + sample.f, sample.body, "").status == refusal);
    for (const std::string& type : sample.types) {
      CHECK(is_read(post("/validate", sample.body, type)));
      CHECK(post("/collections/town/items", sample.body, type).status == refusal);
    }
  }
}

TEST_CASE_METHOD(Fixture, "validate answers with the report, a layer or a page, by Accept") {
  const auto answer = [&](const std::string& accept) {
    return send({"POST",
                 "/validate",
                 {{"content-type", "application/city+json-seq"}, {"accept", accept}},
                 kOneOpen});
  };
  const Json report = Json::parse(answer("*/*").body);
  CHECK(report["type"] == "val3dity_report");
  CHECK(report["schema"] == 2);
  CHECK(report["all_errors"] == Json{302});
  const server::Response layer = answer("application/geo+json");
  CHECK(layer.content_type == "application/geo+json");
  CHECK(Json::parse(layer.body)["features"][0]["properties"]["code"] == 302);
  const server::Response page = answer("text/html,application/xhtml+xml");
  CHECK(page.content_type == "text/html; charset=utf-8");
  CHECK(page.body.find("SHELL_NOT_CLOSED") != std::string::npos);
  CHECK(answer("image/png").status == 406);
}

TEST_CASE_METHOD(Fixture, "OPTIONS of the service as a whole lists its methods") {
  const server::Response response = send({"OPTIONS", "*", {}, ""});
  CHECK(response.status == 204);
  REQUIRE(header_of(response, "Allow"));
  CHECK(header_of(response, "Allow")->find("PATCH") != std::string::npos);
  CHECK(send({"GET", "*", {}, ""}).status == 400);
}

TEST_CASE("the server's own words about a failure are for the log alone") {
  const Error error{
      ErrorCode::unavailable, "the database is away", {}, {}, "no file /secret/socket"};
  const server::Response response = server::to_response(server::to_problem(error));
  CHECK(response.body.find("secret") == std::string::npos);
  CHECK(response.note == "no file /secret/socket");
}

TEST_CASE_METHOD(Fixture, "surfaces are checked, judged, taken for solids or ignored") {
  const std::string city =
      test::read_text(test::source_path("tests/data/cityjson/surfaces.city.json"));
  const auto validate = [&](const std::string& query) {
    const server::Response response = post("/validate" + query, city, "application/city+json");
    REQUIRE(response.status == 200);
    return Json::parse(response.body);
  };
  const Json checked = validate("");
  CHECK(checked["verdict"] == "valid");
  CHECK(checked["surfaces"] ==
        Json{{"checked", 7}, {"closed", 3}, {"closed_valid", 1}, {"with_findings", 2}});
  CHECK_FALSE(checked["parameters"].contains("surfaces"));
  CHECK(validate("?surfaces=check") == checked);
  const Json judged = validate("?surfaces=judge");
  CHECK(judged["all_errors"] == Json{102, 203, 902});
  CHECK(judged["parameters"]["surfaces"] == "judge");
  CHECK(validate("?surfaces=as-solids")["all_errors"] == Json{307});
  CHECK_FALSE(validate("?surfaces=ignore").contains("surfaces"));
  CHECK(post("/validate?surfaces=solids", city, "application/city+json").status == 400);

  const std::string items = "/collections/town/items";
  CHECK(post(items + "?surfaces=judge", city, "application/city+json").status == 400);
  CHECK(post(items + "?invalid=keep&surfaces=as-solids", city, "application/city+json").status ==
        201);
  const Json closed = Json::parse(get(items + "/closed?f=proof").body);
  CHECK(closed["solids"][0]["proven"] == true);
  CHECK_FALSE(closed.contains("otherGeometries"));
  CHECK(Json::parse(get(items + "/turned?f=proof").body)["solids"][0]["proven"] == false);
  const Json two = Json::parse(get(items + "/two?f=proof").body);
  CHECK(two["otherGeometries"] == Json{{"MultiSurface", 1}});
  const Json item = Json::parse(get(items + "/closed?f=cityjson").body);
  CHECK(item["CityObjects"]["closed"]["geometry"][0]["type"] == "MultiSurface");
}

TEST_CASE_METHOD(Fixture, "a malformed body is answered with its place") {
  const server::Response response =
      post("/validate", "{\"type\":\"CityJSON\",", "application/json");
  CHECK(response.status == 400);
  CHECK(problem_of(response).contains("byteOffset"));
  CHECK(post("/validate", "x", "image/png").status == 415);
  CHECK(post("/collections/town/items", "v 0 0 0\n", "model/obj").status == 415);
  CHECK(post("/validate?planarity=-1", kTwo).status == 400);
  CHECK(post("/validate?proof=faith", kTwo).status == 400);
}

TEST_CASE_METHOD(Fixture, "lists are paged by next links that visit each item once") {
  std::vector<std::string> features;
  for (int i = 10; i < 17; ++i) features.push_back(samples::feature("f " + std::to_string(i)));
  REQUIRE(post("/collections/town/items", samples::sequence(features)).status == 201);
  std::string target = "/collections/town/items?limit=3";
  std::vector<std::string> seen;
  while (!target.empty() && seen.size() < 20) {
    const server::Response response = get(target);
    REQUIRE(response.status == 200);
    const Json page = Json::parse(response.body);
    CHECK(page["numberMatched"] == 7);
    for (const Json& item : page["features"]) seen.push_back(item["id"]);
    target.clear();
    for (const Json& link : page["links"]) {
      if (link["rel"] == "next") target = link["href"];
    }
  }
  CHECK(seen.size() == 7);
  CHECK(std::is_sorted(seen.begin(), seen.end()));
}

TEST_CASE_METHOD(Fixture, "bbox selects the features whose boxes it touches") {
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  const std::string items = "/collections/town/items?bbox=";
  const std::string crs = "&bbox-crs=http://www.opengis.net/def/crs/EPSG/0/7415";
  const auto matched = [&](const std::string& box) {
    return Json::parse(get(items + box + crs).body)["numberMatched"].get<int>();
  };
  const Json first = Json::parse(get(items + "100,200,101,201&limit=1" + crs).body);
  CHECK(first["numberReturned"] == 1);
  CHECK_FALSE(first.contains("numberMatched"));  // it would have to look at all features
  CHECK(matched("100,200,101,201") == 2);
  CHECK(matched("100,200,0,101,201,1") == 2);
  CHECK(matched("101.5,200,102,201") == 0);
  CHECK(matched("100,200,3,101,201,4") == 0);
  CHECK(get(items + "100,200,101,201&bbox-crs=http://www.opengis.net/def/crs/EPSG/0/4326").status ==
        400);
  for (const char* wrong :
       {"", "1,2,3", "1,2,3,4,5", "1,2,3,x", "3,3,1,1", "1,2,3,4,5,6,7", "nan,0,1,1"}) {
    INFO(wrong);
    CHECK(get(items + wrong + crs).status == 400);
  }
}

TEST_CASE_METHOD(Fixture, "ETags change with the feature and save a download") {
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  const server::Response first = get("/collections/town/items/a");
  REQUIRE(header_of(first, "ETag"));
  const std::string etag = *header_of(first, "ETag");
  CHECK(get("/collections/town/items/a", {{"if-none-match", etag}}).status == 304);
  CHECK(get("/collections/town/items/a?f=obj", {{"if-none-match", etag}}).status == 200);
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  CHECK(get("/collections/town/items/a", {{"if-none-match", etag}}).status == 200);
}

/// A document with `count` buildings, whose ids are "b1000", ...
std::string many(int count) {
  std::vector<std::string> lines;
  for (int i = 0; i < count; ++i) {
    std::string id = std::to_string(1000 + i);
    id.insert(id.begin(), 'b');
    lines.push_back(samples::feature(id));
  }
  return samples::sequence(lines);
}

TEST_CASE_METHOD(Fixture, "a collection comes as one file in the form that is asked for") {
  const std::string text = many(600);
  REQUIRE(post("/collections/town/items", text).status == 201);
  const server::Response sequence = get("/collections/town/export?f=cityjsonseq");
  REQUIRE(sequence.status == 200);
  CHECK(sequence.content_type == "application/city+json-seq");
  CHECK(*header_of(sequence, "Content-Disposition") == "attachment; filename=\"town.city.jsonl\"");
  CHECK(sequence.rest);
  CHECK(sequence.body.size() < text.size());
  CHECK(test::whole(sequence) == text);
  const server::Response file = get("/collections/town/export");
  REQUIRE(file.status == 200);
  CHECK(file.content_type == "application/vnd.watertight");
  const std::string bytes = test::whole(file);
  const auto documents = pipeline::decode_container(as_bytes(bytes));
  REQUIRE(documents);
  REQUIRE(documents->size() == 1);
  CHECK(as_text(*formats::write_document(documents->front(), Format::city_json_seq)) == text);
  CHECK(get("/collections/town/export", {{"accept", "application/city+json-seq"}}).content_type ==
        "application/city+json-seq");
  const Json collection = Json::parse(get("/collections/town").body);
  for (const Json& link : collection["links"]) {
    INFO(link["href"]);
    CHECK(get(link["href"]).status == 200);
  }
}

TEST_CASE_METHOD(Fixture, "a collection of one feature comes as one part, whose length is known") {
  REQUIRE(post("/collections/town/items", many(1)).status == 201);
  const server::Response file = get("/collections/town/export");
  CHECK_FALSE(file.rest);
  CHECK(pipeline::decode_container(as_bytes(file.body)));
}

TEST_CASE_METHOD(Fixture, "an impossible export is refused before its first byte") {
  const auto refused = [&](const std::string& target, unsigned status, const std::string& says) {
    const server::Response response = get(target);
    INFO(target << " " << response.body);
    CHECK(response.status == status);
    CHECK(problem_of(response)["detail"].get<std::string>().find(says) != std::string::npos);
    CHECK_FALSE(response.rest);
  };
  refused("/collections/none/export", 404, "none");
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  refused("/collections/town/export?f=obj", 406, "application/vnd.watertight (f=wt)");
  refused("/collections/town/export?limit=3", 400, "known here: f");
  CHECK(get("/collections/town/export", {{"accept", "text/html"}}).status == 406);
  CHECK(send({"POST", "/collections/town/export", {}, ""}).status == 405);
  auto feature = store.get("town", "a");
  REQUIRE(feature);
  feature->solids[0].blob.back() ^= 1U;
  REQUIRE(store.put({&*feature, 1}));
  refused("/collections/town/export?f=cityjsonseq", 500, "cannot be exported");
  std::string other = samples::sequence({samples::feature("zz")});
  other.replace(other.find("100.0"), 5, "0.12345678901");
  REQUIRE(post("/collections/town/items", other).status == 201);
  refused("/collections/town/export?f=cityjsonseq", 406, "different headers");
  for (const char* id : {"a", "b", "zz"}) REQUIRE(store.remove("town", id));
  refused("/collections/town/export", 404, "no features");
  refused("/collections/town/export?f=cityjsonseq", 404, "no features");
  store.is_away = true;
  refused("/collections/town/export", 503, "away");
}

TEST_CASE_METHOD(Fixture, "every id that is stored can be fetched, listed, paged and deleted") {
  const std::vector<std::string> ids{"a\\tb", "line\\n", "\\u0001", "\\u007f",
                                     "...",   "%2E",     "a/b?c#d", "\\u00e9"};
  std::vector<std::string> features;
  for (const std::string& id : ids) features.push_back(samples::feature(id));
  REQUIRE(post("/collections/town/items", samples::sequence(features)).status == 201);
  std::string target = "/collections/town/items?limit=1&f=summary";
  std::size_t seen = 0;
  while (!target.empty() && seen < 20) {
    const server::Response page = get(target);
    REQUIRE(page.status == 200);
    const Json json = Json::parse(page.body);
    REQUIRE(json["features"].size() == 1);
    ++seen;
    std::string item = json["features"][0]["links"][0]["href"];
    CHECK(get(item).status == 200);
    item.resize(item.find('?'));
    CHECK(get(item).status == 200);
    target.clear();
    for (const Json& link : json["links"]) {
      if (link["rel"] == "next") target = link["href"];
    }
    CHECK(send({"DELETE", item, {}, ""}).status == 204);
  }
  CHECK(seen == ids.size());
}

TEST_CASE_METHOD(Fixture, "delete removes an item once") {
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  CHECK(send({"DELETE", "/collections/town/items/a", {}, ""}).status == 204);
  CHECK(send({"DELETE", "/collections/town/items/a", {}, ""}).status == 404);
  CHECK(get("/collections/town/items/b").status == 200);
}

TEST_CASE_METHOD(Fixture, "paths and parameters that mean nothing are refused by name") {
  CHECK(get("/nothing").status == 404);
  CHECK(get("/collections/%2e%2e/items").status == 404);
  CHECK(get("/collections/../items").status == 404);
  CHECK(get("/collections/a%2Fb").status == 404);
  CHECK(get("/collections/town%00").status == 400);
  CHECK(get("/collections//items").status == 400);
  CHECK(get("/collections?f=json&f=json").status == 400);
  CHECK(get("/collections?colour=red").status == 400);
  CHECK(get("/collections/town/items/" + std::string(2000, 'a')).status == 400);
  const server::Response wrong = send({"PUT", "/collections", {}, ""});
  CHECK(wrong.status == 405);
  REQUIRE(header_of(wrong, "Allow"));
  CHECK(*header_of(wrong, "Allow") == "GET, HEAD, OPTIONS");
  problem_of(wrong);
}

TEST_CASE_METHOD(Fixture, "an absent database is 503 everywhere but in healthz") {
  store.is_away = true;
  CHECK(get("/healthz").status == 200);
  for (const char* target : {"/readyz", "/collections", "/collections/town",
                             "/collections/town/items", "/collections/town/items/a"}) {
    const server::Response response = get(target);
    CHECK(response.status == 503);
    problem_of(response);
  }
  CHECK(post("/collections/town/items", kTwo).status == 503);
}

TEST_CASE("Accept chooses by quality and specificity") {
  const std::vector<std::string_view> offers{"application/json", "model/obj"};
  const auto choose = [&](const std::string& accept) { return server::negotiate(&accept, offers); };
  CHECK(server::negotiate(nullptr, offers) == 0);
  CHECK(choose("*/*") == 0);
  CHECK(choose("model/*") == 1);
  CHECK(choose("application/json;q=0.1, model/obj;q=0.5") == 1);
  CHECK(choose("*/*;q=0.1, application/json;q=0") == 1);
  CHECK_FALSE(choose("image/png"));
  CHECK_FALSE(choose("*/*;q=0"));
}

TEST_CASE("targets are decoded strictly") {
  CHECK(server::parse_target("/a%20b/c?x=1+2&y=%C3%A9"));
  CHECK(server::parse_target("/a%20b/c?x=1+2")->segments[0] == "a b");
  CHECK(*server::parse_target("/?x=1+2")->parameter("x") == "1 2");
  CHECK(server::parse_target("http://a:80/b?c=d")->segments == std::vector<std::string>{"b"});
  CHECK(server::parse_target("http://a/")->segments.empty());
  for (const char* wrong : {"", "x", "ftp://a/", "http://a", "/%", "/%1", "/%zz", "/%ff", "/%c0%af",
                            "/a//b", "/%00", "/?x=1&x=2"}) {
    INFO(wrong);
    CHECK_FALSE(server::parse_target(wrong));
  }
}

}  // namespace
}  // namespace watertight::test_routes
