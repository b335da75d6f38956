// SPDX-License-Identifier: GPL-3.0-or-later
//
// Limits on the cost of one input. Every reader, decoder and validator takes them and answers
// ErrorCode::limit_exceeded beyond them, before it allocates.
#pragma once

#include <cstdint>

#include "base/cancel.h"

namespace watertight {

/// The memory for an input is proportional to its bytes, and constants besides: `text_solids`,
/// `placed_solids`, `claimed` and `expanded`.
struct Limits {
  std::uint64_t bytes = 1ULL << 30;          // the most bytes of a document or blob
  std::uint64_t feature_bytes = 1ULL << 30;  // the most bytes of a line of a sequence, and of the
                                             // text of a feature in a Watertight file
  std::uint64_t vertices = 10'000'000;       // the most vertices of a solid (and of a feature)
  std::uint64_t facets = 10'000'000;         // the most facets of a solid
  std::uint64_t rings = 10'000'000;          // the most rings of a solid
  std::uint64_t shells = 1'000'000;          // the most shells of a solid
  std::uint64_t solids = 10'000'000;      // the most solids of a feature, unreadable parts included
  std::uint64_t text_solids = 10'000;     // see solids_of()
  std::uint64_t placed_solids = 100'000;  // see placed_solids_of()
  std::uint64_t claimed = 1'000'000;      // see claimed_by()
  std::uint64_t expanded = 64ULL << 20;   // see expanded_from()
  std::uint32_t nesting = 64;             // the deepest nesting of arrays and objects in a document
  std::uint64_t findings = 10'000;     // the most findings kept in a report; more are only counted
  const CancelPoll* cancel = nullptr;  // ends the work by ErrorCode::cancelled; null: nothing does

  bool is_cancelled() const { return cancel != nullptr && *cancel && (*cancel)(); }
  CancelPoll poll() const { return cancel == nullptr ? CancelPoll{} : *cancel; }

  /// The most solids, unreadable parts included, of a document with so many bytes of text. A closed
  /// solid takes more than 64 bytes; without facets it takes three, and a report of kilobytes.
  constexpr std::uint64_t solids_of(std::uint64_t text_bytes) const {
    return more_than(text_solids, text_bytes / 64);
  }
  /// The most solids that so many instances of geometry templates place in a feature.
  constexpr std::uint64_t placed_solids_of(std::uint64_t instances) const {
    return more_than(placed_solids, times(instances, 4));
  }
  /// The most vertices of a blob, or of all solids of a Watertight file, with so many bytes.
  constexpr std::uint64_t claimed_by(std::uint64_t bytes_of_file) const {
    return more_than(claimed, times(bytes_of_file, 8));
  }
  /// The most bytes of all texts of a Watertight file with so many bytes.
  constexpr std::uint64_t expanded_from(std::uint64_t bytes_of_file) const {
    return more_than(expanded, times(bytes_of_file, 100));
  }

 private:
  static constexpr std::uint64_t kMost = ~std::uint64_t{0};
  static constexpr std::uint64_t times(std::uint64_t count, std::uint64_t factor) {
    return count > kMost / factor ? kMost : count * factor;
  }
  static constexpr std::uint64_t more_than(std::uint64_t constant, std::uint64_t more) {
    return more > kMost - constant ? kMost : constant + more;
  }
};

/// The limits for a text that the program has read or written before.
inline constexpr Limits kOwnText{
    .bytes = ~std::uint64_t{0}, .text_solids = ~std::uint64_t{0}, .nesting = 256};

}  // namespace watertight
