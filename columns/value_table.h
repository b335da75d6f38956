// SPDX-License-Identifier: GPL-3.0-or-later
//
// The different texts of a list, numbered in order of their first appearance. Internal to columns/.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace watertight::columns {

class ValueTable {
 public:
  ValueTable() = default;
  ValueTable(const ValueTable& other) { *this = other; }
  ValueTable& operator=(const ValueTable& other) {
    if (this == &other) return *this;
    shared_ = other.shared_;
    numbers_.clear();
    texts_.clear();
    for (const std::string& text : other.texts_) add(text);
    return *this;
  }

  std::optional<std::uint32_t> find(std::string_view text) const {
    if (const auto found = numbers_.find(text); found != numbers_.end()) return found->second;
    return shared_ == nullptr ? std::nullopt : shared_->find(text);
  }
  /// The number of a text, which is added if it is new.
  std::uint32_t add(std::string text) {
    if (const auto known = find(text)) return *known;
    const std::uint32_t number = size();
    numbers_.emplace(texts_.emplace_back(std::move(text)), number);
    return number;
  }
  const std::string& text(std::uint32_t number) const {
    const std::uint32_t shared = shared_size();
    return number < shared ? shared_->texts_[number] : texts_[number - shared];
  }
  std::uint32_t size() const { return shared_size() + static_cast<std::uint32_t>(texts_.size()); }

  /// Makes all texts ones that copies share: a copy costs little until texts are added.
  void share() {
    auto all = std::make_shared<ValueTable>();
    for (std::uint32_t number = 0; number < size(); ++number) all->add(text(number));
    *this = ValueTable();
    shared_ = std::move(all);
  }

 private:
  std::uint32_t shared_size() const {
    return shared_ == nullptr ? 0 : static_cast<std::uint32_t>(shared_->texts_.size());
  }

  std::shared_ptr<const ValueTable> shared_;  // has no shared texts itself
  std::deque<std::string> texts_;  // a deque, so that the keys of `numbers_` stay where they are
  std::unordered_map<std::string_view, std::uint32_t> numbers_;
};

}  // namespace watertight::columns
