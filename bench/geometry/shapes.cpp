// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/geometry/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/random.h"

namespace watertight::bench {
namespace {

/// Merges equal points into one vertex.
void merge(Soup& soup) {
  std::vector<Point> sorted = soup.points;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  for (Triangle& triangle : soup.triangles) {
    for (Index& vertex : triangle) {
      vertex = static_cast<Index>(
          std::lower_bound(sorted.begin(), sorted.end(), soup.points[vertex]) - sorted.begin());
    }
  }
  soup.points = std::move(sorted);
}

/// The six faces of the cube [-n, n]^3 as grids of 2 x (2n)^2 triangles each, turned outward.
Soup cube_grid(int half) {
  Soup soup;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const auto first = static_cast<Index>(soup.points.size());
      const int count = 2 * half + 1;
      for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
          Point p;
          p[axis] = side * half;
          p[(axis + 1) % 3] = i - half;
          p[(axis + 2) % 3] = j - half;
          soup.points.push_back(p);
        }
      }
      for (int i = 0; i + 1 < count; ++i) {
        for (int j = 0; j + 1 < count; ++j) {
          const auto at = [&](int a, int b) { return first + static_cast<Index>(a * count + b); };
          Triangle lower{at(i, j), at(i + 1, j), at(i + 1, j + 1)};
          Triangle upper{at(i, j), at(i + 1, j + 1), at(i, j + 1)};
          if (side < 0) std::swap(lower[1], lower[2]);
          if (side < 0) std::swap(upper[1], upper[2]);
          soup.triangles.push_back(lower);
          soup.triangles.push_back(upper);
        }
      }
    }
  }
  merge(soup);
  return soup;
}

int half_for(std::size_t count) {
  return std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(count) / 48.0))));
}

void add_triangle(Soup& soup, const std::array<Point, 3>& corners) {
  const auto first = static_cast<Index>(soup.points.size());
  soup.points.insert(soup.points.end(), corners.begin(), corners.end());
  soup.triangles.push_back({first, first + 1, first + 2});
}

}  // namespace

Soup bumpy_sphere(std::size_t count) {
  Soup soup = cube_grid(half_for(count));
  soup.name = "bumpy sphere";
  const double half = half_for(count);
  for (Point& p : soup.points) {
    std::array<double, 3> direction{};
    double length = 0;
    for (int axis = 0; axis < 3; ++axis) {
      // Equal angles make the triangles about equally large.
      const auto at = static_cast<std::size_t>(axis);
      direction[at] = std::tan(0.78539816339744831 * p[axis] / half);
      length += direction[at] * direction[at];
    }
    length = std::sqrt(length);
    for (double& component : direction) component /= length;
    const double bumps =
        std::sin(17 * direction[0]) * std::cos(13 * direction[1]) * std::sin(11 * direction[2]);
    const double radius = 1e7 * (1 + 0.1 * bumps);
    for (int axis = 0; axis < 3; ++axis) {
      p[axis] = std::round(radius * direction[static_cast<std::size_t>(axis)]) + 0.0;
    }
  }
  return soup;
}

Soup grid_box(std::size_t count) {
  Soup soup = cube_grid(half_for(count));
  soup.name = "grid box";
  for (Point& p : soup.points) p = {p.x * 1000 + 1e8, p.y * 1000 + 1e8, p.z * 1000 + 1e8};
  return soup;
}

Soup comb(std::size_t teeth) {
  Soup soup;
  soup.name = "comb";
  const auto length = static_cast<double>(4 * teeth);
  soup.points = {{0, 0, 100}, {length, 0, 100}};
  for (std::size_t i = 0; i < teeth; ++i) {
    const auto first = static_cast<Index>(soup.points.size());
    const double x = static_cast<double>(4 * i);
    soup.points.push_back({x + 1, 0, 0});
    soup.points.push_back({x + 3, 0, 0});
    soup.points.push_back({x + 2, 0, -1000});
    soup.triangles.push_back({first, first + 2, first + 1});
    const Index corner = i < teeth / 2 ? 0 : 1;
    soup.triangles.push_back({corner, first, first + 1});
    if (i + 1 < teeth) soup.triangles.push_back({corner, first + 1, first + 3});
    if (i + 1 == teeth / 2) soup.triangles.push_back({0, first + 3, 1});
  }
  return soup;
}

Soup cone(std::size_t count) {
  Soup soup;
  soup.name = "cone";
  soup.points.push_back({0, 0, 1e6});
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(count);
    soup.points.push_back({std::round(1e9 * std::cos(angle)), std::round(1e9 * std::sin(angle)),
                           static_cast<double>(i % 5)});
    const auto next = static_cast<Index>(i + 1 == count ? 1 : i + 2);
    soup.triangles.push_back({0, static_cast<Index>(i + 1), next});
  }
  return soup;
}

Soup star(std::size_t count) {
  Soup soup;
  soup.name = "star";
  const auto on_circle = [&](double radius, double step) {
    const double angle = 6.283185307179586 * step / static_cast<double>(count);
    const double x = std::round(radius * std::cos(angle));
    const double y = std::round(radius * std::sin(angle));
    return Point{x, y, x + 2 * y};
  };
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<double>(i);
    add_triangle(soup, {on_circle(5e8, at), on_circle(1e9, at + 0.5), on_circle(5e8, at + 1)});
  }
  merge(soup);
  return soup;
}

Soup diagonal_needles(std::size_t count) {
  Soup soup;
  soup.name = "diagonal needles";
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<double>(10 * (i % side));
    const auto y = static_cast<double>(10 * (i / side));
    const double length = 1e6;
    add_triangle(soup, {Point{x, y, 0}, Point{x + 2, y + 1, 1},
                        Point{x + length, y + 2 * length, 3 * length}});
  }
  return soup;
}

Soup oblique_sheets(std::size_t count) {
  Soup soup;
  soup.name = "oblique sheets";
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<double>(i);
    add_triangle(soup, {Point{1e7 + at, 0, 0}, Point{0, 1e7 + at, 0}, Point{0, 0, 1e7 + at}});
  }
  return soup;
}

Soup random_needles(std::size_t count) {
  Soup soup;
  soup.name = "random needles";
  test::Random random(7);
  const auto coordinate = [&] {
    return static_cast<double>(random.between(-100'000'000, 100'000'000));
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Point from{coordinate(), coordinate(), coordinate()};
    add_triangle(soup, {from, Point{from.x + 3, from.y - 2, from.z + 1},
                        Point{coordinate(), coordinate(), coordinate()}});
  }
  return soup;
}

}  // namespace watertight::bench
