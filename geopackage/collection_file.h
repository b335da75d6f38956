// SPDX-License-Identifier: GPL-3.0-or-later
//
// A collection of the store as a GeoPackage.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/cancel.h"
#include "base/temporary_file.h"
#include "pipeline/export.h"
#include "store/solid_store.h"

namespace watertight::geopackage {

struct CollectionChoice {
  pipeline::ExportScope scope = pipeline::ExportScope::all;
  std::optional<store::Filter> filter = std::nullopt;  // which must be true
  std::optional<std::string> lod = std::nullopt;       // nothing: the highest of each object
};

/// Asked now and then with the bytes of the file so far; false ends the work.
using HasRoom = std::function<bool(std::uint64_t bytes)>;

struct CollectionFile {
  TemporaryFile file;
  std::uint64_t features = 0;
  std::uint64_t findings = 0;
};

/// A GeoPackage with the layer of the features, named as the collection: facets as a MultiPolygon
/// with heights in the storage CRS, attributes and facts as columns; and the layer
/// `NAME_findings` with a point for each defect of those features that are not proven. Equal
/// collections give equal bytes. Errors: those of SolidStore::walk(); not_found without features;
/// limit_exceeded when there is no room; unavailable for a feature that cannot be decoded, and for
/// a full disk; cancelled. Cost: that of decoding all features; the disk has them twice meanwhile.
Result<CollectionFile> collection_file(SolidStore& store, const std::string& collection,
                                       const CollectionChoice& choice,
                                       const CancelPoll& is_cancelled = {},
                                       const HasRoom& has_room = {});

}  // namespace watertight::geopackage
