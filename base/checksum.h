// SPDX-License-Identifier: GPL-3.0-or-later
//
// Checksums: CRC-32C for corruption (blobs, frames) and a 64-bit content hash (FNV-1a) for
// equality look-ups. Neither protects against a deliberate forger.
#pragma once

#include <cstdint>

#include "base/bytes.h"

namespace watertight {

/// CRC-32C (Castagnoli, polynomial 0x1EDC6F41, reflected, as in RFC 3720). `previous` is the result
/// for the bytes before. crc32c("123456789") is 0xE3069283. Cost: linear.
std::uint32_t crc32c(ByteView bytes, std::uint32_t previous = 0);

/// FNV-1a, 64 bits. Cost: linear.
std::uint64_t content_hash(ByteView bytes);

}  // namespace watertight
