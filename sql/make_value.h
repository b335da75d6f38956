// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes values of the type `solid` (sql/solid_value.h), and compares and measures their solids.
#pragma once

#include "base/bytes.h"
#include "base/result.h"
#include "geometry/measures.h"
#include "geometry/solid.h"

namespace watertight::sql {

/// The value of a solid and its blob. Requires a solid that was accepted. Errors: not_encodable.
/// Cost: that of triangulating the facets.
Result<Bytes> make_value(const Solid& solid, ByteView blob);

/// The measures of a solid that was accepted.
geometry::Measures measures_of(const Solid& solid);

/// Compares two solids by their canonical forms, lattices and reference systems: below, at or above
/// 0. 0 only if they are equal. Errors: not_encodable. Cost: O(n log n).
Result<int> compare(const Solid& left, const Solid& right);

}  // namespace watertight::sql
