// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/files.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace watertight::files {
namespace {

constexpr std::size_t kChunk = 1 << 16;

/// The error of a system call. Callers add the name of the file.
Error file_error(int error) { return Error{ErrorCode::unavailable, std::strerror(error)}; }

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

/// Writes all bytes. Returns 0 or the error number.
int write_all(int descriptor, ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

/// The permissions of the file that is replaced, else those that the umask gives.
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

/// Opens a file or standard input for reading.
int open_to_read(const std::string& path) {
  return path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
}

/// Reads at most as many bytes as `bytes` holds; returns their number.
Result<std::size_t> read_some(int descriptor, std::span<std::uint8_t> bytes) {
  for (;;) {
    const ssize_t count = ::read(descriptor, bytes.data(), bytes.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR) return file_error(errno);
  }
}

/// The file that a link leads to, whether it exists or not: like `cp`, writing keeps the link.
Result<std::string> behind_links(const std::string& path) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  std::filesystem::path place = path;
  for (int links = 0; std::filesystem::is_symlink(place, error); ++links) {
    const auto next = std::filesystem::read_symlink(place, error);
    if (error) return file_error(error.value());
    if (links == kMostLinks) return file_error(ELOOP);
    place = place.parent_path() / next;
  }
  return place.string();
}

/// Whether a file may not be written. Such a file is not replaced, although its folder would allow
/// that.
bool is_read_only(const std::string& path) {
  return ::access(path.c_str(), F_OK) == 0 && ::access(path.c_str(), W_OK) != 0;
}

/// Opens a new file in the folder of `path`: without a name where the system can do that, so that a
/// program that is killed leaves nothing behind; else `name` becomes its name.
int open_beside(const std::string& path, std::string& name) {
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  if (::access("/proc/self/fd", X_OK) == 0) {
    const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    if (descriptor >= 0) return descriptor;
  }
  name = path + ".XXXXXX";
  return ::mkstemp(name.data());
}

/// Gives a file without a name a name beside `path`. Returns 0 or the error number.
int name_beside(const std::string& path, int descriptor, std::string& name) {
  const std::string file = "/proc/self/fd/" + std::to_string(descriptor);
  for (int attempt = 0; attempt < 100; ++attempt) {
    name = path + "." + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    if (::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) return 0;
    if (errno != EEXIST) break;
  }
  const int error = errno;
  name.clear();
  return error;
}

}  // namespace

Result<OpenedFile> open_file(const std::string& path) {
  auto file = std::make_shared<Descriptor>(open_to_read(path));
  if (file->number() < 0) return file_error(errno);
  OpenedFile opened;
  struct stat status {};
  if (::fstat(file->number(), &status) == 0 && S_ISREG(status.st_mode)) {
    opened.bytes = static_cast<std::uint64_t>(status.st_size);
  }
  opened.source = [file](std::span<std::uint8_t> bytes) {
    return read_some(file->number(), bytes);
  };
  return opened;
}

Result<archives::RandomBytes> open_random(const std::string& path) {
  auto file = std::make_shared<Descriptor>(open_to_read(path));
  struct stat status {};
  if (file->number() < 0 || ::fstat(file->number(), &status) != 0) return file_error(errno);
  const auto read = [file](std::uint64_t offset,
                           std::span<std::uint8_t> bytes) -> Result<std::size_t> {
    for (;;) {
      const ssize_t count =
          ::pread(file->number(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (count >= 0) return static_cast<std::size_t>(count);
      if (errno != EINTR) return file_error(errno);
    }
  };
  return archives::RandomBytes{static_cast<std::uint64_t>(status.st_size), read};
}

EarlyFiles::EarlyFiles(std::span<const InputFile> inputs, bool opens_early)
    : inputs_(inputs), opens_early_(opens_early) {
  if (!opens_early) return;
  constexpr rlim_t kOthers = 256;  // descriptors of the store and the workers
  rlimit most{};
  if (::getrlimit(RLIMIT_NOFILE, &most) != 0) return;
  if (most.rlim_cur < inputs.size() + kOthers) {
    most.rlim_cur = std::min<rlim_t>(most.rlim_max, inputs.size() + kOthers);
    ::setrlimit(RLIMIT_NOFILE, &most);
    ::getrlimit(RLIMIT_NOFILE, &most);
  }
  const rlim_t room = most.rlim_cur > kOthers ? most.rlim_cur - kOthers : 0;
  for (const InputFile& input : inputs) {
    if (early_.size() < room) early_.push_back(input.open());
  }
}

Result<OpenedFile> EarlyFiles::take(std::size_t number) {
  if (number < early_.size()) {
    return std::exchange(early_[number], Error{ErrorCode::unavailable, "used already"});
  }
  auto file = inputs_[number].open();
  if (file || !opens_early_) return file;
  Error error = std::move(file).error();
  error.message += "; it was opened without root's rights, as only " +
                   std::to_string(early_.size()) +
                   " files could be opened before (ulimit -n sets how many)";
  return error;
}

Result<Bytes> read_all(const ByteSource& source, const Limits& limits) {
  Bytes bytes;
  for (;;) {
    if (bytes.size() > limits.bytes) {
      return Error{ErrorCode::limit_exceeded,
                   "larger than " + std::to_string(limits.bytes) + " bytes"};
    }
    const std::size_t size = bytes.size();
    bytes.resize(size + kChunk);
    const auto count = source(std::span<std::uint8_t>(bytes).subspan(size, kChunk));
    bytes.resize(size + (count ? *count : 0));
    if (!count) return count.error();
    if (*count == 0) return bytes;
  }
}

Result<Bytes> read_file(const std::string& path, const Limits& limits) {
  const auto file = open_file(path);
  if (!file) return file.error();
  return read_all(file->source, limits);
}

struct FileWriter::State {
  std::string path;
  std::string temporary;   // name of the new file while it has one; "" after commit()
  bool is_direct = false;  // the target itself is written: standard output, a device, a pipe
  Descriptor file;
  std::string buffer;

  State(std::string target, std::string name, bool direct, int descriptor)
      : path(std::move(target)), temporary(std::move(name)), is_direct(direct), file(descriptor) {}
  ~State() {
    if (!temporary.empty()) ::unlink(temporary.c_str());
  }
  Status flush() {
    const int error = write_all(file.number(), as_bytes(buffer));
    buffer.clear();
    if (error != 0) return file_error(error);
    return Done{};
  }
};

FileWriter::FileWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
FileWriter::FileWriter(FileWriter&&) noexcept = default;
FileWriter::~FileWriter() = default;

Result<FileWriter> FileWriter::open(const std::string& target) {
  const bool is_direct = target == "-" || is_special(target);
  const auto place = is_direct ? Result<std::string>(target) : behind_links(target);
  if (!place) return place.error();
  const std::string& path = *place;
  if (!is_direct && is_read_only(path)) return file_error(EACCES);
  std::string temporary;
  int descriptor = STDOUT_FILENO;
  if (!is_direct) {
    descriptor = open_beside(path, temporary);
  } else if (path != "-") {
    descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  }
  if (descriptor < 0) return file_error(errno);
  return FileWriter(std::make_unique<State>(path, std::move(temporary), is_direct, descriptor));
}

FileWriter FileWriter::to(int descriptor) {
  return FileWriter(std::make_unique<State>("", "", true, descriptor));
}

int FileWriter::descriptor() const { return state_->file.number(); }

Status FileWriter::write(std::string_view text) {
  state_->buffer += text;
  if (state_->buffer.size() < kChunk) return Done{};
  return state_->flush();
}

Status FileWriter::commit() {
  State& state = *state_;
  if (Status status = state.flush(); !status) return status;
  if (state.is_direct) return Done{};
  const int number = state.file.number();
  int error = ::fchmod(number, permissions_for(state.path)) == 0 ? 0 : errno;
  if (error == 0 && ::fsync(number) != 0) error = errno;
  if (error == 0 && state.temporary.empty()) {
    error = name_beside(state.path, number, state.temporary);
  }
  if (state.file.close() != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(state.temporary.c_str(), state.path.c_str()) != 0) error = errno;
  if (error != 0) return file_error(error);
  state.temporary.clear();
  return Done{};
}

Status write_file(const std::string& path, ByteView bytes) {
  auto writer = FileWriter::open(path);
  if (!writer) return std::move(writer).error();
  Status status = writer->write(as_text(bytes));
  return status ? writer->commit() : status;
}

std::string numbered_name(const std::string& output, std::size_t number) {
  if (number == 0) return output;
  const std::size_t name = output.rfind('/') + 1;  // 0 without a folder
  std::size_t ending = output.find('.', name + 1);
  if (ending == std::string::npos) ending = std::min(output.find('.', name), output.size());
  std::string result = output.substr(0, ending);
  result += '-';
  result += std::to_string(number + 1);
  return result + output.substr(ending);
}

bool is_same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  if (a == "-" || b == "-") return a == b;
  std::error_code ignored;
  if (fs::exists(a, ignored) && !fs::is_regular_file(a, ignored)) return false;
  if (a == b || fs::equivalent(a, b, ignored)) return true;
  // If no part of a relative path exists, weakly_canonical() does not make it absolute.
  const auto place = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  };
  return place(a) == place(b);
}

}  // namespace watertight::files
