// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compresses texts by gzip, for answers that are sent once.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"

namespace watertight::archives {

/// How much time compression takes for how few bytes.
enum class Effort : std::uint8_t { fast, best };

/// The text as one gzip member, without name and time. The same text gives the same bytes with one
/// version of zlib. Errors: unavailable without the 256 KiB of memory that zlib takes. Cost:
/// linear; about 100 MB/s fast, 20 MB/s best.
Result<std::string> gzip(std::string_view text, Effort effort);

}  // namespace watertight::archives
