// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "codec/encode_boundary.h"
#include "pipeline/container.h"
#include "pipeline/outcome_json.h"
#include "pipeline/pipeline.h"
#include "tests/files.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_pipeline {
namespace {

Document read(const std::string& text, Format format = Format::city_json_seq) {
  auto document = formats::read_document(as_bytes(text), format);
  REQUIRE(document);
  return *std::move(document);
}

pipeline::IngestOptions into(const std::string& collection) {
  pipeline::IngestOptions options;
  options.collection = collection;
  return options;
}

std::string sequence_of(const Document& document) {
  const auto bytes = formats::write_document(document, Format::city_json_seq);
  REQUIRE(bytes);
  return std::string(as_text(*bytes));
}

/// A box whose top has vertices of its own, which are equal to those of the walls.
std::string box_with_equal_vertices() {
  return samples::feature(
      "twins", "[[[0,3,2,1]],[[8,9,10,11]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]",
      "[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,2500],[1000,0,2500],[1000,1000,2500],"
      "[0,1000,2500],[0,0,2500],[1000,0,2500],[1000,1000,2500],[0,1000,2500]]");
}

Bytes container_of(const std::string& text) {
  auto encoded = pipeline::encode_document(read(text), nullptr, {});
  REQUIRE(encoded);
  REQUIRE(encoded->outcome.verdict == Verdict::valid);
  auto container = pipeline::write_container(encoded->document);
  REQUIRE(container);
  return *std::move(container);
}

TEST_CASE("ingest stores a valid document, and it comes back the same") {
  samples::MemoryStore store;
  const std::string text = samples::sequence({samples::feature("a"), samples::feature("b")});
  const auto outcome = pipeline::ingest(read(text), store, nullptr, into("town"));
  REQUIRE(outcome);
  CHECK(outcome->verdict == Verdict::valid);
  CHECK(outcome->stored == 2);
  const auto stored = store.get("town", "b");
  REQUIRE(stored);
  CHECK(stored->srid == 7415);
  REQUIRE(stored->box);
  CHECK(stored->box->max[2] == 2.5);
  const auto document = pipeline::from_stored(*stored);
  REQUIRE(document);
  CHECK(sequence_of(*document) == sequence_of(read(samples::sequence({samples::feature("b")}))));
}

TEST_CASE("ingest refuses the whole document when one feature is invalid") {
  samples::MemoryStore store;
  const std::string text =
      samples::sequence({samples::feature("a"), samples::feature("open", samples::kOpenFacets)});
  const auto outcome = pipeline::ingest(read(text), store, nullptr, into("town"));
  REQUIRE(outcome);
  CHECK(outcome->verdict == Verdict::invalid);
  CHECK(outcome->stored == 0);
  CHECK_FALSE(store.get("town", "a"));
}

TEST_CASE("ingest can skip invalid features and reports which were stored") {
  samples::MemoryStore store;
  pipeline::IngestOptions options = into("town");
  options.policy = store::Policy::skip;
  const std::string text =
      samples::sequence({samples::feature("open", samples::kOpenFacets), samples::feature("a")});
  const auto outcome = pipeline::ingest(read(text), store, nullptr, options);
  REQUIRE(outcome);
  CHECK(outcome->stored == 1);
  CHECK_FALSE(outcome->features[0].is_stored);
  CHECK(outcome->features[1].is_stored);
  CHECK(store.get("town", "a"));
  CHECK_FALSE(store.get("town", "open"));
}

TEST_CASE("ingest refuses two features of one id") {
  samples::MemoryStore store;
  Document document = read(samples::sequence({samples::feature("a")}));
  document.features.push_back(document.features.front());
  const auto outcome = pipeline::ingest(std::move(document), store, nullptr, into("town"));
  REQUIRE_FALSE(outcome);
  CHECK(outcome.error().code == ErrorCode::malformed);
}

TEST_CASE("ingest refuses another CRS than the collection's") {
  samples::MemoryStore store;
  REQUIRE(pipeline::ingest(read(samples::sequence({samples::feature("a")})), store, nullptr,
                           into("town")));
  Document document = read(samples::sequence({samples::feature("b")}));
  document.features.front().srid = 28992;
  const auto outcome = pipeline::ingest(std::move(document), store, nullptr, into("town"));
  REQUIRE_FALSE(outcome);
  CHECK(outcome.error().code == ErrorCode::conflict);
}

TEST_CASE("ingest stores nothing when it is cancelled") {
  samples::MemoryStore store;
  pipeline::IngestOptions options = into("town");
  options.is_cancelled = [] { return true; };
  const auto outcome =
      pipeline::ingest(read(samples::sequence({samples::feature("a")})), store, nullptr, options);
  REQUIRE_FALSE(outcome);
  CHECK(outcome.error().code == ErrorCode::cancelled);
  CHECK_FALSE(store.get("town", "a"));
}

TEST_CASE("the outcome is the same for any number of threads") {
  std::vector<std::string> features;
  for (int i = 0; i < 20; ++i) {
    features.push_back(samples::feature(std::string("f").append(std::to_string(i)),
                                        i % 3 == 0 ? samples::kOpenFacets : samples::kBoxFacets));
  }
  pipeline::IngestOptions options;
  const auto one = pipeline::encode_document(read(samples::sequence(features)), nullptr, options);
  options.threads = 4;
  const auto four = pipeline::encode_document(read(samples::sequence(features)), nullptr, options);
  REQUIRE(one);
  REQUIRE(four);
  CHECK(pipeline::outcome_json(one->outcome) == pipeline::outcome_json(four->outcome));
}

TEST_CASE("equal vertices of a document keep their own numbers through the store") {
  const std::string text = samples::sequence({box_with_equal_vertices()});
  const auto documents = pipeline::decode_container(container_of(text));
  REQUIRE(documents);
  CHECK(sequence_of(documents->at(0)) == sequence_of(read(text)));
}

TEST_CASE("convert triangulates facets with holes for OBJ") {
  // A box with a square dent of depth 0 in its top is not closed, but it can be converted.
  const std::string text = samples::sequence({samples::feature(
      "holed", "[[[0,1,2,3],[4,7,6,5]]]",
      "[[0,0,0],[4000,0,0],[4000,4000,0],[0,4000,0],[1000,1000,0],[3000,1000,0],[3000,3000,0],"
      "[1000,3000,0]]")});
  const auto obj = pipeline::convert_document(read(text), Format::obj);
  REQUIRE(obj);
  std::size_t faces = 0;
  const std::string lines(as_text(*obj));
  for (std::size_t at = lines.find("\nf "); at != std::string::npos;
       at = lines.find("\nf ", at + 1)) {
    ++faces;
  }
  CHECK(faces == 8);
}

TEST_CASE("JSON strings are escaped and always UTF-8") {
  CHECK(json_string("a\"b\\\n\x01") == "\"a\\\"b\\\\\\u000a\\u0001\"");
  CHECK(json_string("\xC3\xA9") == "\"\xC3\xA9\"");
  CHECK(json_string("\xC3") == "\"\xEF\xBF\xBD\"");
  CHECK(json_string("\xED\xA0\x80") == "\"\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\"");
}

// Two facets of the solid are not planar and share three vertices. Both could follow one Delaunay
// face; the bitmap would then have lost one of them.
TEST_CASE("facets that could follow the same Delaunay face keep apart in mode bitmap") {
  const Bytes bytes = test::read_bytes(
      test::source_path("tests/data/solids/facets_that_share_a_triangle.city.json"));
  const auto document = formats::read_document(bytes, Format::city_json);
  REQUIRE(document);
  REQUIRE(document->features.at(0).solids.size() == 1);
  const Solid solid = geometry::merge_equal_vertices(document->features[0].solids[0].solid).solid;
  const auto boundary = OrientedBoundary::make(solid);
  REQUIRE(boundary);
  EncodeOptions options;
  options.mode = Mode::bitmap;
  const auto blob = codec::encode_boundary(*boundary, {}, options);
  REQUIRE(blob);
  const auto decoded = decode(*blob);
  REQUIRE(decoded);
  CHECK(decoded->solid == solid);
}

}  // namespace
}  // namespace watertight::test_pipeline
