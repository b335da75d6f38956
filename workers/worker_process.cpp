// SPDX-License-Identifier: GPL-3.0-or-later
#include "workers/worker_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "workers/frames.h"

namespace watertight::workers {
namespace {

// AddressSanitizer and ThreadSanitizer reserve terabytes of address space, which a limit would
// refuse.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCanLimitMemory = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kCanLimitMemory = false;
#else
constexpr bool kCanLimitMemory = true;
#endif
#else
constexpr bool kCanLimitMemory = true;
#endif

/// The CPU seconds beyond its first job that a process may use in all: a process that ignores its
/// soft limit ends then, whatever it does.
constexpr rlim_t kSpareCpuSeconds = 3600;

Error system_error(const std::string& what, int number) {
  return Error{ErrorCode::unavailable, what + ": " + std::string(std::strerror(number))};
}

double to_seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

/// The two parameter blocks of posix_spawn; freed with the object.
struct SpawnParameters {
  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
  SpawnParameters() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
  }
  ~SpawnParameters() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnParameters(const SpawnParameters&) = delete;
  SpawnParameters& operator=(const SpawnParameters&) = delete;
};

/// Sets the descriptors: 3 is the socket, 0 to 2 are /dev/null, all others are closed. The socket
/// moves first, because a daemon's socket may itself be one of 0 to 2.
int prepare_descriptors(posix_spawn_file_actions_t* actions, int socket, const char* directory) {
  int failed = posix_spawn_file_actions_adddup2(actions, socket, kWorkerSocket);
  for (int descriptor = 0; descriptor < kWorkerSocket && failed == 0; ++descriptor) {
    const int mode = descriptor == 0 ? O_RDONLY : O_WRONLY;
    failed = posix_spawn_file_actions_addopen(actions, descriptor, "/dev/null", mode, 0);
  }
  if (failed == 0) failed = posix_spawn_file_actions_addclosefrom_np(actions, kWorkerSocket + 1);
  if (failed == 0) failed = posix_spawn_file_actions_addchdir_np(actions, directory);
  return failed;
}

/// Sets a process group of its own, no blocked signals, and every signal at its default.
int prepare_attributes(posix_spawnattr_t* attributes) {
  sigset_t none;
  sigset_t all;
  sigemptyset(&none);
  sigfillset(&all);
  int failed = posix_spawnattr_setflags(
      attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  if (failed == 0) failed = posix_spawnattr_setpgroup(attributes, 0);
  if (failed == 0) failed = posix_spawnattr_setsigmask(attributes, &none);
  if (failed == 0) failed = posix_spawnattr_setsigdefault(attributes, &all);
  return failed;
}

/// The short environment of a worker. From the parent's it has only the path of libraries and the
/// options of sanitizers.
std::vector<std::string> environment_of_worker(double idle_seconds) {
  const double milliseconds = std::min(std::max(idle_seconds, 0.0) * 1000.0, 2e9);
  std::vector<std::string> environment = {
      "LANG=C", "PATH=/usr/bin:/bin",
      std::string(kIdleVariable) + "=" + std::to_string(static_cast<long>(milliseconds))};
  // A parent-death signal comes when the *thread* that started the child ends, so only the main
  // thread asks for one; in every other case the closed socket ends the process.
  if (gettid() == getpid()) {
    environment.push_back(std::string(kParentVariable) + "=" + std::to_string(getpid()));
  }
  for (const char* name : {"LD_LIBRARY_PATH", "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"}) {
    if (const char* value = std::getenv(name)) {
      environment.push_back(std::string(name) + "=" + value);
    }
  }
  return environment;
}

/// An empty directory that nobody else can enter.
Result<std::string> make_private_directory() {
  std::error_code failed;
  const std::filesystem::path base = std::filesystem::temp_directory_path(failed);
  std::string name = (failed ? std::string("/tmp") : base.string()) + "/watertight-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) return system_error("cannot make directory " + name, errno);
  return name;
}

Result<pid_t> spawn(const std::string& executable, int socket, double idle_seconds) {
  Result<std::string> directory = make_private_directory();
  if (!directory) return std::move(directory).error();
  SpawnParameters parameters;
  int failed = prepare_descriptors(&parameters.actions, socket, directory->c_str());
  if (failed == 0) failed = prepare_attributes(&parameters.attributes);
  std::vector<std::string> environment = environment_of_worker(idle_seconds);
  std::vector<char*> pointers;
  for (std::string& variable : environment) pointers.push_back(variable.data());
  pointers.push_back(nullptr);
  std::string path = executable;
  std::array<char*, 2> arguments{path.data(), nullptr};
  pid_t process = -1;
  if (failed == 0) {
    failed = posix_spawn(&process, executable.c_str(), &parameters.actions, &parameters.attributes,
                         arguments.data(), pointers.data());
  }
  // posix_spawn returns after the exec, so the process works in the directory already. Nothing can
  // be created in a removed directory, so it stays empty and nobody has to clean up later.
  rmdir(directory->c_str());
  if (failed != 0) return system_error("cannot start " + executable, failed);
  return process;
}

}  // namespace

std::string to_string(const Ending& ending) {
  if (!ending.known) return "ended, status unknown";
  if (!ending.by_signal) return "exited with status " + std::to_string(ending.code);
  return "killed by signal " + std::to_string(ending.code);
}

Result<WorkerProcess> WorkerProcess::start(const std::string& executable, double idle_seconds) {
  std::array<int, 2> sockets{-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) {
    return system_error("cannot make a socket pair", errno);
  }
  const int flags = fcntl(sockets[0], F_GETFL);
  fcntl(sockets[0], F_SETFL, flags | O_NONBLOCK);
  Result<pid_t> process = spawn(executable, sockets[1], idle_seconds);
  close(sockets[1]);
  if (!process) {
    close(sockets[0]);
    return std::move(process).error();
  }
  WorkerProcess worker(*process, sockets[0]);
  // The process never writes a core file. The limits of a job follow with the job.
  const rlimit none{0, 0};
  if (prlimit(*process, RLIMIT_CORE, &none, nullptr) != 0 && errno != ESRCH) {
    return system_error("cannot limit a helper process", errno);
  }
  return worker;
}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      socket_(std::exchange(other.socket_, -1)),
      jobs_done_(other.jobs_done_),
      accounted_(other.accounted_),
      has_hard_limits_(other.has_hard_limits_) {}

WorkerProcess& WorkerProcess::operator=(WorkerProcess&& other) noexcept {
  if (this != &other) {
    end();
    process_ = std::exchange(other.process_, -1);
    socket_ = std::exchange(other.socket_, -1);
    jobs_done_ = other.jobs_done_;
    accounted_ = other.accounted_;
    has_hard_limits_ = other.has_hard_limits_;
  }
  return *this;
}

WorkerProcess::~WorkerProcess() { end(); }

std::optional<double> WorkerProcess::cpu_seconds() const {
  clockid_t clock{};
  timespec used{};
  if (clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &used) != 0) {
    return std::nullopt;
  }
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

Status WorkerProcess::limit(double cpu_seconds, std::uint64_t memory_bytes) {
  // The pool watches the CPU time and is exact; this limit ends the process if the pool cannot.
  const double seconds =
      std::ceil(this->cpu_seconds().value_or(0) + std::max(cpu_seconds, 0.0)) + 1;
  const auto allowed = static_cast<rlim_t>(std::min(seconds, 1e9));
  Status limited = set_limit(RLIMIT_CPU, allowed, allowed + kSpareCpuSeconds);
  if (kCanLimitMemory && limited) limited = set_limit(RLIMIT_AS, memory_bytes, memory_bytes);
  has_hard_limits_ = true;
  return limited;
}

Status WorkerProcess::set_limit(int resource, std::uint64_t soft, std::uint64_t hard) const {
  const auto which = static_cast<__rlimit_resource>(resource);
  rlimit current{};
  if (prlimit(process_, which, nullptr, &current) != 0) {
    return system_error("cannot read a helper's limits", errno);
  }
  // A hard limit can be lowered only. The first job sets it; a job that needs more gets another
  // process.
  if (!has_hard_limits_) current.rlim_max = std::min(current.rlim_max, static_cast<rlim_t>(hard));
  if (soft > current.rlim_max && has_hard_limits_) {
    return Error{ErrorCode::unavailable, "the job needs more than the helper may use"};
  }
  current.rlim_cur = std::min(static_cast<rlim_t>(soft), current.rlim_max);
  if (prlimit(process_, which, &current, nullptr) != 0) {
    return system_error("cannot limit a helper process", errno);
  }
  return Done{};
}

bool WorkerProcess::has_ended() const {
  siginfo_t info{};
  const int found = waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
  // No such child: the parent ignores SIGCHLD or reaped it, so it has ended.
  return found != 0 ? errno == ECHILD : info.si_pid == process_;
}

bool WorkerProcess::is_waiting() const {
  if (has_ended()) return false;
  std::uint8_t byte = 0;
  const ssize_t got = recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
}

Ending WorkerProcess::end() {
  Ending ending;
  if (process_ > 0) {
    // Until the process is reaped, its number, which is also that of its group, belongs to it
    // alone.
    kill(-process_, SIGKILL);
    int status = 0;
    rusage used{};
    pid_t reaped = -1;
    do {
      reaped = wait4(process_, &status, 0, &used);
    } while (reaped < 0 && errno == EINTR);
    if (reaped == process_) {
      ending.known = true;
      ending.by_signal = WIFSIGNALED(status);
      ending.code = ending.by_signal ? WTERMSIG(status) : WEXITSTATUS(status);
      ending.cpu_seconds = to_seconds(used.ru_utime) + to_seconds(used.ru_stime);
    }
    process_ = -1;
  }
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
  return ending;
}

}  // namespace watertight::workers
