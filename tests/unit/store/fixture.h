// SPDX-License-Identifier: GPL-3.0-or-later
//
// A private cluster with fresh databases for the store's tests.
#pragma once

#include <memory>
#include <string>

#include "store/connection.h"
#include "store/private_cluster.h"
#include "store/solid_store.h"

namespace watertight::test {

/// An empty directory, which is removed with its content at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string path;
};

/// A fresh database in the shared cluster.
class Database {
 public:
  Database();
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  const std::string& connection() const { return connection_; }
  /// The path of the server's socket.
  std::string socket() const;
  std::unique_ptr<SolidStore> store(std::size_t connections = 4) const;
  /// The first column of the first row as text; an error fails the test.
  std::string ask(const std::string& statement) const;
  /// Adds a collection "c" of 20,000 features without solids, enough for a plan to use an index:
  /// feature i has the id i, the box from (i, i, 0) to (i + 1, i + 1, 9) and the place number 1000
  /// i.
  void add_many_features() const;
  /// Ends all other sessions in the database; returns false if the server is away.
  bool end_sessions() const;

 private:
  std::unique_ptr<store::PrivateCluster> cluster_;
  std::string name_;
  std::string connection_;
};

std::unique_ptr<store::DatabaseSession> session_in(const std::string& connection);
std::string ask(const std::string& connection, const std::string& statement);

/// A feature with a box, two solids and bytes that are no valid text.
StoredFeature sample_feature(const std::string& id);

}  // namespace watertight::test
