// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <set>
#include <string>

#include "codec/blob.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_kept {
namespace {

using samples::Json;
using samples::kOneOpen;
using samples::kTwo;
using Fixture = samples::RoutesFixture;

TEST_CASE_METHOD(Fixture, "invalid=keep stores all, and every reader sees what is proven") {
  const server::Response stored = post("/collections/town/items?invalid=keep", kOneOpen);
  REQUIRE(stored.status == 201);
  const Json outcome = Json::parse(stored.body);
  CHECK(outcome["verdict"] == "invalid");
  CHECK(outcome["stored"] == 2);
  CHECK(outcome["unproven"] == Json{{"features", 1}, {"solids", 1}});

  const Json collection = Json::parse(get("/collections/town").body);
  CHECK(collection["unproven"] == Json{{"features", 1}, {"solids", 1}});
  CHECK(collection["invalid"] == "keep");

  const auto ids_of = [&](const std::string& query) {
    std::set<std::string> ids;
    const Json page = Json::parse(get("/collections/town/items" + query).body);
    for (const Json& item : page["features"]) ids.insert(item["id"].get<std::string>());
    CHECK(page["numberMatched"] == ids.size());
    return ids;
  };
  using Ids = std::set<std::string>;
  CHECK(ids_of("") == Ids{"a", "open"});
  CHECK(ids_of("?proven=true") == Ids{"a"});
  CHECK(ids_of("?proven=false") == Ids{"open"});
  CHECK(get("/collections/town/items?proven=maybe").status == 400);

  const Json proof = Json::parse(get("/collections/town/items/open?f=proof").body);
  CHECK(proof["proven"] == false);
  CHECK(proof["solids"][0]["proven"] == false);
  CHECK(proof["solids"][0]["report"]["all_errors"] == Json{302});
  CHECK(get("/collections/town/items/open?f=blob").status == 406);
  CHECK(get("/collections/town/items/a?f=blob").status == 200);

  const std::string line = kOneOpen.substr(kOneOpen.rfind('\n', kOneOpen.size() - 2) + 1);
  CHECK(get("/collections/town/items/open?f=cityjsonseq").body.ends_with(line));
  const auto exported = [&](const std::string& query) {
    const server::Response response = get("/collections/town/export?f=cityjsonseq" + query);
    std::string text = response.body;
    while (response.rest) {
      const auto part = response.rest([] { return false; });
      REQUIRE(part);
      if (part->empty()) break;
      text += *part;
    }
    return text;
  };
  CHECK(exported("").find("\"open\"") != std::string::npos);
  CHECK(exported("&proven=true").find("\"open\"") == std::string::npos);
  CHECK(exported("&proven=true").find("\"a\"") != std::string::npos);
  CHECK(exported("&proven=false").find("\"open\"") != std::string::npos);
  CHECK(exported("&proven=false").find("\"a\"") == std::string::npos);
}

TEST_CASE_METHOD(Fixture, "a collection's policy counts where a write names none") {
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  CHECK(post("/collections/town/items", kOneOpen).status == 422);
  const auto patch = [&](const std::string& body) {
    return send({"PATCH", "/collections/town", {{"content-type", "application/json"}}, body});
  };
  for (const char* wrong : {"{}", R"({"invalid":"maybe"})", R"({"invalid":1})", R"({"srid":1})"}) {
    CHECK(patch(wrong).status == 400);
  }
  const server::Response changed = patch(R"({"invalid":"keep"})");
  REQUIRE(changed.status == 200);
  CHECK(Json::parse(changed.body)["invalid"] == "keep");
  CHECK(post("/collections/town/items", kOneOpen).status == 201);
  CHECK(post("/collections/town/items?invalid=refuse", kOneOpen).status == 422);
}

TEST_CASE_METHOD(Fixture,
                 "tolerances of a request decide what is stored, and each blob states them") {
  // The top of the box has a corner 5 mm too high.
  const std::string bent = samples::sequence({samples::feature(
      "bent", samples::kBoxFacets,
      "[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,2500],[1000,0,2500],[1000,1000,2500],"
      "[0,1000,2505]]")});
  CHECK(post("/collections/town/items?planarity=0.0001", bent).status == 422);
  CHECK(post("/collections/town/items?planarity=-1", bent).status == 400);
  REQUIRE(post("/collections/town/items?planarity=0.02&planarity-angle=45", bent).status == 201);
  const auto blob = codec::describe(as_bytes(get("/collections/town/items/bent?f=blob").body));
  REQUIRE(blob);
  CHECK(blob->acceptance.tolerances.planarity_metres == 0.02);
  CHECK(blob->acceptance.tolerances.planarity_degrees == 45);
}

}  // namespace
}  // namespace watertight::test_kept
