// SPDX-License-Identifier: GPL-3.0-or-later
//
// The different texts of a list, numbered in order of their first appearance. Internal to columns/.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace watertight::columns {

class ValueTable {
 public:
  ValueTable() = default;
  ValueTable(const ValueTable& other) {
    for (const std::string& text : other.texts_) add(text);
  }
  ValueTable& operator=(const ValueTable&) = delete;

  std::optional<std::uint32_t> find(std::string_view text) const {
    const auto found = numbers_.find(text);
    if (found == numbers_.end()) return std::nullopt;
    return found->second;
  }
  /// The number of a text, which is added if it is new.
  std::uint32_t add(std::string text) {
    if (const auto known = find(text)) return *known;
    const std::uint32_t number = size();
    numbers_.emplace(texts_.emplace_back(std::move(text)), number);
    return number;
  }
  const std::string& text(std::uint32_t number) const { return texts_[number]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(texts_.size()); }

 private:
  std::deque<std::string> texts_;  // a deque, so that the keys of `numbers_` stay where they are
  std::unordered_map<std::string_view, std::uint32_t> numbers_;
};

}  // namespace watertight::columns
