// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/indoor.h"

#include <algorithm>
#include <map>
#include <utility>

#include "formats/gml/elements.h"
#include "formats/gml/gml.h"
#include "formats/text/numbers.h"

namespace watertight::formats {
namespace {

using geometry::GraphElement;
using geometry::GraphLink;

// The most bytes of a position's text: three numbers with all digits that a double can have.
constexpr std::size_t kLongestPosition = 4096;

bool is_core_space(std::string_view space) {
  return space.starts_with("http://www.opengis.net/indoorgml/1.") && space.ends_with("/core");
}

// The indices of the elements of one kind by their ids. Counts elements with one id.
class IdIndex {
 public:
  template <class Elements>
  explicit IdIndex(const Elements& elements) {
    for (Index i = 0; i < elements.size(); ++i) {
      if (elements[i].id.empty()) continue;
      const auto [place, is_new] = by_id_.try_emplace(elements[i].id, i, 0U);
      ++place->second.second;
    }
  }

  void resolve(std::vector<GraphLink>& links) const {
    for (GraphLink& link : links) {
      if (!link.reference.starts_with('#')) continue;
      const auto found = by_id_.find(std::string_view(link.reference).substr(1));
      if (found == by_id_.end()) continue;
      link.found = found->second.second;
      if (link.found == 1) link.target = found->second.first;
    }
  }

 private:
  std::map<std::string_view, std::pair<Index, std::uint32_t>> by_id_;
};

}  // namespace

void CellGraphReader::open_object(Kind kind, const XmlElement& element, std::string_view id) {
  object_ = kind;
  object_depth_ = depth_;
  const GraphElement own{std::string(id), element.place.line};
  switch (kind) {
    case Kind::cell:
      opened_cell_ = static_cast<Index>(graph_.cells.size());
      graph_.cells.push_back({own});
      break;
    case Kind::boundary:
      graph_.boundaries.push_back({own});
      break;
    case Kind::state:
      graph_.states.push_back({own});
      srids_.push_back(0);
      break;
    case Kind::transition:
      graph_.transitions.push_back({own});
      break;
    case Kind::none:
      break;
  }
}

GraphElement& CellGraphReader::open_element() {
  if (object_ == Kind::cell) return graph_.cells.back();
  if (object_ == Kind::boundary) return graph_.boundaries.back();
  if (object_ == Kind::state) return graph_.states.back();
  return graph_.transitions.back();
}

void CellGraphReader::start(const XmlElement& element, std::string_view id) {
  ++depth_;
  opened_cell_ = kNone;
  if (model_depth_ == 0) {
    if (element.name == "IndoorFeatures" && is_core_space(element.space)) model_depth_ = depth_;
    return;
  }
  if (object_ != Kind::none) return start_in_object(element);
  if (member_ != Kind::none && depth_ == member_depth_ + 1) {
    return open_object(member_, element, id);
  }
  if (!is_core_space(element.space)) return;
  const auto open_member = [&](Kind kind) {
    member_ = kind;
    member_depth_ = depth_;
  };
  if (element.name == "cellSpaceMember") open_member(Kind::cell);
  if (element.name == "cellSpaceBoundaryMember") open_member(Kind::boundary);
  if (element.name == "State") open_object(Kind::state, element, id);
  if (element.name == "Transition") open_object(Kind::transition, element, id);
}

void CellGraphReader::start_in_object(const XmlElement& element) {
  if (depth_ == object_depth_ + 1 && is_core_space(element.space)) {
    const bool is_dual = element.name == "duality";
    const bool is_connection =
        element.name == "connects" && (object_ == Kind::state || object_ == Kind::transition);
    if (is_dual || is_connection) {
      const auto href = without_blanks(element.attribute(kXlinkSpace, "href").value_or(""));
      if (href.empty()) return;
      auto& links = is_dual                  ? open_element().duals
                    : object_ == Kind::state ? graph_.states.back().transitions
                                             : graph_.transitions.back().states;
      links.push_back({std::string(href.substr(0, GraphLink::kLongestReference))});
    } else if (element.name == "geometry" && object_ == Kind::state) {
      geometry_depth_ = depth_;
    }
    return;
  }
  if (geometry_depth_ == 0 || position_depth_ > 0 || !is_gml_space(element.space)) return;
  if (const auto name = element.attribute("", "srsName"); name && srids_.back() == 0) {
    srids_.back() = srid_of_srs_name(without_blanks(*name));
  }
  if (element.name != "pos" && element.name != "coordinates") return;
  position_depth_ = depth_;
  position_.clear();
}

void CellGraphReader::text(std::string_view text) {
  if (position_depth_ == 0 || position_depth_ != depth_) return;
  if (position_.size() <= kLongestPosition) position_.append(text);
}

void CellGraphReader::end_position() {
  geometry::GraphState& state = graph_.states.back();
  if (state.position || !state.fault.empty()) return;
  const auto words = position_.size() <= kLongestPosition ? words_of(position_, " \t\r\n,")
                                                          : std::vector<std::string_view>();
  if (words.size() != 3) {
    state.fault = "its position has not three numbers";
    return;
  }
  std::array<GridNumber, 3> position;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto number = exact_number(words[axis]);
    if (!number) {
      state.fault = "its position has a part that is no number";
      return;
    }
    if (number->is_rounded) state.fault = "its position has more than 18 digits";
    position[axis] = number->value;
  }
  if (state.fault.empty()) state.position = position;
}

void CellGraphReader::end() {
  if (position_depth_ == depth_) {
    end_position();
    position_depth_ = 0;
  }
  if (geometry_depth_ == depth_) geometry_depth_ = 0;
  if (object_depth_ == depth_) {
    object_depth_ = 0;
    object_ = Kind::none;
  }
  if (member_depth_ == depth_) {
    member_depth_ = 0;
    member_ = Kind::none;
  }
  if (model_depth_ == depth_) model_depth_ = 0;
  --depth_;
}

geometry::CellGraph CellGraphReader::take() {
  const IdIndex cells(graph_.cells);
  const IdIndex boundaries(graph_.boundaries);
  const IdIndex states(graph_.states);
  const IdIndex transitions(graph_.transitions);
  for (geometry::GraphCell& cell : graph_.cells) states.resolve(cell.duals);
  for (geometry::GraphBoundary& boundary : graph_.boundaries) transitions.resolve(boundary.duals);
  for (geometry::GraphState& state : graph_.states) {
    cells.resolve(state.duals);
    transitions.resolve(state.transitions);
  }
  for (geometry::GraphTransition& transition : graph_.transitions) {
    boundaries.resolve(transition.duals);
    states.resolve(transition.states);
  }
  return std::move(graph_);
}

}  // namespace watertight::formats
