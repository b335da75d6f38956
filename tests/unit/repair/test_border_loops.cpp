// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>

#include "repair/border_loops.h"
#include "tests/solids/builders.h"

namespace watertight::repair {
namespace {

const solids::Shell kBox = solids::box({0, 0, 0}, {8, 8, 8});

std::vector<EditedFacet> facets_of(const solids::Shell& shell) {
  return edited(solids::solid_of({shell})).shells[0];
}

TEST_CASE("a closed shell has no border") {
  const BorderLoops borders = border_loops(facets_of(kBox));
  CHECK(borders.loops.empty());
  CHECK(borders.left_over == 0);
}

TEST_CASE("the border of a missing facet is its ring") {
  for (std::size_t missing = 0; missing < kBox.size(); ++missing) {
    std::vector<EditedFacet> facets = facets_of(kBox);
    const EditedFacet gone = facets[missing];
    facets.erase(facets.begin() + static_cast<std::ptrdiff_t>(missing));
    const BorderLoops borders = border_loops(facets);
    REQUIRE(borders.loops.size() == 1);
    Ring ring = gone.rings[0];
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    CHECK(borders.loops[0] == ring);
    CHECK(borders.left_over == 0);
  }
}

TEST_CASE("a missing facet with a hole leaves a loop for each ring") {
  const solids::Shell tunnelled = solids::tunnelled_box({0, 0, 0}, {8, 8, 8}, {2, 2, 0}, {4, 4, 8});
  std::vector<EditedFacet> facets = facets_of(tunnelled);
  REQUIRE(facets[0].rings.size() == 2);
  facets.erase(facets.begin());
  CHECK(border_loops(facets).loops.size() == 2);
}

TEST_CASE("borders that meet in a vertex are separate loops along the fans of facets") {
  // Two facets of a box that share no edge leave two loops; two that meet in one vertex only, too.
  const solids::Shell shell =
      solids::bipyramid({{4, 0, 0}, {0, 4, 0}, {-4, 0, 0}, {0, -4, 0}}, {0, 0, 4}, {0, 0, -4});
  std::vector<EditedFacet> facets = facets_of(shell);
  REQUIRE(facets.size() == 8);
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::vector<EditedFacet> rest = facets;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(j));
      const BorderLoops borders = border_loops(rest);
      std::size_t edges = 0;
      for (const Ring& loop : borders.loops) edges += loop.size();
      CHECK(borders.left_over == 0);
      CHECK((borders.loops.size() == 1 ? edges == 4 : edges == 6));
    }
  }
}

TEST_CASE("edges that facets pass twice belong to no loop") {
  std::vector<EditedFacet> facets = facets_of(kBox);
  facets.pop_back();
  facets.push_back(facets[0]);
  const BorderLoops borders = border_loops(facets);
  CHECK(borders.loops.size() <= 1);
}

}  // namespace
}  // namespace watertight::repair
