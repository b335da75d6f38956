// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "tests/unit/validate/solids.h"
#include "validate/report_json.h"
#include "validate/rules/rules.h"

using namespace watertight;
using namespace watertight::test;

namespace {

Finding finding_at(int code, Index shell, Index facet) {
  Finding finding;
  finding.code = code;
  finding.place.shell = shell;
  finding.place.facet = facet;
  return finding;
}

}  // namespace

TEST_CASE("a finding's pointer leads to its place in the document") {
  const Solid solid = solid_of({cube(9), inside_out(box({1, 1, 1}, {3, 3, 3}))});
  validate::ReportJsonOptions options;
  options.pointer_prefix = "/CityObjects/a~1b/geometry/0/boundaries";
  Place place;
  place.shell = 1;
  CHECK(validate::place_pointer(place, solid, options) == options.pointer_prefix + "/1");
  place.facet = 8;  // the third facet of shell 1
  CHECK(validate::place_pointer(place, solid, options) == options.pointer_prefix + "/1/2");
  place.ring = 0;
  place.vertex = solid.ring(8)[3];
  CHECK(validate::place_pointer(place, solid, options) == options.pointer_prefix + "/1/2/0/3");
  options.has_shells = false;
  CHECK(validate::place_pointer(place, solid, options) == options.pointer_prefix + "/2/0/3");
  CHECK(validate::place_pointer(Place{}, solid, options) == options.pointer_prefix);
}

TEST_CASE("the JSON report has val3dity's members and more") {
  Shell shell = cube(4);
  shell.pop_back();
  const Solid solid = solid_of({shell});
  const Report report = certify(solid, nullptr).report;
  validate::ReportJsonOptions options;
  options.pointer_prefix = "/b";
  const auto json = nlohmann::json::parse(validate::report_json(report, solid, options));
  CHECK(json["validity"] == false);
  CHECK(json["verdict"] == "invalid");
  CHECK(json["all_errors"] == nlohmann::json{302});
  CHECK(json["first_level"] == nlohmann::json{302});
  CHECK(json["parameters"]["planarity_d2p_tol"] == 0.01);
  const auto& error = json["errors"][0];
  CHECK(error["code"] == 302);
  CHECK(error["description"] == "SHELL_NOT_CLOSED");
  CHECK(error["id"] == "shell=0|face=0");
  CHECK(error["pointer"] == "/b/0/0/0/0");
  CHECK(error["witness"].size() == 3);
  const auto& skipped = json["not_run"];
  CHECK(std::any_of(skipped.begin(), skipped.end(), [](const auto& rule) {
    return rule["codes"] == nlohmann::json{404} && !rule["reason"].empty();
  }));
}

TEST_CASE("the JSON report without times is the same for the same solid") {
  const Solid solid = solid_of({cube(4)});
  validate::ReportJsonOptions options;
  options.include_times = false;
  const std::string text = validate::report_json(certify(solid, nullptr).report, solid, options);
  CHECK(text == validate::report_json(certify(solid, nullptr).report, solid, options));
  CHECK(text.find("seconds") == std::string::npos);
}

TEST_CASE("a finding reads as one line") {
  Finding finding = finding_at(203, 0, 5);
  finding.measured = 0.0250001;
  finding.limit = 0.01;
  finding.unit = "metre";
  finding.detail = "the point is off the plane";
  CHECK(validate::finding_text(finding) ==
        "error 203 NON_PLANAR_POLYGON_DISTANCE_PLANE at shell 0 facet 5: the point is off the "
        "plane (0.0250001 metre, limit 0.01)");
}

TEST_CASE("first_level stops per facet, then per shell, then at the solid") {
  using CodeList = std::vector<int>;
  CHECK(validate::first_level_codes({}).empty());
  CHECK(validate::first_level_codes({finding_at(306, 0, 1), finding_at(203, 0, 2)}) ==
        CodeList{203});
  CHECK(validate::first_level_codes({finding_at(101, 0, 1), finding_at(102, 0, 1),
                                     finding_at(203, 0, 2)}) == CodeList{101, 203});
  CHECK(validate::first_level_codes({finding_at(204, 0, 1), finding_at(302, 0, kNone)}) ==
        CodeList{204});
  CHECK(validate::first_level_codes({finding_at(302, 0, 1), finding_at(303, 0, 1),
                                     finding_at(306, 0, 2)}) == CodeList{303});
  CHECK(validate::first_level_codes({finding_at(302, 0, 1), finding_at(306, 0, 2),
                                     finding_at(306, 1, 9)}) == CodeList{302, 306});
  CHECK(validate::first_level_codes({finding_at(401, 0, 1), finding_at(403, 1, 2)}) ==
        CodeList{401, 403});
  Finding warning = finding_at(801, kNone, kNone);
  warning.severity = Severity::warning;
  CHECK(validate::first_level_codes({warning}).empty());
}
