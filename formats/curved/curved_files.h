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

}  // namespace watertight::formats
