// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rows that never change and that many features refer to, kept in memory: kinds, dictionaries, and
// the digests of headers. A read of a feature so asks for its own row only.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "base/bytes.h"
#include "base/result.h"
#include "base/shared_text.h"
#include "packing/text_dictionary.h"
#include "store/connection.h"

namespace watertight::store {

/// What the features of one kind have in common.
struct RowKind {
  std::string type;
  std::string format;
  SharedText header;
};

/// Holds some 128 MiB: forgets everything when there is more. Keys are never used twice, so nothing
/// that it holds can become wrong. Thread-safe.
class SharedRows {
 public:
  struct Found {
    std::map<std::int64_t, RowKind> kinds;
    std::map<std::int64_t, packing::DictionaryPointer> dictionaries;  // null for key 0
  };
  /// The kinds and dictionaries of these keys; asks the database for those that are not held. A key
  /// without a row is not found. Errors: those of the session and of TextDictionary::of().
  Result<Found> find(DatabaseSession& connection, std::span<const std::int64_t> kinds,
                     std::span<const std::int64_t> dictionaries);

  /// The newest dictionary of a collection as it was read some seconds ago; nothing when that is
  /// longer ago.
  std::optional<packing::DictionaryPointer> newest(const std::string& collection) const;
  void set_newest(const std::string& collection, const packing::DictionaryPointer& dictionary);

  /// The SHA-256 of a header; empty for an unknown one.
  Bytes digest(const SharedText& header) const;
  void add_digest(const SharedText& header, const Bytes& digest);

  /// The key of the row in which a collection has this dictionary; 0 for an unknown one.
  std::int64_t key_of(const std::string& collection,
                      const packing::DictionaryPointer& dictionary) const;
  void add_key(const std::string& collection, const packing::DictionaryPointer& dictionary,
               std::int64_t key);
  /// Forgets what key_of() and newest() return: a collection may have been removed meanwhile, or
  /// the transaction that wrote a row may have failed.
  void forget_keys();

 private:
  using Clock = std::chrono::steady_clock;
  void make_room(std::size_t bytes);  // requires the lock
  Status read_kinds(DatabaseSession& connection, std::span<const std::int64_t> keys, Found& found);
  Status read_dictionaries(DatabaseSession& connection, std::span<const std::int64_t> keys,
                           Found& found);

  mutable std::mutex mutex_;
  std::map<std::int64_t, RowKind> kinds_;
  std::set<SharedText> headers_;  // one copy of each
  std::map<std::int64_t, packing::DictionaryPointer> dictionaries_;
  std::map<std::string, std::pair<packing::DictionaryPointer, Clock::time_point>> newest_;
  std::map<SharedText, Bytes> digests_;
  std::map<std::pair<std::string, packing::DictionaryPointer>, std::int64_t> keys_;
  std::size_t bytes_ = 0;
};

}  // namespace watertight::store
