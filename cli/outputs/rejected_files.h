// SPDX-License-Identifier: GPL-3.0-or-later
//
// The files of `ingest --rejected FILE`: FILE has what --invalid skip leaves out, as a CityJSONSeq
// (FILE-2, ... for documents with other headers), FILE.report.json the findings.
#pragma once

#include <string>
#include <vector>

#include "cli/outputs/output_files.h"
#include "pipeline/pipeline.h"

namespace watertight::cli {

class RejectedFiles {
 public:
  /// Starts to write, with the rights that the program has now; see OutputFiles::open().
  static Result<RejectedFiles> open(const std::string& file, bool gives_up_rights);

  /// Adds what was left out of the features of a document. Returns the number of features that are
  /// left out and have no text, as only those of city models have. Errors: those of OutputFiles.
  Result<std::size_t> add(const std::string& header,
                          std::vector<pipeline::FeatureOutcome> features);
  /// Gives the files their names; without anything left out there are none. Errors: those of
  /// OutputFiles.
  Status commit(const pipeline::IngestCounts& counts);

 private:
  RejectedFiles(OutputFiles documents, OutputFiles report)
      : documents_(std::move(documents)), report_(std::move(report)) {}
  Result<std::size_t> file_of(const std::string& header);

  OutputFiles documents_;
  OutputFiles report_;
  std::vector<std::string> headers_;  // of each file of documents_
  std::vector<pipeline::FeatureOutcome> features_;
};

}  // namespace watertight::cli
