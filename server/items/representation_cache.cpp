// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/items/representation_cache.h"

#include <utility>

namespace watertight::server {

std::size_t RepresentationCache::size_of(const Entry& entry) {
  constexpr std::size_t kNodes = 256;  // about the bytes of the list's and the map's nodes
  return entry.answer->body.size() + 2 * entry.key.size() + kNodes;
}

RepresentationCache::Answer RepresentationCache::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  const auto place = places_.find(key);
  if (place == places_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, place->second);
  return place->second->answer;
}

void RepresentationCache::keep(const std::string& key, Answer answer) {
  Entry entry{key, std::move(answer)};
  const std::size_t size = size_of(entry);
  if (size > most_ / 8) return;
  const std::lock_guard lock(mutex_);
  if (const auto former = places_.find(key); former != places_.end()) {
    bytes_ -= size_of(*former->second);
    entries_.erase(former->second);
    places_.erase(former);
  }
  entries_.push_front(std::move(entry));
  places_[key] = entries_.begin();
  bytes_ += size;
  while (bytes_ > most_) {
    bytes_ -= size_of(entries_.back());
    places_.erase(entries_.back().key);
    entries_.pop_back();
  }
}

}  // namespace watertight::server
