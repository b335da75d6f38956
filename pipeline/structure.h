// SPDX-License-Identifier: GPL-3.0-or-later
//
// The inside of stored solids, for people who want to see why a solid is proven and what it costs.
#pragma once

#include <string>

#include "pipeline/pipeline.h"

namespace watertight::pipeline {

/// The proven solids of a feature, proven again under the rules of their blobs, as JSON: {"id",
/// "bytes": {"solids", "text"}, "solids": [{"object", "lod", "geometry", "ordinal", "mode",
/// "parts":
/// [{"name", "bytes"}], "rung", "vertices", "steinerVertices", "tetrahedra", "unrecoveredFaces"}]}.
/// Vertices are in the coordinates of the document, Steiner vertices last; tetrahedra are those of
/// the interior; unrecovered faces are the faces of the boundary that the Delaunay
/// tetrahedralization of these vertices lacks (Verbree & Si 2008, section 4.1). A solid whose proof
/// is not found again, or that is accepted without one, has no rung and what follows it.
/// `text_bytes` is the size of the feature's packed text. Errors: those of decode_solids(). Cost:
/// that of certify().
Result<std::string> structure_json(const EncodedFeature& feature, std::size_t text_bytes,
                                   delaunay::EngineWorkers* workers, const CertifyOptions& options);

}  // namespace watertight::pipeline
