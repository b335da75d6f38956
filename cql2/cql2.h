// SPDX-License-Identifier: GPL-3.0-or-later
//
// CQL2, the query language of the OGC (21-065r2): the classes Basic CQL2 and Advanced Comparison
// Operators, and S_INTERSECTS with a box or a point, which compares the box of a feature.
#pragma once

#include <string_view>

#include "base/result.h"
#include "store/filter.h"

namespace watertight::cql2 {

/// Reads a filter in the text encoding, as `height > 10 AND NOT (roof = 'flat' OR roof IS NULL)`.
/// Dates and timestamps are texts. Boxes are as written, in the system of the request. Errors:
/// malformed with the byte offset; unsupported for what other classes have; limit_exceeded.
Result<store::Filter> read_text(std::string_view text);

/// Reads a filter in the JSON encoding: {"op": ">", "args": [{"property": "height"}, 10]}. Errors:
/// as above, with a JSON Pointer. Numbers have the precision of doubles.
Result<store::Filter> read_json(std::string_view text);

}  // namespace watertight::cql2
