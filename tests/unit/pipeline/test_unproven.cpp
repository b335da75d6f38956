// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <string>

#include "pipeline/container.h"
#include "pipeline/export.h"
#include "pipeline/outcome_json.h"
#include "pipeline/repaired/repair_document.h"
#include "pipeline/stored/unproven_solid.h"
#include "pipeline/streaming/ingestion.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_unproven {
namespace {

/// A solid with all that a valid one cannot have: equal, unused and far vertices, a ring of two
/// vertices, a facet without rings, a shell without facets.
Solid defective(geometry::LatticeKind kind) {
  SolidArrays arrays;
  const double step = kind == geometry::LatticeKind::float64 ? 0.1 : 1;
  arrays.vertices = {{0, 0, 0},           {step, 0, 0},   {step, 0, 0},
                     {7 * step, step, 0}, {0x1p52, 0, 1}, {3, 1e15, 2}};
  arrays.ring_vertices = {0, 1, 2, 3, 3, 0, 4};
  for (const Index end : {4U, 6U, 7U}) arrays.ring_offsets.push_back(end);
  for (const Index end : {2U, 2U, 3U}) arrays.facet_offsets.push_back(end);
  for (const Index end : {3U, 3U}) arrays.shell_offsets.push_back(end);
  geometry::Lattice lattice;
  lattice.kind = kind;
  if (kind == geometry::LatticeKind::decimal) {
    lattice.step.fill({1, -3});
    lattice.origin = {geometry::GridNumber{85, -1}, {-44'700'012'345, -5}, {0, 0}};
  }
  auto solid = Solid::make(std::move(arrays), lattice, 7415);
  REQUIRE(solid);
  return *std::move(solid);
}

TEST_CASE("a solid that is not proven comes back as it came, with all its defects") {
  for (const auto kind : {geometry::LatticeKind::decimal, geometry::LatticeKind::float64}) {
    const Solid solid = defective(kind);
    const std::string line = pipeline::write_unproven(solid);
    CHECK(line.find('\n') == std::string::npos);
    const auto back = pipeline::read_unproven(line);
    REQUIRE(back);
    CHECK(*back == solid);
  }
}

TEST_CASE(
    "a cut or changed line of an unproven solid is an error or another solid, never a crash") {
  const std::string line = pipeline::write_unproven(defective(geometry::LatticeKind::decimal));
  for (std::size_t size = 0; size < line.size(); ++size) {
    const auto cut = pipeline::read_unproven(std::string_view(line).substr(0, size));
    CHECK_FALSE(cut);
  }
  for (std::size_t at = 0; at < line.size(); ++at) {
    for (const char other : {' ', '-', '9', 'x', 'e', '\0'}) {
      std::string changed = line;
      changed[at] = other;
      static_cast<void>(pipeline::read_unproven(changed));
    }
  }
  for (
      const char* const hostile :
      {"", " ", "0", "9 9 9", "2 1 0 1 0 1 0 0 0 0 0 0 0 0 18446744073709551615 1",
       "2 1 0 1 0 1 0 0 0 0 0 0 0 0 0 1 4294967295", "2 1 0 1 0 1 0 0 0 0 0 0 0 0 1 0 nan nan inf",
       R"({"lattice":[9,1,0,1,0,1,0,0,0,0,0,0,0],"srid":0,"boundaries":[],"vertices":{"count":0,"solids":[],"others":[]}})",
       R"({"lattice":[2,1,0,1,0,1,0,0,0,0,0,0,0],"srid":0,"boundaries":[[[[0]]]],"vertices":{"count":0,"solids":[],"others":[]}})",
       R"({"lattice":[2,1,0,1,0,1,0,0,0,0,0,0,0],"srid":0,"boundaries":[],"vertices":{"count":6148914691236517206,"solids":[],"others":[1,2]}})",
       R"({"lattice":[2,1,0,1,0,1,0,0,0,0,0,0,0],"srid":0,"boundaries":[],"vertices":{"count":1,"solids":[],"others":[1,2,nan]}})"}) {
    CHECK_FALSE(pipeline::read_unproven(hostile));
  }
}

TEST_CASE("a factor that all coordinates of an axis have is left out of a line") {
  SolidArrays arrays = defective(geometry::LatticeKind::decimal).arrays();
  arrays.vertices = {{0, 0, 0}, {4, 0, 7}, {4, 3, 0}, {0, 5, 1}, {9, 0, 0}, {3, 2, 2}};
  const auto plain = Solid::make(arrays, Lattice{}, 7415);
  REQUIRE(plain);
  const std::string before = pipeline::write_unproven(*plain);
  for (Point& point : arrays.vertices) point[1] *= 1000;
  const auto solid = Solid::make(arrays, Lattice{}, 7415);
  REQUIRE(solid);
  const std::string line = pipeline::write_unproven(*solid);
  CHECK(before.find("units") == std::string::npos);
  CHECK(line.find(R"("units":[1,1000,1],"boundaries")") != std::string::npos);
  const auto back = pipeline::read_unproven(line);
  REQUIRE(back);
  CHECK(*back == *solid);
}

TEST_CASE("a line of numbers, the older form of an unproven solid, is read") {
  const auto solid = pipeline::read_unproven(
      "0 1 -3 1 -3 1 -3 85 -1 0 0 0 0 7415 3 1 5 6 7 1 0 0 0 -2 1 3 0 1 2 1 3 1 1 1 1");
  REQUIRE(solid);
  CHECK(solid->srid() == 7415);
  CHECK(solid->vertex_count() == 3);
  CHECK(solid->vertices()[2] == Point{6, 4, 8});
  CHECK(solid->facet_count() == 1);
}

pipeline::IngestOptions keeping() {
  pipeline::IngestOptions options;
  options.collection = "town";
  options.policy = store::Policy::keep;
  return options;
}

Document document_of(const std::string& text) {
  formats::ReadOptions read;
  read.keep_text = true;
  auto document = formats::read_document(as_bytes(text), Format::city_json_seq, read);
  REQUIRE(document);
  return *std::move(document);
}

const std::string kMixed =
    samples::sequence({samples::feature("good"), samples::feature("open", samples::kOpenFacets)});

TEST_CASE("a file keeps solids that are not proven with their findings, and its bytes come back") {
  auto encoded = pipeline::encode_document(document_of(kMixed), nullptr, keeping());
  REQUIRE(encoded);
  CHECK(encoded->outcome.unproven == 1);
  CHECK(encoded->outcome.unproven_features == 1);
  const auto file = pipeline::write_container(encoded->document);
  REQUIRE(file);
  const auto info = pipeline::describe_container(*file);
  REQUIRE(info);
  CHECK(info->solids == 2);
  CHECK(info->unproven_features == 1);
  REQUIRE(info->unproven.size() == 1);
  CHECK(info->unproven.front().object_id == "open");
  CHECK(info->unproven.front().note == R"({"all_errors":[302]})");
  const auto documents = pipeline::decode_container(*file);
  REQUIRE(documents);
  const auto text = formats::write_document(documents->front(), Format::city_json_seq);
  REQUIRE(text);
  CHECK(as_text(*text) == kMixed);
}

TEST_CASE("a repaired solid says how it was repaired, in files and in stored features") {
  Document document = document_of(kMixed);
  repair::RepairOptions options;
  options.remedies = *repair::remedies_of("all");
  REQUIRE(pipeline::repair_document(document, nullptr, options, 1));
  CHECK(document.features[0].solids[0].repair.empty());
  const std::string repair = document.features[1].solids[0].repair;
  CHECK(repair.starts_with(R"({"outcome":"repaired","remedies":["fill"],"codes_before":[302],)"));
  auto encoded = pipeline::encode_document(std::move(document), nullptr, keeping());
  REQUIRE(encoded);
  CHECK(encoded->outcome.unproven == 0);
  const pipeline::EncodedFeature& feature = encoded->document.features[1];
  CHECK(pipeline::proof_json(feature).find(R"("repair":)" + repair) != std::string::npos);

  const auto file = pipeline::write_container(encoded->document);
  REQUIRE(file);
  const auto info = pipeline::describe_container(*file);
  REQUIRE(info);
  REQUIRE(info->repaired.size() == 1);
  CHECK(info->repaired.front().feature == "open");
  CHECK(info->repaired.front().note == repair);
  const auto documents = pipeline::decode_container(*file);
  REQUIRE(documents);
  CHECK(documents->front().features[1].solids[0].repair == repair);
}

TEST_CASE("a collection takes the policy of the write that makes it, and later writes follow it") {
  samples::MemoryStore store;
  REQUIRE(pipeline::ingest(document_of(kMixed), store, nullptr, keeping()));
  auto collection = store.collection("town");
  REQUIRE(collection);
  CHECK(collection->policy == store::Policy::keep);
  CHECK(collection->features == 2);
  CHECK(collection->unproven == 1);
  pipeline::IngestOptions silent = keeping();
  silent.policy = std::nullopt;
  const auto more = pipeline::ingest(
      document_of(samples::sequence({samples::feature("other", samples::kOpenFacets)})), store,
      nullptr, silent);
  REQUIRE(more);
  CHECK(more->stored == 1);
  CHECK(store.collection("town")->unproven_features == 2);
  pipeline::IngestOptions refusing = keeping();
  refusing.policy = store::Policy::refuse;
  const auto refused = pipeline::ingest(document_of(kMixed), store, nullptr, refusing);
  REQUIRE(refused);
  CHECK(refused->stored == 0);
  CHECK(store.collection("town")->policy == store::Policy::keep);
  // The default for a collection that nobody gave a policy is to refuse.
  silent.collection = "village";
  CHECK(pipeline::ingest(document_of(kMixed), store, nullptr, silent)->stored == 0);
}

/// A box, and a second solid with a vertex index that is out of range, in one feature.
std::string half_readable() {
  std::string line = samples::feature("a");
  const std::string first = std::string("[") + std::string(samples::kBoxFacets) + "]}";
  const std::size_t end = line.find(first) + first.size();
  return line.insert(end, R"(,{"type":"Solid","lod":"1","boundaries":[[[[0,1,99]]]]})");
}

TEST_CASE("a feature that was marked as not proven is not proven when its file is read again") {
  auto encoded = pipeline::encode_document(document_of(samples::sequence({half_readable()})),
                                           nullptr, keeping());
  REQUIRE(encoded);
  CHECK(encoded->outcome.unproven == 0);
  CHECK(encoded->outcome.unproven_features == 1);
  const Report& unread = encoded->outcome.features.front().solids.back().report;
  CHECK(unread.first_level == std::vector<int>{901});
  const auto file = pipeline::write_container(encoded->document);
  REQUIRE(file);
  auto documents = pipeline::decode_container(*file);
  REQUIRE(documents);
  auto again = pipeline::encode_document(std::move(documents->front()), nullptr, keeping());
  REQUIRE(again);
  CHECK(again->outcome.verdict == Verdict::invalid);
  CHECK(again->outcome.unproven_features == 1);

  samples::MemoryStore store;
  pipeline::IngestOptions refusing = keeping();
  refusing.policy = store::Policy::refuse;
  pipeline::Ingestion ingestion(store, nullptr, refusing,
                                [](pipeline::FeatureOutcome&&) -> Status { return Done{}; });
  REQUIRE(ingestion.add_container(*file));
  REQUIRE(ingestion.finish());
  CHECK(ingestion.is_refused());
}

TEST_CASE("skip leaves out what cannot be read, and keeps the rest of the feature") {
  pipeline::IngestOptions options = keeping();
  options.policy = store::Policy::skip;
  const auto encoded = pipeline::encode_document(document_of(samples::sequence({half_readable()})),
                                                 nullptr, options);
  REQUIRE(encoded);
  REQUIRE(encoded->document.features.size() == 1);
  CHECK(encoded->document.features.front().is_proven());
  CHECK(encoded->document.features.front().solids.size() == 1);
  const pipeline::FeatureOutcome& outcome = encoded->outcome.features.front();
  REQUIRE(outcome.left_out.size() == 1);
  CHECK(outcome.left_out.front() == formats::GeometryPlace{"a", 1});
  CHECK(outcome.rejected.find("[[[[0,1,99]]]]") != std::string::npos);
}

TEST_CASE("skip counts the bytes of the solids that it keeps, whose geometries have new numbers") {
  // Geometry 0 is open; 1 and 2 are boxes, which become 0 and 1.
  const auto geometry = [](const std::string& lod, std::string_view facets) {
    std::string text = R"({"type":"Solid","lod":")" + lod + R"(","boundaries":[)";
    return text.append(facets).append("]}");
  };
  std::string line = samples::feature("a");
  const std::size_t begin = line.find(R"({"type":"Solid")");
  const std::size_t end = line.find("]}},\"vertices\"");
  line.replace(begin, end - begin,
               geometry("1", samples::kOpenFacets) + "," + geometry("2", samples::kBoxFacets) +
                   "," + geometry("3", samples::kBoxFacets));
  pipeline::IngestOptions options = keeping();
  options.policy = store::Policy::skip;
  const auto encoded =
      pipeline::encode_document(document_of(samples::sequence({line})), nullptr, options);
  REQUIRE(encoded);
  REQUIRE(encoded->document.features.size() == 1);
  const auto& kept = encoded->document.features.front().solids;
  REQUIRE(kept.size() == 2);
  const pipeline::FeatureOutcome& outcome = encoded->outcome.features.front();
  REQUIRE(outcome.solids.size() == 3);
  CHECK(outcome.solids[0].blob_bytes == 0);
  CHECK(outcome.solids[1].blob_bytes == kept[0].blob.size());
  CHECK(outcome.solids[2].blob_bytes == kept[1].blob.size());
  CHECK_FALSE(kept[0].blob.empty());
}

TEST_CASE("an export of what is proven leaves the other features out") {
  samples::MemoryStore store;
  REQUIRE(pipeline::ingest(document_of(kMixed), store, nullptr, keeping()));
  for (const auto scope : {pipeline::ExportScope::all, pipeline::ExportScope::proven}) {
    auto exporting = pipeline::CollectionExport::start(store, "town",
                                                       pipeline::ExportFormat::sequence, {}, scope);
    REQUIRE(exporting);
    std::string text;
    while (!exporting->is_at_end()) {
      const auto bytes = exporting->next();
      REQUIRE(bytes);
      text += as_text(*bytes);
    }
    CHECK(text.find("\"good\"") != std::string::npos);
    CHECK((text.find("\"open\"") != std::string::npos) == (scope == pipeline::ExportScope::all));
  }
}

}  // namespace
}  // namespace watertight::test_unproven
