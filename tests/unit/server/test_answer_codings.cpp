// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compressed answers.
#include <catch2/catch_test_macros.hpp>

#include "archives/expansion.h"
#include "server/features/answer_coding.h"
#include "tests/unit/server/routes_fixture.h"

namespace watertight::test_answer_codings {
namespace {

using Fixture = samples::RoutesFixture;
using samples::header_of;

server::Request accepting(const std::string& codings) {
  return {"GET", "/", {{"accept-encoding", codings}}, ""};
}

/// The text behind a gzip member.
std::string expanded(const std::string& packed) {
  std::string_view rest = packed;
  const ByteSource source = archives::expanded(
      [&rest](std::span<std::uint8_t> bytes) -> Result<std::size_t> {
        const std::size_t count = std::min(rest.size(), bytes.size());
        std::copy_n(rest.begin(), count, bytes.begin());
        rest.remove_prefix(count);
        return count;
      },
      archives::Compression::gzip);
  std::string text;
  std::string piece(1000, ' ');
  for (;;) {
    const auto count = source({reinterpret_cast<std::uint8_t*>(piece.data()), piece.size()});
    REQUIRE(count);
    if (*count == 0) return text;
    text.append(piece, 0, *count);
  }
}

TEST_CASE("a client says which codings it takes") {
  for (const char* yes :
       {"gzip", "GZIP", "deflate, gzip;q=0.5", "x-gzip", "br;q=1, *", "*;q=0.1"}) {
    INFO(yes);
    CHECK(server::takes_gzip(accepting(yes)));
  }
  for (const char* no : {"", "br", "gzip;q=0", "gzip;q=0, *", "*;q=0", "gzip;q=x", ",,;"}) {
    INFO(no);
    CHECK_FALSE(server::takes_gzip(accepting(no)));
  }
  CHECK_FALSE(server::takes_gzip({"GET", "/", {}, ""}));
}

TEST_CASE_METHOD(Fixture, "a long text is compressed for who takes that, with a tag of its own") {
  REQUIRE(post("/collections/town/items", samples::kTwo).status == 201);
  for (const std::string target : {"/collections/town/items/a", "/collections/town/items",
                                   "/collections/town?f=html", "/web/main.js"}) {
    INFO(target);
    const auto plain = get(target);
    const auto packed = get(target, {{"accept-encoding", "gzip"}});
    REQUIRE(packed.status == 200);
    CHECK(header_of(plain, "Content-Encoding") == nullptr);
    if (plain.body.size() < 1024) {
      CHECK(packed.body == plain.body);
      continue;
    }
    REQUIRE(header_of(packed, "Content-Encoding") != nullptr);
    CHECK(packed.body.size() < plain.body.size());
    CHECK(expanded(packed.body) == plain.body);
    const std::string* etag = header_of(packed, "ETag");
    if (etag == nullptr) continue;
    CHECK(*etag != *header_of(plain, "ETag"));
    CHECK(get(target, {{"if-none-match", *etag}, {"accept-encoding", "gzip"}}).status == 304);
    CHECK(get(target, {{"if-none-match", *etag}}).status == 304);
  }
}

TEST_CASE_METHOD(Fixture, "what is compressed already, or a part, is not compressed again") {
  REQUIRE(post("/collections/town/items", samples::kTwo).status == 201);
  const auto file = get("/collections/town/items/a?f=wt", {{"accept-encoding", "gzip"}});
  CHECK(file.status == 200);
  CHECK(header_of(file, "Content-Encoding") == nullptr);
  const auto part =
      get("/collections/town/items/a", {{"accept-encoding", "gzip"}, {"range", "bytes=0-9"}});
  CHECK(part.status == 206);
  CHECK(part.body.size() == 10);
  CHECK(header_of(part, "Content-Encoding") == nullptr);
}

TEST_CASE_METHOD(Fixture, "a write takes the tag of a compressed answer") {
  REQUIRE(post("/collections/town/items", samples::kTwo).status == 201);
  const std::string target = "/collections/town/items/a";
  const std::string tag = *header_of(get(target), "ETag");
  const std::string packed = tag.substr(0, tag.size() - 1) + std::string(server::kGzipTag) + "\"";
  CHECK(send({"DELETE", target, {{"if-match", "\"99-x-gzip\""}}, ""}).status == 412);
  CHECK(send({"DELETE", target, {{"if-match", packed}}, ""}).status == 204);
}

}  // namespace
}  // namespace watertight::test_answer_codings
