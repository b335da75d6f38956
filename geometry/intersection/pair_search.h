// SPDX-License-Identifier: GPL-3.0-or-later
//
// The intersecting pairs of the triangles of one part of space: one piece of the box partition's
// work, done by one thread. Private to geometry/ (it includes CGAL).
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "geometry/intersection/box_partition.h"
#include "geometry/intersection/leaf_comparer.h"
#include "geometry/intersection/pair_tester.h"
#include "geometry/intersection/slab_partition.h"

namespace watertight::geometry {

/// The data that all pieces of one search read, and the means to end it.
struct SearchContext {
  std::span<const Point> points;
  std::span<const Triangle> triangles;
  std::span<const BoxMember<3>> boxes;  // the box of each triangle
  PairTester tester;
  std::span<const Index> group_of;  // a copy of IntersectionOptions::group_of
  std::uint64_t limit = 0;
  CancelPoll cancel;  // a function that only the caller's thread calls
  std::atomic<bool> is_ended = false;
  std::atomic<bool> is_cancelled = false;

  bool are_of_one_group(Index a, Index b) const {
    return !group_of.empty() && group_of[a] == group_of[b];
  }

  void ask() {
    if (!cancel || is_ended || !cancel()) return;
    is_cancelled = true;
    is_ended = true;
  }
};

class PairSearch {
 public:
  PairSearch(SearchContext& context, bool is_caller) : context_(context), is_caller_(is_caller) {}

  /// The intersecting pairs of the members, sorted, as far as the low corner of the overlap of
  /// their boxes lies within the bounds: all such pairs, or at least `limit` of them, unless
  /// another thread ends the search.
  std::vector<IntersectingPair> run(std::span<const BoxMember<3>> members,
                                    const PartBounds<3>& bounds);

 private:
  /// The triangles of a part that no division of space separates.
  struct Stalled {
    std::vector<Index> first;
    std::vector<Index> second;
    bool is_within = true;
    bool may_have_hub = true;
    PartBounds<3> bounds;
  };

  void divide_space(std::span<const BoxMember<3>> members, const PartBounds<3>& bounds);
  void resolve(Stalled stalled);
  bool resolve_hub(Stalled& stalled);
  void resolve_along_axes(const Stalled& stalled);
  void divide_directions(const std::vector<BoxMember<6>>& first,
                         const std::vector<BoxMember<6>>& second, const Stalled& stalled);
  template <std::size_t D>
  bool compare(const PartMembers<D>& members, const PartBounds<D>& bounds,
               const PartBounds<3>& outer);
  template <std::size_t D>
  static Stalled stalled_part(const PartMembers<D>& members);
  bool goes_on(std::size_t comparisons);

  SearchContext& context_;
  bool is_caller_;
  std::vector<Stalled> stalled_;
  std::vector<PlaneTriangle> first_planes_;
  std::vector<PlaneTriangle> second_planes_;
  std::vector<IntersectingPair> pairs_;
  std::uint64_t most_pairs_ = 0;   // at this number of pairs, repeated pairs are removed
  std::uint64_t comparisons_ = 0;  // the number of comparisons since the last check for the end
};

}  // namespace watertight::geometry
