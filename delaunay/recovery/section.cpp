// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/recovery/section.h"

#include <algorithm>

#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {

Section::Section(std::span<const Point> points, const Triangle& triangle,
                 const geometry::Tetrahedron& tetrahedron)
    : points_(points), triangle_(triangle), tetrahedron_(tetrahedron) {
  const auto& [a, b, c] = triangle;
  for (std::size_t i = 0; i < 4; ++i) side_[i] = orientation(a, b, c, tetrahedron[i]);
}

bool Section::meets_inside() const {
  if (!meets_plane() || is_beyond_a_face({0, 1, 2})) return false;
  for (std::size_t edge = 0; edge < 3; ++edge) {
    if (range_beside(edge)[1] <= 0) return false;
  }
  return true;
}

bool Section::meets_edge(std::size_t edge) const {
  if (!meets_plane() || is_beyond_a_face({edge, (edge + 1) % 3, edge})) return false;
  const auto [least, most] = range_beside(edge);
  return least <= 0 && most >= 0;
}

int Section::orientation(Index a, Index b, Index c, Index d) const {
  if (a == d || b == d || c == d || a == c || b == c) return 0;
  return geometry::orient3d(points_[a], points_[b], points_[c], points_[d]);
}

bool Section::meets_plane() const {
  const auto [least, most] = std::minmax_element(side_.begin(), side_.end());
  return *least <= 0 && *most >= 0;
}

/// True if these corners of the triangle are not inside a face of the tetrahedron, nor all on it.
bool Section::is_beyond_a_face(const std::array<std::size_t, 3>& corners) const {
  for (std::size_t face = 0; face < 4; ++face) {
    const auto [a, b, c] = inward_face(tetrahedron_, face);
    int least = 0;
    int most = -1;
    for (const std::size_t corner : corners) {
      const int side = orientation(a, b, c, triangle_[corner]);
      least = std::min(least, side);
      most = std::max(most, side);
    }
    if (most <= 0 && least < 0) return true;
  }
  return false;
}

/// The least and the largest side of the tetrahedron's section on the line of an edge of the
/// triangle; the triangle itself is on the side +1.
std::array<int, 2> Section::range_beside(std::size_t edge) const {
  const Index p = triangle_[edge];
  const Index q = triangle_[(edge + 1) % 3];
  std::array<int, 2> range{1, -1};
  const auto add = [&](int side) { range = {std::min(range[0], side), std::max(range[1], side)}; };
  const auto off = static_cast<std::size_t>(
      std::find_if(side_.begin(), side_.end(), [](int side) { return side != 0; }) - side_.begin());
  for (std::size_t i = 0; i < 4; ++i) {
    if (side_[i] == 0) add(orientation(p, q, tetrahedron_[i], tetrahedron_[off]) * side_[off]);
    for (std::size_t j = 0; j < 4; ++j) {
      if (side_[i] > 0 && side_[j] < 0) {
        add(orientation(p, q, tetrahedron_[j], tetrahedron_[i]));
      }
    }
  }
  return range;
}

}  // namespace watertight::delaunay
