// SPDX-License-Identifier: GPL-3.0-or-later
//
// The body of a request while it arrives. Internal to transport/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace watertight::server {

/// The bytes of a body in pieces, so that none of them is copied when more arrive: one thread
/// receives the bodies of all clients, and the copies of large ones would delay everybody.
class ReceivedBody {
 public:
  /// Space for the next bytes; never empty. Valid until the next call. Cost: constant.
  std::span<char> space();
  /// Adds the first `count` bytes of the space. Requires no more than the space has.
  void add(std::size_t count) { size_ += count; }
  std::uint64_t size() const { return size_; }
  void clear();
  /// The whole body; leaves nothing. Memory: each piece is freed once it is copied.
  /// Cost: linear in the bytes.
  std::string take();

 private:
  std::vector<std::unique_ptr<char[]>> pieces_;
  std::uint64_t size_ = 0;
};

}  // namespace watertight::server
