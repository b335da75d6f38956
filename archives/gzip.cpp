// SPDX-License-Identifier: GPL-3.0-or-later
#include "archives/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <climits>
#include <new>

namespace watertight::archives {
namespace {

constexpr int kFast = 2;
constexpr int kWindow = 15 + 16;  // 32 KiB; 16 means a gzip header
constexpr int kMemory = 8;        // zlib's default
constexpr std::size_t kStep = std::size_t{1} << 16U;

/// zlib's state; it has no way to fail but for want of memory.
class Deflater {
 public:
  explicit Deflater(int level) {
    if (deflateInit2(&stream_, level, Z_DEFLATED, kWindow, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;
  ~Deflater() { deflateEnd(&stream_); }

  void add(std::string_view text, bool is_last, std::string& out) {
    // zlib reads from next_in only.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream_.avail_in = static_cast<uInt>(text.size());
    do {
      const std::size_t before = out.size();
      out.resize(before + kStep);
      stream_.next_out = reinterpret_cast<Bytef*>(out.data() + before);
      stream_.avail_out = kStep;
      deflate(&stream_, is_last ? Z_FINISH : Z_NO_FLUSH);
      out.resize(out.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

 private:
  z_stream stream_{};
};

}  // namespace

std::string gzip(std::string_view text, Effort effort) {
  Deflater deflater(effort == Effort::best ? Z_BEST_COMPRESSION : kFast);
  std::string out;
  do {
    const std::string_view part = text.substr(0, INT_MAX);
    text.remove_prefix(part.size());
    deflater.add(part, text.empty(), out);
  } while (!text.empty());
  return out;
}

}  // namespace watertight::archives
