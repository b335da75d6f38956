// SPDX-License-Identifier: GPL-3.0-or-later
//
// OGC API Features as map programs use it. The names of abstract tests are those of OGC 17-069r4
// (part 1) and 18-058r1 (part 2).
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_floating_point.hpp>
#include <random>
#include <set>

#include "server/features/cors.h"
#include "server/features/links.h"
#include "server/items/representation_cache.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_features {
namespace {

using Catch::Matchers::WithinAbs;
using samples::header_of;
using samples::Json;
using samples::kTwo;
using samples::problem_of;
using Fixture = samples::RoutesFixture;

constexpr double kFewMetres = 5e-5;  // of degrees

/// Two buildings at the origin of the Dutch grid.
std::string amersfoort() {
  std::string text = kTwo;
  text.replace(text.find("100.0,200.0"), 11, "155000,463000");
  return text;
}

std::string uri(const std::string& name) { return "http://www.opengis.net/def/crs/" + name; }

class City : public Fixture {
 public:
  City() { REQUIRE(post("/collections/town/items", amersfoort()).status == 201); }
  Json page(const std::string& query, const std::vector<server::HeaderField>& headers = {}) const {
    const server::Response response = get("/collections/town/items" + query, headers);
    INFO(response.body);
    REQUIRE(response.status == 200);
    return Json::parse(response.body);
  }
};

TEST_CASE_METHOD(City, "items are GeoJSON in CRS84h, with attributes as properties") {
  const server::Response response =
      get("/collections/town/items", {{"accept", "application/geo+json"}});
  CHECK(response.content_type == "application/geo+json");
  CHECK(*header_of(response, "Content-Crs") == "<" + uri("OGC/0/CRS84h") + ">");
  const Json json = Json::parse(response.body);
  CHECK(json["type"] == "FeatureCollection");
  CHECK(json["numberMatched"] == 2);
  CHECK(json["numberReturned"] == 2);
  const Json& feature = json["features"][0];
  CHECK(feature["type"] == "Feature");
  CHECK(feature["properties"]["height"] == 2.5);
  CHECK(feature["properties"]["wt_type"] == "Building");
  CHECK(feature["properties"]["wt_proven"] == true);
  CHECK(feature["properties"]["wt_solids"] == 1);
  CHECK(feature["geometry"]["type"] == "MultiPolygon");
  CHECK(feature["geometry"]["coordinates"].size() == 6);
  const Json& position = feature["geometry"]["coordinates"][0][0][0];
  REQUIRE(position.size() == 3);
  CHECK_THAT(position[0].get<double>(), WithinAbs(5.387206, kFewMetres));
  CHECK_THAT(position[1].get<double>(), WithinAbs(52.155174, kFewMetres));
  CHECK(position[2] == 0);
  CHECK(feature["bbox"].size() == 6);
  CHECK(feature["bbox"][5] == 2.5);
}

TEST_CASE_METHOD(City, "items come in each CRS of the collection, the stored one exactly") {
  const Json collection = Json::parse(get("/collections/town").body);
  for (const Json& crs : collection["crs"]) {
    INFO(crs);
    const std::string query = "?crs=" + crs.get<std::string>();
    const server::Response response = get("/collections/town/items" + query);
    REQUIRE(response.status == 200);
    CHECK(*header_of(response, "Content-Crs") == "<" + crs.get<std::string>() + ">");
    CHECK(*header_of(get("/collections/town/items/a" + query + "&f=geojson"), "Content-Crs") ==
          "<" + crs.get<std::string>() + ">");
  }
  const Json stored = page("?crs=" + uri("EPSG/0/7415"));
  CHECK(stored["features"][0]["geometry"]["coordinates"][1][0] ==
        Json::parse("[[155000,463000,2.5],[155001,463000,2.5],[155001,463001,2.5],"
                    "[155000,463001,2.5],[155000,463000,2.5]]"));
  CHECK(page("?crs=https://www.opengis.net/def/crs/EPSG/0/7415") !=
        page(""));  // both schemes name the same systems
  const Json mercator = page("?crs=" + uri("EPSG/0/3857"));
  CHECK_THAT(mercator["features"][0]["bbox"][0].get<double>(), WithinAbs(599701, 10));
  for (const char* wrong : {"EPSG/0/25833", "", "OGC/1.3/CRS83"}) {
    CHECK(get("/collections/town/items?crs=" + uri(wrong)).status == 400);
  }
  CHECK(get("/collections/town/items/a?f=obj&crs=" + uri("EPSG/0/7415")).status == 400);
}

TEST_CASE_METHOD(City, "bbox is in CRS84 unless it names another CRS") {
  const auto found = [&](const std::string& query) {
    return page("?bbox=" + query)["numberReturned"].get<int>();
  };
  CHECK(found("5.38,52.15,5.39,52.16") == 2);
  CHECK(found("-180,-90,180,90") == 2);
  CHECK(found("-180,-90,-100,180,90,100") == 2);
  CHECK(found("-180,-90,3,180,90,100") == 0);
  CHECK(found("5.38,52.15,1,5.39,52.16,9") == 2);
  CHECK(found("5.38721,52.15,5.39,52.16") == 2);  // cuts the buildings
  CHECK(found("5.3873,52.15,5.39,52.16") == 0);   // begins beside them
  CHECK(found("4,50,5,51") == 0);
  CHECK(found("170,50,6,53") == 2);  // across the meridian of 180 degrees
  CHECK(found("170,50,-170,53") == 0);
  CHECK(found("5.38,52.15,5.39,52.16&bbox-crs=" + uri("OGC/1.3/CRS84")) == 2);
  CHECK(found("599000,6810000,600500,6850000&bbox-crs=" + uri("EPSG/0/3857")) == 2);
  CHECK(found("155000,463000,155001,463001&bbox-crs=" + uri("EPSG/0/7415")) == 2);
  CHECK(found("155002,463000,155003,463001&bbox-crs=" + uri("EPSG/0/7415")) == 0);
  CHECK(get("/collections/town/items?bbox=6,50,5,53&bbox-crs=" + uri("EPSG/0/7415")).status == 400);
  CHECK(page("?datetime=2026-01-01T00:00:00Z/..")["numberReturned"] == 2);
  CHECK(get("/collections/town/items?datetime=today").status == 400);
}

TEST_CASE_METHOD(Fixture, "coordinates without a CRS are only given under its name") {
  std::string text = kTwo;
  const std::size_t begin = text.find(R"("metadata")");
  text.erase(begin, text.find(R"("CityObjects")") - begin);
  REQUIRE(post("/collections/town/items", text).status == 201);
  const std::string nil = "http://www.opengis.net/def/nil/OGC/0/unknown";
  const Json json = Json::parse(get("/collections/town/items").body);
  CHECK(json["features"][0]["geometry"].is_null());
  CHECK(json["features"][0]["properties"]["wt_no_geometry"] == "the collection states no CRS");
  CHECK(Json::parse(get("/collections/town/items?crs=" + nil).body)["features"][0]["bbox"] ==
        Json::parse("[100,200,0,101,201,2.5]"));
  CHECK(get("/collections/town/items?bbox=0,0,1,1").status == 400);
  CHECK(Json::parse(get("/collections/town/items?bbox=100,200,101,201&bbox-crs=" + nil)
                        .body)["numberReturned"] == 2);
  const Json collection = Json::parse(get("/collections/town").body);
  CHECK(collection["crs"] == Json::array({nil}));
  CHECK_FALSE(collection.contains("extent"));
  CHECK(collection["storageBbox"].size() == 6);
}

TEST_CASE_METHOD(Fixture, "what is not proven is shown as it came") {
  const std::string open = samples::sequence({samples::feature("open", samples::kOpenFacets)});
  REQUIRE(post("/collections/town/items?invalid=keep", open).status == 201);
  const Json json = Json::parse(get("/collections/town/items").body);
  CHECK(json["features"][0]["geometry"]["coordinates"].size() == 5);
  CHECK(json["features"][0]["properties"]["wt_proven"] == false);
  CHECK(json["features"][0]["properties"]["wt_unproven_solids"] == 1);
}

TEST_CASE_METHOD(City, "an item as GeoJSON is what lists have of it, with a tag of its own") {
  const server::Response item =
      get("/collections/town/items/a", {{"accept", "application/geo+json"}});
  CHECK(item.content_type == "application/geo+json");
  const Json listed = page("")["features"];
  CHECK(std::find(listed.begin(), listed.end(), Json::parse(item.body)) != listed.end());
  const std::string etag = *header_of(item, "ETag");
  CHECK(get("/collections/town/items/a?f=geojson", {{"if-none-match", etag}}).status == 304);
  CHECK(*header_of(get("/collections/town/items/a?f=geojson&lod=1"), "ETag") != etag);
  CHECK(*header_of(get("/collections/town/items/a"), "ETag") != etag);
  CHECK(get("/collections/town/items/a").content_type == "application/city+json");
  CHECK(page("?lod=1")["features"][0]["geometry"].is_null());
  CHECK(page("?lod=2.2")["features"][0]["geometry"]["coordinates"].size() == 6);
}

TEST_CASE_METHOD(City, "a summary has the facts without a look into the features") {
  const std::size_t before = store.gets;
  const Json json = page("?f=summary");
  CHECK(store.gets == before);
  CHECK(json["features"][0]["geometry"].is_null());
  CHECK(json["features"][0]["properties"]["proven"] == true);
  CHECK(json["features"][0]["bbox"] == Json::parse("[155000,463000,0,155001,463001,2.5]"));
}

TEST_CASE_METHOD(Fixture, "pages are written where they keep no other request waiting") {
  std::mt19937 random(1);  // a text that packs badly
  std::string noise;
  for (int i = 0; i < 30'000; ++i) noise += std::to_string(random());
  std::string large = samples::feature("large");
  large.replace(large.find("2.50"), 4, '"' + noise + '"');
  REQUIRE(
      post("/collections/town/items", samples::sequence({samples::feature("a"), large})).status ==
      201);
  const CancelPoll never = [] { return false; };
  const server::Service service{&store, nullptr, {}};
  const auto lanes_of = [&](const std::string& target) {
    std::vector<server::Lane> lanes;
    server::Response response = server::respond(service, {"GET", target, {}, ""}, never);
    while (response.further) {
      lanes.push_back(response.further->lane);
      response = std::shared_ptr(response.further)->make(never);
    }
    CHECK(response.status == 200);
    return lanes;
  };
  using enum server::Lane;
  CHECK(lanes_of("/collections/town/items?limit=2") == std::vector{small, computing});
  REQUIRE(store.remove("town", "large"));
  CHECK(lanes_of("/collections/town/items") == std::vector{small});
  CHECK(lanes_of("/collections/town/items?f=summary").empty());
  CHECK(lanes_of("/collections/town/items?bbox=100,0,101,1").empty());

  server::Response stopped =
      server::respond(service, {"GET", "/collections/town/items", {}, ""}, never);
  REQUIRE(stopped.further);
  CHECK(stopped.further->make([] { return true; }).status == 503);
}

TEST_CASE_METHOD(Fixture, "features of a page are decoded once for each version and form") {
  REQUIRE(post("/collections/town/items", amersfoort()).status == 201);
  server::RepresentationCache cache(std::size_t{1} << 20U);
  server::Service service{&store, nullptr, {}};
  service.cache = &cache;
  const CancelPoll never = [] { return false; };
  const auto answer = [&](const std::string& target) {
    server::Response response = server::respond(service, {"GET", target, {}, ""}, never);
    while (response.further) response = std::shared_ptr(response.further)->make(never);
    return response;
  };
  const auto decoded = [&](const std::string& target) {
    const std::size_t before = store.gets;
    REQUIRE(answer(target).status == 200);
    return store.gets - before;
  };
  CHECK(decoded("/collections/town/items") == 2);
  CHECK(decoded("/collections/town/items") == 0);
  CHECK(decoded("/collections/town/items?limit=1") == 0);
  CHECK(decoded("/collections/town/items?f=html") == 0);
  CHECK(decoded("/collections/town/items?f=jsonfg") == 2);
  CHECK(decoded("/collections/town/items?crs=" + uri("EPSG/0/3857")) == 2);
  CHECK(decoded("/collections/town/items?lod=1") == 2);
  CHECK(decoded("/collections/town/items/a?f=geojson&crs=" + uri("OGC/1.3/CRS84")) == 1);
  // The kept answer is of another CRS.
  const server::Response item = answer("/collections/town/items/a?f=geojson");
  CHECK(*header_of(item, "Content-Crs") == "<" + uri("OGC/0/CRS84h") + ">");
  REQUIRE(post("/collections/town/items", amersfoort()).status == 201);
  CHECK(decoded("/collections/town/items") == 2);
}

TEST_CASE_METHOD(Fixture, "bbox finds features by all of their geometry, with solids or without") {
  const std::string terrain =
      R"({"type":"CityJSONFeature","id":"t","CityObjects":{"t":{"type":"TINRelief","geometry":[)"
      R"({"type":"CompositeSurface","lod":"1","boundaries":[[[0,1,2]]]}]}},)"
      R"("vertices":[[9000,9000,1000],[10000,9000,1000],[9000,10000,1500]]})";
  std::string both = samples::feature("b");
  both.replace(both.find(R"("geometry":[)"), 12,
               R"("geometry":[{"type":"MultiSurface","lod":"1","boundaries":[[[8,9,10]]]},)");
  both.replace(both.find("[0,1000,2500]]"), 14,
               "[0,1000,2500],[50000,0,0],[51000,0,0],[50000,1000,0]]");
  REQUIRE(post("/collections/town/items", samples::sequence({terrain, both})).status == 201);
  const auto found = [&](const std::string& box) {
    const Json json = Json::parse(
        get("/collections/town/items?f=summary&bbox=" + box + "&bbox-crs=" + uri("EPSG/0/7415"))
            .body);
    std::string ids;
    for (const Json& feature : json["features"]) ids += feature["id"].get<std::string>();
    return ids;
  };
  CHECK(found("109,209,110,210") == "t");
  CHECK(found("100,200,100.5,200.5") == "b");
  CHECK(found("150.5,200,152,200.5") == "b");
  CHECK(found("152,200,153,201").empty());
  CHECK(found("109,209,1.2,110,210,1.3") == "t");
  CHECK(found("109,209,3,110,210,4").empty());
}

TEST_CASE_METHOD(City, "links are absolute, by the request or by what a proxy says of it") {
  const auto start = [&](std::vector<server::HeaderField> headers) {
    const Json landing = Json::parse(get("/", std::move(headers)).body);
    std::string href = landing["links"][0]["href"];
    return href.substr(0, href.size() - 1);
  };
  CHECK(start({{"host", "example.org:8080"}}) == "http://example.org:8080");
  CHECK(start({{"host", "[::1]:80"}}) == "http://[::1]:80");
  CHECK(start({{"host", "inner"}, {"x-forwarded-proto", "https"}, {"x-forwarded-host", "a.org"}}) ==
        "https://a.org");
  CHECK(start({{"host", "inner"}, {"x-forwarded-prefix", "/solids/"}}) == "http://inner/solids");
  CHECK(start({{"host", "inner"},
               {"forwarded", "for=1.2.3.4; Proto=https; host=\"b.org:99\", for=5.6.7.8"}}) ==
        "https://b.org:99");
  CHECK(start({}).empty());
  for (const char* hostile : {"a\"b", "a/b", "a b", "a<script>", ""}) {
    CHECK(start({{"host", hostile}}).empty());
    CHECK(start({{"host", "h"}, {"x-forwarded-host", hostile}}) == "http://h");
    CHECK(start({{"host", "h"}, {"x-forwarded-proto", hostile}}) == "http://h");
  }
  CHECK(start({{"host", "h"}, {"x-forwarded-prefix", "//evil.org\""}}) == "http://h");
  const Json page = this->page("?limit=1", {{"host", "example.org"}});
  std::set<std::string> relations;
  for (const Json& link : page["links"]) {
    if (link["rel"] == "profile") continue;  // an address of the OGC
    relations.insert(link["rel"]);
    CHECK(link["href"].get<std::string>().starts_with("http://example.org/collections/town"));
    CHECK(get(link["href"]).status == 200);
  }
  CHECK(relations == std::set<std::string>{"self", "next", "collection"});
}

TEST_CASE("the address of the service can be stated") {
  Fixture fixture;
  server::Service service{&fixture.store, nullptr, {}};
  service.options.base_url = "https://example.org/solids";
  const server::Response landing =
      server::respond(service, {"GET", "/", {{"host", "inner"}, {"x-forwarded-host", "b.org"}}, ""},
                      [] { return false; });
  CHECK(Json::parse(landing.body)["links"][0]["href"] == "https://example.org/solids/");
  CHECK(server::check_base_url("https://example.org/solids"));
  CHECK(server::check_base_url("http://[::1]:80"));
  for (const char* wrong :
       {"", "example.org", "ftp://a", "http://", "http://a?b", "http://a/\"b"}) {
    INFO(wrong);
    CHECK_FALSE(server::check_base_url(wrong));
  }
}

TEST_CASE("pages of an origin that is named may read, and no others") {
  Fixture fixture;
  REQUIRE(fixture.post("/collections/town/items", kTwo).status == 201);
  const auto send = [&](const std::string& cors, const std::string& method,
                        const std::string& target, const std::string& origin) {
    server::Service service{&fixture.store, nullptr, {}};
    service.options.cors_origin = cors;
    const CancelPoll never = [] { return false; };
    std::vector<server::HeaderField> fields;
    if (!origin.empty()) fields.push_back({"origin", origin});
    server::Response response = server::respond(service, {method, target, fields, ""}, never);
    while (response.further) response = std::shared_ptr(response.further)->make(never);
    return response;
  };
  const std::string maps = "https://maps.example.org";
  for (const char* target :
       {"/", "/collections/town/items", "/collections/town/items/a", "/none"}) {
    INFO(target);
    const server::Response any = send("*", "GET", target, maps);
    REQUIRE(header_of(any, "Access-Control-Allow-Origin"));
    CHECK(*header_of(any, "Access-Control-Allow-Origin") == "*");
    CHECK(*header_of(send(maps, "GET", target, "http://evil.org"), "Access-Control-Allow-Origin") ==
          maps);
    CHECK_FALSE(header_of(send("", "GET", target, maps), "Access-Control-Allow-Origin"));
    CHECK_FALSE(header_of(send("*", "GET", target, ""), "Access-Control-Allow-Origin"));
  }
  CHECK(header_of(send("*", "OPTIONS", "/collections", maps), "Access-Control-Allow-Methods"));
  CHECK_FALSE(header_of(send("*", "DELETE", "/collections/town/items/a", maps),
                        "Access-Control-Allow-Origin"));
  CHECK(server::check_origin("*"));
  CHECK(server::check_origin("http://localhost:3000"));
  for (const char* wrong : {"", "**", "maps.example.org", "https://a/", "https://a/b", "null"}) {
    INFO(wrong);
    CHECK_FALSE(server::check_origin(wrong));
  }
}

TEST_CASE_METHOD(City,
                 "JSON-FG has the solids as polyhedra, which are valid when they are read again") {
  const server::Response item = get("/collections/town/items/a?f=jsonfg");
  CHECK(item.content_type == "application/vnd.ogc.fg+json");
  CHECK(*header_of(item, "Content-Crs") == "<" + uri("EPSG/0/7415") + ">");
  const Json feature = Json::parse(item.body);
  CHECK(feature["coordRefSys"] == uri("EPSG/0/7415"));
  CHECK(feature["conformsTo"].size() == 2);
  CHECK(feature["featureType"] == "Building");
  CHECK(feature["time"].is_null());
  CHECK(feature["geometry"].is_null());
  CHECK(feature["place"]["type"] == "Polyhedron");
  CHECK(feature["properties"]["height"] == 2.5);
  const Json report = Json::parse(post("/validate", item.body, "application/vnd.ogc.fg+json").body);
  CHECK(report["verdict"] == "valid");
  CHECK(report["features"].size() == 1);
  CHECK(get("/collections/town/items", {{"accept", "application/vnd.ogc.fg+json"}}).content_type ==
        "application/vnd.ogc.fg+json");
  const server::Response list = get("/collections/town/items?f=jsonfg");
  const Json all = Json::parse(post("/validate", list.body, "application/vnd.ogc.fg+json").body);
  CHECK(all["features"].size() == 2);
  CHECK(all["verdict"] == "valid");
  const Json degrees = page("?f=jsonfg&crs=" + uri("OGC/0/CRS84h"));
  CHECK(degrees["coordRefSys"] == uri("OGC/0/CRS84h"));
  CHECK_THAT(degrees["features"][0]["place"]["coordinates"][0][0][0][0][0].get<double>(),
             WithinAbs(5.387206, kFewMetres));
}

/// Checks that a page has one script and one style, which the service has under their addresses.
void check_files_of_page(const Fixture& fixture, const std::string& page, const std::string& body) {
  std::size_t count = 0;
  for (const std::string_view mark : {"src=\"", "rel=\"stylesheet\" href=\""}) {
    for (std::size_t at = body.find(mark); at != std::string::npos; at = body.find(mark, at + 1)) {
      const std::size_t begin = at + mark.size();
      std::string file = body.substr(begin, body.find('"', begin) - begin);
      std::string folder = page.substr(0, page.substr(0, page.find('?')).rfind('/') + 1);
      while (file.starts_with("../")) {
        file.erase(0, 3);
        folder.erase(folder.rfind('/', folder.size() - 2) + 1);
      }
      INFO(folder + file);
      CHECK(fixture.get(folder + file).status == 200);
      ++count;
    }
  }
  CHECK(count == 2);
}

// Abstract tests of part 1, HTML: /conf/html/content, definition.
TEST_CASE_METHOD(Fixture, "browsers get pages whose links lead on, with every text escaped") {
  std::string text = kTwo;
  const std::string hostile = "<script>alert(1)</script>&\\\"";
  text.replace(text.find("\"height\":2.50"), 13, "\"<b>\":\"" + hostile + "\"");
  REQUIRE(post("/collections/town/items", text).status == 201);
  const std::string accept = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8";
  std::set<std::string> seen;
  std::vector<std::string> next{"/"};
  while (!next.empty()) {
    const std::string target = next.back();
    next.pop_back();
    if (!seen.insert(target).second) continue;
    INFO(target);
    const server::Response response = get(target, {{"accept", accept}});
    REQUIRE(response.status == 200);
    if (response.content_type != "text/html; charset=utf-8") continue;
    CHECK(response.body.starts_with("<!doctype html>"));
    CHECK(response.body.find("<script>") == std::string::npos);
    check_files_of_page(*this, target, response.body);
    CHECK(response.body.find("<b>") == std::string::npos);
    CHECK(response.body.find("default-src 'none'") != std::string::npos);
    const std::string mark = "<a href=\"";
    for (std::size_t at = response.body.find(mark); at != std::string::npos;
         at = response.body.find(mark, at + 1)) {
      const std::size_t begin = at + mark.size();
      std::string href = response.body.substr(begin, response.body.find('"', begin) - begin);
      for (std::size_t amp = href.find("&amp;"); amp != std::string::npos;
           amp = href.find("&amp;")) {
        href.erase(amp + 1, 4);
      }
      if (href.starts_with("..")) continue;  // leads back
      if (href.ends_with("f=cityjsonseq")) continue;
      if (href.find("/report?") != std::string::npos) continue;  // a page of report/
      next.push_back(href.starts_with("?") ? target.substr(0, target.find('?')) + href : href);
    }
  }
  for (const char* needed : {"/collections", "/collections/town", "/collections/town/items",
                             "/collections/town/items/a", "/collections/town/items/b?f=obj"}) {
    INFO(needed);
    CHECK(seen.contains(needed));
  }
  CHECK(get("/collections/town/items?f=html&limit=1").body.find("Next page") != std::string::npos);
  CHECK(get("/collections?f=html&after=zz").body.find("no collection yet") != std::string::npos);
}

// Abstract tests of part 1, Core: /conf/core/root-op, conformance-op, fc-md-op, sfc-md-op.
TEST_CASE_METHOD(City,
                 "landing page, conformance and collections have what OGC API Features asks") {
  const Json landing = Json::parse(get("/").body);
  std::set<std::string> relations;
  for (const Json& link : landing["links"]) relations.insert(link["rel"]);
  for (const char* needed : {"self", "service-desc", "conformance", "data"}) {
    INFO(needed);
    CHECK(relations.contains(needed));
  }
  const Json classes = Json::parse(get("/conformance").body)["conformsTo"];
  for (const char* name : {"ogcapi-features-1/1.0/conf/core", "ogcapi-features-1/1.0/conf/geojson",
                           "ogcapi-features-1/1.0/conf/oas30", "ogcapi-features-2/1.0/conf/crs"}) {
    const std::string wanted = std::string("http://www.opengis.net/spec/") + name;
    CHECK(std::count(classes.begin(), classes.end(), wanted) == 1);
  }
  const Json collections = Json::parse(get("/collections").body);
  REQUIRE(collections["collections"].size() == 1);
  const Json collection = collections["collections"][0];
  CHECK(collection == Json::parse(get("/collections/town").body));
  CHECK(collection["crs"][0] == uri("OGC/0/CRS84h"));
  CHECK(std::count(collection["crs"].begin(), collection["crs"].end(), collection["storageCrs"]) ==
        1);
  const Json extent = collection["extent"]["spatial"];
  CHECK(extent["crs"] == uri("OGC/0/CRS84h"));
  CHECK_THAT(extent["bbox"][0][0].get<double>(), WithinAbs(5.387206, kFewMetres));
  CHECK(std::any_of(collection["links"].begin(), collection["links"].end(), [](const Json& link) {
    return link["rel"] == "items" && link["type"] == "application/geo+json";
  }));
  // /conf/core/query-param-unknown, query-param-invalid
  CHECK(problem_of(get("/collections/town/items?limit=no"))["status"] == 400);
  CHECK(problem_of(get("/conformance?no=1"))["status"] == 400);
  CHECK(get("/collections/none/items").status == 404);
  CHECK(get("/conformance", {{"accept", "image/png"}}).status == 406);
}

}  // namespace
}  // namespace watertight::test_features
