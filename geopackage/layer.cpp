// SPDX-License-Identifier: GPL-3.0-or-later
#include "geopackage/layer.h"

#include <algorithm>
#include <charconv>

#include "base/json_text.h"

namespace watertight::geopackage {
namespace {

// Equal rows give equal bytes, so the time of the last change is not that of the writing.
constexpr std::string_view kNoTime = "1970-01-01T00:00:00.000Z";

constexpr std::int64_t kRowsBetweenPolls = 256;

std::string literal(std::string_view text) {
  std::string quotes = "'";
  for (const char c : text) quotes.append(c == '\'' ? 2 : 1, c);
  return quotes.append("'");
}

std::string with(std::string text, std::string_view from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    text.replace(at, from.size(), to);
    at += to.size();
  }
  return text;
}

// The triggers of the extension gpkg_rtree_index (OGC 12-128r18, annex F.3), with which programs
// that change rows keep the index right. Here <i> is the index, <t> the table.
constexpr std::string_view kTriggers = R"(
CREATE TRIGGER <i:insert> AFTER INSERT ON <t>
  WHEN (new."geom" NOT NULL AND NOT ST_IsEmpty(NEW."geom"))
BEGIN
  INSERT OR REPLACE INTO <i> VALUES (NEW."fid", ST_MinX(NEW."geom"), ST_MaxX(NEW."geom"),
    ST_MinY(NEW."geom"), ST_MaxY(NEW."geom"));
END;
CREATE TRIGGER <i:update6> AFTER UPDATE OF "geom" ON <t>
  WHEN OLD."fid" = NEW."fid" AND (NEW."geom" NOTNULL AND NOT ST_IsEmpty(NEW."geom")) AND
       (OLD."geom" NOTNULL AND NOT ST_IsEmpty(OLD."geom"))
BEGIN
  UPDATE <i> SET minx = ST_MinX(NEW."geom"), maxx = ST_MaxX(NEW."geom"),
    miny = ST_MinY(NEW."geom"), maxy = ST_MaxY(NEW."geom") WHERE id = NEW."fid";
END;
CREATE TRIGGER <i:update7> AFTER UPDATE OF "geom" ON <t>
  WHEN OLD."fid" = NEW."fid" AND (NEW."geom" NOTNULL AND NOT ST_IsEmpty(NEW."geom")) AND
       (OLD."geom" ISNULL OR ST_IsEmpty(OLD."geom"))
BEGIN
  INSERT INTO <i> VALUES (NEW."fid", ST_MinX(NEW."geom"), ST_MaxX(NEW."geom"),
    ST_MinY(NEW."geom"), ST_MaxY(NEW."geom"));
END;
CREATE TRIGGER <i:update2> AFTER UPDATE OF "geom" ON <t>
  WHEN OLD."fid" = NEW."fid" AND (NEW."geom" ISNULL OR ST_IsEmpty(NEW."geom"))
BEGIN
  DELETE FROM <i> WHERE id = OLD."fid";
END;
CREATE TRIGGER <i:update5> AFTER UPDATE ON <t>
  WHEN OLD."fid" != NEW."fid" AND (NEW."geom" NOTNULL AND NOT ST_IsEmpty(NEW."geom"))
BEGIN
  DELETE FROM <i> WHERE id = OLD."fid";
  INSERT OR REPLACE INTO <i> VALUES (NEW."fid", ST_MinX(NEW."geom"), ST_MaxX(NEW."geom"),
    ST_MinY(NEW."geom"), ST_MaxY(NEW."geom"));
END;
CREATE TRIGGER <i:update4> AFTER UPDATE ON <t>
  WHEN OLD."fid" != NEW."fid" AND (NEW."geom" ISNULL OR ST_IsEmpty(NEW."geom"))
BEGIN
  DELETE FROM <i> WHERE id IN (OLD."fid", NEW."fid");
END;
CREATE TRIGGER <i:delete> AFTER DELETE ON <t>
  WHEN old."geom" NOT NULL
BEGIN
  DELETE FROM <i> WHERE id = OLD."fid";
END;
)";

/// One line of a row that waits: the number of a column and its value; or, without a column, a
/// member of a JSON object.
void append_value(std::string& row, std::optional<std::size_t> column, std::string_view name,
                  std::string_view value) {
  row.append(column ? std::to_string(*column) : "-").append("\t");
  if (!column) row.append(json_string(name)).append(":");
  const std::size_t begin = row.size();
  row.append(value);
  // In a JSON text a line feed is only space between words.
  std::replace(row.begin() + static_cast<std::ptrdiff_t>(begin), row.end(), '\n', ' ');
  row.append("\n");
}

}  // namespace

Result<Layer> Layer::begin(Database& database, int number) {
  std::string staged = "temp.staged_" + std::to_string(number);
  const Status made = database.run("CREATE TABLE " + staged +
                                   " (fid INTEGER PRIMARY KEY, geom BLOB, minx REAL, maxx REAL, "
                                   "miny REAL, maxy REAL, row TEXT)");
  if (!made) return made.error();
  auto insert = database.prepare("INSERT INTO " + staged +
                                 " (geom, minx, maxx, miny, maxy, row) VALUES (?, ?, ?, ?, ?, ?)");
  if (!insert) return std::move(insert).error();
  return Layer(database, std::move(staged), *std::move(insert));
}

Status Layer::add(const std::optional<ShapeBytes>& shape, const Properties& properties) {
  std::string row;
  for (const auto& [name, value] : properties) {
    const auto column = columns_.note(name, value);
    has_further_ |= !column;
    append_value(row, column, name, value);
  }
  if (shape) {
    insert_.bind(1, ByteView(shape->bytes));
    for (std::size_t axis = 0; axis < 2; ++axis) {
      insert_.bind(2 + 2 * static_cast<int>(axis), shape->min[axis]);
      insert_.bind(3 + 2 * static_cast<int>(axis), shape->max[axis]);
      min_[axis] = has_shapes_ ? std::min(min_[axis], shape->min[axis]) : shape->min[axis];
      max_[axis] = has_shapes_ ? std::max(max_[axis], shape->max[axis]) : shape->max[axis];
    }
    has_shapes_ = true;
    has_type_[static_cast<std::size_t>(shape->type)] = true;
  } else {
    for (int number = 1; number <= 5; ++number) insert_.bind_null(number);
  }
  ++rows_;
  return insert_.bind(6, row).run();
}

std::string Layer::type_name() const {
  const auto [points, polygons, others] = has_type_;
  if (others || (points && polygons)) return "GEOMETRY";
  if (points) return "POINT";
  return polygons ? "MULTIPOLYGON" : "GEOMETRY";
}

Status Layer::finish(const std::string& name, std::int64_t srs, const std::string& description,
                     const CancelPoll& is_cancelled) {
  std::string create = "CREATE TABLE ";
  create.append(sql_name(name)).append(" (fid INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, geom ");
  create.append(type_name());
  for (const Columns::Column& column : columns_.all()) {
    create.append(", ").append(sql_name(column.name)).append(" ").append(column.type());
  }
  create.append(has_further_ ? ", further_attributes TEXT)" : ")");
  if (Status made = database_->run(create); !made) return made;
  if (Status written = write_rows(name, is_cancelled); !written) return written;
  if (Status written = write_index(name); !written) return written;
  if (Status written = write_entries(name, srs, description); !written) return written;
  return database_->run("DROP TABLE " + staged_);
}

void Layer::bind_values(Statement& insert, std::string_view row) const {
  std::string further;
  while (!row.empty()) {
    const std::string_view line = row.substr(0, row.find('\n'));
    row.remove_prefix(line.size() + 1);
    const std::size_t tab = line.find('\t');
    const std::string_view value = line.substr(tab + 1);
    std::size_t column = 0;
    const auto read = std::from_chars(line.data(), line.data() + tab, column);
    if (read.ec != std::errc{}) {
      further.append(further.empty() ? "{" : ",").append(value);
    } else {
      Columns::bind(insert, static_cast<int>(column) + 3, columns_.all()[column], value);
    }
  }
  const int last = static_cast<int>(columns_.all().size()) + 3;
  if (!further.empty()) insert.bind(last, further.append("}"));
}

Status Layer::write_rows(const std::string& name, const CancelPoll& is_cancelled) {
  const std::size_t values = columns_.all().size() + (has_further_ ? 1 : 0);
  std::string text = "INSERT INTO " + sql_name(name) + " VALUES (?, ?";
  for (std::size_t i = 0; i < values; ++i) text += ", ?";
  auto insert = database_->prepare(text + ")");
  if (!insert) return std::move(insert).error();
  auto select = database_->prepare("SELECT fid, geom, row FROM " + staged_ + " ORDER BY fid");
  if (!select) return std::move(select).error();
  for (;;) {
    const auto has_row = select->step();
    if (!has_row) return has_row.error();
    if (!*has_row) return Done{};
    const std::int64_t fid = select->integer(0);
    if (fid % kRowsBetweenPolls == 0 && is_cancelled && is_cancelled()) {
      return Error{ErrorCode::cancelled, "the GeoPackage was not finished"};
    }
    for (std::size_t i = 0; i < values; ++i) insert->bind_null(static_cast<int>(i) + 3);
    insert->bind(1, fid);
    if (select->is_null(1)) {
      insert->bind_null(2);
    } else {
      insert->bind(2, select->bytes(1));
    }
    bind_values(*insert, select->text(2));
    if (Status written = insert->run(); !written) return written;
  }
}

Status Layer::write_index(const std::string& name) {
  const std::string index = "rtree_" + name + "_geom";
  std::string text = "CREATE VIRTUAL TABLE " + sql_name(index) +
                     " USING rtree(id, minx, maxx, miny, maxy); INSERT INTO " + sql_name(index) +
                     " SELECT fid, minx, maxx, miny, maxy FROM " + staged_ +
                     " WHERE geom IS NOT NULL ORDER BY fid;";
  std::string triggers(kTriggers);
  for (const char* suffix :
       {"insert", "update2", "update4", "update5", "update6", "update7", "delete"}) {
    std::string mark = "<i:";
    mark.append(suffix).append(">");
    std::string trigger = index;
    trigger.append("_").append(suffix);
    triggers = with(std::move(triggers), mark, sql_name(trigger));
  }
  triggers = with(std::move(triggers), "<i>", sql_name(index));
  return database_->run(text + with(std::move(triggers), "<t>", sql_name(name)));
}

Status Layer::write_entries(const std::string& name, std::int64_t srs,
                            const std::string& description) {
  auto contents = database_->prepare(
      "INSERT INTO gpkg_contents VALUES (?, 'features', ?, ?, ?, ?, ?, ?, ?, ?)");
  if (!contents) return std::move(contents).error();
  contents->bind(1, name).bind(2, name).bind(3, description).bind(4, kNoTime).bind(9, srs);
  if (has_shapes_) {
    contents->bind(5, min_[0]).bind(6, min_[1]).bind(7, max_[0]).bind(8, max_[1]);
  } else {
    for (int number = 5; number <= 8; ++number) contents->bind_null(number);
  }
  if (Status written = contents->run(); !written) return written;
  const std::string table = literal(name);
  return database_->run(
      "INSERT INTO gpkg_geometry_columns VALUES (" + table + ", 'geom', '" + type_name() + "', " +
      std::to_string(srs) + ", 1, 0); INSERT INTO gpkg_extensions VALUES (" + table +
      ", 'geom', 'gpkg_rtree_index', 'http://www.geopackage.org/spec131/#extension_rtree', "
      "'write-only');");
}

}  // namespace watertight::geopackage
