// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/recovery/divided_edges.h"

#include <algorithm>

namespace watertight::delaunay {

DividedEdges::Part DividedEdges::part_of(const VertexPair& edge) const {
  const auto found = parts_.find(edge);
  return found == parts_.end() ? Part{edge, {0, 1}} : found->second;
}

std::optional<PlacedPoint> DividedEdges::place_on(const std::vector<Point>& points,
                                                  const VertexPair& edge,
                                                  const std::array<double, 2>& places) const {
  const Part part = part_of(edge);
  const auto [from, to] = part.places;
  const double one = from + places[0] * (to - from);
  const double other = from + places[1] * (to - from);
  const Point& p = points[part.whole[0]];
  const Point& q = points[part.whole[1]];
  const auto placed = point_between(p, q, {std::min(one, other), std::max(one, other)});
  return placed ? placed : point_at(p, q, (from + to) / 2);
}

void DividedEdges::divide(const VertexPair& edge, Index vertex, double place) {
  const Part part = part_of(edge);
  for (const std::size_t end : {0U, 1U}) {
    parts_.insert_or_assign({edge[end], vertex}, Part{part.whole, {part.places[end], place}});
  }
  parts_.erase(edge);
}

}  // namespace watertight::delaunay
