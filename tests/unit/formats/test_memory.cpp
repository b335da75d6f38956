// SPDX-License-Identifier: GPL-3.0-or-later
#include <malloc.h>

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <fstream>
#include <optional>
#include <string>

#include "formats/feature_reader.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_memory {
namespace {

/// A line of /proc/self/status, bytes.
double status_bytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.starts_with(name + ':')) return std::stod(line.substr(name.size() + 1)) * 1024;
  }
  FAIL("no line " << name);
  return 0;
}

/// The most memory that `work` has more than there was before, bytes.
template <class Work>
double peak_of(Work work) {
  malloc_trim(0);
  const double before = status_bytes("VmRSS");
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak begins anew
  work();
  return status_bytes("VmHWM") - before;
}

/// The most memory that reading a document whole takes, by the bytes of its text.
double times_its_text(const std::string& text) {
  const double peak = peak_of([&] {
    formats::ReadOptions options;
    options.keep_text = true;
    const auto document =
        formats::read_document(as_bytes(text), formats::Format::city_json, options);
    REQUIRE(document);
    CHECK(document->features.size() > 0);
  });
  return peak / static_cast<double>(text.size());
}

std::string city(const std::string& attributes, int objects) {
  std::string text = R"({"type":"CityJSON","version":"2.0","vertices":[],"CityObjects":{)";
  for (int i = 0; i < objects; ++i) {
    if (i > 0) text += ',';
    text.append(R"("object)").append(std::to_string(i)).append(R"(":{"type":"Building",)");
    text.append(R"("attributes":)").append(attributes).append("}");
  }
  return text + "}}";
}

TEST_CASE("a document that is read whole takes at most the memory that the service counts") {
  constexpr double kCounted = 40;  // times the text: kMemoryOfText in server/submission.cpp
  double most = 0;
  for (const std::string value : {"0", "{}", "[]", R"("")", "1e5", "[0]", R"({"":0})"}) {
    std::string values = value;
    while (values.size() < 4'000'000) values.append(",").append(value);
    const double times = times_its_text(city(R"({"a":[)" + values + "]}", 1));
    CAPTURE(value, times);
    CHECK(times < kCounted);
    most = std::max(most, times);
  }
  CHECK(most > 4);  // else this test measures nothing
  CHECK(times_its_text(city("{}", 100'000)) < kCounted);
  CHECK(times_its_text(city(R"({"a":1,"b":[2,3,4,5],"c":"text"})", 50'000)) < kCounted);
}

/// A building whose only geometry is a MultiSolid of `count` solids without shells.
std::string empty_solids(int count) {
  std::string solids = "[]";
  for (int i = 1; i < count; ++i) solids += ",[]";
  return R"({"type":"CityJSON","version":"2.0","vertices":[],"CityObjects":{"a":{)"
         R"("type":"Building","geometry":[{"type":"MultiSolid","lod":"1","boundaries":[)" +
         solids + "]}]}}}";
}

TEST_CASE("solids without facets do not take more memory than the length of their text allows") {
  const std::string text = empty_solids(300'000);
  const double peak = peak_of([&] {
    const auto document = formats::read_document(as_bytes(text), formats::Format::city_json);
    REQUIRE_FALSE(document);
    CHECK(document.error().code == ErrorCode::limit_exceeded);
    CHECK(document.error().pointer == "/CityObjects/a/geometry/0/boundaries");
  });
  CHECK(peak < 40 * static_cast<double>(text.size()));
  CHECK(formats::read_document(as_bytes(empty_solids(10'000)), formats::Format::city_json));
}

TEST_CASE("a feature has at most the solids that the caller allows") {
  formats::ReadOptions options;
  options.limits.solids = 99;
  const auto read = [&](int count) {
    return formats::read_document(as_bytes(empty_solids(count)), formats::Format::city_json,
                                  options);
  };
  CHECK(read(99));
  const auto document = read(100);
  REQUIRE_FALSE(document);
  CHECK(document.error().code == ErrorCode::limit_exceeded);
  CHECK(document.error().message == "100 solids in the feature 'a'; the limit is 99");
}

TEST_CASE("a sequence of any length takes the memory of its longest line") {
  const std::string header = samples::sequence({});
  const std::string line = samples::feature("a") + '\n';
  constexpr std::size_t kLength = 200U << 20U;
  std::size_t given = 0;
  const auto source = [&](std::span<std::uint8_t> bytes) -> Result<std::size_t> {
    if (given >= kLength) return 0;
    const std::string& piece = given == 0 ? header : line;
    REQUIRE(bytes.size() >= piece.size());
    std::copy(piece.begin(), piece.end(), bytes.begin());
    given += piece.size();
    return piece.size();
  };
  std::size_t features = 0;
  const double peak = peak_of([&] {
    auto reader = formats::FeatureReader::open(source, ".jsonl");
    REQUIRE(reader);
    for (;;) {
      auto text = reader->next();
      REQUIRE(text);
      if (!*text) break;
      if (features++ % 1000 == 0) CHECK(reader->read(**std::move(text)));
    }
  });
  CHECK(features > 100'000);
  CHECK(peak < 20e6);
}

}  // namespace
}  // namespace watertight::test_memory
