// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small writes of several threads that arrive at about the same time share one transaction, and so
// one wait for the disk. For postgres_store.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/result.h"
#include "store/solid_store.h"

namespace watertight::store {

/// One of the waiting threads writes for all that wait: it takes the calls from the front of the
/// queue, writes their features in one transaction, and hands the queue to the next thread. There
/// is no thread of its own and no waiting for others to come: while one group is written, the next
/// gathers. Thread-safe.
class GroupCommit {
 public:
  using Versions = Result<std::vector<std::uint64_t>>;
  using Features = std::span<const StoredFeature* const>;
  /// Both store all features or none, each key at most once, and return the version of each.
  struct Writer {
    /// Writes the features of some calls, without waiting long for the locks of others. Nothing:
    /// such a lock was in the way, and nothing is stored.
    std::function<std::optional<Versions>(Features)> group;
    /// Writes the features of one call.
    std::function<Versions(Features)> alone;
  };

  struct Limits {
    std::size_t features = 256;
    std::size_t bytes = 4 << 20;  // of skeletons and blobs
  };

  explicit GroupCommit(Writer writer) : GroupCommit(std::move(writer), Limits{}) {}
  GroupCommit(Writer writer, const Limits& limits) : writer_(std::move(writer)), limits_(limits) {}

  /// Stores all features or none, each key at most once in a call; returns the version of each.
  /// Calls with a feature in common are written in different transactions. When a group fails, or a
  /// lock is in its way, each of its calls is written alone by its own thread, so that one bad or
  /// long call is nobody else's matter; but not when the database was unavailable: then the calls
  /// of the group share its failure, as it may not be known whether the group was stored.
  Versions put(std::span<const StoredFeature> features);

  /// The number of calls that wait for their turn.
  std::size_t waiting() const;

 private:
  struct Call;
  class Turn;
  using Group = std::vector<Call*>;
  void take_group(Group& group);
  void write_group(Group& group);

  const Writer writer_;
  const Limits limits_;
  mutable std::mutex mutex_;
  std::deque<Call*> waiting_;
  bool is_writing_ = false;
};

}  // namespace watertight::store
