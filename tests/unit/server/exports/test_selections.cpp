// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests of files and reports of some features of a collection, and of GeoPackages.
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "server/export_files.h"
#include "tests/unit/server/answers.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_selections {
namespace {

using samples::header_of;
using samples::Json;
using samples::problem_of;

/// A town with the proven buildings a and b, and the open one far in the east.
class Town : public samples::RoutesFixture {
 public:
  Town() {
    const std::string far =
        "[[9000,0,0],[9500,0,0],[9500,500,0],[9000,500,0],[9000,0,2500],"
        "[9500,0,2500],[9500,500,2500],[9000,500,2500]]";
    const std::string text =
        samples::sequence({samples::feature("a"), samples::feature("b"),
                           samples::feature("open", samples::kOpenFacets, far)});
    REQUIRE(post("/collections/town/items?invalid=keep", text).status == 201);
  }
  server::Response file(const std::string& query, std::vector<server::HeaderField> fields = {}) {
    return get("/collections/town/export?f=gpkg" + query, std::move(fields));
  }
  /// The ids in an export as a sequence.
  std::string exported(const std::string& query) {
    const auto response = get("/collections/town/export?f=cityjsonseq" + query);
    if (response.status != 200) return std::to_string(response.status);
    std::string ids;
    std::string text = test::whole(response);
    for (const char* id : {"a", "b", "open"}) {
      if (text.find(std::string("\"id\":\"") + id + "\"") != std::string::npos) ids += id;
    }
    return ids;
  }
};

constexpr const char* kEast =
    "&bbox-crs=http://www.opengis.net/def/crs/EPSG/0/7415&bbox=108,0,200,900";

TEST_CASE_METHOD(Town, "an export has the features that a filter and a box select") {
  REQUIRE(
      send({"PUT", "/collections/town/attributes", {}, R"({"attributes":["height"]})"}).status ==
      200);
  CHECK(exported("") == "abopen");
  CHECK(exported(kEast) == "open");
  CHECK(exported("&filter=height%20%3D%202.5") == "abopen");
  CHECK(exported("&filter=height%20%3E%203") == "404");
  CHECK(exported(std::string("&filter=height%20%3D%202.5&proven=true") + kEast) == "404");
  CHECK(exported("&proven=false") == "open");
  CHECK(exported("&filter=height%20%3D") == "400");
  CHECK(exported("&bbox=1,2") == "400");
  // Tags tell selections apart.
  const auto tag = [&](const std::string& query) {
    return *header_of(get("/collections/town/export?f=wt" + query), "ETag");
  };
  CHECK(tag("") != tag(kEast));
  CHECK(tag(kEast) != tag("&filter=height%20%3D%202.5"));
}

TEST_CASE_METHOD(Town, "a report is about the features that a box selects") {
  const auto features = [&](const std::string& query) {
    const auto response = get("/collections/town/report?f=json" + query);
    REQUIRE(response.status == 200);
    return Json::parse(response.body)["features_overview"][0]["total"].get<int>();
  };
  CHECK(features("") == 3);
  CHECK(features(kEast) == 1);
}

TEST_CASE_METHOD(Town, "a collection is a GeoPackage, of which ranges can be had") {
  const auto whole = file("");
  REQUIRE(whole.status == 200);
  CHECK(whole.content_type == "application/geopackage+sqlite3");
  CHECK(*header_of(whole, "Content-Disposition") == "attachment; filename=\"town.gpkg\"");
  const std::string bytes = test::whole(whole);
  CHECK(bytes.starts_with("SQLite format 3"));
  CHECK(bytes.find("town_findings") != std::string::npos);
  const std::string etag = *header_of(whole, "ETag");
  CHECK(file("", {{"if-none-match", etag}}).status == 304);
  const auto part = file("", {{"range", "bytes=7-12"}});
  CHECK(part.status == 206);
  CHECK(test::whole(part) == bytes.substr(7, 6));
  CHECK(test::whole(file("&proven=true")).find("town_findings") == std::string::npos);
  CHECK(*header_of(file("&lod=1.2"), "ETag") != etag);
  CHECK(file("&part=1").status == 400);
  CHECK(get("/collections/town/export?f=wt&lod=1.2").status == 400);
}

TEST_CASE_METHOD(Town, "a GeoPackage of more bytes than the service keeps is refused") {
  const CancelPoll never = [] { return false; };
  server::ExportFiles little(8, 1000);
  server::Service service{&store, nullptr, {}};
  service.metrics = &metrics;
  service.export_files = &little;
  const server::Request request{"GET", "/collections/town/export?f=gpkg", {}, ""};
  server::Response response = server::respond(service, request, never);
  while (response.further) response = std::shared_ptr(response.further)->make(never);
  CHECK(response.status == 413);
  CHECK(problem_of(response)["detail"].get<std::string>().find("watertight export") !=
        std::string::npos);
}

}  // namespace
}  // namespace watertight::test_selections
