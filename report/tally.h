// SPDX-License-Identifier: GPL-3.0-or-later
//
// The counts of a report: features and solids by type and verdict, findings by code. Internal to
// report/.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "pipeline/pipeline.h"

namespace watertight::report {

struct VerdictCount {
  std::uint64_t valid = 0;
  std::uint64_t invalid = 0;
  std::uint64_t undecided = 0;
  std::uint64_t total() const { return valid + invalid + undecided; }
  void add(Verdict verdict);
};

/// The solids that were not valid as they were read, of a document that was repaired.
struct RepairCount {
  std::uint64_t repaired = 0;
  std::uint64_t left = 0;  // as they were
};

class Tally {
 public:
  void add(const pipeline::InspectedFeature& feature);
  void add_error(int code);

  const std::map<std::string, VerdictCount>& features() const { return features_; }
  const std::map<std::string, VerdictCount>& solids() const { return solids_; }
  VerdictCount all_features() const;
  VerdictCount all_solids() const;
  /// The number of findings of each code, without omitted ones; errors of reading count under their
  /// codes.
  const std::map<int, std::uint64_t>& findings() const { return findings_; }
  const std::set<int>& errors() const { return errors_; }
  const std::set<int>& warnings() const { return warnings_; }
  const std::set<int>& first_level() const { return first_level_; }
  /// The surfaces, which `solids` does not count.
  const pipeline::SurfaceCounts& surfaces() const { return surfaces_; }
  const RepairCount& repairs() const { return repairs_; }
  std::uint64_t unreadable() const { return unreadable_; }
  std::uint64_t omitted() const { return omitted_; }
  /// The worst verdict of all features; at least undecided when something could not be read.
  Verdict verdict() const;
  bool is_valid() const { return verdict() == Verdict::valid; }

 private:
  void add_finding(const Finding& finding);

  std::map<std::string, VerdictCount> features_;  // by type of the feature
  std::map<std::string, VerdictCount> solids_;
  pipeline::SurfaceCounts surfaces_;
  RepairCount repairs_;
  std::map<int, std::uint64_t> findings_;
  std::set<int> errors_;
  std::set<int> warnings_;
  std::set<int> first_level_;
  std::uint64_t unreadable_ = 0;
  std::uint64_t omitted_ = 0;
  Verdict verdict_ = Verdict::valid;
};

/// val3dity's number for something that could not be read: 901, 903, 904, or 999 where the fault is
/// not in the input.
int code_of(const Error& error);

/// The name of a finding's code or of 999.
std::string_view name_of(int code);

}  // namespace watertight::report
