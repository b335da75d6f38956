// SPDX-License-Identifier: GPL-3.0-or-later
#include "exhaustive.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace watertight::fill::test {
namespace {

using geometry::Vector3;
using Edge = std::pair<Index, Index>;
constexpr double kPi = 3.141592653589793;

Edge turned(const Edge& edge) { return {edge.second, edge.first}; }

/// The border edges in their sense, with the facets behind them.
std::map<Edge, Vector3> borders_of(std::span<const Loop> loops, const FillOptions& options) {
  std::map<Edge, Vector3> borders;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (std::size_t j = 0; j < loops[i].size(); ++j) {
      const Edge edge{loops[i][j], loops[i][(j + 1) % loops[i].size()]};
      borders[edge] = options.behind.empty() ? Vector3{} : options.behind[i][j];
    }
  }
  return borders;
}

/// How many fans the triangles around a vertex form.
std::size_t fans_at(std::span<const Triangle> triangles, Index vertex) {
  std::map<Index, Index> next;
  for (const Triangle& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (triangle[i] == vertex) next[triangle[(i + 1) % 3]] = triangle[(i + 2) % 3];
    }
  }
  std::set<Index> ends;
  for (const auto& [from, to] : next) ends.insert(to);
  std::size_t fans = 0;
  std::size_t passed = 0;
  for (const auto& [from, to] : next) {
    if (ends.contains(from)) continue;
    ++fans;
    for (auto at = next.find(from); at != next.end(); at = next.find(at->second)) ++passed;
  }
  return passed == next.size() ? fans : fans + 1;
}

class Search {
 public:
  Search(std::span<const Point> points, std::span<const Loop> loops, const FillOptions& options)
      : points_(points), loops_(loops), options_(options), borders_(borders_of(loops, options)) {
    for (const Loop& loop : loops) vertices_.insert(vertices_.end(), loop.begin(), loop.end());
    most_triangles_ = vertices_.size() + 2 * loops.size() - 4;
  }

  std::optional<double> run() {
    continue_from(0);
    return best_;
  }

 private:
  double angle_at(const Edge& edge, const Vector3& first, const Vector3& second) const {
    const Vector3 along = geometry::difference(points_[edge.second], points_[edge.first]);
    const Vector3 a = geometry::cross(along, first);
    const Vector3 b = geometry::cross(along, second);
    return kPi - std::atan2(geometry::length(geometry::cross(a, b)), geometry::dot(a, b));
  }

  /// The border sense of an edge: +1 along the loop, -1 against it, 0 for no border.
  int border_sense(const Edge& edge) const {
    return borders_.contains(edge) ? 1 : borders_.contains(turned(edge)) ? -1 : 0;
  }

  bool may_add(const Edge& edge) const {
    if (thirds_.contains(edge)) return false;
    const int sense = border_sense(edge);
    if (sense == 0) return true;
    if (thirds_.contains(turned(edge))) return false;
    return sense > 0 || (options_.has_both_senses && !is_first_loop(edge));
  }
  bool is_first_loop(const Edge& edge) const {
    return std::ranges::find(loops_[0], edge.first) != loops_[0].end();
  }

  /// The next directed edge that needs a triangle.
  std::optional<Edge> open_edge() const {
    for (const auto& [edge, third] : thirds_) {
      if (border_sense(edge) == 0 && !thirds_.contains(turned(edge))) return turned(edge);
    }
    const Edge first{loops_[0][0], loops_[0][1]};
    if (!thirds_.contains(first)) return first;
    return std::nullopt;
  }

  /// The angle that a triangle's side adds.
  double angle_on(const Edge& edge, Index third) const {
    const Vector3 own = geometry::difference(points_[third], points_[edge.first]);
    if (border_sense(edge) != 0) {
      const Edge along = border_sense(edge) > 0 ? edge : turned(edge);
      const Vector3& behind = borders_.at(along);
      return behind == Vector3{} ? 0 : angle_at(edge, own, behind);
    }
    const auto other = thirds_.find(turned(edge));
    if (other == thirds_.end()) return 0;
    return angle_at(edge, own, geometry::difference(points_[other->second], points_[edge.first]));
  }

  void continue_from(double weight) {
    if (best_ && weight >= *best_ - 1e-12) return;
    const std::optional<Edge> open = open_edge();
    if (!open) {
      if (is_filling(loops_, triangles_, options_.has_both_senses)) best_ = weight;
      return;
    }
    if (triangles_.size() == most_triangles_) return;
    for (const Index third : vertices_) {
      if (third == open->first || third == open->second) continue;
      try_triangle({open->first, open->second, third}, weight);
    }
  }

  void try_triangle(const Triangle& triangle, double weight) {
    if (options_.is_allowed) {
      Triangle sorted = triangle;
      std::ranges::sort(sorted, {}, [&](Index point) { return points_[point]; });
      if (!options_.is_allowed(sorted)) return;
    }
    const auto side = [&](std::size_t i) { return Edge{triangle[i], triangle[(i + 1) % 3]}; };
    for (std::size_t i = 0; i < 3; ++i) {
      if (!may_add(side(i))) return;
    }
    const Vector3 normal =
        geometry::cross(geometry::difference(points_[triangle[1]], points_[triangle[0]]),
                        geometry::difference(points_[triangle[2]], points_[triangle[0]]));
    if (options_.objective == Objective::area) {
      weight += geometry::length(normal) / 2;
    } else {
      for (std::size_t i = 0; i < 3; ++i) weight += angle_on(side(i), triangle[(i + 2) % 3]);
    }
    for (std::size_t i = 0; i < 3; ++i) thirds_[side(i)] = triangle[(i + 2) % 3];
    triangles_.push_back(triangle);
    continue_from(weight);
    triangles_.pop_back();
    for (std::size_t i = 0; i < 3; ++i) thirds_.erase(side(i));
  }

  std::span<const Point> points_;
  std::span<const Loop> loops_;
  const FillOptions& options_;
  std::map<Edge, Vector3> borders_;
  std::vector<Index> vertices_;
  std::size_t most_triangles_ = 0;
  std::vector<Triangle> triangles_;
  std::map<Edge, Index> thirds_;  // directed edge -> the third vertex of its triangle
  std::optional<double> best_;
};

}  // namespace

std::optional<double> least_weight(std::span<const Point> points, std::span<const Loop> loops,
                                   const FillOptions& options) {
  return Search(points, loops, options).run();
}

bool is_filling(std::span<const Loop> loops, std::span<const Triangle> triangles,
                bool has_both_senses) {
  const std::map<Edge, Vector3> borders = borders_of(loops, {});
  std::set<Edge> used;
  for (const Triangle& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!used.insert({triangle[i], triangle[(i + 1) % 3]}).second) return false;
    }
  }
  std::size_t border_count = 0;
  for (const Edge& edge : used) {
    const bool is_single = !used.contains(turned(edge));
    const bool is_along = borders.contains(edge);
    const bool is_against = has_both_senses && borders.contains(turned(edge));
    if (is_single != (is_along || is_against)) return false;
    border_count += is_single ? 1 : 0;
  }
  std::size_t vertex_count = 0;
  for (const Loop& loop : loops) {
    vertex_count += loop.size();
    for (const Index vertex : loop) {
      if (fans_at(triangles, vertex) != 1) return false;
    }
  }
  // With one fan at each vertex and the right counts a surface has Euler number 2 - k; connected it
  // has no handles.
  const std::size_t edge_count = (used.size() + border_count) / 2;
  if (triangles.size() != vertex_count + 2 * loops.size() - 4) return false;
  if (edge_count - border_count != vertex_count + 3 * loops.size() - 6) return false;
  std::set<Index> reached{triangles[0][0]};
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const Triangle& triangle : triangles) {
      if (std::ranges::any_of(triangle, [&](Index v) { return reached.contains(v); })) {
        reached.insert(triangle.begin(), triangle.end());
      }
    }
  }
  return reached.size() == vertex_count;
}

}  // namespace watertight::fill::test
