// SPDX-License-Identifier: GPL-3.0-or-later
//
// One PostgreSQL session and a bounded pool of sessions, over libpq with binary parameters and
// results. For postgres_store and private_cluster only. Nothing is tried again here, and only
// connection.cpp includes libpq.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "base/bytes.h"
#include "base/result.h"

struct pg_conn;
struct pg_result;

namespace watertight::store {

/// The parameters $1, $2, ... of one statement, in binary form. Arrays are for `unnest`.
class Parameters {
 public:
  Parameters& text(std::string_view value);
  Parameters& bytea(ByteView value);
  Parameters& int8(std::int64_t value);
  Parameters& float8(std::optional<double> value);
  Parameters& text_array(std::span<const std::string_view> values);
  Parameters& bytea_array(std::span<const ByteView> values);
  Parameters& int8_array(std::span<const std::int64_t> values);
  Parameters& float8_array(std::span<const std::optional<double>> values);

 private:
  friend class DatabaseSession;
  void add(std::uint32_t type, std::optional<std::string> value);
  void begin_array(std::uint32_t array_type, std::uint32_t element_type, std::size_t count);
  void element(std::string_view value);
  void null_element();

  std::vector<std::uint32_t> types_;
  std::vector<std::optional<std::string>> values_;
};

/// The rows of a result. Views stay valid as long as the Rows object. Indices start at 0.
class Rows {
 public:
  explicit Rows(pg_result* result) : result_(result) {}
  const pg_result* get() const { return result_.get(); }
  int size() const;
  bool is_null(int row, int column) const;
  /// The bytes of a text or bytea column; "" for NULL.
  std::string_view text(int row, int column) const;
  /// The number in an int8 column; 0 for NULL or a column of another width.
  std::int64_t int8(int row, int column) const;
  double float8(int row, int column) const;

 private:
  struct Clear {
    void operator()(pg_result* result) const;
  };
  std::unique_ptr<pg_result, Clear> result_;
};

/// A session with UTF-8 encoding and synchronous commit. It keeps prepared statements and settings,
/// so a connection pool between it and the server must give it one server session for its life
/// (pgbouncer: session mode). Not thread-safe.
class DatabaseSession {
 public:
  using Clock = std::chrono::steady_clock;

  /// The latest moment for an answer, and a flag that ends the wait for it earlier. The flag must
  /// outlive the session.
  struct Limit {
    Clock::time_point deadline = Clock::time_point::max();
    const std::atomic<bool>* is_interrupted = nullptr;
  };

  /// The reason why a session could not be opened. Errors: invalid_argument when the connection
  /// string cannot be parsed; limit_exceeded without memory; unavailable with the server's message
  /// as detail. `may_come_back` says whether waiting can help.
  struct OpenFailure {
    Error error;
    bool may_come_back = false;
  };
  explicit DatabaseSession(pg_conn* connection) : connection_(connection) {}  // used by open() only
  /// Takes 10 s at most, and no longer than `limit` says. (The lookup of a host's name is not
  /// interrupted.)
  static std::variant<std::unique_ptr<DatabaseSession>, OpenFailure> open(
      const std::string& connection, const Limit& limit);
  static std::variant<std::unique_ptr<DatabaseSession>, OpenFailure> open(
      const std::string& connection) {
    return open(connection, Limit{});
  }
  ~DatabaseSession();
  DatabaseSession(const DatabaseSession&) = delete;
  DatabaseSession& operator=(const DatabaseSession&) = delete;

  /// Statements that are not done within the limit fail, and the session is lost then.
  void limit(const Limit& limit) { limit_ = limit; }

  /// Sends a statement and does not wait for its result: results() has it, at the index that this
  /// returns. The session prepares the statement at its first use, so the text must not contain
  /// values. After a statement that fails the server ignores the others up to results(). Without
  /// BEGIN, all statements up to results() are one transaction.
  std::size_t send(const std::string& statement, const Parameters& parameters = {});
  /// Waits for the results of all statements that were sent since the last call. Errors: that of
  /// the first statement that failed: unavailable with the server's message as detail, or with a
  /// code that follows from its SQLSTATE and the server's message; limit_exceeded for parameters of
  /// more than 1 GiB. state(), constraint() and is_lost() say more.
  Result<std::vector<Rows>> results();
  /// send() and results(); returns the last result.
  Result<Rows> ask(const std::string& statement, const Parameters& parameters = {});
  /// The same for a statement that is not worth to be prepared.
  Result<Rows> run(const std::string& statement, const Parameters& parameters = {});
  /// Ends a transaction that failed. Does nothing when no transaction is open.
  void roll_back();

  /// The failure of a transaction that got into the way of another, although the server saw no
  /// error; state() is then that of a failed serialization, so that the transaction is tried again.
  Error collide(const char* message);

  /// SQLSTATE of the statement that failed last; "" when the server did not answer, or when later
  /// statements succeeded.
  const std::string& state() const { return state_; }
  /// The name of the constraint that the last failed statement broke, or "".
  const std::string& constraint() const { return constraint_; }
  /// Whether the session is gone, so that this object is of no more use.
  bool is_lost() const;
  /// True if nothing is under way: no transaction is open, and all results were read.
  bool is_idle() const;

 private:
  struct Finish {
    void operator()(pg_conn* connection) const;
  };
  struct Arguments;
  /// The statements that the server was sent and has still to answer.
  struct Sent {
    std::string prepares;  // the statement that this prepares; "" = it runs one
  };
  Error failure(const pg_result* result);
  Error late();
  bool wait_for(short events) const;
  std::optional<Error> connect(const std::string& connection);
  std::optional<Error> set_up();
  const std::string* name_of(const std::string& statement, const Arguments& arguments);
  std::size_t sent(bool is_sent, const Arguments& arguments);
  bool flush();
  pg_result* next_result();
  Result<std::vector<Rows>> receive();
  void settle(const Sent& sent, Rows rows, std::vector<Rows>& all, std::optional<Error>& failed);

  std::unique_ptr<pg_conn, Finish> connection_;
  std::unordered_map<std::string, std::string> prepared_;  // the names of statements, by their text
  std::size_t names_ = 0;
  std::vector<Sent> sent_;
  std::size_t expected_ = 0;      // the number of statements in sent_ that are run
  std::optional<Error> refused_;  // why a statement could not be sent
  std::string state_;
  std::string constraint_;
  Limit limit_;
};

/// Whether a server takes connections now; no password is needed to ask.
enum class ServerState { accepting, starting, silent };
ServerState server_state(const std::string& connection);

/// `keyword='value'` for a connection string, quoted.
std::string connection_option(std::string_view keyword, std::string_view value);

/// A pool of at most `size` sessions, which the holders of leases open. Thread-safe.
class ConnectionPool {
 public:
  ConnectionPool(std::string connection, std::size_t size)
      : connection_(std::move(connection)), free_slots_(size == 0 ? 1 : size) {}

  /// The right to use one session, until the lease is destroyed. If `session` is empty, the holder
  /// must open() one.
  class Lease {
   public:
    Lease(ConnectionPool* pool, std::unique_ptr<DatabaseSession> first)
        : session(std::move(first)), pool_(pool) {}
    Lease(Lease&& other) noexcept
        : session(std::move(other.session)), pool_(std::exchange(other.pool_, nullptr)) {}
    Lease& operator=(Lease&&) = delete;
    ~Lease();
    std::unique_ptr<DatabaseSession> session;

   private:
    ConnectionPool* pool_;
  };

  /// Errors: unavailable when every session stays busy for `seconds`.
  Result<Lease> lease(double seconds);
  /// Makes all leases, running and later ones, fail soon.
  void interrupt();
  const std::atomic<bool>& is_interrupted() const { return is_interrupted_; }
  const std::string& connection() const { return connection_; }

 private:
  void give_back(std::unique_ptr<DatabaseSession> session);

  const std::string connection_;
  std::mutex mutex_;
  std::condition_variable freed_;
  std::size_t free_slots_;
  std::atomic<bool> is_interrupted_ = false;
  std::vector<std::unique_ptr<DatabaseSession>> idle_;
};

}  // namespace watertight::store
