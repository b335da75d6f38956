// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/checksum.h"

#include <array>

namespace watertight {
namespace {

/// kTables[k][b] is the remainder of byte b with k zero bytes after it. So the remainders of eight
/// bytes are looked up at once, none waiting for another.
constexpr std::size_t kSlices = 8;
constexpr auto kTables = [] {
  std::array<std::array<std::uint32_t, 256>, kSlices> tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? 0x82F63B78U : 0U);
    tables[0][i] = value;
  }
  for (std::size_t slice = 1; slice < kSlices; ++slice) {
    for (std::size_t i = 0; i < 256; ++i) {
      const std::uint32_t before = tables[slice - 1][i];
      tables[slice][i] = (before >> 8) ^ tables[0][before & 0xFF];
    }
  }
  return tables;
}();

}  // namespace

// Source: M. E. Kounavis, F. L. Berry, "Novel table lookup-based algorithms for high-performance
// CRC generation" (IEEE Transactions on Computers, 2008): slicing by 8.
std::uint32_t crc32c(ByteView bytes, std::uint32_t previous) {
  std::uint32_t crc = ~previous;
  for (; bytes.size() >= kSlices; bytes = bytes.subspan(kSlices)) {
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < kSlices; ++i) {
      const std::uint32_t mask = i < 4 ? crc >> (8 * i) : 0;
      next ^= kTables[kSlices - 1 - i][(bytes[i] ^ mask) & 0xFF];
    }
    crc = next;
  }
  for (const std::uint8_t byte : bytes) crc = (crc >> 8) ^ kTables[0][(crc ^ byte) & 0xFF];
  return ~crc;
}

std::uint64_t content_hash(ByteView bytes) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001B3ULL;
  return hash;
}

}  // namespace watertight
