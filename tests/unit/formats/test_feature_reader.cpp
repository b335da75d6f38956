// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "formats/feature_reader.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_feature_reader {
namespace {

/// A source that gives a text in pieces of `step` bytes.
formats::ByteSource in_pieces(std::string text, std::size_t step) {
  return [text = std::move(text), step,
          at = std::size_t{0}](std::span<std::uint8_t> bytes) mutable -> Result<std::size_t> {
    const std::size_t count = std::min({step, bytes.size(), text.size() - at});
    std::copy_n(text.begin() + static_cast<std::ptrdiff_t>(at), count, bytes.begin());
    at += count;
    return count;
  };
}

struct Read {
  std::vector<std::string> ids;
  std::vector<Error> errors;
};

Read read_all(formats::FeatureReader& reader) {
  Read read;
  for (;;) {
    auto text = reader.next();
    if (!text) {
      read.errors.push_back(text.error());
      continue;
    }
    if (!*text) return read;
    auto feature = reader.read(**std::move(text));
    if (feature) {
      read.ids.push_back(feature->id);
    } else {
      read.errors.push_back(feature.error());
    }
  }
}

using Ids = std::vector<std::string>;

TEST_CASE("a sequence is read the same however its bytes arrive") {
  const std::string text =
      samples::sequence({samples::feature("a"), samples::feature("b"), samples::feature("c")});
  for (const std::size_t step : {std::size_t{1}, std::size_t{7}, text.size()}) {
    auto reader = formats::FeatureReader::open(in_pieces(text, step), "x.city.jsonl");
    REQUIRE(reader);
    CHECK(reader->document().format == Format::city_json_seq);
    CHECK_FALSE(reader->feature_count());
    const Read read = read_all(*reader);
    CHECK(read.ids == Ids{"a", "b", "c"});
    CHECK(read.errors.empty());
    CHECK(reader->bytes_read() == text.size());
  }
}

TEST_CASE("a sequence is detected by its content when no name helps") {
  const std::string text = samples::sequence({samples::feature("a")});
  auto reader = formats::FeatureReader::open(in_pieces(text, 100), "");
  REQUIRE(reader);
  CHECK(reader->document().format == Format::city_json_seq);
  CHECK(read_all(*reader).ids == Ids{"a"});
}

TEST_CASE("one bad line of a sequence does not cost the others, and is named") {
  const std::string first = samples::feature("a");
  const std::string text =
      samples::sequence({first, R"({"type":"CityJSONFeature",)", "", samples::feature("c")});
  auto reader = formats::FeatureReader::open(in_pieces(text, 64), "x.jsonl");
  REQUIRE(reader);
  const Read read = read_all(*reader);
  CHECK(read.ids == Ids{"a", "c"});
  REQUIRE(read.errors.size() == 1);
  CHECK(read.errors[0].code == ErrorCode::malformed);
  CHECK(read.errors[0].message.find("line 3: ") == 0);
  const std::size_t start = samples::kHeader.size() + first.size() + 2;
  REQUIRE(read.errors[0].byte_offset);
  CHECK(*read.errors[0].byte_offset >= start);
  CHECK(*read.errors[0].byte_offset < start + 40);
}

TEST_CASE("separators, carriage returns and a byte order mark around lines are skipped") {
  std::string text = "\xEF\xBB\xBF";
  text += "\x1E" + std::string(samples::kHeader) + "\r\n\r\n\x1E" + samples::feature("a") + "\r\n";
  text += "  " + samples::feature("b");  // the last line has no line end
  auto reader = formats::FeatureReader::open(in_pieces(text, 33), "x.jsonl");
  REQUIRE(reader);
  CHECK(reader->document().notes.size() == 1);
  const Read read = read_all(*reader);
  CHECK(read.ids == Ids{"a", "b"});
  CHECK(read.errors.empty());
}

TEST_CASE("a feature alone is read under the header that is found for it") {
  const std::string feature = samples::feature("a");
  std::string pretty = "{\n";
  pretty.append(feature, 1, feature.size() - 2).append("\n}\n");
  int calls = 0;
  const auto find = [&calls]() -> Result<std::string> {
    ++calls;
    return std::string(samples::kHeader);
  };
  for (const std::string& text : {feature, feature + "\n\n", pretty}) {
    for (const std::string name : {"x.jsonl", "x.json", ""}) {
      const int before = calls;
      auto reader = formats::FeatureReader::open(in_pieces(text, 50), name, {}, find);
      REQUIRE(reader);
      CHECK(calls == before + 1);
      CHECK(reader->document().header.str() == samples::kHeader);
      const auto found = reader->next();
      REQUIRE(found);
      REQUIRE(*found);
      CHECK((*found)->ready->id == "a");
      CHECK((*found)->ready->solids.size() == 1);
      CHECK((*found)->ready->unreadable.empty());
    }
  }
  // A sequence has a header of its own.
  const std::string sequence = samples::sequence({feature});
  const int before = calls;
  CHECK(formats::FeatureReader::open(in_pieces(sequence, 50), "x.jsonl", {}, find));
  CHECK(calls == before);
  // Features without header are no feature alone.
  const std::string headless = feature + "\n" + feature + "\n";
  CHECK_FALSE(formats::FeatureReader::open(in_pieces(headless, 50), "x.jsonl", {}, find));
}

TEST_CASE("other documents are read whole and given feature by feature") {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no first\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
      "o second\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  auto reader = formats::FeatureReader::open(in_pieces(text, 5), "x.obj");
  REQUIRE(reader);
  CHECK(reader->document().format == Format::obj);
  REQUIRE(reader->feature_count());
  CHECK(*reader->feature_count() == 2);
  CHECK(read_all(*reader).ids.size() == 2);
}

TEST_CASE("a line beyond the limit ends the input with an error") {
  const std::string text = samples::sequence(
      {samples::feature("a", samples::kBoxFacets, "[" + std::string(900'000, ' ') + "[0,0,0]]")});
  formats::ReadOptions options;
  options.limits.bytes = 300'000;
  auto reader = formats::FeatureReader::open(in_pieces(text, 4096), "x.jsonl", options);
  REQUIRE(reader);
  const auto text_found = reader->next();
  REQUIRE_FALSE(text_found);
  CHECK(text_found.error().code == ErrorCode::limit_exceeded);
  const auto after = reader->next();
  REQUIRE(after);
  CHECK_FALSE(*after);
}

TEST_CASE("an error of the source is passed on, then the input is at its end") {
  const std::string text = samples::sequence({samples::feature("a")});
  auto pieces = in_pieces(text, 50);
  std::size_t left = text.size() - 60;
  auto reader = formats::FeatureReader::open(
      [pieces, left](std::span<std::uint8_t> bytes) mutable -> Result<std::size_t> {
        if (left < 50) return Error{ErrorCode::unavailable, "the disk is gone"};
        left -= 50;
        return pieces(bytes);
      },
      "x.jsonl");
  // The reader may meet the error already when it detects the format.
  if (!reader) {
    CHECK(reader.error().code == ErrorCode::unavailable);
    return;
  }
  const Read read = read_all(*reader);
  REQUIRE(read.errors.size() == 1);
  CHECK(read.errors[0].code == ErrorCode::unavailable);
}

}  // namespace
}  // namespace watertight::test_feature_reader
