// SPDX-License-Identifier: GPL-3.0-or-later
//
// The surface that the walk of mode walk knows so far: its triangles as half-edges, which are open
// where no triangle beyond them is known yet. Private to the walk.
#pragma once

#include <array>
#include <vector>

#include "geometry/mesh/half_edges.h"
#include "geometry/point.h"

namespace watertight::codec::walk {

class WalkFront {
 public:
  explicit WalkFront(Index vertex_count)
      : head_(vertex_count, kNone),
        open_count_(vertex_count, 0),
        component_of_(vertex_count, kNone) {}

  std::vector<Triangle> triangles;
  std::vector<Index> twin;  // half-edge -> twin, kNone if open; 3 t + k leaves corner k of triangle
                            // t

  /// Starts a new component. Triangles are joined only to triangles of the same component.
  void start_component() { ++component_; }
  /// Adds a triangle and joins its half-edges to open ones. Requires that the half-edges are
  /// unused.
  void add(const Triangle& triangle);

  Index from(Index half_edge) const { return geometry::start_of(triangles, half_edge); }
  Index to(Index half_edge) const { return geometry::end_of(triangles, half_edge); }
  Index corner(Index half_edge) const { return geometry::corner_of(triangles, half_edge); }
  bool is_open(Index half_edge) const { return twin[half_edge] == kNone; }

  /// The first half-edge of the present component that leaves `v`, or kNone; next_at() returns the
  /// other ones.
  Index first_at(Index v) const { return is_used(v) ? head_[v] : kNone; }
  Index next_at(Index half_edge) const { return next_[half_edge]; }
  /// The half-edge of the present component from a to b, kNone if unused.
  Index find(Index a, Index b) const {
    Index h = first_at(a);
    while (h != kNone && to(h) != b) h = next_[h];
    return h;
  }
  /// is_used(): the present component has a triangle at `v`; is_known(): any component has one.
  bool is_used(Index v) const { return component_of_[v] == component_; }
  bool is_known(Index v) const { return component_of_[v] != kNone; }
  /// True if `v` is used and all half-edges of the present component at `v` have twins.
  bool is_closed(Index v) const { return is_used(v) && open_count_[v] == 0; }
  /// The number of half-edges without twin, in all components.
  std::size_t open_edges() const { return open_edges_; }

 private:
  Index component_ = kNone;  // the present component; start_component() makes the first one 0
  std::vector<Index> next_;  // half-edge -> the half-edge added before it at the same vertex
  std::vector<Index> head_;
  std::vector<Index> open_count_;
  std::vector<Index> component_of_;  // vertex -> the last component that used it
  std::size_t open_edges_ = 0;
};

inline void WalkFront::add(const Triangle& triangle) {
  const auto first = static_cast<Index>(3 * triangles.size());
  for (const Index v : triangle) {
    if (is_used(v)) continue;
    component_of_[v] = component_;
    head_[v] = kNone;
    open_count_[v] = 0;
  }
  std::array<Index, 3> opposite{};
  for (std::size_t k = 0; k < 3; ++k) opposite[k] = find(triangle[(k + 1) % 3], triangle[k]);
  triangles.push_back(triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    const Index a = triangle[k];
    const Index b = triangle[(k + 1) % 3];
    const Index half_edge = first + static_cast<Index>(k);
    twin.push_back(opposite[k]);
    if (opposite[k] == kNone) {
      ++open_edges_;
      ++open_count_[a];
      ++open_count_[b];
    } else {
      twin[opposite[k]] = half_edge;
      --open_edges_;
      --open_count_[a];
      --open_count_[b];
    }
    next_.push_back(head_[a]);
    head_[a] = half_edge;
  }
}

}  // namespace watertight::codec::walk
