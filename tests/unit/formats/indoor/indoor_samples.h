// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small IndoorGML documents of boxes.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tests/unit/formats/gml_samples.h"

namespace watertight::test {

/// A cell that is a box, and the reference of its duality ("" for none).
struct BoxCell {
  std::string id;
  std::array<std::string, 3> low, high;
  std::string dual = {};
};

/// A state, or a transition with the references of its states.
struct Node {
  std::string id;
  std::string dual = {};
  std::string position = {};
  std::vector<std::string> connects = {};
};

inline std::string links(std::string_view name, const std::vector<std::string>& references) {
  std::string text;
  for (const std::string& reference : references) {
    if (reference.empty()) continue;
    text.append("<").append(name).append(" x:href=\"").append(reference).append("\"/>");
  }
  return text;
}

inline std::string box_solid(const std::array<std::string, 3>& low,
                             const std::array<std::string, 3>& high) {
  std::string members;
  for (const std::string facet : {"0462", "1375", "0154", "2673", "0231", "4576"}) {
    std::string positions;
    for (const char digit : facet + facet[0]) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_high = ((digit - '0') >> axis & 1) != 0;
        positions.append((is_high ? high : low)[axis]).append(" ");
      }
    }
    members += member(polygon(positions));
  }
  return solid_of(members);
}

/// An IndoorGML document; a line for each cell, state and transition, from line 2.
inline std::string indoor(const std::vector<BoxCell>& cells, const std::vector<Node>& states,
                          const std::vector<Node>& transitions = {},
                          const std::string& version = "1.0", const std::string& more = "") {
  std::string text = R"(<IndoorFeatures xmlns="http://www.opengis.net/indoorgml/)";
  text.append(version).append(R"(/core" xmlns:g="http://www.opengis.net/gml/3.2" )");
  text.append(R"(xmlns:n="http://www.opengis.net/indoorgml/1.0/navigation" )");
  text.append(R"(xmlns:x="http://www.w3.org/1999/xlink"><p><PrimalSpaceFeatures>)").append(more);
  for (const BoxCell& cell : cells) {
    text.append("\n<cellSpaceMember><n:GeneralSpace g:id=\"").append(cell.id);
    text.append("\"><cellSpaceGeometry><Geometry3D>").append(box_solid(cell.low, cell.high));
    text.append("</Geometry3D></cellSpaceGeometry>").append(links("duality", {cell.dual}));
    text.append("</n:GeneralSpace></cellSpaceMember>");
  }
  text.append("</PrimalSpaceFeatures></p><m><MultiLayeredGraph><SpaceLayer>");
  for (const Node& state : states) {
    text.append("\n<stateMember><State g:id=\"").append(state.id).append("\">");
    text.append(links("duality", {state.dual})).append(links("connects", state.connects));
    if (!state.position.empty()) {
      text.append("<geometry><g:Point><g:pos>").append(state.position);
      text.append("</g:pos></g:Point></geometry>");
    }
    text.append("</State></stateMember>");
  }
  for (const Node& transition : transitions) {
    text.append("\n<transitionMember><Transition g:id=\"").append(transition.id).append("\">");
    text.append(links("duality", {transition.dual}));
    text.append(links("connects", transition.connects)).append("</Transition></transitionMember>");
  }
  return text.append("</SpaceLayer></MultiLayeredGraph></m></IndoorFeatures>");
}

}  // namespace watertight::test
