// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests CityJSONSeq exports of collections whose documents have different headers.
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "server/export_files.h"
#include "tests/unit/server/answers.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_sequences {
namespace {

using samples::header_of;
using samples::Json;
using samples::kTwo;
using Fixture = samples::RoutesFixture;

std::string variant(const std::string& id, const std::string& from, const std::string& to) {
  std::string text = samples::sequence({samples::feature(id)});
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST_CASE_METHOD(Fixture, "headers are merged, and what they differ in is named") {
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  CHECK(header_of(get("/collections/town/export?f=cityjsonseq"), "Watertight-Losses") == nullptr);
  std::string other = variant("far", "100.0,200.0", "300.5,200.0");
  other.replace(other.find(R"("metadata":{)"), 12, R"("metadata":{"title":"a, b",)");
  REQUIRE(post("/collections/town/items", other).status == 201);
  const server::Response merged = get("/collections/town/export?f=cityjsonseq");
  REQUIRE(merged.status == 200);
  REQUIRE(header_of(merged, "Watertight-Losses") != nullptr);
  CHECK(*header_of(merged, "Watertight-Losses") == "metadata%2Ftitle");
  const std::string text = test::whole(merged);
  CHECK(text.find("[200500,0,0]") != std::string::npos);  // 300.5 - 100.0
  REQUIRE(post("/collections/copy/items", text).status == 201);
  CHECK(test::whole(get("/collections/copy/export?f=cityjsonseq")) == text);
  CHECK(test::whole(get("/collections/town/export?f=cityjsonseq&part=1")) == text);
  CHECK(get("/collections/town/export?f=cityjsonseq&part=2").status == 400);
}

TEST_CASE_METHOD(Fixture, "a collection that needs several sequences links to each") {
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  const std::string fine = variant("fine", "100.0", "0.12345678901");
  REQUIRE(post("/collections/town/items", fine).status == 201);
  const server::Response refused = get("/collections/town/export?f=cityjsonseq");
  REQUIRE(refused.status == 406);
  const Json problem = Json::parse(refused.body);
  CHECK(problem["detail"].get<std::string>().find("different headers") != std::string::npos);
  REQUIRE(problem["parts"].size() == 2);
  CHECK(problem["parts"][1]["reason"].get<std::string>().find("common grid") != std::string::npos);
  std::string all;
  for (const Json& part : problem["parts"]) {
    const server::Response answer = get(part["href"].get<std::string>());
    REQUIRE(answer.status == 200);
    all += test::whole(answer);
  }
  CHECK(all == kTwo + fine);
  const server::Response second = get("/collections/town/export?f=cityjsonseq&part=2");
  CHECK(*header_of(second, "Content-Disposition") == "attachment; filename=\"town-2.city.jsonl\"");
  CHECK(*header_of(second, "ETag") !=
        *header_of(get("/collections/town/export?f=cityjsonseq&part=1"), "ETag"));
  for (const char* wrong : {"part=0", "part=3", "part=x", "part=", "part=-1"}) {
    INFO(wrong);
    CHECK(get(std::string("/collections/town/export?f=cityjsonseq&") + wrong).status == 400);
  }
  CHECK(get("/collections/town/export?f=wt&part=1").status == 400);
  CHECK(test::whole(get("/collections/town/export?f=cityjsonseq&part=2&proven=true")) == fine);
}

TEST_CASE_METHOD(Fixture, "a range of a sequence of several is refused like the whole") {
  server::ExportFiles kept;
  server::Service service{&store, nullptr, {}};
  service.export_files = &kept;
  REQUIRE(post("/collections/town/items", kTwo).status == 201);
  const std::string fine = variant("fine", "100.0", "0.12345678901");
  REQUIRE(post("/collections/town/items", fine).status == 201);
  const auto ranged = [&](const std::string& query) {
    const CancelPoll never = [] { return false; };
    server::Response response = server::respond(
        service,
        {"GET", "/collections/town/export?f=cityjsonseq" + query, {{"range", "bytes=0-9"}}, ""},
        never);
    while (response.further) response = std::shared_ptr(response.further)->make(never);
    return response;
  };
  CHECK(ranged("").status == 406);
  const server::Response part = ranged("&part=2");
  CHECK(part.status == 206);
  CHECK(test::whole(part) == fine.substr(0, 10));
}

}  // namespace
}  // namespace watertight::test_sequences
