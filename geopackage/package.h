// SPDX-License-Identifier: GPL-3.0-or-later
//
// A GeoPackage 1.3 (OGC 12-128r18): an SQLite database with layers of features, as QGIS, GDAL and
// other map programs open it.
#pragma once

#include <cstdint>
#include <string>

#include "geopackage/database.h"
#include "geopackage/layer.h"

namespace watertight::geopackage {

/// A GeoPackage that is written to a new file.
class Package {
 public:
  /// Makes the tables that each GeoPackage has. All layers are in EPSG system `srid`, easting or
  /// longitude first; 0: in no known one. Equal layers give equal bytes. Errors: unavailable.
  static Result<Package> create(const std::string& path, std::uint32_t srid);

  /// The EPSG system of the layers; 0 for one that PROJ does not know.
  std::uint32_t srid() const { return srid_; }
  Result<Layer> begin_layer() { return Layer::begin(database_, ++layers_); }
  /// Errors: those of Layer::finish().
  Status finish(Layer& layer, const std::string& name, const std::string& description,
                const CancelPoll& is_cancelled);
  /// Completes the file. Errors: unavailable.
  Status close();

 private:
  Package(Database database, std::uint32_t srid) : database_(std::move(database)), srid_(srid) {}

  Database database_;
  std::uint32_t srid_;
  int layers_ = 0;
};

/// A name that a layer can have, as near to `wanted` as can be: the prefixes of SQLite and of
/// GeoPackages are for themselves.
std::string layer_name(const std::string& wanted);

}  // namespace watertight::geopackage
