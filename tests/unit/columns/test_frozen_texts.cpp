// SPDX-License-Identifier: GPL-3.0-or-later
//
// The format of packed texts is frozen (docs/format-columns.md): these bytes never change. If one
// of these tests fails, files and rows that exist could not be read any more. Other choices of a
// writer may change the bytes of texts (not of examples); then the old bytes still have to be read.
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/checksum.h"
#include "columns/columns.h"
#include "tests/files.h"

namespace watertight {
namespace {

using columns::Examples;
using columns::Text;
using columns::TextKind;

constexpr std::uint64_t kMostBytes = 1'000'000;

Bytes bytes_of(std::string_view hex) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoul(std::string(hex.substr(i, 2)), nullptr, 16)));
  }
  return bytes;
}

std::string hex_of(ByteView bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  for (const std::uint8_t byte : bytes) {
    hex += kDigits[byte >> 4U];
    hex += kDigits[byte & 15U];
  }
  return hex;
}

Bytes read_example(const std::string& name) {
  return test::read_bytes(test::source_path("columns/models/" + name));
}

/// Texts with all kinds of values: numbers of all forms, UUIDs, counters, rings, vertices, lines.
const std::string kSkeleton =
    R"({"type":"CityJSONFeature","id":"a-1","CityObjects":{"a-1":{"type":"Building","attributes":)"
    R"({"h":[11.0,11.5,3.25],"f":[5.6811981201171875,0.10000000149011612],"g":-0.4970000088214874,)"
    R"("e":["28155563e-2"],"n":59e1,"u":"ID_0f8fad5b-d9cb-469f-a165-70867728950e","c":["x9","x10"],)"
    R"("t":"Aa \u00e4 aa bb aa bb aa bb aa bb aa bb aa bb"},"geometry":[{"type":"MultiSurface",)"
    R"("boundaries":[[[0,1,2,3]],[[1,0,4,5]],[[2,1,5]],[[5,4,2]]]}]}},"vertices":{"count":6,)"
    R"("solids":[],"others":[0,0,0,10,0,0,10,10,0,0,10,0,0,0,5.5,10,0,5.5]}})";
const std::string kLines = [] {
  std::string text = "<c><g:name>n</g:name><p>1 2 3</p><p name=\"q\"> 1.5 2.5 3.5 4.5 5.5 6.5</p>";
  for (int i = 0; i < 6; ++i) {
    text += "<posList>";
    for (int j = 0; j < 5; ++j) {
      text += std::to_string(100 + j) + ".000 " + std::to_string(200 + i) + '.' +
              std::to_string(250 + 125 * j) + ' ' + std::to_string(7 * i + j) + ".5 ";
    }
    text += "</posList>";
  }
  return text + "</c>";
}();

struct Frozen {
  TextKind kind;
  std::string text;
  std::size_t size;   // of the packed bytes
  std::uint32_t crc;  // CRC-32C of the packed bytes
};

const std::vector<Frozen>& frozen() {
  static const std::vector<Frozen> kFrozen{
      {TextKind::bytes, std::string("\0\1 any bytes, any bytes, any bytes \xFF", 36), 18,
       0x5e3aaea6U},
      {TextKind::json, kSkeleton, 153, 0x5f7ac268U},
      {TextKind::xml, kLines, 151, 0x0af64c50U},
      {TextKind::table, "features\n0\ta-1\tBuilding\t7415\n0\ta-2\tBuilding\t7415\n", 12,
       0x99cc0c19U}};
  return kFrozen;
}

}  // namespace

TEST_CASE("the examples from which coders learn are those of the format") {
  const Bytes file = columns::packed_examples(false);
  const Bytes row = columns::packed_examples(true);
  CHECK(crc32c(file) == 0xf16c5d87U);
  CHECK(crc32c(row) == 0xb7153461U);
  CHECK(file == read_example("examples-file.bin"));
  CHECK(row == read_example("examples-row.bin"));
}

TEST_CASE("texts of each kind have the bytes that are frozen") {
  std::vector<Text> all;
  for (const Frozen& one : frozen()) {
    const Bytes packed = columns::pack_texts(std::vector<Text>{{one.kind, one.text}});
    CHECK(packed.size() == one.size);
    CHECK(crc32c(packed) == one.crc);
    all.push_back({one.kind, one.text});
  }
  const Bytes packed = columns::pack_texts(all);
  CHECK(packed.size() == 337);
  CHECK(crc32c(packed) == 0xfe799470U);
  const auto back = columns::unpack_texts(packed, kMostBytes);
  REQUIRE(back);
  for (std::size_t i = 0; i < all.size(); ++i) CHECK((*back)[i] == all[i].text);
}

TEST_CASE("frozen bytes are read") {
  const auto by_column =
      columns::unpack_texts(bytes_of("04a61ee67f5123d675c60a6fdb63dc5dbc"), kMostBytes);
  REQUIRE(by_column);
  CHECK(*by_column == std::vector<std::string>{R"({"a":[1,2.5,"b"]})"});
  const auto plain =
      columns::unpack_texts(bytes_of("0905000080b2a077df99cd69fffc9cf000"), kMostBytes);
  REQUIRE(plain);
  CHECK(*plain == std::vector<std::string>{"b", "cc"});
}

TEST_CASE("golden packed texts are read") {
  const std::filesystem::path sources = test::source_path("");
  std::size_t found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(sources / "tests/golden/texts")) {
    const std::filesystem::path name = entry.path().stem();
    CAPTURE(name.string());
    const auto texts = columns::unpack_texts(test::read_bytes(entry.path()), kMostBytes);
    REQUIRE(texts);
    CHECK(*texts == std::vector<std::string>{test::read_text(sources / "tests/data/texts" / name)});
    ++found;
  }
  CHECK(found == 4);
}

TEST_CASE("single texts have the bytes that are frozen") {
  std::vector<Text> texts{{TextKind::json, kSkeleton},
                          {TextKind::json, R"({"type":"Bridge","attributes":{"h":[12.0,1]}})"}};
  const Bytes content = Examples::pack_examples(texts);
  CHECK(content.size() == 161);
  CHECK(crc32c(content) == 0xe1444e8fU);
  const auto examples = Examples::of(content, kMostBytes);
  REQUIRE(examples);
  const auto none = Examples::of(Examples::pack_examples({}), 0);
  REQUIRE(none);
  const std::string text = R"({"type":"Bridge","attributes":{"h":[12.5,3],"u":"x11"}})";
  CHECK(hex_of((*examples)->pack({TextKind::json, text})) == "878d98fb8bb58debbc1279de9e");
  CHECK(hex_of((*none)->pack({TextKind::json, text})) ==
        "721250466b39aa0ae1e29ab82bd5319927041de123b75ca32a");
}

TEST_CASE("texts of a form that is not known are refused as those of a newer program") {
  for (const std::uint8_t form : {std::uint8_t{2}, std::uint8_t{3}}) {
    const auto refused = columns::unpack_texts(Bytes{static_cast<std::uint8_t>(4 + form)}, 10);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == ErrorCode::unsupported);
    CHECK(refused.error().message ==
          "texts of form " + std::to_string(form) + " are not known: a newer program wrote them");
  }
}

TEST_CASE("examples that are cut, long or too many are refused") {
  const Bytes content = Examples::pack_examples(std::vector<Text>{{TextKind::json, kSkeleton}});
  for (std::size_t size = 0; size < content.size(); ++size) {
    CHECK_FALSE(Examples::of(ByteView(content).first(size), kMostBytes));
  }
  const auto over = Examples::of(content, kSkeleton.size() - 1);
  REQUIRE_FALSE(over);
  CHECK(over.error().code == ErrorCode::limit_exceeded);
  CHECK(Examples::of(content, kSkeleton.size()));
  ByteWriter many;
  many.varint(std::uint64_t{1} << 40U);
  CHECK_FALSE(Examples::of(many.bytes(), kMostBytes));
}

TEST_CASE("coordinates that are floats leave nothing behind for those of the next feature") {
  const std::string first =
      R"({"boundaries":[[[0,1,2,3]],[[1,0,2]]],"vertices":{"count":4,"others":[1,2,0,1,5,0,4,5,9,1,2,7]}})";
  const std::string second =
      R"({"boundaries":[[[0,1,2]]],"vertices":{"count":3,"others":[5.6811981201171875,2,3,)"
      R"(6.6811981201171875,2,5.6811981201171875,6.6811981201171875,2,3]}})";
  const std::vector<Text> texts{{TextKind::json, first}, {TextKind::json, second}};
  const auto back = columns::unpack_texts(columns::pack_texts(texts), kMostBytes);
  REQUIRE(back);
  CHECK(*back == std::vector<std::string>{first, second});
  const auto examples =
      Examples::of(Examples::pack_examples(std::span(texts).first(1)), kMostBytes);
  REQUIRE(examples);
  const Bytes packed = (*examples)->pack(texts[1]);
  CHECK(*(*examples)->unpack(packed, kMostBytes) == second);
  CHECK((*examples)->pack(texts[1]) == packed);
}

}  // namespace watertight
