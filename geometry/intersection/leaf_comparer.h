// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds the pairs of overlapping boxes in a part that is not divided any more: compares a box with
// four others at a time. Private to geometry/.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "geometry/intersection/slab_partition.h"

namespace watertight::geometry {

/// The bounds of boxes, in one array for each direction and side. The arrays are padded to whole
/// blocks of four with boxes that overlap nothing.
template <std::size_t D>
class BoxColumns {
 public:
  void fill(std::span<const BoxMember<D>> members) {
    size_ = members.size();
    const std::size_t padded = (size_ + 3) / 4 * 4;
    for (std::size_t axis = 0; axis < D; ++axis) {
      low_[axis].resize(padded);
      high_[axis].resize(padded);
      for (std::size_t i = 0; i < size_; ++i) {
        low_[axis][i] = members[i].low[axis];
        high_[axis][i] = members[i].high[axis];
      }
      for (std::size_t i = size_; i < padded; ++i) {
        low_[axis][i] = std::numeric_limits<float>::max();
        high_[axis][i] = -std::numeric_limits<float>::max();
      }
    }
  }

  /// Calls visit(j) for each j >= first, ascending, whose box overlaps the member's.
  template <class Visit>
  void for_overlapping(const BoxMember<D>& member, std::size_t first, Visit visit) const {
    for (std::size_t block = first / 4 * 4; block < size_; block += 4) {
      const Mask mask = overlapping(member, block);
      std::array<std::uint64_t, 2> halves{};
      std::memcpy(halves.data(), &mask, sizeof(mask));
      if ((halves[0] | halves[1]) == 0) continue;
      unsigned lanes = lane_bits(halves[0]) | lane_bits(halves[1]) << 2U;
      if (block < first) lanes &= ~0U << (first - block);
      for (; lanes != 0; lanes &= lanes - 1) {
        visit(block + static_cast<std::size_t>(std::countr_zero(lanes)));
      }
    }
  }

 private:
  using Floats [[gnu::vector_size(16)]] = float;
  using Mask [[gnu::vector_size(16)]] = std::int32_t;

  /// One bit for each of two lanes of a mask, whose bits are all ones or all zeros. The order of
  /// bytes on the machine does not matter.
  static unsigned lane_bits(std::uint64_t half) {
    std::array<std::uint32_t, 2> lanes{};
    std::memcpy(lanes.data(), &half, sizeof(half));
    return (lanes[0] & 1U) | (lanes[1] & 2U);
  }

  static Floats load(const float* values) {
    Floats result;
    std::memcpy(&result, values, sizeof(result));
    return result;
  }

  Mask overlapping(const BoxMember<D>& member, std::size_t block) const {
    Mask mask = load(&low_[0][block]) <= member.high[0];
    mask &= load(&high_[0][block]) >= member.low[0];
    for (std::size_t axis = 1; axis < D; ++axis) {
      mask &= load(&low_[axis][block]) <= member.high[axis];
      mask &= load(&high_[axis][block]) >= member.low[axis];
    }
    return mask;
  }

  std::size_t size_ = 0;
  std::array<std::vector<float>, D> low_;
  std::array<std::vector<float>, D> high_;
};

}  // namespace watertight::geometry
