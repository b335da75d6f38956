// SPDX-License-Identifier: GPL-3.0-or-later
//
// Spreads independent steps over threads. Internal to pipeline/.
#pragma once

#include <cstddef>
#include <functional>

namespace watertight {

/// Calls step(0) .. step(count - 1), each once, on up to `threads` threads (the caller's is one).
/// What a step throws (out of memory) is thrown again here, after all threads have ended.
void parallel_for(std::size_t count, std::size_t threads,
                  const std::function<void(std::size_t)>& step);

}  // namespace watertight
