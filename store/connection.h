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

/// A session with UTF-8 encoding and synchronous commit. Not thread-safe.
class DatabaseSession {
 public:
  using Clock = std::chrono::steady_clock;

  /// The reason why a session could not be opened. Errors: invalid_argument when the connection
  /// string cannot be parsed; limit_exceeded without memory; unavailable with the server's message.
  /// `may_come_back` says whether waiting can help.
  struct OpenFailure {
    Error error;
    bool may_come_back = false;
  };
  explicit DatabaseSession(pg_conn* connection) : connection_(connection) {}  // used by open() only
  static std::variant<std::unique_ptr<DatabaseSession>, OpenFailure> open(
      const std::string& connection);
  ~DatabaseSession();
  DatabaseSession(const DatabaseSession&) = delete;
  DatabaseSession& operator=(const DatabaseSession&) = delete;

  /// Statements that are not done at `deadline`, or when `is_interrupted` has become true, fail and
  /// the session is lost then. `is_interrupted` must outlive the session.
  void limit(Clock::time_point deadline, const std::atomic<bool>* is_interrupted) {
    deadline_ = deadline;
    is_interrupted_ = is_interrupted;
  }
  /// Runs one statement. Errors: the server's message, with a code that follows from its SQLSTATE;
  /// limit_exceeded for parameters of more than 1 GiB. state() and is_lost() say more.
  Result<Rows> run(const std::string& statement, const Parameters& parameters = {});
  /// Ends a transaction that failed. Does nothing when no transaction is open.
  void roll_back();

  /// The failure of a transaction that got into the way of another, although the server saw no
  /// error; state() is then that of a failed serialization, so that the transaction is tried again.
  Error collide(const char* message);

  /// SQLSTATE of the last failed statement; "" when the server did not answer.
  const std::string& state() const { return state_; }
  /// Whether the session is gone, so that this object is of no more use.
  bool is_lost() const;

 private:
  struct Finish {
    void operator()(pg_conn* connection) const;
  };
  Error failure(const pg_result* result);
  bool wait_for(short events) const;
  Result<Rows> late();
  Result<Rows> receive();

  std::unique_ptr<pg_conn, Finish> connection_;
  std::string state_;
  Clock::time_point deadline_ = Clock::time_point::max();
  const std::atomic<bool>* is_interrupted_ = nullptr;
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
