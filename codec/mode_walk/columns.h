// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the vertices of a solid as columns: the places (x, y) in sorted order, then the heights at
// each place. The order of vertices is not coded, since the canonical form sorts them. For mode
// walk (docs/format-walk.md, "Columns").
#pragma once

#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"
#include "codec/page/integer_solid.h"

namespace watertight::codec::walk {

/// Codes at least one point, in lexicographic order; no two points may be equal. When reading,
/// `points` must be empty and is filled. Errors: not_encodable if a side of the points' box is 2^30
/// or more; when reading: malformed, limit_exceeded. Cost: linear in the points and in the columns
/// of the page that are compared.
Status code_columns(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                    std::vector<GridPoint>& points, const Limits& limits);

}  // namespace watertight::codec::walk
