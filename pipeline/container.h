// SPDX-License-Identifier: GPL-3.0-or-later
//
// The Watertight file: a document with its solids as blobs, in one file (docs/cli.md has the
// layout). What `encode` writes, `decode` reads and the service gives as a download.
#pragma once

#include <span>

#include "pipeline/pipeline.h"

namespace watertight {

/// True if the bytes start like a Watertight file (of any version).
bool is_container(ByteView bytes);

/// Features must share `format` and `header` (those of one document do).
/// Errors: invalid_argument if they do not.
Result<Bytes> write_container(std::span<const StoredFeature> features);

/// Trusts nothing. Reports and measures are not in the file: they come back empty.
/// Errors: malformed (with byte offset), unsupported (version), limit_exceeded.
Result<std::vector<StoredFeature>> read_container(ByteView bytes, const Limits& limits = {});

/// The document in a Watertight file, with all its features. Errors: as read_container and decode.
Result<Document> decode_container(ByteView bytes, const Limits& limits = {});

}  // namespace watertight
