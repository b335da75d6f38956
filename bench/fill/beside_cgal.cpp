// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fills single loops beside CGAL's triangulate_hole_polyline(), which makes the largest angle
// between triangles least, then the area.
//
//   beside_cgal FILE COUNT LEAST MOST
//
// Takes COUNT random loops of LEAST to MOST vertices of a mesh, each the border of a disc of
// triangles, and fills them from all triangles. Prints the sums of angles and the seconds of both,
// and how often CGAL's sum is smaller, which is status 1.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "bench/fill/random_loop.h"
#include "bench/input.h"
#include "geometry/vector3.h"

using namespace watertight;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using geometry::Vector3;

/// CGAL's filling; empty if it finds none.
std::vector<Triangle> by_cgal(const bench::Mesh& mesh, const fill::Loop& loop) {
  std::vector<Kernel::Point_3> polyline;
  for (const Index vertex : loop) {
    const Point& p = mesh.points[vertex];
    polyline.emplace_back(p.x, p.y, p.z);
  }
  std::vector<CGAL::Triple<int, int, int>> found;
  CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
      polyline, std::back_inserter(found),
      CGAL::parameters::use_delaunay_triangulation(false).use_2d_constrained_delaunay_triangulation(
          false));
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c] : found) {
    triangles.push_back({loop[static_cast<std::size_t>(a)], loop[static_cast<std::size_t>(b)],
                         loop[static_cast<std::size_t>(c)]});
  }
  return triangles;
}

Vector3 normal_of(const bench::Mesh& mesh, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Point& p = mesh.points[a];
  const Point& q = mesh.points[b];
  const Point& r = mesh.points[c];
  return geometry::cross(geometry::difference(q, p), geometry::difference(r, p));
}

/// The sum of angles between neighbours, in radians: 0 flat, pi folded.
double angles_of(const bench::Mesh& mesh, const std::vector<Triangle>& triangles) {
  std::map<bench::MeshEdge, Vector3> normals;
  double sum = 0;
  for (const Triangle& triangle : triangles) {
    const Vector3 normal = normal_of(mesh, triangle);
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = triangle[i];
      const Index b = triangle[(i + 1) % 3];
      if (const auto other = normals.find({b, a}); other != normals.end()) {
        const Vector3 across = geometry::cross(normal, other->second);
        sum += std::atan2(geometry::length(across), geometry::dot(normal, other->second));
      }
      normals[{a, b}] = normal;
    }
  }
  return sum;
}

template <class Function>
auto timed(const Function& function, double& seconds) {
  const auto start = std::chrono::steady_clock::now();
  auto result = function();
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  const auto document = bench::read_file(argv[1]);
  if (!document || document->features.empty()) return 1;
  const bench::Mesh mesh = bench::mesh_of(document->features[0].solids[0].solid);
  const std::size_t count = std::stoul(argv[2]);
  const std::size_t least = std::stoul(argv[3]);
  const std::size_t most = std::stoul(argv[4]);
  test::Random random(3621);
  fill::FillOptions options;
  options.space = fill::CandidateSpace::all;
  options.max_bytes = std::size_t{8} << 30U;
  options.max_domains = 100'000'000;
  std::size_t compared = 0;
  std::size_t unfilled = 0;
  std::size_t smaller = 0;
  double sum = 0;
  double sum_of_cgal = 0;
  double seconds = 0;
  double seconds_of_cgal = 0;
  while (compared + unfilled < count) {
    const auto loop = bench::random_loop(mesh, least + random.below(most - least + 1), {}, random);
    if (!loop) continue;
    const auto ours =
        timed([&] { return fill::triangulate_loops(mesh.points, {{*loop}}, options); }, seconds);
    const auto theirs = timed([&] { return by_cgal(mesh, *loop); }, seconds_of_cgal);
    if (!ours || theirs.empty()) {
      ++unfilled;
      continue;
    }
    ++compared;
    const double own = angles_of(mesh, ours->triangles);
    const double other = angles_of(mesh, theirs);
    sum += own;
    sum_of_cgal += other;
    if (other < own - 1e-6) ++smaller;
  }
  std::printf("%zu loops, %zu that one of both did not fill\n", compared + unfilled, unfilled);
  std::printf("sum of angles   %12.4f  CGAL %12.4f\n", sum, sum_of_cgal);
  std::printf("seconds         %12.3f  CGAL %12.3f\n", seconds, seconds_of_cgal);
  std::printf("CGAL has the smaller sum: %zu\n", smaller);
  return smaller == 0 ? 0 : 1;
}
