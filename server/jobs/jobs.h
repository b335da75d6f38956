// SPDX-License-Identifier: GPL-3.0-or-later
//
// The jobs of the service: a list that outlives the process, and a thread that does them one after
// the other. Internal to server/.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/handlers.h"
#include "server/jobs/job.h"
#include "server/jobs/job_folder.h"

namespace watertight::server {

/// A job and how far it is.
struct JobView {
  Job job;
  JobProgress progress;
};

class Jobs;

/// The problem with an upload: 507 storage-full, 503 busy, or that of the error.
Problem problem_of_upload(const Error& error);

/// A file on its way to a job. Without accept() it leaves nothing behind.
class Upload final : public BodySink {
 public:
  Upload(Jobs& jobs, Job job, JobFolder folder, GrowingFile file);
  ~Upload() override;

  std::optional<Response> take(std::string_view piece) override;
  /// Makes the job of the file, durably. Errors: invalid_argument for an empty file; unavailable.
  Result<JobView> accept();

 private:
  Jobs& jobs_;
  Job job_;
  JobFolder folder_;
  std::optional<GrowingFile> file_;  // absent after accept()
  std::uint64_t checked_ = 0;        // the bytes at which there was room on the disk
};

/// Thread-safe.
class Jobs {
 public:
  /// Reads the jobs in a folder, which is made if it is missing, and goes on with those that are
  /// not over. The parts of `service` outlive the object. Errors: unavailable.
  static Result<std::unique_ptr<Jobs>> open(const std::string& folder, const Service& service,
                                            LogLine log);
  ~Jobs();  // stops
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// The job that a client made with this key before; nothing without such a job. Errors: conflict
  /// when its file is being uploaded.
  Result<std::optional<JobView>> made_with(const std::string& owner, const std::string& key) const;
  /// Begins the upload of a file; the job needs no id yet. Errors: limit_exceeded (too many jobs
  /// wait); unavailable (disk); those of made_with().
  Result<std::shared_ptr<Upload>> upload(Job job);

  std::optional<JobView> find(const std::string& id) const;
  /// The jobs before `before` ("": the newest), the newest first. Errors: not_found.
  Result<std::vector<JobView>> list(std::size_t limit, const std::string& before) const;
  /// Ends a job, or removes one that is over. A running job ends a moment later, or is done before.
  /// Errors: not_found; unavailable.
  Result<JobView> dismiss(const std::string& id);
  /// The file of the lines of a job.
  std::string results_path(const std::string& id) const;
  /// Interrupts the running job, which goes on when the service runs again. Later calls do nothing.
  void stop();

 private:
  friend class Upload;
  struct Record {
    JobView view;
    bool is_dismissed = false;
  };
  using Records = std::map<std::string, std::shared_ptr<Record>>;

  Jobs(std::string folder, const Service& service, LogLine log);
  Status load();
  JobFolder folder_of(const std::string& id) const { return {folder_, id}; }
  std::shared_ptr<Record> next();
  void work();
  void run(Record& record);
  Status attempt(Job& job, Record& record);
  void publish(Record& record, const Job& job);
  void finish(Record& record, Job job);
  void wait_before_retry(const Record& record, unsigned tries);
  bool is_unwanted(const Record& record) const;
  void remove_old();
  std::optional<JobView> found_by_key(const std::string& owner, const std::string& key) const;

  const std::string folder_;
  const Service service_;
  const LogLine log_;
  mutable std::mutex mutex_;  // of the members below
  std::condition_variable changed_;
  Records records_;                       // by id; ids are in order of time
  std::set<std::string> uploading_keys_;  // owner and key
  std::size_t waiting_ = 0;               // jobs that are accepted, and uploads
  bool is_stopping_ = false;
  std::thread thread_;
};

}  // namespace watertight::server
