// SPDX-License-Identifier: GPL-3.0-or-later
//
// How fast functions over triangulations are computed, and how long the least bent filling of a
// hole takes: spline_speed [POINTS [EDGES]]. A disc of EDGES border edges with a round hole is
// filled; the functions at random points are computed by the table of shared parts and by the
// definition, term by term; sums of all differences are printed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "spline/dms_surface.h"
#include "spline/extend_triangulation.h"
#include "spline/knot_clouds.h"
#include "spline/thin_plate.h"

namespace {

using namespace watertight;
using spline::Index;
using spline::Point;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<Point> circle(int edges, double radius) {
  std::vector<Point> polygon;
  for (int i = 0; i < edges; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / edges;
    polygon.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  return polygon;
}

template <class Value>
Value require(Result<Value> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "spline_speed: %s\n", to_string(result.error()).c_str());
  std::exit(1);
}

struct Scene {
  spline::DmsDomain domain;
  std::vector<Index> hole;
};

/// A ring between two circles, whose inner circle is filled.
Scene scene_of(int edges) {
  const std::vector<std::vector<Point>> ring{circle(edges, 2), circle(edges / 2, 1)};
  spline::ExtendedTriangulation mesh = require(spline::extend_triangulation(ring));
  const std::vector<Point> fixed = require(spline::make_clouds(mesh.vertices, mesh.triangles));
  const std::vector<std::vector<Point>> inner{circle(edges / 2, 1)};
  const spline::ExtendedTriangulation fill = require(spline::extend_triangulation(inner));
  const auto ring_triangles = static_cast<Index>(mesh.triangles.size());
  const auto ring_vertices = static_cast<Index>(mesh.vertices.size());
  const auto border = static_cast<Index>(edges / 2);
  const auto number = [&](Index v) {
    return v < border ? static_cast<Index>(edges) + v : ring_vertices + v - border;
  };
  for (const auto& [a, b, c] : fill.triangles)
    mesh.triangles.push_back({number(a), number(b), number(c)});
  mesh.vertices.insert(mesh.vertices.end(), fill.vertices.begin() + border, fill.vertices.end());
  std::vector<Point> moved = require(spline::move_off_lines(mesh.vertices, mesh.triangles, fixed));
  std::vector<Point> clouds = require(spline::make_clouds(moved, mesh.triangles, fixed));
  Scene scene{
      require(spline::DmsDomain::make({2, std::move(moved), std::move(clouds), mesh.triangles})),
      {}};
  for (Index t = ring_triangles; t < mesh.triangles.size(); ++t) scene.hole.push_back(t);
  return scene;
}

void measure_values(const spline::DmsDomain& domain, int points) {
  std::mt19937_64 engine(1);
  const auto between = [&] {
    return -1.4 + 2.8 * (static_cast<double>(engine() >> 11U) / 9007199254740992.0);
  };
  std::vector<Point> places;
  while (places.size() < static_cast<std::size_t>(points)) {
    const double x = between();
    places.push_back({x, between(), 0});
  }
  spline::BasisEvaluator evaluator(domain);
  for (const int order : {0, 1, 2}) {
    std::size_t values = 0;
    const auto start = std::chrono::steady_clock::now();
    for (const Point& u : places) {
      if (const auto found = evaluator.at(u, order)) values += found->size();
    }
    const double seconds = seconds_since(start);
    std::printf("order %d: %.0f points/s, %.2f million functions/s, %.1f at a point\n", order,
                points / seconds, static_cast<double>(values) / seconds / 1e6,
                static_cast<double>(values) / points);
  }
  const auto plain_points = std::min<std::size_t>(places.size(), 5000);
  double difference = 0;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < plain_points; ++i) {
    const auto place = domain.place_of(places[i]);
    if (!place) continue;
    for (const Index function : domain.functions_at(place->triangle)) {
      difference +=
          domain.scale_of(function) * spline::simplex_spline(places[i], domain.knots_of(function));
    }
  }
  const double seconds = seconds_since(start);
  for (std::size_t i = 0; i < plain_points; ++i) {
    if (const auto found = evaluator.at(places[i])) {
      for (const auto& value : *found) difference -= value.value;
    }
  }
  std::printf("by the definition: %.0f points/s; sum of differences %.1e\n",
              static_cast<double>(plain_points) / seconds, difference);
}

void measure_filling(const Scene& scene) {
  std::vector<Point> coefficients;
  for (Index f = 0; f < scene.domain.function_count(); ++f) {
    Point middle;  // a saddle over the triangles
    for (const Index v : scene.domain.arrays().triangles[scene.domain.triangle_of(f)]) {
      middle.x += scene.domain.knot(v, 0).x / 3;
      middle.y += scene.domain.knot(v, 0).y / 3;
    }
    coefficients.push_back({middle.x, middle.y, middle.x * middle.y});
  }
  const auto start = std::chrono::steady_clock::now();
  const spline::ThinPlate plate =
      require(spline::least_thin_plate(scene.domain, scene.hole, coefficients));
  std::printf("filling: %zu unknowns, %zu old functions, %.2f s, energy %.6g, condition %.1e\n",
              plate.unknowns, plate.old_functions, seconds_since(start), plate.energy,
              plate.condition);
}

}  // namespace

int main(int argc, char** argv) {
  const int points = argc > 1 ? std::atoi(argv[1]) : 1'000'000;
  const int edges = argc > 2 ? std::atoi(argv[2]) : 200;
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = scene_of(edges);
  std::printf("domain: %zu triangles, %zu functions, made in %.2f s\n",
              scene.domain.arrays().triangles.size(), scene.domain.function_count(),
              seconds_since(start));
  measure_values(scene.domain, points);
  measure_filling(scene);
}
