// SPDX-License-Identifier: GPL-3.0-or-later
//
// Damaged blobs and pages, for the unit test's slice, bench/codec/mutate_blobs and the fuzzing
// harnesses.
#pragma once

#include "base/bytes.h"
#include "codec/blob.h"
#include "tests/generated/generated_solids.h"

namespace watertight::generated {

/// Blobs of generated solids of at most a few hundred vertices in all modes, with and without
/// order.
std::vector<Bytes> seed_blobs(std::uint64_t seed);
/// Pages of them, and of solids that share columns, in all modes.
std::vector<Bytes> seed_pages(std::uint64_t seed);

/// One to three changes: a bit or byte changed, bytes removed, repeated or copied from another
/// blob, or the rest replaced by a long tail that may stand for anything.
Bytes mutated(const std::vector<Bytes>& blobs, Random& random);

/// All that decode() and decode_page() do but for the questions whether the stream ends in time and
/// whether the checksum is right: what a hostile writer gets through, who can answer both.
Result<std::vector<Decoded>> decode_unchecked(ByteView bytes, const Limits& limits = {});

}  // namespace watertight::generated
