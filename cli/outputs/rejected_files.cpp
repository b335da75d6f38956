// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs/rejected_files.h"

#include <algorithm>
#include <utility>

#include "pipeline/outcome_json.h"

namespace watertight::cli {

Result<RejectedFiles> RejectedFiles::open(const std::string& file, bool gives_up_rights) {
  auto documents = OutputFiles::open(file, gives_up_rights);
  if (!documents) return std::move(documents).error();
  auto report = OutputFiles::open(file + ".report.json", gives_up_rights);
  if (!report) return std::move(report).error();
  return RejectedFiles(*std::move(documents), *std::move(report));
}

/// The file of the features under a header, to which the header is written first.
Result<std::size_t> RejectedFiles::file_of(const std::string& header) {
  const auto known = std::find(headers_.begin(), headers_.end(), header);
  const auto number = static_cast<std::size_t>(known - headers_.begin());
  if (known != headers_.end()) return number;
  if (number > 0) {
    if (Status added = documents_.add(); !added) return std::move(added).error();
  }
  if (Status written = documents_.write(number, header + '\n'); !written) {
    return std::move(written).error();
  }
  headers_.push_back(header);
  return number;
}

Result<std::size_t> RejectedFiles::add(const std::string& header,
                                       std::vector<pipeline::FeatureOutcome> features) {
  std::size_t without_text = 0;
  for (pipeline::FeatureOutcome& feature : features) {
    if (feature.rejected.empty()) {
      ++without_text;
    } else {
      const auto number = file_of(header);
      if (!number) return number.error();
      if (Status written = documents_.write(*number, feature.rejected + '\n'); !written) {
        return std::move(written).error();
      }
      feature.rejected = {};
    }
    features_.push_back(std::move(feature));
  }
  return without_text;
}

Status RejectedFiles::commit(const pipeline::IngestCounts& counts) {
  if (features_.empty()) return Done{};
  if (!headers_.empty()) {
    if (Status committed = documents_.commit(); !committed) return committed;
  }
  const std::string text = pipeline::outcome_json({counts, std::move(features_)}) + '\n';
  if (Status written = report_.write(0, text); !written) return written;
  return report_.commit();
}

}  // namespace watertight::cli
