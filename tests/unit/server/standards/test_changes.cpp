// SPDX-License-Identifier: GPL-3.0-or-later
//
// Features made, replaced, changed and deleted, as OGC API - Features, part 4 (draft of OGC API -
// Common, part 5) wants it. The names of abstract tests are those of its annex A.
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "server/routes.h"
#include "tests/unit/server/answers.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_changes {
namespace {

using samples::header_of;
using samples::Json;

class Town : public samples::RoutesFixture {
 public:
  Town() { REQUIRE(post(kItems, samples::kTwo).status == 201); }
  /// The answer of the service to a request as it comes from a connection.
  server::Response ask(const std::string& method, const std::string& target,
                       const std::string& body, std::vector<server::HeaderField> fields = {}) {
    const CancelPoll never = [] { return false; };
    server::Service service{&store, nullptr, {}};
    service.metrics = &metrics;
    const server::Application application = server::make_application(service);
    const server::Request request{method, target, std::move(fields), body};
    if (auto refusal = application.admit(request).refusal) return *std::move(refusal);
    server::Response response = application.respond(request, never);
    while (response.further) response = std::shared_ptr(response.further)->make(never);
    return response;
  }
  std::string height_of(const std::string& item) {
    const Json feature = Json::parse(ask("GET", item + "?f=geojson", "").body);
    return feature["properties"].value("height", Json()).dump();
  }

  static constexpr const char* kItems = "/collections/town/items";
  static constexpr const char* kA = "/collections/town/items/a";
  const std::vector<server::HeaderField> sequence_type{
      {"content-type", "application/city+json-seq"}};
  const std::vector<server::HeaderField> patch_type{
      {"content-type", "application/merge-patch+json"}};
};

std::string with_height(const std::string& id, const std::string& height) {
  std::string feature = samples::feature(id);
  feature.replace(feature.find("2.50"), 4, height);
  return samples::sequence({feature});
}

// /conf/create-replace-delete/options, /conf/update/options
TEST_CASE_METHOD(Town, "a path says by which methods and types of bodies it can be changed") {
  const auto items = ask("OPTIONS", kItems, "");
  CHECK(items.status == 200);
  CHECK(header_of(items, "Allow")->find("POST") != std::string::npos);
  CHECK(header_of(items, "Accept-Post")->find("application/city+json-seq") != std::string::npos);
  const auto item = ask("OPTIONS", kA, "");
  CHECK(item.status == 200);
  for (const char* method : {"PUT", "PATCH", "DELETE"}) {
    CHECK(header_of(item, "Allow")->find(method) != std::string::npos);
  }
  CHECK(*header_of(item, "Accept-Patch") == "application/merge-patch+json");
}

// /conf/create-replace-delete/create; features: /conf/features/endpoints
TEST_CASE_METHOD(Town, "a feature that is made has the address that the answer gives") {
  const auto made = ask("POST", kItems, with_height("new", "7"), sequence_type);
  REQUIRE(made.status == 201);
  const std::string place = *header_of(made, "Location");
  CHECK(place == "/collections/town/items/new");
  CHECK(height_of(place) == "7");
}

// /conf/create-replace-delete/create-content-type, replace-content-type; /conf/update/
// update-content-type
TEST_CASE_METHOD(Town, "a body that states no type is refused") {
  CHECK(ask("POST", kItems, with_height("new", "7")).status == 400);
  CHECK(ask("PUT", kA, with_height("a", "7")).status == 400);
  CHECK(ask("PATCH", kA, R"({"properties":{"height":7}})").status == 400);
  CHECK(ask("GET", "/collections/town/items/new", "").status == 404);
  CHECK(height_of(kA) == "2.5");
  // The parameter f states it as well.
  CHECK(ask("PUT", std::string(kA) + "?f=cityjsonseq", with_height("a", "7")).status == 200);
}

// /conf/create-replace-delete/replace, replace-rid, replace-exceptions; /conf/features/put-create
TEST_CASE_METHOD(Town, "a document takes the place of the feature of its address") {
  CHECK(ask("PUT", kA, with_height("a", "8"), sequence_type).status == 200);
  CHECK(height_of(kA) == "8");
  CHECK(ask("PUT", kA, with_height("other", "9"), sequence_type).status == 400);
  CHECK(height_of(kA) == "8");
  CHECK(ask("GET", "/collections/town/items/other", "").status == 404);
  const std::string absent = "/collections/town/items/absent";
  auto fields = sequence_type;
  fields.push_back({"if-match", "\"xyz\""});
  CHECK(ask("PUT", absent, with_height("absent", "1"), fields).status == 412);
  CHECK(ask("GET", absent, "").status == 404);
  CHECK(ask("PUT", absent, with_height("absent", "1"), sequence_type).status == 201);
  CHECK(ask("GET", absent, "").status == 200);
  for (const char* target : {"/collections", "/collections/town"}) {
    const Json json = Json::parse(ask("GET", std::string(target) + "?f=json", "").body);
    const Json& collection = json.contains("collections") ? json["collections"][0] : json;
    CHECK(collection["supportsNonAutogeneratedResourceIds"] == true);
  }
}

// /conf/create-replace-delete/delete
TEST_CASE_METHOD(Town, "a feature that was deleted is gone") {
  CHECK(ask("DELETE", kA, "").status == 204);
  CHECK(ask("GET", kA, "").status == 404);
}

// /conf/update/update, update-rid
TEST_CASE_METHOD(Town, "a patch changes what it names and nothing else") {
  const std::string before = ask("GET", std::string(kA) + "?f=cityjsonseq", "").body;
  CHECK(ask("PATCH", kA, R"({"properties":{"height":3.5}})", patch_type).status == 200);
  std::string after = ask("GET", std::string(kA) + "?f=cityjsonseq", "").body;
  CHECK(height_of(kA) == "3.5");
  after.replace(after.find("3.5"), 3, "2.50");
  CHECK(after == before);
}

// /conf/optimistic-locking-etags/get-etag, replace, update, delete
TEST_CASE_METHOD(Town, "a change whose tag does not fit is not done") {
  const auto tag = [&](const char* item) { return *header_of(ask("GET", item, ""), "ETag"); };
  const auto with = [](std::vector<server::HeaderField> fields, const std::string& etag) {
    fields.push_back({"if-match", etag});
    return fields;
  };
  const std::string first = tag(kA);
  CHECK(ask("PUT", kA, with_height("a", "8"), with(sequence_type, "\"0\"")).status == 412);
  CHECK(tag(kA) == first);
  const auto replaced = ask("PUT", kA, with_height("a", "8"), with(sequence_type, first));
  CHECK(replaced.status == 200);
  const std::string second = *header_of(replaced, "ETag");
  CHECK(second != first);
  CHECK(second == tag(kA));
  const std::string patch = R"({"properties":{"height":9}})";
  CHECK(ask("PATCH", kA, patch, with(patch_type, first)).status == 412);
  CHECK(height_of(kA) == "8");
  const auto patched = ask("PATCH", kA, patch, with(patch_type, second));
  CHECK(patched.status == 200);
  const std::string third = *header_of(patched, "ETag");
  CHECK(third != second);
  CHECK(ask("PATCH", kA, patch, patch_type).status == 200);
  CHECK(ask("DELETE", kA, "", with({}, third)).status == 412);
  CHECK(ask("DELETE", kA, "", with({}, tag(kA))).status == 204);
  CHECK(ask("GET", kA, "").status == 404);
}

}  // namespace
}  // namespace watertight::test_changes
