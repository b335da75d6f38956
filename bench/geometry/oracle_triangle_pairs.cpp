// SPDX-License-Identifier: GPL-3.0-or-later
//
// oracle_triangle_pairs [N [SEED]]: compares the triangle-triangle classification with an exact
// construction on N random and degenerate integer pairs (1,000,000 by default). Prints how often
// each class occurred; exit status 1 at the first disagreement.
#include <array>
#include <cstdio>
#include <cstdlib>

#include "tests/unit/geometry/triangle_oracle.h"

int main(int argc, char** argv) {
  using namespace watertight;
  const std::uint64_t count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  test::Random random(seed);
  std::array<std::uint64_t, 12> counts{};
  for (std::uint64_t i = 0; i < count; ++i) {
    const test::TrianglePair pair = test::random_pair(random);
    if (const auto difference = test::disagreement(pair, random)) {
      std::printf("pair %llu: %s\n", static_cast<unsigned long long>(i), difference->c_str());
      return 1;
    }
    ++counts[static_cast<std::size_t>(
        geometry::classify_contact(pair.points, pair.first, pair.second))];
  }
  std::printf("%llu pairs, seed %llu: no disagreement\n", static_cast<unsigned long long>(count),
              static_cast<unsigned long long>(seed));
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto name = geometry::to_string(static_cast<geometry::ContactClass>(i));
    std::printf("  %-16.*s %llu\n", static_cast<int>(name.size()), name.data(),
                static_cast<unsigned long long>(counts[i]));
  }
  return 0;
}
