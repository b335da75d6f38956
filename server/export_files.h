// SPDX-License-Identifier: GPL-3.0-or-later
//
// Exports that were asked for by ranges, kept as files for a while so that the ranges that follow
// need not make them again. Internal to server/.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "base/temporary_file.h"

namespace watertight::server {

/// Whole files by key, which names the state of their collection. Thread-safe.
class ExportFiles {
 public:
  using File = std::shared_ptr<const TemporaryFile>;

  /// Keeps at most `most_files` files, each for `keep` after it was asked for last. All files
  /// together have at most `most_bytes`, and each that is being made as many again.
  explicit ExportFiles(std::size_t most_files = 8, std::uint64_t most_bytes = 4ULL << 30,
                       std::chrono::seconds keep = std::chrono::seconds(600))
      : most_files_(most_files), most_bytes_(most_bytes), keep_(keep) {}

  /// The file that is kept under `key`; null if there is none.
  File find(const std::string& key);
  /// Whether a file that is being made may have so many bytes, beside those of all files that
  /// somebody still reads. Removes other files for it.
  bool make_room(std::uint64_t bytes);
  /// Keeps a file that is whole.
  File keep(const std::string& key, TemporaryFile file);
  /// Removes the files whose time is over.
  void forget_old();

 private:
  using Clock = std::chrono::steady_clock;
  struct Entry {
    std::string key;
    File file;
    Clock::time_point used;
  };
  void drop_surplus();

  const std::size_t most_files_;
  const std::uint64_t most_bytes_;
  const std::chrono::seconds keep_;
  /// The bytes of all files that exist, also of those that are not kept any more but still read.
  const std::shared_ptr<std::atomic<std::uint64_t>> bytes_ =
      std::make_shared<std::atomic<std::uint64_t>>(0);
  std::mutex mutex_;
  std::list<Entry> entries_;  // the one that was used last comes first
};

}  // namespace watertight::server
