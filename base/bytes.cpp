// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/bytes.h"

#include <array>
#include <bit>
#include <string>

namespace watertight {

ByteView as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string_view as_text(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

namespace {
template <std::size_t count>
void put(Bytes& bytes, std::uint64_t value) {
  std::array<std::uint8_t, count> little;
  for (std::size_t i = 0; i < count; ++i) little[i] = static_cast<std::uint8_t>(value >> (8 * i));
  bytes.insert(bytes.end(), little.begin(), little.end());
}
}  // namespace

void ByteWriter::u16(std::uint16_t value) { put<2>(bytes_, value); }
void ByteWriter::u32(std::uint32_t value) { put<4>(bytes_, value); }
void ByteWriter::u64(std::uint64_t value) { put<8>(bytes_, value); }
void ByteWriter::f64(double value) { u64(std::bit_cast<std::uint64_t>(value)); }

void ByteWriter::varint(std::uint64_t value) {
  while (value >= 0x80) {
    u8(static_cast<std::uint8_t>(value | 0x80));
    value >>= 7;
  }
  u8(static_cast<std::uint8_t>(value));
}

void ByteWriter::zigzag(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  varint((bits << 1) ^ (value < 0 ? ~std::uint64_t{0} : 0));
}

void ByteWriter::append(ByteView bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

bool ByteReader::need(std::size_t count) {
  if (failed_ || remaining() < count) failed_ = true;
  return !failed_;
}

std::uint64_t ByteReader::little_endian(std::size_t count) {
  if (!need(count)) return 0;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    value |= static_cast<std::uint64_t>(bytes_[position_ + i]) << (8 * i);
  }
  position_ += count;
  return value;
}

std::uint8_t ByteReader::u8() { return static_cast<std::uint8_t>(little_endian(1)); }
std::uint16_t ByteReader::u16() { return static_cast<std::uint16_t>(little_endian(2)); }
std::uint32_t ByteReader::u32() { return static_cast<std::uint32_t>(little_endian(4)); }
std::uint64_t ByteReader::u64() { return little_endian(8); }
double ByteReader::f64() { return std::bit_cast<double>(u64()); }

std::uint64_t ByteReader::varint() {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 70; shift += 7) {
    if (!need(1)) return 0;
    const std::uint8_t byte = bytes_[position_];
    const bool overflows = shift == 63 && byte > 1;
    const bool is_padded = shift > 0 && byte == 0;
    if (overflows || is_padded) break;
    ++position_;
    value |= static_cast<std::uint64_t>(byte & 0x7F) << shift;
    if (byte < 0x80) return value;
  }
  failed_ = true;
  return 0;
}

std::int64_t ByteReader::zigzag() {
  const std::uint64_t bits = varint();
  return static_cast<std::int64_t>((bits >> 1) ^ (~(bits & 1) + 1));
}

ByteView ByteReader::take(std::size_t count) {
  if (!need(count)) return {};
  const ByteView view = bytes_.subspan(position_, count);
  position_ += count;
  return view;
}

Error ByteReader::error(std::string_view what) const {
  return {ErrorCode::malformed, "truncated or malformed " + std::string(what), position_};
}

}  // namespace watertight
