// SPDX-License-Identifier: GPL-3.0-or-later
//
// A progress bar with rate and time left on standard error, if standard error is a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace watertight::cli {

class ProgressBar {
 public:
  /// `position` says which file of how many it is, "file 3 of 41"; "" for one file.
  explicit ProgressBar(const std::string& label, const std::string& position = {});
  ~ProgressBar();  // wipes the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows the number of features and, if known, the `share` of the whole that is done, 0 to 1.
  /// Draws at most ten times a second. Not for several threads at once.
  void show(std::uint64_t features, std::optional<double> share);

 private:
  std::string label_;
  std::string position_;
  bool is_terminal_;
  bool is_drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

/// "file 3 of 41", the position for a ProgressBar; "" in a run over one file. `number` is from 1.
std::string position_among(std::size_t number, std::size_t files);

/// The share of a document that is done: by the number of its features if known, else by bytes.
std::optional<double> share_done(std::uint64_t features, std::optional<std::uint64_t> all_features,
                                 std::uint64_t bytes, std::optional<std::uint64_t> all_bytes);

/// The line that is shown, e.g. "x.jsonl [###...] 12000 features  850/s  2:05 left".
std::string progress_line(const std::string& label, std::uint64_t features,
                          std::optional<double> share, double seconds);

/// The position, the label and the rest of a line in at most `columns` columns: first the start of
/// the label is cut off, down to its last 12 characters, then the end of the line. Each character
/// of UTF-8 counts as one column.
std::string fit_to_width(const std::string& position, const std::string& label,
                         const std::string& rest, std::size_t columns);

}  // namespace watertight::cli
