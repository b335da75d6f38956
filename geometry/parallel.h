// SPDX-License-Identifier: GPL-3.0-or-later
//
// Does independent pieces of work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace watertight::geometry {

/// Calls work(i, is_caller) for all i < count, each once, on at most `threads` threads: the
/// caller's (is_caller is true there) and others. Pieces are begun in ascending order. While the
/// caller waits for other threads it calls wait() some hundred times a second; `wait` may be empty.
/// An exception from `work` or `wait` is thrown again on the caller's thread, after all threads
/// have ended. Where the system gives no more threads, fewer threads do the work.
void for_each_piece(std::size_t count, unsigned threads,
                    const std::function<void(std::size_t, bool)>& work,
                    const std::function<void()>& wait = {});

}  // namespace watertight::geometry
