// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the sequences of a collection whose features came with different headers.
#include <catch2/catch_test_macros.hpp>
#include <map>
#include <string>

#include "pipeline/export.h"
#include "pipeline/pipeline.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_sequences {
namespace {

using pipeline::CollectionExport;
using pipeline::SequencePlan;

void put(SolidStore& store, std::string_view text, Format format = Format::city_json_seq,
         const std::string& name = "") {
  formats::ReadOptions read;
  read.keep_text = true;
  auto document = formats::read_document(as_bytes(text), format, read);
  REQUIRE(document);
  pipeline::IngestOptions options;
  options.collection = "town";
  options.unnamed = name;
  const auto outcome = pipeline::ingest(*std::move(document), store, nullptr, options);
  REQUIRE(outcome);
  REQUIRE(outcome->verdict == Verdict::valid);
}

/// A sequence of one box under the sample's header with a part of it replaced.
std::string variant(const std::string& id, const std::string& from, const std::string& to) {
  std::string text = samples::sequence({samples::feature(id)});
  text.replace(text.find(from), from.size(), to);
  return text;
}

std::string text_of(CollectionExport& exporting) {
  std::string text;
  for (;;) {
    const auto bytes = exporting.next();
    REQUIRE(bytes);
    if (bytes->empty()) return text;
    text += as_text(*bytes);
  }
}

/// The solid of each feature of a sequence.
std::map<std::string, Solid> solids_of(const std::string& text) {
  const auto document = formats::read_city_json_seq(text, {});
  REQUIRE(document);
  std::map<std::string, Solid> solids;
  for (const Feature& feature : document->features) {
    REQUIRE(feature.solids.size() == 1);
    solids.emplace(feature.id, feature.solids[0].solid);
  }
  return solids;
}

TEST_CASE("features of several headers are one sequence with the coordinates that they had") {
  samples::MemoryStore store;
  const std::string plain = samples::sequence({samples::feature("a")});
  const std::string moved = variant("b", "100.0,200.0", "300.125,-7.5");
  const std::string coarse = variant("c", "0.001,0.001,0.001", "0.002,0.01,0.001");
  for (const std::string& text : {plain, moved, coarse}) put(store, text);
  auto exporting = CollectionExport::start(store, "town", pipeline::ExportFormat::sequence);
  REQUIRE(exporting);
  const std::string all = text_of(*exporting);
  CHECK(exporting->exported().features == 3);
  CHECK(exporting->exported().generic == 0);
  auto wanted = solids_of(plain);
  wanted.merge(solids_of(moved));
  wanted.merge(solids_of(coarse));
  CHECK(solids_of(all) == wanted);
  // Attributes and all other text stay, and so does a line whose vertices stay.
  CHECK(all.find(samples::feature("a") + "\n") != std::string::npos);
  std::size_t heights = 0;
  for (std::size_t at = all.find("2.50"); at != std::string::npos; at = all.find("2.50", at + 1)) {
    ++heights;
  }
  CHECK(heights == 3);
}

TEST_CASE("the header of the collection's first document comes first") {
  samples::MemoryStore store;
  const std::string first = variant("z", "100.0,200.0", "999.0,999.0");
  put(store, first);
  put(store, samples::sequence({samples::feature("a")}));
  const auto plan = SequencePlan::make(store, "town");
  REQUIRE(plan);
  REQUIRE(plan->sequences().size() == 1);
  CHECK(plan->sequences()[0].headers == 2);
  CHECK(plan->sequences()[0].header == first.substr(0, first.find('\n')));
}

TEST_CASE("headers without a common grid give several sequences, each feature in one of them") {
  samples::MemoryStore store;
  const std::string plain = samples::sequence({samples::feature("a"), samples::feature("c")});
  const std::string fine = variant("b", "100.0,200.0", "0.12345678901,0");
  put(store, plain);
  put(store, fine);
  const auto refused = CollectionExport::start(store, "town", pipeline::ExportFormat::sequence);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::unsupported);
  CHECK(refused.error().message.find("needs 2 sequences") != std::string::npos);
  CHECK(refused.error().message.find("common grid") != std::string::npos);
  auto made = SequencePlan::make(store, "town");
  REQUIRE(made);
  const auto plan = std::make_shared<const SequencePlan>(*std::move(made));
  REQUIRE(plan->sequences().size() == 2);
  const auto part = [&](std::size_t number) {
    auto exporting = CollectionExport::start_sequence(store, "town", plan, number);
    REQUIRE(exporting);
    return text_of(*exporting);
  };
  CHECK(part(0) == plain);
  CHECK(part(1) == fine);
  CHECK_FALSE(CollectionExport::start_sequence(store, "town", plan, 2));
}

TEST_CASE("features that came without a city model are generic objects of the sequence") {
  samples::MemoryStore store;
  put(store, samples::sequence({samples::feature("a")}));
  constexpr std::string_view kTetrahedron =
      "SRID=7415;SOLID Z((((0 0 0,0 1.25 0,1 0 0,0 0 0)),((0 0 0,1 0 0,0 0 1,0 0 0)),((0 0 0,0 0 1,"
      "0 1.25 0,0 0 0)),((1 0 0,0 1.25 0,0 0 1,1 0 0))))";
  put(store, kTetrahedron, Format::wkt, "house");
  auto exporting = CollectionExport::start(store, "town", pipeline::ExportFormat::sequence);
  REQUIRE(exporting);
  const auto solids = solids_of(text_of(*exporting));
  CHECK(exporting->exported().features == 2);
  CHECK(exporting->exported().generic == 1);
  const auto house = formats::read_document(as_bytes(kTetrahedron), Format::wkt);
  REQUIRE(house);
  REQUIRE(solids.contains("house"));
  CHECK(solids.at("house") == house->features[0].solids[0].solid);
}

TEST_CASE("coordinates on no decimal grid, and a city model without transform, are no sequence") {
  samples::MemoryStore store;
  put(store,
      R"({"type":"CityJSON","version":"1.0","CityObjects":{"a":{"type":"Building","geometry":[)"
      R"({"type":"Solid","lod":"1","boundaries":[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]]]}]}},)"
      R"("vertices":[[0.5,0,0],[1.5,0,0],[0,1,0],[0,0,1]]})",
      Format::city_json);
  const auto exporting = CollectionExport::start(store, "town", pipeline::ExportFormat::sequence);
  REQUIRE_FALSE(exporting);
  CHECK(exporting.error().code == ErrorCode::unsupported);
  CHECK(exporting.error().message.find("transform") != std::string::npos);
}

}  // namespace
}  // namespace watertight::test_sequences
