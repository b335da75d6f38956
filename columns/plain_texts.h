// SPDX-License-Identifier: GPL-3.0-or-later
//
// Texts without columns worth the name, compressed by LZMA. Internal to columns/.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "columns/columns.h"

namespace watertight::columns {

/// The texts one after the other, compressed (docs/format-columns.md, "Plain texts"), if that may
/// take fewer bytes than `columns_bytes`; a quick compressor tells first. Nothing without memory.
/// Cost: 200 MB a second when the columns are clearly smaller, else about 2 MB a second.
std::optional<Bytes> pack_plainly(std::span<const Text> texts, std::uint64_t columns_bytes);

/// The `count` texts of pack_plainly(). Memory grows with the output. Errors: malformed;
/// limit_exceeded for texts of more than `most_bytes`.
Result<std::vector<std::string>> unpack_plainly(ByteView bytes, std::uint64_t count,
                                                std::uint64_t most_bytes);

}  // namespace watertight::columns
