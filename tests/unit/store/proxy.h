// SPDX-License-Identifier: GPL-3.0-or-later
//
// A proxy between client and server on Unix sockets, which breaks the connection at a chosen
// moment.
#pragma once

#include <atomic>
#include <string>
#include <thread>

namespace watertight::test {

class Proxy {
 public:
  enum class Cut {
    none,
    before_commit,  // the server never sees the next COMMIT
    after_commit    // the server commits, but its answer never arrives
  };

  /// Listens on `folder`/.s.PGSQL.5432 and connects clients to `server` (the path of a socket).
  Proxy(const std::string& folder, const std::string& server);
  ~Proxy();
  Proxy(const Proxy&) = delete;
  Proxy& operator=(const Proxy&) = delete;

  /// Breaks the connection at the next COMMIT, once.
  void cut_next(Cut cut) { cut_ = cut; }
  bool has_cut() const { return cut_ == Cut::none; }
  /// Passes nothing on while held, so that the server seems to hang.
  void hold(bool is_held) { is_held_ = is_held; }

 private:
  void serve();
  void pass(int client);

  std::string server_;
  int listener_ = -1;
  std::atomic<Cut> cut_{Cut::none};
  std::atomic<bool> is_held_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace watertight::test
