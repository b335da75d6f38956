// SPDX-License-Identifier: GPL-3.0-or-later
//
// A client on a plain socket, for the tests of the server.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <catch2/catch_test_macros.hpp>
#include <cstdint>
#include <string>

namespace watertight {

/// A client on a plain socket; it waits at most ten seconds for any event.
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{10, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    REQUIRE(::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(const std::string& text) const {
    ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }
  /// Receives all bytes up to the end of the connection.
  std::string receive_all() const {
    std::string text;
    while (receive_some(text)) {
    }
    return text;
  }
  bool receive_at_least(std::size_t bytes, std::string& text) const {
    while (text.size() < bytes) {
      if (!receive_some(text)) return false;
    }
    return true;
  }
  /// Receives one answer up to the end of its body, by its Content-Length.
  std::string receive_answer() const {
    std::string text;
    for (;;) {
      const std::size_t end = text.find("\r\n\r\n");
      const std::size_t field = text.find("Content-Length: ");
      if (end != std::string::npos && field != std::string::npos) {
        const std::size_t length = std::stoul(text.substr(field + 16));
        if (text.size() >= end + 4 + length) return text;
      }
      if (!receive_some(text)) return text;
    }
  }

 private:
  bool receive_some(std::string& text) const {
    char buffer[4096];
    const ssize_t count = ::recv(socket_, buffer, sizeof buffer, 0);
    if (count > 0) text.append(buffer, static_cast<std::size_t>(count));
    return count > 0;
  }
  int socket_;
};

}  // namespace watertight
