// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cstdint>
#include <limits>

#include "base/bytes.h"
#include "base/checksum.h"

using namespace watertight;

TEST_CASE("integers and doubles read back as written") {
  ByteWriter writer;
  const std::int64_t signed_values[] = {0,
                                        -1,
                                        1,
                                        63,
                                        -64,
                                        64,
                                        std::numeric_limits<std::int64_t>::min(),
                                        std::numeric_limits<std::int64_t>::max()};
  const std::uint64_t values[] = {0,     127,   128,
                                  16383, 16384, std::numeric_limits<std::uint64_t>::max()};
  for (const auto value : signed_values) writer.zigzag(value);
  for (const auto value : values) writer.varint(value);
  writer.u16(0xBEEF);
  writer.f64(-0.125);
  ByteReader reader(writer.bytes());
  for (const auto value : signed_values) CHECK(reader.zigzag() == value);
  for (const auto value : values) CHECK(reader.varint() == value);
  CHECK(reader.u16() == 0xBEEF);
  CHECK(reader.f64() == -0.125);
  CHECK_FALSE(reader.failed());
  CHECK(reader.remaining() == 0);
}

TEST_CASE("a read past the end fails once and for all") {
  const Bytes bytes{1, 2, 3};
  ByteReader reader(bytes);
  CHECK(reader.u32() == 0);
  CHECK(reader.failed());
  CHECK(reader.u8() == 0);
  CHECK(reader.error("header").byte_offset == 0);
}

TEST_CASE("a varint has one encoding only") {
  for (const Bytes& bytes : {Bytes{0x80, 0x00}, Bytes(11, 0xFF),
                             Bytes{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x02}}) {
    ByteReader reader(bytes);
    static_cast<void>(reader.varint());
    CHECK(reader.failed());
  }
}

TEST_CASE("checksums match their published check values") {
  CHECK(crc32c(as_bytes("123456789")) == 0xE3069283U);
  CHECK(content_hash(as_bytes("")) == 0xCBF29CE484222325ULL);
  CHECK(content_hash(as_bytes("a")) == 0xAF63DC4C8601EC8CULL);
}

TEST_CASE("a checksum of any length is the remainder bit by bit, also in parts") {
  std::string text;
  std::uint32_t remainder = 0xFFFFFFFFU;
  for (unsigned i = 0; i < 100; ++i) {
    INFO(i);
    REQUIRE(crc32c(as_bytes(text)) == ~remainder);
    const std::uint32_t head = crc32c(as_bytes(text).first(text.size() / 3));
    REQUIRE(crc32c(as_bytes(text).subspan(text.size() / 3), head) == ~remainder);
    text += static_cast<char>(37 * i + 11);
    remainder ^= static_cast<unsigned char>(text.back());
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1) != 0 ? 0x82F63B78U : 0U);
    }
  }
}
