// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests that the verdict does not depend on how a solid is written.
#include "tests/unit/validate/solids.h"

using namespace watertight;
using namespace watertight::test;

namespace {

/// The solid with facets, interior shells, ring starts and vertices in another order.
Solid shuffled(std::vector<Shell> shells, std::mt19937& random) {
  for (Shell& shell : shells) {
    std::shuffle(shell.begin(), shell.end(), random);
    for (Facet& facet : shell) {
      for (Ring& ring : facet) {
        std::rotate(ring.begin(),
                    ring.begin() + static_cast<std::ptrdiff_t>(random() % ring.size()), ring.end());
      }
      if (facet.size() > 2) std::shuffle(facet.begin() + 1, facet.end(), random);
    }
  }
  if (shells.size() > 2) std::shuffle(shells.begin() + 1, shells.end(), random);
  return solid_of(shells);
}

/// The codes of all findings, each as often as it was found.
std::multiset<int> code_counts(const Report& report) {
  std::multiset<int> codes;
  for (const Finding& finding : report.findings) codes.insert(finding.code);
  return codes;
}

/// A prism with a fin: floor and roof run to a point and back, with a wall each way.
Shell finned_prism() {
  const Ring floor{{9, 9, 0}, {6, 6, 0}, {6, 0, 0}, {3, -1, 0}, {0, 2, 0}, {1, 6, 0}, {6, 6, 0}};
  Ring roof = floor;
  for (Point& p : roof) p.z = 5;
  std::reverse(roof.begin(), roof.end());
  Shell shell{{floor}, {roof}};
  for (std::size_t i = 0; i < floor.size(); ++i) {
    const Point a = floor[i], b = floor[(i + 1) % floor.size()];
    shell.push_back({{{b.x, b.y, 5}, b, a, {a.x, a.y, 5}}});
  }
  return shell;
}

/// A facet whose spike has no width in projection only: two of its points lie above each other.
Shell steep_spike() {
  return {
      {{{11, 1, 10}, {11, 0, 10}, {42, 9, 34}, {3, 36, 11}, {3, 38, 12}, {0, 37, 9}, {11, 0, 9}}}};
}

std::vector<std::vector<Shell>> samples() {
  Shell open = cube(4);
  open.pop_back();
  Shell flipped = cube(4);
  std::reverse(flipped[2][0].begin(), flipped[2][0].end());
  Shell pierced = cube(9);
  pierced[1].push_back(Ring{{3, 3, 9}, {3, 6, 9}, {6, 6, 9}, {6, 3, 9}});
  return {{cube(4)},
          {finned_prism()},
          {steep_spike()},
          {open},
          {flipped},
          {pierced},
          {join(cube(2), box({2, 2, 2}, {4, 4, 4}))},
          {join(cube(2), box({2, 2, 0}, {4, 4, 2}))},
          {join(cube(9), box({-3, 3, 3}, {12, 4, 4}))},
          {cube(9), inside_out(box({1, 1, 1}, {3, 3, 3})), inside_out(box({5, 5, 5}, {7, 7, 7}))},
          {cube(9), inside_out(box({1, 1, 1}, {3, 3, 3})), inside_out(box({2, 2, 2}, {7, 7, 7}))}};
}

}  // namespace

TEST_CASE("verdict and codes are the same for every order of facets, rings and vertices") {
  std::mt19937 random(5);
  for (const std::vector<Shell>& shells : samples()) {
    const Report expected = report_of(shells);
    for (int round = 0; round < 20; ++round) {
      const Report report = certify(shuffled(shells, random), nullptr).report;
      CHECK(report.verdict == expected.verdict);
      CHECK(code_counts(report) == code_counts(expected));
      CHECK(report.first_level == expected.first_level);
    }
  }
}

TEST_CASE("verdict and codes are the same under turns and shifts of the lattice") {
  for (const std::vector<Shell>& shells : samples()) {
    const Report expected = report_of(shells);
    for (int turn = 0; turn < 3; ++turn) {
      std::vector<Shell> moved = shells;
      for (Shell& shell : moved) {
        for (Facet& facet : shell) {
          for (Ring& ring : facet) {
            for (Point& p : ring) {
              const double shift = 1099511627776.0;  // 2^40
              p = {p[turn] + shift, p[(turn + 1) % 3] - shift, p[(turn + 2) % 3] + 3 * shift};
            }
          }
        }
      }
      const Report report = report_of(moved);
      CHECK(code_counts(report) == code_counts(expected));
      CHECK(report.first_level == expected.first_level);
    }
  }
}

TEST_CASE("random facets on a small grid give the same codes in every order, and no crash") {
  std::mt19937 random(17);
  const auto point = [&] {
    return Point{double(random() % 3), double(random() % 3), double(random() % 3)};
  };
  for (int round = 0; round < 400; ++round) {
    std::vector<Shell> shells(1 + random() % 3);
    for (Shell& shell : shells) {
      shell.resize(random() % 9);
      for (Facet& facet : shell) {
        facet.resize(1 + random() % 8 / 6);
        for (Ring& ring : facet) {
          ring.resize(2 + random() % 4);
          for (Point& p : ring) p = point();
        }
      }
    }
    if (round % 2 == 0) shells[0] = join(cube(2), shells[0]);
    const Report expected = report_of(shells);
    const Report report = certify(shuffled(shells, random), nullptr).report;
    CHECK(report.verdict == expected.verdict);
    CHECK(code_counts(report) == code_counts(expected));
    CHECK(report.first_level == expected.first_level);
  }
}
