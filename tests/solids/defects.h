// SPDX-License-Identifier: GPL-3.0-or-later
//
// One defect in an otherwise valid solid, of random size, with the codes that a validator owes.
#pragma once

#include <set>
#include <span>
#include <string_view>

#include "tests/solids/shape.h"

namespace watertight::solids {

struct Defect {
  std::string_view name;
  Shape shape;
  std::set<int> codes;  // of errors, exactly
  int first_level = 0;  // the one code that val3dity's cascade gives
  /// The code depends on lengths: not invariant under affine maps, and found only with the metric
  /// rules on. The lattice is then millimetres().
  bool is_metric = false;
  /// Found only by a tetrahedralization (404).
  bool needs_tetrahedra = false;
};

using DefectMaker = Defect (*)(Random& random);
/// One maker per kind of defect.
std::span<const DefectMaker> defect_makers();

}  // namespace watertight::solids
