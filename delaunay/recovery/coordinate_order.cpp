// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/recovery/coordinate_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace watertight::delaunay {

CoordinateOrder order_of(std::span<const Point> points) {
  CoordinateOrder order;
  order.vertex_at.resize(points.size());
  std::iota(order.vertex_at.begin(), order.vertex_at.end(), Index{0});
  std::sort(order.vertex_at.begin(), order.vertex_at.end(),
            [&](Index a, Index b) { return points[a] < points[b]; });
  order.rank_of.resize(points.size());
  for (Index rank = 0; rank < points.size(); ++rank) order.rank_of[order.vertex_at[rank]] = rank;
  return order;
}

geometry::Tetrahedron normalized(geometry::Tetrahedron t) {
  bool is_odd = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto least = static_cast<std::size_t>(
        std::min_element(t.begin() + static_cast<std::ptrdiff_t>(i), t.end()) - t.begin());
    if (least == i) continue;
    std::swap(t[i], t[least]);
    is_odd = !is_odd;
  }
  if (is_odd) std::swap(t[2], t[3]);
  return t;
}

}  // namespace watertight::delaunay
