// SPDX-License-Identifier: GPL-3.0-or-later
//
// One layer of a GeoPackage: rows with a geometry and properties. The columns and their types are
// known when all rows are, so rows wait in a temporary table. Internal to geopackage/.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/cancel.h"
#include "geopackage/database.h"
#include "geopackage/shape_bytes.h"
#include "pipeline/shown/properties.h"

namespace watertight::geopackage {

/// The properties of a row: names, and values as JSON texts.
using Properties = std::vector<std::pair<std::string, std::string>>;

/// The columns of a layer besides its number and geometry. The names of columns of SQLite do not
/// differ by case alone, and a table has at most kMost of them: the properties beyond are members
/// of one JSON object in the column `further_attributes`.
class Columns {
 public:
  static constexpr std::size_t kMost = 1000;

  /// Takes note of a property; returns its column, or nothing for one beyond the most.
  std::optional<std::size_t> note(std::string_view name, std::string_view value);

  struct Column {
    std::string name;  // of the column
    /// BOOLEAN, INTEGER or REAL if all values are of this type, else TEXT.
    std::string_view type() const;

    pipeline::ValueKinds kinds = {};
  };
  const std::vector<Column>& all() const { return columns_; }
  /// Binds a value (a JSON text) in the type of its column.
  static void bind(Statement& statement, int number, const Column& column, std::string_view value);

 private:
  std::size_t add(const std::string& name);

  std::vector<Column> columns_;
  std::map<std::string, std::size_t, std::less<>> numbers_;  // by name of the property
  std::map<std::string, std::size_t> taken_;                 // by name of the column, in lower case
};

/// The rows of a layer while they arrive.
class Layer {
 public:
  /// `database` must outlive the layer. `number` tells the layers of a file apart. Errors:
  /// unavailable.
  static Result<Layer> begin(Database& database, int number);

  /// Errors: unavailable.
  Status add(const std::optional<ShapeBytes>& shape, const Properties& properties);
  std::uint64_t rows() const { return rows_; }

  /// Writes the table `name` with all rows, its index of places and the entries of both in the
  /// tables of the GeoPackage. `srs` is the number of its reference system there. Errors:
  /// unavailable; cancelled.
  Status finish(const std::string& name, std::int64_t srs, const std::string& description,
                const CancelPoll& is_cancelled);

 private:
  Layer(Database& database, std::string staged, Statement insert)
      : database_(&database), staged_(std::move(staged)), insert_(std::move(insert)) {}
  void bind_values(Statement& insert, std::string_view row) const;
  Status write_rows(const std::string& name, const CancelPoll& is_cancelled);
  Status write_index(const std::string& name);
  Status write_entries(const std::string& name, std::int64_t srs, const std::string& description);
  std::string type_name() const;

  Database* database_;
  std::string staged_;  // the temporary table
  Statement insert_;
  Columns columns_;
  std::uint64_t rows_ = 0;
  std::array<bool, 3> has_type_{};  // by ShapeType
  std::array<double, 2> min_{};
  std::array<double, 2> max_{};
  bool has_shapes_ = false;
  bool has_further_ = false;  // whether there is a property without a column
};

}  // namespace watertight::geopackage
