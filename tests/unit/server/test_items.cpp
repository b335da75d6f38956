// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers for one feature: tags, preconditions, ranges and the cache; and collections as a whole.
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "server/export_files.h"
#include "server/handlers.h"
#include "server/items/representation_cache.h"
#include "tests/unit/pipeline/samples.h"
#include "tests/unit/server/answers.h"

namespace watertight::test_items {
namespace {

using Json = nlohmann::json;

const std::string kA = samples::sequence({samples::feature("a")});

/// A service with a cache and the feature "a".
class Items {
 public:
  Items() { REQUIRE(send({"POST", "/collections/town/items", {}, kA}).status == 201); }

  server::Response send(const server::Request& request, bool requires_preconditions = false) const {
    server::Service service{&store, nullptr, {}, {}, &cache, &files};
    service.options.requires_preconditions = requires_preconditions;
    const CancelPoll never = [] { return false; };
    server::Response response = server::respond(service, request, never);
    while (response.further) response = std::shared_ptr(response.further)->make(never);
    return response;
  }
  server::Response item(std::vector<server::HeaderField> fields = {},
                        const std::string& query = "?f=blob") const {
    return send({"GET", "/collections/town/items/a" + query, std::move(fields), ""});
  }
  static std::string field(const server::Response& response, std::string_view name) {
    for (const server::HeaderField& field : response.headers) {
      if (field.name == name) return field.value;
    }
    return "";
  }

  mutable samples::MemoryStore store;
  mutable server::RepresentationCache cache{1 << 20};
  mutable server::ExportFiles files;
};

TEST_CASE_METHOD(Items, "an item is read once for all requests for one representation") {
  const server::Response first = item();
  REQUIRE(first.status == 200);
  const std::size_t read = store.gets;
  CHECK(item().body == first.body);
  CHECK(store.gets == read);
  CHECK(item({}, "?f=cityjson").body != first.body);
  CHECK(store.gets == read + 1);
}

TEST_CASE_METHOD(Items, "a changed item is never answered from the cache") {
  const std::string before = field(item(), "ETag");
  REQUIRE(send({"POST", "/collections/town/items", {}, kA}).status == 201);
  CHECK(field(item(), "ETag") != before);
  REQUIRE(send({"DELETE", "/collections/town/items/a", {}, ""}).status == 204);
  CHECK(item().status == 404);
}

TEST_CASE("a cache keeps what was used last, and nothing larger than an eighth of it") {
  server::RepresentationCache cache(100'000);
  const auto answer = [](std::size_t bytes) {
    return std::make_shared<const server::Response>(
        server::Response{200, "text/plain", std::string(bytes, 'a'), {}});
  };
  for (const char* key : {"a", "b", "c", "d", "e", "f", "g", "h"}) cache.keep(key, answer(12'000));
  CHECK(cache.find("a"));
  cache.keep("i", answer(12'000));
  CHECK(cache.find("a"));
  CHECK_FALSE(cache.find("b"));
  cache.keep("large", answer(13'000));
  CHECK_FALSE(cache.find("large"));
  const auto newer = answer(11'000);
  cache.keep("i", newer);
  CHECK(cache.find("i") == newer);
  CHECK(cache.find("h"));
}

TEST_CASE_METHOD(Items, "an item that nobody has asked for is read at once, without its version") {
  const std::size_t versions = store.version_reads;
  CHECK(item().status == 200);
  CHECK(store.version_reads == versions);
  CHECK(item().status == 200);
  CHECK(store.version_reads == versions + 1);
  CHECK(item({{"if-none-match", field(item(), "ETag")}}).status == 304);
}

TEST_CASE_METHOD(Items, "preconditions of a read are kept") {
  const std::string etag = field(item(), "ETag");
  CHECK(item({{"if-match", etag}}).status == 200);
  CHECK(item({{"if-match", "*"}}).status == 200);
  CHECK(item({{"if-match", "\"0-blob\""}}).status == 412);
  CHECK(item({{"if-match", "W/" + etag}}).status == 412);  // weak tags never match strongly
  CHECK(item({{"if-none-match", "\"0-blob\", W/" + etag}}).status == 304);
  CHECK(item({{"if-none-match", "*"}}).status == 304);
}

TEST_CASE_METHOD(Items, "a write is done only if its precondition holds") {
  const auto remove = [&](std::vector<server::HeaderField> fields) {
    return send({"DELETE", "/collections/town/items/a", std::move(fields), ""}).status;
  };
  const std::string stale = field(item(), "ETag");
  REQUIRE(send({"POST", "/collections/town/items", {}, kA}).status == 201);
  CHECK(remove({{"if-match", stale}}) == 412);
  CHECK(remove({{"if-none-match", "*"}}) == 412);
  CHECK(remove({{"if-none-match", stale}}) == 400);
  CHECK(item().status == 200);
  CHECK(remove({{"if-match", "\"7-obj\", " + field(item(), "ETag")}}) == 204);
  CHECK(item().status == 404);
}

TEST_CASE_METHOD(Items,
                 "a document is stored only if its features have the versions that were seen") {
  const auto store_a = [&](std::vector<server::HeaderField> fields) {
    return send({"POST", "/collections/town/items", std::move(fields), kA}).status;
  };
  const std::string other = samples::sequence({samples::feature("other")});
  REQUIRE(send({"POST", "/collections/town/items", {}, other}).status == 201);
  const std::string first = field(item(), "ETag");
  CHECK(store_a({{"if-none-match", "*"}}) == 412);
  CHECK(store_a({{"if-match", first}}) == 201);
  CHECK(store_a({{"if-match", first}}) == 412);
  REQUIRE(send({"DELETE", "/collections/town/items/a", {}, ""}).status == 204);
  CHECK(store_a({{"if-match", "*"}}) == 412);
  CHECK(store_a({{"if-none-match", "*"}}) == 201);
}

TEST_CASE_METHOD(Items, "a service that wants preconditions refuses writes without") {
  const server::Request blind{"DELETE", "/collections/town/items/a", {}, ""};
  CHECK(send(blind, true).status == 428);
  CHECK(item().status == 200);
  server::Request careful = blind;
  careful.headers.push_back({"if-match", "*"});
  CHECK(send(careful, true).status == 204);
}

TEST_CASE_METHOD(Items, "a range of an item is its bytes, from the store and from the cache") {
  const server::Response whole = item();
  CHECK(field(whole, "Accept-Ranges") == "bytes");
  const std::string size = std::to_string(whole.body.size());
  const auto part = [&](const std::string& range) { return item({{"range", range}}); };
  const server::Response middle = part("bytes=2-5");
  CHECK(middle.status == 206);
  CHECK(middle.body == whole.body.substr(2, 4));
  CHECK(field(middle, "Content-Range") == "bytes 2-5/" + size);
  CHECK(part("bytes=3-").body == whole.body.substr(3));
  CHECK(part("bytes=-3").body == whole.body.substr(whole.body.size() - 3));
  CHECK(part("bytes=0-999999999999999999999999").body == whole.body);
  CHECK(part("bytes=-999999999999999999999999").status == 206);
  const server::Response beyond = part("bytes=" + size + "-");
  CHECK(beyond.status == 416);
  CHECK(field(beyond, "Content-Range") == "bytes */" + size);
  for (const char* odd : {"bytes=5-2", "bytes=0-1,3-4", "lines=1-2", "bytes=", "bytes=a-b", "5"}) {
    INFO(odd);
    CHECK(part(odd).status == 200);
  }
  CHECK(item({{"range", "bytes=1-2"}, {"if-range", field(whole, "ETag")}}).status == 206);
  CHECK(item({{"range", "bytes=1-2"}, {"if-range", "\"0-blob\""}}).status == 200);
}

TEST_CASE_METHOD(Items,
                 "a download of a collection can be resumed while the collection is the same") {
  const auto get = [&](std::vector<server::HeaderField> fields) {
    return send({"GET", "/collections/town/export?f=wt", std::move(fields), ""});
  };
  const server::Response first = get({});
  const std::string all = test::whole(first);
  const std::string etag = field(first, "ETag");
  CHECK(field(first, "Accept-Ranges") == "bytes");
  const server::Response rest = get({{"range", "bytes=7-"}, {"if-range", etag}});
  CHECK(rest.status == 206);
  CHECK(field(rest, "ETag") == etag);
  const std::string size = std::to_string(all.size());
  CHECK(field(rest, "Content-Range") == "bytes 7-" + std::to_string(all.size() - 1) + "/" + size);
  CHECK(test::whole(rest) == all.substr(7));
  CHECK(test::whole(get({{"range", "bytes=2-4"}})) == all.substr(2, 3));
  CHECK(test::whole(get({{"range", "bytes=-4"}})) == all.substr(all.size() - 4));
  CHECK(get({{"range", "bytes=" + size + "-"}}).status == 416);
  CHECK(get({{"if-none-match", etag}}).status == 304);

  REQUIRE(send({"POST", "/collections/town/items", {}, kA}).status == 201);
  CHECK(get({{"range", "bytes=7-"}, {"if-range", etag}}).status == 200);
  CHECK(get({{"if-none-match", etag}}).status == 200);
  CHECK(get({{"if-match", etag}}).status == 412);
}

/// Six times the volume of a tetrahedron.
double sixfold_volume(const Json& vertices, const Json& tetrahedron) {
  std::array<std::array<double, 3>, 3> sides{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sides[i][axis] = vertices[tetrahedron[i + 1].get<std::size_t>()][axis].get<double>() -
                       vertices[tetrahedron[0].get<std::size_t>()][axis].get<double>();
    }
  }
  const auto& [a, b, c] = sides;
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

TEST_CASE_METHOD(Items, "the inside of an item has the tetrahedra that fill its solids") {
  const Json structure = Json::parse(item({}, "?f=structure").body);
  const Json proof = Json::parse(item({}, "?f=proof").body);
  CHECK(structure["id"] == "a");
  REQUIRE(structure["solids"].size() == 1);
  const Json& solid = structure["solids"][0];
  CHECK(solid["rung"] == "delaunay");
  CHECK(solid["vertices"].size() == 8);
  CHECK(solid["steinerVertices"] == 0);
  CHECK(solid["unrecoveredFaces"].empty());
  double sixfold = 0;
  for (const Json& tetrahedron : solid["tetrahedra"]) {
    const double volume = sixfold_volume(solid["vertices"], tetrahedron);
    CHECK(std::abs(volume) > 0);
    sixfold += std::abs(volume);
  }
  CHECK(sixfold / 6 == proof["solids"][0]["measures"]["volume"].get<double>());
  double bytes = 0;
  for (const Json& part : solid["parts"]) bytes += part["bytes"].get<double>();
  CHECK(std::abs(bytes - structure["bytes"]["solids"].get<double>()) < 0.1);
  CHECK(structure["bytes"]["text"].get<double>() > 0);
  // What is not proven has no inside.
  REQUIRE(send({"POST",
                "/collections/town/items?invalid=keep",
                {},
                samples::sequence({samples::feature("open", samples::kOpenFacets)})})
              .status == 201);
  const auto open = send({"GET", "/collections/town/items/open?f=structure", {}, ""});
  CHECK(Json::parse(open.body)["solids"].empty());
}

TEST_CASE("exports are kept as files for a while, so many and so large") {
  using server::ExportFiles;
  const auto file = [](std::size_t bytes) {
    auto made = TemporaryFile::make();
    REQUIRE(made);
    REQUIRE(made->append(Bytes(bytes, 1)));
    return *std::move(made);
  };
  ExportFiles few(2, 1000);
  for (const char* key : {"a", "b", "c"}) few.keep(key, file(10));
  CHECK_FALSE(few.find("a"));
  CHECK(few.find("b"));
  CHECK(few.make_room(980));
  CHECK(few.find("c"));
  {
    const ExportFiles::File read = few.find("c");  // counts as long as somebody reads it
    CHECK_FALSE(few.make_room(1000));
    CHECK_FALSE(few.find("c"));
  }
  CHECK(few.make_room(1000));
  CHECK_FALSE(few.make_room(1001));
  ExportFiles brief(2, 1000, std::chrono::seconds(0));
  brief.keep("a", file(10));
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  CHECK_FALSE(brief.find("a"));
}

TEST_CASE_METHOD(Items, "collections are listed in pages, renamed, recounted and removed") {
  for (const char* name : {"b", "c"}) {
    const std::string path = std::string("/collections/").append(name).append("/items");
    REQUIRE(send({"POST", path, {}, kA}).status == 201);
  }
  const auto ids = [&](const std::string& target) {
    std::string text;
    const Json page = Json::parse(send({"GET", target, {}, ""}).body);
    for (const Json& collection : page["collections"]) text += collection["id"].get<std::string>();
    for (const Json& link : page["links"]) {
      if (link["rel"] == "next") text += " " + link["href"].get<std::string>();
    }
    return text;
  };
  CHECK(ids("/collections?limit=2") == "bc /collections?limit=2&after=c");
  CHECK(ids("/collections?limit=2&after=c") == "town");
  CHECK(send({"GET", "/collections?limit=0", {}, ""}).status == 400);

  const auto rename = [&](const std::string& body) {
    return send({"PATCH", "/collections/b", {}, body});
  };
  CHECK(rename("{\"id\":\"c\"}").status == 409);
  CHECK(rename("{\"id\":\"no/id\"}").status == 400);
  CHECK(rename("{\"id\":\"d\",\"crs\":1}").status == 400);
  CHECK(rename("nothing").status == 400);
  CHECK(rename("{\"id\":\"..\"}").status == 400);  // a URL cannot name it
  CHECK(rename(std::string(5000, '[')).status == 413);
  const server::Response renamed = rename("{\"id\":\"d\"}");
  CHECK(renamed.status == 200);
  CHECK(field(renamed, "Content-Location") == "/collections/d");
  CHECK(Json::parse(renamed.body)["features"] == 1);
  CHECK(rename("{\"id\":\"e\"}").status == 404);

  CHECK(send({"POST", "/collections/d/recount", {}, ""}).status == 200);
  CHECK(send({"POST", "/collections/nowhere/recount", {}, ""}).status == 404);
  CHECK(send({"DELETE", "/collections/d", {}, ""}).status == 204);
  CHECK(send({"DELETE", "/collections/d", {}, ""}).status == 404);
  CHECK(ids("/collections") == "ctown");
}

TEST_CASE_METHOD(Items, "a collection changes only from the state that the client saw") {
  const auto change = [&](const std::string& method, const std::string& body,
                          const std::string& tag) {
    return send({method, "/collections/town", {{"if-match", tag}}, body}).status;
  };
  const server::Response seen = send({"GET", "/collections/town", {}, ""});
  const std::string etag = field(seen, "ETag");
  CHECK(send({"GET", "/collections/town", {{"if-none-match", etag}}, ""}).status == 304);
  REQUIRE(send({"POST", "/collections/town/items", {}, kA}).status == 201);
  CHECK(change("DELETE", "", etag) == 412);
  CHECK(change("PATCH", "{\"id\":\"new\"}", etag) == 412);
  const std::string now = field(send({"GET", "/collections/town", {}, ""}), "ETag");
  CHECK(change("PATCH", "{\"id\":\"town\"}", now) != 412);
  CHECK(change("DELETE", "", now) == 204);
}

}  // namespace
}  // namespace watertight::test_items
