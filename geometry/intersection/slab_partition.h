// SPDX-License-Identifier: GPL-3.0-or-later
//
// Divides boxes into parts small enough to compare pair by pair. Space is cut into slabs, again and
// again, along the direction in which the boxes are smallest relative to the part; a box goes into
// every slab that it reaches. Private to geometry/.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/intersection/box_member.h"

namespace watertight::geometry {

/// The members of one part. If `is_within`, a pair has two members of `first`; else a pair has one
/// member of `first` and one of `second`.
template <std::size_t D>
struct PartMembers {
  std::span<const BoxMember<D>> first;
  std::span<const BoxMember<D>> second;
  bool is_within = true;

  double pairs() const {
    const auto a = static_cast<double>(first.size());
    const auto b = static_cast<double>(second.size());
    return is_within ? 0.5 * a * a : a * b;
  }
};

/// Parallel planes across one direction: slab s holds the values v with planes[s] <= v < planes[s +
/// 1]; the first and the last slab also hold all values beyond the outer planes.
struct Slabs {
  static constexpr std::size_t kMost = 16;
  std::size_t axis = 0;
  std::size_t count = 0;
  float start = 0;
  float per_length = 0;
  std::array<float, kMost + 1> planes{};

  std::size_t slab_of(float value) const {
    const float place = (value - start) * per_length;
    std::size_t slab =
        place > 0 ? std::min(static_cast<std::size_t>(place), count - 1) : std::size_t{0};
    // The slab found by multiplication is a guess; the planes decide.
    while (slab > 0 && value < planes[slab]) --slab;
    while (slab + 1 < count && value >= planes[slab + 1]) ++slab;
    return slab;
  }
};

/// For each slab, the number of members of PartMembers::first and PartMembers::second that reach
/// it.
struct SlabCounts {
  std::array<std::size_t, Slabs::kMost> first{};
  std::array<std::size_t, Slabs::kMost> second{};
};

template <std::size_t D>
class SlabDivider {
 public:
  /// Parts with fewer pairs are not divided.
  static constexpr double kFewPairs = 0.5 * 72 * 72;
  /// A division is worth its copies of members if it leaves at most this share of the pairs. The
  /// limit also bounds the work: all undivided parts together never have more pairs than the
  /// undivided whole.
  static constexpr double kLargestShareOfPairs = 0.8;

  /// Finds slabs that save work. False if there are none.
  bool find(const PartMembers<D>& members, const PartBounds<D>& bounds) {
    measure(members, bounds);
    std::array<std::size_t, D> axes{};
    for (std::size_t i = 0; i < D; ++i) axes[i] = i;
    std::stable_sort(axes.begin(), axes.end(),
                     [&](std::size_t a, std::size_t b) { return layers(a) > layers(b); });
    for (const std::size_t axis : axes) {
      if (place_even_planes(axis, bounds, members) && saves_work(members)) return true;
    }
    for (const std::size_t axis : axes) {
      if (place_planes_at_ends(axis, bounds, members) && saves_work(members)) return true;
    }
    return false;
  }

  const Slabs& slabs() const { return slabs_; }
  const SlabCounts& counts() const { return counts_; }

  PartBounds<D> bounds_of(std::size_t slab, const PartBounds<D>& bounds) const {
    PartBounds<D> result = bounds;
    if (slab > 0) result.low[slabs_.axis] = slabs_.planes[slab];
    if (slab + 1 < slabs_.count) result.high[slabs_.axis] = slabs_.planes[slab + 1];
    return result;
  }

  bool is_empty(std::size_t slab, bool is_within) const {
    return is_within ? counts_.first[slab] < 2
                     : counts_.first[slab] == 0 || counts_.second[slab] == 0;
  }

  /// Writes each member into every slab that it reaches. `place(slab)` returns a pointer to which
  /// the next member of the slab is written.
  template <class Place>
  void distribute(std::span<const BoxMember<D>> members, Place place) const {
    for (const BoxMember<D>& member : members) {
      const std::size_t last = slabs_.slab_of(member.high[slabs_.axis]);
      for (std::size_t slab = slabs_.slab_of(member.low[slabs_.axis]); slab <= last; ++slab) {
        *place(slab) = member;
      }
    }
  }

 private:
  double pairs_of(std::size_t slab, const PartMembers<D>& members) const {
    const auto a = static_cast<double>(counts_.first[slab]);
    const auto b = static_cast<double>(counts_.second[slab]);
    return members.is_within ? 0.5 * a * a : a * b;
  }

  /// The number of boxes of the mean length that fit beside each other along an axis.
  float layers(std::size_t axis) const {
    return (last_[axis] - first_[axis]) / (extent_[axis] + 1e-30F);
  }

  void measure(const PartMembers<D>& members, const PartBounds<D>& bounds) {
    first_.fill(std::numeric_limits<float>::max());
    last_.fill(-std::numeric_limits<float>::max());
    extent_.fill(0);
    for (const auto side : {members.first, members.second}) {
      for (const BoxMember<D>& member : side) {
        for (std::size_t axis = 0; axis < D; ++axis) {
          const float low = std::max(member.low[axis], bounds.low[axis]);
          const float high = std::min(member.high[axis], bounds.high[axis]);
          const float centre = 0.5F * (low + high);
          first_[axis] = std::min(first_[axis], centre);
          last_[axis] = std::max(last_[axis], centre);
          extent_[axis] += high - low;
        }
      }
    }
    const auto count = static_cast<float>(members.first.size() + members.second.size());
    for (float& extent : extent_) extent /= count;
  }

  /// Places planes at equal distances, so that each slab is a few mean box lengths thick. False if
  /// such slabs divide nothing.
  bool place_even_planes(std::size_t axis, const PartBounds<D>& bounds,
                         const PartMembers<D>& members) {
    constexpr float kExtentsPerSlab = 4;
    constexpr float kShortest = 1e-30F;
    const float length = last_[axis] - first_[axis];
    if (!(length > kShortest)) return false;
    slabs_.axis = axis;
    slabs_.count = slab_count(std::min(layers(axis) / kExtentsPerSlab, most_slabs(members)));
    slabs_.start = first_[axis];
    slabs_.per_length = static_cast<float>(slabs_.count) / length;
    for (std::size_t i = 0; i <= slabs_.count; ++i) {
      slabs_.planes[i] =
          first_[axis] + length * (static_cast<float>(i) / static_cast<float>(slabs_.count));
    }
    return are_inside(bounds);
  }

  /// Places planes so that each slab has about the same number of ends of boxes: for boxes of very
  /// different lengths or distances. False if such slabs divide nothing.
  bool place_planes_at_ends(std::size_t axis, const PartBounds<D>& bounds,
                            const PartMembers<D>& members) {
    constexpr std::size_t kSamples = 256;
    ends_.clear();
    for (const auto side : {members.first, members.second}) {
      const std::size_t stride = side.size() / kSamples + 1;
      for (std::size_t i = 0; i < side.size(); i += stride) {
        for (const float end : {side[i].low[axis], side[i].high[axis]}) {
          if (end > bounds.low[axis] && end < bounds.high[axis]) ends_.push_back(end);
        }
      }
    }
    if (ends_.empty()) return false;
    std::sort(ends_.begin(), ends_.end());
    slabs_.axis = axis;
    slabs_.count = slab_count(most_slabs(members));
    slabs_.start = 0;
    slabs_.per_length = 0;
    for (std::size_t i = 0; i <= slabs_.count; ++i) {
      slabs_.planes[i] = ends_[i * (ends_.size() - 1) / slabs_.count];
    }
    return are_inside(bounds);
  }

  /// True if the first and the last plane between slabs lie inside the part. A plane on the border
  /// of the part divides nothing.
  bool are_inside(const PartBounds<D>& bounds) const {
    return slabs_.planes[1] > bounds.low[slabs_.axis] &&
           slabs_.planes[slabs_.count - 1] < bounds.high[slabs_.axis];
  }

  static float most_slabs(const PartMembers<D>& members) {
    constexpr float kMembersPerSlab = 16;
    return static_cast<float>(members.first.size() + members.second.size()) / kMembersPerSlab;
  }

  static std::size_t slab_count(float wanted) {
    return static_cast<std::size_t>(std::clamp(wanted, 2.0F, static_cast<float>(Slabs::kMost)));
  }

  bool saves_work(const PartMembers<D>& members) {
    count(members);
    double left = 0;
    for (std::size_t slab = 0; slab < slabs_.count; ++slab) left += pairs_of(slab, members);
    return left <= kLargestShareOfPairs * members.pairs();
  }

  void count(const PartMembers<D>& members) {
    counts_ = {};
    const auto tally = [&](std::span<const BoxMember<D>> side, auto& counts) {
      for (const BoxMember<D>& member : side) {
        const std::size_t last = slabs_.slab_of(member.high[slabs_.axis]);
        for (std::size_t slab = slabs_.slab_of(member.low[slabs_.axis]); slab <= last; ++slab) {
          ++counts[slab];
        }
      }
    };
    tally(members.first, counts_.first);
    tally(members.second, counts_.second);
  }

  std::array<float, D> first_{};   // the least middle of a box on each axis
  std::array<float, D> last_{};    // the largest middle of a box on each axis
  std::array<float, D> extent_{};  // the mean length of the boxes on each axis
  std::vector<float> ends_;
  Slabs slabs_;
  SlabCounts counts_;
};

/// Divides members until no division saves work, and gives each part to `visit(members, bounds)`,
/// which returns false to end the division. Parts are visited depth first, from the last slab to
/// the first: the order depends on the members only.
template <std::size_t D, class Visit>
class SlabPartition {
 public:
  explicit SlabPartition(Visit visit) : visit_(visit) {}

  void run(const PartMembers<D>& members, const PartBounds<D>& bounds) {
    members_.assign(members.first.begin(), members.first.end());
    members_.insert(members_.end(), members.second.begin(), members.second.end());
    parts_ = {{bounds, 0, members.first.size(), members_.size()}};
    is_within_ = members.is_within;
    while (!parts_.empty()) {
      const Part part = parts_.back();
      parts_.pop_back();
      const PartMembers<D> inside = members_of(part);
      if (inside.pairs() > SlabDivider<D>::kFewPairs && divider_.find(inside, part.bounds)) {
        divide(part);
      } else {
        if (!visit_(inside, part.bounds)) return;
        members_.resize(part.begin);
      }
    }
  }

 private:
  struct Part {
    PartBounds<D> bounds;
    /// PartMembers::first has the indices from `begin` to `middle`, PartMembers::second the indices
    /// from `middle` to `end`.
    std::size_t begin = 0;
    std::size_t middle = 0;
    std::size_t end = 0;
  };

  PartMembers<D> members_of(const Part& part) const {
    const std::span<const BoxMember<D>> all(members_);
    return {all.subspan(part.begin, part.middle - part.begin),
            all.subspan(part.middle, part.end - part.middle), is_within_};
  }

  /// Replaces a part, whose members are at the end of members_, by its slabs.
  void divide(const Part& part) {
    divided_.assign(members_.begin() + static_cast<std::ptrdiff_t>(part.begin), members_.end());
    members_.resize(part.begin);
    std::array<std::size_t, Slabs::kMost> first{};
    std::array<std::size_t, Slabs::kMost> second{};
    std::size_t end = part.begin;
    for (std::size_t slab = 0; slab < divider_.slabs().count; ++slab) {
      if (divider_.is_empty(slab, is_within_)) {
        first[slab] = second[slab] = kNowhere;
        continue;
      }
      first[slab] = end;
      second[slab] = end + divider_.counts().first[slab];
      end = second[slab] + divider_.counts().second[slab];
      parts_.push_back({divider_.bounds_of(slab, part.bounds), first[slab], second[slab], end});
    }
    members_.resize(end);
    const std::span<const BoxMember<D>> divided(divided_);
    const std::size_t middle = part.middle - part.begin;
    BoxMember<D> dropped;
    const auto into = [&](auto& places) {
      return [&](std::size_t slab) {
        return places[slab] == kNowhere ? &dropped : &members_[places[slab]++];
      };
    };
    divider_.distribute(divided.first(middle), into(first));
    divider_.distribute(divided.subspan(middle), into(second));
  }

  static constexpr std::size_t kNowhere = ~std::size_t{0};

  Visit visit_;
  bool is_within_ = true;
  SlabDivider<D> divider_;
  /// The members of all parts in `parts_`, part by part, from the bottom of the stack to the top.
  std::vector<BoxMember<D>> members_;
  std::vector<BoxMember<D>> divided_;  // the members of the part that is being divided
  std::vector<Part> parts_;            // a stack of the parts that are still to be compared
};

}  // namespace watertight::geometry
