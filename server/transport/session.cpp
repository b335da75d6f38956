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
#include <limits>
#include <new>
#include <optional>
#include <span>

#include "base/ascii.h"
#include "server/transport/body_coding.h"
#include "server/transport/client_watch.h"
#include "server/transport/messages.h"
#include "server/transport/priority.h"
#include "server/transport/received_body.h"
#include "server/transport/sending.h"

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
constexpr std::size_t kFirstBytes =
    1024;                             // a connection that waits for a request has little memory
constexpr double kLingerSeconds = 2;  // how long the rest of a request is read after the answer
constexpr std::uint64_t kLingerBytes = 64ULL << 20;
constexpr std::size_t kUnbudgeted = 64 * 1024;  // bytes of a body that no budget limits
constexpr std::size_t kSinkBytes = 256 * 1024;  // that a sink gets at once
constexpr std::size_t kDiskThreads = 2;
// A read that waits for a thread is refused when no read was answered for so long: those before it
// hang, and it would too.
constexpr std::chrono::seconds kLongestReadSilence{2};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Response made_guarded(const std::function<Response()>& make) {
  try {
    return make();
  } catch (const std::bad_alloc&) {
    return busy("not enough memory for this request now");
  } catch (const std::exception& failure) {
    return problem(500, "internal", std::string("unexpected failure: ") + failure.what());
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

/// The right to do the works of a key, which nobody else has meanwhile. Passes to the session that
/// has waited longest.
class KeyShare {
 public:
  KeyShare(SessionEnvironment& environment, std::string key,
           const ClientStream::executor_type& executor)
      : environment_(environment), key_(std::move(key)) {
    const auto never = Clock::time_point::max();
    environment_.keys.emplace(key_, std::make_shared<asio::steady_timer>(executor, never));
  }
  ~KeyShare() {
    const auto own = environment_.keys.find(key_);
    if (own == environment_.keys.end()) return;
    if (own->second->cancel_one() == 0) environment_.keys.erase(own);
  }
  KeyShare(const KeyShare&) = delete;
  KeyShare& operator=(const KeyShare&) = delete;

 private:
  SessionEnvironment& environment_;
  std::string key_;
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
  awaitable<std::optional<Response>> hand_to_sink();
  awaitable<Response> answer(Request& request);
  // These take references to objects with names: GCC 12 destroys a temporary object in the argument
  // of a co_await twice.
  awaitable<Response> run(Lane lane, const std::function<Response()>& make,
                          const CancelPoll& cancel);
  awaitable<Response> respond(Request& request, const CancelPoll& cancel);
  awaitable<Response> finish(const std::shared_ptr<const FurtherWork>& first,
                             const CancelPoll& cancel);
  awaitable<bool> download(Response response, bool keep_alive, Clock::time_point start);
  awaitable<void> linger();
  void log_answer(unsigned status, std::uint64_t bytes, Clock::time_point start,
                  const Status& sent);

  std::shared_ptr<Connection> connection_;
  ClientStream& stream_;
  SessionEnvironment& environment_;
  const ServerOptions& options_;
  beast::flat_buffer buffer_;
  std::string method_;
  std::string target_;
  std::string key_;                        // the name of the access key, for the log
  std::string user_;                       // the name that a proxy gives, for the log
  std::string note_;                       // of the answer, for the log
  ReceivedBody body_;                      // of the request, until the request has it
  std::optional<BudgetShare> body_share_;  // held from the header to the answer
  std::shared_ptr<BodySink> sink_;         // where the body goes; null: body_
  std::uint64_t most_bytes_ = 0;           // of the body
  bool is_head_ = false;
  unsigned version_ = 11;
};

awaitable<void> Session::run() {
  if (stream_.is_encrypted()) connection_->enter(Connection::State::receiving);
  stream_.expires_after(seconds(options_.header_seconds));
  bool goes_on = co_await stream_.handshake();
  const bool is_greeted = goes_on;
  while (goes_on) {
    goes_on = co_await wait_for_request();
    if (goes_on) goes_on = co_await serve_one();
  }
  if (is_greeted && stream_.is_encrypted()) {
    stream_.expires_after(seconds(kLingerSeconds));
    co_await stream_.end_sending();
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
  buffer_.shrink_to_fit();
  const auto space = buffer_.prepare(kFirstBytes);
  const std::size_t count =
      co_await stream_.async_read_some(space, redirect_error(use_awaitable, error));
  connection_->enter(Connection::State::receiving);
  buffer_.commit(count);
  // Line ends before a request mean nothing (RFC 9112, section 2.2).
  const std::string_view text(static_cast<const char*>(buffer_.data().data()), buffer_.size());
  buffer_.consume(std::min(text.find_first_not_of("\r\n"), text.size()));
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
  if (environment_.application.admit) {
    Admission admission = environment_.application.admit(to_request(parser));
    key_ = std::move(admission.key);
    user_ = std::move(admission.user);
    if (admission.refusal) co_return std::move(admission.refusal);
    sink_ = std::move(admission.sink);
    if (sink_) most_bytes_ = admission.sink_bytes;
  }
  if (parser.content_length() && *parser.content_length() > most_bytes_) {
    co_return too_large(most_bytes_);
  }
  parser.body_limit(most_bytes_);
  if (lower_case(std::string(parser.get()[http::field::expect])) == "100-continue" &&
      buffer_.size() == 0 && !parser.is_done()) {
    const std::string go_on = "HTTP/1.1 100 Continue\r\n\r\n";
    co_await asio::async_write(stream_, asio::buffer(go_on), redirect_error(use_awaitable, error));
    if (error) co_return silence;
  }
  co_return co_await receive_body(parser);
}

/// Passes what has arrived of the body to the sink, on a thread that may wait for the disk.
awaitable<std::optional<Response>> Session::hand_to_sink() {
  using Taken = std::optional<Response>;
  auto work = [sink = sink_, piece = body_.take()]() -> awaitable<Taken> {
    Taken refusal;
    const Response done = made_guarded([&]() -> Response {
      refusal = sink->take(piece);
      return {};
    });
    if (!refusal && done.status != Response{}.status) refusal = done;
    co_return refusal;
  };
  co_return co_await asio::co_spawn(environment_.disk.get_executor(), std::move(work),
                                    use_awaitable);
}

/// Reads the body into body_, or by way of it into the sink. The bytes that have arrived, not those
/// that were promised, buy time, and those in memory are taken from the budget for bodies. Returns
/// as receive() does.
awaitable<std::optional<Response>> Session::receive_body(RequestParser& parser) {
  const Clock::time_point start = Clock::now();
  body_.clear();
  body_share_.emplace(environment_.bodies, 0);
  const BudgetShare upload(environment_.uploads, sink_ ? 1 : 0);
  if (!upload.is_granted()) co_return busy("too many documents are being uploaded");
  stream_.expires_never();
  std::uint64_t received = 0;
  while (!parser.is_done()) {
    const double allowed =
        options_.body_seconds + static_cast<double>(received) / options_.body_rate;
    const TimeLimit limit(connection_, start + seconds(allowed));
    const std::span<char> space = body_.space();
    parser.get().body().data = space.data();
    parser.get().body().size = space.size();
    parser.get().body().more = true;
    error_code error;
    co_await http::async_read_some(stream_, buffer_, parser, redirect_error(use_awaitable, error));
    if (error == http::error::need_buffer) error = {};
    if (limit.is_over()) co_return problem(408, "request-timeout", "the body came too slowly");
    if (error == http::error::body_limit) co_return too_large(most_bytes_);
    if (error) co_return answer_to(error, options_).value_or(Response{0, "", "", {}});
    const std::size_t count = space.size() - parser.get().body().size;
    body_.add(count);
    received += count;
    connection_->body_bytes = received;
    if (sink_) {
      if (body_.size() < kSinkBytes && !parser.is_done()) continue;
      auto refusal = co_await hand_to_sink();
      if (refusal) co_return refusal;
      continue;
    }
    const bool is_small = body_.size() <= kUnbudgeted;
    if (!is_small && !body_share_->grow_to(body_.size())) {
      co_return busy("too many large requests are being received");
    }
  }
  co_return std::nullopt;
}

/// Makes an answer, or the next step of one, on the threads of a lane.
awaitable<Response> Session::run(Lane lane, const std::function<Response()>& make,
                                 const CancelPoll& cancel) {
  if (lane == Lane::quick) co_return made_guarded(make);
  if (environment_.is_cancelled) co_return busy("the service is stopping");
  LaneThreads& threads = environment_.threads_of(lane);
  const BudgetShare place(threads.places, 1);
  if (!place.is_granted()) co_return busy("too many requests are waiting");
  const bool is_limited = lane != Lane::reading;
  const AddressShare share(environment_.works_of, connection_->peer,
                           is_limited ? options_.works_per_address : 0);
  if (!share.is_granted()) co_return too_many("this address has too many requests in work");
  const Clock::time_point begin = Clock::now();
  auto work = [&make, &cancel, &threads, lane, begin]() -> awaitable<Response> {
    if (lane == Lane::computing) step_back();
    const Clock::time_point silent_since = std::max(begin, threads.last_answer.load());
    const bool is_stuck =
        lane == Lane::reading && Clock::now() - silent_since > kLongestReadSilence;
    if (is_stuck || cancel()) co_return busy("the request waited too long");
    Response response = made_guarded(make);
    if (response.status < 500) threads.last_answer = Clock::now();
    co_return response;
  };
  co_return co_await asio::co_spawn(threads.threads.get_executor(), std::move(work), use_awaitable);
}

/// Does the further works of an answer: from the first one with a key on, after those with the same
/// key that have begun before.
awaitable<Response> Session::finish(const std::shared_ptr<const FurtherWork>& first,
                                    const CancelPoll& cancel) {
  std::shared_ptr<const FurtherWork> work = first;
  std::optional<KeyShare> key;
  for (;;) {
    const bool begins_key = !key && !work->key.empty();
    const auto other = begins_key ? environment_.keys.find(work->key) : environment_.keys.end();
    if (other != environment_.keys.end()) {
      const auto turn = other->second;
      error_code ignored;
      co_await turn->async_wait(redirect_error(use_awaitable, ignored));
    }
    if (begins_key) key.emplace(environment_, work->key, stream_.get_executor());
    const std::function<Response()> make = [&work, &cancel] { return work->make(cancel); };
    Response response = co_await run(work->lane, make, cancel);
    if (!response.further) co_return response;
    work = std::move(response.further);
  }
}

/// Makes the answer, or its first step. A large body is put together where it is used. A compressed
/// body that expands to little is expanded among the small works, and the request goes to the lane
/// of its expanded size. Any other is expanded and used in one computing work, so that no more of
/// them are in memory than there are threads for computing.
awaitable<Response> Session::respond(Request& request, const CancelPoll& cancel) {
  constexpr unsigned kIsExpanded = 0;  // no status of an answer
  const Application& application = environment_.application;
  const auto coding = coding_of(request).value_or(archives::Compression::none);
  const std::uint64_t size = request.body.size() + body_.size();
  const Lane lane = application.lane(request, size);
  if (lane == Lane::quick) body_.clear();
  const auto gather = [&] {
    if (body_.size() > 0) request.body = body_.take();
  };
  const std::function<Response()> make = [&] {
    gather();
    return application.respond(request, cancel);
  };
  const bool is_packed = coding != archives::Compression::none && size > 0;
  if (!is_packed || lane == Lane::quick) {
    Response response = co_await run(lane, make, cancel);
    co_return response;
  }
  const auto has_room = [&](std::uint64_t bytes) {
    return bytes <= kUnbudgeted || body_share_->grow_to(size + bytes);
  };
  const std::function<Response()> expand_little = [&] {
    auto problem = expand_body(request, coding, kUnbudgeted, has_room, cancel);
    return problem ? *std::move(problem) : Response{kIsExpanded, "", "", {}};
  };
  const std::function<Response()> expand_and_make = [&] {
    gather();
    auto problem = expand_body(request, coding, options_.body_bytes, has_room, cancel);
    return problem ? *std::move(problem) : made_guarded(make);
  };
  if (size <= kUnbudgeted) {
    Response little = co_await run(Lane::small, expand_little, cancel);
    if (little.status == kIsExpanded) {
      const Lane expanded_lane = application.lane(request, request.body.size());
      Response response = co_await run(expanded_lane, make, cancel);
      co_return response;
    }
    if (little.status != 413) co_return little;
  }
  Response response = co_await run(Lane::computing, expand_and_make, cancel);
  co_return response;
}

/// Answers the request on the threads of its lane.
awaitable<Response> Session::answer(Request& request) {
  const Clock::time_point deadline = Clock::now() + seconds(options_.answer_seconds);
  const SessionEnvironment& environment = environment_;
  const ClientWatch watch(connection_);
  const CancelPoll is_cancelled = [deadline, &environment, left = watch.has_left()] {
    return environment.is_cancelled || *left || Clock::now() > deadline;
  };
  Response response = co_await respond(request, is_cancelled);
  if (!response.further) co_return response;
  const std::shared_ptr<const FurtherWork> further = std::move(response.further);
  Response made = co_await finish(further, is_cancelled);
  co_return made;
}

/// Serves one request whose first bytes are in the buffer. True when the connection goes on.
awaitable<bool> Session::serve_one() {
  const Clock::time_point start = Clock::now();
  RequestParser parser;
  parser.header_limit(options_.header_bytes);
  parser.body_limit(
      std::numeric_limits<std::uint64_t>::max());  // until it is known where the body goes
  most_bytes_ = options_.body_bytes;
  sink_.reset();
  std::optional<Response> refusal = co_await receive(parser);
  if (refusal) {
    if (refusal->status == 0) {
      const Error left{ErrorCode::cancelled, "the client left before its request was whole"};
      if (!method_.empty()) log_answer(0, 0, start, left);
      co_return false;
    }
    const unsigned status = refusal->status;
    const std::uint64_t size = refusal->body.size();
    Sender sender(connection_, environment_, is_head_, version_);
    const Status sent = co_await sender.send(*std::move(refusal), false);
    log_answer(status, size, start, sent);
    co_await linger();
    co_return false;
  }
  const bool keep_alive = parser.get().keep_alive();
  connection_->enter(Connection::State::answering);
  stream_.expires_never();
  Response response;
  {
    Request request = to_request(parser);
    request.sink = std::move(sink_);
    if (!takes_body(parser)) body_.clear();
    if (body_.size() <= kUnbudgeted) request.body = body_.take();
    response = co_await answer(request);
  }
  body_share_.reset();
  const bool goes_on = keep_alive && !environment_.is_draining;
  if (response.rest) {
    const bool is_whole = co_await download(std::move(response), goes_on, start);
    co_return is_whole&& goes_on;
  }
  const BudgetShare unsent(environment_.bodies,
                           response.body.size() > kUnbudgeted ? response.body.size() : 0);
  if (!unsent.is_granted()) response = busy("too many large answers are being sent");
  const unsigned status = response.status;
  const std::uint64_t size = response.body.size();
  note_ = std::move(response.note);
  Sender sender(connection_, environment_, is_head_, version_);
  const Status sent = co_await sender.send(std::move(response), goes_on);
  log_answer(status, size, start, sent);
  co_return sent.has_value() && goes_on;
}

/// Sends an answer in parts, unless too many are being sent. True when the answer is sent and the
/// connection can go on. An answer that is cut off resets the connection, because without chunks
/// the end of the connection alone would look like that of the body.
awaitable<bool> Session::download(Response response, bool keep_alive, Clock::time_point start) {
  const bool is_watcher = response.pause.count() > 0;
  const BudgetShare place(is_watcher ? environment_.watchers : environment_.downloads, 1);
  Sender sender(connection_, environment_, is_head_, version_);
  if (!place.is_granted()) {
    Response refusal =
        busy(is_watcher ? "too many clients watch jobs" : "too many downloads are running");
    const std::uint64_t size = refusal.body.size();
    const Status sent_refusal = co_await sender.send(std::move(refusal), keep_alive);
    log_answer(503, size, start, sent_refusal);
    co_return sent_refusal.has_value() && keep_alive;
  }
  const unsigned status = response.status;
  std::uint64_t sent = 0;
  const Status done =
      co_await sender.send_parts(std::move(response), keep_alive && version_ > 10, sent);
  log_answer(status, sent, start, done);
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
  stream_.expires_after(seconds(kLingerSeconds));
  co_await stream_.end_sending();
  std::array<char, kReadBytes> sink{};
  std::uint64_t total = 0;
  while (!error && total < kLingerBytes) {
    total +=
        co_await stream_.async_read_some(asio::buffer(sink), redirect_error(use_awaitable, error));
  }
}

void Session::log_answer(unsigned status, std::uint64_t bytes, Clock::time_point start,
                         const Status& sent) {
  const double elapsed = seconds_since(start);
  if (environment_.application.answered) {
    environment_.application.answered({method_, target_, status, bytes, elapsed});
  }
  const auto milliseconds = static_cast<std::int64_t>(std::llround(elapsed * 1e3));
  environment_.log("event=request peer=" + connection_->peer + " method=" + quoted(method_) +
                   " target=" + quoted(target_) + " status=" + std::to_string(status) +
                   " bytes=" + std::to_string(bytes) + " ms=" + std::to_string(milliseconds) +
                   (key_.empty() ? std::string() : " key=" + quoted(key_)) +
                   (user_.empty() ? std::string() : " user=" + quoted(user_)) +
                   (note_.empty() ? std::string() : " note=" + quoted(note_)) +
                   (sent ? std::string() : " cut-off=" + quoted(to_string(sent.error()))));
  key_.clear();
  user_.clear();
  note_.clear();
}

}  // namespace

SessionEnvironment::SessionEnvironment(const ServerOptions& server_options,
                                       Application server_application, LogLine server_log)
    : options(server_options),
      application(std::move(server_application)),
      log(std::move(server_log)),
      computing(server_options.computing_threads, server_options.computing_queue),
      small(server_options.small_threads, server_options.small_queue),
      reading(server_options.reading_threads, server_options.reading_queue),
      items(server_options.item_threads, server_options.item_queue),
      bodies(server_options.body_bytes_together),
      downloads(server_options.downloads),
      watchers(server_options.watchers),
      uploads(server_options.uploads),
      disk(kDiskThreads) {}

awaitable<void> run_session(std::shared_ptr<Connection> connection,
                            SessionEnvironment& environment) {
  Session session(std::move(connection), environment);
  co_await session.run();
}

LaneThreads& SessionEnvironment::threads_of(Lane lane) {
  switch (lane) {
    case Lane::reading:
      return reading;
    case Lane::items:
      return items;
    case Lane::small:
      return small;
    default:
      return computing;
  }
}

awaitable<void> refuse_session(std::shared_ptr<Connection> connection, Response refusal) {
  connection->stream.expires_after(seconds(kLingerSeconds));
  const bool is_greeted = co_await connection->stream.handshake();
  if (!is_greeted) co_return;
  auto message = to_message(std::move(refusal), false, false, 11);
  error_code error;
  co_await http::async_write(connection->stream, message, redirect_error(use_awaitable, error));
  co_await connection->stream.end_sending();
  std::array<char, kReadBytes> sink{};
  while (!error) {
    co_await connection->stream.async_read_some(asio::buffer(sink),
                                                redirect_error(use_awaitable, error));
  }
}

}  // namespace watertight::server
