// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes answers to a connection: whole, or in parts that are made while they are sent. Includes
// Asio: for session.cpp only.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "server/transport/session.h"

namespace watertight::server {

/// So many seconds, as a time of the steady clock.
inline std::chrono::steady_clock::duration seconds(double value) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(value));
}

/// Sends the answer to one request.
class Sender {
 public:
  /// `version` is that of HTTP: 10 or 11.
  Sender(std::shared_ptr<Connection> connection, SessionEnvironment& environment, bool is_head,
         unsigned version)
      : connection_(std::move(connection)),
        stream_(connection_->stream),
        environment_(environment),
        options_(environment.options),
        is_head_(is_head),
        version_(version) {}

  boost::asio::awaitable<Status> send(Response response, bool keep_alive);
  /// Sends an answer in parts: in chunks, or, in HTTP 1.0, until the connection ends. Each part is
  /// made after the one before is sent, so that a slow client takes the memory of one part only.
  /// `sent` is the number of bytes.
  boost::asio::awaitable<Status> send_parts(Response response, bool keep_alive,
                                            std::uint64_t& sent);

 private:
  boost::asio::awaitable<Result<std::string>> next_part(const BodyParts& parts, LaneThreads& lane);
  boost::asio::awaitable<Result<std::string>> part_after(const Response& response);

  std::shared_ptr<Connection> connection_;
  ClientStream& stream_;
  SessionEnvironment& environment_;
  const ServerOptions& options_;
  bool is_head_;
  unsigned version_;
};

}  // namespace watertight::server
