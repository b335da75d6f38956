// SPDX-License-Identifier: GPL-3.0-or-later
//
// A progress bar with rate on standard error; silent when that is no terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace watertight {

class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();  // wipes the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Draws at most ten times a second. Not for several threads at once.
  void show(std::size_t done, std::size_t total);

 private:
  std::string label_;
  bool is_terminal_;
  bool is_drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace watertight
