// SPDX-License-Identifier: GPL-3.0-or-later
//
// Texts compressed with Zstandard (RFC 8878): skeletons in stores and in Watertight files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/bytes.h"
#include "base/packed_text.h"
#include "base/result.h"

namespace watertight::formats {

/// Compresses a text into one Zstandard frame. Errors: limit_exceeded without memory. Cost: linear.
Result<PackedText> pack_text(std::string_view text);

/// The text of a frame that fills all of `packed`. Memory grows with the output, never with a size
/// that the frame states; a frame that needs a window of more than 128 MiB is refused. Errors:
/// malformed; limit_exceeded as soon as the output exceeds `most_bytes`.
Result<std::string> unpack_text(ByteView packed, std::uint64_t most_bytes);

}  // namespace watertight::formats
