// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "tests/unit/report/samples.h"
#include "validate/finding_kinds.h"

using namespace watertight;
using namespace watertight::test;
using Json = nlohmann::json;

namespace {

Json report_of(const std::vector<pipeline::ValidatedFeature>& features) {
  Written written;
  const auto report = report::json_report(written.sink(), head_without_times());
  write_document(*report, "a.city.json", features);
  REQUIRE(report->finish());
  return Json::parse(written.text);
}

}  // namespace

TEST_CASE("a report has val3dity's members and the verdicts beside them") {
  const Json report = report_of(
      {feature_of("a", {}), feature_of("b", {finding_of(306, 1, 4), finding_of(801, 2)})});
  CHECK(report["type"] == "val3dity_report");
  CHECK(report["schema"] == 2);
  CHECK(report["input_file"] == "a.city.json");
  CHECK(report["input_file_type"] == "CityJSON");
  CHECK(report["validity"] == false);
  CHECK(report["verdict"] == "invalid");
  CHECK(report["all_errors"] == Json{306});
  CHECK(report["all_warnings"] == Json{801});
  CHECK(report["first_level"] == Json{306});
  CHECK(report["finding_counts"] == Json{{"306", 1}, {"801", 1}});
  CHECK(
      report["features_overview"] ==
      Json::array(
          {{{"type", "Building"}, {"total", 2}, {"valid", 1}, {"invalid", 1}, {"undecided", 0}}}));
  CHECK(report["features"][0]["errors"].empty());
  const Json& error = report["features"][1]["errors"][0];
  CHECK(error["id"] ==
        "coid=b|geom=0|solid=0|shell=0|face=1&&coid=b|geom=0|solid=0|shell=0|face=4");
  CHECK(error["place"] == Json{{"solid", 0}, {"shell", 0}, {"facet", 1}});
  CHECK(error["other_pointer"] == "/CityObjects/b/geometry/0/0/4");
  CHECK(error["hint"] == validate::find_kind(306)->hint);
  CHECK(error["is_repairable"] == false);
  CHECK(report["features"][1]["warnings"][0]["code"] == 801);
  CHECK(report["notes"] == Json{"a note"});
  CHECK_FALSE(report.contains("seconds"));
}

TEST_CASE("a finding about a group names both solids") {
  const Json report = report_of({overlapping_parts()});
  const Json& feature = report["features"][0];
  CHECK(feature["verdict"] == "invalid");
  CHECK(feature["groups"][0]["kind"] == "building_parts");
  CHECK(feature["groups"][0]["solids"] == Json{0, 1});
  const Json& error = feature["errors"][0];
  CHECK(error["id"] ==
        "coid=part-1|geom=0|solid=0|shell=|face=&&coid=part-2|geom=0|solid=0|shell=|face=");
  CHECK(error["place"] == Json{{"solid", 0}});
  CHECK(error["other"] == Json{{"solid", 1}});
  CHECK(error["other_pointer"] == "/CityObjects/c/geometry/0");
  CHECK(report["first_level"] == Json{601});
}

TEST_CASE("an unreadable document or feature is listed and keeps the document from being valid") {
  Written written;
  const auto report = report::json_report(written.sink(), head_without_times());
  REQUIRE(report->begin_document({"a", std::nullopt}));
  REQUIRE(report->add(feature_of("a", {})));
  REQUIRE(report->add_error({ErrorCode::malformed, "no vertices", 17, "/vertices"}));
  REQUIRE(report->add_error({ErrorCode::unavailable, "disk away"}));
  REQUIRE(report->end_document({}));
  REQUIRE(report->finish());
  const Json json = Json::parse(written.text);
  CHECK(json["verdict"] == "undecided");
  CHECK(json["validity"] == false);
  CHECK(json["input_file_type"] == "unknown");
  CHECK(json["all_errors"] == Json{901, 999});
  CHECK(json["dataset_errors"][0]["byte_offset"] == 17);
  CHECK(json["dataset_errors"][0]["pointer"] == "/vertices");
  CHECK(json["dataset_errors"][1]["description"] == "UNKNOWN_ERROR");
}

TEST_CASE("each document is one line of JSON, equal for equal input") {
  Written written;
  const auto report = report::json_report(written.sink(), head_without_times());
  write_document(*report, "a", {feature_of("line\nfeed", {finding_of(302, 0)})});
  write_document(*report, "b", {});
  write_document(*report, "a", {feature_of("line\nfeed", {finding_of(302, 0)})});
  REQUIRE(report->finish());
  std::istringstream lines(written.text);
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  REQUIRE(all.size() == 3);
  CHECK(all[0] == all[2]);
  const Json empty = Json::parse(all[1]);
  CHECK(empty["verdict"] == "valid");
  CHECK(empty["features"].empty());
  CHECK(empty["all_errors"].empty());
}

TEST_CASE("ids that are no UTF-8 or full of quotes leave the JSON well formed") {
  const std::string hostile = "\xff\"\\</script>\x01|face=&&";
  const Json report = report_of({feature_of(hostile, {finding_of(203, 3)})});
  CHECK(report["features"][0]["id"] == "\xEF\xBF\xBD\"\\</script>\x01|face=&&");
}

TEST_CASE("pieces of a report are no larger than a feature's part, however many there are") {
  Written written;
  const auto report = report::json_report(written.sink(), head_without_times());
  write_document(*report, "a", {feature_of("a", {finding_of(302, 0)})});
  const std::size_t largest = written.largest_piece;
  write_document(
      *report, "a",
      std::vector<pipeline::ValidatedFeature>(300, feature_of("a", {finding_of(302, 0)})));
  CHECK(written.largest_piece <= largest + 16);
}

TEST_CASE("every error code is one that val3dity's report browser knows") {
  for (const validate::FindingKind& kind : validate::finding_kinds()) {
    INFO(kind.code);
    CHECK((kind.severity == Severity::warning) == (kind.code / 100 == 8));
  }
}

TEST_CASE("an error of the sink ends the report") {
  const auto report = report::json_report(
      [](std::string_view) -> Status {
        return Error{ErrorCode::unavailable, "full"};
      },
      {});
  const Status status = report->begin_document({"a", std::nullopt});
  REQUIRE_FALSE(status);
  CHECK(status.error().message == "full");
}
