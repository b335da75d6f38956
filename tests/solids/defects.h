// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids with exactly one defect of random size, and the codes that a validator must report.
#pragma once

#include <set>
#include <span>
#include <string_view>

#include "tests/solids/shape.h"

namespace watertight::solids {

struct Defect {
  std::string_view name;
  Shape shape;
  std::set<int> codes;  // the codes of all errors
  // The only code that val3dity reports: it stops at the first level with errors.
  int first_level = 0;
  /// True if the code depends on lengths: affine maps change it, and it is found only with the
  /// metric rules on. The lattice is then millimetres().
  bool is_metric = false;
  /// True if only a tetrahedralization finds the defect (404).
  bool needs_tetrahedra = false;
};

using DefectMaker = Defect (*)(Random& random);
/// One function for each kind of defect.
std::span<const DefectMaker> defect_makers();

}  // namespace watertight::solids
