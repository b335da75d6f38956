// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/rows/shared_rows.h"

#include <vector>

namespace watertight::store {
namespace {

constexpr std::size_t kMostBytes = 128 << 20;
constexpr std::size_t kRowBytes = 256;
constexpr std::chrono::seconds kFresh{5};

}  // namespace

Result<SharedRows::Found> SharedRows::find(DatabaseSession& connection,
                                           std::span<const std::int64_t> kinds,
                                           std::span<const std::int64_t> dictionaries) {
  Found found;
  std::vector<std::int64_t> missing_kinds;
  std::vector<std::int64_t> missing_dictionaries;
  {
    const std::lock_guard lock(mutex_);
    for (const std::int64_t key : kinds) {
      if (found.kinds.contains(key)) continue;
      const auto held = kinds_.find(key);
      if (held == kinds_.end()) missing_kinds.push_back(key);
      if (held != kinds_.end()) found.kinds.insert(*held);
    }
    for (const std::int64_t key : dictionaries) {
      if (found.dictionaries.contains(key)) continue;
      const auto held = dictionaries_.find(key);
      if (key == 0) found.dictionaries[0] = nullptr;
      if (held != dictionaries_.end()) found.dictionaries.insert(*held);
      if (key != 0 && held == dictionaries_.end()) missing_dictionaries.push_back(key);
    }
  }
  if (!missing_kinds.empty()) {
    if (Status done = read_kinds(connection, missing_kinds, found); !done) {
      return std::move(done).error();
    }
  }
  if (!missing_dictionaries.empty()) {
    if (Status done = read_dictionaries(connection, missing_dictionaries, found); !done) {
      return std::move(done).error();
    }
  }
  return found;
}

Status SharedRows::read_kinds(DatabaseSession& connection, std::span<const std::int64_t> keys,
                              Found& found) {
  const Result<Rows> rows = connection.ask(
      "SELECT k.key::int8, k.type, k.format, d.content FROM watertight.kind k"
      " JOIN watertight.document d ON d.key = k.document WHERE k.key = ANY($1)",
      Parameters().int8_array(keys));
  if (!rows) return rows.error();
  const std::lock_guard lock(mutex_);
  for (int row = 0; row < rows->size(); ++row) {
    const auto [header, is_new] = headers_.emplace(std::string(rows->text(row, 3)));
    const RowKind kind{std::string(rows->text(row, 1)), std::string(rows->text(row, 2)), *header};
    found.kinds[rows->int8(row, 0)] = kind;
    make_room(kRowBytes + (is_new ? kind.header.str().size() : 0));
    kinds_[rows->int8(row, 0)] = kind;
  }
  return Done{};
}

Status SharedRows::read_dictionaries(DatabaseSession& connection,
                                     std::span<const std::int64_t> keys, Found& found) {
  const Result<Rows> rows =
      connection.ask("SELECT key::int8, content FROM watertight.dictionary WHERE key = ANY($1)",
                     Parameters().int8_array(keys));
  if (!rows) return rows.error();
  for (int row = 0; row < rows->size(); ++row) {
    const ByteView content = as_bytes(rows->text(row, 1));
    auto made = packing::TextDictionary::of({content.begin(), content.end()});
    if (!made) return std::move(made).error();
    found.dictionaries[rows->int8(row, 0)] = *made;
    const std::lock_guard lock(mutex_);
    make_room(packing::kDictionaryMemory);
    dictionaries_.try_emplace(rows->int8(row, 0), *std::move(made));
  }
  return Done{};
}

std::optional<packing::DictionaryPointer> SharedRows::newest(const std::string& collection) const {
  const std::lock_guard lock(mutex_);
  const auto found = newest_.find(collection);
  if (found == newest_.end() || Clock::now() > found->second.second + kFresh) return std::nullopt;
  return found->second.first;
}

void SharedRows::set_newest(const std::string& collection,
                            const packing::DictionaryPointer& dictionary) {
  const std::lock_guard lock(mutex_);
  make_room(kRowBytes);
  newest_[collection] = {dictionary, Clock::now()};
}

Bytes SharedRows::digest(const SharedText& header) const {
  const std::lock_guard lock(mutex_);
  const auto found = digests_.find(header);
  return found == digests_.end() ? Bytes() : found->second;
}

void SharedRows::add_digest(const SharedText& header, const Bytes& digest) {
  const std::lock_guard lock(mutex_);
  if (header.str().size() > kMostBytes) return;
  make_room(kRowBytes + header.str().size());
  digests_.try_emplace(header, digest);
}

std::int64_t SharedRows::key_of(const std::string& collection,
                                const packing::DictionaryPointer& dictionary) const {
  const std::lock_guard lock(mutex_);
  const auto found = keys_.find({collection, dictionary});
  return found == keys_.end() ? 0 : found->second;
}

void SharedRows::add_key(const std::string& collection,
                         const packing::DictionaryPointer& dictionary, std::int64_t key) {
  const std::lock_guard lock(mutex_);
  make_room(packing::kDictionaryMemory);
  keys_[{collection, dictionary}] = key;
  dictionaries_.try_emplace(key, dictionary);
}

void SharedRows::forget_keys() {
  const std::lock_guard lock(mutex_);
  keys_.clear();
  newest_.clear();
}

void SharedRows::make_room(std::size_t bytes) {
  if (bytes_ + bytes > kMostBytes) {
    kinds_.clear();
    headers_.clear();
    dictionaries_.clear();
    newest_.clear();
    digests_.clear();
    keys_.clear();
    bytes_ = 0;
  }
  bytes_ += bytes;
}

}  // namespace watertight::store
