// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "geopackage/collection_file.h"
#include "geopackage/database.h"
#include "geopackage/package.h"
#include "pipeline/pipeline.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight {
namespace {

using geopackage::collection_file;
using geopackage::CollectionChoice;

Bytes bytes_of(const TemporaryFile& file) {
  auto bytes = file.read(0, file.size());
  REQUIRE(bytes);
  return *std::move(bytes);
}

/// A GeoPackage that is read by SQL. It has a name while the object lives.
class Opened {
 public:
  explicit Opened(const Bytes& bytes) : path_(name()) {
    std::ofstream(path_, std::ios::binary) << as_text(bytes);
    auto opened = geopackage::Database::open_empty(path_);
    REQUIRE(opened);
    database_.emplace(*std::move(opened));
  }
  ~Opened() { std::filesystem::remove(path_); }
  Opened(const Opened&) = delete;

  /// The rows of a query: columns with | between them.
  std::vector<std::string> ask(const std::string& query, int columns) {
    auto statement = database_->prepare(query);
    INFO(query << (statement ? "" : ": " + statement.error().message));
    REQUIRE(statement);
    std::vector<std::string> rows;
    for (;;) {
      const auto has_row = statement->step();
      REQUIRE(has_row);
      if (!*has_row) return rows;
      std::string row;
      for (int column = 0; column < columns; ++column) {
        if (column > 0) row += '|';
        row += statement->is_null(column) ? "null" : std::string(statement->text(column));
      }
      rows.push_back(std::move(row));
    }
  }

 private:
  static std::string name() {
    std::string text = (std::filesystem::temp_directory_path() / "watertight-XXXXXX").string();
    const int descriptor = ::mkstemp(text.data());
    REQUIRE(descriptor >= 0);
    return text;
  }

  std::string path_;
  std::optional<geopackage::Database> database_;
};

using Rows = std::vector<std::string>;

const std::string kOneOpen =
    samples::sequence({samples::feature("a"), samples::feature("open", samples::kOpenFacets)});

void store_sequence(SolidStore& store, const std::string& text) {
  auto document = formats::read_document(as_bytes(text), Format::city_json_seq);
  REQUIRE(document);
  pipeline::IngestOptions options;
  options.collection = "town";
  options.policy = store::Policy::keep;
  REQUIRE(pipeline::ingest(*std::move(document), store, nullptr, options));
}

std::string with_attributes(const std::string& id, const std::string& attributes) {
  std::string text = samples::feature(id);
  const std::string own = R"({"height":2.50})";
  text.replace(text.find(own), own.size(), attributes);
  return text;
}

TEST_CASE("a collection is a GeoPackage with a row for each feature") {
  samples::MemoryStore store;
  store_sequence(store, samples::sequence({samples::feature("a"), samples::feature("b")}));
  const auto made = collection_file(store, "town", {});
  REQUIRE(made);
  CHECK(made->features == 2);
  CHECK(made->findings == 0);
  const Bytes bytes = bytes_of(made->file);
  CHECK(as_text(bytes).starts_with("SQLite format 3"));
  Opened file(bytes);
  CHECK(file.ask("PRAGMA integrity_check", 1) == Rows{"ok"});
  CHECK(file.ask("PRAGMA foreign_key_check", 1).empty());
  CHECK(file.ask("PRAGMA application_id", 1) == Rows{std::to_string(0x47504B47)});
  CHECK(file.ask("SELECT table_name, data_type, min_x, min_y, max_x, max_y, srs_id FROM "
                 "gpkg_contents",
                 7) == Rows{"town|features|100.0|200.0|101.0|201.0|7415"});
  CHECK(file.ask("SELECT geometry_type_name, z FROM gpkg_geometry_columns", 2) ==
        Rows{"MULTIPOLYGON|1"});
  CHECK(file.ask("SELECT organization_coordsys_id FROM gpkg_spatial_ref_sys ORDER BY srs_id", 1) ==
        Rows{"-1", "0", "4326", "7415"});
  CHECK(file.ask("SELECT id, height, wt_type, wt_proven, wt_solids FROM town", 5) ==
        Rows{"a|2.5|Building|1|1", "b|2.5|Building|1|1"});
  CHECK(file.ask("SELECT id FROM rtree_town_geom WHERE minx <= 100.5 AND maxx >= 100.5", 1) ==
        Rows{"1", "2"});
}

TEST_CASE("equal collections give GeoPackages with equal bytes") {
  Bytes first;
  for (int round = 0; round < 2; ++round) {
    samples::MemoryStore store;
    store_sequence(store, samples::sequence({samples::feature("a")}));
    const auto made = collection_file(store, "town", {});
    REQUIRE(made);
    if (round == 0) first = bytes_of(made->file);
    if (round == 1) CHECK(bytes_of(made->file) == first);
  }
}

TEST_CASE("the columns of a GeoPackage have the types of the values") {
  samples::MemoryStore store;
  store_sequence(
      store,
      samples::sequence(
          {with_attributes(
               "a", R"({"n":1,"r":1,"t":true,"mixed":1,"s":"x\"'\n","o":{"k":[1]},"Name":"up",)"
                    R"("name":"low","fid":7,"big":123456789012345678901234567890,"e":null})"),
           with_attributes("b", R"({"n":-9007199254740993,"r":0.5,"t":false,"mixed":true})")}));
  const auto made = collection_file(store, "town", {});
  REQUIRE(made);
  Opened file(bytes_of(made->file));
  const auto types = file.ask(
      "SELECT name || ' ' || type FROM pragma_table_info('town') WHERE name NOT LIKE "
      "'wt_%' ORDER BY name",
      1);
  CHECK(types == Rows{"Name TEXT", "big REAL", "e TEXT", "fid INTEGER", "fid_2 INTEGER",
                      "geom MULTIPOLYGON", "id TEXT", "mixed TEXT", "n INTEGER", "name_2 TEXT",
                      "o TEXT", "r REAL", "s TEXT", "t BOOLEAN"});
  CHECK(file.ask("SELECT n, r, t, mixed, o, Name, name_2, fid_2, e FROM town", 9) ==
        Rows{R"(1|1.0|1|1|{"k":[1]}|up|low|7|null)",
             "-9007199254740993|0.5|0|true|null|null|null|null|null"});
  CHECK(file.ask("SELECT s FROM town WHERE id = 'a'", 1) == Rows{"x\"'\n"});
}

TEST_CASE("attributes beyond the most columns of a GeoPackage are one JSON object") {
  samples::MemoryStore store;
  std::string attributes = "{";
  for (int i = 0; i < 1100; ++i) {
    if (i > 0) attributes += ',';
    attributes.append("\"k").append(std::to_string(i)).append("\":").append(std::to_string(i));
  }
  store_sequence(store, samples::sequence({with_attributes("a", attributes + "}")}));
  const auto made = collection_file(store, "town", {});
  REQUIRE(made);
  Opened file(bytes_of(made->file));
  CHECK(file.ask("SELECT count(*) FROM pragma_table_info('town')", 1) == Rows{"1003"});
  CHECK(file.ask("SELECT json_extract(further_attributes, '$.k1099'), k998 FROM town", 2) ==
        Rows{"1099|998"});
}

TEST_CASE("the defects of what is not proven are a layer of the GeoPackage") {
  samples::MemoryStore store;
  store_sequence(store, kOneOpen);
  const auto made = collection_file(store, "town", {});
  REQUIRE(made);
  CHECK(made->features == 2);
  CHECK(made->findings >= 1);
  Opened file(bytes_of(made->file));
  CHECK(file.ask("SELECT table_name FROM gpkg_contents ORDER BY 1", 1) ==
        Rows{"town", "town_findings"});
  CHECK(file.ask("SELECT feature, object, lod, code, name, severity FROM town_findings LIMIT 1",
                 6) == Rows{"open|open|2.2|302|SHELL_NOT_CLOSED|error"});
  CHECK(file.ask("SELECT geometry_type_name FROM gpkg_geometry_columns ORDER BY table_name", 1) ==
        Rows{"MULTIPOLYGON", "POINT"});
  const auto unproven = collection_file(store, "town", {.scope = pipeline::ExportScope::unproven});
  REQUIRE(unproven);
  CHECK(unproven->features == 1);
}

TEST_CASE("a GeoPackage of a CRS that nobody knows keeps its coordinates") {
  samples::MemoryStore store;
  std::string text = samples::sequence({samples::feature("a")});
  text.replace(text.find("/7415"), 5, "/999999");
  store_sequence(store, text);
  const auto made = collection_file(store, "town", {});
  REQUIRE(made);
  Opened file(bytes_of(made->file));
  CHECK(file.ask("SELECT srs_id, min_x FROM gpkg_contents", 2) == Rows{"-1|100.0"});
  // The number of the system stands in the header of each geometry, too.
  CHECK(file.ask("SELECT hex(substr(geom, 5, 4)) FROM town", 1) == Rows{"FFFFFFFF"});
}

TEST_CASE("a GeoPackage that cannot be finished gives the reason") {
  samples::MemoryStore store;
  store_sequence(store, kOneOpen);
  CHECK(collection_file(store, "none", {}).error().code == ErrorCode::not_found);
  CHECK(collection_file(store, "town", {}, [] { return true; }).error().code ==
        ErrorCode::cancelled);
  const auto no_room = collection_file(store, "town", {}, {}, [](std::uint64_t) { return false; });
  CHECK(no_room.error().code == ErrorCode::limit_exceeded);
  store::Filter never{store::Filter::Kind::constant};
  never.truth = false;
  CHECK(collection_file(store, "town", {.filter = never}).error().code == ErrorCode::not_found);
}

TEST_CASE("layers have no names that SQLite and GeoPackages keep for themselves") {
  CHECK(geopackage::layer_name("town") == "town");
  CHECK(geopackage::layer_name("GPKG_town") == "layer_GPKG_town");
  CHECK(geopackage::layer_name("sqlite_x") == "layer_sqlite_x");
  CHECK(geopackage::sql_name("a\"b") == "\"a\"\"b\"");
}

}  // namespace
}  // namespace watertight
