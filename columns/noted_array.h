// SPDX-License-Identifier: GPL-3.0-or-later
//
// An array that notes which of its elements change, so that a copy becomes equal to its original
// again in the time of the changes, not of its size. Internal to columns/.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace watertight::columns {

/// Notes changes by blocks of elements. A copy begins without changes.
template <class T>
class NotedArray {
 public:
  static constexpr int kBlockBits = 4;

  NotedArray() = default;
  NotedArray(std::size_t size, const T& value)
      : values_(size, value), changed_(blocks_of(size), kUnchanged) {}
  NotedArray(const NotedArray& other)
      : values_(other.values_), changed_(other.changed_.size(), kUnchanged) {}
  NotedArray(NotedArray&&) noexcept = default;
  NotedArray& operator=(const NotedArray& other) {
    values_ = other.values_;
    changed_.assign(other.changed_.size(), kUnchanged);
    is_replaced_ = false;
    return *this;
  }
  NotedArray& operator=(NotedArray&&) noexcept = default;
  ~NotedArray() = default;

  std::size_t size() const { return values_.size(); }
  bool empty() const { return values_.empty(); }
  const T& operator[](std::size_t index) const { return values_[index]; }
  /// An element that may be changed; so may the others of its block.
  T& change(std::size_t index) {
    changed_[index >> kBlockBits] = kChanged;
    return values_[index];
  }
  void push_back(const T& value) {
    values_.push_back(value);
    changed_.resize(blocks_of(values_.size()), kChanged);
  }
  /// Takes other elements, and returns those that it had.
  std::vector<T> replace(std::vector<T> values) {
    std::swap(values, values_);
    changed_.assign(blocks_of(values_.size()), kChanged);
    is_replaced_ = true;
    return values;
  }
  /// Makes this copy of an array equal to it again. Requires that the original has not changed
  /// since. Cost: linear in the changes, and a byte for each block; a copy once replaced.
  void revert(const NotedArray& original) {
    if (is_replaced_) {
      *this = original;
      return;
    }
    values_.resize(original.size());
    changed_.resize(original.changed_.size());
    for (std::size_t block = 0; (block = changed_.find(kChanged, block)) != std::string::npos;
         ++block) {
      changed_[block] = kUnchanged;
      const std::size_t begin = block << kBlockBits;
      const std::size_t end = std::min(begin + (std::size_t{1} << kBlockBits), values_.size());
      for (std::size_t i = begin; i < end; ++i) values_[i] = original.values_[i];
    }
  }

 private:
  static constexpr char kUnchanged = 0;
  static constexpr char kChanged = 1;
  static std::size_t blocks_of(std::size_t size) {
    return (size + (std::size_t{1} << kBlockBits) - 1) >> kBlockBits;
  }

  std::vector<T> values_;
  std::string changed_;  // for each block whether it may have changed
  bool is_replaced_ = false;
};

}  // namespace watertight::columns
