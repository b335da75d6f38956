// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

namespace watertight::store {
namespace {

/// The attributes and file actions of posix_spawn; freed with the object.
class SpawnSetup {
 public:
  explicit SpawnSetup(const SpawnOptions& options) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawnattr_init(&attributes_);
    posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions_, 1, options.log.c_str(),
                                     O_WRONLY | O_CREAT | O_APPEND, 0600);
    posix_spawn_file_actions_adddup2(&actions_, 1, 2);
    posix_spawn_file_actions_addclosefrom_np(&actions_, 3);
    posix_spawn_file_actions_addchdir_np(&actions_, options.folder.c_str());
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    // Signals to the terminal's process group do not reach a session of its own.
    posix_spawnattr_setflags(
        &attributes_,
        static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSID));
  }
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;

  int run(pid_t* child, char* const* arguments, char* const* environment) const {
    return posix_spawn(child, arguments[0], &actions_, &attributes_, arguments, environment);
  }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

/// The variables that PostgreSQL, and the extension's helper processes, can need.
constexpr std::array kKeptVariables{"PATH",
                                    "HOME",
                                    "TZ",
                                    "TMPDIR",
                                    "LD_LIBRARY_PATH",
                                    "WATERTIGHT_LIBEXEC",
                                    "ASAN_OPTIONS",
                                    "UBSAN_OPTIONS",
                                    "TSAN_OPTIONS"};

std::vector<std::string> short_environment() {
  std::vector<std::string> kept{"LC_ALL=C"};
  for (const char* name : kKeptVariables) {
    if (const char* value = std::getenv(name)) kept.push_back(std::string(name) + "=" + value);
  }
  return kept;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

}  // namespace

Result<pid_t> spawn(const std::vector<std::string>& arguments, const SpawnOptions& options) {
  std::vector<std::string> own_arguments = arguments;
  std::vector<std::string> environment = short_environment();
  pid_t child = 0;
  const int failure =
      SpawnSetup(options).run(&child, pointers(own_arguments).data(), pointers(environment).data());
  if (failure != 0) {
    return Error{ErrorCode::unavailable,
                 "cannot start " + arguments.front() + ": " + std::strerror(failure)};
  }
  return child;
}

std::optional<std::string> ended(pid_t child) {
  int status = 0;
  if (waitpid(child, &status, WNOHANG) != child) return std::nullopt;
  if (WIFSIGNALED(status)) return "was killed by signal " + std::to_string(WTERMSIG(status));
  return "exited with status " + std::to_string(WEXITSTATUS(status));
}

Status wait_for(pid_t child, std::chrono::seconds limit, const std::string& name,
                const CancelPoll& is_cancelled) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  Error failure{ErrorCode::unavailable, name + " did not end in time"};
  while (std::chrono::steady_clock::now() < deadline) {
    if (const std::optional<std::string> end = ended(child)) {
      if (*end == "exited with status 0") return Done{};
      return Error{ErrorCode::unavailable, name + " " + *end};
    }
    if (is_cancelled && is_cancelled()) {
      failure = {ErrorCode::cancelled, "stopped while " + name + " was at work"};
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  kill(-child, SIGKILL);
  waitpid(child, nullptr, 0);
  return failure;
}

std::string last_lines(const std::string& path, int lines) {
  constexpr std::streamoff kLargest = 4096;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return {};
  const std::streamoff size = file.tellg();
  file.seekg(std::max<std::streamoff>(0, size - kLargest));
  std::string text(static_cast<std::size_t>(std::min(size, kLargest)), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::size_t from = text.size();
  for (int line = 0; line < lines && from != std::string::npos && from > 0; ++line) {
    from = text.rfind('\n', from - 1);
  }
  return from == std::string::npos ? text : text.substr(from + (from < text.size() ? 1 : 0));
}

}  // namespace watertight::store
