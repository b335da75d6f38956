// SPDX-License-Identifier: GPL-3.0-or-later
//
// The defects of the OGC's quality experiment (QIE), written as GML of our own: what the reader
// hands over must give the code of each. A building's gml:id is "b-CODE", "b-CODE-remark" or
// "b-valid-remark"; the code is the one of the first level.
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "samples.h"
#include "validate/certify.h"

namespace watertight {
namespace {

std::vector<int> expected_codes(const std::string& id) {
  const std::string code = id.substr(2, id.find('-', 2) - 2);
  if (code == "valid") return {};
  return {std::stoi(code)};
}

TEST_CASE("GML: every defect of the quality experiment is found under its code") {
  const auto document = test::read(test::file_text("gml/defects.gml"), Format::gml);
  REQUIRE(document);
  CHECK(document->features.size() == 27);
  for (const Feature& feature : document->features) {
    CAPTURE(feature.id);
    REQUIRE(feature.solids.size() == 1);
    const SubmittedSolid& submitted = feature.solids[0];
    CertifyOptions options;
    options.proof = Proof::boundary;
    options.unclosed_rings = submitted.unclosed_rings;
    const Report report = certify(submitted.solid, nullptr, options).report;
    const std::vector<int> expected = expected_codes(feature.id);
    CHECK(report.first_level == expected);
    CHECK(report.verdict == (expected.empty() ? Verdict::valid : Verdict::invalid));
  }
}

}  // namespace
}  // namespace watertight
