// SPDX-License-Identifier: GPL-3.0-or-later
//
// Asks the caller now and then, within long loops, whether to go on. Private to delaunay/.
#pragma once

#include "base/cancel.h"

#include <cstddef>

namespace watertight::delaunay {

/// Keeps a reference to `is_cancelled`, which may be empty. Each loop has its own; not thread-safe.
class Cancellation {
 public:
  explicit Cancellation(const CancelPoll& is_cancelled) : is_cancelled_(is_cancelled) {}

  /// Counts `steps`; asks the caller once in about 4096 steps. Returns true if the caller cancels.
  bool is_due_and_wanted(std::size_t steps = 1) {
    steps_ += steps;
    if (steps_ < kStepsPerQuestion) return false;
    steps_ = 0;
    return is_wanted();
  }
  bool is_wanted() const { return is_cancelled_ && is_cancelled_(); }

 private:
  static constexpr std::size_t kStepsPerQuestion = 4096;
  const CancelPoll& is_cancelled_;
  std::size_t steps_ = 0;
};

}  // namespace watertight::delaunay
