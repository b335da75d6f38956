// SPDX-License-Identifier: GPL-3.0-or-later
//
// The checksum of a solid in a blob or page (docs/format.md, "Checksum").
#pragma once

#include <cstdint>

#include "geometry/canonical_form.h"
#include "geometry/valid_solid.h"

namespace watertight::codec {

/// CRC-32C over the canonical serialization of the contents of a blob: acceptance, SRID, lattice,
/// the canonical solid, and the source order unless it is the identity.
std::uint32_t checksum_of(const Acceptance& acceptance, const Solid& canonical,
                          const geometry::SourceOrder& order);

}  // namespace watertight::codec
