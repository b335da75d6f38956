// SPDX-License-Identifier: GPL-3.0-or-later
//
// The reports that a run writes to files.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "files/files.h"
#include "report/feature_report.h"

namespace watertight::cli {

using report::ReportForm;

class ReportFiles {
 public:
  /// Takes the name of a file, as messages have it, and an error.
  using Complaint = std::function<void(const std::string&, const Error&)>;
  using Call = std::function<Status(report::FeatureReport&)>;

  /// Starts to write a report. Errors: those of FileWriter::open(); invalid_argument for the file
  /// of another report.
  Status open(const std::string& path, ReportForm form, const report::ReportHead& head);
  bool is_empty() const { return reports_.empty(); }
  /// Passes a call to all reports. Errors: the first report's error, naming its file.
  Status tell(const Call& call);
  /// Ends the reports, and gives the files their names.
  void finish(const Complaint& complain);
  /// Gives up all reports; their files are gone.
  void give_up() { reports_.clear(); }

 private:
  struct Open {
    std::unique_ptr<files::FileWriter> file;
    std::unique_ptr<report::FeatureReport> report;
    std::string path;
  };
  std::vector<Open> reports_;
};

/// The name of an output in messages.
std::string output_name(const std::string& path);

/// The time of day, RFC 3339 in UTC.
std::string time_now();

}  // namespace watertight::cli
