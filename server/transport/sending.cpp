// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/sending.h"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/http.hpp>
#include <new>
#include <optional>

#include "server/transport/client_watch.h"
#include "server/transport/messages.h"
#include "server/transport/priority.h"

namespace watertight::server {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::awaitable;
using asio::redirect_error;
using asio::use_awaitable;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

Result<std::string> next_part_guarded(const BodyParts& parts, const CancelPoll& is_cancelled) {
  try {
    return parts(is_cancelled);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::limit_exceeded, "not enough memory"};
  } catch (const std::exception& failure) {
    return Error{ErrorCode::unavailable, std::string("unexpected failure: ") + failure.what()};
  }
}

}  // namespace

awaitable<Status> Sender::send(Response response, bool keep_alive) {
  const double size = static_cast<double>(response.body.size());
  stream_.expires_after(seconds(options_.write_seconds + size / options_.write_rate));
  auto message = to_message(std::move(response), is_head_, keep_alive, version_);
  http::serializer<false, http::string_body> serializer{message};
  error_code error;
  if (is_head_) {
    co_await http::async_write_header(stream_, serializer, redirect_error(use_awaitable, error));
  } else {
    co_await http::async_write(stream_, serializer, redirect_error(use_awaitable, error));
  }
  if (error) co_return Error{ErrorCode::unavailable, error.message()};
  co_return Done{};
}

/// Makes the next part on a thread of a lane.
awaitable<Result<std::string>> Sender::next_part(const BodyParts& parts, LaneThreads& lane) {
  if (environment_.is_cancelled) co_return Error{ErrorCode::cancelled, "the server is stopping"};
  using Made = std::optional<Result<std::string>>;  // co_spawn needs a type with a default value
  const SessionEnvironment& environment = environment_;
  const ClientWatch watch(connection_);
  const CancelPoll is_cancelled = [&environment, left = watch.has_left()] {
    return environment.is_cancelled || *left;
  };
  const bool is_long = &lane == &environment_.computing;
  auto work = [&parts, &is_cancelled, is_long]() -> awaitable<Made> {
    if (is_long) step_back();
    co_return next_part_guarded(parts, is_cancelled);
  };
  Made made = co_await asio::co_spawn(lane.threads.get_executor(), std::move(work), use_awaitable);
  if (!made) co_return Error{ErrorCode::unavailable, "there is no next part"};
  co_return *std::move(made);
}

/// The part that follows what was sent of an answer, after the pause that the answer wants.
awaitable<Result<std::string>> Sender::part_after(const Response& response) {
  if (response.pause.count() == 0) {
    auto part = co_await next_part(response.rest, environment_.computing);
    co_return part;
  }
  asio::steady_timer timer(stream_.get_executor(), response.pause);
  error_code ignored;
  co_await timer.async_wait(redirect_error(use_awaitable, ignored));
  if (environment_.is_draining) co_return std::string();
  auto part = co_await next_part(response.rest, environment_.small);
  co_return part;
}

awaitable<Status> Sender::send_parts(Response response, bool keep_alive, std::uint64_t& sent) {
  auto message = head_of<http::buffer_body>(response, keep_alive, version_);
  message.chunked(version_ > 10);
  message.body().data = nullptr;
  message.body().more = true;
  http::serializer<false, http::buffer_body> serializer{message};
  error_code error;
  // The time that the client still has to take what is being sent. Each byte adds to it, a client
  // below write_rate uses write_seconds up, and the time in which parts are made does not count.
  const Clock::duration reserve = seconds(options_.write_seconds);
  Clock::duration left = reserve;
  stream_.expires_after(left);
  co_await http::async_write_header(stream_, serializer, redirect_error(use_awaitable, error));
  Result<std::string> part = std::move(response.body);
  if (part->empty() && !error && !is_head_) {
    stream_.expires_never();
    part = co_await part_after(response);
    if (!part) co_return part.error();
  }
  while (!error && !is_head_) {
    message.body().data = part->empty() ? nullptr : part->data();
    message.body().size = part->size();
    message.body().more = !part->empty();
    left =
        std::min(left, reserve) + seconds(static_cast<double>(part->size()) / options_.write_rate);
    const Clock::time_point begin = Clock::now();
    stream_.expires_after(left);
    co_await http::async_write(stream_, serializer, redirect_error(use_awaitable, error));
    left -= Clock::now() - begin;
    if (error == http::error::need_buffer) error = {};
    if (error || part->empty()) break;
    sent += part->size();
    stream_.expires_never();
    part = co_await part_after(response);
    if (!part) co_return part.error();
  }
  if (error) co_return Error{ErrorCode::unavailable, error.message()};
  co_return Done{};
}

}  // namespace watertight::server
