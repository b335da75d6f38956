// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/session.h"

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <cmath>
#include <new>
#include <optional>

#include "base/ascii.h"
#include "server/transport/messages.h"

namespace watertight::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::awaitable;
using asio::redirect_error;
using asio::use_awaitable;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kReadBytes = 16 * 1024;
constexpr double kLingerSeconds = 2;  // how long the rest of a request is read after the answer
constexpr std::uint64_t kLingerBytes = 64ULL << 20;
constexpr std::size_t kSmallBody = 64 * 1024;  // bytes of a body that no budget limits
constexpr double kBytesPerSecond = 100e3;      // the slowest client that gets its whole answer

Clock::duration seconds(double value) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Response respond_guarded(const Application& application, const Request& request,
                         const CancelPoll& is_cancelled) {
  try {
    return application.respond(request, is_cancelled);
  } catch (const std::bad_alloc&) {
    return busy("not enough memory for this request now");
  } catch (const std::exception& failure) {
    return problem(500, "internal", std::string("unexpected failure: ") + failure.what());
  }
}

Result<std::string> next_part_guarded(const BodyParts& parts) {
  try {
    return parts();
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::limit_exceeded, "not enough memory"};
  } catch (const std::exception& failure) {
    return Error{ErrorCode::unavailable, std::string("unexpected failure: ") + failure.what()};
  }
}

/// Cancels what a connection's stream is doing when a moment has come, so that the client can still
/// be answered (a time limit of the stream itself closes it). Only for the stream's executor.
class TimeLimit {
 public:
  TimeLimit(const std::shared_ptr<Connection>& connection, Clock::time_point end)
      : timer_(connection->stream.get_executor(), end), state_(std::make_shared<State>()) {
    timer_.async_wait([connection, state = state_](const error_code&) {
      if (!state->is_watching) return;
      state->is_over = true;
      connection->stream.cancel();
    });
  }
  ~TimeLimit() {
    state_->is_watching = false;
    timer_.cancel();
  }
  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;
  bool is_over() const { return state_->is_over; }

 private:
  struct State {
    bool is_watching = true;
    bool is_over = false;
  };
  asio::steady_timer timer_;
  std::shared_ptr<State> state_;
};

/// Notices that a client has closed its side of the connection while its request is answered. Does
/// not read: bytes that come are those of the next request. Only for the stream's executor.
class ClientWatch {
 public:
  explicit ClientWatch(const std::shared_ptr<Connection>& connection)
      : connection_(connection), has_left_(std::make_shared<std::atomic<bool>>(false)) {
    connection_->stream.socket().async_wait(
        asio::ip::tcp::socket::wait_read, [connection, left = has_left_](const error_code& error) {
          if (error) return;
          char byte = 0;
          error_code problem_of_socket;
          const std::size_t count = connection->stream.socket().receive(
              asio::buffer(&byte, 1), asio::socket_base::message_peek, problem_of_socket);
          *left = problem_of_socket || count == 0;
        });
  }
  ~ClientWatch() {
    error_code ignored;
    connection_->stream.socket().cancel(ignored);
  }
  ClientWatch(const ClientWatch&) = delete;
  ClientWatch& operator=(const ClientWatch&) = delete;
  /// May be asked by any thread, also after the watch has ended.
  std::shared_ptr<const std::atomic<bool>> has_left() const { return has_left_; }

 private:
  std::shared_ptr<Connection> connection_;
  std::shared_ptr<std::atomic<bool>> has_left_;
};

/// The state of one run of run_session.
class Session {
 public:
  Session(std::shared_ptr<Connection> connection, SessionEnvironment& environment)
      : connection_(std::move(connection)),
        stream_(connection_->stream),
        environment_(environment),
        options_(environment.options) {}

  awaitable<void> run();

 private:
  awaitable<bool> wait_for_request();
  awaitable<bool> serve_one();
  awaitable<std::optional<Response>> receive(RequestParser& parser);
  awaitable<std::optional<Response>> receive_body(RequestParser& parser);
  awaitable<Response> answer(const Request& request);
  awaitable<bool> send(Response response, bool keep_alive);
  awaitable<Status> send_parts(Response response, bool keep_alive, std::uint64_t& sent);
  awaitable<Result<std::string>> next_part(const BodyParts& parts);
  awaitable<bool> download(Response response, bool keep_alive, Clock::time_point start);
  awaitable<void> linger();
  void log_answer(unsigned status, std::uint64_t bytes, Clock::time_point start,
                  const std::string& cut_off = {});

  std::shared_ptr<Connection> connection_;
  beast::tcp_stream& stream_;
  SessionEnvironment& environment_;
  const ServerOptions& options_;
  beast::flat_buffer buffer_;
  std::string method_;
  std::string target_;
  std::string body_;                       // of the request
  std::optional<BudgetShare> body_share_;  // held from the header to the answer
  bool is_head_ = false;
  unsigned version_ = 11;
};

awaitable<void> Session::run() {
  for (;;) {
    const bool has_request = co_await wait_for_request();
    if (!has_request) break;
    const bool goes_on = co_await serve_one();
    if (!goes_on) break;
  }
  error_code ignored;
  stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
  stream_.close();
}

/// Waits for the first byte. False when the connection is over.
awaitable<bool> Session::wait_for_request() {
  if (buffer_.size() > 0) {
    connection_->enter(Connection::State::receiving);
    co_return true;
  }
  connection_->enter(Connection::State::idle);
  if (environment_.is_draining) co_return false;
  stream_.expires_after(seconds(options_.idle_seconds));
  error_code error;
  const auto space = buffer_.prepare(kReadBytes);
  const std::size_t count =
      co_await stream_.async_read_some(space, redirect_error(use_awaitable, error));
  connection_->enter(Connection::State::receiving);
  buffer_.commit(count);
  co_return !error && count > 0;
}

/// Reads the header and the body. Returns the problem that ends the connection, if any; a problem
/// without status means that the connection is closed without an answer.
awaitable<std::optional<Response>> Session::receive(RequestParser& parser) {
  const Response silence{0, "", "", {}};
  error_code error;
  stream_.expires_never();
  bool is_late = false;
  {
    const TimeLimit limit(connection_, Clock::now() + seconds(options_.header_seconds));
    co_await http::async_read_header(stream_, buffer_, parser,
                                     redirect_error(use_awaitable, error));
    is_late = limit.is_over();
  }
  method_ = std::string(parser.get().method_string());
  target_ = std::string(parser.get().target());
  is_head_ = parser.get().method() == http::verb::head;
  version_ = parser.get().version() == 10 ? 10 : 11;
  if (is_late) co_return problem(408, "request-timeout", "the header came too slowly");
  if (error) co_return answer_to(error, options_).value_or(silence);
  auto refusal = refusal_of(parser, options_);
  if (refusal) co_return refusal;
  if (lower_case(std::string(parser.get()[http::field::expect])) == "100-continue" &&
      buffer_.size() == 0 && !parser.is_done()) {
    const std::string go_on = "HTTP/1.1 100 Continue\r\n\r\n";
    co_await asio::async_write(stream_, asio::buffer(go_on), redirect_error(use_awaitable, error));
    if (error) co_return silence;
  }
  co_return co_await receive_body(parser);
}

/// Reads the body into body_. The bytes that have arrived, not those that were promised, are taken
/// from the budget for bodies and buy time. Returns as receive() does.
awaitable<std::optional<Response>> Session::receive_body(RequestParser& parser) {
  const Clock::time_point start = Clock::now();
  std::array<char, kReadBytes> piece{};
  body_.clear();
  body_share_.emplace(environment_.bodies, 0);
  stream_.expires_never();
  while (!parser.is_done()) {
    const double allowed =
        options_.body_seconds + static_cast<double>(body_.size()) / options_.body_rate;
    const TimeLimit limit(connection_, start + seconds(allowed));
    parser.get().body().data = piece.data();
    parser.get().body().size = piece.size();
    parser.get().body().more = true;
    error_code error;
    co_await http::async_read_some(stream_, buffer_, parser, redirect_error(use_awaitable, error));
    if (error == http::error::need_buffer) error = {};
    if (limit.is_over()) co_return problem(408, "request-timeout", "the body came too slowly");
    if (error) co_return answer_to(error, options_).value_or(Response{0, "", "", {}});
    body_.append(piece.data(), piece.size() - parser.get().body().size);
    const bool is_small = body_.size() <= kSmallBody;
    if (!is_small && !body_share_->grow_to(body_.size())) {
      co_return busy("too many large requests are being received");
    }
  }
  co_return std::nullopt;
}

/// Answers the request on the threads of its lane.
awaitable<Response> Session::answer(const Request& request) {
  const Clock::time_point deadline = Clock::now() + seconds(options_.answer_seconds);
  const SessionEnvironment& environment = environment_;
  const ClientWatch watch(connection_);
  const CancelPoll is_cancelled = [deadline, &environment, left = watch.has_left()] {
    return environment.is_cancelled || *left || Clock::now() > deadline;
  };
  const Lane lane = environment_.application.lane(request);
  if (lane == Lane::quick) {
    co_return respond_guarded(environment_.application, request, is_cancelled);
  }
  const bool computes = lane == Lane::computing;
  BudgetShare place(computes ? environment_.computing_places : environment_.reading_places, 1);
  if (!place.is_granted()) co_return busy("too many requests are waiting");
  auto& threads = computes ? environment_.computing : environment_.reading;
  const Application& application = environment_.application;
  auto work = [&application, &request, &is_cancelled]() -> awaitable<Response> {
    if (is_cancelled()) co_return busy("the request waited too long");
    co_return respond_guarded(application, request, is_cancelled);
  };
  co_return co_await asio::co_spawn(threads.get_executor(), std::move(work), use_awaitable);
}

/// Serves one request whose first bytes are in the buffer. True when the connection goes on.
awaitable<bool> Session::serve_one() {
  const Clock::time_point start = Clock::now();
  RequestParser parser;
  parser.header_limit(options_.header_bytes);
  parser.body_limit(options_.body_bytes);
  std::optional<Response> refusal = co_await receive(parser);
  if (refusal) {
    if (refusal->status == 0) co_return false;
    log_answer(refusal->status, refusal->body.size(), start);
    co_await send(*std::move(refusal), false);
    co_await linger();
    co_return false;
  }
  const bool keep_alive = parser.get().keep_alive();
  connection_->enter(Connection::State::answering);
  Request request = to_request(parser);
  request.body = std::move(body_);
  stream_.expires_never();
  Response response = co_await answer(request);
  const bool goes_on = keep_alive && !environment_.is_draining;
  body_share_.reset();
  if (response.rest) {
    const bool is_whole = co_await download(std::move(response), goes_on, start);
    co_return is_whole&& goes_on;
  }
  log_answer(response.status, response.body.size(), start);
  const bool is_sent = co_await send(std::move(response), goes_on);
  co_return is_sent&& goes_on;
}

awaitable<bool> Session::send(Response response, bool keep_alive) {
  const double size = static_cast<double>(response.body.size());
  stream_.expires_after(seconds(options_.write_seconds + size / kBytesPerSecond));
  auto message = to_message(std::move(response), is_head_, keep_alive, version_);
  http::serializer<false, http::string_body> serializer{message};
  error_code error;
  if (is_head_) {
    co_await http::async_write_header(stream_, serializer, redirect_error(use_awaitable, error));
  } else {
    co_await http::async_write(stream_, serializer, redirect_error(use_awaitable, error));
  }
  co_return !error;
}

/// Makes the next part on a thread for computing.
awaitable<Result<std::string>> Session::next_part(const BodyParts& parts) {
  if (environment_.is_cancelled) co_return Error{ErrorCode::cancelled, "the server is stopping"};
  using Made = std::optional<Result<std::string>>;  // co_spawn needs a type with a default value
  auto work = [&parts]() -> awaitable<Made> { co_return next_part_guarded(parts); };
  Made made = co_await asio::co_spawn(environment_.computing.get_executor(), std::move(work),
                                      use_awaitable);
  if (!made) co_return Error{ErrorCode::unavailable, "there is no next part"};
  co_return *std::move(made);
}

/// Sends an answer in parts: in chunks, or, in HTTP 1.0, until the connection ends. Each part is
/// made after the one before is sent, so that a slow client takes the memory of one part only.
awaitable<Status> Session::send_parts(Response response, bool keep_alive, std::uint64_t& sent) {
  auto message = head_of<http::buffer_body>(response, keep_alive, version_);
  message.chunked(version_ > 10);
  message.body().data = nullptr;
  message.body().more = true;
  http::serializer<false, http::buffer_body> serializer{message};
  error_code error;
  stream_.expires_after(seconds(options_.write_seconds));
  co_await http::async_write_header(stream_, serializer, redirect_error(use_awaitable, error));
  Result<std::string> part = std::move(response.body);
  while (!error && !is_head_) {
    message.body().data = part->empty() ? nullptr : part->data();
    message.body().size = part->size();
    message.body().more = !part->empty();
    stream_.expires_after(
        seconds(options_.write_seconds + static_cast<double>(part->size()) / kBytesPerSecond));
    co_await http::async_write(stream_, serializer, redirect_error(use_awaitable, error));
    if (error == http::error::need_buffer) error = {};
    if (error || part->empty()) break;
    sent += part->size();
    stream_.expires_never();
    part = co_await next_part(response.rest);
    if (!part) co_return part.error();
  }
  if (error) co_return Error{ErrorCode::unavailable, error.message()};
  co_return Done{};
}

/// Sends an answer in parts, unless too many are being sent. True when the answer is sent and the
/// connection can go on. An answer that is cut off resets the connection, because without chunks
/// the end of the connection alone would look like that of the body.
awaitable<bool> Session::download(Response response, bool keep_alive, Clock::time_point start) {
  const BudgetShare place(environment_.downloads, 1);
  if (!place.is_granted()) {
    Response refusal = busy("too many downloads are running");
    log_answer(refusal.status, refusal.body.size(), start);
    const bool is_sent = co_await send(std::move(refusal), keep_alive);
    co_return is_sent;
  }
  const unsigned status = response.status;
  std::uint64_t sent = 0;
  const Status done = co_await send_parts(std::move(response), keep_alive && version_ > 10, sent);
  log_answer(status, sent, start, done ? std::string() : to_string(done.error()));
  if (done) co_return version_ > 10;
  error_code ignored;
  stream_.socket().set_option(asio::socket_base::linger(true, 0), ignored);
  stream_.close();
  co_return false;
}

/// Reads on for a moment after the answer: closing on unread bytes would reset the connection and
/// could take the answer from the sender.
awaitable<void> Session::linger() {
  error_code error;
  stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, error);
  stream_.expires_after(seconds(kLingerSeconds));
  std::array<char, kReadBytes> sink{};
  std::uint64_t total = 0;
  while (!error && total < kLingerBytes) {
    total +=
        co_await stream_.async_read_some(asio::buffer(sink), redirect_error(use_awaitable, error));
  }
}

void Session::log_answer(unsigned status, std::uint64_t bytes, Clock::time_point start,
                         const std::string& cut_off) {
  const auto milliseconds = static_cast<std::int64_t>(std::llround(seconds_since(start) * 1e3));
  environment_.log("event=request peer=" + connection_->peer + " method=" + quoted(method_) +
                   " target=" + quoted(target_) + " status=" + std::to_string(status) +
                   " bytes=" + std::to_string(bytes) + " ms=" + std::to_string(milliseconds) +
                   (cut_off.empty() ? std::string() : " cut-off=" + quoted(cut_off)));
}

}  // namespace

bool Budget::take(std::uint64_t amount) {
  std::uint64_t left = left_;
  while (left >= amount) {
    if (left_.compare_exchange_weak(left, left - amount)) return true;
  }
  return false;
}

SessionEnvironment::SessionEnvironment(const ServerOptions& server_options,
                                       Application server_application, LogLine server_log)
    : options(server_options),
      application(std::move(server_application)),
      log(std::move(server_log)),
      computing(std::max<std::size_t>(server_options.computing_threads, 1)),
      reading(std::max<std::size_t>(server_options.reading_threads, 1)),
      bodies(server_options.body_bytes_together),
      computing_places(server_options.computing_queue + server_options.computing_threads),
      reading_places(server_options.reading_queue + server_options.reading_threads),
      downloads(server_options.downloads) {}

awaitable<void> run_session(std::shared_ptr<Connection> connection,
                            SessionEnvironment& environment) {
  Session session(std::move(connection), environment);
  co_await session.run();
}

awaitable<void> refuse_session(std::shared_ptr<Connection> connection) {
  connection->stream.expires_after(seconds(kLingerSeconds));
  auto message = to_message(busy("too many connections"), false, false, 11);
  error_code error;
  co_await http::async_write(connection->stream, message, redirect_error(use_awaitable, error));
  connection->stream.socket().shutdown(asio::ip::tcp::socket::shutdown_send, error);
  std::array<char, kReadBytes> sink{};
  while (!error) {
    co_await connection->stream.async_read_some(asio::buffer(sink),
                                                redirect_error(use_awaitable, error));
  }
}

}  // namespace watertight::server
