// SPDX-License-Identifier: GPL-3.0-or-later
//
// The end of a run over files: the table, and the exit status.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "pipeline/pipeline.h"
#include "pipeline/streaming/stage_times.h"

namespace watertight::cli {

/// Exit statuses of the program (docs/cli.md).
enum class Exit : int { valid = 0, invalid = 1, error = 2, undecided = 3 };

/// The worse of two: error, then invalid, then undecided, then valid.
Exit worse(Exit a, Exit b);
Exit exit_of(Verdict verdict);

/// The findings of a run beside those of a baseline.
struct BaselineCounts {
  std::uint64_t fresh = 0;  // findings that the baseline does not have, and omitted ones
  std::uint64_t known = 0;
  std::uint64_t gone = 0;  // findings of the baseline that were not found
};

/// Counts over all files of a run.
class Summary {
 public:
  /// Adds the counts of a part of the run.
  void add(const Summary& part);
  void add(const pipeline::FeatureOutcome& feature);
  void add(const pipeline::InspectedFeature& feature);
  void add_file_bytes(std::uint64_t bytes) { file_bytes_ += bytes; }
  void add_stored(std::uint64_t features) { stored_ += features; }
  void add_unreadable() { ++unreadable_; }
  /// Counts a file, and whether a solid of it was checked.
  void add_file(bool has_solids, bool has_surfaces);
  /// Counts a file that could not be opened or read at all.
  void add_unreadable_file();
  void add(const BaselineCounts& counts);

  /// Counts the time of an ingestion by stages.
  void add(const pipeline::StageTimes& times);

  /// The result in a sentence or a few, one on each line.
  std::string headline() const;
  /// The table as text.
  std::string table(double seconds) const;
  /// The figures of the table as a JSON object.
  std::string json(double seconds) const;
  bool has_findings() const {
    return with_warnings_ + surfaces_.with_findings > 0 || !by_code_.empty() ||
           !groups_by_code_.empty();
  }
  /// The surfaces that were checked, which solids() does not count.
  const pipeline::SurfaceCounts& surfaces() const { return surfaces_; }
  std::uint64_t solids() const { return valid_ + invalid_ + undecided_; }

 private:
  void add_feature(Verdict verdict, bool has_solids, bool has_surfaces);
  std::string surface_rows() const;
  void add(const Report& report);
  void add(const std::vector<pipeline::InspectedGroup>& groups);

  std::uint64_t valid_ = 0;
  std::uint64_t with_warnings_ = 0;  // valid solids that have warnings
  std::uint64_t invalid_ = 0;
  std::uint64_t undecided_ = 0;
  std::uint64_t features_ = 0;
  std::uint64_t invalid_features_ = 0;
  std::uint64_t undecided_features_ = 0;
  std::uint64_t empty_features_ = 0;    // features without solids
  std::uint64_t surface_features_ = 0;  // those of them in which surfaces were checked
  std::uint64_t files_ = 0;             // 0: files are not counted
  std::uint64_t empty_files_ = 0;       // files without solids
  std::uint64_t surface_files_ = 0;     // those of them in which surfaces were checked
  std::uint64_t unreadable_files_ = 0;
  std::optional<BaselineCounts> baseline_;
  std::uint64_t unreadable_ = 0;  // features and rests of documents that could not be read
  std::uint64_t stored_ = 0;
  std::map<pipeline::Stage, double> stages_;  // seconds of all threads
  std::uint64_t file_bytes_ = 0;
  std::uint64_t plain_bytes_ = 0;  // the size of the encoded solids as plain arrays
  std::uint64_t blob_bytes_ = 0;
  bool has_tolerant_ = false;
  std::uint64_t repaired_ = 0;            // solids that were repaired before they were judged
  std::uint64_t valid_snapped_ = 0;       // solids whose tolerant verdict is valid
  std::map<int, std::uint64_t> by_code_;  // invalid solids by error code; a solid may have several
  std::map<int, std::uint64_t> groups_by_code_;  // invalid composite solids and buildings
  std::map<delaunay::Rung, std::uint64_t> by_rung_;
  pipeline::SurfaceCounts surfaces_;
  std::map<int, std::uint64_t> surfaces_by_code_;  // surfaces by code of their findings
};

}  // namespace watertight::cli
