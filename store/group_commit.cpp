// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/group_commit.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace watertight::store {
namespace {

using Key = std::pair<std::string_view, std::string_view>;

Key key_of(const StoredFeature& feature) { return {feature.collection, feature.id}; }

std::size_t bytes_of(std::span<const StoredFeature> features) {
  std::size_t bytes = 0;
  for (const StoredFeature& feature : features) {
    bytes += feature.skeleton.bytes.size();
    for (const StoredSolid& solid : feature.solids) bytes += solid.blob.size();
  }
  return bytes;
}

void append(std::vector<const StoredFeature*>& all, std::span<const StoredFeature> features) {
  for (const StoredFeature& feature : features) all.push_back(&feature);
}

}  // namespace

/// A call of put() on the stack of its thread. The mutex guards all but the features.
struct GroupCommit::Call {
  std::span<const StoredFeature> features;
  std::size_t bytes = 0;
  std::optional<Versions> result;  // present when the call is done
  bool leads = false;              // whether it is this call's turn to write a group
  bool is_alone = false;           // whether its own thread has to write it
  std::condition_variable changed;
};

/// The turn of a call to write a group. At its end, by an exception too, each call of the group has
/// a result and the next call has its turn: else they would wait for ever.
class GroupCommit::Turn {
 public:
  Turn(GroupCommit& commit, Call& leader) : commit_(commit), leader_(leader) {}
  ~Turn() {
    const std::lock_guard lock(commit_.mutex_);
    for (Call* const call : group) {
      if (call == nullptr) continue;
      call->result = Error{ErrorCode::unavailable, "out of memory"};
      call->changed.notify_one();
    }
    std::deque<Call*>& waiting = commit_.waiting_;
    waiting.erase(std::remove(waiting.begin(), waiting.end(), &leader_), waiting.end());
    commit_.is_writing_ = !waiting.empty();
    if (waiting.empty()) return;
    waiting.front()->leads = true;
    waiting.front()->changed.notify_one();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

  Group group;  // null: a call that has its result and may be gone

 private:
  GroupCommit& commit_;
  Call& leader_;
};

GroupCommit::Versions GroupCommit::put(std::span<const StoredFeature> features) {
  Call call;
  call.features = features;
  call.bytes = bytes_of(features);
  std::unique_lock lock(mutex_);
  waiting_.push_back(&call);
  if (is_writing_) {
    call.changed.wait(lock, [&] { return call.leads || call.is_alone || call.result; });
  }
  if (!call.result && !call.is_alone) {
    is_writing_ = true;
    lock.unlock();
    Turn turn(*this, call);
    take_group(turn.group);
    write_group(turn.group);
  } else {
    lock.unlock();
  }
  if (call.result) return *std::move(call.result);
  std::vector<const StoredFeature*> alone;
  append(alone, features);
  return writer_.alone(alone);
}

std::size_t GroupCommit::waiting() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size();
}

/// Takes the calls from the front of the queue that fit in one group, one at least. Ends before a
/// call that has a feature in common with one before.
void GroupCommit::take_group(Group& group) {
  const std::lock_guard lock(mutex_);
  std::set<Key> keys;
  std::size_t features = 0;
  std::size_t bytes = 0;
  while (!waiting_.empty()) {
    Call* const next = waiting_.front();
    features += next->features.size();
    bytes += next->bytes;
    const bool fits = features <= limits_.features && bytes <= limits_.bytes;
    const bool is_known =
        std::any_of(next->features.begin(), next->features.end(),
                    [&](const StoredFeature& feature) { return keys.contains(key_of(feature)); });
    if (!group.empty() && (!fits || is_known)) break;
    for (const StoredFeature& feature : next->features) keys.insert(key_of(feature));
    group.push_back(next);
    waiting_.pop_front();
  }
}

/// Writes a group and gives each of its calls its result, or leaves the call to its own thread.
void GroupCommit::write_group(Group& group) {
  std::vector<const StoredFeature*> all;
  for (const Call* const call : group) append(all, call->features);
  const std::optional<Versions> written = writer_.group(all);
  const bool is_shared =
      written && (*written || group.size() == 1 || written->error().code == ErrorCode::unavailable);
  std::size_t first = 0;
  for (Call*& call : group) {
    std::optional<Versions> result;
    if (is_shared && !*written) result = written->error();
    if (is_shared && *written) {
      const auto begin = (*written)->begin() + static_cast<std::ptrdiff_t>(first);
      result = std::vector<std::uint64_t>(
          begin, begin + static_cast<std::ptrdiff_t>(call->features.size()));
    }
    first += call->features.size();
    // As soon as the mutex is free, the call's thread may return and take the call with it.
    const std::lock_guard lock(mutex_);
    call->result = std::move(result);
    call->is_alone = !is_shared;
    call->changed.notify_one();
    call = nullptr;
  }
}

}  // namespace watertight::store
