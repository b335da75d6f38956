// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads lists of shells, facets and rings with plain vertex numbers: the facet section
// of mode raw, and of mode bitmap where marks and joints do not bring the facets back
// (docs/format-plain.md).
#pragma once

#include "base/bytes.h"
#include "base/limits.h"
#include "geometry/solid.h"

namespace watertight::codec {

/// Writes all of `arrays` except its vertices. Cost: linear.
Bytes write_facet_listing(const SolidArrays& arrays);

/// Reads the arrays of rings, facets and shells; the result has no vertices. Its indices are below
/// `vertex_count`. Errors: malformed; limit_exceeded. Every ring vertex takes at least one byte of
/// the section.
Result<SolidArrays> read_facet_listing(ByteView section, Index vertex_count, const Limits& limits);

}  // namespace watertight::codec
