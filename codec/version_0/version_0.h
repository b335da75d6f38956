// SPDX-License-Identifier: GPL-3.0-or-later
//
// Blobs of format version 0, the experimental one: read, so that they can be encoded again, and
// never written (docs/format-0.md).
#pragma once

#include "codec/blob.h"

namespace watertight::codec {

/// Errors: as decode().
Result<Decoded> decode_version_0(ByteView blob, const Limits& limits);

}  // namespace watertight::codec
