// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/received_body.h"

#include <algorithm>

namespace watertight::server {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{64} << 10U;

}  // namespace

std::span<char> ReceivedBody::space() {
  const std::size_t used = size_ % kPieceBytes;
  if (size_ == pieces_.size() * kPieceBytes) {
    pieces_.push_back(std::make_unique_for_overwrite<char[]>(kPieceBytes));
  }
  return {pieces_.back().get() + used, kPieceBytes - used};
}

void ReceivedBody::clear() {
  pieces_.clear();
  size_ = 0;
}

std::string ReceivedBody::take() {
  std::string body;
  body.reserve(size_);
  for (std::unique_ptr<char[]>& piece : pieces_) {
    body.append(piece.get(), std::min<std::uint64_t>(kPieceBytes, size_ - body.size()));
    piece.reset();
  }
  clear();
  return body;
}

}  // namespace watertight::server
