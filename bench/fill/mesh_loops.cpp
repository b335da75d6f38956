// SPDX-License-Identifier: GPL-3.0-or-later
//
// Compares the best filling from Delaunay triangles with the best one from all triangles, on loops
// of edges of a mesh, as section 4.2 of Zou, Ju and Carr 2013 does.
//
//   mesh_loops FILE LOOPS COUNT LEAST MOST [both] [round]
//
// Makes COUNT sets of LOOPS random loops of LEAST to MOST vertices, each the border of a disc of
// triangles that grows at random edges; with `round` as round as the mesh allows. With `both` the
// loops are curves that may be passed in both senses, as in the paper; else they are borders of
// holes. Prints the share of sets with an area above 0.97 of the other's,
// and with an angle less than 5 and 10 degrees above the other's for each interior edge.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "bench/fill/random_loop.h"
#include "bench/input.h"
#include "fill/triangulate_loops.h"

using namespace watertight;

namespace {

struct Compared {
  double area_ratio = 0;
  double degrees = 0;  // per interior edge
};

std::optional<Compared> compare(const bench::Mesh& mesh, const std::vector<fill::Loop>& loops,
                                bool has_both_senses) {
  std::size_t vertices = 0;
  for (const fill::Loop& loop : loops) vertices += loop.size();
  const auto filled = [&](fill::CandidateSpace space, fill::Objective objective) {
    fill::FillOptions options;
    options.space = space;
    options.objective = objective;
    options.has_both_senses = has_both_senses;
    options.max_bytes = std::size_t{8} << 30U;
    options.max_domains = 100'000'000;
    return fill::triangulate_loops(mesh.points, loops, options);
  };
  using enum fill::CandidateSpace;
  const auto area = filled(delaunay, fill::Objective::area);
  const auto least_area = filled(all, fill::Objective::area);
  const auto angles = filled(delaunay, fill::Objective::angle);
  const auto least_angles = filled(all, fill::Objective::angle);
  if (!area || !least_area || !angles || !least_angles) return std::nullopt;
  constexpr double kDegrees = 57.29577951308232;
  const auto edges = static_cast<double>(vertices + 3 * loops.size() - 6);
  return Compared{least_area->area / area->area,
                  (angles->angle - least_angles->angle) * kDegrees / edges};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6) return 2;
  const auto document = bench::read_file(argv[1]);
  if (!document || document->features.empty()) return 1;
  const bench::Mesh mesh = bench::mesh_of(document->features[0].solids[0].solid);
  const std::size_t loop_count = std::stoul(argv[2]);
  const std::size_t count = std::stoul(argv[3]);
  const std::size_t least = std::stoul(argv[4]);
  const std::size_t most = std::stoul(argv[5]);
  const std::set<std::string_view> ways(argv + 6, argv + argc);
  const bool has_both_senses = ways.contains("both");
  const auto growth = ways.contains("round") ? bench::Growth::round : bench::Growth::ragged;
  test::Random random(2013);
  std::vector<Compared> results;
  std::size_t unfilled = 0;
  const auto start = std::chrono::steady_clock::now();
  while (results.size() + unfilled < count) {
    std::vector<fill::Loop> loops;
    std::set<Index> taken;
    while (loops.size() < loop_count) {
      const auto loop =
          bench::random_loop(mesh, least + random.below(most - least + 1), taken, random, growth);
      if (!loop) continue;
      taken.insert(loop->begin(), loop->end());
      loops.push_back(*loop);
    }
    if (const auto compared = compare(mesh, loops, has_both_senses)) {
      results.push_back(*compared);
    } else {
      ++unfilled;
    }
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const auto number = [&](auto&& test) { return std::ranges::count_if(results, test); };
  std::printf("%zu sets, %zu not filled, %.1f s\n", results.size() + unfilled, unfilled,
              seconds.count());
  std::printf("area_all / area_delaunay > 0.97: %td\n",
              number([](const Compared& c) { return c.area_ratio > 0.97; }));
  for (const double limit : {5.0, 10.0}) {
    std::printf("angle per interior edge, delaunay - all < %.0f degrees: %td\n", limit,
                number([&](const Compared& c) { return c.degrees < limit; }));
  }
  return 0;
}
