// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/rules/open_edges.h"

#include <cmath>
#include <map>
#include <tuple>

#include "geometry/disjoint_sets.h"
#include "geometry/predicates/predicates.h"
#include "validate/overlap/box_tree.h"

namespace watertight::validate {
namespace {

/// The largest number of pairs of an edge and a vertex that are tested in a shell, after the tree
/// has left out pairs that are far apart: a second of work. Only vertices close to many edges come
/// near this number.
constexpr std::uint64_t kMostPairs = 50'000'000;
/// A bound far above the rounding error of the products in is_near(), relative to their size.
constexpr double kRounding = 1e-12;

struct End {
  Index vertex = 0;
  std::size_t edge = 0;  // the index of an open edge that ends at the vertex
};

class OpenEdgeExaminer {
 public:
  OpenEdgeExaminer(const Solid& solid, std::span<const EdgeUse> open)
      : vertices_(solid.vertices()), open_(open), is_explained_(open.size(), false) {}

  OpenEdges examine(const CancelPoll& is_cancelled) {
    collect_ends();
    const BoxTree tree(end_boxes());
    for (std::size_t e = 0; e < open_.size() && result_.is_complete; ++e) {
      result_.is_complete = !is_cancelled();
      find_junctions(tree, e);
    }
    collect_borders();
    return std::move(result_);
  }

 private:
  void collect_ends();
  std::vector<Box> end_boxes() const;
  void find_junctions(const BoxTree& tree, std::size_t number);
  void explain(std::size_t number, const std::vector<Index>& chain);
  void collect_borders();
  bool is_inside(const EdgeUse& edge, Index vertex) const;

  std::span<const Point> vertices_;
  std::span<const EdgeUse> open_;
  std::vector<End> ends_;  // one entry for each end of open edges, ascending by vertex
  std::uint64_t pairs_ = 0;
  std::vector<bool> is_explained_;
  OpenEdges result_;
};

void OpenEdgeExaminer::collect_ends() {
  for (std::size_t e = 0; e < open_.size(); ++e) {
    for (const Index vertex : {open_[e].low, open_[e].high}) ends_.push_back({vertex, e});
  }
  std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) {
    return std::tie(a.vertex, a.edge) < std::tie(b.vertex, b.edge);
  });
  ends_.erase(std::unique(ends_.begin(), ends_.end(),
                          [](const End& a, const End& b) { return a.vertex == b.vertex; }),
              ends_.end());
}

std::vector<Box> OpenEdgeExaminer::end_boxes() const {
  std::vector<Box> boxes;
  boxes.reserve(ends_.size());
  for (const End& end : ends_) boxes.push_back({vertices_[end.vertex], vertices_[end.vertex]});
  return boxes;
}

/// False only if no point of the box lies on the segment ab. The test is by separating axes: the
/// coordinate axes, and the cross products of the segment with the edges of the box.
bool is_near(const Point& a, const Point& b, const Box& box) {
  Box around;
  around.include(a);
  around.include(b);
  if (!around.overlaps(box)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const double along_u = b[u] - a[u];
    const double along_v = b[v] - a[v];
    const double from_u = (box.min[u] / 2 + box.max[u] / 2) - a[u];
    const double from_v = (box.min[v] / 2 + box.max[v] / 2) - a[v];
    const double half_u = box.max[u] / 2 - box.min[u] / 2;
    const double half_v = box.max[v] / 2 - box.min[v] / 2;
    const double distance = std::abs(along_u * from_v - along_v * from_u);
    const double reach = std::abs(along_u) * half_v + std::abs(along_v) * half_u;
    const auto size = [&](int i) {
      return std::abs(a[i]) + std::abs(b[i]) + std::abs(box.min[i]) + std::abs(box.max[i]);
    };
    if (distance > reach + kRounding * size(u) * size(v)) return false;
  }
  return true;
}

bool OpenEdgeExaminer::is_inside(const EdgeUse& edge, Index vertex) const {
  if (vertex == edge.low || vertex == edge.high) return false;
  const Point& a = vertices_[edge.low];
  const Point& b = vertices_[edge.high];
  const Point& p = vertices_[vertex];
  for (int axis = 0; axis < 3; ++axis) {
    if (p[axis] < std::min(a[axis], b[axis]) || p[axis] > std::max(a[axis], b[axis])) return false;
  }
  return geometry::are_collinear(a, b, p);
}

void OpenEdgeExaminer::find_junctions(const BoxTree& tree, std::size_t number) {
  const EdgeUse& edge = open_[number];
  const Point& a = vertices_[edge.low];
  const Point& b = vertices_[edge.high];
  std::vector<Index> found;  // indices into ends_
  tree.visit([&](const Box& box) { return is_near(a, b, box); },
             [&](Index end) {
               ++pairs_;
               if (is_inside(edge, ends_[end].vertex)) found.push_back(end);
             });
  if (pairs_ > kMostPairs) result_.is_complete = false;
  if (found.empty()) return;
  std::sort(found.begin(), found.end(), [&](Index x, Index y) {
    return vertices_[ends_[x].vertex] < vertices_[ends_[y].vertex];
  });
  std::vector<Index> chain;
  for (const Index end : found) {
    chain.push_back(ends_[end].vertex);
    result_.junctions.push_back({edge, open_[ends_[end].edge], ends_[end].vertex});
  }
  explain(number, chain);
}

/// Notes open edges that together cover another open edge from the other side: neither these edges
/// nor the covered edge belong to a border.
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
  std::map<Index, Index> group_of;  // vertex -> its number among the vertices of border edges
  for (std::size_t e = 0; e < open_.size(); ++e) {
    if (is_explained_[e]) continue;
    for (const Index vertex : {open_[e].low, open_[e].high}) {
      group_of.emplace(vertex, static_cast<Index>(group_of.size()));
    }
  }
  geometry::DisjointSets sets(group_of.size());
  for (std::size_t e = 0; e < open_.size(); ++e) {
    if (!is_explained_[e]) sets.join(group_of[open_[e].low], group_of[open_[e].high]);
  }
  std::map<Index, std::size_t> border_of;  // root of a set of vertices -> index of its border
  for (std::size_t e = 0; e < open_.size(); ++e) {
    if (is_explained_[e]) continue;
    const Index root = sets.root(group_of[open_[e].low]);
    const auto [place, is_new] = border_of.emplace(root, result_.borders.size());
    if (is_new) result_.borders.emplace_back();
    result_.borders[place->second].edges.push_back(open_[e]);
  }
}

}  // namespace

OpenEdges examine_open_edges(const Solid& solid, std::span<const EdgeUse> open,
                             const CancelPoll& is_cancelled) {
  return OpenEdgeExaminer(solid, open).examine(is_cancelled);
}

}  // namespace watertight::validate
