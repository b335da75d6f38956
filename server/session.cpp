// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/session.h"

#include <algorithm>
#include <array>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <cmath>
#include <new>
#include <optional>

#include "base/ascii.h"
#include "server/problem.h"

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
using Parser = http::request_parser<http::string_body>;

constexpr std::size_t kReadBytes = 16 * 1024;
constexpr double kLingerSeconds = 2;  // how long the rest of a request is read after the answer
constexpr std::uint64_t kLingerBytes = 64ULL << 20;
constexpr double kBytesPerSecond = 100e3;  // the slowest client that gets its whole answer

Clock::duration seconds(double value) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(value));
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Response problem(unsigned status, std::string kind, std::string detail) {
  return to_response(Problem{status, std::move(kind), std::move(detail), {}, {}, {}, {}});
}

Response busy(std::string detail) {
  Problem answer{503, "busy", std::move(detail), {}, {}, {}, {}};
  answer.headers.push_back({"Retry-After", "5"});
  return to_response(answer);
}

/// The answer to a request that could not be read; nothing when the connection is simply over.
std::optional<Response> answer_to(const error_code& error, const ServerOptions& options) {
  if (error == http::error::header_limit) {
    return problem(
        431, "header-too-large",
        "the request header is larger than " + std::to_string(options.header_bytes) + " bytes");
  }
  if (error == http::error::body_limit) {
    return problem(
        413, "limit-exceeded",
        "the request body is larger than " + std::to_string(options.body_bytes) + " bytes");
  }
  if (error == http::error::bad_version) {
    return problem(505, "http-version", "this service speaks HTTP/1.1 and HTTP/1.0");
  }
  const bool is_over = error == http::error::end_of_stream ||
                       error == http::error::partial_message ||
                       error.category() != make_error_code(http::error::end_of_stream).category();
  if (is_over) return std::nullopt;
  return problem(400, "malformed", "not an HTTP request: " + error.message());
}

std::string lower(beast::string_view text) {
  return lower_case(std::string_view(text.data(), text.size()));
}

/// The refusal of a header before its body is read; nothing when the header is fine.
std::optional<Response> refusal_of(const Parser& parser) {
  const auto& request = parser.get();
  if (request.version() >= 11 && request.count(http::field::host) != 1) {
    return problem(400, "malformed", "the request needs exactly one Host field");
  }
  const bool takes_body = request.method() == http::verb::post;
  if (takes_body && !parser.chunked() && !parser.content_length()) {
    return problem(411, "length-required",
                   "send Content-Length or Transfer-Encoding: chunked with the body");
  }
  const auto coding = request.find(http::field::content_encoding);
  if (coding != request.end() && lower(coding->value()) != "identity") {
    return problem(415, "unsupported",
                   "this service does not accept Content-Encoding: send the body uncompressed");
  }
  return std::nullopt;
}

Request to_request(http::request<http::string_body>&& message) {
  Request request;
  request.method = std::string(message.method_string());
  request.target = std::string(message.target());
  for (const auto& field : message) {
    request.headers.push_back({lower(field.name_string()), std::string(field.value())});
  }
  request.body = std::move(message.body());
  return request;
}

/// Status and header fields of an answer, except those that state its length.
template <class Body>
http::response<Body> head_of(const Response& response, bool keep_alive, unsigned version) {
  http::response<Body> message;
  message.version(version);
  message.result(response.status);
  message.reason(std::string(reason_phrase(response.status)));
  message.set(http::field::server, "watertight");
  if (!response.content_type.empty()) {
    message.set(http::field::content_type, response.content_type);
  }
  message.set("X-Content-Type-Options", "nosniff");
  for (const HeaderField& field : response.headers) message.insert(field.name, field.value);
  message.keep_alive(keep_alive);
  return message;
}

http::response<http::string_body> to_message(Response&& response, bool is_head, bool keep_alive,
                                             unsigned version) {
  auto message = head_of<http::string_body>(response, keep_alive, version);
  const bool has_no_body = response.status == 204 || response.status == 304;
  if (!has_no_body) message.content_length(response.body.size());
  if (!is_head && !has_no_body) message.body() = std::move(response.body);
  return message;
}

/// The characters of a target or name as one word of a log line.
std::string quoted(std::string_view text) {
  std::string word = "\"";
  for (const char c : text.substr(0, 512)) {
    const bool is_plain = static_cast<unsigned char>(c) >= 0x20 && c != '"' && c != '\\';
    word.push_back(is_plain ? c : '?');
  }
  return word + "\"";
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
  awaitable<std::optional<Response>> receive(Parser& parser);
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
  if (buffer_.size() > 0) co_return true;
  connection_->is_idle = true;
  if (environment_.is_draining) co_return false;
  stream_.expires_after(seconds(options_.idle_seconds));
  error_code error;
  const auto space = buffer_.prepare(kReadBytes);
  const std::size_t count =
      co_await stream_.async_read_some(space, redirect_error(use_awaitable, error));
  connection_->is_idle = false;
  buffer_.commit(count);
  co_return !error && count > 0;
}

/// Reads the header and the body. Returns the problem that ends the connection, if any; a problem
/// without status means that the connection is closed without an answer.
awaitable<std::optional<Response>> Session::receive(Parser& parser) {
  const Response silence{0, "", "", {}};
  error_code error;
  stream_.expires_after(seconds(options_.header_seconds));
  co_await http::async_read_header(stream_, buffer_, parser, redirect_error(use_awaitable, error));
  method_ = std::string(parser.get().method_string());
  target_ = std::string(parser.get().target());
  is_head_ = parser.get().method() == http::verb::head;
  version_ = parser.get().version() == 10 ? 10 : 11;
  if (error) co_return answer_to(error, options_).value_or(silence);
  auto refusal = refusal_of(parser);
  if (refusal) co_return refusal;
  // A chunked body states no length: it may grow to the limit.
  const std::uint64_t expected = parser.content_length()
                                     ? std::uint64_t{*parser.content_length()}
                                     : (parser.chunked() ? options_.body_bytes : 0);
  body_share_.emplace(environment_.bodies, expected);
  if (!body_share_->is_granted()) co_return busy("too many large requests are being received");
  if (lower(parser.get()[http::field::expect]) == "100-continue" && buffer_.size() == 0) {
    const std::string go_on = "HTTP/1.1 100 Continue\r\n\r\n";
    co_await asio::async_write(stream_, asio::buffer(go_on), redirect_error(use_awaitable, error));
    if (error) co_return silence;
  }
  stream_.expires_after(seconds(options_.body_seconds));
  co_await http::async_read(stream_, buffer_, parser, redirect_error(use_awaitable, error));
  if (error) co_return answer_to(error, options_).value_or(silence);
  co_return std::nullopt;
}

/// Answers the request on the threads of its lane.
awaitable<Response> Session::answer(const Request& request) {
  const Clock::time_point deadline = Clock::now() + seconds(options_.answer_seconds);
  const SessionEnvironment& environment = environment_;
  const CancelPoll is_cancelled = [deadline, &environment] {
    return environment.is_cancelled || Clock::now() > deadline;
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
    co_return respond_guarded(application, request, is_cancelled);
  };
  co_return co_await asio::co_spawn(threads.get_executor(), std::move(work), use_awaitable);
}

/// Serves one request whose first bytes are in the buffer. True when the connection goes on.
awaitable<bool> Session::serve_one() {
  const Clock::time_point start = Clock::now();
  Parser parser;
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
  const Request request = to_request(parser.release());
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
