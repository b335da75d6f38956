// SPDX-License-Identifier: GPL-3.0-or-later
//
// The edges that a triangulation of a domain may use although another part of the hole uses them
// too: sets of them say which triangulations can be joined. Internal to fill/.
// Source: Zou, Ju and Carr 2013, sections 3.2.2 and 3.2.3.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fill/domain.h"

namespace watertight::fill {

/// A set of weak edges of a domain, a bit for each of its list.
using WeakSet = std::uint64_t;

/// The weak edges of a domain: candidate edges between ends of its segments, the two ends of one
/// segment included, except its spanning edges and edges of loops. Ascending; at most 60.
std::vector<EdgeNumber> weak_edges(const Borders& borders, const Candidates& candidates,
                                   const Domain& domain);

/// A part of a divided domain, with its weak edges.
struct PartEdges {
  const Domain* domain = nullptr;
  std::span<const EdgeNumber> weak;
};

/// Joins sets of weak edges of the two parts of a divided domain (definition 3.1 of the paper).
class Joiner {
 public:
  /// `second.domain` is null where there is one part.
  Joiner(EdgeNumber access, std::span<const EdgeNumber> weak, const PartEdges& first,
         const PartEdges& second);

  /// False if the parts share a spanning edge, or one of them has the access edge.
  bool can_join() const { return can_join_; }
  /// The weak edges of the divided domain that triangulations with these sets use together; nothing
  /// if an edge would be used twice. Requires can_join().
  std::optional<WeakSet> join(WeakSet first, WeakSet second) const;

 private:
  static constexpr std::uint8_t kNowhere = 0xFF;
  struct Part {
    WeakSet forbidden = 0;
    std::vector<std::uint8_t> place;  // weak edge of the part -> weak edge of the divided domain
  };
  static Part part_of(EdgeNumber access, std::span<const EdgeNumber> weak, const PartEdges& part,
                      const Domain* other);
  static WeakSet moved(WeakSet set, const std::vector<std::uint8_t>& place);

  bool can_join_ = true;
  bool is_trivial_ = false;
  Part first_;
  Part second_;
  std::vector<std::uint8_t> second_in_first_;  // weak edge of the second part -> of the first
  WeakSet always_ = 0;                         // used whatever the sets are
};

}  // namespace watertight::fill
