// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small solids from rings of points, for the tests of this folder.
#pragma once

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <random>
#include <set>
#include <vector>

#include "validate/certify.h"

namespace watertight::test {

using Ring = std::vector<Point>;
using Facet = std::vector<Ring>;
using Shell = std::vector<Facet>;

inline Solid solid_of(const std::vector<Shell>& shells, const Lattice& lattice = {},
                      std::uint32_t srid = 0) {
  SolidArrays arrays;
  for (const Shell& shell : shells) {
    for (const Facet& facet : shell) {
      for (const Ring& ring : facet) {
        for (const Point& p : ring) {
          arrays.ring_vertices.push_back(static_cast<Index>(arrays.vertices.size()));
          arrays.vertices.push_back(p);
        }
        arrays.end_ring();
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  auto solid = Solid::make(std::move(arrays), lattice, srid);
  REQUIRE(solid);
  return *solid;
}

inline Lattice lattice_of(double step) {
  Lattice lattice;
  lattice.step.fill(geometry::shortest_decimal(step));
  return lattice;
}

/// An axis-parallel box whose facets face outward.
inline Shell box(const Point& low, const Point& high) {
  const std::vector<Point> p{{low.x, low.y, low.z},    {high.x, low.y, low.z},
                             {high.x, high.y, low.z},  {low.x, high.y, low.z},
                             {low.x, low.y, high.z},   {high.x, low.y, high.z},
                             {high.x, high.y, high.z}, {low.x, high.y, high.z}};
  const auto facet = [&](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    return Facet{Ring{p[a], p[b], p[c], p[d]}};
  };
  return {facet(0, 3, 2, 1), facet(4, 5, 6, 7), facet(0, 1, 5, 4),
          facet(1, 2, 6, 5), facet(2, 3, 7, 6), facet(3, 0, 4, 7)};
}

inline Shell cube(double size) { return box({0, 0, 0}, {size, size, size}); }

/// The shell with all facets reversed.
inline Shell inside_out(Shell shell) {
  for (Facet& facet : shell) {
    for (Ring& ring : facet) std::reverse(ring.begin(), ring.end());
  }
  return shell;
}

/// A tetrahedron at `at` with legs of length |size| along +x, +y, +z (or -x, -y, -z if `size` is
/// negative).
inline Shell corner(const Point& at, double size) {
  const Point o = at;
  const Point x{at.x + size, at.y, at.z};
  const Point y{at.x, at.y + size, at.z};
  const Point z{at.x, at.y, at.z + size};
  const Shell shell{{{o, y, x}}, {{o, x, z}}, {{x, y, z}}, {{y, o, z}}};
  return size > 0 ? shell : inside_out(shell);
}

inline Shell join(Shell a, const Shell& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline Report report_of(const std::vector<Shell>& shells, const CertifyOptions& options = {}) {
  return certify(solid_of(shells), nullptr, options).report;
}

inline std::set<int> error_codes(const Report& report) {
  std::set<int> codes;
  for (const Finding& finding : report.findings) {
    if (finding.severity == Severity::error) codes.insert(finding.code);
  }
  return codes;
}

inline const Finding* first_finding(const Report& report, int code) {
  for (const Finding& finding : report.findings) {
    if (finding.code == code) return &finding;
  }
  return nullptr;
}

}  // namespace watertight::test
