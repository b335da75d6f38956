// SPDX-License-Identifier: GPL-3.0-or-later
//
// The graph of an indoor model as the reader of GML gives it.
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "tests/unit/formats/indoor/indoor_samples.h"

namespace watertight::test_indoor {
namespace {

using geometry::CellGraph;
using test::BoxCell;
using test::Node;

const BoxCell kRoom{"room", {"0", "0", "0"}, {"4", "3", "3"}, "#s"};

TEST_CASE("IndoorGML: cells, states and transitions, with lines and targets") {
  for (const std::string version : {"1.0", "1.1"}) {
    CAPTURE(version);
    const Document document = test::gml_of(
        test::indoor({kRoom, {"hall", {"4", "0", "0"}, {"9", "3", "3"}}},
                     {{"s", "#room", " 2 1.50\n1e0 ", {"#t"}}, {"u", "#hall", "5 1 1", {}}},
                     {{"t", "", "", {"#s", "#u"}}}, version));
    REQUIRE(document.features.size() == 2);
    CHECK(document.features[0].id == "room");
    CHECK(document.features[0].type == "GeneralSpace");
    CHECK(document.features[0].cell == 0);
    CHECK(document.features[1].cell == 1);
    const CellGraph& graph = document.graph;
    REQUIRE(graph.cells.size() == 2);
    CHECK(graph.cells[0].id == "room");
    CHECK(graph.cells[0].line == 2);
    REQUIRE(graph.cells[0].duals.size() == 1);
    CHECK(graph.cells[0].duals[0].reference == "#s");
    CHECK(graph.cells[0].duals[0].target == 0);
    CHECK(graph.cells[1].duals.empty());
    REQUIRE(graph.states.size() == 2);
    CHECK(graph.states[1].line == 6);  // the position of the first state has a line feed
    CHECK(graph.states[1].duals.at(0).target == 1);
    CHECK(graph.states[0].transitions.at(0).target == 0);
    REQUIRE(graph.states[0].position);
    CHECK((*graph.states[0].position)[1] == GridNumber{15, -1});
    REQUIRE(graph.transitions.size() == 1);
    CHECK(graph.transitions[0].states.at(0).target == 0);
    CHECK(graph.transitions[0].states.at(1).target == 1);
  }
}

TEST_CASE("IndoorGML: references to nothing, to several and to other documents have no target") {
  const Document document = test::gml_of(
      test::indoor({kRoom,
                    {"same", {"9", "0", "0"}, {"10", "1", "1"}, "#none"},
                    {"same", {"19", "0", "0"}, {"20", "1", "1"}, "other.gml#s"}},
                   {{"s", "#same", "", {}}, {"u", "#t", "", {}}}, {{"t", "#room", "", {"#room"}}}));
  const CellGraph& graph = document.graph;
  CHECK(graph.cells.at(0).duals.at(0).target == 0);
  CHECK(graph.cells.at(1).duals.at(0).target == kNone);
  CHECK(graph.cells.at(1).duals.at(0).found == 0);
  CHECK(graph.cells.at(2).duals.at(0).target == kNone);
  CHECK(graph.states.at(0).duals.at(0).target == kNone);
  CHECK(graph.states.at(0).duals.at(0).found == 2);
  // Elements of another kind are no targets.
  CHECK(graph.states.at(1).duals.at(0).found == 0);
  CHECK(graph.transitions.at(0).states.at(0).found == 0);
  CHECK(graph.transitions.at(0).duals.at(0).found == 0);
}

TEST_CASE("IndoorGML: a position that cannot be read is a fault of its state") {
  const auto fault = [](const std::string& position) {
    const Document document = test::gml_of(test::indoor({kRoom}, {{"s", "#room", position, {}}}));
    const geometry::GraphState& state = document.graph.states.at(0);
    CHECK(state.position.has_value() == state.fault.empty());
    return state.fault;
  };
  CHECK(fault("1 2 3").empty());
  CHECK(fault("1 2") == "its position has not three numbers");
  CHECK(fault("1 2 3 4") == "its position has not three numbers");
  CHECK(fault("1 2 x") == "its position has a part that is no number");
  CHECK(fault("1 2 1e999") == "its position has a part that is no number");
  CHECK(fault("1 2 3.1234567890123456789") == "its position has more than 18 digits");
  CHECK(fault(std::string(5000, '1')) == "its position has not three numbers");
}

TEST_CASE("IndoorGML: positions of states have the axes and the system of their cells") {
  const auto position = [](const std::string& envelope, const std::string& at) {
    std::string text = test::indoor({{"room", {"50", "4", "0"}, {"51", "5", "3"}, "#s"}},
                                    {{"s", "#room", "50.5 4.25 1", {}}});
    text.insert(text.find("<p>"),
                "<g:boundedBy><g:Envelope srsName=\"" + envelope + "\"/></g:boundedBy>");
    if (!at.empty()) text.insert(text.find("<g:pos>") + 6, " srsName=\"" + at + "\"");
    return test::gml_of(text).graph.states.at(0);
  };
  CHECK((*position("EPSG:4979", "").position)[0] == GridNumber{505, -1});
  CHECK((*position("urn:ogc:def:crs:EPSG::4979", "").position)[0] == GridNumber{425, -2});
  CHECK(position("EPSG:4979", "EPSG:4979").fault.empty());
  CHECK(position("EPSG:4979", "EPSG:7415").fault ==
        "its position is in another reference system than its cell");
}

TEST_CASE("GML: states outside of IndoorGML 1.0 and 1.1 are no graph") {
  std::string text = test::indoor({kRoom}, {{"s", "#room", "1 1 1", {}}});
  for (const std::string space : {"http://www.opengis.net/indoorgml/2.0/core", "urn:other"}) {
    std::string other = text;
    const std::string core = "http://www.opengis.net/indoorgml/1.0/core";
    other.replace(other.find(core), core.size(), space);
    const Document document = test::gml_of(other);
    CHECK(document.features.at(0).solids.size() == 1);
    CHECK(document.features.at(0).cell == kNone);
    CHECK(document.graph.cells.empty());
    CHECK(document.graph.states.empty());
  }
}

}  // namespace
}  // namespace watertight::test_indoor
