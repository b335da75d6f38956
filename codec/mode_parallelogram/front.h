// SPDX-License-Identifier: GPL-3.0-or-later
//
// The border of the known part of a closed oriented surface: loops of gates. A gate is the known
// side of an edge whose other triangle is still missing. Each of four functions adds a triangle.
// The front knows the connectivity and the room at each corner. For mode parallelogram.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "codec/mode_parallelogram/vectors.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/point.h"

namespace watertight::codec::parallelogram {

/// A directed edge of a known triangle. The corner of the gate is at `end`, where the next gate of
/// the loop begins.
struct Gate {
  Index start = 0;
  Index end = 0;
  Index apex = 0;  // third vertex of the known triangle
  Index previous = 0;
  Index next = 0;
  Index side = 0;             // the half-edge of the known triangle
  Index half_edge = kNone;    // this half-edge in the surface that is written; kNone when reading
  double room = 0;            // angle left for missing triangles at the corner
  std::uint32_t version = 0;  // the number of changes of the corner
  bool is_open = true;
  bool is_refused = false;  // true: no triangle closes the corner
};

class SurfaceFront {
 public:
  /// `centres` are the positions of the vertices; there are more of them as the front advances.
  explicit SurfaceFront(const std::vector<Vector>& centres) : centres_(centres) {}

  const Gate& operator[](Index gate) const { return gates_[gate]; }
  Index gate_count() const { return static_cast<Index>(gates_.size()); }
  Index open_count() const { return open_count_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// Half-edge -> its twin, kNone while it is a gate. Half-edge 3 t + k belongs to triangle t.
  const std::vector<Index>& twin() const { return twin_; }
  /// The third vertex of the triangle beyond a half-edge, kNone while the half-edge is a gate.
  Index beyond(Index half_edge) const {
    const Index opposite = twin_[half_edge];
    return opposite == kNone ? kNone : geometry::corner_of(triangles_, opposite);
  }
  std::uint32_t degree(Index vertex) const { return degrees_[vertex]; }

  /// Adds the first triangle of a component. `half_edges` are its edges in the surface written.
  void add_seed(const Triangle& triangle, const std::array<Index, 3>& half_edges);
  /// Adds a triangle beyond `gate` with a new vertex. `half_edges` run from the gate's start to the
  /// vertex, and from the vertex to the gate's end.
  void add_vertex(Index gate, Index vertex, const std::array<Index, 2>& half_edges);
  /// Adds the triangle that fills the corner of `gate`: it is also beyond the next gate.
  /// `half_edge` runs from the start of `gate` to the end of the next gate. A loop of three gates
  /// ends.
  void close_corner(Index gate, Index half_edge);
  /// Adds a triangle beyond `gate` that ends at the corner of `other`, which is not beside `gate`.
  void join_corner(Index gate, Index other, const std::array<Index, 2>& half_edges);
  void refuse(Index gate) { gates_[gate].is_refused = true; }

  /// Returns the open corner with the least room, kNone if no corner is open. The corner stays in
  /// the queue until it changes.
  Index next_corner();

 private:
  struct Waiting {
    double room = 0;
    std::uint32_t turn = 0;  // the order of arrival in the queue
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
  /// Returns the first half-edge of the new triangle.
  Index add_triangle(const Triangle& triangle);
  void pair(Index side, Index other);
  void drop(Index gate);
  /// The gates of a new triangle: `rise` from the start of its gate, `fall` to the end of its gate.
  struct NewGates {
    Index rise = 0;
    Index fall = 0;
  };
  NewGates replace_gate(Index gate, Index tip, const std::array<Index, 2>& half_edges);

  const std::vector<Vector>& centres_;
  std::deque<Gate> gates_;  // a deque, since it never copies its elements
  std::vector<Triangle> triangles_;
  std::vector<Index> twin_;
  std::vector<std::uint32_t> degrees_;
  std::vector<Waiting> waiting_;  // the corners of the queue, as a heap
  std::uint32_t turns_ = 0;
  Index open_count_ = 0;
};

}  // namespace watertight::codec::parallelogram
