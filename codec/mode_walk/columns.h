// SPDX-License-Identifier: GPL-3.0-or-later
//
// The vertices of a building as columns: the places (x, y) in sorted order, then the heights at
// each. The order of vertices is not coded: the canonical form sorts them. For mode walk
// (docs/format-walk.md, "Columns").
#pragma once

#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/page/integer_solid.h"

namespace watertight::codec::walk {

/// Codes points, of which there is at least one and no two are equal, in lexicographic order.
/// Reading: requires that `points` is empty, and fills it. Errors: not_encodable if the sides of
/// their box are 2^30 or more; reading: malformed, limit_exceeded. Cost: linear in the points and
/// in the columns of the page that are compared.
Status code_columns(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                    std::vector<GridPoint>& points, const Limits& limits);

}  // namespace watertight::codec::walk
