// SPDX-License-Identifier: GPL-3.0-or-later
//
// The representations of stored features that were asked for last, so that none is made twice while
// it is in demand. Internal to server/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "server/transport/http.h"

namespace watertight::server {

/// Keeps whole answers by key, at most `bytes` of them together; the one that was not used for the
/// longest time goes first. A key or the answer names the version of the feature, so that nobody
/// takes an answer that is out of date. Thread-safe.
class RepresentationCache {
 public:
  using Answer = std::shared_ptr<const Response>;

  explicit RepresentationCache(std::size_t bytes) : most_(bytes) {}
  /// The answer that was kept under `key`; null if there is none.
  Answer find(const std::string& key);
  /// Keeps an answer, in the place of that with the same key, unless it is larger than an eighth of
  /// the cache.
  void keep(const std::string& key, Answer answer);

 private:
  struct Entry {
    std::string key;
    Answer answer;
  };
  static std::size_t size_of(const Entry& entry);

  const std::size_t most_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // the one that was used last comes first
  std::unordered_map<std::string, std::list<Entry>::iterator> places_;
  std::size_t bytes_ = 0;
};

}  // namespace watertight::server
