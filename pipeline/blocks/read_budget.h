// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bound on what the blocks of one Watertight file may claim: in proportion to the bytes of it
// that were read, so that a small file cannot ask for much memory. A writer keeps to it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/limits.h"

namespace watertight::pipeline {

class ReadBudget {
 public:
  explicit ReadBudget(const Limits& limits) : limits_(limits) {}

  /// Raises the bounds: so many bytes more of the file were read.
  void add_bytes(std::uint64_t bytes) { bytes_ += bytes; }

  /// The bytes of texts that may still come.
  std::uint64_t texts_left() const { return left(limits_.expanded_from(bytes_), texts_); }
  /// Take what a block claims; false if that is more than may still come.
  bool take_text(std::uint64_t bytes) { return take(bytes, texts_left(), texts_); }
  bool take_vertices(std::uint64_t count) {
    return take(count, left(limits_.claimed_by(bytes_), vertices_), vertices_);
  }
  static constexpr std::uint64_t kFreeItems = 65'536;
  static constexpr std::uint64_t kItemsPerByte = 4;

  /// Documents, features and solids. Texts may be compressed a thousandfold, so the bytes of the
  /// file bound the number of their items.
  bool take_items(std::uint64_t count) {
    return take(count, left(kFreeItems + kItemsPerByte * bytes_, items_), items_);
  }
  /// Forgets what was claimed: it is not in memory any more, or the caller's.
  void start_anew() { texts_ = vertices_ = items_ = 0; }
  const Limits& limits() const { return limits_; }

  /// Takes what `later`, a copy of `start`, has taken since it was copied. False, and nothing is
  /// taken, if that is more than may still come.
  bool take_since(const ReadBudget& start, const ReadBudget& later) {
    ReadBudget taken = *this;
    const bool fits = taken.take_text(later.texts_ - start.texts_) &&
                      taken.take_vertices(later.vertices_ - start.vertices_) &&
                      taken.take_items(later.items_ - start.items_);
    if (fits) *this = taken;
    return fits;
  }

 private:
  static std::uint64_t left(std::uint64_t most, std::uint64_t used) {
    return most > used ? most - used : 0;
  }
  static bool take(std::uint64_t count, std::uint64_t left, std::uint64_t& used) {
    if (count > left) return false;
    used += count;
    return true;
  }

  Limits limits_;
  std::uint64_t bytes_ = 0;
  std::uint64_t texts_ = 0;
  std::uint64_t vertices_ = 0;
  std::uint64_t items_ = 0;
};

/// What a writer keeps to, so that readers with the usual limits take its file: as a whole, and
/// each part of it. So what a block claims beyond its own bytes counts, whatever others leave.
class WriteBudget {
 public:
  /// Takes a block or a record of documents; false if no reader would.
  bool take(std::uint64_t bytes, std::uint64_t texts, std::uint64_t items) {
    const Limits limits;
    texts_ += beyond(texts, limits.expanded_from(bytes) - limits.expanded);
    items_ += beyond(items, ReadBudget::kItemsPerByte * bytes);
    return texts_ <= limits.expanded && items_ <= ReadBudget::kFreeItems;
  }

 private:
  static std::uint64_t beyond(std::uint64_t claimed, std::uint64_t allowed) {
    return std::max(claimed, allowed) - allowed;
  }
  std::uint64_t texts_ = 0;
  std::uint64_t items_ = 0;
};

}  // namespace watertight::pipeline
