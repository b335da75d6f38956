// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/client_watch.h"

#include <poll.h>

#include <boost/asio/steady_timer.hpp>
#include <chrono>

namespace watertight::server {
namespace {

using boost::asio::ip::tcp;
using boost::system::error_code;

}  // namespace

struct ClientWatch::Watched {
  explicit Watched(const std::shared_ptr<Connection>& watched_connection)
      : connection(watched_connection), timer(connection->stream.get_executor()) {}
  std::shared_ptr<Connection> connection;
  boost::asio::steady_timer timer;
  bool is_over = false;
  std::atomic<bool> has_left = false;
};

ClientWatch::ClientWatch(const std::shared_ptr<Connection>& connection)
    : watched_(std::make_shared<Watched>(connection)) {
  wait_for_bytes(watched_);
}

ClientWatch::~ClientWatch() {
  watched_->is_over = true;
  watched_->timer.cancel();
  error_code ignored;
  watched_->connection->stream.socket().cancel(ignored);
}

std::shared_ptr<const std::atomic<bool>> ClientWatch::has_left() const {
  return {watched_, &watched_->has_left};
}

void ClientWatch::wait_for_bytes(const std::shared_ptr<Watched>& watched) {
  watched->connection->stream.socket().async_wait(tcp::socket::wait_read,
                                                  [watched](const error_code& error) {
                                                    if (!error && !watched->is_over) look(watched);
                                                  });
}

/// Looks whether the client has closed its side. Behind bytes that wait to be read, no event
/// reports the end, so it is looked for again and again.
void ClientWatch::look(const std::shared_ptr<Watched>& watched) {
  constexpr std::chrono::milliseconds kPause{50};
  pollfd state{watched->connection->stream.socket().native_handle(), POLLRDHUP, 0};
  if (::poll(&state, 1, 0) > 0 && (state.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0) {
    watched->has_left = true;
    return;
  }
  watched->timer.expires_after(kPause);
  watched->timer.async_wait([watched](const error_code& error) {
    if (!error && !watched->is_over) look(watched);
  });
}

}  // namespace watertight::server
