// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bytes that this program holds, and the most that it held: counted by the usable sizes of all
// blocks, because the standard library has no count.
#pragma once

#include <cstddef>

namespace watertight::bench {

/// Begins to count anew: most_bytes_held() is the most above what is held now.
void count_bytes_from_here();
std::size_t most_bytes_held();

}  // namespace watertight::bench
