// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job: a document that was uploaded, and is stored in a collection while nobody waits for the
// answer. Its states are those of OGC API - Processes. Internal to server/.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "pipeline/pipeline.h"

namespace watertight::server {

enum class JobState : std::uint8_t { accepted, running, successful, failed, dismissed };
std::string_view to_string(JobState state);

/// A moment in milliseconds since 1970; 0: not yet.
using Moment = std::int64_t;
Moment now();
/// The moment as RFC 3339 writes it, in UTC: "2026-11-26T20:15:00.125Z".
std::string text_of(Moment moment);

/// All that is kept of a job, also while the service does not run.
struct Job {
  std::string id;
  std::string target;  // of the request, which names the rules
  std::string collection;
  std::string name;             // of the file, as the client says; "" without
  std::string idempotency_key;  // "" without
  std::string owner;            // the name of the access key that made it; "" without
  std::uint64_t bytes = 0;      // of the file
  JobState state = JobState::accepted;
  std::string message;  // one sentence for the client
  Moment created = 0, started = 0, finished = 0;
  std::uint64_t documents = 0;  // in the file; 0 before it was read
  std::uint64_t documents_done = 0;
  std::uint64_t documents_failed = 0;  // of those that are done: nothing of them was stored
  unsigned starts = 0;                 // how often the present document was begun
  std::uint64_t results_bytes = 0;     // of the lines about the documents that are done
  pipeline::IngestCounts counts;       // of the documents that are done

  bool is_over() const { return state != JobState::accepted && state != JobState::running; }
};

/// How far a running job is; lost with the process.
struct JobProgress {
  std::uint64_t features = 0;      // of the present document
  std::uint64_t all_features = 0;  // since the run began
  double share = 0;                // of the whole job, 0 to 1
  double seconds = 0;              // since the run began
  double share_before = 0;         // where the run began
};

/// The job as the text that is kept of it, and back. Errors: malformed.
std::string text_of(const Job& job);
Result<Job> read_job(const std::string& text);

/// What clients are told: the members of a statusInfo of OGC API - Processes, and more. Links start
/// with `base`.
std::string status_json(const Job& job, const JobProgress& progress, const std::string& base);

}  // namespace watertight::server
