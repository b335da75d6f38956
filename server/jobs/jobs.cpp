// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/jobs/jobs.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <new>
#include <random>
#include <utility>

#include "server/jobs/job_run.h"
#include "server/metrics/metrics.h"
#include "server/transport/priority.h"

namespace watertight::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWaiting = 1000;
constexpr std::size_t kMostKept = 1000;                        // jobs that are over
constexpr Moment kKept = Moment{7} * 24 * 3600 * 1000;         // milliseconds
constexpr unsigned kMostTries = 60;                            // while the database is away
constexpr std::chrono::seconds kLongestPause{30};              // between two of them
constexpr std::uint64_t kRoomStep = std::uint64_t{64} << 20U;  // bytes between looks at the disk

/// An id that comes after all earlier ones in the order of texts.
std::string make_id(Moment created) {
  std::random_device random;
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%012llx-%08x%08x",
                static_cast<unsigned long long>(created), random(), random());
  return text.data();
}

std::string owned_key(const std::string& owner, const std::string& key) {
  return owner + '/' + key;
}

}  // namespace

Problem problem_of_upload(const Error& error) {
  Problem problem = to_problem(error);
  if (error.code == ErrorCode::unavailable) {
    problem.status = 507;
    problem.kind = "storage-full";
    problem.headers.clear();
  } else if (error.code == ErrorCode::limit_exceeded) {
    problem.status = 503;
    problem.kind = "busy";
    problem.headers.push_back({"Retry-After", "5"});
  }
  return problem;
}

Upload::Upload(Jobs& jobs, Job job, JobFolder folder, GrowingFile file)
    : jobs_(jobs), job_(std::move(job)), folder_(std::move(folder)), file_(std::move(file)) {}

Upload::~Upload() {
  if (file_) folder_.remove();
  const std::lock_guard lock(jobs_.mutex_);
  if (file_) --jobs_.waiting_;
  if (!job_.idempotency_key.empty()) {
    jobs_.uploading_keys_.erase(owned_key(job_.owner, job_.idempotency_key));
  }
}

std::optional<Response> Upload::take(std::string_view piece) {
  job_.bytes += piece.size();
  if (job_.bytes - checked_ > kRoomStep) {
    checked_ = job_.bytes;
    if (Status room = check_room(jobs_.folder_); !room)
      return to_response(problem_of_upload(room.error()));
  }
  if (Status written = file_->write(piece); !written)
    return to_response(problem_of_upload(written.error()));
  return std::nullopt;
}

Result<JobView> Upload::accept() {
  if (job_.bytes == 0) return Error{ErrorCode::invalid_argument, "the body is empty"};
  if (Status synced = file_->sync(); !synced) return std::move(synced).error();
  job_.message = "waits for its turn";
  if (Status saved = folder_.save(job_); !saved) return std::move(saved).error();
  const auto record = std::make_shared<Jobs::Record>(Jobs::Record{{job_, {}}, false});
  file_.reset();
  const std::lock_guard lock(jobs_.mutex_);
  jobs_.records_[job_.id] = record;
  jobs_.changed_.notify_all();
  jobs_.log_("event=job id=" + job_.id + " status=accepted");
  return record->view;
}

Jobs::Jobs(std::string folder, const Service& service, LogLine log)
    : folder_(std::move(folder)), service_(service), log_(std::move(log)) {}

Result<std::unique_ptr<Jobs>> Jobs::open(const std::string& folder, const Service& service,
                                         LogLine log) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) fs::permissions(folder, fs::perms::owner_all, error);
  if (error) return Error{ErrorCode::unavailable, folder + ": " + error.message()};
  std::unique_ptr<Jobs> jobs(new Jobs(folder, service, std::move(log)));
  if (Status loaded = jobs->load(); !loaded) return std::move(loaded).error();
  jobs->thread_ = std::thread([raw = jobs.get()] { raw->work(); });
  return jobs;
}

Jobs::~Jobs() { stop(); }

void Jobs::stop() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

/// Reads the jobs of an earlier process; those that ran wait again.
Status Jobs::load() {
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string id = entry->path().filename().string();
    const JobFolder folder = folder_of(id);
    auto job = folder.load();
    if (!job) {
      const bool is_unfinished = job.error().code == ErrorCode::not_found;
      log_("event=job-not-read id=" + id + " removed=" + (is_unfinished ? "yes" : "no"));
      if (is_unfinished) folder.remove();
      continue;
    }
    if (job->id != id) continue;
    if (!job->is_over()) {
      job->state = JobState::accepted;
      ++waiting_;
    }
    records_[id] = std::make_shared<Record>(Record{{*std::move(job), {}}, false});
  }
  if (error) return Error{ErrorCode::unavailable, folder_ + ": " + error.message()};
  return Done{};
}

std::optional<JobView> Jobs::found_by_key(const std::string& owner, const std::string& key) const {
  for (const auto& [id, record] : records_) {
    const Job& job = record->view.job;
    if (job.owner == owner && job.idempotency_key == key) return record->view;
  }
  return std::nullopt;
}

Result<std::optional<JobView>> Jobs::made_with(const std::string& owner,
                                               const std::string& key) const {
  const std::lock_guard lock(mutex_);
  if (uploading_keys_.contains(owned_key(owner, key))) {
    return Error{ErrorCode::conflict, "a file with this Idempotency-Key is being uploaded"};
  }
  return found_by_key(owner, key);
}

Result<std::shared_ptr<Upload>> Jobs::upload(Job job) {
  if (Status room = check_room(folder_); !room) return std::move(room).error();
  {
    const std::lock_guard lock(mutex_);
    if (waiting_ >= kMostWaiting) {
      return Error{ErrorCode::limit_exceeded,
                   "at most " + std::to_string(kMostWaiting) + " jobs can wait"};
    }
    if (!job.idempotency_key.empty()) {
      const bool is_new = uploading_keys_.insert(owned_key(job.owner, job.idempotency_key)).second;
      if (!is_new) {
        return Error{ErrorCode::conflict, "a file with this Idempotency-Key is being uploaded"};
      }
    }
    ++waiting_;
  }
  job.created = now();
  job.id = make_id(job.created);
  JobFolder folder = folder_of(job.id);
  const std::string key = owned_key(job.owner, job.idempotency_key);
  const auto failed = [&](Error error) {
    folder.remove();
    const std::lock_guard lock(mutex_);
    --waiting_;
    uploading_keys_.erase(key);
    return error;
  };
  if (Status made = folder.make(); !made) return failed(std::move(made).error());
  auto file = GrowingFile::open(folder.document(), 0);
  if (!file) return failed(std::move(file).error());
  return std::make_shared<Upload>(*this, std::move(job), folder, *std::move(file));
}

std::optional<JobView> Jobs::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = records_.find(id);
  if (found == records_.end()) return std::nullopt;
  return found->second->view;
}

Result<std::vector<JobView>> Jobs::list(std::size_t limit, const std::string& before) const {
  const std::lock_guard lock(mutex_);
  auto end = records_.end();
  if (!before.empty()) {
    end = records_.find(before);
    if (end == records_.end()) return Error{ErrorCode::not_found, "no job has the id of 'after'"};
  }
  std::vector<JobView> views;
  while (end != records_.begin() && views.size() < limit) views.push_back((--end)->second->view);
  return views;
}

Result<JobView> Jobs::dismiss(const std::string& id) {
  std::unique_lock lock(mutex_);
  const auto found = records_.find(id);
  if (found == records_.end()) return Error{ErrorCode::not_found, "there is no job '" + id + "'"};
  const std::shared_ptr<Record> record = found->second;
  Job& job = record->view.job;
  if (job.state == JobState::running) {
    record->is_dismissed = true;
    job.message = "is being ended";
    changed_.notify_all();
    return record->view;
  }
  if (job.is_over()) {
    records_.erase(found);
    lock.unlock();
    folder_of(id).remove();
    record->view.job.state = JobState::dismissed;
    record->view.job.message = "removed with its results";
    return record->view;
  }
  Job ended = job;
  ended.state = JobState::dismissed;
  ended.message = "dismissed before it began";
  ended.finished = now();
  if (Status saved = folder_of(id).save(ended); !saved) return std::move(saved).error();
  folder_of(id).remove_document();
  job = std::move(ended);
  --waiting_;
  return record->view;
}

std::string Jobs::results_path(const std::string& id) const { return folder_of(id).results(); }

/// The next job to do; null at the end.
std::shared_ptr<Jobs::Record> Jobs::next() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (is_stopping_) return nullptr;
    for (const auto& [id, record] : records_) {
      if (record->view.job.state != JobState::accepted) continue;
      record->view.job.state = JobState::running;
      --waiting_;
      return record;
    }
    changed_.wait(lock);
  }
}

void Jobs::work() {
  // The requests of clients that wait go first.
  step_back();
  remove_old();
  while (const auto record = next()) {
    run(*record);
    remove_old();
  }
}

bool Jobs::is_unwanted(const Record& record) const {
  const std::lock_guard lock(mutex_);
  return is_stopping_ || record.is_dismissed;
}

void Jobs::publish(Record& record, const Job& job) {
  const std::lock_guard lock(mutex_);
  record.view.job = job;
}

/// One attempt at what is left of a job. Third-party code may throw.
Status Jobs::attempt(Job& job, Record& record) {
  const JobFolder folder = folder_of(job.id);
  const JobRun run{service_, folder, [&] { return is_unwanted(record); },
                   [&](const Job& saved) {
                     publish(record, saved);
                     return folder.save(saved);
                   },
                   [&](const JobProgress& progress) {
                     const std::lock_guard lock(mutex_);
                     record.view.progress = progress;
                   }};
  try {
    return run_job(job, run);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::limit_exceeded, "not enough memory for this job"};
  } catch (const std::exception& failure) {
    return Error{ErrorCode::limit_exceeded, std::string("unexpected failure: ") + failure.what()};
  }
}

void Jobs::wait_before_retry(const Record& record, unsigned tries) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::min(kLongestPause, std::chrono::seconds(tries)),
                    [&] { return is_stopping_ || record.is_dismissed; });
}

void Jobs::run(Record& record) {
  Job job = record.view.job;
  if (job.started == 0) job.started = now();
  job.message = "is being stored";
  log_("event=job id=" + job.id + " status=running");
  for (unsigned tries = 1;; ++tries) {
    publish(record, job);
    const Status done = attempt(job, record);
    if (done) break;
    std::unique_lock lock(mutex_);
    if (is_stopping_) {
      job.state = JobState::accepted;
      job.message = "interrupted; goes on when the service runs again";
      record.view.job = job;
      lock.unlock();
      static_cast<void>(folder_of(job.id).save(job));  // else it was running, which means the same
      return;
    }
    const bool is_dismissed = record.is_dismissed;
    lock.unlock();
    if (is_dismissed) {
      job.state = JobState::dismissed;
      job.message = "dismissed; the document that was being read is not stored";
      break;
    }
    if (done.error().code != ErrorCode::unavailable || tries == kMostTries) {
      job.state = JobState::failed;
      job.message = done.error().message;
      break;
    }
    job.message = done.error().message + "; is tried again";
    publish(record, job);
    wait_before_retry(record, tries);
  }
  finish(record, std::move(job));
}

void Jobs::finish(Record& record, Job job) {
  job.finished = now();
  const JobFolder folder = folder_of(job.id);
  if (Status saved = folder.save(job); !saved) {
    log_("event=job-not-saved id=" + job.id + " error=\"" + to_string(saved.error()) + "\"");
  }
  folder.remove_document();
  // First counted, then shown: who reads that a job is over also reads it in the metrics.
  if (service_.metrics != nullptr) service_.metrics->count_job(to_string(job.state));
  publish(record, job);
  log_("event=job id=" + job.id + " status=" + std::string(to_string(job.state)) + " stored=" +
       std::to_string(job.counts.stored) + " ms=" + std::to_string(job.finished - job.started));
}

/// Removes the jobs that have been over for long, or are too many.
void Jobs::remove_old() {
  std::vector<std::string> gone;
  {
    const std::lock_guard lock(mutex_);
    std::size_t kept = 0;
    for (auto entry = records_.rbegin(); entry != records_.rend(); ++entry) {
      const Job& job = entry->second->view.job;
      if (!job.is_over()) continue;
      if (++kept > kMostKept || now() - job.finished > kKept) gone.push_back(job.id);
    }
    for (const std::string& id : gone) records_.erase(id);
  }
  for (const std::string& id : gone) folder_of(id).remove();
}

}  // namespace watertight::server
