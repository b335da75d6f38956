// SPDX-License-Identifier: GPL-3.0-or-later
//
// The Watertight file: a document with its solids as blobs, in one file (docs/cli.md has the
// layout). What `encode` writes, `decode` reads and the service gives as a download.
#pragma once

#include "pipeline/pipeline.h"

namespace watertight {

/// True if the bytes start like a Watertight file (of any version).
bool is_container(ByteView bytes);

/// Features must have format and header of the document.
/// Errors: invalid_argument if they do not; limit_exceeded.
Result<Bytes> write_container(const StoredDocument& document);

/// Trusts nothing. Reports and measures are not in the file: they come back empty.
/// Errors: malformed (with byte offset), unsupported (version), limit_exceeded.
Result<StoredDocument> read_container(ByteView bytes, const Limits& limits = {});

/// The document in a Watertight file, with all its features. Errors: as read_container and decode.
Result<Document> decode_container(ByteView bytes, const Limits& limits = {});

}  // namespace watertight
