// SPDX-License-Identifier: GPL-3.0-or-later
//
// The findings of features as lines of text, the worst features first.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "pipeline/pipeline.h"

namespace watertight::cli {

/// How urgent a line is. New errors decide the exit status.
enum class Urgency : std::uint8_t { error, undecided, warning, known_error, known_warning, rest };

/// The findings of one feature.
struct FeatureLines {
  std::string head;                // "a.city.json: b: invalid, 2 errors"
  std::vector<std::string> lines;  // a line for each finding, the most urgent first
  Urgency worst = Urgency::rest;
  std::size_t errors = 0;  // errors that are not known
};

/// The lines of a feature; no lines when nothing was found and all is decided. `is_known[i]` tells
/// of finding i, in the order of report::identified_findings(), whether a baseline has it; an
/// empty vector: none is known.
FeatureLines lines_of(const std::string& file, const pipeline::InspectedFeature& feature,
                      const std::vector<bool>& is_known);
FeatureLines lines_of(const std::string& file, const pipeline::FeatureOutcome& feature);

/// The head and the lines, as text.
std::string text_of(const FeatureLines& feature);

/// Collects features and writes the worst first: by their most urgent line, then by the number of
/// errors, then in the order in which they came. Of more than `most_lines` lines the least urgent
/// are dropped and counted, so memory is bounded.
class FindingList {
 public:
  static constexpr std::size_t kMostLines = 20'000;
  explicit FindingList(std::size_t most_lines = kMostLines) : most_lines_(most_lines) {}
  void add(FeatureLines feature);
  std::string text() const;

 private:
  struct Entry {
    FeatureLines feature;
    std::uint64_t number = 0;  // in the order in which features came
  };
  struct IsWorse {
    bool operator()(const Entry& a, const Entry& b) const;
  };
  std::size_t most_lines_;
  std::set<Entry, IsWorse> entries_;
  std::uint64_t added_ = 0;
  std::size_t lines_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace watertight::cli
