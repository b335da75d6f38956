// SPDX-License-Identifier: GPL-3.0-or-later
#include "geopackage/database.h"

#include <sqlite3.h>

namespace watertight::geopackage {
namespace {

Error error_of(sqlite3* database) {
  return {ErrorCode::unavailable,
          std::string("the GeoPackage cannot be written: ").append(sqlite3_errmsg(database))};
}

}  // namespace

std::string sql_name(std::string_view name) {
  std::string text = "\"";
  for (const char c : name) text.append(c == '"' ? 2 : 1, c);
  return text.append("\"");
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Error Statement::error() const { return error_of(sqlite3_db_handle(statement_.get())); }

Statement& Statement::bind(int number, std::int64_t value) {
  is_bound_ &= sqlite3_bind_int64(statement_.get(), number, value) == SQLITE_OK;
  return *this;
}

Statement& Statement::bind(int number, double value) {
  is_bound_ &= sqlite3_bind_double(statement_.get(), number, value) == SQLITE_OK;
  return *this;
}

Statement& Statement::bind(int number, std::string_view text) {
  is_bound_ &= sqlite3_bind_text64(statement_.get(), number, text.data(), text.size(),
                                   SQLITE_TRANSIENT, SQLITE_UTF8) == SQLITE_OK;
  return *this;
}

Statement& Statement::bind(int number, ByteView bytes) {
  is_bound_ &= sqlite3_bind_blob64(statement_.get(), number, bytes.data(), bytes.size(),
                                   SQLITE_TRANSIENT) == SQLITE_OK;
  return *this;
}

Statement& Statement::bind_null(int number) {
  is_bound_ &= sqlite3_bind_null(statement_.get(), number) == SQLITE_OK;
  return *this;
}

Result<bool> Statement::step() {
  if (!is_bound_) return error();
  switch (sqlite3_step(statement_.get())) {
    case SQLITE_ROW:
      return true;
    case SQLITE_DONE:
      return false;
    default:
      return error();
  }
}

Status Statement::run() {
  const auto stepped = step();
  if (!stepped) return stepped.error();
  if (sqlite3_reset(statement_.get()) != SQLITE_OK) return error();
  return Done{};
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string_view Statement::text(int column) const { return as_text(bytes(column)); }

ByteView Statement::bytes(int column) const {
  const void* begin = sqlite3_column_blob(statement_.get(), column);
  const int count = sqlite3_column_bytes(statement_.get(), column);
  return {static_cast<const std::uint8_t*>(begin), static_cast<std::size_t>(count)};
}

void Database::Close::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Result<Database> Database::open_empty(const std::string& path) {
  sqlite3* opened = nullptr;
  const int outcome =
      sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, nullptr);
  Database database(opened);
  if (outcome != SQLITE_OK) return error_of(opened);
  const Status set = database.run(
      "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA locking_mode = EXCLUSIVE;"
      "PRAGMA temp_store = FILE; PRAGMA cache_size = -16384; PRAGMA trusted_schema = OFF;");
  if (!set) return set.error();
  return database;
}

Status Database::run(const std::string& statements) {
  if (sqlite3_exec(database_.get(), statements.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    return error_of(database_.get());
  }
  return Done{};
}

Result<Statement> Database::prepare(const std::string& text) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), text.c_str(), -1, &statement, nullptr) != SQLITE_OK) {
    return error_of(database_.get());
  }
  if (statement == nullptr) return Error{ErrorCode::invalid_argument, "there is no statement"};
  return Statement(statement);
}

}  // namespace watertight::geopackage
