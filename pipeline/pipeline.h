// SPDX-License-Identifier: GPL-3.0-or-later
//
// The whole path, shared by service and command line: document in, validated, encoded, stored;
// stored, decoded, document out.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "codec/blob.h"
#include "formats/document.h"
#include "store/solid_store.h"
#include "validate/certify.h"

namespace watertight {

struct InspectedSolid {
  SolidSource source;
  Inspection inspection;
};

struct InspectedFeature {
  Feature feature;
  std::vector<InspectedSolid> solids;  // one per feature.solids, same order
  Verdict verdict() const;             // the worst of its solids; valid when it has none
};

/// Validates every solid of a feature.
InspectedFeature inspect(Feature feature, EngineWorkers* workers, const CertifyOptions& options);

/// Encodes a feature whose verdict is valid into what the store keeps.
/// Errors: invalid_argument when a solid is not valid; those of encode().
Result<StoredFeature> to_stored(const InspectedFeature& feature, const Document& document,
                                const std::string& collection, const EncodeOptions& options = {});

/// Decodes a stored feature: the document (with one feature) that came in.
Result<Document> from_stored(const StoredFeature& stored, const Limits& limits = {});

}  // namespace watertight
