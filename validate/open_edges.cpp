// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/open_edges.h"

#include <map>

#include "geometry/predicates.h"

namespace watertight {
namespace {

/// Pairs of edge and vertex looked at per shell: about a second of work.
constexpr std::uint64_t kMostPairs = 50'000'000;

struct End {
  Index vertex = 0;
  std::size_t edge = 0;  // an open edge that ends there
};

class OpenEdgeExaminer {
 public:
  OpenEdgeExaminer(const Solid& solid, std::span<const EdgeUse> open)
      : vertices_(solid.vertices()), open_(open), is_explained_(open.size(), false) {}

  OpenEdges examine() {
    collect_ends();
    for (std::size_t e = 0; e < open_.size() && result_.is_complete; ++e) find_junctions(e);
    collect_borders();
    return std::move(result_);
  }

 private:
  void collect_ends();
  void find_junctions(std::size_t number);
  void explain(std::size_t number, const std::vector<Index>& chain);
  void collect_borders();
  bool is_inside(const EdgeUse& edge, Index vertex) const;

  std::span<const Point> vertices_;
  std::span<const EdgeUse> open_;
  std::vector<End> ends_;  // one per vertex, sorted along axis_
  int axis_ = 0;
  std::uint64_t pairs_ = 0;
  std::vector<bool> is_explained_;
  OpenEdges result_;
};

void OpenEdgeExaminer::collect_ends() {
  Box box;
  for (std::size_t e = 0; e < open_.size(); ++e) {
    for (const Index vertex : {open_[e].low, open_[e].high}) {
      ends_.push_back({vertex, e});
      box.include(vertices_[vertex]);
    }
  }
  for (int axis = 1; axis < 3; ++axis) {
    if (box.max[axis] - box.min[axis] > box.max[axis_] - box.min[axis_]) axis_ = axis;
  }
  std::sort(ends_.begin(), ends_.end(), [&](const End& a, const End& b) {
    return std::tuple(vertices_[a.vertex][axis_], a.vertex, a.edge) <
           std::tuple(vertices_[b.vertex][axis_], b.vertex, b.edge);
  });
  ends_.erase(std::unique(ends_.begin(), ends_.end(),
                          [](const End& a, const End& b) { return a.vertex == b.vertex; }),
              ends_.end());
}

bool OpenEdgeExaminer::is_inside(const EdgeUse& edge, Index vertex) const {
  if (vertex == edge.low || vertex == edge.high) return false;
  const Point& a = vertices_[edge.low];
  const Point& b = vertices_[edge.high];
  const Point& p = vertices_[vertex];
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] < std::min(a[axis], b[axis]) || p[axis] > std::max(a[axis], b[axis])) return false;
  }
  return are_collinear(a, b, p);
}

void OpenEdgeExaminer::find_junctions(std::size_t number) {
  const EdgeUse& edge = open_[number];
  const auto [from, to] = std::minmax({vertices_[edge.low][axis_], vertices_[edge.high][axis_]});
  auto end = std::lower_bound(ends_.begin(), ends_.end(), from, [&](const End& e, double value) {
    return vertices_[e.vertex][axis_] < value;
  });
  std::vector<Index> chain;
  for (; end != ends_.end() && vertices_[end->vertex][axis_] <= to; ++end) {
    if (++pairs_ > kMostPairs) {
      result_.is_complete = false;
      return;
    }
    if (!is_inside(edge, end->vertex)) continue;
    chain.push_back(end->vertex);
    result_.junctions.push_back({edge, open_[end->edge], end->vertex});
  }
  if (!chain.empty()) explain(number, chain);
}

/// Open edges that together cover the edge from the other side are no border of their own.
void OpenEdgeExaminer::explain(std::size_t number, const std::vector<Index>& chain) {
  std::vector<Index> stops = chain;
  stops.push_back(open_[number].low);
  stops.push_back(open_[number].high);
  std::sort(stops.begin(), stops.end(),
            [&](Index a, Index b) { return vertices_[a] < vertices_[b]; });
  std::vector<std::size_t> parts;
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const std::pair<Index, Index> key = std::minmax(stops[i - 1], stops[i]);
    const auto part = std::lower_bound(
        open_.begin(), open_.end(), key,
        [](const EdgeUse& e, const auto& k) { return std::pair(e.low, e.high) < k; });
    if (part == open_.end() || std::pair(part->low, part->high) != key) return;
    parts.push_back(static_cast<std::size_t>(part - open_.begin()));
  }
  is_explained_[number] = true;
  for (const std::size_t part : parts) is_explained_[part] = true;
}

void OpenEdgeExaminer::collect_borders() {
  std::map<Index, Index> group_of;  // vertex -> number
  for (std::size_t e = 0; e < open_.size(); ++e) {
    if (is_explained_[e]) continue;
    for (const Index vertex : {open_[e].low, open_[e].high}) {
      group_of.emplace(vertex, static_cast<Index>(group_of.size()));
    }
  }
  DisjointSets sets(group_of.size());
  for (std::size_t e = 0; e < open_.size(); ++e) {
    if (!is_explained_[e]) sets.join(group_of[open_[e].low], group_of[open_[e].high]);
  }
  std::map<Index, std::size_t> border_of;  // root -> border
  for (std::size_t e = 0; e < open_.size(); ++e) {
    if (is_explained_[e]) continue;
    const Index root = sets.root(group_of[open_[e].low]);
    const auto [place, is_new] = border_of.emplace(root, result_.borders.size());
    if (is_new) result_.borders.emplace_back();
    result_.borders[place->second].edges.push_back(open_[e]);
  }
}

}  // namespace

OpenEdges examine_open_edges(const Solid& solid, std::span<const EdgeUse> open) {
  return OpenEdgeExaminer(solid, open).examine();
}

}  // namespace watertight
