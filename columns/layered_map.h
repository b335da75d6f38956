// SPDX-License-Identifier: GPL-3.0-or-later
//
// A map whose first entries many share: copies of it cost little. Internal to columns/.
#pragma once

#include <functional>
#include <memory>
#include <unordered_map>
#include <utility>

namespace watertight::columns {

template <class Key, class Value, class Hasher = std::hash<Key>>
class LayeredMap {
 public:
  /// The value of a key; null for an unknown one.
  const Value* find(const Key& key) const {
    if (const auto own = own_.find(key); own != own_.end()) return &own->second;
    if (shared_ == nullptr) return nullptr;
    const auto shared = shared_->find(key);
    return shared == shared_->end() ? nullptr : &shared->second;
  }
  /// The value of a key, to be changed; a new one for an unknown key. It stays where it is.
  Value& operator[](const Key& key) {
    const auto [own, is_new] = own_.try_emplace(key);
    if (is_new && shared_ != nullptr) {
      if (const auto shared = shared_->find(key); shared != shared_->end()) {
        own->second = shared->second;
      }
    }
    return own->second;
  }
  /// Makes all entries shared ones: a copy costs little until it is changed.
  void share() {
    if (own_.empty()) return;
    if (shared_ != nullptr) own_.insert(shared_->begin(), shared_->end());
    shared_ = std::make_shared<const Map>(std::exchange(own_, {}));
  }

 private:
  using Map = std::unordered_map<Key, Value, Hasher>;
  std::shared_ptr<const Map> shared_;
  Map own_;  // entries that are new or were changed
};

}  // namespace watertight::columns
