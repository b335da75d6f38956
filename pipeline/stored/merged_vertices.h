// SPDX-License-Identifier: GPL-3.0-or-later
//
// A valid solid has no two equal vertices, but its source may have. These functions note which
// vertices were merged or dropped, so that decoding returns the numbering of the source. Internal
// to pipeline/.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "geometry/solid.h"

namespace watertight::pipeline {

/// One line of text with which unmerge() turns `merged` back into `source`; "" when the two are
/// equal. Errors: not_encodable if `merged` is not merge_equal_vertices(source).
Result<std::string> describe_merge(const Solid& source, const Solid& merged);

/// The source of describe_merge(). Errors: malformed if the line does not fit the solid;
/// limit_exceeded.
Result<Solid> unmerge(const Solid& merged, std::string_view line, const Limits& limits);

}  // namespace watertight::pipeline
