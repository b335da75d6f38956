// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <memory>

#include "server/transport/session.h"

namespace watertight::server {

/// Notices that a client has closed its side of the connection while its request is answered. Does
/// not read: bytes that come are those of the next request. Only for the stream's executor.
class ClientWatch {
 public:
  explicit ClientWatch(const std::shared_ptr<Connection>& connection);
  ~ClientWatch();
  ClientWatch(const ClientWatch&) = delete;
  ClientWatch& operator=(const ClientWatch&) = delete;
  /// May be asked by any thread, also after the watch has ended.
  std::shared_ptr<const std::atomic<bool>> has_left() const;

 private:
  struct Watched;
  static void wait_for_bytes(const std::shared_ptr<Watched>& watched);
  static void look(const std::shared_ptr<Watched>& watched);

  std::shared_ptr<Watched> watched_;
};

}  // namespace watertight::server
