// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/outputs/locked_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace watertight::cli {
namespace {

Error system_error(int error) { return Error{ErrorCode::unavailable, std::strerror(error)}; }

}  // namespace

/// A descriptor that closes itself; the lock goes with it.
class LockedFile::Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

  Status write_at(std::uint64_t offset, ByteView bytes) const {
    while (!bytes.empty()) {
      const ssize_t count =
          ::pwrite(number_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) return system_error(errno);
      bytes = bytes.subspan(static_cast<std::size_t>(count));
      offset += static_cast<std::uint64_t>(count);
    }
    return ::fsync(number_) == 0 ? Status(Done{}) : system_error(errno);
  }

  Result<Bytes> read_at(std::uint64_t offset, std::uint64_t count) const {
    Bytes bytes(static_cast<std::size_t>(count));
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t read = ::pread(number_, bytes.data() + done, bytes.size() - done,
                                   static_cast<off_t>(offset + done));
      if (read < 0 && errno == EINTR) continue;
      if (read < 0) return system_error(errno);
      if (read == 0) break;
      done += static_cast<std::size_t>(read);
    }
    bytes.resize(done);
    return bytes;
  }

 private:
  int number_;
};

Result<LockedFile> LockedFile::open(const std::string& path) {
  const auto file = std::make_shared<Descriptor>(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (file->number() < 0) return system_error(errno);
  if (::flock(file->number(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return system_error(errno);
    return Error{ErrorCode::unavailable, "another process is writing this file"};
  }
  return LockedFile(file);
}

pipeline::FileBytes LockedFile::bytes() const {
  struct stat status {};
  pipeline::FileBytes bytes;
  if (::fstat(file_->number(), &status) == 0) {
    bytes.size = static_cast<std::uint64_t>(status.st_size);
  }
  bytes.read = [file = file_](std::uint64_t offset, std::uint64_t count) {
    return file->read_at(offset, count);
  };
  return bytes;
}

Status LockedFile::add(std::uint64_t end, ByteView records, ByteView commit) {
  if (::ftruncate(file_->number(), static_cast<off_t>(end)) != 0) return system_error(errno);
  Status written = file_->write_at(end, records);
  if (written) written = file_->write_at(end + records.size(), commit);
  return written;
}

}  // namespace watertight::cli
