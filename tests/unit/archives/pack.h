// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compresses texts for tests: gzip, Zstandard, zip.
#pragma once

#include <zlib.h>
#include <zstd.h>

#include <catch2/catch_test_macros.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace watertight::test {

/// One stream of zlib: `window` says which (MAX_WBITS + 16 gzip, -MAX_WBITS raw).
inline std::string deflated(const std::string& text, int window) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 9, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string packed(deflateBound(&stream, text.size()) + 64, '\0');
  std::string in = text;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

inline std::string gzip(const std::string& text) { return deflated(text, MAX_WBITS + 16); }

/// A Zstandard frame with a checksum.
inline std::string zstd(const std::string& text, int window = 0) {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1);
  ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, 0);
  if (window > 0) ZSTD_CCtx_setParameter(context, ZSTD_c_windowLog, window);
  std::string packed(ZSTD_compressBound(text.size()) + 64, '\0');
  ZSTD_inBuffer in{text.data(), text.size(), 0};
  ZSTD_outBuffer out{packed.data(), packed.size(), 0};
  // A frame that is made in one step would have a window no larger than the text.
  if (window > 0) ZSTD_compressStream2(context, &out, &in, ZSTD_e_continue);
  REQUIRE(ZSTD_compressStream2(context, &out, &in, ZSTD_e_end) == 0);
  ZSTD_freeCCtx(context);
  packed.resize(out.pos);
  return packed;
}

/// Makes a zip archive, well formed or not.
struct ZipMaker {
  struct Member {
    std::string name;
    std::string text;
    bool is_stored = false;
    std::uint16_t flags = 0;
    int method = -1;             // another one than that of the data
    std::int64_t size = -1;      // another one than that of the text
    std::int64_t checksum = -1;  // another one than that of the text
  };
  std::vector<Member> members;

  static std::string number(std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text.push_back(static_cast<char>(value >> (8 * i)));
    return text;
  }
  std::string bytes() const {
    std::string all;
    std::string list;
    for (const Member& member : members) {
      const std::string data = member.is_stored ? member.text : deflated(member.text, -MAX_WBITS);
      const auto crc = member.checksum >= 0
                           ? static_cast<std::uint64_t>(member.checksum)
                           : crc32(0, reinterpret_cast<const Bytef*>(member.text.data()),
                                   static_cast<uInt>(member.text.size()));
      const auto size = member.size >= 0 ? static_cast<std::uint64_t>(member.size)
                                         : static_cast<std::uint64_t>(member.text.size());
      const int usual = member.is_stored ? 0 : 8;
      const auto method = static_cast<std::uint64_t>(member.method >= 0 ? member.method : usual);
      const std::string common = number(20, 2) + number(member.flags, 2) + number(method, 2) +
                                 number(0, 4) + number(crc, 4) + number(data.size(), 4) +
                                 number(size, 4) + number(member.name.size(), 2) + number(0, 2);
      list += "PK\x01\x02" + number(20, 2) + common + number(0, 2) + number(0, 2) + number(0, 2) +
              number(0, 4) + number(all.size(), 4) + member.name;
      all += "PK\x03\x04" + common + member.name + data;
    }
    const std::string end = number(0, 2) + number(0, 2) + number(members.size(), 2) +
                            number(members.size(), 2) + number(list.size(), 4) +
                            number(all.size(), 4) + number(0, 2);
    return all + list + "PK\x05\x06" + end;
  }
};

}  // namespace watertight::test
