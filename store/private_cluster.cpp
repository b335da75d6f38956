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
constexpr seconds kUntold{2};  // waits that are shorter are not worth a sentence
constexpr milliseconds kPoll{30};
constexpr milliseconds kLongestStartPause{250};  // between two questions to a server that starts
constexpr milliseconds kGlance{100};  // between two looks whether the server's process lives
constexpr int kGlancesPerLook = 10;   // of which one asks the server whether it answers
constexpr int kLogLines = 8;

Error refused(std::string message) { return {ErrorCode::unavailable, std::move(message)}; }

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
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

/// The caller's side of a wait: tells what is waited for, and ends the wait.
class Waiting {
 public:
  Waiting(CancelPoll is_cancelled, std::function<void(const std::string&)> tell)
      : is_cancelled_(std::move(is_cancelled)), tell_(std::move(tell)) {}

  bool is_cancelled() const { return is_cancelled_ && is_cancelled_(); }

  /// A poll for a wait that has this purpose.
  CancelPoll waiting_for(std::string purpose) {
    return [this, purpose = std::move(purpose)] {
      mention(purpose);
      return is_cancelled();
    };
  }

  /// Tells the purpose of a wait, once, if the waits have taken more than a moment.
  void mention(const std::string& purpose) {
    if (!tell_ || purpose == told_ || Clock::now() - start_ < kUntold) return;
    told_ = purpose;
    tell_("waiting: " + purpose);
  }

 private:
  const CancelPoll is_cancelled_;
  const std::function<void(const std::string&)> tell_;
  const Clock::time_point start_ = Clock::now();
  std::string told_;
};

/// The state of a server, as one look sees it.
enum class Condition : std::uint8_t { absent, starting, accepting, stopping, silent };

std::string to_string(Condition condition) {
  switch (condition) {
    case Condition::absent:
      return "the private database is not running";
    case Condition::starting:
      return "the private database starts or recovers";
    case Condition::accepting:
      return "the private database answers";
    case Condition::stopping:
      return "the private database shuts down";
    case Condition::silent:
      return "the private database does not answer";
  }
  return {};
}

/// The cluster on the disk and its processes. Callers start and stop it under the exclusive lock,
/// and know whether others use it.
class Cluster {
 public:
  Cluster(std::string data, std::string programs, std::string user, const ClusterOptions& options)
      : data_(std::move(data)),
        programs_(std::move(programs)),
        user_(std::move(user)),
        continue_after_(options.continue_after),
        kill_after_(options.kill_after) {}

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

  /// The state of the server. Takes up to 2 s when it does not answer. A server that shuts down is
  /// not asked: it would log each question.
  Condition look() {
    const std::optional<pid_t> pid = postmaster();
    const Condition seen =
        pid ? condition_of(*pid) : (child_ != 0 ? Condition::starting : Condition::absent);
    if (seen != Condition::silent) silent_since_.reset();
    if (seen == Condition::silent && !silent_since_) silent_since_ = Clock::now();
    return seen;
  }

  /// Whether the server, in this state, needs ensure_running(): others start or recover by
  /// themselves.
  bool needs_help(Condition seen) const {
    return seen == Condition::absent || seen == Condition::stopping ||
           (seen == Condition::silent && silence() > continue_after_);
  }

  /// Creates the cluster unless it exists. Errors: unavailable, cancelled.
  Status ensure_created(Waiting& waiting) {
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
    Status made = wait_for(*child, kInitdbPatience, "initdb",
                           waiting.waiting_for("PostgreSQL makes a new cluster in " + data_));
    if (!made) {
      fs::remove_all(fresh, failure);
      if (made.error().code == ErrorCode::cancelled) return made;
      return refused(made.error().message + ":\n" + last_lines(log(), kLogLines));
    }
    std::ofstream(fresh + "/postgresql.conf", std::ios::app) << "\ninclude 'watertight.conf'\n";
    if (Status written = write_file(fresh + "/watertight.conf", ""); !written) return written;
    if (Status synced = sync_folder(fresh); !synced) return synced;
    fs::rename(fresh, pgdata(), failure);
    if (failure) return refused("cannot create " + pgdata() + ": " + failure.message());
    return sync_folder(data_);
  }

  /// Brings the server from any state to accepting connections: recovers the cluster, ends a server
  /// that shuts down (a smart shutdown waits for its clients for ever), continues or kills one that
  /// does not answer, starts one. Errors: unavailable, cancelled.
  Status ensure_running(Waiting& waiting) {
    const Clock::time_point deadline = Clock::now() + kRecoveryPatience;
    milliseconds pause = kPoll;
    bool has_started = false;
    Condition seen = look();
    for (; Clock::now() < deadline; seen = look()) {
      if (seen == Condition::accepting) return Done{};
      if (seen != Condition::absent) waiting.mention(to_string(seen) + " (" + data_ + ")");
      if (waiting.is_cancelled()) {
        return Error{ErrorCode::cancelled, "stopped while " + to_string(seen)};
      }
      if (seen == Condition::absent && has_started) {
        return refused("PostgreSQL " + end_ + ":\n" + last_lines(log(), kLogLines));
      }
      if (seen == Condition::absent) {
        if (Status cleared = clear_remains(waiting); !cleared) return cleared;
        if (Status started = start_postmaster(); !started) return started;
        has_started = true;
      } else if (seen == Condition::stopping) {
        stop_postmaster();
        has_started = false;
      } else if (seen == Condition::silent) {
        tend_silent();
      }
      std::this_thread::sleep_for(pause);
      pause = std::min(pause * 2, kLongestStartPause);
    }
    return refused(to_string(seen) + ":\n" + last_lines(log(), kLogLines));
  }

  /// Stops the postmaster with a fast shutdown or, when that takes too long, an immediate one or
  /// the death of all processes, after which the next start recovers.
  void stop() {
    stop_postmaster();
    if (!socket_folder_.starts_with(data_)) rmdir(socket_folder_.c_str());
  }

 private:
  Condition condition_of(pid_t pid) {
    const std::optional<PostmasterFile> file = read_postmaster_file(pgdata());
    if (!file || file->pid != pid) return Condition::starting;
    if (file->state == "stopping") return Condition::stopping;
    if (file->socket_folder.empty()) return Condition::silent;
    socket_folder_ = file->socket_folder;
    switch (server_state(connection("postgres") + " connect_timeout=2")) {
      case ServerState::accepting:
        return Condition::accepting;
      case ServerState::starting:
        return Condition::starting;
      case ServerState::silent:
        return Condition::silent;
    }
    return Condition::silent;
  }

  Clock::duration silence() const {
    return silent_since_ ? Clock::now() - *silent_since_ : Clock::duration::zero();
  }

  void tend_silent() {
    if (silence() > continue_after_) continue_stopped_processes(pgdata());
    if (silence() > kill_after_) kill_all();
  }

  void kill_all() {
    for (const pid_t pid : postgres_processes_in(pgdata())) kill(pid, SIGKILL);
  }

  void stop_postmaster() {
    for (const int signal : {SIGINT, SIGQUIT, SIGKILL}) {
      const std::optional<pid_t> pid = postmaster();
      if (!pid) return;
      if (signal == SIGKILL) kill_all();
      kill(*pid, signal);
      kill(*pid, SIGCONT);  // a stopped process does not see the signal
      // postmaster.pid disappears a moment before the process ends.
      const Clock::time_point deadline = Clock::now() + kStopPatience;
      for (; is_postgres_in(*pid, pgdata()) && Clock::now() < deadline; reap()) {
        std::this_thread::sleep_for(kPoll);
      }
    }
  }

  /// Reaps the postmaster if this process started it and it has ended.
  void reap() {
    if (child_ == 0) return;
    if (const std::optional<std::string> end = ended(child_)) {
      end_ = *end;
      child_ = 0;
    }
  }

  /// After a crash: waits for backends that outlived their postmaster (a new postmaster beside them
  /// would destroy data), then removes lock files that name a process that is not a postmaster.
  Status clear_remains(Waiting& waiting) {
    const Clock::time_point deadline = Clock::now() + kOrphanPatience;
    std::vector<pid_t> orphans = postgres_processes_in(pgdata());
    for (; !orphans.empty(); orphans = postgres_processes_in(pgdata())) {
      reap();
      continue_stopped_processes(pgdata());  // or they never notice the end of the postmaster
      waiting.mention("processes of a killed PostgreSQL are still at work in " + data_);
      if (waiting.is_cancelled()) return Error{ErrorCode::cancelled, "stopped before the start"};
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
    // The settings let only processes of this user on this machine connect. To synchronize the file
    // system at once, before a recovery, takes a tenth of the time that its files take one by one.
    if (Status written = write_file(
            pgdata() + "/watertight.conf",
            "# Written at each start.\n"
            "listen_addresses = ''\nunix_socket_permissions = 0700\nport = 5432\n"
            "unix_socket_directories = " +
                quoted_setting(quoted_name(*socket)) +
                "\nmax_connections = 64\nfsync = on\nfull_page_writes = on\n"
                "synchronous_commit = on\nlogging_collector = off\nlog_destination = 'stderr'\n"
                "recovery_init_sync_method = syncfs\nlog_checkpoints = "
                "off\nlog_min_error_statement = panic\n"
                "log_line_prefix = '%m [%p] '\n");
        !written) {
      return written;
    }
    bound_log(log());
    const Result<pid_t> child = spawn({programs_ + "/postgres", "-D", pgdata()}, {data_, log()});
    if (!child) return child.error();
    child_ = *child;
    return Done{};
  }

  const std::string data_;
  const std::string programs_;
  const std::string user_;
  std::string socket_folder_;
  const Clock::duration continue_after_;
  const Clock::duration kill_after_;
  std::optional<Clock::time_point> silent_since_;
  pid_t child_ = 0;  // the postmaster if this process started and has not reaped it, else 0
  std::string end_ = "ended while it started";  // how the last child ended
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
  RunningCluster(Cluster cluster, std::string data, FileLock users, ClusterOptions options)
      : cluster_(std::move(cluster)),
        data_(std::move(data)),
        users_(std::move(users)),
        options_(std::move(options)),
        connection_(cluster_.connection("watertight")) {
    if (options_.supervise) {
      supervisor_ = std::jthread([this](const std::stop_token& stop) { supervise(stop); });
    }
  }

  ~RunningCluster() override {
    if (supervisor_.joinable()) {
      supervisor_.request_stop();
      supervisor_.join();
    }
    // Who holds the lock for longer than a stop takes is a user of the cluster too.
    const Result<FileLock> lock =
        FileLock::take(lock_path(), FileLock::Kind::exclusive, kStopPatience);
    if (lock && users_.try_exclusive()) cluster_.stop();
  }

  const std::string& connection() const override { return connection_; }

  Status health() const override {
    const Condition seen = condition_;
    if (seen != Condition::accepting) return refused(to_string(seen));
    if (is_disk_full_) return refused("the disk of the private database is almost full");
    return Done{};
  }

 private:
  std::string lock_path() const { return data_ + "/cluster.lock"; }

  /// Looks after the server. Only this thread and, after its end, the destructor use cluster_.
  void supervise(const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock held(mutex);
    for (int glances = 0; !stop.stop_requested(); ++glances) {
      if (glances % kGlancesPerLook == 0 || !cluster_.postmaster()) tend(stop);
      wake.wait_for(held, stop, kGlance, [] { return false; });
    }
  }

  void tend(const std::stop_token& stop) {
    std::error_code failure;
    const std::filesystem::space_info room = fs::space(data_, failure);
    is_disk_full_ = !failure && room.available < options_.least_free_bytes;
    condition_ = cluster_.look();
    if (cluster_.needs_help(condition_)) {
      help(stop);
    } else if (is_large_log(cluster_.log())) {
      const Result<FileLock> lock = take_lock(stop);
      if (lock) bound_log(cluster_.log());
    }
  }

  /// Brings the server back. A failure is tried again at the next look.
  void help(const std::stop_token& stop) {
    const Result<FileLock> lock = take_lock(stop);
    if (!lock) return;
    tell(to_string(condition_) + "; bringing it back");
    Waiting waiting([&stop] { return stop.stop_requested(); }, {});
    const Status running = cluster_.ensure_running(waiting);
    condition_ = cluster_.look();
    if (running) {
      tell("the private database is back");
    } else if (!stop.stop_requested()) {
      const std::string& message = running.error().message;
      tell(message.substr(0, message.find('\n')) + "; see " + cluster_.log());
    }
  }

  /// Tells a sentence, unless it was the last one too.
  void tell(const std::string& sentence) {
    if (options_.tell && sentence != told_) options_.tell(sentence);
    told_ = sentence;
  }

  Result<FileLock> take_lock(const std::stop_token& stop) const {
    return FileLock::take(lock_path(), FileLock::Kind::exclusive, seconds(1),
                          [&stop] { return stop.stop_requested(); });
  }

  Cluster cluster_;
  const std::string data_;
  FileLock users_;
  const ClusterOptions options_;
  const std::string connection_;
  std::atomic<Condition> condition_ = Condition::accepting;
  std::atomic<bool> is_disk_full_ = false;
  std::string told_;
  std::jthread supervisor_;
};

}  // namespace

Result<std::unique_ptr<PrivateCluster>> PrivateCluster::start(const ClusterOptions& options) {
  if (geteuid() == 0) {
    return Error{ErrorCode::invalid_argument, "PostgreSQL does not run as root"};
  }
  const Result<std::string> data = prepare_data_directory(options.data_directory);
  if (!data) return data.error();
  Waiting waiting(options.is_cancelled, options.tell);
  const Result<FileLock> lock = FileLock::take(
      *data + "/cluster.lock", FileLock::Kind::exclusive, kLockPatience,
      waiting.waiting_for("another process starts or stops the private database (" + *data + ")"));
  if (!lock) return lock.error();
  Result<FileLock> users =
      FileLock::take(*data + "/cluster.users", FileLock::Kind::shared, kLockPatience,
                     waiting.waiting_for("another process stops " + *data));
  if (!users) return users.error();

  const std::string version = first_line(*data + "/postgres/PG_VERSION");
  Result<std::string> programs = find_programs(options.postgres_bin, version);
  if (!programs) return programs.error();
  Result<std::string> user = user_name();
  if (!user) return user.error();
  Cluster cluster(*data, std::move(*programs), std::move(*user), options);
  Status ready = cluster.ensure_created(waiting);
  if (ready) ready = cluster.ensure_running(waiting);
  if (ready) ready = ensure_database(cluster);
  if (ready) ready = ensure_extension(cluster);
  if (!ready) {
    if (users->try_exclusive()) cluster.stop();
    return std::move(ready).error();
  }
  return std::unique_ptr<PrivateCluster>(
      std::make_unique<RunningCluster>(std::move(cluster), *data, std::move(*users), options));
}

}  // namespace watertight::store
