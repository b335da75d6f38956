// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/reference/pmp_oracle.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <array>
#include <iterator>
#include <utility>
#include <vector>

namespace watertight {

std::size_t count_pmp_intersections(std::span<const Point> vertices,
                                    std::span<const Triangle> triangles) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> points;
  points.reserve(vertices.size());
  for (const Point& p : vertices) points.emplace_back(p.x, p.y, p.z);
  std::vector<std::array<std::size_t, 3>> soup;
  soup.reserve(triangles.size());
  for (const Triangle& t : triangles) soup.push_back({t[0], t[1], t[2]});
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  CGAL::Polygon_mesh_processing::triangle_soup_self_intersections(points, soup,
                                                                  std::back_inserter(pairs));
  return pairs.size();
}

}  // namespace watertight
