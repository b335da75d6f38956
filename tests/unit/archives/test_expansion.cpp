// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "archives/expansion.h"
#include "tests/unit/archives/pack.h"

namespace watertight {
namespace {

using archives::Compression;

/// A source that gives a text in pieces of `step` bytes.
ByteSource in_pieces(std::string text, std::size_t step) {
  return [text = std::move(text), step,
          at = std::size_t{0}](std::span<std::uint8_t> bytes) mutable -> Result<std::size_t> {
    const std::size_t count = std::min({step, bytes.size(), text.size() - at});
    std::copy_n(text.begin() + static_cast<std::ptrdiff_t>(at), count, bytes.begin());
    at += count;
    return count;
  };
}

/// All bytes of a source, in pieces of `room` bytes.
Result<std::string> all_of(const ByteSource& source, std::size_t room = 1000) {
  std::string text;
  Bytes piece(room);
  for (;;) {
    const auto count = source(piece);
    if (!count) return count.error();
    if (*count == 0) return text;
    text.append(piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(*count));
  }
}

Result<std::string> expand(const std::string& packed, Compression compression,
                           const archives::ExpansionLimit& limit = {}) {
  return all_of(archives::expanded(in_pieces(packed, 4096), compression, limit));
}

std::string sample() {
  std::string text;
  for (int i = 0; i < 300; ++i) text.append("[").append(std::to_string(i * i)).append(",0,1],");
  return text;
}

const std::pair<Compression, std::string (*)(const std::string&)> kBoth[] = {
    {Compression::gzip, test::gzip},
    {Compression::zstd, [](const std::string& text) { return test::zstd(text); }}};

TEST_CASE("the first bytes show the compression") {
  CHECK(archives::compression_of(as_bytes(test::gzip("a"))) == Compression::gzip);
  CHECK(archives::compression_of(as_bytes(test::zstd("a"))) == Compression::zstd);
  CHECK(archives::compression_of(as_bytes(std::string("\x5A\x2A\x4D\x18\0\0\0\0", 8))) ==
        Compression::zstd);
  CHECK(archives::compression_of(as_bytes("PK\x03\x04")) == Compression::zip);
  CHECK(archives::compression_of(as_bytes("PK\x05\x06")) == Compression::zip);
  for (const std::string text : {"", "P", "PK", "{\"type\"", "\x1F", "WT\x02", "\x28\xB5\x2F"}) {
    CHECK(archives::compression_of(as_bytes(text)) == Compression::none);
  }
}

TEST_CASE("compressed bytes are expanded however they arrive") {
  const std::string text = sample();
  for (const auto& [compression, pack] : kBoth) {
    for (const std::size_t step : {std::size_t{1}, std::size_t{7}, std::size_t{1} << 20U}) {
      for (const std::size_t room : {std::size_t{1}, std::size_t{100}, std::size_t{1} << 20U}) {
        const auto back =
            all_of(archives::expanded(in_pieces(pack(text), step), compression), room);
        REQUIRE(back);
        CHECK(*back == text);
      }
    }
    CHECK(*expand(pack(""), compression) == "");
  }
}

TEST_CASE("members and frames that follow each other are one input") {
  for (const auto& [compression, pack] : kBoth) {
    const auto back = expand(pack("ab") + pack("") + pack("c"), compression);
    REQUIRE(back);
    CHECK(*back == "abc");
  }
  const std::string skippable("\x50\x2A\x4D\x18\x02\0\0\0xy", 10);
  const auto back = expand(skippable + test::zstd("c"), Compression::zstd);
  REQUIRE(back);
  CHECK(*back == "c");
}

TEST_CASE("every truncation is an error with its place") {
  for (const auto& [compression, pack] : kBoth) {
    const std::string packed = pack(sample());
    for (std::size_t size = 0; size < packed.size(); ++size) {
      const auto back = expand(packed.substr(0, size), compression);
      INFO(size << " of " << packed.size());
      REQUIRE_FALSE(back);
      CHECK(back.error().code == ErrorCode::malformed);
      REQUIRE(back.error().byte_offset);
      CHECK(*back.error().byte_offset <= size);
    }
  }
}

TEST_CASE("a changed byte never gives another text") {
  const std::string text = sample();
  for (const auto& [compression, pack] : kBoth) {
    const std::string packed = pack(text);
    for (std::size_t at = 0; at < packed.size(); ++at) {
      std::string broken = packed;
      broken[at] = static_cast<char>(broken[at] ^ 0x24);
      const auto back = expand(broken, compression);
      INFO(at);
      if (back) CHECK(*back == text);  // a time or a name in a head, which nothing depends on
    }
  }
}

TEST_CASE("bytes after the end are an error") {
  for (const auto& [compression, pack] : kBoth) {
    const std::string packed = pack("a");
    const auto back = expand(packed + "{}", compression);
    REQUIRE_FALSE(back);
    CHECK(back.error().code == ErrorCode::malformed);
    CHECK(*back.error().byte_offset >= packed.size());
  }
}

TEST_CASE("the limit is the larger one of bytes and ratio") {
  const std::string zeros(1'000'000, '0');
  for (const auto& [compression, pack] : kBoth) {
    const std::string packed = pack(zeros);  // far below a hundredth
    CHECK(expand(packed, compression, {1'000'000, 0}));
    const auto over = expand(packed, compression, {999'999, 0});
    REQUIRE_FALSE(over);
    CHECK(over.error().code == ErrorCode::limit_exceeded);
    CHECK(over.error().message.find("999999 bytes") != std::string::npos);
    CHECK_FALSE(expand(packed, compression, {10'000, 100}));
    CHECK(expand(packed, compression, {10'000, 100'000}));
  }
}

TEST_CASE("an error of the source is the error, and it repeats") {
  const auto failing = [](std::span<std::uint8_t>) -> Result<std::size_t> {
    return Error{ErrorCode::unavailable, "gone"};
  };
  const ByteSource source = archives::expanded(failing, Compression::gzip);
  for (int i = 0; i < 2; ++i) {
    const auto back = all_of(source);
    REQUIRE_FALSE(back);
    CHECK(back.error().message == "gone");
  }
}

TEST_CASE("a window that is too large is a limit, not broken data") {
  std::string text;
  std::uint32_t state = 1;
  while (text.size() < (std::size_t{1} << 21U)) {
    state = state * 1664525U + 1013904223U;
    text.push_back(static_cast<char>(state >> 24U));
  }
  const std::string packed = test::zstd(text, 25);
  CHECK(expand(packed, Compression::zstd));
  const auto back = all_of(
      archives::expanded(in_pieces(packed, 4096), Compression::zstd, {}, archives::kWindowOfHttp));
  REQUIRE_FALSE(back);
  CHECK(back.error().code == ErrorCode::limit_exceeded);
}

}  // namespace
}  // namespace watertight
