// SPDX-License-Identifier: GPL-3.0-or-later
//
// The weights of domains, each computed once. Internal to fill/.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fill/weak_edges.h"

namespace watertight::fill {

/// The weight that is minimised; `tie`, an area, decides between equal sums.
struct Weight {
  std::uint64_t sum = 0;
  std::uint64_t tie = 0;
  friend auto operator<=>(const Weight&, const Weight&) = default;
  friend Weight operator+(const Weight& a, const Weight& b) {
    return {a.sum + b.sum, a.tie + b.tie};
  }
};

/// The least weight of a triangulation of a domain with a given triangle on its access edge and
/// given weak edges, without the angle on the access edge.
struct WeighedTriangle {
  WeakSet weak = 0;
  Weight weight;
  Turn turn = 0;  // the direction of the triangle around the access edge, turned by half a turn
  Vertex third = 0;
};

/// The least weight of a triangulation with given weak edges, and its triangle on the access edge.
struct Answer {
  WeakSet weak = 0;
  Weight weight;
  Weight beyond;  // the weight without the angle on the access edge
  Vertex third = 0;
};

class DomainTable {
 public:
  using Number = std::uint32_t;
  static constexpr Number kUnknown = 0xFFFFFFFF;

  /// For domains of so many vertices.
  DomainTable(std::size_t vertex_count, bool has_angles, bool keeps_all_sets);

  /// The number of a domain, whatever is behind its first spanning edge; kUnknown if it was not
  /// added. Cost: constant.
  Number find(const Domain& domain) const;
  /// The number of the domain between an edge and the segment of a loop from its head to its tail,
  /// which follows the loop; kUnknown if it was not added or is not listed. Cost: constant.
  Number find_segment(Vertex tail, Vertex head) const {
    return segments_.empty() ? kUnknown : segments_[tail * vertex_count_ + head];
  }
  /// Adds a domain. Of the triangles it keeps those that are the best for some triangle behind.
  /// Cost: O(n log n) for each set of weak edges, and each pair of sets with a subset.
  void add(const Domain& domain, std::span<const EdgeNumber> weak,
           std::vector<WeighedTriangle>& triangles);

  std::span<const EdgeNumber> weak_edges(Number number) const;
  /// The least weight of a domain without weak edges, as answer() has it; nothing without one.
  std::optional<Weight> least_weight(Number number, std::optional<Turn> behind) const;
  /// Appends the least weight for each set of weak edges that is worth it, where the triangle
  /// behind the access edge has a direction, or for any direction.
  void answer(Number number, std::optional<Turn> behind, std::vector<Answer>& answers) const;

  std::size_t domain_count() const { return domains_.size(); }
  std::size_t set_count() const { return sets_.size(); }
  std::size_t bytes() const;

 private:
  using Key = std::array<std::uint64_t, kMostLoops>;
  struct Record {
    std::uint32_t key = 0;   // its first word in keys_
    std::uint32_t weak = 0;  // its first weak edge in weak_; that of the next record is the end
    std::uint32_t set = 0;   // its first set in sets_; that of the next record is the end
  };
  struct Set {
    WeakSet weak = 0;
    std::uint32_t triangle = 0;  // its first triangle in triangles_; that of the next is the end
  };
  struct Kept {
    Weight weight;
    Turn turn = 0;
    Vertex third = 0;
  };

  static Key key_of(const Domain& domain);
  static std::size_t hash_of(const Key& key, std::size_t size);
  const Kept& best_of(std::span<const Kept> kept, std::optional<Turn> behind) const;
  bool has_key(Number number, const Key& key, std::size_t size) const;
  void grow();
  std::span<const Kept> kept(std::size_t set) const;
  Weight at_turn(const Kept& kept, Turn turn) const;
  const Kept& nearest(std::span<const Kept> kept, Turn turn) const;
  void keep_best_by_turn(std::vector<Kept>& list) const;
  void drop_heavier(std::size_t first_set, WeakSet weak, std::vector<Kept>& list) const;

  std::size_t vertex_count_;
  bool has_angles_;
  bool keeps_all_sets_;
  std::vector<Number> segments_;  // tail, head -> number; empty for many vertices
  std::vector<Number> slots_;     // open addressing; kUnknown is free
  std::vector<std::uint64_t> keys_;
  std::vector<EdgeNumber> weak_;
  std::vector<Record> domains_;
  std::vector<Set> sets_;
  std::vector<Kept> triangles_;
  std::vector<Kept> list_;  // kept for its memory
};

}  // namespace watertight::fill
