// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "pipeline/container.h"

namespace watertight {
namespace {

constexpr std::size_t kChunk = 1 << 16;

Error file_error(const std::string& path, int error) {
  return Error{ErrorCode::unavailable, path + ": " + std::strerror(error)};
}

/// A descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ > STDERR_FILENO) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  int close() {
    const int result = ::close(number_);
    number_ = -1;
    return result;
  }

 private:
  int number_;
};

/// 0 or the error number.
int write_all(int descriptor, ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

/// Permissions of the file that is replaced, else those that the umask gives.
mode_t permissions_for(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return status.st_mode & 0777U;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666U & ~mask;
}

bool is_special(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

Status write_special(const std::string& path, ByteView bytes) {
  const Descriptor file(path == "-" ? STDOUT_FILENO : ::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.number() < 0) return file_error(path, errno);
  const int error = write_all(file.number(), bytes);
  if (error != 0) return file_error(path == "-" ? "standard output" : path, error);
  return Done{};
}

}  // namespace

Result<Bytes> read_file(const std::string& path, const Limits& limits) {
  const Descriptor file(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0) return file_error(path, errno);
  Bytes bytes;
  for (;;) {
    if (bytes.size() > limits.bytes) {
      return Error{ErrorCode::limit_exceeded,
                   path + ": larger than " + std::to_string(limits.bytes) + " bytes"};
    }
    const std::size_t size = bytes.size();
    bytes.resize(size + kChunk);
    const ssize_t count = ::read(file.number(), bytes.data() + size, kChunk);
    bytes.resize(size + (count > 0 ? static_cast<std::size_t>(count) : 0));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return file_error(path, errno);
    if (count == 0) return bytes;
  }
}

Status write_file(const std::string& path, ByteView bytes) {
  if (path == "-" || is_special(path)) return write_special(path, bytes);
  std::string temporary = path + ".XXXXXX";
  Descriptor file(::mkstemp(temporary.data()));
  if (file.number() < 0) return file_error(path, errno);
  int error = write_all(file.number(), bytes);
  if (error == 0 && ::fchmod(file.number(), permissions_for(path)) != 0) error = errno;
  if (error == 0 && ::fsync(file.number()) != 0) error = errno;
  if (file.close() != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error == 0) return Done{};
  ::unlink(temporary.c_str());
  return file_error(path, error);
}

Result<Input> load_input(const std::string& path, ByteView bytes, const ReadOptions& options) {
  Input input;
  if (is_container(bytes)) {
    auto document = decode_container(bytes, options.limits);
    if (!document) return std::move(document).error();
    input.kind = InputKind::container;
    input.document = *std::move(document);
    return input;
  }
  if (describe(bytes, options.limits)) {
    auto decoded = decode(bytes, options.limits);
    if (!decoded) return std::move(decoded).error();
    Feature feature;
    feature.id = path;
    feature.srid = decoded->info.srid;
    feature.solids.push_back(SubmittedSolid{std::move(decoded->solid), {}, {}});
    input.kind = InputKind::blob;
    input.document.format = Format::ewkb;
    input.document.features.push_back(std::move(feature));
    return input;
  }
  const auto format = detect_format(path == "-" ? "" : path, bytes);
  if (!format) return format.error();
  auto document = read_document(bytes, *format, options);
  if (!document) return std::move(document).error();
  input.document = *std::move(document);
  return input;
}

Result<Format> format_of_name(const std::string& path) {
  const auto format = detect_format(path, {});
  if (format) return format;
  return Error{ErrorCode::unsupported,
               "the ending of '" + path +
                   "' names no format; known: .city.json .json .city.jsonl .jsonl .obj .off .wkt "
                   ".wkb .ewkb"};
}

}  // namespace watertight
