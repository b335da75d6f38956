// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <string>

#include "pipeline/container.h"
#include "pipeline/unproven_solid.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight {
namespace {

/// A solid with all that a valid one cannot have: equal, unused and far vertices, a ring of two
/// vertices, a facet without rings, a shell without facets.
Solid defective(geometry::LatticeKind kind) {
  SolidArrays arrays;
  const double step = kind == geometry::LatticeKind::float64 ? 0.1 : 1;
  arrays.vertices = {{0, 0, 0},           {step, 0, 0},   {step, 0, 0},
                     {7 * step, step, 0}, {0x1p52, 0, 1}, {3, 1e15, 2}};
  arrays.ring_vertices = {0, 1, 2, 3, 3, 0, 4};
  for (const Index end : {4U, 6U, 7U}) arrays.ring_offsets.push_back(end);
  for (const Index end : {2U, 2U, 3U}) arrays.facet_offsets.push_back(end);
  for (const Index end : {3U, 3U}) arrays.shell_offsets.push_back(end);
  geometry::Lattice lattice;
  lattice.kind = kind;
  if (kind == geometry::LatticeKind::decimal) {
    lattice.step.fill({1, -3});
    lattice.origin = {geometry::GridNumber{85, -1}, {-44'700'012'345, -5}, {0, 0}};
  }
  auto solid = Solid::make(std::move(arrays), lattice, 7415);
  REQUIRE(solid);
  return *std::move(solid);
}

TEST_CASE("a solid that is not proven comes back as it came, with all its defects") {
  for (const auto kind : {geometry::LatticeKind::decimal, geometry::LatticeKind::float64}) {
    const Solid solid = defective(kind);
    const std::string line = pipeline::write_unproven(solid);
    CHECK(line.find('\n') == std::string::npos);
    const auto back = pipeline::read_unproven(line);
    REQUIRE(back);
    CHECK(*back == solid);
  }
}

TEST_CASE(
    "a cut or changed line of an unproven solid is an error or another solid, never a crash") {
  const std::string line = pipeline::write_unproven(defective(geometry::LatticeKind::decimal));
  for (std::size_t size = 0; size + 1 < line.size(); ++size) {
    const auto cut = pipeline::read_unproven(std::string_view(line).substr(0, size));
    if (line[size] != ' ' && size > 0 && line[size - 1] != ' ') continue;  // a shorter last number
    CHECK_FALSE(cut);
  }
  for (std::size_t at = 0; at < line.size(); ++at) {
    for (const char other : {' ', '-', '9', 'x', 'e', '\0'}) {
      std::string changed = line;
      changed[at] = other;
      static_cast<void>(pipeline::read_unproven(changed));
    }
  }
  for (const char* const hostile :
       {"", " ", "0", "9 9 9", "2 1 0 1 0 1 0 0 0 0 0 0 0 0 18446744073709551615 1",
        "2 1 0 1 0 1 0 0 0 0 0 0 0 0 0 1 4294967295",
        "2 1 0 1 0 1 0 0 0 0 0 0 0 0 1 0 nan nan inf"}) {
    CHECK_FALSE(pipeline::read_unproven(hostile));
  }
}

}  // namespace
}  // namespace watertight
