// SPDX-License-Identifier: GPL-3.0-or-later
//
// Byte strings and the two cursors that read and write them: little-endian integers, IEEE doubles
// and variable-length integers. The reader trusts nothing: every read is checked against the end.
// For the codec, EWKB, worker frames and the SQL bridge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace watertight {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// Views a text as bytes, or bytes as a text. No copy.
ByteView as_bytes(std::string_view text);
std::string_view as_text(ByteView bytes);

/// Appends to a byte string. Integers are little-endian.
class ByteWriter {
 public:
  void u8(std::uint8_t value) { bytes_.push_back(value); }
  void u16(std::uint16_t value);
  void u32(std::uint32_t value);
  void u64(std::uint64_t value);
  void f64(double value);
  /// Writes LEB128: seven bits a byte, low bits first, 1 to 10 bytes.
  void varint(std::uint64_t value);
  /// Writes zigzag (0, -1, 1, -2, ...) as LEB128.
  void zigzag(std::int64_t value);
  void append(ByteView bytes);

  std::size_t size() const { return bytes_.size(); }
  const Bytes& bytes() const& { return bytes_; }
  Bytes&& bytes() && { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Reads a byte string from the front. A read past the end yields 0 (or an empty view) and sets
/// failed(); the caller checks once per group of reads.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : bytes_(bytes) {}

  std::uint8_t u8();
  std::uint16_t u16();
  std::uint32_t u32();
  std::uint64_t u64();
  double f64();
  /// Reads LEB128. Fails on more than 10 bytes, on overflow and on a non-minimal form (one value,
  /// one encoding).
  std::uint64_t varint();
  std::int64_t zigzag();
  ByteView take(std::size_t count);

  bool failed() const { return failed_; }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }
  /// The error "truncated or malformed <what>" at the position of the first failed read.
  Error error(std::string_view what) const;

 private:
  bool need(std::size_t count);
  std::uint64_t little_endian(std::size_t count);

  ByteView bytes_;
  std::size_t position_ = 0;
  bool failed_ = false;
};

}  // namespace watertight
