// SPDX-License-Identifier: GPL-3.0-or-later
//
// Times the filling of curves of the paper: a monkey saddle, and saddles at the corners of an
// octahedron (bench/fill/saddles.txt). Usage: fill_curves monkey N delaunay|all angle|area
//                                             fill_curves saddles FILE delaunay|all angle|area
//                                             [both]
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "fill/triangulate_loops.h"

using namespace watertight;

namespace {

struct Curves {
  std::vector<Point> points;
  std::vector<fill::Loop> loops;
};

Curves monkey_saddle(std::size_t n) {
  constexpr double kTwoPi = 6.283185307179586;
  Curves curves;
  fill::Loop& loop = curves.loops.emplace_back();
  for (std::size_t i = 0; i < n; ++i) {
    const double t = kTwoPi * static_cast<double>(i) / static_cast<double>(n);
    loop.push_back(static_cast<Index>(curves.points.size()));
    curves.points.push_back({std::cos(t), std::sin(t), 0.5 * std::cos(3 * t)});
  }
  return curves;
}

/// Loops of points, one point a line, loops parted by an empty line.
Curves read_curves(const char* path) {
  Curves curves;
  std::ifstream file(path);
  std::string line;
  curves.loops.emplace_back();
  while (std::getline(file, line)) {
    Point point;
    if (std::sscanf(line.c_str(), "%lf %lf %lf", &point.x, &point.y, &point.z) == 3) {
      curves.loops.back().push_back(static_cast<Index>(curves.points.size()));
      curves.points.push_back(point);
    } else if (!curves.loops.back().empty()) {
      curves.loops.emplace_back();
    }
  }
  if (curves.loops.back().empty()) curves.loops.pop_back();
  return curves;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  const std::string kind = argv[1];
  const Curves curves =
      kind == "monkey" ? monkey_saddle(std::stoul(argv[2])) : read_curves(argv[2]);
  fill::FillOptions options;
  options.max_bytes = std::size_t{4} << 30U;
  options.space =
      std::string(argv[3]) == "all" ? fill::CandidateSpace::all : fill::CandidateSpace::delaunay;
  if (std::string(argv[4]) == "area") options.objective = fill::Objective::area;
  for (int i = 5; i < argc; ++i) {
    if (std::string(argv[i]) == "both") options.has_both_senses = true;
    if (std::string(argv[i]) == "sets") options.keeps_all_sets = true;
  }
  const auto start = std::chrono::steady_clock::now();
  const auto filled = fill::triangulate_loops(curves.points, curves.loops, options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (!filled) {
    std::printf("%s\n", to_string(filled.error()).c_str());
    return 1;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "%s %s %s: %zu triangles of %zu, angle %.7f, area %.7f, %zu domains, %zu sets, "
      "%.1f MB in tables, %.1f MB in all, %.3f s\n",
      argv[2], argv[3], argv[4], filled->triangles.size(), filled->candidates, filled->angle,
      filled->area, filled->domains, filled->weak_sets, static_cast<double>(filled->bytes) / 1e6,
      static_cast<double>(usage.ru_maxrss) / 1e3, seconds.count());
  return 0;
}
