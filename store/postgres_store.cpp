// SPDX-License-Identifier: GPL-3.0-or-later
//
// The store in PostgreSQL: the pool, the transactions, and new attempts after a connection broke.
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "store/attributes/attribute_rows.h"
#include "store/connection.h"
#include "store/group_commit.h"
#include "store/migrations.h"
#include "store/rows/feature_rows.h"
#include "store/solid_store.h"

namespace watertight::store {
namespace {

using Clock = std::chrono::steady_clock;

// The longest time to wait for the server. A restarted server replays its log within seconds.
constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::milliseconds kCancelPoll{20};
constexpr std::chrono::milliseconds kFirstPause{50};
constexpr std::chrono::milliseconds kLongestPause{1000};
constexpr double kLeaseSeconds = 30;
// The longest times for one attempt of a transaction.
constexpr std::chrono::seconds kPinging{2};
constexpr std::chrono::seconds kReading{10};
constexpr std::chrono::seconds kWriting{120};
constexpr std::chrono::seconds kCounting{600};
constexpr std::chrono::hours kMigrating{48};
// A ping that failed speaks for all calls of the next moments.
constexpr std::chrono::seconds kAway{2};
// Calls that put at most so many features share a transaction with others (store/group_commit.h).
// Larger ones are written at the same time as others, each in a session of its own.
constexpr std::size_t kGrouped = 16;
// For transactions that many wait for: who is in their way has to be waited for elsewhere.
constexpr const char* kImpatient = "SET LOCAL lock_timeout = '100ms'";
// PostgreSQL's name for the primary key of the receipts.
constexpr std::string_view kReceiptConstraint = "write_receipt_pkey";
constexpr double kPingLeaseSeconds = 2;
// Old receipts are removed after the first write and then once in this many writes.
constexpr std::uint64_t kWritesPerSweep = 1000;
// The changes of collections' counts are summed up at the start and after this many writes.
constexpr std::uint64_t kWritesPerFold = 100;

/// Pauses between attempts, each pause longer than the one before, until kPatience is used up.
class Backoff {
 public:
  /// Sleeps; or returns false at once when no time is left.
  bool pause() {
    const Clock::time_point now = Clock::now();
    if (now + pause_ > deadline_) return false;
    std::this_thread::sleep_for(pause_);
    pause_ = std::min(pause_ * 2, kLongestPause);
    return true;
  }

 private:
  Clock::time_point deadline_ = Clock::now() + kPatience;
  std::chrono::milliseconds pause_ = kFirstPause;
};

/// Whether concurrent transactions got into each other's way, so that the same transaction can
/// succeed now. A foreign key fails (23503) only when a document or kind was removed as unused
/// while a writer was about to use it, and a value is missing (23502) only when that was removed
/// whose key it is: a collection, a kind, a dictionary.
bool is_collision(const std::string& state) {
  return state == "40001" || state == "40P01" || state == "55P03" || state == "23503" ||
         state == "23502";
}

/// A random number that names one write, so that no two writes of any instance have the same name.
using Token = std::array<std::uint8_t, 16>;

Result<Token> new_token() {
  Token token;
  if (getrandom(token.data(), token.size(), 0) != static_cast<ssize_t>(token.size())) {
    return Error{ErrorCode::unavailable, "the system gives no random numbers"};
  }
  return token;
}

class PostgresStore final : public SolidStore {
 public:
  PostgresStore(const std::string& connection, std::size_t connections, AttributeReader reader)
      : reader_(std::move(reader)),
        pool_(connection, connections),
        pings_(connection, 1),
        group_({[this](FeatureRefs features) { return write_group(features); },
                [this](FeatureRefs features) { return write_all(features, {}); }}) {}

  Status open(const Tell& tell) {
    return with_session<Done>([&tell](DatabaseSession& session) { return migrate(session, tell); },
                              kMigrating);
  }

  Status ping() override {
    const Status status = try_ping();
    away_until_ = status ? Clock::time_point::min() : Clock::now() + kAway;
    return status;
  }

  void interrupt() override {
    pool_.interrupt();
    pings_.interrupt();
  }

  Status try_ping() {
    Result<ConnectionPool::Lease> lease = pings_.lease(kPingLeaseSeconds);
    if (!lease) return lease.error();
    const DatabaseSession::Limit limit = limit_of(kPinging);
    // A session of the pool is lost if the server restarted. Then one new session is tried at once.
    for (int attempt = 0; attempt < 2; ++attempt) {
      if (!lease->session) {
        auto opened = DatabaseSession::open(pings_.connection(), limit);
        if (const auto* failed = std::get_if<DatabaseSession::OpenFailure>(&opened)) {
          return failed->error;
        }
        lease->session = std::move(std::get<std::unique_ptr<DatabaseSession>>(opened));
      }
      lease->session->limit(limit);
      Status current = check_schema(*lease->session);
      if (current || !lease->session->is_lost()) return current;
      lease->session.reset();
    }
    return Error{ErrorCode::unavailable, "the database does not answer"};
  }

  Result<CollectionPage> collections(std::uint64_t limit, const std::string& after) override {
    if (!after.empty() && !check_collection_id(after)) {
      return Error{ErrorCode::invalid_argument, "a page cannot start after an impossible id"};
    }
    return read<CollectionPage>(
        [&](DatabaseSession& session) { return read_collections(session, limit, after); });
  }

  Result<StoredCollection> collection(const std::string& id) override {
    if (!check_collection_id(id)) return no_such_collection();
    return read<StoredCollection>(
        [&](DatabaseSession& session) { return read_collection(session, id); });
  }

  Result<StoredCollection> recount(const std::string& id) override {
    if (!check_collection_id(id)) return no_such_collection();
    return write<StoredCollection>(
        [&](DatabaseSession& session) { return recount_collection(session, id); }, kCounting);
  }

  Status remove_collection(const std::string& id, const CancelPoll& is_cancelled) override {
    if (!check_collection_id(id)) return no_such_collection();
    const auto is_over = [&] { return is_cancelled && is_cancelled(); };
    if (is_over()) return Error{ErrorCode::cancelled, "nothing was removed"};
    const Result<std::string> key =
        write<std::string>([&](DatabaseSession& session) { return hide_collection(session, id); });
    if (!key) return key.error();
    for (std::string after; !is_over();) {
      const Result<std::string> last = purge(*key, after);
      if (!last || last->empty()) break;  // after a failure later writes delete the rest
      after = *last;
    }
    return Done{};
  }

  Status rename_collection(const std::string& id, const std::string& new_id) override {
    if (Status checked = check_collection_id(new_id); !checked) return checked;
    if (!check_collection_id(id)) return no_such_collection();
    return write<Done>(
        [&](DatabaseSession& session) { return store::rename_collection(session, id, new_id); });
  }

  Status set_policy(const std::string& id, Policy policy) override {
    if (!check_collection_id(id)) return no_such_collection();
    return write<Done>(
        [&](DatabaseSession& session) { return store::set_policy(session, id, policy); });
  }

  Status make_collection(const std::string& id, std::uint32_t srid) override {
    if (Status checked = check_collection_id(id); !checked) return checked;
    return write<Done>(
        [&](DatabaseSession& session) { return store::make_collection(session, id, srid); });
  }

  Status set_rules(const std::string& id, const std::string& rules) override {
    if (!check_collection_id(id)) return no_such_collection();
    return write<Done>(
        [&](DatabaseSession& session) { return store::set_rules(session, id, rules); });
  }

  Result<std::vector<ChosenAttribute>> attributes(const std::string& collection) override {
    if (!check_collection_id(collection)) return no_such_collection();
    return read<std::vector<ChosenAttribute>>(
        [&](DatabaseSession& session) { return read_attributes(session, collection); });
  }

  Status change_attributes(const std::string& collection, const AttributeChange& change,
                           const CancelPoll& is_cancelled, const ShareDone& progress) override {
    if (!check_collection_id(collection)) return no_such_collection();
    for (const std::string& name : change.add) {
      if (Status checked = check_attribute_name(name); !checked) return checked;
    }
    const auto is_over = [&] { return is_cancelled && is_cancelled(); };
    const Error over{ErrorCode::cancelled,
                     "the attributes are chosen, their values are not complete: the same change "
                     "goes on"};
    Status chosen = write<Done>(
        [&](DatabaseSession& session) { return choose_attributes(session, collection, change); });
    if (!chosen) return chosen;
    for (double share = 0; share < 1;) {
      if (is_over()) return over;
      const Result<double> filled = write<double>([&](DatabaseSession& session) {
        return fill_attributes(session, collection, shared_, reader_);
      });
      if (!filled) return filled.error();
      share = *filled;
      if (progress) progress(share);
    }
    for (bool has_more = true; has_more;) {
      if (is_over()) return over;
      const Result<bool> purged = write<bool>(purge_attributes);
      if (!purged) return purged.error();
      has_more = *purged;
    }
    return analyze_attributes();
  }

  Result<std::vector<std::uint64_t>> put(std::span<const StoredFeature> features,
                                         const WriteCondition& condition) override {
    if (features.empty()) return std::vector<std::uint64_t>{};
    if (Status checked = check_features(features); !checked) return std::move(checked).error();
    if (condition.kind == WriteCondition::Kind::none && features.size() <= kGrouped) {
      return group_.put(features);
    }
    std::vector<const StoredFeature*> all;
    for (const StoredFeature& feature : features) all.push_back(&feature);
    return write_all(all, condition);
  }

  Result<std::vector<std::uint64_t>> put_all(FeatureBatches& batches,
                                             const WriteCondition& condition) override {
    return write<std::vector<std::uint64_t>>(
        [&](DatabaseSession& session) { return write_batches(session, batches, condition); });
  }

  Result<StoredFeature> get(const std::string& collection, const std::string& id) override {
    if (!check_collection_id(collection) || !is_possible_id(id)) return no_such_feature(collection);
    return read<StoredFeature>(
        [&](DatabaseSession& session) { return read_feature(session, collection, id, shared_); });
  }

  Result<packing::DictionaryPointer> dictionary(const std::string& collection) override {
    if (!check_collection_id(collection)) return packing::DictionaryPointer();
    if (auto known = shared_.newest(collection)) return *std::move(known);
    return read<packing::DictionaryPointer>(
        [&](DatabaseSession& session) { return read_dictionary(session, collection, shared_); });
  }

  Result<std::uint64_t> repack(std::span<const StoredFeature> features) override {
    if (features.empty()) return std::uint64_t{0};
    if (Status checked = check_features(features); !checked) return std::move(checked).error();
    std::vector<const StoredFeature*> all;
    for (const StoredFeature& feature : features) all.push_back(&feature);
    return write<std::uint64_t>(
        [&](DatabaseSession& session) { return repack_features(session, all, shared_); });
  }

  Result<FeaturePage> list(const FeatureQuery& query) override {
    if (query.box) {
      if (Status checked = check_box(*query.box); !checked) return std::move(checked).error();
    }
    if (!check_collection_id(query.collection)) return no_such_collection();
    if (query.where.size() > kMostConditions) return too_many_conditions();
    if (query.filter) {
      if (Status checked = check_filter(*query.filter); !checked) return std::move(checked).error();
    }
    if (!query.sort && !query.after.empty() && !is_possible_id(query.after)) {
      return Error{ErrorCode::invalid_argument, "a page cannot start after an impossible id"};
    }
    return read<FeaturePage>([&](DatabaseSession& session) { return read_page(session, query); });
  }

  using SolidStore::walk;
  Result<FeatureBatch> walk(const std::string& collection, std::uint64_t limit,
                            const std::string& after,
                            const std::optional<Filter>& filter) override {
    if (!check_collection_id(collection)) return no_such_collection();
    if (filter) {
      if (Status checked = check_filter(*filter); !checked) return std::move(checked).error();
    }
    return read_at_once<FeatureBatch>([&](DatabaseSession& session) {
      return read_batch(session, collection, limit, after, filter, shared_);
    });
  }

  Result<std::vector<Twins>> twins(const std::string& collection,
                                   std::span<const std::string> ids) override {
    if (!check_collection_id(collection)) return no_such_collection();
    return read<std::vector<Twins>>(
        [&](DatabaseSession& session) { return read_twins(session, collection, ids); });
  }

  Result<PlacedPage> places(const std::string& collection, std::uint64_t limit,
                            const std::string& after, bool only_unproven) override {
    if (!check_collection_id(collection)) return no_such_collection();
    return read<PlacedPage>([&](DatabaseSession& session) {
      return read_places(session, collection, limit, after, only_unproven);
    });
  }

  Result<std::vector<std::string>> ranked(const RankQuery& query, std::uint64_t limit) override {
    if (!check_collection_id(query.collection)) return no_such_collection();
    return read<std::vector<std::string>>(
        [&](DatabaseSession& session) { return read_ranked(session, query, limit); });
  }

  Result<std::vector<StoredHeader>> documents(const std::string& collection,
                                              std::uint64_t limit) override {
    if (!check_collection_id(collection)) return no_such_collection();
    return read<std::vector<StoredHeader>>(
        [&](DatabaseSession& session) { return read_documents(session, collection, limit); });
  }

  Result<std::uint64_t> version(const std::string& collection, const std::string& id) override {
    if (!check_collection_id(collection) || !is_possible_id(id)) return no_such_feature(collection);
    return read<std::uint64_t>(
        [&](DatabaseSession& session) { return read_version(session, collection, id); });
  }

  Status remove(const std::string& collection, const std::string& id,
                const WriteCondition& condition) override {
    if (!check_collection_id(collection) || !is_possible_id(id)) return no_such_feature(collection);
    return write<Done>([&](DatabaseSession& session) {
      return delete_feature(session, collection, id, condition);
    });
  }

 private:
  DatabaseSession::Limit limit_of(std::chrono::seconds longest) const {
    return {Clock::now() + longest, &pool_.is_interrupted()};
  }

  Result<std::vector<std::uint64_t>> write_all(FeatureRefs features,
                                               const WriteCondition& condition) {
    return write<std::vector<std::uint64_t>>([&](DatabaseSession& session) {
      return write_features(session, features, condition, shared_, reader_);
    });
  }

  /// Writes the features of several calls. Nothing: a lock of another transaction is in the way.
  std::optional<Result<std::vector<std::uint64_t>>> write_group(FeatureRefs features) {
    bool has_collided = false;
    const Work<std::vector<std::uint64_t>> work = [&](DatabaseSession& session) {
      session.send(kImpatient);
      auto versions = write_features(session, features, {}, shared_, reader_);
      has_collided = !versions && is_collision(session.state());
      return versions;
    };
    auto versions = write(work, kWriting, Collisions::are_errors);
    if (!versions && has_collided) return std::nullopt;
    return versions;
  }

  template <class Value>
  using Work = std::function<Result<Value>(DatabaseSession&)>;

  Result<std::vector<std::uint64_t>> write_batches(DatabaseSession& session,
                                                   FeatureBatches& batches,
                                                   const WriteCondition& condition) {
    std::vector<std::uint64_t> versions;
    if (Status rewound = batches.rewind(); !rewound) return std::move(rewound).error();
    for (;;) {
      const auto batch = batches.next();
      if (!batch) return batch.error();
      if (batch->empty()) return versions;
      if (Status checked = check_features(*batch); !checked) return std::move(checked).error();
      session.limit(limit_of(kWriting));
      std::vector<const StoredFeature*> features;
      for (const StoredFeature& feature : *batch) features.push_back(&feature);
      const auto written = write_features(session, features, condition, shared_, reader_);
      if (!written) return written.error();
      versions.insert(versions.end(), written->begin(), written->end());
    }
  }

  /// The server plans queries of attributes by what it knows of their values.
  Status analyze_attributes() {
    return with_session<Done>(
        [](DatabaseSession& session) -> Status {
          const Result<Rows> done = session.run("ANALYZE watertight.attribute_value");
          if (!done) return done.error();
          return Done{};
        },
        kWriting);
  }

  static Error too_many_conditions() {
    return {ErrorCode::invalid_argument,
            "a query has at most " + std::to_string(kMostConditions) + " conditions on attributes"};
  }

  static Error no_such_collection() {
    return {ErrorCode::not_found, "there is no such collection"};
  }

  /// The error for ids that cannot be shown as text.
  static Error no_such_feature(const std::string& collection) {
    return {ErrorCode::not_found, check_collection_id(collection)
                                      ? "collection '" + collection + "' has no such feature"
                                      : "there is no such collection"};
  }

  enum class Collisions : std::uint8_t { are_tried_again, are_errors };

  /// Runs `work` with a session, and runs it again when transactions collided or the session was
  /// lost, then with a new session. Requires work that may be run again.
  template <class Value>
  Result<Value> with_session(const Work<Value>& work, std::chrono::seconds longest,
                             Collisions collisions = Collisions::are_tried_again) {
    if (Clock::now() < away_until_.load()) {
      return Error{ErrorCode::unavailable, "the database is away"};
    }
    Result<ConnectionPool::Lease> lease = pool_.lease(kLeaseSeconds);
    if (!lease) return lease.error();
    for (Backoff backoff;;) {
      if (!lease->session) {
        auto opened = DatabaseSession::open(pool_.connection(), limit_of(longest));
        if (const auto* failed = std::get_if<DatabaseSession::OpenFailure>(&opened)) {
          if (failed->may_come_back && !pool_.is_interrupted() && backoff.pause()) continue;
          return failed->error;
        }
        lease->session = std::move(std::get<std::unique_ptr<DatabaseSession>>(opened));
      }
      lease->session->limit(limit_of(longest));
      Result<Value> result = work(*lease->session);
      if (result) return result;
      const bool lost = lease->session->is_lost();
      const bool collided =
          collisions == Collisions::are_tried_again && is_collision(lease->session->state());
      if (lost) {
        lease->session.reset();
      } else {
        lease->session->roll_back();
      }
      if ((!lost && !collided) || pool_.is_interrupted() || !backoff.pause()) return result;
    }
  }

  /// Runs `work`, each of whose statements sees a state of the database of its own.
  template <class Value>
  Result<Value> read(const Work<Value>& work) {
    return with_session<Value>(work, kReading);
  }

  /// Runs `work` in a transaction in which all statements see one state of the database.
  template <class Value>
  Result<Value> read_at_once(const Work<Value>& work) {
    const Work<Value> transaction = [&](DatabaseSession& session) -> Result<Value> {
      session.send("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY");
      Result<Value> result = work(session);
      if (!result) return result;
      const Result<Rows> ended = session.run("COMMIT");
      if (!ended) return ended.error();
      return result;
    };
    return with_session<Value>(transaction, kReading);
  }

  /// Runs `work` in one durable transaction, exactly once. The transaction also inserts a token: if
  /// the connection breaks during COMMIT, the insert of the token in the next attempt waits for the
  /// end of the first attempt, and fails exactly when the first attempt was committed. `work` must
  /// wait for a result; BEGIN and the token are sent with its first statements.
  template <class Value>
  Result<Value> write(const Work<Value>& work, std::chrono::seconds longest = kWriting,
                      Collisions collisions = Collisions::are_tried_again) {
    const Result<Token> token = new_token();
    if (!token) return token.error();
    std::optional<Value> in_doubt;  // the result of an attempt whose COMMIT was not answered
    const Work<Value> transaction = [&](DatabaseSession& session) -> Result<Value> {
      session.send("BEGIN ISOLATION LEVEL READ COMMITTED READ WRITE");
      session.send("INSERT INTO watertight.write_receipt (token) VALUES ($1)",
                   Parameters().bytea(*token));
      Result<Value> value = work(session);
      if (!value) {
        if (!in_doubt || session.constraint() != kReceiptConstraint) return value;
        session.roll_back();
        return *in_doubt;
      }
      const Result<Rows> ended = session.run("COMMIT");
      if (ended) return value;
      if (session.is_lost()) in_doubt = *value;
      return ended.error();
    };
    Result<Value> result = with_session<Value>(transaction, longest, collisions);
    if (!result && in_doubt && result.error().code == ErrorCode::unavailable) {
      return Error{
          ErrorCode::unavailable,
          "the database went away while it committed; whether this was stored is not known",
          {},
          {},
          to_string(result.error())};
    }
    if (!result) return result;
    const std::uint64_t writes = ++writes_;
    if (writes % kWritesPerFold == 1) {
      fold();
      purge_one();
    }
    if (writes % kWritesPerSweep == 1) sweep();
    return result;
  }

  /// Keeps the changes few that a reader of a collection's counts sums up.
  void fold() {
    const Work<Done> work = [](DatabaseSession& session) -> Status {
      session.send("BEGIN");
      if (Status done = fold_changes(session); !done) return done;
      if (const Result<Rows> ended = session.run("COMMIT"); !ended) return ended.error();
      return Done{};
    };
    static_cast<void>(with_session(work, kWriting));  // the next one takes what this one left
  }

  /// One step of the deletion of a removed collection's rows: purge_step().
  Result<std::string> purge(const std::string& key, const std::string& after) {
    const Work<std::string> work = [&](DatabaseSession& session) -> Result<std::string> {
      session.send("BEGIN");
      Result<std::string> last = purge_step(session, key, after);
      if (!last) return last;
      if (const Result<Rows> ended = session.run("COMMIT"); !ended) return ended.error();
      return last;
    };
    return with_session(work, kWriting);
  }

  /// Deletes some rows of a removed collection whose deletion was broken off.
  void purge_one() {
    const Work<std::string> hidden = [](DatabaseSession& session) {
      return read_hidden_collection(session);
    };
    const Result<std::string> key = with_session(hidden, kWriting);
    if (key && !key->empty()) static_cast<void>(purge(*key, ""));
  }

  /// Removes old receipts, and kinds and documents that no feature uses any more.
  void sweep() {
    const Work<Done> work = [](DatabaseSession& session) -> Status {
      for (const char* statement :
           {"DELETE FROM watertight.write_receipt WHERE written < now() - interval '1 day'",
            "DELETE FROM watertight.kind k WHERE NOT EXISTS"
            " (SELECT FROM watertight.feature_row f WHERE f.kind = k.key)",
            "DELETE FROM watertight.document d WHERE NOT EXISTS"
            " (SELECT FROM watertight.kind k WHERE k.document = d.key) AND NOT EXISTS"
            " (SELECT FROM watertight.collection c WHERE c.document = d.key)"}) {
        if (const Result<Rows> gone = session.run(statement); !gone) return gone.error();
      }
      return Done{};
    };
    static_cast<void>(
        with_session(work, kWriting));  // after a failure the next sweep removes the rest
  }

  const AttributeReader reader_;
  ConnectionPool pool_;
  ConnectionPool pings_;  // apart, so that no other call delays a ping
  SharedRows shared_;
  GroupCommit group_;
  std::atomic<Clock::time_point> away_until_ = Clock::time_point::min();
  std::atomic<std::uint64_t> writes_{0};
};

}  // namespace

Result<std::unique_ptr<SolidStore>> open_postgres_store(const std::string& connection,
                                                        std::size_t connections,
                                                        const CancelPoll& is_cancelled,
                                                        const Tell& tell, AttributeReader reader) {
  auto store = std::make_unique<PostgresStore>(connection, connections, std::move(reader));
  const std::jthread watch([&is_cancelled, opening = store.get()](const std::stop_token& stop) {
    while (is_cancelled && !stop.stop_requested()) {
      if (is_cancelled()) return opening->interrupt();
      std::this_thread::sleep_for(kCancelPoll);
    }
  });
  if (Status opened = store->open(tell); !opened) return std::move(opened).error();
  return std::unique_ptr<SolidStore>(std::move(store));
}

}  // namespace watertight::store
