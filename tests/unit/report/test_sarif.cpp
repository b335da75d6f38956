// SPDX-License-Identifier: GPL-3.0-or-later
//
// The members that the schema of SARIF 2.1.0 requires are checked by hand; no schema is loaded.
#include <set>

#include "tests/unit/report/samples.h"
#include "validate/finding_kinds.h"

using namespace watertight;
using namespace watertight::test;
using Json = nlohmann::json;

namespace {

Json log_of(const std::vector<pipeline::ValidatedFeature>& features,
            const std::string& name = "a.city.json") {
  Written written;
  const auto report = report::sarif_report(written.sink(), head_without_times());
  write_document(*report, name, features);
  REQUIRE(report->finish());
  return Json::parse(written.text);
}

void check_message(const Json& message) {
  REQUIRE(message.is_object());
  REQUIRE(message["text"].is_string());
  CHECK_FALSE(message["text"].get<std::string>().empty());
}

void check_location(const Json& location) {
  const Json& physical = location["physicalLocation"];
  REQUIRE(physical["artifactLocation"]["uri"].is_string());
  if (!physical.contains("region")) return;
  const Json& region = physical["region"];
  REQUIRE((region.contains("startLine") || region.contains("byteOffset")));
  if (region.contains("startLine")) CHECK(region["startLine"].get<int>() >= 1);
  if (region.contains("byteOffset")) CHECK(region["byteOffset"].get<int>() >= 0);
}

/// The required members and the types of section 3 of SARIF 2.1.0, as far as the log has them.
void check_log(const Json& log) {
  REQUIRE(log["version"] == "2.1.0");
  REQUIRE(log["$schema"].is_string());
  REQUIRE(log["runs"].size() == 1);
  const Json& run = log["runs"][0];
  const Json& driver = run["tool"]["driver"];
  REQUIRE(driver["name"].is_string());
  std::set<std::string> ids;
  for (const Json& rule : driver["rules"]) {
    INFO(rule.dump());
    REQUIRE(rule["id"].is_string());
    CHECK(ids.insert(rule["id"]).second);
    for (const char* text : {"shortDescription", "fullDescription", "help"}) {
      check_message(rule[text]);
    }
    CHECK((rule["defaultConfiguration"]["level"] == "error" ||
           rule["defaultConfiguration"]["level"] == "warning"));
  }
  REQUIRE(run["results"].is_array());
  for (const Json& result : run["results"]) {
    INFO(result.dump());
    check_message(result["message"]);
    CHECK((result["level"] == "error" || result["level"] == "warning"));
    const auto rule = result["ruleIndex"].get<std::size_t>();
    REQUIRE(rule < driver["rules"].size());
    CHECK(driver["rules"][rule]["id"] == result["ruleId"]);
    REQUIRE(result["locations"].size() == 1);
    check_location(result["locations"][0]);
    if (result.contains("relatedLocations")) check_location(result["relatedLocations"][0]);
    if (!result.contains("partialFingerprints")) continue;
    for (const auto& [name, value] : result["partialFingerprints"].items()) {
      CHECK(value.is_string());
    }
  }
  REQUIRE(run["invocations"][0]["executionSuccessful"].is_boolean());
}

}  // namespace

TEST_CASE("a log has the required members, a rule for each finding and a result for each") {
  const Json log =
      log_of({feature_of("a", {}), feature_of("b", {finding_of(306, 1, 4), finding_of(801, 2)}),
              overlapping_parts()});
  check_log(log);
  const Json& run = log["runs"][0];
  CHECK(run["tool"]["driver"]["rules"].size() == validate::finding_kinds().size() + 1);
  REQUIRE(run["results"].size() == 3);
  const Json& result = run["results"][0];
  CHECK(result["ruleId"] == "306");
  CHECK(result["level"] == "error");
  const Json& logical = result["locations"][0]["logicalLocations"][0];
  CHECK(logical["name"] == "b");
  CHECK(logical["fullyQualifiedName"] == "/CityObjects/b/geometry/0/0/1");
  CHECK(result["relatedLocations"][0]["logicalLocations"][0]["fullyQualifiedName"] ==
        "/CityObjects/b/geometry/0/0/4");
  CHECK(result["partialFingerprints"]["watertightFinding/v1"].get<std::string>().size() == 16);
  CHECK(run["results"][1]["level"] == "warning");
  CHECK(run["invocations"][0]["executionSuccessful"] == true);
}

TEST_CASE("a result names the line of its feature, and an error the byte") {
  pipeline::ValidatedFeature feature = feature_of("b", {finding_of(302, 0)});
  feature.place.line = 7;
  Written written;
  const auto report = report::sarif_report(written.sink(), head_without_times());
  REQUIRE(report->begin_document({"a", Format::city_json_seq}));
  REQUIRE(report->add(feature));
  REQUIRE(report->add_error({ErrorCode::malformed, "no vertices", 17, "/vertices"}));
  REQUIRE(report->add_error({ErrorCode::unavailable, "disk away"}));
  REQUIRE(report->end_document({}));
  REQUIRE(report->finish());
  const Json log = Json::parse(written.text);
  check_log(log);
  const Json& results = log["runs"][0]["results"];
  REQUIRE(results.size() == 3);
  CHECK(results[0]["locations"][0]["physicalLocation"]["region"]["startLine"] == 7);
  CHECK(results[1]["ruleId"] == "901");
  CHECK(results[1]["locations"][0]["physicalLocation"]["region"]["byteOffset"] == 17);
  CHECK(results[2]["ruleId"] == "999");
  CHECK_FALSE(results[2]["locations"][0]["physicalLocation"].contains("region"));
  CHECK(log["runs"][0]["invocations"][0]["executionSuccessful"] == false);
}

TEST_CASE("names of files become URI references") {
  const auto uri_of = [](const std::string& name) {
    const Json log = log_of({feature_of("b", {finding_of(302, 0)})}, name);
    return log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]
              ["uri"]
                  .get<std::string>();
  };
  CHECK(uri_of("./a b/c#1.json") == "a%20b/c%231.json");
  CHECK(uri_of("/data/a.json") == "file:///data/a.json");
  CHECK(uri_of("\xFF.json") == "%FF.json");
}

TEST_CASE("a log without documents is complete") {
  Written written;
  const auto report = report::sarif_report(written.sink(), head_without_times());
  REQUIRE(report->finish());
  check_log(Json::parse(written.text));
  check_log(log_of({}));
  check_log(log_of({feature_of("\xFF\"\n\x01", {finding_of(302, 0)})}));
}
