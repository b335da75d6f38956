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
#include <span>
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
  /// Stores all features or none, each key at most once; returns the version of each.
  using Write = std::function<Versions(std::span<const StoredFeature* const>)>;

  struct Limits {
    std::size_t features = 256;
    std::size_t bytes = 4 << 20;  // of skeletons and blobs
  };

  explicit GroupCommit(Write write) : GroupCommit(std::move(write), Limits{}) {}
  GroupCommit(Write write, const Limits& limits) : write_(std::move(write)), limits_(limits) {}

  /// Stores all features or none, each key at most once in a call; returns the version of each.
  /// Calls with a feature in common are written in the order of the queue, in different
  /// transactions. When a group fails, each of its calls is written alone, so that one bad call
  /// fails alone; but not when the database was unavailable: then the calls of the group share its
  /// failure, as it may not be known whether the group was stored.
  Versions put(std::span<const StoredFeature> features);

 private:
  struct Call;
  class Turn;
  using Group = std::vector<Call*>;
  void take_group(Group& group);
  void write_group(Group& group);
  Versions write_alone(const Call& call);

  const Write write_;
  const Limits limits_;
  std::mutex mutex_;
  std::deque<Call*> waiting_;
  bool is_writing_ = false;
};

}  // namespace watertight::store
