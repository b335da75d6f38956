// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where a text of a mesh has its vertices and corners. Internal to formats/.
#pragma once

#include <optional>

#include "formats/text/indexed_text.h"

namespace watertight::formats {

/// The places of an OBJ, OFF or PLY that its reader accepts; nothing for other formats, for binary
/// PLY but that of little-endian 32-bit numbers, for PLY whose vertices do not begin with their
/// position, and for texts that write a vertex or a facet over several lines. Cost: linear.
std::optional<IndexedPlaces> indexed_places(ByteView bytes, Format format);

}  // namespace watertight::formats
