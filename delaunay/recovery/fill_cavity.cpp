// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/recovery/fill_cavity.h"

#include <algorithm>
#include <array>
#include <utility>

#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/intersection/triangle_triangle.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

class Search {
 public:
  Search(std::span<const Point> points, Cavity cavity, std::size_t& steps)
      : points_(points),
        steps_(steps),
        outer_vertex_(cavity.outer_vertex),
        base_(cavity.base),
        corners_(std::move(cavity.inner_vertices)) {
    for (Triangle& triangle : cavity.front) {
      triangle = rotated(triangle);
      corners_.insert(corners_.end(), triangle.begin(), triangle.end());
    }
    std::sort(corners_.begin(), corners_.end());
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
    levels_.push_back({std::move(cavity.front), {}, 0, {}});
  }

  /// Goes down a level for each tetrahedron that fits, and up when none does.
  bool run() {
    levels_.back().choices = choices(levels_.back().front);
    while (!levels_.empty()) {
      Level& level = levels_.back();
      if (level.front.empty()) return true;
      if (level.next == level.choices.size()) {
        levels_.pop_back();
        continue;
      }
      if (steps_ == 0) return false;
      const Choice choice = level.choices[level.next++];
      level.placed = placed(level.front.back(), choice.apex);
      Level below;
      below.front = front_after(level.front, level.placed);
      if (below.front.size() > kLargestFront) continue;
      if (!below.front.empty()) below.choices = choices(below.front);
      levels_.push_back(std::move(below));
    }
    return false;
  }

  Filling result(bool is_filled) && {
    Filling filling;
    for (const Level& level : levels_) {
      if (is_filled && !level.front.empty()) filling.tetrahedra.push_back(level.placed);
    }
    std::sort(blocked_.begin(), blocked_.end());
    blocked_.erase(std::unique(blocked_.begin(), blocked_.end()), blocked_.end());
    filling.blocked = std::move(blocked_);
    return filling;
  }

 private:
  struct Choice {
    Index apex = kNone;
    int closed = 0;  // the faces of the front that the tetrahedron closes, besides its base
  };
  struct Level {
    std::vector<Triangle> front;
    std::vector<Choice> choices;  // for the last triangle of the front
    std::size_t next = 0;
    geometry::Tetrahedron placed{};
  };

  const Point& at(Index vertex) const { return points_[vertex]; }

  static geometry::Tetrahedron placed(const Triangle& base, Index apex) {
    return {base[0], base[1], base[2], apex};
  }

  static std::vector<Triangle> front_after(std::vector<Triangle> front,
                                           const geometry::Tetrahedron& tetrahedron) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Triangle face = rotated(inward_face(tetrahedron, corner));
      const auto found = std::find(front.begin(), front.end(), face);
      if (found != front.end()) {
        front.erase(found);
      } else {
        front.push_back(rotated(reversed(face)));
      }
    }
    return front;
  }

  /// The apexes of tetrahedra over the last triangle of the front that lie inside, those that close
  /// most first.
  std::vector<Choice> choices(const std::vector<Triangle>& front) {
    std::vector<Choice> found;
    const Triangle& base = front.back();
    for (const Index apex : corners_) {
      if (steps_ == 0) break;
      if (has_vertex(base, apex)) continue;
      if (geometry::orient3d(at(base[0]), at(base[1]), at(base[2]), at(apex)) <= 0) continue;
      --steps_;
      const int closed = closed_by(front, placed(base, apex));
      if (closed >= 0) found.push_back({apex, closed});
    }
    if (found.empty()) blocked_.push_back(base);
    std::stable_sort(found.begin(), found.end(),
                     [](const Choice& a, const Choice& b) { return a.closed > b.closed; });
    return found;
  }

  template <class Vertices>
  static bool has_vertex(const Vertices& vertices, Index vertex) {
    return std::find(vertices.begin(), vertices.end(), vertex) != vertices.end();
  }

  /// The number of faces of the front, besides the base, that are faces of the tetrahedron; -1 if
  /// the tetrahedron is not inside.
  int closed_by(const std::vector<Triangle>& front,
                const geometry::Tetrahedron& tetrahedron) const {
    if (crosses_hull(tetrahedron) || holds_corner(tetrahedron)) return -1;
    int closed = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Triangle face = rotated(inward_face(tetrahedron, corner));
      if (std::find(front.begin(), front.end(), face) != front.end()) {
        ++closed;
      } else if (!is_free(front, face)) {
        return -1;
      }
    }
    return closed;
  }

  /// True if the tetrahedron has the outer vertex, and a corner that is not in the plane of the
  /// hull.
  bool crosses_hull(const geometry::Tetrahedron& tetrahedron) const {
    if (!has_vertex(tetrahedron, outer_vertex_)) return false;
    return std::any_of(tetrahedron.begin(), tetrahedron.end(), [&](Index vertex) {
      return vertex != outer_vertex_ && !has_vertex(base_, vertex) &&
             geometry::orient3d(at(base_[0]), at(base_[1]), at(base_[2]), at(vertex)) != 0;
    });
  }

  /// True if a corner of the cavity lies in the tetrahedron without being its vertex.
  bool holds_corner(const geometry::Tetrahedron& tetrahedron) const {
    return std::any_of(corners_.begin(), corners_.end(), [&](Index vertex) {
      if (std::find(tetrahedron.begin(), tetrahedron.end(), vertex) != tetrahedron.end()) {
        return false;
      }
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const auto [a, b, c] = inward_face(tetrahedron, corner);
        if (geometry::orient3d(at(a), at(b), at(c), at(vertex)) < 0) return false;
      }
      return true;
    });
  }

  /// True if a face that is not in the front meets the front in common vertices and edges only.
  bool is_free(const std::vector<Triangle>& front, const Triangle& face) const {
    const Box box = box_of(face);
    return std::none_of(front.begin(), front.end(), [&](const Triangle& other) {
      return overlap(box, other) &&
             is_intersection(geometry::classify_contact(points_, face, other));
    });
  }

  Box box_of(const Triangle& t) const {
    Box box{at(t[0]), at(t[0])};
    for (const Index vertex : {t[1], t[2]}) {
      const Point& p = at(vertex);
      box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y), std::min(box.min.z, p.z)};
      box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y), std::max(box.max.z, p.z)};
    }
    return box;
  }

  /// Whether a box and the box of a triangle have a point in common.
  bool overlap(const Box& box, const Triangle& t) const {
    const Point& a = at(t[0]);
    const Point& b = at(t[1]);
    const Point& c = at(t[2]);
    return std::max({a.x, b.x, c.x}) >= box.min.x && std::min({a.x, b.x, c.x}) <= box.max.x &&
           std::max({a.y, b.y, c.y}) >= box.min.y && std::min({a.y, b.y, c.y}) <= box.max.y &&
           std::max({a.z, b.z, c.z}) >= box.min.z && std::min({a.z, b.z, c.z}) <= box.max.z;
  }

  std::span<const Point> points_;
  std::size_t& steps_;
  Index outer_vertex_;
  Triangle base_;
  std::vector<Index> corners_;
  std::vector<Level> levels_;
  std::vector<Triangle> blocked_;
};

}  // namespace

Filling fill_cavity(std::span<const Point> points, Cavity cavity, std::size_t& steps) {
  if (cavity.front.size() > kLargestFront) return {};
  Search search(points, std::move(cavity), steps);
  const bool is_filled = search.run();
  return std::move(search).result(is_filled);
}

}  // namespace watertight::delaunay
