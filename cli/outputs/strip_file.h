// SPDX-License-Identifier: GPL-3.0-or-later
//
// The triangles of curved solids as strips, in a JSON file (docs/cli.md, "Curved solids").
#pragma once

#include <string>

#include "formats/document.h"

namespace watertight::cli {

/// Writes the strips of all curved solids that were read with CurvedReading::keeps_strips. Errors:
/// those of files::FileWriter.
Status save_strips(const Document& document, const std::string& output);

}  // namespace watertight::cli
