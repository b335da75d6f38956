// SPDX-License-Identifier: GPL-3.0-or-later
//
// A database of SQLite and its statements. Internal to geopackage/.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "base/bytes.h"
#include "base/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace watertight::geopackage {

/// An identifier in quotes, for SQL.
std::string sql_name(std::string_view name);

/// A prepared statement. Parameters are numbered from 1, columns from 0. A failed bind shows as an
/// error of the next step.
class Statement {
 public:
  Statement& bind(int number, std::int64_t value);
  Statement& bind(int number, double value);
  Statement& bind(int number, std::string_view text);
  Statement& bind(int number, ByteView bytes);
  Statement& bind_null(int number);

  /// Whether there is a next row. Errors: unavailable, for a full disk too.
  Result<bool> step();
  /// Runs a statement without rows, which can then be bound anew. Errors: as for step().
  Status run();

  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;
  /// Valid until the next step.
  std::string_view text(int column) const;
  ByteView bytes(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}
  Error error() const;

  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  bool is_bound_ = true;
};

class Database {
 public:
  /// Opens a file that is empty, for one writer that starts anew after any fault: without journal.
  /// Errors: unavailable.
  static Result<Database> open_empty(const std::string& path);
  /// Runs statements without parameters and rows. Errors: unavailable.
  Status run(const std::string& statements);
  /// Errors: unavailable; invalid_argument for text that is no statement.
  Result<Statement> prepare(const std::string& text);

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  explicit Database(sqlite3* database) : database_(database) {}

  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace watertight::geopackage
