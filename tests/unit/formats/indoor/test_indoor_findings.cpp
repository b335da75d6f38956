// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the findings about indoor models (701 to 704) from the text of a document to the features
// of a report, and what encoding keeps of them.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/pipeline.h"
#include "pipeline/validate_stream.h"
#include "tests/unit/formats/indoor/indoor_samples.h"

namespace watertight::test_indoor_findings {
namespace {

using test::BoxCell;
using test::Node;

CertifyOptions by_boundary() {
  CertifyOptions options;
  options.proof = Proof::boundary;
  return options;
}

/// The features of a document after validation, in order.
std::vector<pipeline::InspectedFeature> validated(const std::string& text,
                                                  const validate::GroupOptions& groups = {},
                                                  std::size_t threads = 1) {
  auto reader = formats::FeatureReader::of(test::gml_of(text));
  pipeline::StreamOptions options;
  options.certify = by_boundary();
  options.groups = groups;
  options.threads = threads;
  std::vector<pipeline::InspectedFeature> features;
  const auto outcome = pipeline::validate_stream(
      reader, nullptr, options,
      [&](pipeline::ValidatedFeature&& feature) -> Status {
        features.push_back(std::move(feature.inspected));
        return Done{};
      },
      [](const Error& error) -> Status { return error; });
  REQUIRE(outcome);
  return features;
}

/// The findings of a feature's comparison with other cells: "703 error DETAIL".
std::vector<std::string> said(const pipeline::InspectedFeature& feature) {
  std::vector<std::string> all;
  for (const pipeline::InspectedGroup& group : feature.groups) {
    CHECK(group.kind == validate::GroupKind::indoor_cells);
    CHECK(group.object_id == feature.feature.id);
    for (const Finding& finding : group.report.findings) {
      CHECK(finding.source.line > 0);
      std::string text = std::to_string(finding.code);
      text.append(" ").append(validate::to_string(finding.severity)).append(" ");
      all.push_back(text.append(finding.detail));
    }
  }
  return all;
}

using Said = std::vector<std::string>;

/// The name of a numbered element: "s7", "#s7".
std::string numbered(const char* prefix, int number) {
  return std::string(prefix).append(std::to_string(number));
}

BoxCell room(const std::string& id, const std::string& from, const std::string& to,
             const std::string& dual = "") {
  return {id, {from, "0", "0"}, {to, "3", "3"}, dual};
}

const std::vector<Node> kStates{{"s", "#a", "2 1 1", {"#t"}}, {"u", "#b", "6 1 1", {"#t"}}};
const std::vector<Node> kDoor{{"t", "", "", {"#s", "#u"}}};

TEST_CASE("IndoorGML: a model of two rooms with a door is valid") {
  const auto features = validated(
      test::indoor({room("a", "0", "4", "#s"), room("b", "4", "9", "#u")}, kStates, kDoor));
  REQUIRE(features.size() == 2);
  for (const auto& feature : features) {
    CHECK(feature.verdict() == Verdict::valid);
    CHECK(said(feature).empty());
    REQUIRE(feature.groups.size() == 1);
    CHECK(feature.groups[0].members == std::vector<std::size_t>{0});
    CHECK(feature.groups[0].report.not_run.empty());
  }
}

TEST_CASE("IndoorGML: cells without state and states without cell are allowed, as in val3dity") {
  for (const auto& feature : validated(test::indoor({room("a", "0", "4"), room("b", "4", "9")},
                                                    {{"s", "", "2 1 1"}, {"u", "#b", "6 1 1"}}))) {
    CHECK(feature.verdict() == Verdict::valid);
  }
}

TEST_CASE("IndoorGML: overlapping cells are finding 701 of both") {
  const std::string text = test::indoor({room("a", "0", "4"), room("b", "3", "9")}, {});
  const auto features = validated(text);
  REQUIRE(features.size() == 2);
  for (const auto& feature : features) {
    CHECK(feature.verdict() == Verdict::invalid);
    REQUIRE(feature.groups.at(0).report.findings.size() == 1);
    const Finding& finding = feature.groups[0].report.findings[0];
    CHECK(finding.code == 701);
    CHECK(finding.measured == 1.0);
    CHECK(finding.place.solid == 0);
    CHECK(test::says(finding.detail, "cell 'a' (line 2)"));
    CHECK(test::says(finding.detail, "cell 'b' (line 3)"));
  }
  CHECK(features[0].groups[0].report.findings[0].source.line == 2);
  CHECK(features[1].groups[0].report.findings[0].source.line == 3);
  validate::GroupOptions allowed;
  allowed.overlap_metres = 1;
  CHECK(validated(text, allowed)[0].verdict() == Verdict::valid);
}

TEST_CASE("IndoorGML: an overlap no deeper than a step of the coordinates is a warning") {
  const std::string text =
      test::indoor({room("a", "0.000", "4.001"), room("b", "4.000", "9.005")}, {});
  const auto features = validated(text);
  CHECK(features.at(0).verdict() == Verdict::valid);
  REQUIRE(said(features[0]).size() == 1);
  CHECK(said(features[0])[0].starts_with("701 warning"));
  validate::GroupOptions strict;
  strict.do_steps_warn = false;
  CHECK(validated(text, strict)[0].verdict() == Verdict::invalid);
}

TEST_CASE("IndoorGML: a state outside of its cell is finding 702; the boundary is inside") {
  const auto codes = [](const std::string& position) {
    return said(validated(test::indoor({room("a", "0", "4", "#s")}, {{"s", "#a", position}}))[0]);
  };
  CHECK(codes("2 1 1").empty());
  CHECK(codes("4 1 1").empty());
  CHECK(codes("4 3 3").empty());
  CHECK(codes("0 0 0").empty());
  CHECK(codes("4.000000000001 1 1") ==
        Said{"702 error state 's' (line 3) is outside cell 'a' (line 2)"});
  CHECK(codes("2 1 -0.0000000000001").size() == 1);
}

TEST_CASE("IndoorGML: a state with more digits than a grid has leaves its cell undecided") {
  const auto features = validated(
      test::indoor({room("a", "0", "4", "#s")}, {{"s", "#a", "4.00000000000000001 1 1"}}));
  CHECK(features.at(0).verdict() == Verdict::undecided);
  CHECK(features[0].groups.at(0).report.not_run.at(0).reason ==
        "state 's' (line 3): its position and the cell have no exact grid in common");
}

TEST_CASE("IndoorGML: a state that cannot be located is said in not_run") {
  const auto features = validated(test::indoor(
      {room("a", "0", "4", "#s"), room("b", "4", "9", "#u")}, {{"s", "#a", "2 1"}, {"u", "#b"}}));
  const auto reason = [&](std::size_t feature) {
    const auto& not_run = features.at(feature).groups.at(0).report.not_run;
    REQUIRE(not_run.size() == 1);
    CHECK(not_run[0].codes == std::vector<int>{702});
    return not_run[0].reason;
  };
  CHECK(reason(0) == "state 's' (line 4): its position has not three numbers");
  CHECK(reason(1) == "state 'u' (line 5): it has no position");
}

TEST_CASE("IndoorGML: a cell that is not valid is not compared") {
  std::string text =
      test::indoor({room("a", "0", "4", "#s"), room("b", "3", "9", "#u")}, kStates, kDoor);
  const std::size_t at = text.find("<g:surfaceMember>");
  text.erase(at, text.find("</g:surfaceMember>") + 18 - at);
  const auto features = validated(text);
  REQUIRE(features.size() == 2);
  CHECK(features[0].solids.at(0).inspection.report.verdict == Verdict::invalid);
  CHECK(said(features[0]).empty());
  CHECK(features[0].groups.at(0).report.not_run.size() == 2);
  CHECK(features[1].verdict() == Verdict::valid);
}

TEST_CASE("IndoorGML: references that do not fit are finding 703") {
  const std::vector<BoxCell> cells{room("a", "0", "4", "#s"), room("b", "4", "9", "#u")};
  const auto all = [](const std::string& text) {
    Said lines;
    for (const auto& feature : validated(text)) {
      for (std::string& line : said(feature)) lines.push_back(std::move(line));
    }
    return lines;
  };
  // To nothing, and to several elements.
  CHECK(all(test::indoor({room("a", "0", "4", "#gone")}, {})) ==
        Said{"703 error cell 'a' (line 2) refers to '#gone', but no state of the document has this "
             "id"});
  CHECK(all(test::indoor({room("a", "0", "4")}, {{"s", "#gone", "1 1 1"}})) ==
        Said{"703 error state 's' (line 3) refers to '#gone', but no cell of the document has this "
             "id"});
  CHECK(
      all(test::indoor({room("a", "0", "4", "#s")}, {{"s", "#a", "1 1 1"}, {"s", "", "1 1 1"}})) ==
      Said{"703 error cell 'a' (line 2) refers to '#s', but 2 states have this id"});
  // Not both ways.
  CHECK(all(test::indoor({room("a", "0", "4", "#s")}, {{"s", "", "1 1 1"}})) ==
        Said{"703 error cell 'a' (line 2) and its state 's' (line 3) are not linked both ways: the "
             "state refers to no cell"});
  const Said crossed = all(test::indoor(cells, {{"s", "#b", "6 1 1"}, {"u", "#a", "1 1 1"}}));
  CHECK(std::count_if(crossed.begin(), crossed.end(), [](const std::string& line) {
          return line.starts_with("703") && test::says(line, "not linked both ways");
        }) == 2);
  CHECK(all(test::indoor(cells,
                         {{"s", "#a", "1 1 1"}, {"u", "#b", "6 1 1"}, {"v", "#a", "1 1 1"}})) ==
        Said{"703 error state 'v' (line 6) refers to cell 'a' (line 2), which has another state"});
  // Transitions.
  CHECK(all(test::indoor(cells, {{"s", "#a", "1 1 1"}, {"u", "#b", "6 1 1"}},
                         {{"t", "#gone", "", {"#s", "#n"}}})) ==
        Said{"703 error transition 't' (line 6) refers to '#n', but no state of the document has "
             "this id",
             "703 error transition 't' (line 6) refers to '#gone', but no boundary of the document "
             "has this id"});
  CHECK(all(test::indoor(cells, {{"s", "#a", "1 1 1"}, {"u", "#b", "6 1 1"}},
                         {{"t", "", "", {"#u"}}})) ==
        Said{"703 error transition 't' (line 6) connects 1 state instead of two"});
  CHECK(all(test::indoor(cells, {{"s", "#a", "1 1 1", {"#t"}}, {"u", "#b", "6 1 1"}},
                         {{"t", "", "", {"#u", "#u"}}})) ==
        Said{"703 error state 's' (line 4) refers to transition 't' (line 6), which connects other "
             "states"});
}

TEST_CASE("IndoorGML: neighbours that do not touch are finding 704 of both cells") {
  const auto door = [](const BoxCell& second, const validate::GroupOptions& groups = {}) {
    BoxCell other = second;
    other.dual = "#u";
    const auto features = validated(
        test::indoor({room("a", "0.000", "4.001", "#s"), other}, {{"s", "#a"}, {"u", "#b"}}, kDoor),
        groups);
    CHECK(said(features.at(0)) == said(features.at(1)));
    return said(features.at(0));
  };
  CHECK(door(room("b", "4.001", "9")).empty());
  CHECK(door({"b", {"4.001", "2.999", "2.999"}, {"9", "9", "9"}}).empty());  // 1 square millimetre
  CHECK(
      door(room("b", "5", "9")) ==
      Said{"704 error transition 't' (line 6) joins cell 'a' (line 2) and cell 'b' (line 3), which "
           "do not touch"});
  CHECK(door({"b", {"4.001", "3", "0"}, {"9", "9", "9"}}) ==
        Said{"704 warning transition 't' (line 6) joins cell 'a' (line 2) and cell 'b' (line 3), "
             "which have only points or edges in common"});
  CHECK(door({"b", {"4.001", "3", "3"}, {"9", "9", "9"}}).size() == 1);
  CHECK(
      door(room("b", "4.002", "9")).at(0).ends_with("apart by a step of the coordinates at most"));
  CHECK(door(room("b", "4.003", "9")).at(0).starts_with("704 error"));
  // Corners that are apart along all axes: 0.3, 0.4 and 1.2 are 1.3 apart.
  const BoxCell corner{"b", {"4.301", "3.4", "4.2"}, {"9", "9", "9"}};
  validate::GroupOptions walls;
  walls.overlap_metres = 1.3001;
  CHECK(door(corner, walls).empty());
  walls.overlap_metres = 1.2999;
  CHECK(door(corner, walls).size() == 1);
  walls.do_steps_warn = false;
  CHECK(door(room("b", "4.002", "9"), walls).empty());
  walls.overlap_metres = 0;
  CHECK(door(room("b", "4.002", "9"), walls).at(0).starts_with("704 error"));
}

TEST_CASE("IndoorGML: transitions that repeat, and of one cell with itself, are no finding") {
  const auto features = validated(test::indoor(
      {room("a", "0", "4", "#s"), room("b", "5", "9", "#u")}, {{"s", "#a"}, {"u", "#b"}},
      {{"t", "", "", {"#s", "#u"}}, {"v", "", "", {"#u", "#s"}}, {"w", "", "", {"#s", "#s"}}}));
  CHECK(said(features.at(0)).size() == 1);
  CHECK(said(features.at(1)).size() == 1);
}

TEST_CASE("IndoorGML: the findings do not depend on the number of threads") {
  std::vector<BoxCell> cells;
  std::vector<Node> states;
  for (int i = 0; i < 40; ++i) {
    cells.push_back(room(numbered("c", i), std::to_string(3 * i), std::to_string(3 * i + 2 + i % 3),
                         numbered("#s", i)));
    states.push_back({numbered("s", i), numbered("#c", i), numbered("", 3 * i + 1) + " 1 1"});
  }
  const std::string text = test::indoor(cells, states);
  const auto one = validated(text, {}, 1);
  const auto two = validated(text, {}, 2);
  REQUIRE(one.size() == 40);
  for (std::size_t i = 0; i < one.size(); ++i) CHECK(said(one[i]) == said(two.at(i)));
}

TEST_CASE("IndoorGML: refuse, skip and keep of cells with findings") {
  const std::string text =
      test::indoor({room("a", "0", "4"), room("b", "3", "9"), room("c", "9", "12")}, {});
  formats::ReadOptions reading;
  reading.keep_text = true;
  reading.split_features = false;
  const auto encoded = [&](pipeline::Policy policy) {
    auto document = formats::read_document(as_bytes(text), Format::gml, reading);
    REQUIRE(document);
    pipeline::IngestOptions options;
    options.certify = by_boundary();
    options.policy = policy;
    auto outcome = pipeline::encode_document(*std::move(document), nullptr, options);
    REQUIRE(outcome);
    CHECK(outcome->outcome.invalid == 2);
    return *std::move(outcome);
  };
  CHECK(encoded(pipeline::Policy::refuse).document.features.empty());
  const auto skipped = encoded(pipeline::Policy::skip);
  REQUIRE(skipped.document.features.size() == 1);
  CHECK(skipped.document.features[0].id == "c");
  const auto kept = encoded(pipeline::Policy::keep);
  REQUIRE(kept.document.features.size() == 3);
  CHECK(kept.outcome.unproven == 0);  // the solids keep their proofs
  CHECK(kept.outcome.unproven_features == 2);
  CHECK_FALSE(kept.document.features[0].is_proven());
  CHECK(kept.document.features[2].is_proven());
  CHECK(kept.document.features[0].findings.find("\"kind\":\"indoor_cells\"") != std::string::npos);
  CHECK(kept.document.features[0].findings.find("\"code\":701") != std::string::npos);
}

TEST_CASE("IndoorGML: a hostile graph takes time and findings in proportion to its size") {
  std::vector<Node> states;
  std::vector<Node> transitions;
  for (int i = 0; i < 20'000; ++i) {
    states.push_back({numbered("s", i), "#a", "2 1 1", {"#t"}});
    transitions.push_back({numbered("t", i), "", "", {"#s0", "#s1"}});
  }
  const std::string text =
      test::indoor({room("a", "0", "4", "#s0"), room("b", "4", "9", "#s1")}, states, transitions);
  const auto start = std::chrono::steady_clock::now();
  const auto features = validated(text);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
  std::uint64_t count = 0;
  for (const auto& feature : features) {
    const auto& report = feature.groups.at(0).report;
    CHECK(report.findings.size() <= Limits{}.findings);
    count += report.findings.size() + report.findings_omitted;
  }
  // Each state refers to the transition t, which is not there; b has a state that refers to a.
  CHECK(count >= 2 * 19'999);
}

}  // namespace
}  // namespace watertight::test_indoor_findings
