// SPDX-License-Identifier: GPL-3.0-or-later
//
// A limit on the number of geometric tests that a search makes. Private to delaunay/.
#pragma once

#include <cstddef>

#include "delaunay/cancellation.h"

namespace watertight::delaunay {

/// Counts tests up to a limit, and asks the caller once in some thousand whether to go on. Keeps a
/// reference to `is_cancelled`.
class TestBudget {
 public:
  TestBudget(std::size_t tests, const CancelPoll& is_cancelled)
      : left_(tests), cancellation_(is_cancelled) {}

  /// Counts a test. False once the tests are used up or the caller cancels.
  bool take() {
    if (left_ == 0) return false;
    --left_;
    if (!cancellation_.is_due_and_wanted()) return true;
    is_cancelled_ = true;
    left_ = 0;
    return false;
  }
  void add(std::size_t tests) { left_ += tests; }
  bool is_used_up() const { return left_ == 0; }
  bool is_cancelled() const { return is_cancelled_; }

 private:
  std::size_t left_;
  bool is_cancelled_ = false;
  Cancellation cancellation_;
};

}  // namespace watertight::delaunay
