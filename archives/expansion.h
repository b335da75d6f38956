// SPDX-License-Identifier: GPL-3.0-or-later
//
// Expands gzip and Zstandard while it is read, in bounded memory. Both are verified: a checksum or
// a length that does not fit is an error, and so is an end that comes too early.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/byte_source.h"
#include "base/bytes.h"

namespace watertight::archives {

enum class Compression : std::uint8_t { none, gzip, zstd, zip };

/// The name as messages have it: "gzip", "zstd", "zip"; "" for none.
std::string_view to_string(Compression compression);

/// The bytes that are enough for compression_of().
inline constexpr std::size_t kMagicBytes = 4;

/// The compression by the first bytes of an input.
Compression compression_of(ByteView first);

/// The most that something may expand to: the larger one of both.
struct ExpansionLimit {
  std::uint64_t bytes = 256ULL << 20;  // in any case
  std::uint64_t ratio = 100;           // for each compressed byte; 0: `bytes` alone counts

  std::uint64_t most(std::uint64_t packed_bytes) const;
};

/// The largest window of Zstandard that is read. The first is what `zstd` reads by default; RFC
/// 9659 gives the second for HTTP.
inline constexpr int kWindowOfFiles = 27;  // 128 MiB, as an exponent of two
inline constexpr int kWindowOfHttp = 23;   // 8 MiB

/// A source of the expanded bytes of `packed`: gzip members or Zstandard frames, one after the
/// other. Errors of the source, which repeat: those of `packed`; malformed and limit_exceeded with
/// the byte offset in the compressed bytes. Memory: 64 KiB, and for Zstandard the window. Requires
/// gzip or zstd. Not thread-safe.
ByteSource expanded(ByteSource packed, Compression compression, const ExpansionLimit& limit = {},
                    int window = kWindowOfFiles);

}  // namespace watertight::archives
