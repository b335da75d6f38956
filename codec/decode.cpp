// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "codec/page.h"
#include "codec/page/container.h"

namespace watertight::codec {

Result<Decoded> decode(ByteView blob, const Limits& limits) {
  const auto page = read_page_bytes(blob, PageKind::blob, limits);
  if (!page) return page.error();
  return decoded_of(*page, 0);
}

Result<BlobInfo> describe(ByteView blob, const Limits& limits) {
  auto decoded = decode(blob, limits);
  if (!decoded) return decoded.error();
  return std::move(decoded->info);
}

Result<std::vector<Decoded>> decode_page(ByteView page, const Limits& limits) {
  const auto stored = read_page_bytes(page, PageKind::page, limits);
  if (!stored) return stored.error();
  std::vector<Decoded> solids;
  for (std::size_t i = 0; i < stored->contents.solids.size(); ++i) {
    auto decoded = decoded_of(*stored, i);
    if (!decoded) return decoded.error();
    solids.push_back(std::move(decoded).value());
  }
  return solids;
}

}  // namespace watertight::codec
