// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/geometry/read_soup.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>

#include <algorithm>

#include "geometry/predicates/predicates.h"

namespace watertight::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

std::optional<Soup> read_soup(const std::string& file) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
  if (!CGAL::IO::read_polygon_soup(file, points, polygons)) return std::nullopt;
  std::vector<Point> source;
  for (const auto& p : points) source.push_back({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0});
  Soup soup;
  soup.name = file.substr(file.find_last_of('/') + 1);
  soup.points = source;
  std::sort(soup.points.begin(), soup.points.end());
  soup.points.erase(std::unique(soup.points.begin(), soup.points.end()), soup.points.end());
  const auto merged = [&](std::size_t vertex) {
    return static_cast<Index>(
        std::lower_bound(soup.points.begin(), soup.points.end(), source[vertex]) -
        soup.points.begin());
  };
  for (const auto& polygon : polygons) {
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      const Triangle t{merged(polygon[0]), merged(polygon[i - 1]), merged(polygon[i])};
      if (geometry::are_collinear(soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]))
        continue;
      soup.triangles.push_back(t);
    }
  }
  return soup;
}

}  // namespace watertight::bench
