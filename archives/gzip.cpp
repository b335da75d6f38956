// SPDX-License-Identifier: GPL-3.0-or-later
#include "archives/gzip.h"

#include <zlib.h>

#include <climits>
#include <memory>

namespace watertight::archives {
namespace {

constexpr int kFast = 2;
constexpr int kWindow = 15 + 16;  // 32 KiB; 16 means a gzip header
constexpr int kMemory = 8;        // zlib's default
constexpr std::size_t kStep = std::size_t{1} << 16U;

/// Compresses a part of a text of at most INT_MAX bytes.
void add(z_stream& stream, std::string_view part, bool is_last, std::string& out) {
  // zlib reads from next_in only.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(part.data()));
  stream.avail_in = static_cast<uInt>(part.size());
  do {
    const std::size_t before = out.size();
    out.resize(before + kStep);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    stream.avail_out = kStep;
    deflate(&stream, is_last ? Z_FINISH : Z_NO_FLUSH);
    out.resize(out.size() - stream.avail_out);
  } while (stream.avail_out == 0);
}

}  // namespace

Result<std::string> gzip(std::string_view text, Effort effort) {
  z_stream stream{};
  const int level = effort == Effort::best ? Z_BEST_COMPRESSION : kFast;
  if (deflateInit2(&stream, level, Z_DEFLATED, kWindow, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
    return Error{ErrorCode::unavailable, "there is no memory to compress"};
  }
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, deflateEnd);
  std::string out;
  do {
    const std::string_view part = text.substr(0, INT_MAX);
    text.remove_prefix(part.size());
    add(stream, part, text.empty(), out);
  } while (!text.empty());
  return out;
}

}  // namespace watertight::archives
