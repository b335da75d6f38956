// SPDX-License-Identifier: GPL-3.0-or-later
#include "packing/zstandard_frame.h"

#include <zstd.h>

#include <memory>

namespace watertight::packing {
namespace {

constexpr int kWindowLog = 27;  // 128 MiB, as in the frames of Watertight files

struct Free {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

Error malformed(std::string_view message) {
  return Error{ErrorCode::malformed, std::string("a packed text: ").append(message), {}, {}};
}

}  // namespace

Result<std::string> unpack_frame(ByteView frame, std::uint64_t most_bytes) {
  const std::unique_ptr<ZSTD_DCtx, Free> context(ZSTD_createDCtx());
  if (context == nullptr ||
      ZSTD_isError(ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kWindowLog)) != 0) {
    return Error{ErrorCode::limit_exceeded, "no memory to read a packed text"};
  }
  std::string text;
  ZSTD_inBuffer in{frame.data(), frame.size(), 0};
  for (;;) {
    const std::size_t size = text.size();
    text.resize(size + ZSTD_DStreamOutSize());
    ZSTD_outBuffer out{text.data() + size, text.size() - size, 0};
    const std::size_t more = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(more) != 0) return malformed(ZSTD_getErrorName(more));
    const bool is_full = out.pos == out.size;
    text.resize(size + out.pos);
    if (text.size() > most_bytes) {
      return Error{ErrorCode::limit_exceeded,
                   "a packed text of more than " + std::to_string(most_bytes) + " bytes"};
    }
    if (more == 0) break;
    if (in.pos == in.size && !is_full) return malformed("truncated");
  }
  if (in.pos != in.size) return malformed("bytes after its end");
  return text;
}

}  // namespace watertight::packing
