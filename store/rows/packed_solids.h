// SPDX-License-Identifier: GPL-3.0-or-later
//
// The solids of a feature in one string of bytes: their facts, most of which follow from those of
// the solid before and cost nothing, then their blobs, one after the other.
//
// The facts of a solid are a byte of flags and the numbers (LEB128) that it announces. Bits 0 to 4:
// the level of detail, an index into a list; 31: its length and its text follow. Bit 6: the object
// is not that of the solid before (of the first solid: the feature itself); the number of bytes
// that its id shares with the feature's, then the length of the rest and the rest follow. Bit 7:
// geometry and ordinal follow; else the geometry is the next one of the object, and the ordinal 0.
// Bit 5: the solid is proven; the length of its blob follows. Where the first byte is kPageMark,
// the facts follow it, then the blobs, then one page of all solids whose blob has the length 0.
// watertight.stored_solids (store/rows/page_schema.h) reads the same in SQL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "store/solid_store.h"

namespace watertight::store {

/// The first byte where there is a page: a level of detail that is not in the list.
inline constexpr std::uint8_t kPageMark = 30;

/// The most bytes of the id of a feature or an object. A B-tree entry of PostgreSQL holds 2704
/// bytes; two ids and a collection name must fit together.
constexpr std::size_t kLongestId = 1024;

/// The solids of the feature without measures and reports. Cost: linear.
Bytes pack_solids(const FeatureRecord& feature);

/// Gives a feature with an id the `number` solids, and the page, that pack_solids() was given.
/// Memory: that of the bytes, and an id for each solid. Errors: malformed; also for an id that is
/// longer than kLongestId.
Status unpack_solids(FeatureRecord& feature, std::uint64_t number, ByteView packed);

}  // namespace watertight::store
