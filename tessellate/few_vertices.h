// SPDX-License-Identifier: GPL-3.0-or-later
//
// The constrained Delaunay triangulation of a simple polygon of few vertices, without the search
// structures that many vertices need.
//
// Based on: G. H. Meisters, "Polygons have ears" (1975): any triangulation; C. L. Lawson, "Software
// for C1 surface interpolation" (1977): edges are flipped until the triangulation is Delaunay. Ties
// are those of tessellate/facets.cpp, so that the result is the same.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace watertight::tessellate {

class FewVertices {
 public:
  using PlanePoint = std::array<double, 2>;
  /// Numbers of points of the ring, counterclockwise.
  using Corners = std::array<std::uint8_t, 3>;

  static constexpr std::size_t kMost = 24;

  /// The triangles of a ring of 3 to kMost points, valid until the next call. None if the ring
  /// touches or crosses itself, or has a point twice. Cost: O(n^2), seldom O(n^3).
  std::span<const Corners> triangulate(std::span<const PlanePoint> ring);

 private:
  bool is_simple() const;
  bool do_edges_meet(std::size_t i, std::size_t k) const;
  void turn_counterclockwise();
  bool clip_ears();
  bool is_ear(std::uint8_t before, std::uint8_t corner, std::uint8_t after) const;
  void add(const Corners& corners, std::size_t number);
  void flip_edges();
  bool is_flipped(std::uint8_t from, std::uint8_t to, std::uint8_t left, std::uint8_t right) const;
  std::uint8_t third(std::size_t triangle, std::uint8_t from, std::uint8_t to) const;

  static constexpr std::uint8_t kNoTriangle = 255;

  std::span<const PlanePoint> points_;
  std::vector<std::uint8_t> order_;  // the points counterclockwise; those that are left of it
  std::vector<Corners> triangles_;
  /// The triangle that has an edge, by its first and last point.
  std::array<std::array<std::uint8_t, kMost>, kMost> owner_{};
};

}  // namespace watertight::tessellate
