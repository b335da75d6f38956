// SPDX-License-Identifier: GPL-3.0-or-later
//
// Damaged blobs and pages, for the unit tests, bench/codec/mutate_blobs and the fuzzing harnesses.
#pragma once

#include "base/bytes.h"
#include "codec/blob.h"
#include "tests/generated/generated_solids.h"

namespace watertight::generated {

/// Blobs of generated solids of at most a few hundred vertices in all modes, with and without
/// source order.
std::vector<Bytes> seed_blobs(std::uint64_t seed);
/// Pages of generated solids, and of solids that share columns, in all modes.
std::vector<Bytes> seed_pages(std::uint64_t seed);

/// A blob with one to three changes: a bit or byte changed, bytes removed, repeated or copied from
/// another blob, or the end replaced by a long tail of equal or random bytes.
Bytes mutated(const std::vector<Bytes>& blobs, Random& random);

/// Decodes a blob or page as decode() and decode_page() do, but without their checks of the end of
/// the stream and of the checksum. A hostile writer can pass these two checks, so the rest of the
/// decoder must not depend on them.
Result<std::vector<Decoded>> decode_unchecked(ByteView bytes, const Limits& limits = {});

}  // namespace watertight::generated
