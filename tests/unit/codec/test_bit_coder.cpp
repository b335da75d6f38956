// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <catch2/catch_test_macros.hpp>

#include "codec/mode_bitmap/bit_coder.h"
#include "tests/generated/generated_solids.h"

using namespace watertight;

TEST_CASE("bits and runs read back in both codings") {
  generated::Random random(11);
  for (int round = 0; round < 300; ++round) {
    const std::uint64_t skew = 1 + random.below(40);
    std::vector<std::array<std::uint64_t, 2>> values;
    for (std::uint64_t i = 0; i < random.below(200); ++i) {
      values.push_back({random.below(skew) == 0 ? 1U : 0U, random.below(5)});
    }
    for (const codec::bitmap::BitCoding coding :
         {codec::bitmap::BitCoding::plain, codec::bitmap::BitCoding::arithmetic}) {
      codec::bitmap::BitEncoder encoder(coding);
      codec::bitmap::AdaptiveBit written[2];
      for (const auto& [bit, run] : values) {
        encoder.bit(bit != 0, written[0]);
        encoder.unary(run, written[1]);
      }
      const Bytes bytes = std::move(encoder).finish();
      codec::bitmap::BitDecoder decoder(bytes, coding);
      codec::bitmap::AdaptiveBit read[2];
      for (const auto& [bit, run] : values) {
        REQUIRE(decoder.bit(read[0]) == (bit != 0));
        REQUIRE(decoder.unary(4, read[1]) == run);
      }
      CHECK(decoder.is_finished());
    }
  }
}

TEST_CASE("rare bits cost little") {
  codec::bitmap::BitEncoder encoder(codec::bitmap::BitCoding::arithmetic);
  codec::bitmap::AdaptiveBit model;
  for (int i = 0; i < 10000; ++i) encoder.bit(i % 1000 == 999, model);
  CHECK(std::move(encoder).finish().size() < 60);
}

TEST_CASE("a decoder past the end reports it") {
  for (const codec::bitmap::BitCoding coding :
       {codec::bitmap::BitCoding::plain, codec::bitmap::BitCoding::arithmetic}) {
    const Bytes bytes{0x12, 0x34};
    codec::bitmap::BitDecoder decoder(bytes, coding);
    for (int i = 0; i < 800; ++i) {
      codec::bitmap::AdaptiveBit even;
      static_cast<void>(decoder.bit(even));
    }
    CHECK(decoder.failed());
    CHECK_FALSE(decoder.is_finished());
  }
}

TEST_CASE("a run beyond its limit fails") {
  codec::bitmap::BitEncoder encoder(codec::bitmap::BitCoding::plain);
  codec::bitmap::AdaptiveBit model;
  encoder.unary(7, model);
  const Bytes bytes = std::move(encoder).finish();
  codec::bitmap::BitDecoder decoder(bytes, codec::bitmap::BitCoding::plain);
  static_cast<void>(decoder.unary(6, model));
  CHECK(decoder.failed());
}
