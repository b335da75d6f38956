// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <numeric>
#include <utility>
#include <vector>

#include "geometry/point.h"

namespace watertight::geometry {

/// Sets numbered by their smallest members.
struct NumberedSets {
  std::vector<Index> set_of;  // element -> set
  std::vector<Index> first;   // set -> its smallest member; increasing
};

/// Union-find with path halving; the smallest member is the root.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }
  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(Index a, Index b) {
    a = root(a);
    b = root(b);
    if (a > b) std::swap(a, b);
    parent_[b] = a;
  }
  NumberedSets numbered() {
    NumberedSets sets;
    sets.set_of.reserve(parent_.size());
    for (Index i = 0; i < parent_.size(); ++i) {
      const Index least = root(i);
      sets.set_of.push_back(least == i ? static_cast<Index>(sets.first.size())
                                       : sets.set_of[least]);
      if (least == i) sets.first.push_back(i);
    }
    return sets;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace watertight::geometry
