// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compressed bodies of requests.
#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <memory>
#include <string>

#include "server/transport/body_coding.h"
#include "server/transport/listener.h"
#include "tests/unit/archives/pack.h"
#include "tests/unit/server/client.h"

namespace watertight::test_codings {
namespace {

using archives::Compression;

constexpr std::size_t kLittle = 64 * 1024;

server::Request with_codings(std::vector<std::string> codings) {
  server::Request request;
  for (std::string& coding : codings) {
    request.headers.push_back({"content-encoding", std::move(coding)});
  }
  return request;
}

TEST_CASE("the coding of a body is that of its fields") {
  CHECK(server::coding_of(with_codings({})) == Compression::none);
  CHECK(server::coding_of(with_codings({"identity"})) == Compression::none);
  CHECK(server::coding_of(with_codings({"GZip"})) == Compression::gzip);
  CHECK(server::coding_of(with_codings({" x-gzip "})) == Compression::gzip);
  CHECK(server::coding_of(with_codings({"zstd", "identity"})) == Compression::zstd);
  for (const std::string coding : {"br", "deflate", "", "gzip, zstd", "gzip;q=1"}) {
    CHECK_FALSE(server::coding_of(with_codings({coding})));
  }
  CHECK_FALSE(server::coding_of(with_codings({"gzip", "gzip"})));
}

unsigned status_of(const std::optional<server::Response>& response) {
  return response ? response->status : 0;
}

std::optional<server::Response> expand(server::Request& request, Compression coding,
                                       std::uint64_t most, std::uint64_t room = ~0ULL) {
  return server::expand_body(
      request, coding, most, [room](std::uint64_t bytes) { return bytes <= room; },
      [] { return false; });
}

TEST_CASE("a body that is cut off anywhere is malformed, and stays") {
  const std::string text =
      "{\"type\":\"CityJSON\",\"version\":\"2.0\",\"vertices\":[[1,2,3],[4,5,6]]}";
  for (const Compression coding : {Compression::gzip, Compression::zstd}) {
    const std::string packed = coding == Compression::gzip ? test::gzip(text) : test::zstd(text);
    for (std::size_t size = 0; size < packed.size(); ++size) {
      server::Request request;
      request.body = packed.substr(0, size);
      const auto problem = expand(request, coding, 1000);
      INFO(size << " of " << packed.size());
      REQUIRE(status_of(problem) == 400);
      CHECK(problem->body.find("\"byteOffset\":") != std::string::npos);
      CHECK(request.body.size() == size);
    }
    server::Request request;
    request.body = packed;
    CHECK_FALSE(expand(request, coding, text.size()));
    CHECK(request.body == text);
  }
}

TEST_CASE("a body is expanded within a limit and within the room for it") {
  const std::string text(300'000, 'a');
  server::Request request;
  request.body = test::gzip(text);
  const auto over = expand(request, Compression::gzip, text.size() - 1);
  CHECK(status_of(over) == 413);
  CHECK(over->body.find("expands to more than 299999 bytes") != std::string::npos);
  const auto without_room = expand(request, Compression::gzip, text.size(), 100'000);
  CHECK(status_of(without_room) == 503);
  CHECK(without_room->body.find("problem:busy") != std::string::npos);
  const auto cancelled = server::expand_body(
      request, Compression::gzip, text.size(), [](std::uint64_t) { return true; },
      [] { return true; });
  CHECK(status_of(cancelled) == 503);
  CHECK_FALSE(expand(request, Compression::gzip, text.size(), text.size()));
  CHECK(request.body == text);
}

/// A server that answers with the lane and the size of a body.
class Server {
 public:
  explicit Server(std::uint64_t together = 10'000'000) {
    server::ServerOptions options;
    options.port = 0;
    options.body_bytes = 1'000'000;
    options.body_bytes_together = together;
    server::Application application;
    application.lane = [](const server::Request& request, std::uint64_t bytes) {
      if (request.target == "/quick") return server::Lane::quick;
      return bytes <= kLittle ? server::Lane::small : server::Lane::computing;
    };
    application.respond = [this](const server::Request& request, const CancelPoll&) {
      ++answers;
      return server::Response{200, "text/plain", "size " + std::to_string(request.body.size()), {}};
    };
    auto started = server::HttpServer::start(options, application, [](const std::string&) {});
    REQUIRE(started);
    server = *std::move(started);
  }
  ~Server() { server->stop(); }

  std::string post(const std::string& body, const std::string& fields,
                   const std::string& target = "/") const {
    const Client client(server->port());
    client.send("POST " + target + " HTTP/1.1\r\nHost: localhost\r\nContent-Length: " +
                std::to_string(body.size()) + "\r\n" + fields + "\r\n" + body);
    return client.receive_answer();
  }

  std::unique_ptr<server::HttpServer> server;
  std::atomic<int> answers = 0;
};

bool has(const std::string& answer, const std::string& text) {
  INFO(answer);
  const bool does = answer.find(text) != std::string::npos;
  CHECK(does);
  return does;
}

const std::string kGzip = "Content-Encoding: gzip\r\n";
const std::string kZstd = "Content-Encoding: zstd\r\n";

TEST_CASE("the service expands bodies, little and large ones") {
  const Server server;
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, kLittle, kLittle + 1, std::size_t{1'000'000}}) {
    const std::string text(size, 'a');
    const std::string expected = "size " + std::to_string(size);
    CHECK(server.post(test::gzip(text), kGzip).ends_with(expected));
    CHECK(server.post(test::zstd(text), kZstd).ends_with(expected));
  }
  CHECK(server.post("abc", "Content-Encoding: identity\r\n").ends_with("size 3"));
  // Where nobody reads the body, nobody expands it.
  CHECK(server.post("no gzip", kGzip, "/quick").ends_with("size 7"));
}

TEST_CASE("a body that expands beyond the limit is refused before anything reads it") {
  const Server server;
  for (const std::size_t size : {std::size_t{1'000'001}, std::size_t{50'000'000}}) {
    const std::string text(size, ' ');
    has(server.post(test::gzip(text), kGzip), "HTTP/1.1 413 ");
    has(server.post(test::zstd(text), kZstd), "expands to more than 1000000 bytes");
  }
  CHECK(server.answers == 0);
  has(server.post("\x1F\x8B no gzip", kGzip), "HTTP/1.1 400 ");
  has(server.post(test::zstd("a"), kGzip), "\"byteOffset\":");
  CHECK(server.answers == 0);
}

TEST_CASE("expanded bodies count against the bytes of all bodies together") {
  const Server server(500'000);
  CHECK(server.post(test::gzip(std::string(400'000, 'a')), kGzip).ends_with("size 400000"));
  has(server.post(test::gzip(std::string(600'000, 'a')), kGzip), "HTTP/1.1 503 ");
  // What was taken is given back.
  CHECK(server.post(test::gzip(std::string(400'000, 'a')), kGzip).ends_with("size 400000"));
}

TEST_CASE("other codings are refused with those that are read") {
  const Server server;
  for (const std::string fields :
       {"Content-Encoding: br\r\n", "Content-Encoding: gzip, gzip\r\n"}) {
    const std::string answer = server.post("x", fields);
    has(answer, "HTTP/1.1 415 ");
    has(answer, "Accept-Encoding: gzip, zstd\r\n");
  }
  CHECK(server.answers == 0);
}

}  // namespace
}  // namespace watertight::test_codings
