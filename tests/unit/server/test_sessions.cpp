// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <atomic>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/transport/listener.h"
#include "tests/unit/server/client.h"

namespace watertight::test_sessions {
namespace {

/// A server whose route "/slow" computes until `release`; all other routes answer at once with the
/// size of the body.
class Server {
 public:
  explicit Server(server::ServerOptions options = small()) {
    options.port = 0;
    server::Application application;
    application.lane = [](const server::Request& request, std::uint64_t) {
      return request.target == "/slow" ? server::Lane::computing : server::Lane::quick;
    };
    application.respond = [this](const server::Request& request, const CancelPoll& is_cancelled) {
      if (request.target == "/slow") {
        ++slow_;
        while (!release && !is_cancelled()) std::this_thread::sleep_for(kTick);
      }
      const std::string body = is_cancelled() ? "cancelled" : std::to_string(request.body.size());
      return server::Response{200, "text/plain", body, {}};
    };
    auto started = server::HttpServer::start(options, application, [](const std::string&) {});
    REQUIRE(started);
    server = *std::move(started);
  }
  ~Server() { server->stop(); }

  static server::ServerOptions small() {
    server::ServerOptions options;
    options.header_bytes = 1000;
    options.body_bytes = 10'000;
    options.body_bytes_together = 15'000;
    options.idle_seconds = 0.5;
    options.header_seconds = 0.5;
    options.body_seconds = 0.5;
    options.drain_seconds = 5;
    options.connections = 8;
    options.computing_threads = 1;
    options.computing_queue = 1;
    return options;
  }
  void wait_for_slow(int count) const {
    while (slow_ < count) std::this_thread::sleep_for(kTick);
  }

  std::unique_ptr<server::HttpServer> server;
  std::atomic<bool> release = false;

 private:
  static constexpr std::chrono::milliseconds kTick{2};
  std::atomic<int> slow_ = 0;
};

const std::string kGet = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";
const std::string kGetSlow = "GET /slow HTTP/1.1\r\nHost: localhost\r\n\r\n";

bool starts(const std::string& answer, const std::string& status) {
  INFO(answer);
  const bool does = answer.starts_with("HTTP/1.1 " + status);
  CHECK(does);
  return does;
}

TEST_CASE("a connection serves several requests") {
  const Server server;
  const Client client(server.server->port());
  for (int i = 0; i < 3; ++i) {
    client.send(kGet);
    starts(client.receive_answer(), "200");
  }
  client.send("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  starts(client.receive_all(), "200");
}

TEST_CASE("pipelined requests are answered in order") {
  const Server server;
  const Client client(server.server->port());
  client.send(
      "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\nabc"
      "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  const std::string answers = client.receive_all();
  starts(answers, "200");
  CHECK(answers.find("\r\n\r\n3HTTP/1.1 200") != std::string::npos);
}

TEST_CASE("limits of header and body are answered as problems") {
  const Server server;
  const auto ask = [&](const std::string& request) {
    const Client client(server.server->port());
    client.send(request);
    std::string answer = client.receive_all();
    CHECK(answer.find("application/problem+json") != std::string::npos);
    return answer;
  };
  starts(ask("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(2000, 'a') + "\r\n\r\n"),
         "431");
  starts(ask("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 20000\r\n\r\n"), "413");
  starts(ask("POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n4e20\r\n" +
             std::string(20000, 'a') + "\r\n0\r\n\r\n"),
         "413");
  starts(ask("POST / HTTP/1.1\r\nHost: localhost\r\n\r\n"), "411");
  starts(ask("GET / HTTP/1.1\r\n\r\n"), "400");
  starts(ask("rubbish\r\n\r\n"), "400");
  starts(ask("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\nContent-Encoding: "
             "br\r\n\r\nabc"),
         "415");
}

TEST_CASE("senders that never finish are cut off") {
  const Server server;
  const Client silent(server.server->port());
  CHECK(silent.receive_all().empty());
  for (const char* part :
       {"GET / HT", "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\na"}) {
    const Client client(server.server->port());
    client.send(part);
    starts(client.receive_all(), "408");
  }
}

TEST_CASE("a body that arrives fast enough may take longer than the time for a short one") {
  server::ServerOptions options = Server::small();
  options.body_seconds = 0.2;
  options.body_rate = 1000;
  const Server server(options);
  const Client client(server.server->port());
  client.send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n");
  for (int i = 0; i < 10; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    client.send(std::string(100, 'a'));
  }
  starts(client.receive_answer(), "200");
}

TEST_CASE("bodies together have a limit of their own") {
  server::ServerOptions options = Server::small();
  options.body_bytes = 200'000;
  options.body_bytes_together = 150'000;
  options.body_seconds = 5;
  const Server server(options);
  const std::string header = "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 110000\r\n\r\n";
  const Client first(server.server->port());
  first.send(header + std::string(100'000, 'a'));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const Client second(server.server->port());
  second.send(header + std::string(100'000, 'a'));
  starts(second.receive_all(), "503");
  const Client small(server.server->port());
  small.send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 60000\r\n\r\n" +
             std::string(60'000, 'a'));
  starts(small.receive_answer(), "200");
  first.send(std::string(10'000, 'a'));
  starts(first.receive_answer(), "200");
}

TEST_CASE("bodies that are only promised take nothing from others") {
  server::ServerOptions options = Server::small();
  options.body_bytes_together = 10'000;
  const Server server(options);
  std::vector<std::unique_ptr<Client>> promising;
  for (int i = 0; i < 5; ++i) {
    promising.push_back(std::make_unique<Client>(server.server->port()));
    promising.back()->send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10000\r\n\r\n");
  }
  const Client chunked(server.server->port());
  chunked.send(
      "POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n"
      "3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n");
  const std::string answer = chunked.receive_answer();
  starts(answer, "200");
  CHECK(answer.ends_with("5"));
}

TEST_CASE("a body that a proxy could frame in another way is refused, and the connection closed") {
  const Server server;
  for (const char* fields :
       {"Transfer-Encoding: xchunked\r\nContent-Length: 2", "Transfer-Encoding: identity",
        "Transfer-Encoding: chunked, identity\r\nContent-Length: 2",
        "Transfer-Encoding: gzip, chunked", "Transfer-Encoding:", "Transfer-Encoding: \"chunked\"",
        "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked"}) {
    INFO(fields);
    const Client client(server.server->port());
    client.send(std::string("POST / HTTP/1.1\r\nHost: localhost\r\n") + fields +
                "\r\n\r\n0\r\n\r\n" + kGet);
    const std::string answer = client.receive_all();
    const bool is_refused =
        answer.starts_with("HTTP/1.1 501") || answer.starts_with("HTTP/1.1 400");
    CHECK(is_refused);
    CHECK(answer.find("HTTP/1.1 200") == std::string::npos);
  }
  const Client old(server.server->port());
  old.send("POST / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n");
  CHECK(old.receive_all().find(" 501 ") != std::string::npos);
}

TEST_CASE("pages of other sites can neither write to a local service nor name it") {
  const Server server;
  const auto status = [&](const std::string& line, const std::string& fields) {
    const Client client(server.server->port());
    client.send(line + " HTTP/1.1\r\n" + fields + "Content-Length: 0\r\nConnection: close\r\n\r\n");
    return client.receive_all().substr(9, 3);
  };
  CHECK(status("GET /", "Host: evil.example\r\n") == "421");
  CHECK(status("GET /", "Host: localhost.evil.example\r\n") == "421");
  for (const char* host :
       {"localhost", "LOCALHOST:8080", "127.0.0.1:1", "[::1]:8080", "127.9.9.9"}) {
    INFO(host);
    CHECK(status("GET /", std::string("Host: ") + host + "\r\n") == "200");
  }
  const std::string host = "Host: localhost:80\r\n";
  CHECK(status("POST /", host + "Origin: http://evil.example\r\n") == "403");
  CHECK(status("DELETE /", host + "Origin: null\r\n") == "403");
  CHECK(status("POST /", host + "Origin: http://localhost:80\r\n") == "200");
  CHECK(status("GET /", host + "Origin: http://evil.example\r\n") == "200");
}

TEST_CASE("work for a client that has left is cancelled") {
  Server server;
  {
    const Client client(server.server->port());
    client.send(kGetSlow);
    server.wait_for_slow(1);
  }
  const Client next(server.server->port());
  next.send(kGetSlow);
  server.wait_for_slow(2);  // the only computing thread is free again
  server.release = true;
  starts(next.receive_answer(), "200");
}

TEST_CASE("work for a client that has left is cancelled although it sent more before") {
  Server server;
  {
    const Client client(server.server->port());
    client.send(kGetSlow);
    server.wait_for_slow(1);
    client.send("G");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  const Client next(server.server->port());
  next.send(kGetSlow);
  server.wait_for_slow(2);
  server.release = true;
  starts(next.receive_answer(), "200");
}

TEST_CASE("the next request may come while one is answered") {
  Server server;
  const Client client(server.server->port());
  client.send(kGetSlow);
  server.wait_for_slow(1);
  client.send(kGet);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server.release = true;
  std::string answers;
  CHECK(client.receive_at_least(2 * 100, answers));
  CHECK(answers.find("cancelled") == std::string::npos);
}

TEST_CASE("idle clients make room for others") {
  server::ServerOptions options = Server::small();
  options.idle_seconds = 60;
  const Server server(options);
  std::vector<std::unique_ptr<Client>> idle;
  for (int i = 0; i < 20; ++i) idle.push_back(std::make_unique<Client>(server.server->port()));
  const Client client(server.server->port());
  client.send(kGet);
  starts(client.receive_answer(), "200");
  idle.back()->send(kGet);  // the youngest was left alone
  starts(idle.back()->receive_answer(), "200");
}

TEST_CASE("every answer has the time") {
  const Server server;
  const Client client(server.server->port());
  client.send(kGet);
  const std::string answer = client.receive_answer();
  CHECK(answer.find("\r\nDate: ") != std::string::npos);
  CHECK(answer.find(" GMT\r\n") != std::string::npos);
}

TEST_CASE("a client that expects 100 Continue gets it") {
  const Server server;
  const Client client(server.server->port());
  client.send(
      "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\nExpect: 100-continue\r\n\r\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  client.send("abc");
  const std::string answer = client.receive_answer();
  starts(answer, "100");
  CHECK(answer.find("HTTP/1.1 200") != std::string::npos);
}

TEST_CASE("HEAD has the length of the body but not the body") {
  const Server server;
  const Client client(server.server->port());
  client.send("HEAD / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  const std::string answer = client.receive_all();
  CHECK(answer.find("Content-Length: 1\r\n") != std::string::npos);
  CHECK(answer.ends_with("\r\n\r\n"));
}

TEST_CASE("quick requests are answered while others compute, and a full queue is 503") {
  Server server;
  const Client computing(server.server->port());
  computing.send(kGetSlow);
  server.wait_for_slow(1);
  const Client waiting(server.server->port());
  waiting.send(kGetSlow);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const Client refused(server.server->port());
  refused.send(kGetSlow);
  starts(refused.receive_answer(), "503");
  const Client quick(server.server->port());
  quick.send(kGet);
  starts(quick.receive_answer(), "200");
  server.release = true;
  starts(computing.receive_answer(), "200");
  starts(waiting.receive_answer(), "200");
}

TEST_CASE("connections beyond the limit are asked to come back") {
  server::ServerOptions options = Server::small();
  options.connections = 1;
  Server server(options);
  const Client first(server.server->port());
  first.send(kGetSlow);
  server.wait_for_slow(1);
  const Client second(server.server->port());
  starts(second.receive_answer(), "503");
  server.release = true;
  starts(first.receive_answer(), "200");
}

TEST_CASE("stopping lets a request in flight finish and closes idle connections") {
  server::ServerOptions options = Server::small();
  options.idle_seconds = 60;
  Server server(options);
  const Client idle(server.server->port());
  idle.send(kGet);
  starts(idle.receive_answer(), "200");
  const Client busy(server.server->port());
  busy.send(kGetSlow);
  server.wait_for_slow(1);
  std::thread stopper([&] { server.server->stop(); });
  CHECK(idle.receive_all().empty());
  server.release = true;
  const std::string answer = busy.receive_all();
  starts(answer, "200");
  CHECK(answer.ends_with("\r\n\r\n0"));
  stopper.join();
}

TEST_CASE("stopping cancels what does not finish in time") {
  server::ServerOptions options = Server::small();
  options.drain_seconds = 0.2;
  Server server(options);
  const Client busy(server.server->port());
  busy.send(kGetSlow);
  server.wait_for_slow(1);
  server.server->stop();
  CHECK(busy.receive_all().ends_with("cancelled"));
}

/// A server that answers "/parts" with `parts` parts of `bytes` bytes; with `failing`, an error
/// follows them.
struct Parts {
  explicit Parts(std::size_t count, std::size_t bytes = 5, bool failing = false) {
    server::ServerOptions options = Server::small();
    options.port = 0;
    options.downloads = 1;
    options.write_seconds = 0.5;
    options.write_rate = 100e3;
    server::Application application;
    application.lane = [](const server::Request&, std::uint64_t) {
      return server::Lane::computing;
    };
    application.respond = [=, this](const server::Request& request, const CancelPoll&) {
      server::Response response{200, "text/plain", std::string(bytes, 'a'), {}};
      if (request.target != "/parts") return response;
      response.body.resize(std::min<std::size_t>(bytes, first_bytes));
      response.rest = [=, this, alive = alive,
                       left = count - 1](const CancelPoll&) mutable -> Result<std::string> {
        ++made;
        if (left > 0) return std::string(bytes, static_cast<char>('a' + left--));
        if (failing) return Error{ErrorCode::unavailable, "the database is away"};
        return std::string();
      };
      return response;
    };
    auto started = server::HttpServer::start(options, application, [this](const std::string& line) {
      const std::lock_guard lock(mutex);
      log += line + "\n";
    });
    REQUIRE(started);
    server = *std::move(started);
  }
  ~Parts() { server->stop(); }
  /// True if, within five seconds, no download holds its state any more.
  bool is_idle() const {
    for (int i = 0; i < 2500 && alive.use_count() > 1; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return alive.use_count() == 1;
  }
  /// True if, within five seconds, a text was logged so many times.
  bool has_logged(const std::string& text, std::size_t times = 1) {
    for (int i = 0; i < 2500; ++i) {
      if (times_logged(text) >= times) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }
  std::size_t times_logged(const std::string& text) {
    const std::lock_guard lock(mutex);
    std::size_t times = 0;
    for (std::size_t at = log.find(text); at != std::string::npos; at = log.find(text, at + 1)) {
      ++times;
    }
    return times;
  }

  std::shared_ptr<int> alive = std::make_shared<int>(0);
  std::atomic<std::size_t> made = 0;
  std::atomic<std::size_t> first_bytes = SIZE_MAX;  // the most that the answer begins with
  std::mutex mutex;
  std::string log;
  std::unique_ptr<server::HttpServer> server;
};

const std::string kGetParts = "GET /parts HTTP/1.1\r\nHost: localhost\r\n\r\n";

TEST_CASE("an answer in parts comes in chunks, and the connection goes on") {
  Parts parts(3);
  const Client client(parts.server->port());
  client.send(kGetParts + "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  const std::string answers = client.receive_all();
  const std::size_t body = answers.find("\r\n\r\n") + 4;
  CHECK(answers.substr(0, body).find("Transfer-Encoding: chunked\r\n") != std::string::npos);
  CHECK(
      answers.substr(body).starts_with("5\r\naaaaa\r\n5\r\nccccc\r\n5\r\nbbbbb\r\n0\r\n\r\nHTTP"));
  CHECK(answers.ends_with("\r\n\r\naaaaa"));
  CHECK(parts.has_logged("target=\"/parts\" status=200 bytes=15 "));
}

TEST_CASE("an answer whose first bytes are still to be made comes as a whole") {
  Parts parts(3);
  parts.first_bytes = 0;
  const Client client(parts.server->port());
  client.send("GET /parts HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  const std::string answer = client.receive_all();
  CHECK(answer.ends_with("\r\n\r\n5\r\nccccc\r\n5\r\nbbbbb\r\n0\r\n\r\n"));
}

TEST_CASE("HTTP 1.0 gets the parts without chunks, and HEAD none") {
  Parts parts(3);
  const Client old(parts.server->port());
  old.send("GET /parts HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
  const std::string answer = old.receive_all();
  CHECK(answer.find("chunked") == std::string::npos);
  CHECK(answer.ends_with("\r\n\r\naaaaacccccbbbbb"));
  const std::size_t made = parts.made;
  const Client head(parts.server->port());
  head.send("HEAD /parts HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  CHECK(head.receive_all().ends_with("\r\n\r\n"));
  CHECK(parts.made == made);
}

TEST_CASE("parts that fail cut the answer off, which has no end then") {
  Parts parts(2, 5, true);
  const Client client(parts.server->port());
  client.send(kGetParts);
  CHECK_FALSE(client.receive_all().ends_with("0\r\n\r\n"));
  CHECK(parts.has_logged("cut-off=\"unavailable: the database is away\""));
  CHECK(parts.is_idle());
}

TEST_CASE("a client that leaves or stops reading leaves nothing behind, and blocks no other") {
  // A part may take 0.5 s and the time of its bytes at 100 kB/s, together 1.2 s.
  Parts parts(100'000, 1 << 16);
  {
    const Client leaving(parts.server->port());
    leaving.send(kGetParts);
    std::string start;
    REQUIRE(leaving.receive_at_least(1, start));
    const Client second(parts.server->port());
    second.send(kGetParts);
    starts(second.receive_answer(), "503");
  }
  CHECK(parts.is_idle());
  CHECK(parts.has_logged("status=503"));
  CHECK(parts.has_logged("cut-off="));
  const Client asleep(parts.server->port());
  asleep.send(kGetParts);
  CHECK(parts.has_logged("cut-off=", 2));
  CHECK(parts.is_idle());
  CHECK(parts.made < 1000);
}

TEST_CASE("the work on a part ends when the client leaves") {
  std::atomic<bool> has_begun = false;
  std::atomic<bool> has_ended = false;
  server::Application application;
  application.lane = [](const server::Request&, std::uint64_t) { return server::Lane::reading; };
  application.respond = [&](const server::Request&, const CancelPoll&) {
    server::Response response{200, "text/plain", "start", {}};
    response.rest = [&](const CancelPoll& is_cancelled) -> Result<std::string> {
      has_begun = true;
      while (!is_cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      has_ended = true;
      return Error{ErrorCode::cancelled, "not finished"};
    };
    return response;
  };
  server::ServerOptions options = Server::small();
  options.port = 0;
  const auto started = server::HttpServer::start(options, application, [](const std::string&) {});
  REQUIRE(started);
  {
    const Client client((*started)->port());
    client.send(kGetParts);
    while (!has_begun) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    CHECK_FALSE(has_ended);
  }
  for (int i = 0; i < 2500 && !has_ended; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  CHECK(has_ended);
  (*started)->stop();
}

TEST_CASE("stopping cuts off an answer in parts that does not end in time") {
  Parts parts(100'000, 5);
  const Client client(parts.server->port());
  client.send(kGetParts);
  std::string start;
  REQUIRE(client.receive_at_least(1000, start));
  std::thread reader([&] { client.receive_all(); });
  parts.server->stop();
  reader.join();
  CHECK(parts.is_idle());
}

TEST_CASE("an address that cannot be listened on is an error") {
  const Server server;
  server::ServerOptions options;
  options.port = server.server->port();
  const auto second = server::HttpServer::start(options, {}, [](const std::string&) {});
  REQUIRE_FALSE(second);
  CHECK(second.error().code == ErrorCode::unavailable);
  options.address = "nowhere";
  CHECK_FALSE(server::HttpServer::start(options, {}, [](const std::string&) {}));
}

}  // namespace
}  // namespace watertight::test_sessions
