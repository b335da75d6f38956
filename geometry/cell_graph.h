// SPDX-License-Identifier: GPL-3.0-or-later
//
// An indoor model as a graph: cells, which are solids of a document, the states and transitions
// that stand for cells and their neighbourhoods, and the references between them. Plain data that
// formats/ reads and validate/ judges.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/lattice/lattice.h"
#include "geometry/point.h"

namespace watertight::geometry {

/// A reference to another element of the graph.
struct GraphLink {
  std::string reference;    // as written, "#N1"; at most kLongestReference bytes of it
  Index target = kNone;     // the index of the element; kNone unless exactly one has this id
  std::uint32_t found = 0;  // the number of elements of the right kind that have this id
  static constexpr std::size_t kLongestReference = 1024;
};

/// The parts that all elements of the graph have.
struct GraphElement {
  std::string id;                     // the gml:id, "" without one
  std::uint64_t line = 0;             // the line on which the element starts, from 1
  std::vector<GraphLink> duals = {};  // the duality: one link in a correct document, or none
};

struct GraphCell : GraphElement {};  // the duality is a state

/// A part of the boundary of a cell.
struct GraphBoundary : GraphElement {};  // the duality is a transition

/// A node: the point that stands for a cell.
struct GraphState : GraphElement {  // the duality is a cell
  std::vector<GraphLink> transitions = {};
  std::optional<std::array<GridNumber, 3>> position = {};
  std::string fault = {};  // why the position is not known, "" if it is or if none is written
};

/// An edge: two cells that are neighbours.
struct GraphTransition : GraphElement {  // the duality is a boundary
  std::vector<GraphLink> states = {};    // two in a correct document
};

struct CellGraph {
  std::vector<GraphCell> cells;
  std::vector<GraphBoundary> boundaries;
  std::vector<GraphState> states;
  std::vector<GraphTransition> transitions;
};

}  // namespace watertight::geometry
