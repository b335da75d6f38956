// SPDX-License-Identifier: GPL-3.0-or-later
//
// A whole collection out of a store, in order of ids. Memory does not grow with the collection: a
// batch of features at a time (of a Watertight file, a part). Features that are put or removed
// meanwhile may be missing or there; each is whole.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "codec/blob.h"
#include "store/solid_store.h"

namespace watertight {

/// Takes the next bytes of a file. An Error of it ends the export.
using ByteSink = std::function<Status(ByteView)>;

struct Exported {
  std::uint64_t features = 0;
  std::uint64_t solids = 0;
};

/// As a Watertight file: solids in pages, any number of documents. Errors: those of the store and
/// the sink; not_found (no collection, no features); malformed when what is stored is damaged.
Result<Exported> export_container(SolidStore& store, const std::string& collection,
                                  const ByteSink& sink, const EncodeOptions& pages = {});

/// As a CityJSONSeq. Errors: those of export_container(); unsupported when the features are not of
/// city models or have several headers (their coordinates and references then differ).
Result<Exported> export_sequence(SolidStore& store, const std::string& collection,
                                 const ByteSink& sink);

}  // namespace watertight
