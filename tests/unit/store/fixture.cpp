// SPDX-License-Identifier: GPL-3.0-or-later
#include "fixture.h"

#include <unistd.h>

#include <catch2/catch_test_macros.hpp>
#include <cstdlib>
#include <filesystem>

namespace watertight::test {
namespace {

std::string new_folder() {
  std::string name = "/tmp/watertight-test-XXXXXX";
  return mkdtemp(name.data()) == nullptr ? std::string() : name;
}

/// The folder of the shared cluster: one for all test processes under ctest, else one for each
/// process.
std::string shared_folder() {
  if (const char* shared = std::getenv("WATERTIGHT_TEST_CLUSTER")) return shared;
  static const TemporaryFolder own;
  return own.path;
}

}  // namespace

TemporaryFolder::TemporaryFolder() : path(new_folder()) { REQUIRE(!path.empty()); }

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

std::unique_ptr<store::DatabaseSession> session_in(const std::string& connection) {
  auto opened = store::DatabaseSession::open(connection);
  REQUIRE(std::holds_alternative<std::unique_ptr<store::DatabaseSession>>(opened));
  return std::move(std::get<std::unique_ptr<store::DatabaseSession>>(opened));
}

std::string ask(const std::string& connection, const std::string& statement) {
  const auto session = session_in(connection);
  const Result<store::Rows> rows = session->run(statement);
  INFO((rows ? std::string() : to_string(rows.error())));
  REQUIRE(rows);
  return rows->size() == 0 ? std::string() : std::string(rows->text(0, 0));
}

Database::Database() {
  static int number = 0;
  name_ = "t" + std::to_string(getpid()) + "_" + std::to_string(++number);
  Result<std::unique_ptr<store::PrivateCluster>> started =
      store::PrivateCluster::start({shared_folder()});
  INFO((started ? std::string() : to_string(started.error())));
  REQUIRE(started);
  cluster_ = std::move(*started);
  test::ask(cluster_->connection(), "CREATE DATABASE " + name_ + " TEMPLATE template0");
  connection_ = cluster_->connection() + " dbname=" + name_;
}

Database::~Database() {
  const auto session = session_in(cluster_->connection());
  const Result<store::Rows> gone = session->run("DROP DATABASE " + name_ + " WITH (FORCE)");
  static_cast<void>(gone);
}

std::string Database::socket() const {
  return ask("SELECT trim('\"' FROM current_setting('unix_socket_directories'))") +
         "/.s.PGSQL.5432";
}

std::unique_ptr<SolidStore> Database::store(std::size_t connections) const {
  Result<std::unique_ptr<SolidStore>> opened = store::open_postgres_store(connection_, connections);
  INFO((opened ? std::string() : to_string(opened.error())));
  REQUIRE(opened);
  return std::move(*opened);
}

std::string Database::ask(const std::string& statement) const {
  return test::ask(connection_, statement);
}

void Database::add_many_features() const {
  ask("INSERT INTO watertight.document (key, digest, content) VALUES (1, 'h', 'h')");
  ask("INSERT INTO watertight.collection (key, name, srid, document) VALUES (1, 'c', 0, 1)");
  ask("INSERT INTO watertight.kind (key, collection, document, format, type)"
      " VALUES (1, 1, 1, '', '')");
  ask("INSERT INTO watertight.feature_row (collection, id, kind, dictionary, packed_solids,"
      " packed_text, solids, blob_bytes, unproven, is_proven,"
      " min_x, min_y, min_z, max_x, max_y, max_z, place)"
      " SELECT 1, i::text, 1, 0, '', '', 0, 0, 0, true, i, i, 0, i + 1, i + 1, 9, i * 1000"
      " FROM generate_series(1, 20000) i");
}

bool Database::end_sessions() const {
  auto opened = store::DatabaseSession::open(cluster_->connection());
  auto* session = std::get_if<std::unique_ptr<store::DatabaseSession>>(&opened);
  if (session == nullptr) return false;
  return (*session)
      ->run("SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity WHERE datname = '" +
            name_ + "'")
      .has_value();
}

StoredFeature sample_feature(const std::string& id) {
  StoredFeature feature;
  feature.collection = "buildings";
  feature.id = id;
  feature.type = "Building";
  feature.format = "city_json";
  feature.srid = 7415;
  feature.header = "{\"type\":\"CityJSON\"}";
  feature.skeleton.bytes = {0x28, 0xB5, 0x2F, 0xFD, 0, 0xFF, '\\', '\n'};
  feature.box = store::StoredBox{{0, 0, 0}, {1, 1.5, 1e9}};
  for (std::uint32_t ordinal = 0; ordinal < 2; ++ordinal) {
    StoredSolid solid;
    solid.object_id = id + "-part";
    solid.geometry = 3;
    solid.ordinal = 1 - ordinal;  // not sorted, so that a test sees whether the order survives
    solid.lod = "2.2";
    solid.blob = {0, 1, 0xFF, static_cast<std::uint8_t>(ordinal)};
    feature.solids.push_back(std::move(solid));
  }
  return feature;
}

}  // namespace watertight::test
