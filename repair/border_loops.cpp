// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/border_loops.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace watertight::repair {
namespace {

using Edge = std::pair<Index, Index>;

/// The directed edges of facets: for each the vertex before its start in the ring, which is unique
/// unless the edge is used twice.
class Passages {
 public:
  explicit Passages(std::span<const EditedFacet> facets) {
    for (const EditedFacet& facet : facets) {
      for (const Ring& ring : facet.rings) add(ring);
    }
  }
  bool has(const Edge& edge) const { return before_.contains(edge); }
  bool is_repeated(const Edge& edge) const { return repeated_.contains(edge); }
  /// The edges without a partner of the other sense, in order.
  std::vector<Edge> open_edges() const {
    std::vector<Edge> open;
    for (const auto& [edge, before] : before_) {
      if (!has({edge.second, edge.first})) open.push_back(edge);
    }
    return open;
  }
  /// The vertex to which the missing facet goes on that comes to the start of an open edge: at the
  /// other end of the fan of facets that begins with the edge's. kNone where the fan is unclear.
  Index across_fan(Edge edge) const {
    const Index centre = edge.first;
    for (std::size_t steps = 0; steps <= before_.size(); ++steps) {
      if (is_repeated(edge)) return kNone;
      const Index before = before_.at(edge);
      const Edge next{centre, before};
      if (!has(next)) return before;
      edge = next;
    }
    return kNone;
  }

 private:
  void add(const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Edge edge{ring[i], ring[(i + 1) % ring.size()]};
      const bool is_new = before_.emplace(edge, ring[(i + ring.size() - 1) % ring.size()]).second;
      if (!is_new) repeated_.insert(edge);
    }
  }

  std::map<Edge, Index> before_;
  std::set<Edge> repeated_;
};

}  // namespace

std::vector<Ring> simple_loops_of(const Ring& walk) {
  std::vector<Ring> loops;
  Ring open;
  std::map<Index, std::size_t> place;
  for (const Index vertex : walk) {
    if (const auto found = place.find(vertex); found != place.end()) {
      const std::size_t start = found->second;
      Ring loop(open.begin() + static_cast<std::ptrdiff_t>(start), open.end());
      for (const Index passed : loop) place.erase(passed);
      open.resize(start);
      loops.push_back(std::move(loop));
    }
    place[vertex] = open.size();
    open.push_back(vertex);
  }
  if (!open.empty()) loops.push_back(std::move(open));
  return loops;
}

BorderLoops border_loops(std::span<const EditedFacet> facets) {
  const Passages passages(facets);
  // The missing facet runs against the open edges: from the second vertex of one to its first.
  std::map<Edge, Edge> next;
  const std::vector<Edge> open = passages.open_edges();
  BorderLoops result;
  for (const Edge& edge : open) {
    const Index onward = passages.is_repeated(edge) ? kNone : passages.across_fan(edge);
    if (onward != kNone) next[{edge.second, edge.first}] = {edge.first, onward};
  }
  std::set<Edge> used;
  for (const auto& [start, first] : next) {
    Ring walk;
    Edge edge = start;
    while (used.insert(edge).second) {
      walk.push_back(edge.first);
      const auto found = next.find(edge);
      if (found == next.end()) break;
      edge = found->second;
    }
    if (walk.empty()) continue;
    if (edge != start) {
      result.left_over += walk.size();
      continue;
    }
    for (Ring& loop : simple_loops_of(walk)) result.loops.push_back(std::move(loop));
  }
  result.left_over += open.size() - next.size();
  for (Ring& loop : result.loops) {
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  std::sort(result.loops.begin(), result.loops.end());
  return result;
}

}  // namespace watertight::repair
