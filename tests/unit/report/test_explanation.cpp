// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/explanation.h"
#include "tests/unit/report/samples.h"
#include "validate/finding_kinds.h"

using namespace watertight;

TEST_CASE("every finding has an explanation with meaning, cause, remedy and picture") {
  for (const validate::FindingKind& kind : validate::finding_kinds()) {
    INFO(kind.code);
    const auto explanation = report::explanation_of(kind.code);
    REQUIRE(explanation);
    CHECK(explanation->name == kind.name);
    CHECK(explanation->picture == "docs/figures/" + std::to_string(kind.code) + ".svg");
    for (const std::string* part :
         {&explanation->meaning, &explanation->cause, &explanation->remedy}) {
      CHECK(part->size() > 10);
      CHECK(part->find("##") == std::string::npos);
      CHECK(part->find("Sample:") == std::string::npos);
      CHECK(part->find("  ") == std::string::npos);
    }
  }
  CHECK_FALSE(report::explanation_of(304));
  CHECK_FALSE(report::explanation_of(-1));
}

TEST_CASE("a finding is found by its number or its name") {
  CHECK(report::code_of_text("302") == 302);
  CHECK(report::code_of_text("Shell_Not_Closed") == 302);
  CHECK_FALSE(report::code_of_text("30"));
  CHECK_FALSE(report::code_of_text(""));
}
