// SPDX-License-Identifier: GPL-3.0-or-later
//
// Readers of files with curved solids. Internal to formats/; the public interface is
// formats/document.h.
#pragma once

#include <string_view>

#include "formats/document.h"

namespace watertight::formats {

/// One feature for each product with solids. Bodies of other kinds are counted in a note.
Result<Document> read_ifc(std::string_view text, const ReadOptions& options);
/// One feature for each solid.
Result<Document> read_step(std::string_view text, const ReadOptions& options);
/// JSON with boundary representations (docs/formats.md, "Curved solids"): one feature for each
/// solid. Errors: malformed with the JSON Pointer of the value.
Result<Document> read_brep(std::string_view text, const ReadOptions& options);
/// Bezier patches: the number of patches, then for each its degrees along v and u, and its control
/// points. One feature of one solid, in metres. Errors: malformed with byte offset.
Result<Document> read_bpt(std::string_view text, const ReadOptions& options);

}  // namespace watertight::formats
