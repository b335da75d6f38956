// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/connection.h"

#include <libpq-fe.h>

#include <poll.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <chrono>

namespace watertight::store {
namespace {

// The numbers of types in pg_type.dat, which are equal in every PostgreSQL.
constexpr std::uint32_t kBytea = 17, kInt8 = 20, kText = 25, kFloat8 = 701;
constexpr std::uint32_t kByteaArray = 1001, kTextArray = 1009, kInt8Array = 1016,
                        kFloat8Array = 1022;
constexpr std::chrono::seconds kOpening{10};  // the longest time to open a session
// The protocol gives lengths in bytes as signed 32-bit numbers and limits a message to 1 GiB.
constexpr std::size_t kLargestMessage = (1ULL << 30) - (1ULL << 16);
constexpr std::size_t kUnsent = 1 << 20;     // the bytes that may wait in memory for results()
constexpr std::size_t kArrayFlagOffset = 4;  // the offset of "has nulls" in a binary array

void append_big_endian(std::string& bytes, std::uint64_t value, int width) {
  for (int i = width - 1; i >= 0; --i) bytes.push_back(static_cast<char>(value >> (8 * i)));
}

std::string big_endian(std::uint64_t value, int width) {
  std::string bytes;
  append_big_endian(bytes, value, width);
  return bytes;
}

std::uint64_t from_big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char c : bytes) value = (value << 8) | static_cast<unsigned char>(c);
  return value;
}

/// The lines of a message as one line.
std::string one_line(const char* message) {
  std::string text;
  bool is_between = false;  // whether a line has ended
  for (const char c : std::string_view(message == nullptr ? "" : message)) {
    if (c == '\n' || c == '\r') {
      is_between = !text.empty();
    } else if (!is_between || (c != ' ' && c != '\t')) {
      if (is_between) text += "; ";
      is_between = false;
      text += c;
    }
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

ErrorCode code_of(std::string_view state, bool is_lost) {
  if (is_lost || state.empty()) return ErrorCode::unavailable;
  const std::string_view group = state.substr(0, 2);
  if (group == "22" || group == "21" || group == "23") return ErrorCode::invalid_argument;
  if (state == "57014") return ErrorCode::cancelled;
  if (group == "54") return ErrorCode::limit_exceeded;
  return ErrorCode::unavailable;
}

/// The message that a client gets about a failure for which it is not to blame.
const char* summary_of(std::string_view state, bool is_lost) {
  if (state == "53100") return "the database's disk is full";
  if (state.substr(0, 2) == "40" || state == "55P03")
    return "the database is busy with other writes";
  if (is_lost || state.empty() || state.substr(0, 3) == "57P")
    return "the database does not answer";
  return "the database cannot do this now";
}

// PQconnectStart and PQping take these. Keywords before `dbname` are defaults that the connection
// string may override; keywords after `dbname` hold whatever the connection string says.
struct ConnectOptions {
  explicit ConnectOptions(const std::string& connection)
      : values{"2", "30000", "30", "watertight", connection.c_str(), "UTF8", nullptr} {}
  std::array<const char*, 7> keywords{"connect_timeout",
                                      "tcp_user_timeout",
                                      "keepalives_idle",
                                      "fallback_application_name",
                                      "dbname",
                                      "client_encoding",
                                      nullptr};
  std::array<const char*, 7> values;
};

}  // namespace

void Parameters::add(std::uint32_t type, std::optional<std::string> value) {
  types_.push_back(type);
  values_.push_back(std::move(value));
}

void Parameters::begin_array(std::uint32_t array_type, std::uint32_t element_type,
                             std::size_t count) {
  std::string header;
  append_big_endian(header, count == 0 ? 0 : 1, 4);  // the number of dimensions
  append_big_endian(header, 0, 4);                   // whether there are nulls
  append_big_endian(header, element_type, 4);
  if (count != 0) {
    append_big_endian(header, count, 4);
    append_big_endian(header, 1, 4);  // the lowest index
  }
  add(array_type, std::move(header));
}

void Parameters::element(std::string_view value) {
  append_big_endian(*values_.back(), value.size(), 4);
  values_.back()->append(value);
}

void Parameters::null_element() {
  values_.back()->at(kArrayFlagOffset + 3) = 1;
  append_big_endian(*values_.back(), 0xFFFFFFFFU, 4);
}

Parameters& Parameters::text(std::string_view value) {
  add(kText, std::string(value));
  return *this;
}

Parameters& Parameters::bytea(ByteView value) {
  add(kBytea, std::string(as_text(value)));
  return *this;
}

Parameters& Parameters::int8(std::int64_t value) {
  add(kInt8, big_endian(static_cast<std::uint64_t>(value), 8));
  return *this;
}

Parameters& Parameters::float8(std::optional<double> value) {
  if (value) {
    add(kFloat8, big_endian(std::bit_cast<std::uint64_t>(*value), 8));
  } else {
    add(kFloat8, std::nullopt);
  }
  return *this;
}

Parameters& Parameters::text_array(std::span<const std::string_view> values) {
  begin_array(kTextArray, kText, values.size());
  for (const std::string_view value : values) element(value);
  return *this;
}

Parameters& Parameters::bytea_array(std::span<const ByteView> values) {
  begin_array(kByteaArray, kBytea, values.size());
  std::size_t total = values_.back()->size();
  for (const ByteView value : values) total += value.size() + 4;
  values_.back()->reserve(total);
  for (const ByteView value : values) element(as_text(value));
  return *this;
}

Parameters& Parameters::int8_array(std::span<const std::int64_t> values) {
  begin_array(kInt8Array, kInt8, values.size());
  for (const std::int64_t value : values) element(big_endian(static_cast<std::uint64_t>(value), 8));
  return *this;
}

Parameters& Parameters::float8_array(std::span<const std::optional<double>> values) {
  begin_array(kFloat8Array, kFloat8, values.size());
  for (const std::optional<double>& value : values) {
    if (value) {
      element(big_endian(std::bit_cast<std::uint64_t>(*value), 8));
    } else {
      null_element();
    }
  }
  return *this;
}

void Rows::Clear::operator()(pg_result* result) const { PQclear(result); }

int Rows::size() const { return PQntuples(result_.get()); }

bool Rows::is_null(int row, int column) const {
  return PQgetisnull(result_.get(), row, column) != 0;
}

std::string_view Rows::text(int row, int column) const {
  const char* value = PQgetvalue(result_.get(), row, column);
  if (value == nullptr) return {};
  return {value, static_cast<std::size_t>(PQgetlength(result_.get(), row, column))};
}

std::int64_t Rows::int8(int row, int column) const {
  const std::string_view value = text(row, column);
  return value.size() == 8 ? static_cast<std::int64_t>(from_big_endian(value)) : 0;
}

double Rows::float8(int row, int column) const {
  const std::string_view value = text(row, column);
  return value.size() == 8 ? std::bit_cast<double>(from_big_endian(value)) : 0;
}

void DatabaseSession::Finish::operator()(pg_conn* connection) const { PQfinish(connection); }

DatabaseSession::~DatabaseSession() = default;

/// Connects within the limit.
std::optional<Error> DatabaseSession::connect(const std::string& connection) {
  const ConnectOptions options(connection);
  connection_.reset(PQconnectStartParams(options.keywords.data(), options.values.data(), 1));
  if (!connection_) return Error{ErrorCode::limit_exceeded, "no memory for a database connection"};
  PostgresPollingStatusType next = PGRES_POLLING_WRITING;
  while (next != PGRES_POLLING_OK) {
    if (next == PGRES_POLLING_FAILED || PQsocket(connection_.get()) < 0) return failure(nullptr);
    if (!wait_for(next == PGRES_POLLING_READING ? POLLIN : POLLOUT)) return late();
    next = PQconnectPoll(connection_.get());
  }
  return std::nullopt;
}

/// Gives a new session its settings.
std::optional<Error> DatabaseSession::set_up() {
  PQsetNoticeProcessor(
      connection_.get(), [](void*, const char*) {}, nullptr);
  if (PQsetnonblocking(connection_.get(), 1) != 0 || PQenterPipelineMode(connection_.get()) != 1) {
    return failure(nullptr);
  }
  // A server that has this setting stops working for a client that has left.
  if (const Result<Rows> checking = run("SELECT set_config(name, '1s', false) FROM pg_settings"
                                        " WHERE name = 'client_connection_check_interval'");
      !checking) {
    return checking.error();
  }
  // A feature counts as stored when it is on the disk, whatever the server's default; stronger
  // settings are left alone. A writer that vanished must not keep its locks, and no session of ours
  // may wait for a lock for ever. An index serves every frequent statement, and the plan of a
  // prepared statement must not be one for tables that were small when it was made.
  if (const Result<Rows> durable =
          run("SELECT set_config('lock_timeout', '30s', false),"
              " set_config('idle_in_transaction_session_timeout', '60s', false),"
              " set_config('enable_seqscan', 'off', false), set_config('jit', 'off', false),"
              " set_config('synchronous_commit',"
              "            replace(current_setting('synchronous_commit'), 'off', 'on'), false)");
      !durable) {
    return durable.error();
  }
  return std::nullopt;
}

std::variant<std::unique_ptr<DatabaseSession>, DatabaseSession::OpenFailure> DatabaseSession::open(
    const std::string& connection, const Limit& limit) {
  char* complaint = nullptr;
  PQconninfoOption* parsed = PQconninfoParse(connection.c_str(), &complaint);
  PQfreemem(complaint);  // the message is not shown, because it can quote a password
  if (parsed == nullptr && connection.find_first_of("=:/ ") != std::string::npos) {
    return OpenFailure{{ErrorCode::invalid_argument, "the database URL cannot be understood"}};
  }
  PQconninfoFree(parsed);
  auto opened = std::make_unique<DatabaseSession>(nullptr);
  opened->limit({std::min(limit.deadline, Clock::now() + kOpening), limit.is_interrupted});
  std::optional<Error> refused = opened->connect(connection);
  if (refused && opened->connection_) {  // the server was not silent until the time was over
    const ConnectOptions options(connection);
    const PGPing ping = PQpingParams(options.keywords.data(), options.values.data(), 1);
    // A server that was starting may have become ready since.
    if (ping == PQPING_OK) refused = opened->connect(connection);
    if (refused) {
      return OpenFailure{*std::move(refused), ping == PQPING_REJECT || ping == PQPING_NO_RESPONSE};
    }
  }
  if (refused) return OpenFailure{*std::move(refused), true};
  if (std::optional<Error> failed = opened->set_up()) {
    return OpenFailure{*std::move(failed), opened->is_lost()};
  }
  opened->limit({});
  return opened;
}

Error DatabaseSession::failure(const pg_result* result) {
  const auto field = [&](int code) {
    const char* text = PQresultErrorField(result, code);
    return text == nullptr ? "" : text;
  };
  state_ = field(PG_DIAG_SQLSTATE);
  constraint_ = field(PG_DIAG_CONSTRAINT_NAME);
  std::string message = one_line(field(PG_DIAG_MESSAGE_PRIMARY));
  if (message.empty()) message = one_line(PQerrorMessage(connection_.get()));
  // The server has ended the session, although libpq may not have seen the end of it yet.
  const std::string_view severity = field(PG_DIAG_SEVERITY_NONLOCALIZED);
  if (severity == "FATAL" || severity == "PANIC") connection_.reset();
  const ErrorCode code = code_of(state_, is_lost());
  if (code != ErrorCode::unavailable) return {code, std::move(message)};
  return {code, summary_of(state_, is_lost()), {}, {}, std::move(message)};
}

/// The parameters of a statement as libpq takes them.
struct DatabaseSession::Arguments {
  explicit Arguments(const Parameters& parameters) : types(parameters.types_) {
    for (const std::optional<std::string>& value : parameters.values_) {
      values.push_back(value ? value->data() : nullptr);
      lengths.push_back(value ? static_cast<int>(value->size()) : 0);
      bytes += value ? value->size() : 0;
    }
    formats.assign(values.size(), 1);
  }
  int count() const { return static_cast<int>(values.size()); }

  const std::vector<std::uint32_t>& types;
  std::vector<const char*> values;
  std::vector<int> lengths, formats;
  std::size_t bytes = 0;
};

/// The name under which the server knows a statement, which is prepared if it is new. Null when
/// this cannot be sent.
const std::string* DatabaseSession::name_of(const std::string& statement,
                                            const Arguments& arguments) {
  const auto [known, is_new] = prepared_.try_emplace(statement);
  if (!is_new) return &known->second;
  known->second.append("w").append(std::to_string(++names_));
  if (PQsendPrepare(connection_.get(), known->second.c_str(), statement.c_str(), arguments.count(),
                    arguments.types.data()) == 0) {
    prepared_.erase(known);
    return nullptr;
  }
  sent_.push_back({statement});
  return &known->second;
}

/// Notes a statement that was sent, or could not be. Passes large ones on at once.
std::size_t DatabaseSession::sent(bool is_sent, const Arguments& arguments) {
  if (!is_sent) {
    if (!refused_) refused_ = failure(nullptr);
    return expected_;
  }
  sent_.push_back({});
  if (arguments.bytes > kUnsent && !flush() && !refused_) refused_ = late();
  return expected_++;
}

std::size_t DatabaseSession::send(const std::string& statement, const Parameters& parameters) {
  const Arguments arguments(parameters);
  if (arguments.bytes > kLargestMessage) {
    if (!refused_) {
      state_ = "54000";
      constraint_.clear();
      refused_ = Error{ErrorCode::limit_exceeded, "more than 1 GiB for one database statement"};
    }
  }
  if (refused_) return expected_;
  const std::string* const name = name_of(statement, arguments);
  return sent(
      name != nullptr && PQsendQueryPrepared(connection_.get(), name->c_str(), arguments.count(),
                                             arguments.values.data(), arguments.lengths.data(),
                                             arguments.formats.data(), 1) != 0,
      arguments);
}

Result<Rows> DatabaseSession::ask(const std::string& statement, const Parameters& parameters) {
  send(statement, parameters);
  Result<std::vector<Rows>> all = results();
  if (!all) return std::move(all).error();
  return std::move(all->back());
}

Result<Rows> DatabaseSession::run(const std::string& statement, const Parameters& parameters) {
  const Arguments arguments(parameters);
  if (!refused_) {
    sent(PQsendQueryParams(connection_.get(), statement.c_str(), arguments.count(),
                           arguments.types.data(), arguments.values.data(),
                           arguments.lengths.data(), arguments.formats.data(), 1) != 0,
         arguments);
  }
  Result<std::vector<Rows>> all = results();
  if (!all) return std::move(all).error();
  return std::move(all->back());
}

/// Passes everything to the system. False when the time is over. A broken connection shows when
/// results are awaited, with the server's reason.
bool DatabaseSession::flush() {
  for (int left = PQflush(connection_.get()); left > 0; left = PQflush(connection_.get())) {
    if (!wait_for(POLLIN | POLLOUT)) return false;
    if (PQconsumeInput(connection_.get()) == 0) break;
  }
  return true;
}

/// Waits until the socket is ready. False when the time is over.
bool DatabaseSession::wait_for(short events) const {
  constexpr std::chrono::milliseconds kTick{100};  // how soon an interruption is noticed
  pollfd socket{PQsocket(connection_.get()), events, 0};
  for (;;) {
    if (limit_.is_interrupted != nullptr && *limit_.is_interrupted) return false;
    const auto left = limit_.deadline - Clock::now();
    if (left <= Clock::duration::zero()) return false;
    const auto pause = std::min<Clock::duration>(left, kTick);
    const int ready = ::poll(
        &socket, 1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(pause).count()));
    if (ready > 0 || (ready < 0 && errno != EINTR)) return true;
  }
}

/// The failure of statements whose time is over. The session cannot be used again: closing it makes
/// the server give up too (client_connection_check_interval).
Error DatabaseSession::late() {
  state_.clear();
  constraint_.clear();
  connection_.reset();
  return {ErrorCode::unavailable, "the database does not answer in time"};
}

Result<std::vector<Rows>> DatabaseSession::results() {
  Result<std::vector<Rows>> all = receive();
  sent_.clear();
  expected_ = 0;
  refused_.reset();
  return all;
}

/// The next result. Null between the results of two statements, and when the time is over: then the
/// connection is gone.
pg_result* DatabaseSession::next_result() {
  while (PQisBusy(connection_.get()) != 0) {
    if (!wait_for(POLLIN)) {
      late();
      return nullptr;
    }
    if (PQconsumeInput(connection_.get()) == 0) break;
  }
  return PQgetResult(connection_.get());
}

Result<std::vector<Rows>> DatabaseSession::receive() {
  if (refused_ && (sent_.empty() || is_lost())) return *refused_;
  if (PQpipelineSync(connection_.get()) == 0) return failure(nullptr);
  if (!flush()) return late();
  std::vector<Rows> all;
  std::optional<Error> failed = refused_;
  for (const Sent& sent : sent_) {
    Rows rows(next_result());
    if (!connection_) return late();
    if (rows.get() == nullptr) return failure(nullptr);
    settle(sent, std::move(rows), all, failed);
    if (is_lost()) return failed ? *std::move(failed) : failure(nullptr);
    Rows end(next_result());
    if (!connection_) return late();
  }
  const Rows synchronized(next_result());
  if (!connection_) return late();
  if (PQresultStatus(synchronized.get()) != PGRES_PIPELINE_SYNC) {
    Error strange = failure(synchronized.get());
    connection_.reset();
    return strange;
  }
  if (failed) return *std::move(failed);
  state_.clear();
  constraint_.clear();
  return all;
}

/// Adds the result of what was sent to `all`, or notes the first failure.
void DatabaseSession::settle(const Sent& sent, Rows rows, std::vector<Rows>& all,
                             std::optional<Error>& failed) {
  const ExecStatusType status = PQresultStatus(rows.get());
  const bool is_done = status == PGRES_TUPLES_OK || status == PGRES_COMMAND_OK;
  if (!is_done && !failed) failed = failure(rows.get());
  if (sent.prepares.empty()) {
    if (is_done) all.push_back(std::move(rows));
  } else if (!is_done) {
    prepared_.erase(sent.prepares);
  }
}

Error DatabaseSession::collide(const char* message) {
  state_ = "40001";
  constraint_.clear();
  return {ErrorCode::unavailable, message};
}

void DatabaseSession::roll_back() {
  if (!is_lost() && !sent_.empty()) {
    const Result<std::vector<Rows>> unwanted = results();
    static_cast<void>(unwanted);
  }
  if (is_lost() || PQtransactionStatus(connection_.get()) == PQTRANS_IDLE) return;
  const Result<Rows> done = run("ROLLBACK");
  static_cast<void>(done);  // a session that cannot roll back is lost: is_lost()
}

bool DatabaseSession::is_lost() const { return PQstatus(connection_.get()) != CONNECTION_OK; }

bool DatabaseSession::is_idle() const {
  return !is_lost() && sent_.empty() && PQtransactionStatus(connection_.get()) == PQTRANS_IDLE;
}

ServerState server_state(const std::string& connection) {
  switch (PQping(connection.c_str())) {
    case PQPING_OK:
      return ServerState::accepting;
    case PQPING_REJECT:
      return ServerState::starting;
    default:
      return ServerState::silent;
  }
}

std::string connection_option(std::string_view keyword, std::string_view value) {
  std::string option(keyword);
  option += "='";
  for (const char c : value) {
    if (c == '\'' || c == '\\') option += '\\';
    option += c;
  }
  return option + "'";
}

ConnectionPool::Lease::~Lease() {
  if (pool_ != nullptr) pool_->give_back(std::move(session));
}

void ConnectionPool::interrupt() {
  {
    const std::lock_guard lock(mutex_);
    is_interrupted_ = true;
  }
  freed_.notify_all();
}

Result<ConnectionPool::Lease> ConnectionPool::lease(double seconds) {
  std::unique_lock lock(mutex_);
  const bool free = freed_.wait_for(lock, std::chrono::duration<double>(seconds),
                                    [this] { return free_slots_ > 0 || is_interrupted_; });
  if (is_interrupted_) return Error{ErrorCode::unavailable, "the service is stopping"};
  if (!free) return Error{ErrorCode::unavailable, "all database connections are busy"};
  --free_slots_;
  std::unique_ptr<DatabaseSession> session;
  if (!idle_.empty()) {
    session = std::move(idle_.back());
    idle_.pop_back();
  }
  return Lease(this, std::move(session));
}

void ConnectionPool::give_back(std::unique_ptr<DatabaseSession> session) {
  {
    const std::lock_guard lock(mutex_);
    ++free_slots_;
    // After an exception a transaction may be open, which the next user must not inherit.
    if (session && session->is_idle()) idle_.push_back(std::move(session));
  }
  freed_.notify_one();
}

}  // namespace watertight::store
