// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints a checksum of the best triangulation of random holes of one to three loops, whose sums of
// angles depend on every rounding.
#include <array>
#include <cstdio>
#include <span>
#include <vector>

#include "base/checksum.h"
#include "fill/triangulate_loops.h"
#include "tests/builds/fingerprint.h"
#include "tests/random.h"

namespace watertight::builds {
namespace {

std::uint32_t checksum_of(const fill::LoopFill& filling) {
  std::vector<std::uint8_t> bytes;
  for (const Triangle& triangle : filling.triangles) {
    for (const Index point : triangle) bytes.push_back(static_cast<std::uint8_t>(point));
  }
  return crc32c(bytes);
}

}  // namespace

bool print_fillings() {
  constexpr std::uint64_t kHoles = 120;
  for (std::uint64_t seed = 1; seed <= kHoles; ++seed) {
    test::Random random(seed);
    std::vector<Point> points;
    std::vector<fill::Loop> loops(1 + seed % 3);
    fill::FillOptions options;
    options.space = seed % 2 == 0 ? fill::CandidateSpace::all : fill::CandidateSpace::delaunay;
    if (seed % 5 == 0) options.objective = fill::Objective::area;
    for (fill::Loop& loop : loops) {
      const std::size_t size = loops.size() == 1 ? 20 : loops.size() == 2 ? 7 : 4;
      const auto coordinate = [&] { return static_cast<double>(random.below(1000)); };
      auto& behind = options.behind.emplace_back();
      for (std::size_t i = 0; i < size; ++i) {
        loop.push_back(static_cast<Index>(points.size()));
        points.push_back({coordinate(), coordinate(), coordinate()});
        behind.push_back({coordinate() - 500, coordinate() - 500, coordinate() - 500});
      }
    }
    const auto filling = fill::triangulate_loops(points, loops, options);
    if (!filling && filling.error().code != ErrorCode::not_found) return false;
    std::printf("filling %u %08x\n", static_cast<unsigned>(seed),
                filling ? checksum_of(*filling) : 0);
  }
  return true;
}

}  // namespace watertight::builds
