// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/constrained/wrap_cavity.h"

#include <algorithm>
#include <array>

#include "delaunay/constrained/perturbed_sphere.h"
#include "delaunay/recovery/tetrahedron_mesh.h"
#include "geometry/intersection/triangle_triangle.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

class Wrapping {
 public:
  Wrapping(std::span<const Point> points, std::vector<Triangle> front, TestBudget& budget)
      : points_(points), front_(std::move(front)), budget_(budget) {
    for (Triangle& face : front_) {
      face = rotated(face);
      corners_.insert(corners_.end(), face.begin(), face.end());
    }
    std::sort(corners_.begin(), corners_.end());
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  }

  std::vector<geometry::Tetrahedron> run() {
    std::vector<geometry::Tetrahedron> placed;
    while (!front_.empty()) {
      const Triangle base = front_.back();
      const Index apex = apex_over(base);
      if (apex == kNone || budget_.is_used_up()) return {};
      placed.push_back({base[0], base[1], base[2], apex});
      place(placed.back());
    }
    return placed;
  }

 private:
  const Point& at(Index vertex) const { return points_[vertex]; }

  /// The spheres through the corners of the base are ordered along its normal. The vertex is taken
  /// whose sphere comes first, of those over which a tetrahedron has room.
  Index apex_over(const Triangle& base) {
    Index first = kNone;
    for (const Index v : corners_) {
      if (has_vertex(base, v) || !budget_.take()) continue;
      if (geometry::orient3d(at(base[0]), at(base[1]), at(base[2]), at(v)) <= 0) continue;
      if (first != kNone &&
          !is_in_perturbed_sphere({&at(base[0]), &at(base[1]), &at(base[2]), &at(first)}, at(v))) {
        continue;
      }
      if (has_room({base[0], base[1], base[2], v})) first = v;
    }
    return first;
  }

  /// True if a tetrahedron over a triangle of the front meets the front in common vertices, edges
  /// and faces only, and holds no other corner.
  bool has_room(const geometry::Tetrahedron& tetrahedron) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Triangle face = rotated(inward_face(tetrahedron, corner));
      if (std::find(front_.begin(), front_.end(), face) == front_.end() && !is_free(face)) {
        return false;
      }
    }
    return std::none_of(corners_.begin(), corners_.end(),
                        [&](Index vertex) { return holds(tetrahedron, vertex); });
  }

  bool is_free(const Triangle& face) {
    const Box box = box_of(face);
    for (const Triangle& other : front_) {
      if (!box.overlaps(box_of(other))) continue;
      if (!budget_.take()) return false;
      if (geometry::is_intersection(geometry::classify_contact(points_, face, other))) return false;
    }
    return true;
  }

  bool holds(const geometry::Tetrahedron& tetrahedron, Index vertex) const {
    if (has_vertex(tetrahedron, vertex)) return false;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const auto [a, b, c] = inward_face(tetrahedron, corner);
      if (geometry::orient3d(at(a), at(b), at(c), at(vertex)) < 0) return false;
    }
    return true;
  }

  void place(const geometry::Tetrahedron& tetrahedron) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Triangle face = rotated(inward_face(tetrahedron, corner));
      const auto found = std::find(front_.begin(), front_.end(), face);
      if (found != front_.end()) {
        front_.erase(found);
      } else {
        front_.push_back(rotated(reversed(face)));
      }
    }
  }

  Box box_of(const Triangle& t) const {
    return geometry::box_of(std::array{at(t[0]), at(t[1]), at(t[2])});
  }

  std::span<const Point> points_;
  std::vector<Triangle> front_;
  std::vector<Index> corners_;  // all vertices of the cavity, each once
  TestBudget& budget_;
};

}  // namespace

std::vector<geometry::Tetrahedron> wrap_cavity(std::span<const Point> points,
                                               std::vector<Triangle> front, TestBudget& budget) {
  return Wrapping(points, std::move(front), budget).run();
}

}  // namespace watertight::delaunay
