// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/private_cluster.h"

#include <pwd.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "store/child_process.h"
#include "store/cluster_files.h"
#include "store/connection.h"

namespace watertight::store {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kLockPatience{180};    // another process may create or recover the cluster
constexpr seconds kInitdbPatience{180};  // initdb takes 3 s on an idle machine
constexpr seconds kRecoveryPatience{600};
constexpr seconds kOrphanPatience{30};
constexpr seconds kStopPatience{30};
constexpr milliseconds kPoll{30};
constexpr milliseconds kSupervision{500};
constexpr std::uintmax_t kLargestLog = 16ULL << 20;
constexpr int kLogLines = 8;

Error refused(std::string message) { return {ErrorCode::unavailable, std::move(message)}; }

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

bool holds_programs(const std::string& folder) {
  return access((folder + "/initdb").c_str(), X_OK) == 0 &&
         access((folder + "/postgres").c_str(), X_OK) == 0;
}

/// The folder of PostgreSQL's programs. `version` is the major version of an existing cluster, or
/// "".
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
  return refused("PostgreSQL's programs initdb and postgres are not in " + tried +
                 " (Debian: apt install postgresql)");
}

Result<std::string> user_name() {
  std::array<char, 4096> buffer{};
  passwd entry{};
  passwd* found = nullptr;
  getpwuid_r(geteuid(), &entry, buffer.data(), buffer.size(), &found);
  if (found == nullptr) {
    return refused("the user with number " + std::to_string(geteuid()) +
                   " has no name, and PostgreSQL needs one");
  }
  return std::string(found->pw_name);
}

/// A value, as postgresql.conf quotes it.
std::string quoted_setting(const std::string& value) {
  std::string quoted = "'";
  for (const char c : value) {
    if (c == '\'' || c == '\\') quoted += c;
    quoted += c;
  }
  return quoted + "'";
}

/// A name, as a list of folders in postgresql.conf quotes it.
std::string quoted_name(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) {
    if (c == '"') quoted += c;
    quoted += c;
  }
  return quoted + "\"";
}

/// The cluster on the disk and its processes. Callers start and stop it under the exclusive lock,
/// and know whether others use it.
class Cluster {
 public:
  Cluster(std::string data, std::string programs, std::string user)
      : data_(std::move(data)), programs_(std::move(programs)), user_(std::move(user)) {}

  std::string log() const { return data_ + "/server.log"; }
  std::string pgdata() const { return data_ + "/postgres"; }

  std::string connection(const std::string& database) const {
    return connection_option("host", socket_folder_) + " port=5432 " +
           connection_option("user", user_) + " " + connection_option("dbname", database);
  }

  /// The process number of the postmaster if it runs.
  std::optional<pid_t> postmaster() {
    reap();
    const std::optional<PostmasterFile> file = read_postmaster_file(pgdata());
    if (!file || !is_postgres_in(file->pid, pgdata())) return std::nullopt;
    return file->pid;
  }

  /// Creates or recovers the cluster where needed, starts it unless it runs, and waits until it
  /// accepts connections.
  Status ensure_running() {
    if (Status created = ensure_created(); !created) return created;
    if (!postmaster()) {
      if (Status cleared = clear_remains(); !cleared) return cleared;
      if (Status started = start_postmaster(); !started) return started;
    }
    return wait_until_accepting();
  }

  /// Stops the postmaster with a fast shutdown or, when that takes too long, an immediate one,
  /// after which the next start recovers.
  void stop() {
    stop_postmaster();
    if (!socket_folder_.starts_with(data_)) rmdir(socket_folder_.c_str());
  }

 private:
  void stop_postmaster() {
    for (const int signal : {SIGINT, SIGQUIT}) {
      const std::optional<pid_t> pid = postmaster();
      if (!pid) return;
      kill(*pid, signal);
      // postmaster.pid disappears a moment before the process ends.
      const Clock::time_point deadline = Clock::now() + kStopPatience;
      for (; is_postgres_in(*pid, pgdata()) && Clock::now() < deadline; reap()) {
        std::this_thread::sleep_for(kPoll);
      }
    }
  }

  /// Reaps the postmaster if this process started it and it has ended.
  void reap() {
    if (child_ != 0 && ended(child_)) child_ = 0;
  }

  Status ensure_created() {
    std::error_code failure;
    if (fs::exists(pgdata() + "/PG_VERSION", failure)) return Done{};
    if (fs::exists(pgdata(), failure)) {
      return refused(pgdata() + " exists and is not a PostgreSQL cluster");
    }
    // The cluster is made in another folder and moved, so that PGDATA is always whole.
    const std::string fresh = data_ + "/postgres.new";
    fs::remove_all(fresh, failure);
    const Result<pid_t> child =
        spawn({programs_ + "/initdb", "-D", fresh, "-U", user_, "--auth=peer", "--encoding=UTF8",
               "--no-locale", "--data-checksums", "--no-instructions"},
              {data_, log()});
    if (!child) return child.error();
    if (Status made = wait_for(*child, kInitdbPatience, "initdb"); !made) {
      return refused(made.error().message + ":\n" + last_lines(log(), kLogLines));
    }
    std::ofstream(fresh + "/postgresql.conf", std::ios::app) << "\ninclude 'watertight.conf'\n";
    if (Status written = write_file(fresh + "/watertight.conf", ""); !written) return written;
    if (Status synced = sync_folder(fresh); !synced) return synced;
    fs::rename(fresh, pgdata(), failure);
    if (failure) return refused("cannot create " + pgdata() + ": " + failure.message());
    return sync_folder(data_);
  }

  /// After a crash: waits for backends that outlived their postmaster (a new postmaster beside them
  /// would destroy data), then removes lock files that name a process that is not a postmaster.
  Status clear_remains() {
    const Clock::time_point deadline = Clock::now() + kOrphanPatience;
    std::vector<pid_t> orphans = postgres_processes_in(pgdata());
    for (; !orphans.empty(); orphans = postgres_processes_in(pgdata())) {
      reap();
      if (Clock::now() > deadline) {
        return refused("processes of a PostgreSQL server that was killed are still at work in " +
                       pgdata() + ", the first is " + std::to_string(orphans.front()));
      }
      std::this_thread::sleep_for(kPoll);
    }
    const std::optional<PostmasterFile> file = read_postmaster_file(pgdata());
    std::error_code ignored;
    if (!file || kill(file->pid, 0) == 0 || errno == EPERM) {
      // PostgreSQL would take the process with the old number for a server.
      fs::remove(pgdata() + "/postmaster.pid", ignored);
      for (const std::string& folder : {data_ + "/socket", file ? file->socket_folder : ""}) {
        if (!folder.empty()) fs::remove(folder + "/.s.PGSQL.5432.lock", ignored);
      }
    }
    return Done{};
  }

  Status start_postmaster() {
    const Result<std::string> socket = prepare_socket_folder(data_);
    if (!socket) return socket.error();
    // The settings let only processes of this user on this machine connect.
    if (Status written = write_file(
            pgdata() + "/watertight.conf",
            "# Written at each start.\n"
            "listen_addresses = ''\nunix_socket_permissions = 0700\nport = 5432\n"
            "unix_socket_directories = " +
                quoted_setting(quoted_name(*socket)) +
                "\nmax_connections = 64\nfsync = on\nfull_page_writes = on\n"
                "synchronous_commit = on\nlogging_collector = off\nlog_destination = 'stderr'\n"
                "log_checkpoints = off\nlog_min_error_statement = panic\n"
                "log_line_prefix = '%m [%p] '\n");
        !written) {
      return written;
    }
    std::error_code failure;
    if (fs::file_size(log(), failure) > kLargestLog && !failure) {
      fs::rename(log(), log() + ".old", failure);
    }
    const Result<pid_t> child =
        spawn({programs_ + "/postgres", "-D", pgdata()}, {data_, log(), true});
    if (!child) return child.error();
    child_ = *child;
    return Done{};
  }

  Status wait_until_accepting() {
    const Clock::time_point deadline = Clock::now() + kRecoveryPatience;
    while (Clock::now() < deadline) {
      if (child_ != 0) {
        if (const std::optional<std::string> end = ended(child_)) {
          child_ = 0;
          return refused("PostgreSQL " + *end + ":\n" + last_lines(log(), kLogLines));
        }
      } else if (!postmaster()) {
        return refused("PostgreSQL ended while it started:\n" + last_lines(log(), kLogLines));
      }
      const std::optional<PostmasterFile> file = read_postmaster_file(pgdata());
      if (file && !file->socket_folder.empty()) {
        socket_folder_ = file->socket_folder;
        if (server_state(connection("postgres")) == ServerState::accepting) return Done{};
      }
      std::this_thread::sleep_for(kPoll);
    }
    return refused("PostgreSQL does not accept connections:\n" + last_lines(log(), kLogLines));
  }

  const std::string data_;
  const std::string programs_;
  const std::string user_;
  std::string socket_folder_;
  pid_t child_ = 0;  // the postmaster if this process started and has not reaped it, else 0
};

Result<std::unique_ptr<DatabaseSession>> connect(const std::string& connection) {
  auto opened = DatabaseSession::open(connection);
  if (auto* failed = std::get_if<DatabaseSession::OpenFailure>(&opened))
    return std::move(failed->error);
  return std::move(std::get<std::unique_ptr<DatabaseSession>>(opened));
}

Status ensure_database(const Cluster& cluster) {
  const Result<std::unique_ptr<DatabaseSession>> session = connect(cluster.connection("postgres"));
  if (!session) return session.error();
  const Result<Rows> found =
      (*session)->run("SELECT datname FROM pg_database WHERE datname = 'watertight'");
  if (!found) return found.error();
  if (found->size() == 1) return Done{};
  const Result<Rows> made =
      (*session)->run("CREATE DATABASE watertight TEMPLATE template0 ENCODING 'UTF8'");
  if (!made) return made.error();
  return Done{};
}

/// Creates or updates the extension where the server has it. Storing needs no extension, so a
/// failed statement is no error; CREATE EXTENSION by hand shows the reason.
Status ensure_extension(const Cluster& cluster) {
  const Result<std::unique_ptr<DatabaseSession>> session =
      connect(cluster.connection("watertight"));
  if (!session) return session.error();
  const Result<Rows> known = (*session)->run(
      "SELECT installed_version IS NULL FROM pg_available_extensions WHERE name = 'watertight'");
  if (!known) return known.error();
  if (known->size() == 0) return Done{};
  const Result<Rows> done = (*session)->run(known->text(0, 0) == std::string_view("\1", 1)
                                                ? "CREATE EXTENSION IF NOT EXISTS watertight"
                                                : "ALTER EXTENSION watertight UPDATE");
  static_cast<void>(done);
  return Done{};
}

class RunningCluster final : public PrivateCluster {
 public:
  RunningCluster(Cluster cluster, std::string lock_path, FileLock users)
      : cluster_(std::move(cluster)),
        lock_path_(std::move(lock_path)),
        users_(std::move(users)),
        connection_(cluster_.connection("watertight")) {}

  ~RunningCluster() override {
    if (supervisor_.joinable()) {
      supervisor_.request_stop();
      supervisor_.join();
    }
    const Result<FileLock> lock =
        FileLock::take(lock_path_, FileLock::Kind::exclusive, kLockPatience);
    if (lock && users_.try_exclusive()) cluster_.stop();
  }

  const std::string& connection() const override { return connection_; }

  void supervise() {
    supervisor_ = std::jthread([this](const std::stop_token& stop) {
      std::mutex mutex;
      std::condition_variable_any wake;
      std::unique_lock held(mutex);
      while (!wake.wait_for(held, stop, kSupervision, [&] { return stop.stop_requested(); })) {
        if (!stop.stop_requested() && !cluster_.postmaster()) revive();
      }
    });
  }

 private:
  /// Starts the server again. Only the supervisor and, after its end, the destructor use cluster_.
  void revive() {
    const Result<FileLock> lock = FileLock::take(lock_path_, FileLock::Kind::exclusive, seconds(1));
    if (!lock) return;
    const Status running = cluster_.ensure_running();
    static_cast<void>(running);  // a failure is tried again at the next look; until then the store
                                 // reports it
  }

  Cluster cluster_;
  const std::string lock_path_;
  FileLock users_;
  const std::string connection_;
  std::jthread supervisor_;
};

}  // namespace

Result<std::unique_ptr<PrivateCluster>> PrivateCluster::start(const ClusterOptions& options) {
  if (geteuid() == 0) {
    return Error{ErrorCode::invalid_argument, "PostgreSQL does not run as root"};
  }
  const Result<std::string> data = prepare_data_directory(options.data_directory);
  if (!data) return data.error();
  const std::string lock_path = *data + "/cluster.lock";
  const Result<FileLock> lock = FileLock::take(lock_path, FileLock::Kind::exclusive, kLockPatience);
  if (!lock) return lock.error();
  Result<FileLock> users =
      FileLock::take(*data + "/cluster.users", FileLock::Kind::shared, kLockPatience);
  if (!users) return users.error();

  const std::string version = first_line(*data + "/postgres/PG_VERSION");
  Result<std::string> programs = find_programs(options.postgres_bin, version);
  if (!programs) return programs.error();
  Result<std::string> user = user_name();
  if (!user) return user.error();
  Cluster cluster(*data, std::move(*programs), std::move(*user));
  Status ready = cluster.ensure_running();
  if (ready) ready = ensure_database(cluster);
  if (ready) ready = ensure_extension(cluster);
  if (!ready) {
    if (users->try_exclusive()) cluster.stop();
    return std::move(ready).error();
  }
  auto running = std::make_unique<RunningCluster>(std::move(cluster), lock_path, std::move(*users));
  if (options.supervise) running->supervise();
  return std::unique_ptr<PrivateCluster>(std::move(running));
}

}  // namespace watertight::store
