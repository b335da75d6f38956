// SPDX-License-Identifier: GPL-3.0-or-later
//
// Goes through the boundaries of a geometry (formats/city_json/sax.h). Internal to formats/.
#pragma once

#include <cstddef>
#include <span>

#include "formats/city_json/sax.h"

namespace watertight::formats {

class BoundaryCursor {
 public:
  BoundaryCursor() = default;
  /// Starts before the value that the tokens are: an array, or a vertex.
  explicit BoundaryCursor(std::span<const BoundaryToken> tokens) : rest_(tokens) {}

  /// Takes a value; if it is an array, calls `take_element` with the number of each element, which
  /// must take it from this cursor.
  template <class TakeElement>
  void for_each_element(TakeElement take_element) {
    if (take() != kOpen) return;
    for (std::size_t i = 0; rest_.front() != kClose; ++i) take_element(i);
    take();
  }

  /// Takes a value. The elements of an array, with the tokens of arrays within it; none of a
  /// vertex.
  std::span<const BoundaryToken> take_elements() {
    const auto all = rest_;
    std::size_t depth = 0;
    do {
      const BoundaryToken token = take();
      if (token == kOpen) ++depth;
      if (token == kClose) --depth;
    } while (depth > 0);
    const std::size_t size = all.size() - rest_.size();
    return size < 2 ? all.first(0) : all.subspan(1, size - 2);
  }

 private:
  BoundaryToken take() {
    const BoundaryToken token = rest_.front();
    rest_ = rest_.subspan(1);
    return token;
  }

  std::span<const BoundaryToken> rest_;
};

}  // namespace watertight::formats
