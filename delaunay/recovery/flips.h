// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes edges and triangles part of a tetrahedralization by flips: exchanges of the tetrahedra at a
// face or around an edge for others that fill the same place. Private to delaunay/.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory_resource>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

#include "base/cancel.h"
#include "delaunay/cancellation.h"
#include "delaunay/recovery/signs.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/point.h"

namespace watertight::delaunay {

/// The triangles of a boundary and their edges, which flips and fillings leave as they are.
class KeptParts {
 public:
  /// For so many triangles, or some more.
  explicit KeptParts(std::size_t triangles) {
    faces_.reserve(triangles);
    edges_.reserve(2 * triangles);
  }
  /// Adds a triangle and its edges.
  void add(const Triangle& sorted);
  void add(const VertexPair& edge) { edges_.insert(key_of(edge)); }
  /// Takes a triangle back, but none of its edges.
  void remove(const Triangle& sorted) { faces_.erase(sorted); }
  void remove(const VertexPair& edge) { edges_.erase(key_of(edge)); }
  bool has(const Triangle& sorted) const { return faces_.contains(sorted); }
  bool has(const VertexPair& edge) const { return edges_.contains(key_of(edge)); }

 private:
  struct Hash {
    std::size_t operator()(const Triangle& t) const;
    std::size_t operator()(std::uint64_t key) const { return key * 0x9E3779B97F4A7C15ULL >> 16U; }
  };
  static std::uint64_t key_of(const VertexPair& edge) {
    return std::uint64_t{edge[0]} << 32U | edge[1];
  }

  std::pmr::monotonic_buffer_resource memory_;
  std::pmr::unordered_set<Triangle, Hash> faces_{&memory_};
  std::pmr::unordered_set<std::uint64_t, Hash> edges_{&memory_};
};

/// The most times that a ring is shortened for one edge or triangle.
inline constexpr std::size_t kShrinks = 4;

/// The most vertices around an edge that is removed.
inline constexpr std::size_t kLargestRing = 64;

/// A short list that holds its elements itself.
class RingList {
 public:
  std::size_t size() const { return size_; }
  const Index* begin() const { return items_.data(); }
  const Index* end() const { return items_.data() + size_; }
  Index operator[](std::size_t i) const { return items_[i]; }
  Index front() const { return items_[0]; }
  Index back() const { return items_[size_ - 1]; }
  void push_back(Index item) { items_[size_++] = item; }
  void push_front(Index item) {
    std::copy_backward(items_.data(), items_.data() + size_, items_.data() + size_ + 1);
    items_[0] = item;
    ++size_;
  }
  void pop_back() { --size_; }

 private:
  std::array<Index, kLargestRing> items_;
  std::size_t size_ = 0;
};

/// Each flip lowers the number of faces and edges that are in the way of the edge or triangle that
/// is wanted, or, a bounded number of times, leaves it as it is and shortens a ring. Every decision
/// is exact. The result depends on the mesh and its numbering alone.
/// Source: edge removal and 2-3 flips as in Joe, "Construction of three-dimensional
/// improved-quality triangulations using local transformations" (1995), and Si, "TetGen" (2015),
/// section 4.2. Departure: edge removal chooses among all triangulations of the ring, after
/// Klincsek (1980).
class Flips {
 public:
  /// Keeps references. At most `visits` tetrahedra are looked at in the stars of vertices and along
  /// segments.
  Flips(const std::vector<Point>& points, TetrahedronMesh& mesh, const KeptParts& kept,
        std::size_t visits, const CancelPoll& is_cancelled)
      : points_(points),
        mesh_(mesh),
        kept_(kept),
        signs_(geometry::box_of(points)),
        turns_(points, signs_),
        visits_left_(visits),
        cancellation_(is_cancelled) {}

  /// True if the visits have ended: answers may say "no" where "yes" is right.
  bool is_exhausted() const { return visits_left_ == 0; }

  /// Makes the segment between two vertices an edge, and shortens rings at most `shrinks` times.
  /// False if the flips end before, or the caller cancels.
  bool recover_edge(Index a, Index b, std::size_t shrinks = kShrinks);
  /// Makes a triangle, all edges of which are there, a face. False if the flips end before, or the
  /// caller cancels.
  bool recover_face(const Triangle& triangle);
  /// The part of a missing edge, as parameters from `a` (0) to `b` (1), in which it is best divided
  /// at the middle of the places where it crosses faces and edges. Rounded. Without `share`: from
  /// the place before the middle one to the place after it. Else from the middle place to the place
  /// beside it, and where one of the two is of an edge, that share of the way from it on: a point
  /// near the edge sees its whole ring, so that the edge can be removed.
  std::array<double, 2> middle_of_crossings(Index a, Index b, std::optional<double> share);
  /// A tetrahedron that has both vertices, or kNone.
  Index tetrahedron_at(Index a, Index b);
  bool is_face(const Triangle& triangle);
  /// The tetrahedra at a vertex. Valid until the next call of any function.
  std::span<const Index> star(Index vertex);

 private:
  /// The tetrahedra around an edge pq: (p, q, vertices[i], vertices[i + 1]) are positive. At an
  /// edge of the hull there is one vertex more than there are tetrahedra.
  struct Ring {
    VertexPair edge{};
    RingList vertices;
    RingList tetrahedra;
    bool is_open() const { return vertices.size() > tetrahedra.size(); }
  };
  /// An edge of the mesh, and a tetrahedron that has it.
  struct MeshEdge {
    VertexPair vertices{};
    Index tetrahedron = kNone;
    bool operator==(const MeshEdge& other) const { return vertices == other.vertices; }
    bool operator<(const MeshEdge& other) const { return vertices < other.vertices; }
  };
  /// A face of the mesh: that of a tetrahedron opposite to a corner.
  struct MeshFace {
    Triangle vertices{};  // sorted
    Index tetrahedron = kNone;
    std::size_t corner = 0;
    bool operator==(const MeshFace& other) const { return vertices == other.vertices; }
    bool operator<(const MeshFace& other) const { return vertices < other.vertices; }
  };
  /// The parts of the mesh through which a segment passes, sorted.
  struct Crossings {
    std::vector<MeshEdge> edges;   // crossed between their ends
    std::vector<MeshFace> faces;   // crossed in their inside
    std::vector<MeshEdge> around;  // the edges of these faces
  };
  /// Counts how many faces and edges are in the way.
  class Obstacles;
  /// Triangles between the vertices of a ring.
  class RingTriangulation;

  /// The sign of orient3d, 0 if a vertex is given twice.
  int side(Index a, Index b, Index c, Index d) const {
    if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
    return signs_.orient3d(points_[a], points_[b], points_[c], points_[d]);
  }
  double rounded_volume(Index a, Index b, Index c, Index d) const;
  double rounded_area(Index a, Index b, Index c) const;
  std::array<double, 3> rounded_product(Index a, Index b, Index c) const;
  std::optional<Ring> ring_of(const MeshEdge& edge) const;
  bool crosses_face(Index a, Index b, const Triangle& face) const;
  /// The same for the segment that turns_ began with.
  bool segment_crosses_face(Index a, Index b, const Triangle& face);
  bool segment_crosses_edge(Index a, Index b, const VertexPair& edge);
  /// True if the tetrahedron with which a part was found still has it.
  bool is_there(const MeshEdge& edge) const;
  bool is_there(const MeshFace& face) const;
  /// The first tetrahedron of the star of a vertex that belongs, or kNone.
  template <class Belongs>
  Index find_in_star(Index vertex, const Belongs& belongs);
  const Crossings& crossings(Index a, Index b);
  bool is_before(Index b, const Triangle& face);
  void add_crossed_edge(Index a, Index b, const MeshEdge& edge);
  std::vector<MeshEdge> edges_through(const Triangle& triangle);
  /// Replaces the two tetrahedra at a face by three.
  bool exchange_face(const MeshFace& face, const Obstacles& obstacles);
  /// Replaces all tetrahedra around an edge.
  bool remove_edge(const MeshEdge& edge, const Obstacles& obstacles);
  /// Takes a tetrahedron from the ring of an edge by flips around the edges beside it.
  bool shrink_ring(const MeshEdge& edge, const Obstacles& obstacles);

  const std::vector<Point>& points_;
  TetrahedronMesh& mesh_;
  const KeptParts& kept_;
  Signs signs_;
  SegmentTurns turns_;
  std::size_t visits_left_;
  Cancellation cancellation_;
  std::vector<Index> star_;
  std::vector<Index> pending_;  // tetrahedra along a segment
  Crossings found_;             // by crossings()
  std::vector<std::uint32_t> mark_of_;
  std::uint32_t mark_ = 0;
};

}  // namespace watertight::delaunay
