// SPDX-License-Identifier: GPL-3.0-or-later
// GET /collections/{id}/report: stored features judged again.
#include <catch2/catch_test_macros.hpp>
#include <set>
#include <tuple>

#include "tests/files.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_reports {
namespace {

using samples::header_of;
using samples::Json;

/// A service with the eleven broken buildings and two good ones.
class ReportRoutes : public samples::RoutesFixture {
 public:
  ReportRoutes() {
    REQUIRE(post("/collections/town/items?invalid=keep",
                 test::read_text(test::source_path("examples/invalid.city.jsonl")))
                .status == 201);
  }
  Json report(const std::string& query) const {
    const server::Response response = get("/collections/town/report" + query);
    REQUIRE(response.status == 200);
    return Json::parse(response.body);
  }
};

TEST_CASE_METHOD(ReportRoutes, "the report of a collection is that of its export") {
  Json of_store = report("");
  Json of_export = Json::parse(
      post("/validate", test::whole(get("/collections/town/export?f=cityjsonseq"))).body);
  CHECK(of_store["input_file"] == "town");
  of_store.erase("input_file");
  of_export.erase("input_file");
  CHECK(of_store == of_export);
  CHECK(of_store["features"].size() == 11);
}

TEST_CASE_METHOD(ReportRoutes,
                 "a report has all features, or those that are proven, or the others") {
  REQUIRE(post("/collections/mixed/items?invalid=keep", samples::kOneOpen).status == 201);
  const auto count = [&](const std::string& query) {
    const auto response = get("/collections/mixed/report" + query);
    REQUIRE(response.status == 200);
    return Json::parse(response.body)["features"].size();
  };
  CHECK(count("") == 2);
  CHECK(count("?proven=true") == 1);
  CHECK(count("?proven=false") == 1);
  REQUIRE(post("/collections/good/items", samples::kTwo).status == 201);
  const auto none = get("/collections/good/report?proven=false");
  REQUIRE(none.status == 200);
  CHECK(Json::parse(none.body)["features"].empty());
  CHECK(Json::parse(none.body)["verdict"] == "valid");
}

TEST_CASE_METHOD(ReportRoutes,
                 "stored features are judged under other tolerances without a change") {
  const auto errors = [&](const std::string& query) {
    return report(query)["all_errors"].get<std::set<int>>();
  };
  CHECK(errors("").contains(203));
  CHECK_FALSE(errors("?planarity=10&planarity-angle=90").contains(203));
  CHECK(errors("").contains(203));
  CHECK(get("/collections/town/report?planarity=-1").status == 400);
}

TEST_CASE_METHOD(ReportRoutes, "a report comes in five forms") {
  for (const auto& [form, type, start] :
       {std::tuple{"json", "application/json", "{"},
        std::tuple{"geojson", "application/geo+json", "{"},
        std::tuple{"html", "text/html; charset=utf-8", "<!doctype html>"},
        std::tuple{"csv", "text/csv; charset=utf-8", "file,feature,"},
        std::tuple{"sarif", "application/sarif+json", "{"}}) {
    INFO(form);
    const auto named = get(std::string("/collections/town/report?f=").append(form));
    REQUIRE(named.status == 200);
    CHECK(named.content_type == type);
    CHECK(named.body.starts_with(start));
    const auto accepted = get("/collections/town/report", {{"accept", type}});
    CHECK(accepted.body == named.body);
    const std::string etag = *header_of(named, "ETag");
    CHECK(get(std::string("/collections/town/report?f=").append(form), {{"if-none-match", etag}})
              .status == 304);
  }
  CHECK(get("/collections/town/report?f=pdf").status == 406);
  CHECK(get("/collections/nowhere/report").status == 404);
}

TEST_CASE_METHOD(ReportRoutes, "a changed collection has another report") {
  const std::string etag = *header_of(get("/collections/town/report"), "ETag");
  REQUIRE(post("/collections/town/items", samples::sequence({samples::feature("a")})).status ==
          201);
  CHECK(get("/collections/town/report", {{"if-none-match", etag}}).status == 200);
}

}  // namespace
}  // namespace watertight::test_reports
