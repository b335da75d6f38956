// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds the coordinates of solids in a text by their values. For formats that write the rings of
// solids one after the other, each position with its own numbers. Internal to formats/.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "formats/text/kept_text.h"

namespace watertight::formats {

/// Whether the last position of a ring in the text repeats the first.
enum class RingEnd : std::uint8_t { closed, open };

/// The texts of rings in document order. A ring whose numbers are not found is left out. Cost:
/// linear; the search ends early in a text that would need more.
std::vector<RingText> find_rings(std::string_view text, DocumentSolids solids, RingEnd end);

}  // namespace watertight::formats
