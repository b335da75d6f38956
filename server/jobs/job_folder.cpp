// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/jobs/job_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "files/files.h"

namespace watertight::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWaitingBytes = std::size_t{64} << 10U;
constexpr std::uintmax_t kRoom = std::uintmax_t{1} << 30U;
constexpr std::uint64_t kLongestJob = 64 * 1024;  // the text of a job, bytes

Error system_error(const char* deed) {
  return {ErrorCode::unavailable, std::string(deed) + ": " + std::strerror(errno)};
}

Status sync_folder(const std::string& path) {
  const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool is_synced = folder >= 0 && ::fsync(folder) == 0;
  Status status = is_synced ? Status(Done{}) : system_error("the folder of a job");
  if (folder >= 0) ::close(folder);
  return status;
}

}  // namespace

Result<GrowingFile> GrowingFile::open(const std::string& path, std::uint64_t bytes) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (descriptor < 0) return system_error("a file of a job");
  GrowingFile file(descriptor, bytes);
  const auto end = static_cast<off_t>(bytes);
  if (::ftruncate(descriptor, end) != 0 || ::lseek(descriptor, end, SEEK_SET) != end) {
    return system_error("a file of a job");
  }
  return file;
}

GrowingFile::GrowingFile(GrowingFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      waiting_(std::move(other.waiting_)) {}

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status GrowingFile::flush() {
  std::string_view rest = waiting_;
  while (!rest.empty()) {
    const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_error("a file of a job");
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  waiting_.clear();
  return Done{};
}

Status GrowingFile::write(std::string_view text) {
  waiting_ += text;
  size_ += text.size();
  return waiting_.size() < kWaitingBytes ? Status(Done{}) : flush();
}

Status GrowingFile::sync() {
  if (Status flushed = flush(); !flushed) return flushed;
  return ::fsync(descriptor_) == 0 ? Status(Done{}) : system_error("a file of a job");
}

Status JobFolder::make() const {
  std::error_code error;
  if (fs::create_directory(path_, error)) return Done{};
  return Error{ErrorCode::unavailable, "the folder of a job cannot be made: " + error.message()};
}

Status JobFolder::save(const Job& job) const {
  const std::string fresh = path_ + "/job.json.new";
  auto file = GrowingFile::open(fresh, 0);
  if (!file) return std::move(file).error();
  if (Status written = file->write(text_of(job)); !written) return written;
  if (Status synced = file->sync(); !synced) return synced;
  if (::rename(fresh.c_str(), (path_ + "/job.json").c_str()) != 0) return system_error("a job");
  return sync_folder(path_);
}

Result<Job> JobFolder::load() const {
  const std::string path = path_ + "/job.json";
  if (!fs::exists(path)) return Error{ErrorCode::not_found, "an upload that did not end"};
  Limits limits;
  limits.bytes = kLongestJob;
  const auto text = files::read_file(path, limits);
  if (!text) return text.error();
  return read_job(std::string(as_text(*text)));
}

void JobFolder::remove_document() const {
  std::error_code ignored;
  fs::remove(document(), ignored);
}

void JobFolder::remove() const {
  std::error_code ignored;
  // The job goes first: a folder without one is removed when the service starts.
  fs::remove(path_ + "/job.json", ignored);
  fs::remove_all(path_, ignored);
}

Status check_room(const std::string& folder) {
  std::error_code error;
  const fs::space_info space = fs::space(folder, error);
  if (!error && space.available >= kRoom) return Done{};
  return Error{ErrorCode::unavailable,
               "the disk for jobs is full: 1 GiB of it stays free for the database"};
}

}  // namespace watertight::server
