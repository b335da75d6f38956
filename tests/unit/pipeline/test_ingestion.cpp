// SPDX-License-Identifier: GPL-3.0-or-later
//
// Documents that are longer than memory, and Watertight files of several documents, on the way into
// a store.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "pipeline/export.h"
#include "pipeline/outcome_json.h"
#include "pipeline/streaming/ingestion.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_ingestion {
namespace {

/// A store that notes how much it was given at once.
class MeasuringStore : public samples::MemoryStore {
 public:
  std::size_t puts = 0;
  std::size_t largest_batch = 0;
  std::size_t batches = 0;

  Result<std::vector<std::uint64_t>> put(std::span<const StoredFeature> features,
                                         const store::WriteCondition& condition) override {
    ++puts;
    return MemoryStore::put(features, condition);
  }
  Result<std::vector<std::uint64_t>> put_all(store::FeatureBatches& given,
                                             const store::WriteCondition& condition) override {
    // A transaction that is tried again reads the batches again.
    for (int attempt = 0; attempt < 2; ++attempt) {
      batches = 0;
      REQUIRE(given.rewind());
      for (auto batch = given.next(); batch && !batch->empty(); batch = given.next()) {
        ++batches;
        largest_batch = std::max(largest_batch, batch->size());
      }
    }
    return MemoryStore::put_all(given, condition);
  }
};

std::vector<std::string> boxes(std::size_t count) {
  std::vector<std::string> features;
  for (std::size_t i = 0; i < count; ++i) {
    features.push_back(samples::feature(std::string("f").append(std::to_string(i))));
  }
  return features;
}

formats::FeatureReader reader_of(const std::string& text) {
  formats::ReadOptions options;
  options.keep_text = true;
  auto reader = formats::FeatureReader::open(
      [rest = text](std::span<std::uint8_t> bytes) mutable -> Result<std::size_t> {
        const std::size_t count = std::min(bytes.size(), rest.size());
        std::copy_n(rest.begin(), count, bytes.begin());
        rest.erase(0, count);
        return count;
      },
      ".jsonl", options);
  REQUIRE(reader);
  return *std::move(reader);
}

pipeline::IngestOptions into(const std::string& collection) {
  pipeline::IngestOptions options;
  options.collection = collection;
  options.batch_bytes = 10'000;  // some ten boxes
  return options;
}

Result<pipeline::IngestOutcome> ingest_text(const std::string& text, SolidStore& store,
                                            const pipeline::IngestOptions& options,
                                            std::size_t most_outcomes = 1000) {
  pipeline::OutcomeKeeper keeper(most_outcomes, 1'000'000);
  pipeline::Ingestion ingestion(store, nullptr, options,
                                [&](pipeline::FeatureOutcome&& outcome) -> Status {
                                  keeper.add(std::move(outcome));
                                  return Done{};
                                });
  auto reader = reader_of(text);
  if (Status added = ingestion.add(reader); !added) return std::move(added).error();
  const auto counts = ingestion.finish();
  if (!counts) return counts.error();
  return std::move(keeper).outcome(*counts, ingestion);
}

Bytes export_of(SolidStore& store, const std::string& collection) {
  auto exporting =
      pipeline::CollectionExport::start(store, collection, pipeline::ExportFormat::container);
  REQUIRE(exporting);
  Bytes all;
  for (;;) {
    const auto bytes = exporting->next();
    REQUIRE(bytes);
    if (bytes->empty()) return all;
    all.insert(all.end(), bytes->begin(), bytes->end());
  }
}

void check_equal(const StoredFeature& a, const StoredFeature& b) {
  INFO(a.id);
  CHECK(a.id == b.id);
  CHECK(a.type == b.type);
  CHECK(a.srid == b.srid);
  CHECK(a.format == b.format);
  CHECK(a.header == b.header);
  CHECK(a.skeleton == b.skeleton);
  REQUIRE(a.box.has_value() == b.box.has_value());
  REQUIRE(a.solids.size() == b.solids.size());
  for (std::size_t i = 0; i < a.solids.size(); ++i) {
    CHECK(a.solids[i].object_id == b.solids[i].object_id);
    CHECK(a.solids[i].geometry == b.solids[i].geometry);
    CHECK(a.solids[i].ordinal == b.solids[i].ordinal);
    CHECK(a.solids[i].lod == b.solids[i].lod);
    CHECK(a.solids[i].blob == b.solids[i].blob);
    CHECK(a.solids[i].measures == b.solids[i].measures);
    CHECK(a.solids[i].report == b.solids[i].report);
  }
}

TEST_CASE("a long document reaches the store in small batches of one write") {
  MeasuringStore store;
  const auto outcome = ingest_text(samples::sequence(boxes(100)), store, into("town"));
  REQUIRE(outcome);
  CHECK(outcome->stored == 100);
  CHECK(store.puts == 0);
  CHECK(store.batches > 4);
  CHECK(store.largest_batch < 25);
  samples::MemoryStore whole;
  pipeline::IngestOptions at_once = into("town");
  at_once.batch_bytes = std::size_t{1} << 30U;
  REQUIRE(ingest_text(samples::sequence(boxes(100)), whole, at_once));
  for (std::size_t i = 0; i < 100; ++i) {
    const std::string id = std::string("f").append(std::to_string(i));
    const auto in_batches = store.get("town", id);
    const auto together = whole.get("town", id);
    REQUIRE(in_batches);
    REQUIRE(together);
    check_equal(*in_batches, *together);
    CHECK(in_batches->version == outcome->features[i].version);
  }
}

TEST_CASE("a short document is one write of the store") {
  MeasuringStore store;
  REQUIRE(ingest_text(samples::sequence(boxes(3)), store, into("town")));
  CHECK(store.puts == 1);
  CHECK(store.batches == 0);
}

TEST_CASE("nothing of a long document is stored when its last feature is not good") {
  samples::MemoryStore store;
  const std::string good = samples::sequence(boxes(60));
  const auto refused =
      ingest_text(good + samples::feature("open", samples::kOpenFacets), store, into("town"));
  REQUIRE(refused);
  CHECK(refused->verdict == Verdict::invalid);
  CHECK(refused->stored == 0);
  for (const std::string& last : {samples::feature("f7"), std::string("{\"type\":")}) {
    pipeline::IngestOptions skip = into("town");
    skip.policy = store::Policy::skip;
    const auto failed = ingest_text(good + last, store, skip);
    REQUIRE_FALSE(failed);
    CHECK(failed.error().code == ErrorCode::malformed);
  }
  CHECK_FALSE(store.collection("town"));
}

TEST_CASE("the valid features of a long document are stored when the others are skipped") {
  samples::MemoryStore store;
  std::vector<std::string> features = boxes(60);
  features.insert(features.begin() + 30, samples::feature("open", samples::kOpenFacets));
  pipeline::IngestOptions skip = into("town");
  skip.policy = store::Policy::skip;
  skip.threads = 2;
  const auto outcome = ingest_text(samples::sequence(features), store, skip);
  REQUIRE(outcome);
  CHECK(outcome->stored == 60);
  CHECK(outcome->invalid == 1);
  CHECK_FALSE(outcome->features[30].is_stored);
  const auto last = store.get("town", "f59");
  REQUIRE(last);
  CHECK(last->version == outcome->features[60].version);
}

TEST_CASE("the answer to a long document keeps the outcomes of features that are not valid") {
  samples::MemoryStore store;
  std::vector<std::string> features = boxes(20);
  features[12] = samples::feature("open", samples::kOpenFacets);
  pipeline::IngestOptions skip = into("town");
  skip.policy = store::Policy::skip;
  const auto outcome = ingest_text(samples::sequence(features), store, skip, 5);
  REQUIRE(outcome);
  REQUIRE(outcome->features.size() == 1);
  CHECK(outcome->features[0].id == "open");
  CHECK(outcome->total == 20);
  const std::string json = pipeline::outcome_json(*outcome);
  CHECK(json.find(R"("counts":{"features":20,"valid":19,"invalid":1,"undecided":0})") !=
        std::string::npos);
  CHECK(json.find(R"("featuresOmitted":19)") != std::string::npos);
}

TEST_CASE("features without ids are named, or refused without a name") {
  Document document;
  document.format = Format::obj;
  const auto box = formats::read_document(as_bytes(samples::sequence({samples::feature("a")})),
                                          Format::city_json_seq);
  REQUIRE(box);
  Feature feature = box->features[0];
  feature.id.clear();
  feature.skeleton.clear();
  document.features = {feature, feature};
  samples::MemoryStore store;
  const auto refused = pipeline::ingest(document, store, nullptr, into("town"));
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::malformed);
  pipeline::IngestOptions named = into("town");
  named.unnamed = "house";
  const auto outcome = pipeline::ingest(document, store, nullptr, named);
  REQUIRE(outcome);
  CHECK_FALSE(outcome->features[0].has_own_id);
  CHECK(store.get("town", "house"));
  CHECK(store.get("town", "house-2"));
}

TEST_CASE("a collection of several documents comes back from its export") {
  samples::MemoryStore store;
  std::string coarse = samples::sequence({samples::feature("c1"), samples::feature("c2")});
  coarse.replace(coarse.find("0.001,0.001,0.001"), 17, "0.002,0.002,0.002");
  std::string spaced = samples::sequence({samples::feature("s 1"), "  " + samples::feature("s2")});
  spaced.replace(spaced.find("0.001,0.001,0.001"), 17, "0.005,0.005,0.005");
  REQUIRE(ingest_text(samples::sequence({samples::feature("a"), samples::feature("b")}), store,
                      into("town")));
  REQUIRE(ingest_text(coarse, store, into("town")));
  pipeline::IngestOptions boundary = into("town");
  boundary.contract = formats::Contract::boundary;
  REQUIRE(ingest_text(spaced, store, boundary));
  const auto documents = store.documents("town", 10);
  REQUIRE(documents);
  REQUIRE(documents->size() == 3);

  const Bytes file = export_of(store, "town");
  pipeline::Ingestion ingestion(store, nullptr, into("copy"),
                                [](pipeline::FeatureOutcome&&) -> Status { return Done{}; });
  const Status added = ingestion.add_container(file);
  INFO((added ? std::string() : to_string(added.error())));
  REQUIRE(added);
  const auto counts = ingestion.finish();
  REQUIRE(counts);
  CHECK(counts->stored == 6);
  CHECK(export_of(store, "copy") == file);
  for (const char* id : {"a", "b", "c1", "c2", "s 1", "s2"}) {
    const auto original = store.get("town", id);
    const auto copy = store.get("copy", id);
    REQUIRE(original);
    REQUIRE(copy);
    check_equal(*copy, *original);
  }
}

TEST_CASE("solids of a document without a city model are stored repaired") {
  const std::string text =
      "o box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  auto document = formats::read_document(as_bytes(text), Format::obj, {});
  REQUIRE(document);
  samples::MemoryStore store;
  pipeline::IngestOptions options = into("boxes");
  options.repair.emplace().remedies = *repair::remedies_of("fill");
  pipeline::Ingestion ingestion(store, nullptr, options,
                                [](pipeline::FeatureOutcome&&) -> Status { return Done{}; });
  auto reader = formats::FeatureReader::of(*std::move(document));
  REQUIRE(ingestion.add(reader));
  const auto counts = ingestion.finish();
  REQUIRE(counts);
  CHECK(counts->stored == 1);
  const auto stored = store.get("boxes", "box");
  REQUIRE(stored);
  const auto back = pipeline::from_stored(*stored);
  REQUIRE(back);
  CHECK(back->features.front().solids.front().solid.facet_count() == 6);
  CHECK(back->features.front().solids.front().repair.starts_with(R"({"outcome":"repaired",)"));
  const auto written = formats::write_document(*back, Format::obj);
  REQUIRE(written);
  CHECK(as_text(*written).starts_with("o box\nv 0 0 0\n"));
}

TEST_CASE("nothing of a damaged Watertight file is stored") {
  samples::MemoryStore store;
  REQUIRE(ingest_text(samples::sequence(boxes(3)), store, into("town")));
  Bytes file = export_of(store, "town");
  file.resize(file.size() - 10);
  pipeline::Ingestion ingestion(store, nullptr, into("copy"),
                                [](pipeline::FeatureOutcome&&) -> Status { return Done{}; });
  CHECK_FALSE(ingestion.add_container(file));
  CHECK_FALSE(store.collection("copy"));
}

TEST_CASE(
    "a CityJSON that a Watertight file holds as a whole is split and stored by its features") {
  const std::string sequence = samples::sequence({samples::feature("a"), samples::feature("b")});
  const auto split = formats::read_city_json_seq(sequence, {});
  REQUIRE(split);
  const auto text = formats::write_city_json(*split);
  REQUIRE(text);
  formats::ReadOptions read;
  read.split_features = false;
  read.keep_text = true;
  auto document = formats::read_city_json(*text, read);
  REQUIRE(document);
  auto encoded = pipeline::encode_document(*std::move(document), nullptr, into("town"));
  REQUIRE(encoded);
  const auto file = pipeline::write_container(encoded->document);
  REQUIRE(file);
  const auto nothing = [](pipeline::FeatureOutcome&&) -> Status { return Done{}; };
  samples::MemoryStore store;
  {
    pipeline::Ingestion refusing(store, nullptr, into("town"), nothing);
    const Status refused = refusing.add_container(*file);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == ErrorCode::unsupported);
  }
  pipeline::Ingestion ingestion(store, nullptr, into("town"), nothing);
  REQUIRE(ingestion.add_container(*file, {}, pipeline::WholeModels::split));
  const auto counts = ingestion.finish();
  REQUIRE(counts);
  CHECK(counts->stored == 2);
  samples::MemoryStore wanted;
  REQUIRE(pipeline::ingest(*formats::read_city_json(*text, {}), wanted, nullptr, into("town")));
  for (const char* id : {"a", "b"}) {
    const auto found = store.get("town", id);
    const auto same = wanted.get("town", id);
    REQUIRE(found);
    REQUIRE(same);
    check_equal(*found, *same);
  }
}

}  // namespace
}  // namespace watertight::test_ingestion
