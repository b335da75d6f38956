// SPDX-License-Identifier: GPL-3.0-or-later
#include "proxy.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <cstring>
#include <string_view>

namespace watertight::test {
namespace {

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
  return address;
}

int connect_to(const std::string& path) {
  const int connection = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_un address = address_of(path);
  if (connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    close(connection);
    return -1;
  }
  return connection;
}

bool is_readable(int descriptor, int milliseconds) {
  pollfd wanted{descriptor, POLLIN, 0};
  return poll(&wanted, 1, milliseconds) == 1;
}

}  // namespace

Proxy::Proxy(const std::string& folder, const std::string& server) : server_(server) {
  listener_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_un address = address_of(folder + "/.s.PGSQL.5432");
  REQUIRE(bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0);
  REQUIRE(listen(listener_, 8) == 0);
  thread_ = std::thread([this] { serve(); });
}

Proxy::~Proxy() {
  stop_ = true;
  thread_.join();
  close(listener_);
}

void Proxy::serve() {
  while (!stop_) {
    if (!is_readable(listener_, 20)) continue;
    const int client = accept(listener_, nullptr, nullptr);
    if (client < 0) continue;
    pass(client);  // the store under test has one connection, so one at a time is enough
    close(client);
  }
}

void Proxy::pass(int client) {
  const int server = connect_to(server_);
  if (server < 0) return;
  std::array<char, 65536> buffer{};
  std::array<pollfd, 2> ends{pollfd{client, POLLIN, 0}, pollfd{server, POLLIN, 0}};
  for (bool open = true; open && !stop_;) {
    if (poll(ends.data(), ends.size(), 20) <= 0) continue;
    if (is_held_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      continue;
    }
    for (std::size_t from = 0; open && from < 2; ++from) {
      if (ends[from].revents == 0) continue;
      const ssize_t count = read(ends[from].fd, buffer.data(), buffer.size());
      const std::string_view data(buffer.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
      open = count > 0;
      const bool commits = from == 0 && cut_ != Cut::none &&
                           data.find(std::string_view("COMMIT\0", 7)) != std::string_view::npos;
      const Cut cut = commits ? cut_.exchange(Cut::none) : Cut::none;
      if (cut == Cut::before_commit) open = false;
      if (open && write(ends[1 - from].fd, data.data(), data.size()) != count) open = false;
      if (cut == Cut::after_commit) {
        // Waits for the server's answer: the commit is on the disk, but the client does not hear of
        // it.
        is_readable(server, 5000);
        open = false;
      }
    }
  }
  close(server);
}

}  // namespace watertight::test
