// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the service counts for Prometheus: requests and their times, judged solids and findings.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/pipeline.h"
#include "server/transport/listener.h"

namespace watertight::server {

/// Counters since the start of the process. Thread-safe.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// Counts an answered request; `path` is that of its route, with names in braces, "" if it has no
  /// route. Paths and methods of clients are no labels, since they could be any number.
  void count(const AnsweredRequest& request, std::string_view path);
  /// Counts the verdict, the rung and the findings of a solid that a request had judged.
  void count(const Report& report);
  /// The same for all solids of a feature, and the findings between them.
  void count(const pipeline::FeatureOutcome& feature);
  /// Counts a job that is over, under the word for its state.
  void count_job(std::string_view state);
  /// Counts the findings between solids.
  void count(const std::vector<Finding>& findings);

  /// All counters in the text format of Prometheus, version 0.0.4, and whether the database can be
  /// used.
  std::string text(bool is_ready);

 private:
  class Families;
  std::unique_ptr<Families> families_;
};

}  // namespace watertight::server
