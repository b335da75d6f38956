// SPDX-License-Identifier: GPL-3.0-or-later
//
// A stored collection is packed again with a dictionary that fits it.
#include "pipeline/stored/compact.h"

#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "packing/text_dictionary.h"
#include "pipeline/pipeline.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_compact {
namespace {

/// A building with a note.
std::string noted(const std::string& id, const std::string& note) {
  std::string text = samples::feature(id);
  const std::string before = R"("height":2.50)";
  return text.replace(text.find(before), before.size(), before + R"(,"note":")" + note + '"');
}

/// Features of collection town by the lines of a sequence, not packed.
std::vector<pipeline::EncodedFeature> encoded(const std::vector<std::string>& lines) {
  auto document = formats::read_document(as_bytes(samples::sequence(lines)), Format::city_json_seq);
  REQUIRE(document);
  auto result = pipeline::encode_document(*std::move(document), nullptr, {});
  REQUIRE(result);
  for (pipeline::EncodedFeature& feature : result->document.features) feature.collection = "town";
  return std::move(result->document.features);
}

packing::DictionaryPointer dictionary_of(const std::vector<std::string>& lines) {
  std::vector<std::string> texts;
  for (const pipeline::EncodedFeature& feature : encoded(lines)) {
    texts.push_back(pipeline::stored_text(feature));
  }
  const auto dictionary = packing::best_dictionary(texts, 10'000);
  REQUIRE(dictionary);
  REQUIRE(*dictionary);
  return *dictionary;
}

StoredFeature packed(const std::string& line, const packing::DictionaryPointer& dictionary) {
  auto stored = pipeline::pack(encoded({line}).front(), dictionary);
  REQUIRE(stored);
  return *std::move(stored);
}

TEST_CASE("compact packs each feature that becomes smaller, and leaves the others as they are") {
  const std::string rare = "5uQ0rZ-kW7-pX1-vB9-nD4-tG6-hJ8-mL3-cF2-yS5-aE0-iO7-wK1-zR9-qT4-xU6";
  const std::string usual = "offices, garage below, roof terrace with solar panels, built 1974";
  std::vector<std::string> rare_lines;
  std::vector<std::string> usual_lines;
  for (int i = 100; i < 150; ++i) {
    rare_lines.push_back(noted("r" + std::to_string(i), rare));
    usual_lines.push_back(noted("u" + std::to_string(i), usual));
  }
  const packing::DictionaryPointer old = dictionary_of(rare_lines);
  samples::MemoryStore store;
  std::vector<StoredFeature> features{packed(rare_lines.front(), old)};
  for (const std::string& line : usual_lines) features.push_back(packed(line, nullptr));
  REQUIRE(store.put(features));

  const auto counts = pipeline::compact(store, "town");
  REQUIRE(counts);
  CHECK(counts->features == 51);
  CHECK(counts->repacked == 50);
  CHECK(counts->bytes_after < counts->bytes_before / 2);
  std::uint64_t bytes = 0;
  for (const StoredFeature& feature : features) {
    const auto now = store.get("town", feature.id);
    REQUIRE(now);
    bytes += now->skeleton.bytes.size();
    CHECK(now->skeleton.bytes.size() <= feature.skeleton.bytes.size());
    CHECK((now->skeleton.dictionary == old) == (feature.id == "r100"));
    const auto before = pipeline::unpack(feature);
    const auto after = pipeline::unpack(*now);
    REQUIRE((before && after));
    CHECK(pipeline::stored_text(*after) == pipeline::stored_text(*before));
  }
  CHECK(counts->bytes_after == bytes);
  const auto again = pipeline::compact(store, "town");
  REQUIRE(again);
  CHECK(again->repacked == 0);
}

}  // namespace
}  // namespace watertight::test_compact
