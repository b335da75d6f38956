// SPDX-License-Identifier: GPL-3.0-or-later
#include "geopackage/package.h"

#include "base/ascii.h"
#include "projection/projection.h"

namespace watertight::geopackage {
namespace {

constexpr std::int64_t kCartesianSystem = -1;

// The tables of OGC 12-128r18, annex C, and of the extension gpkg_crs_wkt, annex F.10.
constexpr const char* kTables = R"(
PRAGMA application_id = 1196444487;
PRAGMA user_version = 10300;
BEGIN;
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY,
  organization TEXT NOT NULL, organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL,
  description TEXT, definition_12_063 TEXT NOT NULL DEFAULT 'undefined');
CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL,
  identifier TEXT UNIQUE, description TEXT DEFAULT '',
  last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL,
  geometry_type_name TEXT NOT NULL, srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name),
  CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id));
CREATE TABLE gpkg_extensions (table_name TEXT, column_name TEXT, extension_name TEXT NOT NULL,
  definition TEXT NOT NULL, scope TEXT NOT NULL,
  CONSTRAINT ge_tce UNIQUE (table_name, column_name, extension_name));
INSERT INTO gpkg_extensions VALUES ('gpkg_spatial_ref_sys', 'definition_12_063', 'gpkg_crs_wkt',
  'http://www.geopackage.org/spec131/#extension_crs_wkt', 'read-write');
INSERT INTO gpkg_spatial_ref_sys VALUES
  ('Undefined Cartesian SRS', -1, 'NONE', -1, 'undefined', NULL, 'undefined'),
  ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', NULL, 'undefined');
)";

constexpr std::uint32_t kLongitudeLatitude = 4326;  // each GeoPackage has it

Status add_system(Database& database, std::uint32_t srid) {
  const auto text = projection::text_of(srid);
  if (!text) return text.error();
  auto insert =
      database.prepare("INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, 'EPSG', ?, ?, NULL, ?)");
  if (!insert) return std::move(insert).error();
  insert->bind(1, text->name).bind(2, std::int64_t{srid}).bind(3, std::int64_t{srid});
  insert->bind(4, text->first.empty() ? "undefined" : text->first).bind(5, text->second);
  return insert->run();
}

}  // namespace

Result<Package> Package::create(const std::string& path, std::uint32_t srid) {
  auto database = Database::open_empty(path);
  if (!database) return std::move(database).error();
  if (Status made = database->run(kTables); !made) return std::move(made).error();
  if (Status added = add_system(*database, kLongitudeLatitude); !added) return added.error();
  // The numbers of a system that PROJ does not know are kept, as in no known system.
  if (srid != 0 && srid != kLongitudeLatitude && !add_system(*database, srid)) srid = 0;
  return Package(*std::move(database), srid);
}

Status Package::finish(Layer& layer, const std::string& name, const std::string& description,
                       const CancelPoll& is_cancelled) {
  const std::int64_t srs = srid_ == 0 ? kCartesianSystem : std::int64_t{srid_};
  return layer.finish(name, srs, description, is_cancelled);
}

Status Package::close() { return database_.run("COMMIT"); }

std::string layer_name(const std::string& wanted) {
  const std::string lower = lower_case(wanted);
  const bool is_reserved =
      lower.starts_with("gpkg_") || lower.starts_with("rtree_") || lower.starts_with("sqlite_");
  return is_reserved ? "layer_" + wanted : wanted;
}

}  // namespace watertight::geopackage
