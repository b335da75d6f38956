// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/text/packed_text.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace watertight::formats {
namespace {

constexpr int kLevel = 15;      // twice the time of level 9, 3 % smaller; a fifth of that of 19
constexpr int kWindowLog = 27;  // 128 MiB, the default limit of the zstd tool
constexpr std::array<std::uint8_t, 4> kMagic{0x28, 0xB5, 0x2F, 0xFD};

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

Error malformed(std::string message) {
  return Error{ErrorCode::malformed, std::move(message), {}, {}};
}

}  // namespace

Result<PackedText> pack_text(std::string_view text) {
  // A new context takes longer than the compression of a small text.
  thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  Bytes packed(ZSTD_compressBound(text.size()));
  const std::size_t size = context == nullptr
                               ? static_cast<std::size_t>(-1)
                               : ZSTD_compressCCtx(context.get(), packed.data(), packed.size(),
                                                   text.data(), text.size(), kLevel);
  if (ZSTD_isError(size) != 0) {
    return Error{ErrorCode::limit_exceeded, "no memory to compress a text"};
  }
  packed.resize(size);
  packed.shrink_to_fit();
  return PackedText{std::move(packed)};
}

Result<std::string> unpack_text(ByteView packed, std::uint64_t most_bytes) {
  const bool is_frame =
      packed.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), packed.begin());
  if (!is_frame) return malformed("compressed text: not a Zstandard frame");
  const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  if (context == nullptr ||
      ZSTD_isError(ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kWindowLog)) != 0) {
    return Error{ErrorCode::limit_exceeded, "no memory to decompress a text"};
  }
  std::string text;
  std::string chunk(ZSTD_DStreamOutSize(), '\0');
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  for (;;) {
    ZSTD_outBuffer out{chunk.data(), chunk.size(), 0};
    const std::size_t more = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(more) != 0) {
      return malformed(std::string("compressed text: ").append(ZSTD_getErrorName(more)));
    }
    if (out.pos > most_bytes - text.size()) {
      return Error{ErrorCode::limit_exceeded,
                   "a compressed text of more than " + std::to_string(most_bytes) + " bytes"};
    }
    text.append(chunk, 0, out.pos);
    if (more == 0) break;
    if (in.pos == in.size && out.pos < out.size) return malformed("compressed text: truncated");
  }
  if (in.pos != in.size) return malformed("compressed text: bytes after its end");
  return text;
}

}  // namespace watertight::formats
