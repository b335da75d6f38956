// SPDX-License-Identifier: GPL-3.0-or-later
#include "unit/delaunay/sample_solids.h"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <numeric>
#include <random>

#include "tests/unit/geometry/solids.h"

namespace watertight::samples {

Solid make_solid(const Shape& shape) {
  Result<Solid> solid = Solid::make(test::arrays_of(shape.vertices, shape.shells), Lattice{}, 0);
  REQUIRE(solid.has_value());
  return std::move(*solid);
}

void add_box_facets(Shape& shape, const Point& low, const Point& high, bool is_cavity) {
  const Shell facets = test::box_shell(shape.vertices, low, high, !is_cavity);
  Shell& last = shape.shells.back();
  last.insert(last.end(), facets.begin(), facets.end());
}

void add_box(Shape& shape, const Point& low, const Point& high, bool is_cavity) {
  shape.shells.push_back(test::box_shell(shape.vertices, low, high, !is_cavity));
}

Shape box(const Point& low, const Point& high) {
  Shape shape;
  add_box(shape, low, high, false);
  return shape;
}

Shape schoenhardt() {
  // The upper triangle is the lower one turned by about 30 degrees; each side is split by the
  // diagonal that bends inward.
  Shape shape;
  shape.vertices = {{1000, 0, 0},     {-500, 866, 0},    {-500, -866, 0},
                    {866, 500, 1000}, {-866, 500, 1000}, {0, -1000, 1000}};
  Shell shell = {{{0, 2, 1}}, {{3, 4, 5}}};
  for (Index i = 0; i < 3; ++i) {
    const Index j = (i + 1) % 3;
    // A side has the lower edge (i, j), the upper edge (i + 3, j + 3) and the reflex diagonal i ->
    // j + 3.
    shell.push_back({{i, j, j + 3}});
    shell.push_back({{i, j + 3, i + 3}});
  }
  shape.shells = {shell};
  return shape;
}

Shape tunnelled_box() {
  Shape shape;
  const std::vector<std::array<double, 2>> outer = {{0, 0}, {60, 0}, {60, 60}, {0, 60}};
  const std::vector<std::array<double, 2>> inner = {{20, 20}, {40, 20}, {40, 40}, {20, 40}};
  for (const double z : {0.0, 30.0}) {
    for (const auto& [x, y] : outer) shape.vertices.push_back({x, y, z});
    for (const auto& [x, y] : inner) shape.vertices.push_back({x, y, z});
  }
  Shell shell;
  shell.push_back({{3, 2, 1, 0}, {4, 5, 6, 7}});        // the bottom, seen from below
  shell.push_back({{8, 9, 10, 11}, {15, 14, 13, 12}});  // the top
  for (Index i = 0; i < 4; ++i) {
    const Index j = (i + 1) % 4;
    shell.push_back({{i, j, j + 8, i + 8}});
    shell.push_back({{j + 4, i + 4, i + 12, j + 12}});
  }
  shape.shells = {shell};
  return shape;
}

Shape touching_pits() {
  Shape shape = box({0, 0, 0}, {90, 60, 40});
  const auto vertex_at = [&](const Point& p) {
    const auto at = std::find(shape.vertices.begin(), shape.vertices.end(), p);
    const auto place = Index(at - shape.vertices.begin());
    if (at == shape.vertices.end()) shape.vertices.push_back(p);
    return place;
  };
  const std::vector<std::array<Point, 4>> pits = {
      {{{0, 0, 40}, {30, 12, 40}, {11, 25, 40}, {14, 13, 21}}},
      {{{30, 12, 40}, {57, 20, 40}, {40, 41, 40}, {43, 24, 13}}},
      {{{90, 60, 40}, {66, 52, 40}, {79, 31, 40}, {78, 47, 19}}}};
  for (const std::array<Point, 4>& pit : pits) {
    Ring rim;
    for (std::size_t i = 0; i < 3; ++i) rim.push_back(vertex_at(pit[i]));
    const Index bottom = vertex_at(pit[3]);
    shape.shells[0][1].push_back({rim[2], rim[1], rim[0]});
    for (std::size_t i = 0; i < 3; ++i) {
      shape.shells[0].push_back({{rim[i], rim[(i + 1) % 3], bottom}});
    }
  }
  return shape;
}

Shape pits_inside_edges() {
  Shape shape = box({0, 0, 0}, {90, 60, 40});
  shape.vertices.insert(shape.vertices.end(), {{45, 0, 40},
                                               {57, 20, 40},
                                               {33, 20, 40},
                                               {44, 12, 21},
                                               {45, 20, 40},
                                               {57, 41, 40},
                                               {33, 41, 40},
                                               {46, 33, 17}});
  std::vector<Facet>& facets = shape.shells[0];
  facets[1].push_back({10, 9, 8});
  facets[1].push_back({14, 13, 12});
  facets.insert(facets.end(), {{{8, 9, 11}},
                               {{9, 12, 10, 11}},
                               {{10, 8, 11}},
                               {{12, 13, 15}},
                               {{13, 14, 15}},
                               {{14, 12, 15}}});
  Ring& front = facets[2][0];
  front.insert(std::find(front.begin(), front.end(), Index{5}) + 1, 8);
  return shape;
}

Shape warped_box(double lift) {
  Shape shape = box({0, 0, 0}, {100, 80, 50});
  shape.vertices[7].z += lift;
  return shape;
}

Shape prism(const std::vector<std::array<double, 2>>& polygon, double height) {
  Shape shape;
  const auto n = static_cast<Index>(polygon.size());
  for (const double z : {0.0, height}) {
    for (const auto& [x, y] : polygon) shape.vertices.push_back({x, y, z});
  }
  Ring top(n);
  std::iota(top.begin(), top.end(), n);
  Ring bottom(n);
  for (Index i = 0; i < n; ++i) bottom[i] = n - 1 - i;
  Shell shell = {{bottom}, {top}};
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    shell.push_back({{i, j, j + n, i + n}});
  }
  shape.shells = {shell};
  return shape;
}

Shape stairs(int steps) {
  std::vector<std::array<double, 2>> polygon = {{0, 0}};
  for (int step = 0; step < steps; ++step) {
    polygon.push_back({double(10 * (steps - step)), double(7 * step)});
    polygon.push_back({double(10 * (steps - step)), double(7 * (step + 1))});
  }
  polygon.push_back({0, double(7 * steps)});
  return prism(polygon, 25);
}

Shape shuffled(const Shape& shape, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<Index> place(shape.vertices.size());
  std::iota(place.begin(), place.end(), Index{0});
  std::shuffle(place.begin(), place.end(), generator);
  Shape result = shape;
  for (std::size_t i = 0; i < place.size(); ++i) result.vertices[place[i]] = shape.vertices[i];
  for (Shell& shell : result.shells) {
    std::shuffle(shell.begin(), shell.end(), generator);
    for (Facet& facet : shell) {
      std::shuffle(facet.begin() + 1, facet.end(), generator);
      for (Ring& ring : facet) {
        for (Index& vertex : ring) vertex = place[vertex];
        std::rotate(ring.begin(), ring.begin() + long(generator() % ring.size()), ring.end());
      }
    }
  }
  return result;
}

}  // namespace watertight::samples
