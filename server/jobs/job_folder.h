// SPDX-License-Identifier: GPL-3.0-or-later
//
// The files of one job on disk: the uploaded file, the job itself, the lines of its results.
// Internal to server/jobs/.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "server/jobs/job.h"

namespace watertight::server {

/// A file that grows at its end. What was written is on the disk after sync().
class GrowingFile {
 public:
  /// Opens a file, which is made if it is missing, and cuts it to `bytes`. Errors: unavailable with
  /// the system's reason.
  static Result<GrowingFile> open(const std::string& path, std::uint64_t bytes);
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&&) = delete;
  ~GrowingFile();

  /// Errors: unavailable, when the disk is full for example.
  Status write(std::string_view text);
  Status sync();
  std::uint64_t size() const { return size_; }

 private:
  GrowingFile(int descriptor, std::uint64_t size) : descriptor_(descriptor), size_(size) {}
  Status flush();

  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::string waiting_;  // bytes that are not in the file yet
};

class JobFolder {
 public:
  /// The folder of the job `id` in the folder of all jobs.
  JobFolder(const std::string& jobs, const std::string& id) : path_(jobs + '/' + id) {}

  /// Makes the folder. Errors: unavailable.
  Status make() const;
  std::string document() const { return path_ + "/document"; }
  std::string results() const { return path_ + "/results.ndjson"; }
  /// Writes the job; after a crash the old text or the new one is there. Errors: unavailable.
  Status save(const Job& job) const;
  /// Errors: not_found when there is no job, as its upload did not end; malformed; unavailable.
  Result<Job> load() const;
  void remove_document() const;
  void remove() const;

 private:
  std::string path_;
};

/// Whether the disk of a folder has room for more: the database may be on the same one, and a full
/// disk stops it. Errors: unavailable, when there is less than 1 GiB.
Status check_room(const std::string& folder);

}  // namespace watertight::server
