// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fingerprint.h"
#include "tests/unit/report/samples.h"

using namespace watertight;
using namespace watertight::test;

namespace {

std::uint64_t fingerprint_of(const Finding& finding, const std::string& object = "b",
                             const std::string& file = "a.json") {
  const auto feature = feature_of(object, {finding});
  const auto found = report::identified_findings(file, feature.inspected);
  REQUIRE(found.size() == 1);
  return found[0].fingerprint;
}

Finding seen_at(double x, Index facet) {
  Finding finding = finding_of(302, facet);
  finding.witness = std::array<double, 3>{x, 447422, 3};
  return finding;
}

}  // namespace

TEST_CASE("a fingerprint holds for file, object, code and place") {
  const std::uint64_t one = fingerprint_of(finding_of(302, 1));
  CHECK(fingerprint_of(finding_of(302, 1)) == one);
  CHECK(fingerprint_of(finding_of(302, 1), "b", "./x/../a.json") == one);
  CHECK(fingerprint_of(finding_of(302, 2)) != one);
  CHECK(fingerprint_of(finding_of(303, 1)) != one);
  CHECK(fingerprint_of(finding_of(302, 1), "c") != one);
  CHECK(fingerprint_of(finding_of(302, 1), "b", "x/a.json") != one);
}

TEST_CASE("a fingerprint with a witness does not depend on the number of the facet") {
  CHECK(fingerprint_of(seen_at(84616.4681, 1)) == fingerprint_of(seen_at(84616.4682, 5)));
  CHECK(fingerprint_of(seen_at(84616.468, 1)) != fingerprint_of(seen_at(84616.568, 1)));
}

TEST_CASE("the fingerprint of a pair does not depend on which side comes first") {
  CHECK(fingerprint_of(finding_of(306, 1, 4)) == fingerprint_of(finding_of(306, 4, 1)));
  CHECK(fingerprint_of(finding_of(306, 1, 4)) != fingerprint_of(finding_of(306, 1, 5)));
}

TEST_CASE("parts of a fingerprint do not run into each other") {
  const report::FindingIdentity one{"a", 302, {"b", "c", {}}, {}, {}};
  const report::FindingIdentity other{"a", 302, {"bc", "", {}}, {}, {}};
  CHECK(report::fingerprint_of(one) != report::fingerprint_of(other));
}
