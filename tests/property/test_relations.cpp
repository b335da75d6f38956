// SPDX-License-Identifier: GPL-3.0-or-later
//
// A part of bench/metamorphic without its oracles: the verdict and the codes of a solid do not
// depend on how it is written or where an integer affine map puts it.
#include <catch2/catch_test_macros.hpp>

#include "tests/solids/builders.h"
#include "tests/solids/defects.h"
#include "validate/certify.h"

using namespace watertight;
using namespace watertight::solids;

namespace {

Report report_of(const Solid& solid) {
  CertifyOptions options;
  options.proof = Proof::boundary;
  // No metric rule applies: the solids are exactly planar.
  options.tolerances.planarity_metres = 1e30;
  options.tolerances.planarity_degrees = 360;
  return certify(solid, nullptr, options).report;
}

void check_same(const Report& expected, const Report& got) {
  CHECK(codes_of(got, Severity::error) == codes_of(expected, Severity::error));
  CHECK(got.first_level == expected.first_level);
  CHECK(got.verdict == expected.verdict);
}

void check_relations(const Made& made, Random& random) {
  INFO(made.family);
  const Solid solid = solid_of(made.shape, millimetres());
  const Report report = report_of(solid);
  check_same(report, report_of(rewritten(solid, random).solid));
  check_same(report, report_of(mapped(solid, unimodular_map(random, 9))));
  check_same(report, report_of(mapped(solid, general_map(random, 9))));
  check_same(report, report_of(mapped(solid, axis_permutation(random, true))));
  check_same(report, report_of(mapped(solid, axis_permutation(random, false))));
}

}  // namespace

TEST_CASE("valid solids stay valid however they are written and wherever they are mapped") {
  Random random(101);
  for (int round = 0; round < 100; ++round) {
    const Made made = random_valid(random);
    INFO(made.family);
    CHECK(codes_of(report_of(solid_of(made.shape, millimetres())), Severity::error).empty());
    check_relations(made, random);
  }
}

TEST_CASE("codes of random shapes do not depend on order or integer affine map") {
  Random random(102);
  for (int round = 0; round < 100; ++round) {
    check_relations(random_open(random), random);
    check_relations(random_cavities(random), random);
  }
}

TEST_CASE("codes of injected defects do not depend on order or integer affine map") {
  Random random(103);
  for (const DefectMaker& make : defect_makers()) {
    const Defect defect = make(random);
    if (!defect.is_metric) check_relations({std::string(defect.name), defect.shape}, random);
  }
}
