// SPDX-License-Identifier: GPL-3.0-or-later
//
// The encoder for boundaries that were not proven valid: for tests, fuzzing and benches on dirty
// meshes. In codec/, encode(ValidSolid) calls it; so do page files and explain() for solids of
// decoded blobs, which keep the acceptance that their blob claims. Other folders call encode().
#pragma once

#include <span>

#include "codec/blob.h"

namespace watertight::codec {

/// Encodes a boundary, decodes the bytes, compares, and only then returns them. The blob holds the
/// source order if the options have `keep_order`, else the canonical form. Errors: not_encodable.
Result<Bytes> encode_boundary(const OrientedBoundary& boundary, const Acceptance& acceptance,
                              const EncodeOptions& options = {});

/// Encodes 1 to kMaxPageSolids boundaries on one grid and in one reference system as a page
/// (codec/page.h), with the same check as encode_boundary(). Errors: not_encodable;
/// invalid_argument.
Result<Bytes> encode_boundaries(std::span<const OrientedBoundary* const> boundaries,
                                const Acceptance& acceptance, const EncodeOptions& options = {});

}  // namespace watertight::codec
