// SPDX-License-Identifier: GPL-3.0-or-later
//
// Requests that keep others waiting, and those that must not wait.
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <thread>

#include "server/transport/listener.h"
#include "tests/unit/server/client.h"

namespace watertight::test_lanes {
namespace {

constexpr std::chrono::milliseconds kTick{2};

std::string get(const std::string& target) {
  return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
}

/// A server whose targets name lanes: "/computing", "/small", "/reading", "/quick". Each answers
/// after `release`, as does "/failing" with 500; "/slow" after 0.6 s. "/steps" answers by further
/// work under the key "a", and "/steps/b" under "b".
struct LaneServer {
  explicit LaneServer(server::ServerOptions options = {}) {
    options.port = 0;
    options.computing_threads = 1;
    options.reading_threads = 1;
    options.small_threads = 2;
    options.drain_seconds = 5;
    server::Application application;
    application.lane = [](const server::Request& request, std::uint64_t) {
      if (request.target == "/computing") return server::Lane::computing;
      if (request.target == "/small") return server::Lane::small;
      if (request.target == "/quick") return server::Lane::quick;
      return server::Lane::reading;
    };
    application.respond = [this](const server::Request& request, const CancelPoll&) {
      ++begun;
      server::Response response{200, "text/plain", "done", {}};
      if (request.target.starts_with("/steps")) {
        response.further = std::make_shared<const server::FurtherWork>(
            server::FurtherWork{server::Lane::small, request.target == "/steps" ? "a" : "b",
                                [this](const CancelPoll&) { return step(); }});
        return response;
      }
      if (request.target == "/slow") {
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        return response;
      }
      while (!release && request.target != "/quick") std::this_thread::sleep_for(kTick);
      if (request.target == "/failing") response.status = 500;
      return response;
    };
    auto started = server::HttpServer::start(options, application, [this](const std::string& line) {
      const std::lock_guard lock(mutex);
      log += line + "\n";
    });
    REQUIRE(started);
    server = *std::move(started);
  }
  ~LaneServer() {
    release = true;
    server->stop();
  }
  server::Response step() {
    ++steps;
    most_at_once = std::max<int>(most_at_once, ++at_once);
    while (!release) std::this_thread::sleep_for(kTick);
    --at_once;
    server::Response last{200, "text/plain", "stepped", {}};
    server::Response response;
    response.further = std::make_shared<const server::FurtherWork>(server::FurtherWork{
        server::Lane::computing, "", [last](const CancelPoll&) { return last; }});
    return response;
  }
  static bool comes_true(const std::function<bool()>& condition) {
    for (int i = 0; i < 2500 && !condition(); ++i) std::this_thread::sleep_for(kTick);
    return condition();
  }
  bool has_logged(const std::string& text) {
    return comes_true([&] {
      const std::lock_guard lock(mutex);
      return log.find(text) != std::string::npos;
    });
  }

  std::atomic<bool> release = false;
  std::atomic<int> begun = 0;
  std::atomic<int> steps = 0;
  std::atomic<int> at_once = 0;
  std::atomic<int> most_at_once = 0;
  std::mutex mutex;
  std::string log;
  std::unique_ptr<server::HttpServer> server;
};

TEST_CASE("requests of one lane do not wait for those of another") {
  LaneServer lanes;
  const Client computing(lanes.server->port());
  computing.send(get("/computing"));
  const Client reading(lanes.server->port());
  reading.send(get("/reading"));
  REQUIRE(LaneServer::comes_true([&] { return lanes.begun == 2; }));
  const Client small(lanes.server->port());
  small.send(get("/small"));
  CHECK(LaneServer::comes_true([&] { return lanes.begun == 3; }));
  const Client quick(lanes.server->port());
  quick.send(get("/quick"));
  CHECK(quick.receive_answer().ends_with("done"));
}

TEST_CASE("works with one key are done one after another, and those of other keys meanwhile") {
  LaneServer lanes;
  const Client first(lanes.server->port());
  const Client second(lanes.server->port());
  const Client other(lanes.server->port());
  first.send(get("/steps"));
  REQUIRE(LaneServer::comes_true([&] { return lanes.steps == 1; }));
  second.send(get("/steps"));
  other.send(get("/steps/b"));
  REQUIRE(LaneServer::comes_true([&] { return lanes.begun == 3 && lanes.steps == 2; }));
  lanes.release = true;
  for (const Client* client : {&first, &second, &other}) {
    CHECK(client->receive_answer().ends_with("stepped"));
  }
  CHECK(lanes.steps == 3);
  CHECK(lanes.most_at_once == 2);
}

TEST_CASE("requests that wait for the turn of their key take no place in a queue") {
  server::ServerOptions options;
  options.small_queue = 0;
  LaneServer lanes(options);
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 20; ++i) {
    clients.push_back(std::make_unique<Client>(lanes.server->port()));
    clients.back()->send(get("/steps"));
  }
  REQUIRE(LaneServer::comes_true([&] { return lanes.begun == 20 && lanes.steps == 1; }));
  lanes.release = true;
  for (const auto& client : clients) CHECK(client->receive_answer().ends_with("stepped"));
  CHECK(lanes.steps == 20);
  CHECK(lanes.most_at_once == 1);
}

TEST_CASE("a read that waits behind one that hangs and fails is refused") {
  LaneServer lanes;
  const Client hanging(lanes.server->port());
  hanging.send(get("/failing"));
  REQUIRE(LaneServer::comes_true([&] { return lanes.begun == 1; }));
  const Client waiting(lanes.server->port());
  waiting.send(get("/reading"));
  std::this_thread::sleep_for(std::chrono::milliseconds(2200));
  lanes.release = true;
  CHECK(hanging.receive_answer().starts_with("HTTP/1.1 500"));
  CHECK(waiting.receive_answer().starts_with("HTTP/1.1 503"));
  CHECK(lanes.begun == 1);
}

TEST_CASE("reads that wait long behind many others are answered") {
  LaneServer lanes;
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 5; ++i) {
    clients.push_back(std::make_unique<Client>(lanes.server->port()));
    clients.back()->send(get("/slow"));
  }
  for (const auto& client : clients) CHECK(client->receive_answer().ends_with("done"));
}

TEST_CASE("an address has at most its share of connections, and gets it back") {
  server::ServerOptions options;
  options.connections_per_address = 2;
  LaneServer lanes(options);
  {
    const Client first(lanes.server->port());
    const Client second(lanes.server->port());
    for (const Client* client : {&first, &second}) {
      client->send(get("/quick"));
      CHECK(client->receive_answer().ends_with("done"));
    }
    const Client third(lanes.server->port());
    const std::string refusal = third.receive_all();
    CHECK(refusal.starts_with("HTTP/1.1 429 Too Many Requests"));
    CHECK(refusal.find("Retry-After: ") != std::string::npos);
    CHECK(lanes.has_logged("event=refused peer=127.0.0.1 status=429"));
  }
  CHECK(LaneServer::comes_true([&] {
    const Client later(lanes.server->port());
    later.send(get("/quick"));
    return later.receive_answer().starts_with("HTTP/1.1 200");
  }));
}

TEST_CASE("an address has at most its share of requests in work") {
  server::ServerOptions options;
  options.works_per_address = 1;
  LaneServer lanes(options);
  const Client first(lanes.server->port());
  first.send(get("/computing"));
  REQUIRE(LaneServer::comes_true([&] { return lanes.begun == 1; }));
  const Client second(lanes.server->port());
  second.send(get("/small"));
  CHECK(second.receive_answer().starts_with("HTTP/1.1 429"));
  const Client quick(lanes.server->port());
  quick.send(get("/quick"));
  CHECK(quick.receive_answer().starts_with("HTTP/1.1 200"));
  lanes.release = true;
  CHECK(first.receive_answer().starts_with("HTTP/1.1 200"));
  const Client third(lanes.server->port());
  third.send(get("/small"));
  CHECK(third.receive_answer().starts_with("HTTP/1.1 200"));
}

TEST_CASE("line ends before a request mean nothing") {
  LaneServer lanes;
  const Client client(lanes.server->port());
  client.send("\r\n\r\n" + get("/quick"));
  CHECK(client.receive_answer().ends_with("done"));
}

TEST_CASE("a request that its client never finished is logged") {
  LaneServer lanes;
  {
    const Client client(lanes.server->port());
    client.send("POST /small HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10\r\n\r\nabc");
  }
  CHECK(lanes.has_logged("method=\"POST\" target=\"/small\" status=0"));
}

}  // namespace
}  // namespace watertight::test_lanes
