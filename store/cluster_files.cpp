// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/cluster_files.h"

#include <dirent.h>
#include <fcntl.h>
#include <pwd.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <thread>
#include <utility>

#include "base/bytes.h"
#include "base/checksum.h"

namespace watertight::store {
namespace {

namespace fs = std::filesystem;
constexpr std::chrono::milliseconds kLockPoll{20};
constexpr std::uintmax_t kLargestLog = 16ULL << 20;
// The length of "/.s.PGSQL.5432", the name of the socket in its folder.
constexpr std::size_t kSocketNameBytes = 14;

/// Creates a directory with mode 0700. An existing one must belong to this user and is closed to
/// others.
Status private_folder(const std::string& path) {
  if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) return system_error("create " + path);
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return system_error("look at " + path);
  if (!S_ISDIR(status.st_mode) || status.st_uid != geteuid()) {
    return Error{ErrorCode::unavailable, path + " is not a directory of this user"};
  }
  if ((status.st_mode & 077) != 0 && chmod(path.c_str(), 0700) != 0) {
    return system_error("close " + path + " to others");
  }
  return Done{};
}

std::string first_word_of(const std::string& path) {
  std::ifstream file(path);
  std::string word;
  file >> word;
  return word;
}

bool holds_programs(const std::string& folder) {
  return access((folder + "/initdb").c_str(), X_OK) == 0 &&
         access((folder + "/postgres").c_str(), X_OK) == 0;
}

Error unavailable(std::string message) { return {ErrorCode::unavailable, std::move(message)}; }

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

}  // namespace

Error system_error(const std::string& what) {
  return {ErrorCode::unavailable, "cannot " + what + ": " + std::strerror(errno)};
}

FileLock::FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

Result<FileLock> FileLock::take(const std::string& path, Kind kind, std::chrono::seconds patience,
                                const CancelPoll& is_cancelled) {
  FileLock lock(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (lock.descriptor_ < 0) return system_error("open " + path);
  const int operation = (kind == Kind::shared ? LOCK_SH : LOCK_EX) | LOCK_NB;
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (flock(lock.descriptor_, operation) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) return system_error("lock " + path);
    if (std::chrono::steady_clock::now() > deadline) {
      return Error{ErrorCode::unavailable, "another process holds " + path};
    }
    if (is_cancelled && is_cancelled()) {
      return Error{ErrorCode::cancelled, "stopped while another process held " + path};
    }
    std::this_thread::sleep_for(kLockPoll);
  }
  return Result<FileLock>(std::move(lock));
}

bool FileLock::try_exclusive() { return flock(descriptor_, LOCK_EX | LOCK_NB) == 0; }

std::optional<PostmasterFile> read_postmaster_file(const std::string& pgdata) {
  std::ifstream file(pgdata + "/postmaster.pid");
  // pid, PGDATA, start time, port, socket folder, address, shared memory, state
  std::array<std::string, 8> lines;
  for (std::string& line : lines) std::getline(file, line);
  PostmasterFile found;
  const char* const end = lines[0].data() + lines[0].size();
  const auto parsed = std::from_chars(lines[0].data(), end, found.pid);
  if (parsed.ec != std::errc{} || found.pid <= 0) return std::nullopt;
  found.socket_folder = lines[4];
  found.state = lines[7].substr(0, lines[7].find(' '));
  return found;
}

bool is_postgres_in(pid_t pid, const std::string& pgdata) {
  const std::string process = "/proc/" + std::to_string(pid);
  std::array<char, PATH_MAX> folder{};
  const ssize_t length = readlink((process + "/cwd").c_str(), folder.data(), folder.size());
  if (length <= 0) return false;
  return std::string_view(folder.data(), static_cast<std::size_t>(length)) == pgdata &&
         first_word_of(process + "/comm") == "postgres";
}

std::vector<pid_t> postgres_processes_in(const std::string& pgdata) {
  std::vector<pid_t> found;
  std::error_code failure;
  for (fs::directory_iterator entry("/proc", failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const std::string name = entry->path().filename();
    pid_t pid = 0;
    const auto parsed = std::from_chars(name.data(), name.data() + name.size(), pid);
    if (parsed.ec != std::errc{} || parsed.ptr != name.data() + name.size()) continue;
    if (is_postgres_in(pid, pgdata)) found.push_back(pid);
  }
  std::sort(found.begin(), found.end());
  return found;
}

void continue_stopped_processes(const std::string& pgdata) {
  for (const pid_t pid : postgres_processes_in(pgdata)) {
    std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
    std::string text;
    std::getline(file, text);
    const std::size_t name_end = text.rfind(')');  // the state follows the program's name
    if (name_end != std::string::npos && text.substr(name_end, 3) == ") T") kill(pid, SIGCONT);
  }
}

Result<std::string> find_programs(const std::string& wanted, const std::string& version) {
  std::vector<std::string> folders;
  if (!wanted.empty()) {
    folders.push_back(wanted);
  } else {
    const char* variable = std::getenv("WATERTIGHT_POSTGRES_BIN");
    if (variable != nullptr && *variable != '\0') folders.emplace_back(variable);
    if (!version.empty()) folders.push_back("/usr/lib/postgresql/" + version + "/bin");
    folders.emplace_back(WATERTIGHT_POSTGRES_BINDIR);
    for (int major = 18; major >= 14; --major) {
      folders.push_back("/usr/lib/postgresql/" + std::to_string(major) + "/bin");
    }
    folders.insert(folders.end(), {"/usr/local/pgsql/bin", "/usr/local/bin", "/usr/bin"});
  }
  std::string tried;
  for (const std::string& folder : folders) {
    if (folder.empty()) continue;
    if (holds_programs(folder)) return folder;
    tried += (tried.empty() ? "" : ", ") + folder;
  }
  return unavailable("PostgreSQL's programs initdb and postgres are not in " + tried +
                     " (Debian: apt install postgresql)");
}

Result<std::string> user_name() {
  std::array<char, 4096> buffer{};
  passwd entry{};
  passwd* found = nullptr;
  errno = getpwuid_r(geteuid(), &entry, buffer.data(), buffer.size(), &found);
  if (errno != 0) return system_error("look up the name of the user " + std::to_string(geteuid()));
  if (found == nullptr) {
    return unavailable("the user with number " + std::to_string(geteuid()) +
                       " has no name, and PostgreSQL needs one");
  }
  return std::string(found->pw_name);
}

bool is_large_log(const std::string& path) {
  std::error_code failure;
  const std::uintmax_t size = fs::file_size(path, failure);
  return !failure && size > kLargestLog;
}

void bound_log(const std::string& path) {
  if (!is_large_log(path)) return;
  std::error_code failure;
  // A failed copy, of a full disk, must not keep the log from being emptied.
  fs::copy_file(path, path + ".old", fs::copy_options::overwrite_existing, failure);
  fs::resize_file(path, 0, failure);
}

Result<std::string> prepare_data_directory(const std::string& folder) {
  if (folder.empty() || std::any_of(folder.begin(), folder.end(), is_control)) {
    return Error{ErrorCode::invalid_argument, "the data directory needs a plain path"};
  }
  std::error_code failure;
  const fs::path parent = fs::absolute(folder, failure).lexically_normal().parent_path();
  if (!failure && !parent.empty()) fs::create_directories(parent, failure);
  if (failure) {
    return Error{ErrorCode::unavailable, "cannot create " + folder + ": " + failure.message()};
  }
  const bool empty = !fs::exists(folder, failure) || fs::is_empty(folder, failure);
  if (!empty && !fs::exists(fs::path(folder) / "cluster.lock", failure)) {
    return Error{ErrorCode::invalid_argument,
                 folder + " is not empty and holds no cluster of Watertight"};
  }
  // A symbolic link is followed to the folder itself, which must belong to this user.
  const fs::path place = fs::weakly_canonical(folder, failure);
  if (failure) {
    return Error{ErrorCode::unavailable, "cannot find " + folder + ": " + failure.message()};
  }
  if (Status done = private_folder(place.string()); !done) return std::move(done).error();
  const fs::path real = fs::canonical(place, failure);
  if (failure) return Error{ErrorCode::unavailable, "cannot find " + folder};
  return real.string();
}

Result<std::string> prepare_socket_folder(const std::string& data) {
  std::string folder = data + "/socket";
  // A comma separates hosts in a connection string and cannot be quoted there.
  if (folder.size() + kSocketNameBytes >= sizeof(sockaddr_un::sun_path) ||
      folder.find(',') != std::string::npos) {
    std::array<char, 64> name{};
    std::snprintf(name.data(), name.size(), "/tmp/watertight-%u-%016llx",
                  static_cast<unsigned>(geteuid()),
                  static_cast<unsigned long long>(content_hash(as_bytes(data))));
    folder = name.data();
  }
  if (Status done = private_folder(folder); !done) return std::move(done).error();
  return folder;
}

Status write_file(const std::string& path, const std::string& content) {
  const std::string fresh = path + ".new";
  const int file = open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file < 0) return system_error("write " + fresh);
  const bool written =
      write(file, content.data(), content.size()) == static_cast<ssize_t>(content.size()) &&
      fsync(file) == 0;
  close(file);
  if (!written || rename(fresh.c_str(), path.c_str()) != 0) return system_error("write " + path);
  return Done{};
}

Status sync_folder(const std::string& path) {
  const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return system_error("open " + path);
  const bool synced = fsync(folder) == 0;
  close(folder);
  if (!synced) return system_error("write " + path + " to the disk");
  return Done{};
}

}  // namespace watertight::store
