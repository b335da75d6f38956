// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests bulk export against PostgreSQL: rows hold single blobs, the exported file holds pages, and
// both must give the same solids.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <map>

#include "codec/page_file.h"
#include "fixture.h"
#include "formats/ewkb.h"
#include "pipeline/export.h"
#include "server/routes.h"
#include "tests/files.h"
#include "tests/unit/server/answers.h"

namespace watertight {
namespace {

using test::Database;

/// Stores the sample tile in a collection; Policy::skip leaves out the solids that need an engine.
/// Returns its text.
std::string ingest_tile(SolidStore& store, store::Policy policy = store::Policy::skip) {
  const Bytes bytes = test::read_bytes(test::source_path("examples/delft.city.jsonl"));
  formats::ReadOptions read;
  read.keep_text = true;
  auto document = formats::read_document(bytes, Format::city_json_seq, read);
  REQUIRE(document);
  pipeline::IngestOptions options;
  options.collection = "delft";
  options.policy = policy;
  const auto outcome = pipeline::ingest(*std::move(document), store, nullptr, options);
  REQUIRE(outcome);
  REQUIRE(outcome->stored > 20);
  return std::string(as_text(bytes));
}

Bytes export_all(SolidStore& store, pipeline::ExportFormat format,
                 pipeline::Exported* exported = nullptr,
                 pipeline::SolidLayout layout = pipeline::SolidLayout::pages) {
  auto exporting = pipeline::CollectionExport::start(store, "delft", format, {.layout = layout});
  REQUIRE(exporting);
  Bytes all;
  for (;;) {
    const auto bytes = exporting->next();
    REQUIRE(bytes);
    if (bytes->empty()) break;
    all.insert(all.end(), bytes->begin(), bytes->end());
  }
  if (exported != nullptr) *exported = exporting->exported();
  return all;
}

/// The page file of the only block of a Watertight file (docs/format-file.md).
ByteView page_file_of(ByteView file) {
  ByteReader reader(file.subspan(9));
  reader.varint();  // kind and length of the record
  reader.take(reader.varint());
  return reader.take(reader.varint());
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    lines.emplace_back(text.substr(0, end + 1));
    text.remove_prefix(end + 1);
  }
  return lines;
}

TEST_CASE(
    "an export holds every solid of the rows, in pages that are smaller than the blobs, and finds "
    "each solid alone") {
  const Database database;
  const auto store = database.store();
  ingest_tile(*store);
  pipeline::Exported exported;
  const Bytes file = export_all(*store, pipeline::ExportFormat::container, &exported);
  const auto documents = pipeline::decode_container(file);
  REQUIRE(documents);
  REQUIRE(documents->size() == 1);
  REQUIRE(documents->front().features.size() == exported.features);
  const auto pages = codec::PageFileReader::open(page_file_of(file));
  REQUIRE(pages);
  REQUIRE(pages->size() == exported.solids);
  std::uint64_t number = 0;
  std::uint64_t blob_bytes = 0;
  for (const Feature& feature : documents->front().features) {
    const auto row = store->get("delft", feature.id);
    REQUIRE(row);
    REQUIRE(row->solids.size() == feature.solids.size());
    const auto stored = pipeline::decode_solids(*row);
    REQUIRE(stored);
    REQUIRE(stored->size() == feature.solids.size());
    for (std::size_t i = 0; i < row->solids.size(); ++i, ++number) {
      const auto blob = pipeline::blob_of(*row, i);
      REQUIRE(blob);
      const auto decoded = decode(*blob);
      REQUIRE(decoded);
      CHECK(formats::write_ewkb((*stored)[i].solid) == formats::write_ewkb(decoded->solid));
      CHECK(formats::write_ewkb(feature.solids[i].solid) == formats::write_ewkb(decoded->solid));
      blob_bytes += blob->size();
      if (number % 37 != 0) continue;
      const auto alone = pages->solid(number);
      REQUIRE(alone);
      CHECK(formats::write_ewkb(alone->solid) == formats::write_ewkb(decoded->solid));
    }
  }
  CHECK(number == exported.solids);
  CHECK(page_file_of(file).size() * 3 < blob_bytes * 2);
}

TEST_CASE("an export as a sequence has the very lines that came in, the same each time") {
  const Database database;
  const auto store = database.store();
  std::vector<std::string> source = lines_of(ingest_tile(*store, store::Policy::keep));
  if (source.back().back() != '\n') source.back() += '\n';
  const Bytes bytes = export_all(*store, pipeline::ExportFormat::sequence);
  const std::vector<std::string> lines = lines_of(as_text(bytes));
  REQUIRE(lines.size() == store->collection("delft")->features + 1);
  CHECK(lines.size() == source.size());
  CHECK(store->collection("delft")->unproven > 0);
  for (const std::string& line : lines) {
    CHECK(std::find(source.begin(), source.end(), line) != source.end());
  }
  CHECK(export_all(*store, pipeline::ExportFormat::sequence) == bytes);
  CHECK(export_all(*store, pipeline::ExportFormat::container) ==
        export_all(*store, pipeline::ExportFormat::container));
}

TEST_CASE("the service exports the same sequence as the command line, and blobs as they are") {
  const Database database;
  const auto store = database.store();
  ingest_tile(*store);
  const server::Service service{store.get(), nullptr, {}};
  for (const auto& [target, format] :
       {std::pair{"/collections/delft/export", pipeline::ExportFormat::container},
        std::pair{"/collections/delft/export?f=cityjsonseq", pipeline::ExportFormat::sequence}}) {
    const server::Response response =
        server::respond(service, {"GET", target, {}, ""}, [] { return false; });
    REQUIRE(response.status == 200);
    CHECK(test::whole(response) ==
          as_text(export_all(*store, format, nullptr, pipeline::SolidLayout::blobs)));
  }
}

TEST_CASE("an export ends with an error when the database goes away, and can be begun again") {
  const Database database;
  const auto store = database.store();
  ingest_tile(*store);
  auto exporting =
      pipeline::CollectionExport::start(*store, "delft", pipeline::ExportFormat::sequence);
  REQUIRE(exporting);
  database.ask("ALTER TABLE watertight.feature_row RENAME TO hidden");
  const auto bytes = exporting->next();
  REQUIRE_FALSE(bytes);
  CHECK_FALSE(bytes.error().message.empty());
  database.ask("ALTER TABLE watertight.hidden RENAME TO feature_row");
  REQUIRE(database.end_sessions());
  CHECK_FALSE(export_all(*store, pipeline::ExportFormat::sequence).empty());
}

}  // namespace
}  // namespace watertight
