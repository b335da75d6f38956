// SPDX-License-Identifier: GPL-3.0-or-later
//
// The packed texts of databases of schema 8 and before.
#pragma once

#include <cstdint>
#include <string>

#include "base/bytes.h"
#include "base/result.h"

namespace watertight::packing {

/// The text of one Zstandard frame (RFC 8878). Memory grows with the output, never with a size that
/// the bytes state. Errors: malformed; limit_exceeded as soon as the output exceeds `most_bytes`.
Result<std::string> unpack_frame(ByteView frame, std::uint64_t most_bytes);

}  // namespace watertight::packing
