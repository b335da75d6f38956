// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/recovery/fill_cavity.h"

#include <algorithm>
#include <array>
#include <utility>

#include "delaunay/recovery/signs.h"
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
    geometry::Box box;
    for (const Index corner : corners_) box.include(at(corner));
    signs_ = Signs(box);
    levels_.push_back({std::move(cavity.front), {}, 0, {}});
  }

  /// Goes down a level for each tetrahedron that fits, and up when none does.
  bool run() {
    levels_.back().choices = choices(levels_.back().front);
    while (!levels_.empty()) {
      Level& level = levels_.back();
      if (level.front.empty()) return true;
      if (level.next == level.choices.size()) {
        if (!level.has_room) blocked_.push_back(level.front.back());
        levels_.pop_back();
        continue;
      }
      if (steps_ == 0) return false;
      --steps_;
      level.placed = placed(level.front.back(), level.choices[level.next++].apex);
      if (!is_inside(level.front, level.placed)) continue;
      level.has_room = true;
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
    double sphere = 0;
  };
  struct Level {
    std::vector<Triangle> front;
    std::vector<Choice> choices;  // for the last triangle of the front
    std::size_t next = 0;
    geometry::Tetrahedron placed{};
    bool has_room = false;  // for a tetrahedron over the last triangle
  };

  const Point& at(Index vertex) const { return points_[vertex]; }
  int side(Index a, Index b, Index c, Index d) const {
    return signs_.orient3d(at(a), at(b), at(c), at(d));
  }

  static geometry::Tetrahedron placed(const Triangle& base, Index apex) {
    return {base[0], base[1], base[2], apex};
  }

  static std::vector<Triangle>::const_iterator find(const std::vector<Triangle>& front,
                                                    const Triangle& face) {
    return std::find_if(front.begin(), front.end(), [&](const Triangle& other) {
      return other[0] == face[0] && other[1] == face[1] && other[2] == face[2];
    });
  }

  static std::vector<Triangle> front_after(std::vector<Triangle> front,
                                           const geometry::Tetrahedron& tetrahedron) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Triangle face = rotated(inward_face(tetrahedron, corner));
      const auto found = find(front, face);
      if (found != front.end()) {
        front.erase(found);
      } else {
        front.push_back(rotated(reversed(face)));
      }
    }
    return front;
  }

  /// How far the sphere through a triangle and an apex reaches beyond the triangle, in a measure
  /// of its own for each triangle. Rounded.
  double sphere_beyond(const Triangle& base, Index apex) const {
    const Point u = difference(base[1], base[0]);
    const Point v = difference(base[2], base[0]);
    const Point w = difference(apex, base[0]);
    const Point n = cross(u, v);
    const Point x = cross(v, n);
    const Point y = cross(n, u);
    const double uu = dot(u, u) / dot(n, n);
    const double vv = dot(v, v) / dot(n, n);
    const Point centre{uu * x.x + vv * y.x, uu * x.y + vv * y.y, uu * x.z + vv * y.z};
    return (dot(w, w) - dot(centre, w)) / dot(n, w);
  }
  Point difference(Index to, Index from) const {
    return {at(to).x - at(from).x, at(to).y - at(from).y, at(to).z - at(from).z};
  }
  static double dot(const Point& p, const Point& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
  static Point cross(const Point& p, const Point& q) {
    return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
  }

  /// The apexes above the last triangle of the front, those whose tetrahedra close most first.
  std::vector<Choice> choices(const std::vector<Triangle>& front) const {
    std::vector<Choice> found;
    const auto [a, b, c] = front.back();
    for (const Index apex : corners_) {
      if (apex == a || apex == b || apex == c || side(a, b, c, apex) <= 0) continue;
      const geometry::Tetrahedron tetrahedron = placed(front.back(), apex);
      int closed = 0;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const Triangle face = rotated(inward_face(tetrahedron, corner));
        if (find(front, face) != front.end()) ++closed;
      }
      found.push_back({apex, closed, sphere_beyond(front.back(), apex)});
    }
    std::stable_sort(found.begin(), found.end(), [](const Choice& x, const Choice& y) {
      return x.closed != y.closed ? x.closed > y.closed : x.sphere < y.sphere;
    });
    return found;
  }

  /// True if a tetrahedron over a triangle of the front fits between the others.
  bool is_inside(const std::vector<Triangle>& front,
                 const geometry::Tetrahedron& tetrahedron) const {
    if (crosses_hull(tetrahedron) || holds_corner(tetrahedron)) return false;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Triangle face = rotated(inward_face(tetrahedron, corner));
      if (find(front, face) == front.end() && !is_free(front, face)) return false;
    }
    return true;
  }

  /// True if the tetrahedron has the outer vertex, and a corner that is not in the plane of the
  /// hull.
  bool crosses_hull(const geometry::Tetrahedron& tetrahedron) const {
    if (!has_vertex(tetrahedron, outer_vertex_)) return false;
    return std::any_of(tetrahedron.begin(), tetrahedron.end(), [&](Index vertex) {
      return vertex != outer_vertex_ && !has_vertex(base_, vertex) &&
             side(base_[0], base_[1], base_[2], vertex) != 0;
    });
  }

  /// True if a corner of the cavity lies in the tetrahedron without being its vertex.
  bool holds_corner(const geometry::Tetrahedron& tetrahedron) const {
    return std::any_of(corners_.begin(), corners_.end(), [&](Index vertex) {
      if (has_vertex(tetrahedron, vertex)) {
        return false;
      }
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const auto [a, b, c] = inward_face(tetrahedron, corner);
        if (side(a, b, c, vertex) < 0) return false;
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
    return geometry::box_of(std::array{at(t[0]), at(t[1]), at(t[2])});
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
  Signs signs_;
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
