// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/indoor/indoor_links.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/quantity.h"
#include "validate/indoor/indoor_names.h"

namespace watertight::validate {
namespace {

using geometry::GraphElement;
using geometry::GraphLink;

/// The most bytes of an id or a reference in a finding.
constexpr std::size_t kLongestName = 200;

std::string cut(std::string_view text) {
  if (text.size() <= kLongestName) return std::string(text);
  std::size_t end = kLongestName;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return std::string(text.substr(0, end)).append("...");
}

std::string in_quotes(std::string_view text) {
  std::string result(1, '\'');
  return result.append(cut(text)).append(1, '\'');
}

/// True if one of the links leads to the element with this index.
bool leads_to(const std::vector<GraphLink>& links, Index target) {
  return std::any_of(links.begin(), links.end(),
                     [&](const GraphLink& link) { return link.target == target; });
}

Index first_target(const std::vector<GraphLink>& links) {
  return links.empty() ? kNone : links.front().target;
}

class FaultFinder {
 public:
  FaultFinder(const geometry::CellGraph& graph, const IndoorLinks& links)
      : graph_(graph), links_(links) {}

  std::vector<LinkFault> run() {
    std::vector<bool> is_named(graph_.states.size(), false);
    for (Index i = 0; i < graph_.cells.size(); ++i) check_cell(i, is_named);
    for (const geometry::GraphBoundary& boundary : graph_.boundaries) {
      check_duals(kNone, "boundary", boundary, "transition");
    }
    for (Index i = 0; i < graph_.states.size(); ++i) check_state(i, is_named[i]);
    for (const geometry::GraphTransition& transition : graph_.transitions) {
      check_transition(transition);
    }
    return std::move(faults_);
  }

 private:
  void add(Index cell, std::string_view noun, const GraphElement& element, std::string_view rest) {
    std::string detail(noun);
    detail.append(" ").append(element_name(element)).append(" ").append(rest);
    faults_.push_back({cell, element.line, std::move(detail)});
  }

  /// Reports a link that leads to no element of the document, or to several.
  bool check_target(Index cell, std::string_view noun, const GraphElement& element,
                    const GraphLink& link, std::string_view target_noun) {
    if (link.target != kNone) return true;
    std::string rest = "refers to ";
    rest.append(quoted_reference(link));
    if (link.found > 1) {
      rest.append(", but ")
          .append(quantity(link.found, target_noun, target_noun == "boundary" ? "boundaries" : ""))
          .append(" have this id");
    } else {
      rest.append(", but no ").append(target_noun).append(" of the document has this id");
    }
    add(cell, noun, element, rest);
    return false;
  }

  /// True if the element has one duality, which leads to an element.
  bool check_duals(Index cell, std::string_view noun, const GraphElement& element,
                   std::string_view target_noun) {
    if (element.duals.empty()) return false;
    if (element.duals.size() > 1) {
      std::string rest = "has ";
      rest.append(std::to_string(element.duals.size())).append(" dualities instead of one");
      add(cell, noun, element, rest);
      return false;
    }
    return check_target(cell, noun, element, element.duals.front(), target_noun);
  }

  void check_cell(Index number, std::vector<bool>& is_named) {
    const geometry::GraphCell& cell = graph_.cells[number];
    if (!check_duals(number, "cell", cell, "state")) return;
    const Index dual = cell.duals.front().target;
    const geometry::GraphState& state = graph_.states[dual];
    if (leads_to(state.duals, number)) return;
    is_named[dual] = true;
    std::string rest = "and its state ";
    rest.append(element_name(state)).append(" are not linked both ways: the state refers to ");
    const Index other = first_target(state.duals);
    if (other != kNone) rest.append("cell ").append(element_name(graph_.cells[other]));
    if (other == kNone) {
      rest.append(state.duals.empty() ? "no cell" : quoted_reference(state.duals.front()));
    }
    add(number, "cell", cell, rest);
  }

  void check_state(Index number, bool is_named) {
    const geometry::GraphState& state = graph_.states[number];
    const Index own = links_.cell_of(number);
    if (check_duals(own, "state", state, "cell") && !is_named) {
      const geometry::GraphCell& cell = graph_.cells[own];
      // A duality that only the state states is allowed. The cell has a finding of its own if its
      // duality leads nowhere.
      if (first_target(cell.duals) != kNone && !leads_to(cell.duals, number)) {
        std::string rest = "refers to cell ";
        rest.append(element_name(cell)).append(", which has another state");
        add(own, "state", state, rest);
      }
    }
    for (const GraphLink& link : state.transitions) {
      if (!check_target(own, "state", state, link, "transition")) continue;
      const geometry::GraphTransition& transition = graph_.transitions[link.target];
      if (leads_to(transition.states, number)) continue;
      std::string rest = "refers to transition ";
      rest.append(element_name(transition)).append(", which connects other states");
      add(own, "state", state, rest);
    }
  }

  void check_transition(const geometry::GraphTransition& transition) {
    Index cell = kNone;  // of one of its states
    for (const GraphLink& link : transition.states) {
      if (cell == kNone) cell = links_.cell_of(link.target);
    }
    if (transition.states.size() != 2) {
      std::string rest = "connects ";
      rest.append(quantity(transition.states.size(), "state")).append(" instead of two");
      add(cell, "transition", transition, rest);
    }
    for (const GraphLink& link : transition.states) {
      check_target(cell, "transition", transition, link, "state");
    }
    check_duals(cell, "transition", transition, "boundary");
  }

  const geometry::CellGraph& graph_;
  const IndoorLinks& links_;
  std::vector<LinkFault> faults_;
};

}  // namespace

std::string element_name(const GraphElement& element) {
  std::string name = element.id.empty() ? std::string("on") : in_quotes(element.id);
  name.append(element.id.empty() ? " line " : " (line ").append(std::to_string(element.line));
  if (!element.id.empty()) name.append(1, ')');
  return name;
}

std::string quoted_reference(const GraphLink& link) { return in_quotes(link.reference); }

IndoorLinks::IndoorLinks(const geometry::CellGraph& graph)
    : graph_(graph), states_(graph.cells.size(), kNone), cells_(graph.states.size(), kNone) {
  for (Index i = 0; i < graph.states.size(); ++i) cells_[i] = first_target(graph.states[i].duals);
  for (Index i = 0; i < graph.cells.size(); ++i) {
    states_[i] = first_target(graph.cells[i].duals);
    if (states_[i] != kNone && cells_[states_[i]] == kNone) cells_[states_[i]] = i;
  }
  for (Index i = 0; i < graph.states.size(); ++i) {
    if (cells_[i] == kNone) continue;
    if (states_[cells_[i]] == kNone && graph.cells[cells_[i]].duals.empty()) {
      states_[cells_[i]] = i;
    }
  }
}

std::vector<LinkFault> IndoorLinks::faults() const { return FaultFinder(graph_, *this).run(); }

}  // namespace watertight::validate
