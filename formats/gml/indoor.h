// SPDX-License-Identifier: GPL-3.0-or-later
//
// The graph of an indoor model in IndoorGML 1.0 and 1.1: cells, their boundaries, states,
// transitions, and the xlinks between them. Internal to formats/.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gml/xml.h"
#include "geometry/cell_graph.h"

namespace watertight::formats {

/// Collects the graph from the events of a document, of which it needs all. Elements outside of an
/// IndoorFeatures are passed over. A value that is written inside a duality or connects, and links
/// between layers, are not read.
class CellGraphReader {
 public:
  /// Takes the start of an element and its gml:id.
  void start(const XmlElement& element, std::string_view id);
  void text(std::string_view text);
  void end();

  /// The index of the cell that the element of the last start() is; kNone for other elements.
  Index opened_cell() const { return opened_cell_; }

  /// The graph with the targets of its links; call it once, at the end. Cost: n log n.
  geometry::CellGraph take();
  /// The EPSG code that each state states for its position, 0 for none.
  const std::vector<std::uint32_t>& srids_of_states() const { return srids_; }

 private:
  enum class Kind : std::uint8_t { none, cell, boundary, state, transition };

  void open_object(Kind kind, const XmlElement& element, std::string_view id);
  void start_in_object(const XmlElement& element);
  void end_position();
  geometry::GraphElement& open_element();

  geometry::CellGraph graph_;
  std::vector<std::uint32_t> srids_;
  std::uint64_t depth_ = 0;
  // The depths of open elements, 0 for none.
  std::uint64_t model_depth_ = 0;
  std::uint64_t member_depth_ = 0;
  std::uint64_t object_depth_ = 0;
  std::uint64_t geometry_depth_ = 0;
  std::uint64_t position_depth_ = 0;
  Kind member_ = Kind::none;  // of what the open member property has one
  Kind object_ = Kind::none;
  Index opened_cell_ = kNone;
  std::string position_;
};

}  // namespace watertight::formats
