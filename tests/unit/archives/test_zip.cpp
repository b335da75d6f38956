// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "archives/zip.h"
#include "tests/unit/archives/pack.h"

namespace watertight {
namespace {

using test::ZipMaker;

archives::RandomBytes random(const std::string& text) {
  return {text.size(), [text](std::uint64_t offset, std::span<std::uint8_t> bytes) {
            const std::size_t at = std::min<std::size_t>(offset, text.size());
            const std::size_t count = std::min(bytes.size(), text.size() - at);
            std::copy_n(text.begin() + static_cast<std::ptrdiff_t>(at), count, bytes.begin());
            return Result<std::size_t>(count);
          }};
}

Result<std::string> read(const std::string& zip, const archives::ZipMember& member,
                         const archives::ExpansionLimit& limit = {}) {
  auto source = archives::open_member(
      random(zip), member, std::make_shared<archives::ExpansionCount>(limit, zip.size()));
  if (!source) return std::move(source).error();
  std::string text;
  Bytes piece(777);
  for (;;) {
    const auto count = (*source)(piece);
    if (!count) return count.error();
    if (*count == 0) return text;
    text.append(piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(*count));
  }
}

/// The text of the only member.
Result<std::string> read_one(const ZipMaker& maker) {
  const std::string zip = maker.bytes();
  const auto members = archives::zip_members(random(zip));
  REQUIRE(members);
  REQUIRE(members->size() == 1);
  return read(zip, members->front());
}

const std::string kText(100'000, 'a');

TEST_CASE("members of a zip are read, stored or deflated") {
  const std::string zip =
      ZipMaker{{{"a/b.json", kText}, {"a/", "", true}, {"c", "xyz", true}, {"empty", ""}}}.bytes();
  const auto members = archives::zip_members(random(zip));
  REQUIRE(members);
  REQUIRE(members->size() == 3);
  CHECK((*members)[0].name == "a/b.json");
  CHECK((*members)[0].size == kText.size());
  CHECK(*read(zip, (*members)[0]) == kText);
  CHECK((*members)[1].name == "c");
  CHECK(*read(zip, (*members)[1]) == "xyz");
  CHECK(*read(zip, (*members)[2]) == "");
}

TEST_CASE("a zip that is cut off is an error") {
  const std::string zip = ZipMaker{{{"a.json", "{\"a\":1}"}, {"b.json", kText}}}.bytes();
  for (std::size_t size = 0; size < zip.size(); ++size) {
    const auto members = archives::zip_members(random(zip.substr(0, size)));
    INFO(size << " of " << zip.size());
    REQUIRE_FALSE(members);
    CHECK(members.error().code == ErrorCode::malformed);
  }
}

TEST_CASE("a changed byte of a zip never gives another text") {
  const std::string zip = ZipMaker{{{"a.json", "{\"a\":[1,2,3,4,5,6,7,8]}"}}}.bytes();
  for (std::size_t at = 0; at < zip.size(); ++at) {
    for (const unsigned change : {1U, 0x80U}) {
      std::string broken = zip;
      broken[at] = static_cast<char>(static_cast<unsigned char>(broken[at]) ^ change);
      const auto members = archives::zip_members(random(broken));
      INFO(at);
      if (!members) continue;
      for (const auto& member : *members) {
        const auto text = read(broken, member);
        if (text) CHECK(*text == "{\"a\":[1,2,3,4,5,6,7,8]}");
      }
    }
  }
}

TEST_CASE("an archive without files is an error") {
  const auto empty = archives::zip_members(random(ZipMaker{}.bytes()));
  REQUIRE_FALSE(empty);
  CHECK(empty.error().message.find("no members") != std::string::npos);
  CHECK_FALSE(archives::zip_members(random(ZipMaker{{{"a/", "", true}}}.bytes())));
  const auto twice = archives::zip_members(random(ZipMaker{{{"a", "1"}, {"a", "2"}}}.bytes()));
  REQUIRE_FALSE(twice);
  CHECK(twice.error().message.find("two members have the name 'a'") != std::string::npos);
}

TEST_CASE("members that cannot be read say why") {
  const auto encrypted = read_one({{{"a", "x", true, 1}}});
  REQUIRE_FALSE(encrypted);
  CHECK(encrypted.error().code == ErrorCode::unsupported);
  CHECK(encrypted.error().message.find("encrypted") != std::string::npos);
  const auto lzma = read_one({{{"a", "x", true, 0, 14}}});
  REQUIRE_FALSE(lzma);
  CHECK(lzma.error().code == ErrorCode::unsupported);
  CHECK(lzma.error().message.find("method 14") != std::string::npos);
  const auto checksum = read_one({{{"a", "x", false, 0, -1, -1, 0}}});
  REQUIRE_FALSE(checksum);
  CHECK(checksum.error().message.find("checksum") != std::string::npos);
  const auto longer = read_one({{{"a", "xyz", false, 0, -1, 1000}}});
  REQUIRE_FALSE(longer);
  CHECK(longer.error().code == ErrorCode::malformed);
  const auto shorter = read_one({{{"a", "xyz", false, 0, -1, 2}}});
  REQUIRE_FALSE(shorter);
  CHECK(shorter.error().code == ErrorCode::malformed);
}

TEST_CASE("all members together are within the limit") {
  const std::string zip = ZipMaker{{{"a", kText}, {"b", kText}}}.bytes();
  const auto members = archives::zip_members(random(zip));
  REQUIRE(members);
  const archives::ExpansionLimit limit{150'000, 0};
  CHECK(read(zip, (*members)[0], limit));
  const auto count = std::make_shared<archives::ExpansionCount>(limit, zip.size());
  const auto total = [&](const archives::ZipMember& member) -> Result<std::size_t> {
    auto source = archives::open_member(random(zip), member, count);
    REQUIRE(source);
    std::size_t sum = 0;
    Bytes piece(4096);
    for (;;) {
      const auto more = (*source)(piece);
      if (!more) return more.error();
      if (*more == 0) return sum;
      sum += *more;
    }
  };
  CHECK(total((*members)[0]));
  const auto second = total((*members)[1]);
  REQUIRE_FALSE(second);
  CHECK(second.error().code == ErrorCode::limit_exceeded);
}

}  // namespace
}  // namespace watertight
