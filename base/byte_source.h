// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bytes that come one after the other, from a file, a text in memory or a decoder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "base/result.h"

namespace watertight {

/// Fills the span from the input and returns the number of bytes; 0 at the end of the input.
using ByteSource = std::function<Result<std::size_t>(std::span<std::uint8_t>)>;

}  // namespace watertight
