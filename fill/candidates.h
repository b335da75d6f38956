// SPDX-License-Identifier: GPL-3.0-or-later
//
// The triangles from which a filling is chosen, by edge, with the direction of each triangle around
// each of its edges.
// Source: Zou, Ju and Carr 2013, section 4: all triples of vertices, or the Delaunay triangles.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fill/borders.h"

namespace watertight::fill {

using EdgeNumber = std::uint32_t;
inline constexpr EdgeNumber kNoEdge = 0xFFFFFFFF;

class Candidates {
 public:
  /// Requires triangles of ascending vertices in lexicographic order, each once, none of them
  /// degenerate. Cost: linear; 18 bytes a triangle.
  Candidates(const Borders& borders, std::span<const std::array<Vertex, 3>> triangles);

  /// The edge between two vertices; kNoEdge where no triangle has it.
  EdgeNumber edge(Vertex a, Vertex b) const {
    const Vertex lower = std::min(a, b);
    const Vertex upper = std::max(a, b);
    const std::uint32_t begin = lowers_[lower];
    const std::uint32_t count = lowers_[lower + 1U] - begin;
    // Where every larger vertex is joined to this one its number gives the place.
    if (count + lower + 1 == borders_.size()) return begin + (upper - lower - 1U);
    return found_edge(lower, upper);
  }
  /// The third vertices of the triangles on an edge, ascending.
  std::span<const Vertex> thirds(EdgeNumber edge) const {
    return {thirds_.data() + begins_[edge], begins_[edge + 1] - begins_[edge]};
  }
  /// The directions of these triangles around the edge, from its smaller vertex to its larger one.
  std::span<const Turn> turns(EdgeNumber edge) const {
    return {turns_.data() + begins_[edge], begins_[edge + 1] - begins_[edge]};
  }
  /// The direction of one of them, on the edge between two vertices.
  Turn turn(EdgeNumber edge, Vertex a, Vertex b, Vertex third) const;
  /// The direction of any vector that is not along the edge.
  Turn turn_of(EdgeNumber edge, const geometry::Vector3& direction) const;
  /// The area of a triangle in units of area_unit(), rounded.
  std::uint64_t area(Vertex a, Vertex b, Vertex c) const;
  /// Square metres: a power of two, about 2^-32 of the square of the loops' size.
  double area_unit() const { return area_unit_; }
  std::size_t edge_count() const { return uppers_.size(); }
  std::size_t bytes() const;

 private:
  /// Two directions across an edge, at right angles.
  struct Frame {
    geometry::Vector3 right{};
    geometry::Vector3 up{};
  };
  EdgeNumber found_edge(Vertex lower, Vertex upper) const;
  Frame frame_of(Vertex from, Vertex to) const;
  void list_edges(std::span<const std::array<Vertex, 3>> triangles);
  void list_thirds(std::span<const std::array<Vertex, 3>> triangles);

  const Borders& borders_;
  std::vector<std::uint32_t> lowers_;  // vertex -> its first edge to a larger vertex
  std::vector<Vertex> uppers_;         // edge -> its larger vertex; ascending for each smaller one
  std::vector<std::uint32_t> begins_;  // edge -> its first triangle
  std::vector<Vertex> thirds_;
  std::vector<Turn> turns_;
  double area_unit_ = 1;
};

}  // namespace watertight::fill
