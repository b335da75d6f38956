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

/// One Zstandard frame. Errors: limit_exceeded when there is no memory for it. Cost: linear.
Result<PackedText> pack_text(std::string_view text);

/// The text of one frame that takes all of the bytes. Memory grows with what comes out, never with
/// what the frame says of itself; a frame that needs a window of more than 128 MiB is refused.
/// Errors: malformed; limit_exceeded as soon as more than `most_bytes` come out.
Result<std::string> unpack_text(ByteView packed, std::uint64_t most_bytes);

}  // namespace watertight::formats
