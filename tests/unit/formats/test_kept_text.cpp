// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests that documents read with ReadOptions::keep_text are written byte for byte as they were.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "formats/document.h"
#include "formats/text/text_layout.h"
#include "samples.h"

namespace watertight::test_kept_text {
namespace {

using test::kTwoBuildings;

Result<Document> read_kept(std::string_view text, Format format) {
  formats::ReadOptions options;
  options.split_features = false;
  options.keep_text = true;
  return formats::read_document(as_bytes(text), format, options);
}

std::string read_and_written(std::string_view text, Format format) {
  const auto document = read_kept(text, format);
  if (!document) return to_string(document.error());
  const auto written = formats::write_document(*document, format);
  return written ? std::string(as_text(*written)) : to_string(written.error());
}

/// The text with other white space between its tokens: the results of `blank`.
template <class Blank>
std::string respaced(std::string_view text, Blank blank) {
  std::string out;
  bool is_in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_mark = !is_in_string && std::string_view("{}[]:,").find(c) != std::string::npos;
    if (is_mark) out += blank();
    out += c;
    if (c == '"') is_in_string = !is_in_string;
    if (is_in_string && c == '\\') out += text[++i];
    if (is_mark) out += blank();
  }
  return out;
}

/// A sequence of a header and the tetrahedron twice: `before` starts it, `between` separates the
/// lines, `after` ends it.
std::string sequence(const std::string& before, const std::string& between,
                     const std::string& after) {
  const std::string feature =
      R"("CityObjects":{"a":{"type":"Building","geometry":[{"type":"Solid","lod":"1",)"
      R"("boundaries":[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]]}]}},)"
      R"("vertices":[[0,0,0],[9,0,0],[0,9,0],[0,0,9]]})";
  return before +
         R"({"type": "CityJSON","version":"2.0","transform":{"scale":[1.0,1,1],)"
         R"("translate":[0,0,0]},"CityObjects":{},"vertices":[]})" +
         between + R"({"type":"CityJSONFeature","id":"a",)" + feature + between +
         R"({"type":"CityJSONFeature", "id":"a",)" + feature + after;
}

TEST_CASE("every real city model comes back byte for byte") {
  std::size_t files = 0;
  const std::string folder = test::source_path("tests/data/cityjson");
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    INFO(name);
    const std::string text = test::file_text("cityjson/" + name);
    const auto format = formats::detect_format(name, as_bytes(text));
    REQUIRE(format);
    if (!read_kept(text, *format)) continue;  // the broken files are in test_city_json_files.cpp
    CHECK(read_and_written(text, *format) == text);
    ++files;
  }
  CHECK(files > 20);
}

TEST_CASE("white space comes back wherever it stands") {
  std::mt19937 random(7);
  const std::vector<std::string> blanks{"", "", "", " ", "\n", "\r\n", "\t", "   \n\t"};
  for (int round = 0; round < 200; ++round) {
    const std::string text =
        respaced(kTwoBuildings, [&] { return blanks[random() % blanks.size()]; });
    REQUIRE(read_and_written(text, Format::city_json) == text);
  }
}

TEST_CASE("byte order mark, line ends and bytes after the text come back") {
  for (const std::string before : {"", "\xEF\xBB\xBF", "\n \t", "\xEF\xBB\xBF\r\n"}) {
    for (const std::string after : {"", "\n", "\r\n", " \n\n"}) {
      const std::string text = before + kTwoBuildings + after;
      CHECK(read_and_written(text, Format::city_json) == text);
    }
  }
}

TEST_CASE("spellings of numbers and escapes of strings come back") {
  const std::string head =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1.0,1e0,0.1e1],"translate":[-0,-0.0,0E5]},)";
  for (const std::string attributes :
       {R"("\u00e9\/é":1.0)", R"("a":"\u00E9\ud83d\ude00","b":"\u0041\b\f\u0009")",
        R"("a":-0,"b":[1e3,1E+03,1000.0,1.50])", R"("a":"é","b":"\u00e9","c":"\/","d":"/")"}) {
    for (const std::string vertices :
         {"[[0,0,0],[1,2,3]]", "[[0.0,-0,0e0],[1.00,2.000,3]]", "[[10.0,1e1,3],[4.0,5.0,6.0]]"}) {
      const std::string text =
          head + R"("CityObjects":{"\u0061":{"type":"Building","attributes":{)" + attributes +
          R"(},"geometry":[{"type":"Solid","lod":1.0,"boundaries":[[[[0,1,0]]]]}]}},"vertices":)" +
          vertices + "}";
      CHECK(read_and_written(text, Format::city_json) == text);
    }
  }
}

TEST_CASE("coordinates without transform keep their digits") {
  const std::string head =
      R"({"type":"CityJSON","version":"1.0","CityObjects":{"a":{"type":"Building","geometry":[)"
      R"({"type":"Solid","lod":1,"boundaries":[[[[0,1,2]]]]}]}},"vertices":)";
  for (const std::string vertices :
       {"[[0.10,1.000,2],[3.5,4e2,-0.0],[5,6,7]]",
        "[[1.100,2.200,3.300],[4.000,5.000,6.000],[7,8,9.5]]",
        "[[0.1234567890123456789,1.0,2.0],[3.0,4.0,5.0],[6.0,7.0,8.0]]"}) {
    CHECK(read_and_written(head + vertices + "}", Format::city_json) == head + vertices + "}");
  }
}

TEST_CASE("bytes between the lines of a sequence come back") {
  for (const std::string before : {"", "\xEF\xBB\xBF", "\x1E", "\n\n \t"}) {
    for (const std::string between : {"\n", "\r\n", "\n\n", " \n\x1E", "\n\n\r\n \n"}) {
      for (const std::string after : {"", "\n", "\r\n", "\n\n", " \n ", "\n\x1E"}) {
        const std::string text = sequence(before, between, after);
        CHECK(read_and_written(text, Format::city_json_seq) == text);
      }
    }
  }
}

TEST_CASE("a line of a sequence comes back as it was") {
  const std::string text = sequence("", "\n", "\n");
  const auto document = read_kept(text, Format::city_json_seq);
  REQUIRE(document);
  REQUIRE(document->features.size() == 2);
  const auto line = formats::write_feature(*document, document->features[1]);
  REQUIRE(line);
  CHECK(text.find(*line) != std::string::npos);
  CHECK(line->starts_with(R"({"type":"CityJSONFeature", "id")"));
}

TEST_CASE("a regular style costs next to nothing, an irregular one is exact all the same") {
  const auto plain = read_kept(kTwoBuildings, Format::city_json);
  REQUIRE(plain);
  CHECK(plain->features[0].layout.size() < 16);
  bool is_after = false;
  const std::string spaced = respaced(kTwoBuildings, [&] {
    is_after = !is_after;
    return is_after ? "" : " ";
  });
  const auto document = read_kept(spaced, Format::city_json);
  REQUIRE(document);
  CHECK(document->features[0].layout.size() < 120);
}

TEST_CASE("a changed layout, or one of another document, is an error and no other text") {
  const std::string text = respaced(kTwoBuildings, [] { return " "; });
  const auto document = read_kept(text, Format::city_json);
  REQUIRE(document);
  const Bytes& layout = document->features[0].layout;
  const auto gives_text = [&](const Bytes& changed) {
    const auto result = formats::apply_layout(kTwoBuildings, changed, 1U << 20U);
    if (!result) CHECK_FALSE(result.error().message.empty());
    return result && *result == text;
  };
  REQUIRE(gives_text(layout));
  for (std::size_t size = 1; size < layout.size(); ++size) {
    CHECK_FALSE(formats::apply_layout(kTwoBuildings, ByteView(layout).first(size), 1U << 20U));
  }
  for (std::size_t i = 0; i < layout.size(); ++i) {
    for (const unsigned bit : {1U, 2U, 16U, 128U}) {
      Bytes changed = layout;
      changed[i] = static_cast<std::uint8_t>(changed[i] ^ bit);
      const auto result = formats::apply_layout(kTwoBuildings, changed, 1U << 20U);
      if (result) CHECK(*result == text);
    }
  }
  CHECK_FALSE(formats::apply_layout("[1,2]", layout, 1U << 20U));
  CHECK(formats::apply_layout(kTwoBuildings, layout, 100).error().code ==
        ErrorCode::limit_exceeded);
}

TEST_CASE("texts with other tokens are kept whole") {
  const std::string text = "{ \"b\" : [1, 2, 3] }";
  for (const std::string plain : {"", "[]", "{\"b\":[1,2]}", "{\"b\":[1,2,3]}}"}) {
    const Bytes layout = formats::describe_layout(plain, text);
    CHECK(formats::holds_whole_text(layout));
    const auto again = formats::apply_layout(plain, layout, 1000);
    REQUIRE(again);
    CHECK(*again == text);
  }
}

TEST_CASE("a layout cannot make more than the size that it states") {
  std::string plain = "[0";
  for (int i = 0; i < 20'000; ++i) plain += ",0";
  plain += ']';
  // Every number expects the gap before the first one, which is long.
  formats::ExceptionWriter gaps;
  gaps.expected();
  gaps.exception(std::string(60'000, ' '));
  const Bytes gap_bytes = std::move(gaps).finish();
  ByteWriter layout;
  layout.u8(0);
  layout.u64(0);
  layout.varint(100'000);
  layout.varint(gap_bytes.size());
  layout.append(gap_bytes);
  const auto result = formats::apply_layout(plain, layout.bytes(), 1U << 20U);
  REQUIRE_FALSE(result);
  CHECK(result.error().code == ErrorCode::malformed);
}

}  // namespace
}  // namespace watertight::test_kept_text
