// SPDX-License-Identifier: GPL-3.0-or-later
//
// The work of one job: the documents of its file are judged and stored, each in one transaction.
// Internal to server/jobs/.
#pragma once

#include <functional>

#include "server/handlers.h"
#include "server/jobs/job.h"
#include "server/jobs/job_folder.h"

namespace watertight::server {

struct JobRun {
  const Service& service;
  const JobFolder& folder;
  CancelPoll is_cancelled;
  std::function<Status(const Job&)> save;               // makes what is done of the job durable
  std::function<void(const JobProgress&)> on_progress;  // from one thread at a time
};

/// Options of a document of a job, by the parameters of its request and, with `reads_collection`,
/// the rules of its collection. Errors: invalid_argument; those of the store, if it is read.
Result<pipeline::IngestOptions> job_options(const Service& service, const std::string& target,
                                            bool reads_collection, const CancelPoll& is_cancelled);

/// Does what is left of a job and sets its state to successful or failed. A document that is not
/// stored does not keep the others from being stored. Errors, after which the job can go on with
/// the document that was interrupted: cancelled; unavailable. Memory: a few features for each
/// thread; a document that is no sequence is read whole.
Status run_job(Job& job, const JobRun& run);

}  // namespace watertight::server
