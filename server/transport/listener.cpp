// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/listener.h"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <future>
#include <limits>
#include <optional>
#include <thread>

#include "server/transport/messages.h"
#include "server/transport/session.h"

namespace watertight::server {
namespace {

namespace asio = boost::asio;
using asio::awaitable;
using asio::redirect_error;
using asio::use_awaitable;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::milliseconds;

constexpr std::size_t kRefusedAtOnce = 64;  // connections beyond the limit that get an answer
// Between two turns of the I/O thread's queue so many connections are accepted. With one each turn,
// a probe waits behind all clients that connect again and again, although its own answer is quick.
constexpr int kAcceptedTogether = 32;
constexpr milliseconds kPause{20};
constexpr double kMoment = 0.001;  // seconds, added to ages so that all rates are finite

class AsioServer final : public HttpServer {
 public:
  AsioServer(const ServerOptions& options, Application application, LogLine log)
      : environment_(options, std::move(application), std::move(log)),
        guard_(asio::make_work_guard(context_)),
        acceptor_(context_) {}
  ~AsioServer() override { stop(); }
  AsioServer(const AsioServer&) = delete;
  AsioServer& operator=(const AsioServer&) = delete;

  Status listen();
  std::uint16_t port() const override { return port_; }
  void stop() override;

 private:
  awaitable<void> accept();
  void begin_session(tcp::socket socket);
  std::optional<Response> refusal_of(const Connection& connection);
  void refuse(std::shared_ptr<Connection> connection, Response refusal);
  bool make_room();
  void close_idle_connections();
  bool wait_for_sessions(double seconds);

  asio::io_context context_{1};
  SessionEnvironment environment_;
  asio::executor_work_guard<asio::io_context::executor_type> guard_;
  tcp::acceptor acceptor_;
  std::shared_ptr<TlsContext> tls_;  // null: clients speak plain HTTP
  std::uint16_t port_ = 0;
  std::size_t making_room_ = 0;  // sessions of closed connections that have not ended yet
  std::atomic<std::size_t> refused_ = 0;
  std::thread thread_;
};

Status AsioServer::listen() {
  const ServerOptions& options = environment_.options;
  if (options.is_encrypted()) {
    auto tls = make_tls(options.tls_certificate, options.tls_key);
    if (!tls) return std::move(tls).error();
    tls_ = *std::move(tls);
  }
  const std::string place = options.address + ":" + std::to_string(options.port);
  error_code error;
  const auto address = asio::ip::make_address(options.address, error);
  if (error) {
    return Error{ErrorCode::invalid_argument,
                 "'" + options.address + "' is not an IP address (example: 127.0.0.1)",
                 {},
                 {}};
  }
  const tcp::endpoint endpoint(address, options.port);
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    return Error{
        ErrorCode::unavailable, "cannot listen on " + place + ": " + error.message(), {}, {}};
  }
  port_ = acceptor_.local_endpoint(error).port();
  for (int i = 0; i < kAcceptedTogether; ++i) asio::co_spawn(context_, accept(), asio::detached);
  thread_ = std::thread([this] { context_.run(); });
  return Done{};
}

awaitable<void> AsioServer::accept() {
  asio::steady_timer timer(context_);
  while (!environment_.is_draining) {
    error_code error;
    tcp::socket socket = co_await acceptor_.async_accept(redirect_error(use_awaitable, error));
    if (environment_.is_draining) break;
    try {
      if (!error) {
        begin_session(std::move(socket));
        continue;
      }
    } catch (const std::bad_alloc&) {
      environment_.log("event=refused reason=memory");
    }
    // Descriptors or memory ran out. Open connections may end, so accepting is tried again soon.
    timer.expires_after(kPause);
    co_await timer.async_wait(redirect_error(use_awaitable, error));
  }
}

void AsioServer::begin_session(tcp::socket socket) {
  error_code error;
  socket.set_option(tcp::no_delay(true), error);
  const auto peer = socket.remote_endpoint(error);
  auto connection = std::make_shared<Connection>(std::move(socket), tls_.get());
  if (!error) connection->peer = peer.address().to_string();
  if (auto refusal = refusal_of(*connection)) {
    refuse(std::move(connection), *std::move(refusal));
    return;
  }
  ++environment_.sessions;
  const auto place = environment_.connections.insert(environment_.connections.end(), connection);
  asio::co_spawn(context_, run_session(connection, environment_),
                 [this, place, connection](std::exception_ptr) {
                   environment_.connections.erase(place);
                   environment_.connections_of.give_back(connection->peer);
                   if (connection->makes_room) --making_room_;
                   --environment_.sessions;
                 });
}

/// The refusal of a new connection; nothing if it is counted as one of its address now.
std::optional<Response> AsioServer::refusal_of(const Connection& connection) {
  const ServerOptions& options = environment_.options;
  if (!environment_.connections_of.take(connection.peer, options.connections_per_address)) {
    return too_many("this address has too many connections");
  }
  const std::size_t staying = environment_.sessions - making_room_;
  const bool is_full = staying >= options.connections && !make_room();
  if (!is_full && environment_.sessions < options.connections + kRefusedAtOnce) return std::nullopt;
  environment_.connections_of.give_back(connection.peer);
  return busy("too many connections");
}

void AsioServer::refuse(std::shared_ptr<Connection> connection, Response refusal) {
  environment_.log("event=refused peer=" + connection->peer +
                   " status=" + std::to_string(refusal.status));
  if (refused_ >= kRefusedAtOnce) return;
  ++refused_;
  asio::co_spawn(context_, refuse_session(std::move(connection), std::move(refusal)),
                 [this](std::exception_ptr) { --refused_; });
}

/// Closes the connection that uses its place least: the one with the fewest bytes of a request for
/// the time in which it could have sent them. False if all connections are being answered.
bool AsioServer::make_room() {
  const auto now = std::chrono::steady_clock::now();
  Connection* chosen = nullptr;
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& connection : environment_.connections) {
    if (connection->makes_room || connection->state == Connection::State::answering) continue;
    const std::chrono::duration<double> age = now - connection->since;
    const double rate = (1 + static_cast<double>(connection->body_bytes)) / (kMoment + age.count());
    if (rate >= lowest) continue;
    lowest = rate;
    chosen = connection.get();
  }
  if (chosen == nullptr) return false;
  if (chosen->state == Connection::State::receiving) {
    environment_.log("event=closed-for-room peer=" + chosen->peer);
  }
  chosen->makes_room = true;
  ++making_room_;
  chosen->stream.close();
  return true;
}

void AsioServer::close_idle_connections() {
  for (const auto& connection : environment_.connections) {
    if (connection->state == Connection::State::idle) connection->stream.close();
  }
}

bool AsioServer::wait_for_sessions(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (environment_.sessions > 0) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

void AsioServer::stop() {
  if (!thread_.joinable()) return;
  environment_.is_draining = true;
  asio::post(context_, [this] {
    error_code ignored;
    acceptor_.close(ignored);
    close_idle_connections();
  });
  if (!wait_for_sessions(environment_.options.drain_seconds)) {
    environment_.log("event=drain-timeout sessions=" + std::to_string(environment_.sessions));
  }
  // Set on the I/O thread, so that no session gives work to a lane after this.
  std::promise<void> is_noted;
  asio::post(context_, [&] {
    environment_.is_cancelled = true;
    is_noted.set_value();
  });
  is_noted.get_future().wait();
  if (environment_.application.interrupt) environment_.application.interrupt();
  // Engines notice the cancellation within moments; no thread may outlive what it refers to.
  for (const Lane lane : {Lane::computing, Lane::small, Lane::items, Lane::reading}) {
    environment_.threads_of(lane).threads.join();
  }
  environment_.disk.join();
  wait_for_sessions(1);
  guard_.reset();
  context_.stop();
  thread_.join();
}

}  // namespace

Result<std::unique_ptr<HttpServer>> HttpServer::start(const ServerOptions& options,
                                                      Application application, LogLine log) {
  auto server = std::make_unique<AsioServer>(options, std::move(application), std::move(log));
  const Status status = server->listen();
  if (!status) return status.error();
  return std::unique_ptr<HttpServer>(std::move(server));
}

}  // namespace watertight::server
