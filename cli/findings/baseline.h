// SPDX-License-Identifier: GPL-3.0-or-later
//
// The findings of an earlier JSON report, so that a run can tell new findings from known ones.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"
#include "pipeline/pipeline.h"

namespace watertight::cli {

class Baseline {
 public:
  /// Reads the output of `validate --report`: a JSON object, or one in each line. Errors: malformed
  /// with the number of the line; unsupported for another layout of reports. Cost: linear; memory
  /// for the findings and for one line as JSON.
  static Result<Baseline> read(ByteView text);

  /// For each finding of a feature whether the baseline has it, in the order of
  /// report::identified_findings(). Each entry of the baseline is used for one finding.
  std::vector<bool> take(const std::string& file, const pipeline::InspectedFeature& feature);
  /// The number of findings that a run omits beyond those that the baseline omits for the file.
  std::uint64_t newly_omitted(const std::string& file, std::uint64_t omitted) const;
  /// The number of findings of the file that no call of take() used.
  std::uint64_t gone(const std::string& file) const;

 private:
  struct File {
    std::map<std::uint64_t, std::uint64_t> counts;  // by fingerprint
    std::uint64_t omitted = 0;
  };
  std::map<std::string, File> files_;  // by name
};

}  // namespace watertight::cli
