// SPDX-License-Identifier: GPL-3.0-or-later
//
// EWKB (PostGIS) and WKT of solids: POLYHEDRALSURFACE Z (one shell) and SOLID Z (shells). For SQL,
// CLI and the service. Solids with cavities need SOLID Z; docs/formats.md gives its layout.
#pragma once

#include "base/bytes.h"
#include "base/limits.h"
#include "formats/document.h"

namespace watertight::formats {

Result<SubmittedSolid> read_ewkb(ByteView bytes, const Limits& limits = {});
Result<SubmittedSolid> read_wkt(std::string_view text, const Limits& limits = {});
/// Writes the doubles nearest to the exact world coordinates, and closed rings.
Bytes write_ewkb(const Solid& solid);
/// The facets of all shells as one MULTIPOLYGON Z, for programs that know no solids.
Bytes write_ewkb_of_boundary(const Solid& solid);
std::string write_wkt(const Solid& solid);

}  // namespace watertight::formats
