// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/temporary_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

namespace watertight {
namespace {

Error file_error(int error) {
  return {ErrorCode::unavailable, std::string("the temporary file: ").append(std::strerror(error))};
}

std::string folder_for_files() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  return error ? "/tmp" : folder.string();
}

}  // namespace

Result<TemporaryFile> TemporaryFile::make() {
  const std::string folder = folder_for_files();
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (unnamed >= 0) return TemporaryFile(unnamed);
  return make({});  // not every file system has files without names
}

Result<TemporaryFile> TemporaryFile::make(
    const std::function<Status(const std::string& path)>& open) {
  std::string name = folder_for_files() + "/watertight-XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named < 0) return file_error(errno);
  TemporaryFile file(named);
  Status opened = open ? open(name) : Done{};
  ::unlink(name.c_str());
  if (!opened) return std::move(opened).error();
  return file;
}

TemporaryFile::~TemporaryFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status TemporaryFile::append(ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t count =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(size_));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return file_error(count < 0 ? errno : ENOSPC);
    size_ += static_cast<std::uint64_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return Done{};
}

Status TemporaryFile::measure() {
  const off_t end = ::lseek(descriptor_, 0, SEEK_END);
  if (end < 0) return file_error(errno);
  size_ = static_cast<std::uint64_t>(end);
  return Done{};
}

Result<Bytes> TemporaryFile::read(std::uint64_t offset, std::size_t count) const {
  Bytes bytes(count);
  for (std::size_t have = 0; have < count;) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data() + have, count - have, static_cast<off_t>(offset + have));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return file_error(got < 0 ? errno : EIO);
    have += static_cast<std::size_t>(got);
  }
  return bytes;
}

}  // namespace watertight
