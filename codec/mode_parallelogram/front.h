// SPDX-License-Identifier: GPL-3.0-or-later
//
// The border of the part of a closed oriented surface that is known so far: loops of gates, each
// the known side of an edge whose other triangle is still missing. A triangle more is one of four
// steps. Combinatorics and the angle left at each corner; for mode parallelogram.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "codec/mode_parallelogram/vectors.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/point.h"

namespace watertight::codec::parallelogram {

/// A directed edge of a known triangle. Its corner is the one at `end`, where the next gate of the
/// loop begins.
struct Gate {
  Index start = 0;
  Index end = 0;
  Index apex = 0;  // third vertex of the known triangle
  Index previous = 0;
  Index next = 0;
  Index side = 0;             // half-edge of the known triangle
  Index half_edge = kNone;    // of the surface that is written; kNone when reading
  double room = 0;            // angle left for missing triangles at the corner
  std::uint32_t version = 0;  // counts changes of the corner
  bool is_open = true;
  bool is_refused = false;  // no triangle closes the corner
};

class SurfaceFront {
 public:
  /// `centres` are of the vertices; they grow while the front is in use.
  explicit SurfaceFront(const std::vector<Vector>& centres) : centres_(centres) {}

  const Gate& operator[](Index gate) const { return gates_[gate]; }
  Index gate_count() const { return static_cast<Index>(gates_.size()); }
  Index open_count() const { return open_count_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Half-edge 3 t + k of triangle t -> the opposite one, kNone while a gate.
  const std::vector<Index>& twin() const { return twin_; }
  /// The third vertex of the triangle beyond a half-edge, kNone while a gate.
  Index beyond(Index half_edge) const {
    const Index opposite = twin_[half_edge];
    return opposite == kNone ? kNone : geometry::corner_of(triangles_, opposite);
  }
  std::uint32_t degree(Index vertex) const { return degrees_[vertex]; }

  /// A first triangle; its half-edges when writing.
  void add_seed(const Triangle& triangle, const std::array<Index, 3>& half_edges);
  /// The triangle beyond gate `gate` has a vertex of its own. The half-edges run from the gate's
  /// start to it, and from it to the gate's end.
  void add_vertex(Index gate, Index vertex, const std::array<Index, 2>& half_edges);
  /// The triangle fills the corner of `gate`: it is also beyond the next gate. `half_edge` runs
  /// from the gate's start to the next one's end. Where the loop has three gates it ends.
  void close_corner(Index gate, Index half_edge);
  /// The triangle beyond `gate` ends at the corner of `other`, which is no neighbour of it.
  void join_corner(Index gate, Index other, const std::array<Index, 2>& half_edges);
  void refuse(Index gate) { gates_[gate].is_refused = true; }

  /// The open corner with the least room, and kNone at the end; it stays until it changes.
  Index next_corner();

 private:
  struct Waiting {
    double room = 0;
    std::uint32_t turn = 0;  // order of arrival
    Index gate = 0;
    std::uint32_t version = 0;
  };
  static bool is_later(const Waiting& a, const Waiting& b) {
    return a.room != b.room ? a.room > b.room : a.turn > b.turn;
  }
  double angle(Index at, Index from, Index to) const;
  Index add_gate(Index side, Index half_edge);
  void link(Index gate, Index next);
  void set_room(Index gate, double room);
  void forget_stale();
  bool is_stale(const Waiting& corner) const;
  /// Its first half-edge.
  Index add_triangle(const Triangle& triangle);
  void pair(Index side, Index other);
  void drop(Index gate);
  /// The gates of a triangle that ends away from its gate, the first from the start of that.
  struct NewGates {
    Index rise = 0;
    Index fall = 0;
  };
  NewGates replace_gate(Index gate, Index tip, const std::array<Index, 2>& half_edges);

  const std::vector<Vector>& centres_;
  std::deque<Gate> gates_;  // there may be many, and a deque never copies them
  std::vector<Triangle> triangles_;
  std::vector<Index> twin_;
  std::vector<std::uint32_t> degrees_;
  std::vector<Waiting> waiting_;  // a heap
  std::uint32_t turns_ = 0;
  Index open_count_ = 0;
};

}  // namespace watertight::codec::parallelogram
