// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/facet_rings.h"

#include <algorithm>
#include <utility>

#include "geometry/mesh/half_edges.h"

namespace watertight::geometry {
namespace {

class RingWalk {
 public:
  RingWalk(std::span<const Triangle> triangles, std::span<const Index> inner_twin)
      : triangles_(triangles), inner_twin_(inner_twin), is_done_(inner_twin.size(), false) {}

  std::vector<FacetRing> run() {
    for (Index h = 0; h < inner_twin_.size(); ++h) {
      if (inner_twin_[h] == kNone && !is_done_[h]) split(h / 3, boundary_from(h));
    }
    return std::move(rings_);
  }

 private:
  /// Follows the boundary of a facet from one of its half-edges until it closes. At a vertex the
  /// walk turns through the triangles of the facet to the next half-edge on the boundary. It cannot
  /// turn for ever: each step of a turn can be undone, and undoing them leads back to the half-edge
  /// on the boundary at which the turn began.
  std::vector<Index> boundary_from(Index start) {
    std::vector<Index> boundary;
    Index h = start;
    do {
      is_done_[h] = true;
      boundary.push_back(start_of(triangles_, h));
      h = next_half_edge(h);
      while (inner_twin_[h] != kNone) h = next_half_edge(inner_twin_[h]);
    } while (h != start);
    return boundary;
  }

  /// Splits a boundary at vertices that it visits twice. The vertices go to a stack; when a vertex
  /// is on the stack already, the vertices from there to the top are a ring.
  void split(Index triangle, std::vector<Index> boundary) {
    std::vector<Index> sorted = boundary;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) {
      add(triangle, std::move(boundary));
      return;
    }
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    std::vector<bool> is_on_stack(sorted.size(), false);
    const auto index_of = [&](Index vertex) {
      return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), vertex) -
                                      sorted.begin());
    };
    std::vector<Index> stack;
    for (const Index vertex : boundary) {
      if (is_on_stack[index_of(vertex)]) {
        auto begin = stack.end() - 1;
        while (*begin != vertex) --begin;
        for (auto above = begin; above != stack.end(); ++above) {
          is_on_stack[index_of(*above)] = false;
        }
        add(triangle, {begin, stack.end()});
        stack.erase(begin, stack.end());
      }
      is_on_stack[index_of(vertex)] = true;
      stack.push_back(vertex);
    }
    add(triangle, std::move(stack));
  }

  void add(Index triangle, std::vector<Index> ring) {
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    rings_.push_back({triangle, std::move(ring)});
  }

  std::span<const Triangle> triangles_;
  std::span<const Index> inner_twin_;
  std::vector<bool> is_done_;
  std::vector<FacetRing> rings_;
};

}  // namespace

std::vector<FacetRing> facet_rings(std::span<const Triangle> triangles,
                                   std::span<const Index> inner_twin) {
  return RingWalk(triangles, inner_twin).run();
}

}  // namespace watertight::geometry
