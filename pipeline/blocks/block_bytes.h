// SPDX-License-Identifier: GPL-3.0-or-later
//
// The marks in the bytes of a block, for its writer and its reader. Internal to pipeline/blocks.
#pragma once

#include <cstdint>

namespace watertight::pipeline {

/// In place of the bytes of a blob, of which there are more: the solid is not proven.
inline constexpr std::uint64_t kNoBlob = 1;

}  // namespace watertight::pipeline
