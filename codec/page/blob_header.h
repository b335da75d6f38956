// SPDX-License-Identifier: GPL-3.0-or-later
//
// The header of a blob of format version 0, its flags (those of mode bitmap live on), and the
// checksum of all versions (docs/format.md, "Checksum").
#pragma once

#include <cstdint>

#include "base/bytes.h"
#include "codec/blob.h"
#include "geometry/canonical_form.h"

namespace watertight::codec {

/// Bits of the flag byte. Bit 7 is reserved and zero.
enum BlobFlag : std::uint8_t {
  kHasOrder = 1,        // an order section follows the facets
  kHasTolerances = 2,   // three doubles follow the rule set; else kImpliedTolerances
  kHasSteiner = 4,      // bitmap: a section of Steiner vertices
  kHasUnrecovered = 8,  // bitmap: a section of unrecovered faces
  kCodedBitmap = 16,    // bitmap: the marks are arithmetic coded, not plain bits
  kCodedFacets = 32,    // bitmap: likewise the facet section
  kExplicitFacets = 64  // bitmap: the facet section lists rings as mode raw does
};

/// What a blob without tolerances was accepted under. Part of the format: never changes.
inline constexpr Tolerances kImpliedTolerances{0.01, 20.0, 0.0};

struct BlobHeader {
  Mode mode = Mode::raw;
  std::uint8_t flags = 0;
  Acceptance acceptance;
  std::uint32_t srid = 0;
  Lattice lattice;
  bool has(BlobFlag flag) const { return (flags & flag) != 0; }
};

/// Errors: malformed; unsupported (version, mode, flags).
Result<BlobHeader> read_header(ByteReader& reader);

/// CRC-32C over the canonical serialization of what a blob says: acceptance, SRID, lattice, the
/// canonical solid, and the source order unless it is the identity.
std::uint32_t checksum_of(const Acceptance& acceptance, const Solid& canonical,
                          const geometry::SourceOrder& order);

}  // namespace watertight::codec
