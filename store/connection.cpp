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
constexpr std::chrono::seconds kOpening{
    5};  // the longest time for the first statements of a session
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

std::string trimmed(const char* message) {
  std::string text = message == nullptr ? "" : message;
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
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

std::variant<std::unique_ptr<DatabaseSession>, DatabaseSession::OpenFailure> DatabaseSession::open(
    const std::string& connection) {
  // Keywords before `dbname` are defaults that the connection string may override; keywords after
  // `dbname` hold whatever the connection string says.
  const std::array<const char*, 7> keywords{"connect_timeout",
                                            "tcp_user_timeout",
                                            "keepalives_idle",
                                            "fallback_application_name",
                                            "dbname",
                                            "client_encoding",
                                            nullptr};
  const std::array<const char*, 7> values{"10",   "30000", "30", "watertight", connection.c_str(),
                                          "UTF8", nullptr};
  char* complaint = nullptr;
  PQconninfoOption* parsed = PQconninfoParse(connection.c_str(), &complaint);
  PQfreemem(complaint);  // the message is not shown, because it can quote a password
  if (parsed == nullptr && connection.find_first_of("=:/ ") != std::string::npos) {
    return OpenFailure{{ErrorCode::invalid_argument, "the database URL cannot be understood"}};
  }
  PQconninfoFree(parsed);
  auto opened =
      std::make_unique<DatabaseSession>(PQconnectdbParams(keywords.data(), values.data(), 1));
  if (!opened->connection_) {
    return OpenFailure{{ErrorCode::limit_exceeded, "no memory for a database connection"}};
  }
  pg_conn* raw = opened->connection_.get();
  PGPing ping = PQPING_OK;
  if (PQstatus(raw) != CONNECTION_OK) {
    ping = PQpingParams(keywords.data(), values.data(), 1);
    if (ping == PQPING_OK) {  // a server that was starting may have become ready since
      opened->connection_.reset(PQconnectdbParams(keywords.data(), values.data(), 1));
      raw = opened->connection_.get();
    }
  }
  if (PQstatus(raw) != CONNECTION_OK) {
    return OpenFailure{{ErrorCode::unavailable, trimmed(PQerrorMessage(raw))},
                       ping == PQPING_REJECT || ping == PQPING_NO_RESPONSE};
  }
  PQsetNoticeProcessor(
      raw, [](void*, const char*) {}, nullptr);
  // A feature counts as stored when it is on the disk, whatever the server's default; stronger
  // settings are left alone. A writer that vanished must not keep its locks, and no session of ours
  // may wait for a lock for ever.
  PQsetnonblocking(raw, 1);
  opened->limit(Clock::now() + kOpening, nullptr);
  // A server that has this setting stops working for a client that has left.
  const Result<Rows> checking = opened->run(
      "SELECT set_config(name, '1s', false) FROM pg_settings"
      " WHERE name = 'client_connection_check_interval'");
  if (!checking) return OpenFailure{checking.error(), opened->is_lost()};
  const Result<Rows> durable = opened->run(
      "SELECT set_config('lock_timeout', '30s', false),"
      " set_config('idle_in_transaction_session_timeout', '60s', false),"
      " set_config('synchronous_commit',"
      "            replace(current_setting('synchronous_commit'), 'off', 'on'), false)");
  if (!durable) return OpenFailure{durable.error(), opened->is_lost()};
  opened->limit(Clock::time_point::max(), nullptr);
  return opened;
}

Error DatabaseSession::failure(const pg_result* result) {
  const char* state = PQresultErrorField(result, PG_DIAG_SQLSTATE);
  state_ = state == nullptr ? "" : state;
  const char* primary = PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY);
  std::string message =
      primary != nullptr ? trimmed(primary) : trimmed(PQerrorMessage(connection_.get()));
  if (message.empty()) message = "the database does not answer";
  return {code_of(state_, is_lost()), std::move(message)};
}

Result<Rows> DatabaseSession::run(const std::string& statement, const Parameters& parameters) {
  // The protocol gives lengths in bytes as signed 32-bit numbers and limits a message to 1 GiB.
  constexpr std::size_t kLargestMessage = (1ULL << 30) - (1ULL << 16);
  std::vector<const char*> values;
  std::vector<int> lengths;
  std::size_t total = 0;
  for (const std::optional<std::string>& value : parameters.values_) {
    values.push_back(value ? value->data() : nullptr);
    total += value ? value->size() : 0;
    if (total > kLargestMessage) {
      state_ = "54000";
      return Error{ErrorCode::limit_exceeded, "more than 1 GiB for one database statement"};
    }
    lengths.push_back(value ? static_cast<int>(value->size()) : 0);
  }
  const std::vector<int> formats(values.size(), 1);
  const int is_sent =
      PQsendQueryParams(connection_.get(), statement.c_str(), static_cast<int>(values.size()),
                        parameters.types_.data(), values.data(), lengths.data(), formats.data(), 1);
  if (is_sent == 0) return failure(nullptr);
  for (int left = PQflush(connection_.get()); left != 0; left = PQflush(connection_.get())) {
    if (left < 0) break;  // receive() has the server's reason
    if (!wait_for(POLLIN | POLLOUT)) return late();
    if (PQconsumeInput(connection_.get()) == 0) break;
  }
  return receive();
}

/// Waits until the socket is ready. False when the time is over.
bool DatabaseSession::wait_for(short events) const {
  constexpr std::chrono::milliseconds kTick{100};  // how soon an interruption is noticed
  pollfd socket{PQsocket(connection_.get()), events, 0};
  for (;;) {
    if (is_interrupted_ != nullptr && *is_interrupted_) return false;
    const auto left = deadline_ - Clock::now();
    if (left <= Clock::duration::zero()) return false;
    const auto pause = std::min<Clock::duration>(left, kTick);
    const int ready = ::poll(
        &socket, 1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(pause).count()));
    if (ready > 0 || (ready < 0 && errno != EINTR)) return true;
  }
}

/// The failure of a statement whose time is over. Its session cannot be used again: closing it
/// makes the server give up too (client_connection_check_interval).
Result<Rows> DatabaseSession::late() {
  state_.clear();
  connection_.reset();
  return Error{ErrorCode::unavailable, "the database does not answer in time"};
}

/// The result of the statement that was sent.
Result<Rows> DatabaseSession::receive() {
  std::optional<Rows> rows;
  for (;;) {
    while (PQisBusy(connection_.get()) != 0) {
      if (!wait_for(POLLIN)) return late();
      if (PQconsumeInput(connection_.get()) == 0) break;
    }
    pg_result* const next = PQgetResult(connection_.get());
    if (next == nullptr) break;
    rows.emplace(next);
  }
  if (!rows) return failure(nullptr);
  const ExecStatusType status = PQresultStatus(rows->get());
  if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK) return failure(rows->get());
  return Result<Rows>(*std::move(rows));
}

Error DatabaseSession::collide(const char* message) {
  state_ = "40001";
  return {ErrorCode::unavailable, message};
}

void DatabaseSession::roll_back() {
  if (is_lost() || PQtransactionStatus(connection_.get()) == PQTRANS_IDLE) return;
  const Result<Rows> done = run("ROLLBACK");
  static_cast<void>(done);  // a session that cannot roll back is lost: is_lost()
}

bool DatabaseSession::is_lost() const { return PQstatus(connection_.get()) != CONNECTION_OK; }

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
    if (session && !session->is_lost()) idle_.push_back(std::move(session));
  }
  freed_.notify_one();
}

}  // namespace watertight::store
