// SPDX-License-Identifier: GPL-3.0-or-later
//
// Let X and Y be regions, each bounded by one closed 2-manifold that does not meet itself, and let
// the inner side of a triangle be the side on which its region is. A triangle of a surface meets
// the inside (the triangle without its edges) of no other triangle of that surface, so a small
// half-ball on the inner side of a point inside a triangle belongs to the region.
//
// (1) If a triangle u meets the inside of a triangle t of the other region and has a vertex
//     strictly on the inner side of t's plane, the insides of the regions meet: from the common
//     point on, u runs into the half-ball beside t. The insides of the regions also meet if two
//     triangles in one plane, turned alike, share an area.
// (2) Otherwise all triangles of one boundary that meet the inside of a triangle t of the other lie
//     on the closed outer side of t there. The inner half of a small ball around a point inside t
//     is then free of the other boundary, so the half-ball lies inside the other region or outside
//     of it. Since the inside of t is connected, the answer is the same for all points inside t: t
//     is `in` or `out`. A triangle that shares an area with a triangle turned the other way is out.
// (3) Then the insides meet if and only if a triangle of Y is in, or an arbitrary triangle of X is:
//     the inside of X is connected, so it holds a point of Y's boundary (and a triangle of Y there
//     is in) or lies inside Y as a whole (and all triangles of X are in).
// (4) Every point of a triangle that is not on the other boundary shows whether the triangle is in
//     or out. A triangle that does not meet the other boundary has the same answer as all triangles
//     with which it shares a corner.
//
// None of (1) to (4) needs the inside of Y to be connected or bounded, so the complement of Y (with
// the triangles of Y turned) can replace Y: X lies in Y when X does not meet Y's complement. The
// boundary of a solid with cavities is no such surface: where a cavity touches a facet from within,
// the half-ball beside the facet is not all interior. validate/overlap/solid_overlap.cpp compares
// solids shell by shell.
#include "validate/overlap/region_relation.h"

#include <algorithm>
#include <map>
#include <optional>

#include "geometry/disjoint_sets.h"
#include "geometry/intersection/triangle_triangle.h"
#include "geometry/predicates/point_in_solid.h"
#include "geometry/predicates/predicates.h"

namespace watertight::validate {
namespace {

constexpr std::uint64_t kCancelInterval = std::uint64_t{1} << 16U;
/// Up to this number of pairs of boxes, all pairs are compared; above it a tree is built.
constexpr std::size_t kFewPairs = 1024;

Box common_box(const Box& a, const Box& b) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::max(a.min[axis], b.min[axis]);
    box.max[axis] = std::min(a.max[axis], b.max[axis]);
  }
  return box;
}

/// The sides of a triangle's plane on which corners of another triangle lie.
struct Sides {
  bool has_inner = false;
  bool has_outer = false;
  bool are_both() const { return has_inner && has_outer; }
};

Sides sides_to(const std::array<Point, 3>& plane, const std::array<Point, 3>& corners) {
  Sides sides;
  for (const Point& p : corners) {
    if (p == plane[0] || p == plane[1] || p == plane[2]) continue;
    const int sign = geometry::orient3d(plane[0], plane[1], plane[2], p);
    sides.has_inner = sides.has_inner || sign < 0;
    sides.has_outer = sides.has_outer || sign > 0;
  }
  return sides;
}

/// True if two triangles have the same orientation. Requires triangles in one plane.
bool are_turned_alike(const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const int turn = geometry::orient2d(a[0], a[1], a[2], axis);
    if (turn != 0) return turn == geometry::orient2d(b[0], b[1], b[2], axis);
  }
  return false;
}

/// The location of the triangle's points that are not on the surface. Requires a triangle that is
/// in or out by (2) and shares no area with the surface: the surface then meets the triangle in
/// segments and points only.
Location locate_triangle(const std::array<Point, 3>& corners, const RegionSurface& surface) {
  for (int exponent = 2; exponent <= 52; exponent = exponent == 2 ? 8 : exponent + 8) {
    for (std::uint64_t i = 1; i <= geometry::triangle_points(exponent); ++i) {
      const geometry::TrianglePoint point = geometry::triangle_point(corners, exponent, i);
      Location location = Location::boundary;
      if (const auto exact = geometry::exact_doubles(point)) {
        location = surface.locate(*exact);
      } else {
        location = Location{static_cast<signed char>(
            geometry::locate_exactly(point, surface.vertices(), surface.triangles()))};
      }
      if (location != Location::boundary) return location;
    }
  }
  return Location::outside;  // reached only if the surface meets the triangle in > 2^25 segments
}

/// One of the two regions, with its triangles that reach into the common box.
struct Side {
  const RegionSurface* surface = nullptr;
  std::vector<Index> triangles;
  std::vector<char> is_touched = {};  // 1 if the triangle meets the other boundary
  std::vector<char> shares_area =
      {};  // 1 if the triangle shares an area with one of the other side
};

class Comparison {
 public:
  Comparison(const RegionSurface& first, const RegionSurface& second,
             const RegionQuestions& questions, const CancelPoll& cancel)
      : first_(side(first, second)),
        second_(side(second, first)),
        questions_(questions),
        cancel_(cancel) {}

  RegionRelation run();

 private:
  static Side side(const RegionSurface& surface, const RegionSurface& other) {
    Side side{&surface, surface.triangles_in(common_box(surface.box(), other.box()))};
    side.is_touched.resize(side.triangles.size());
    side.shares_area.resize(side.triangles.size());
    return side;
  }
  void find_contacts();
  void compare(std::size_t i, std::size_t j);
  void note(geometry::ContactClass contact, std::size_t i, std::size_t j);
  void note_overlap(Index triangle, Index other);
  bool is_done() const {
    return relation_.is_cancelled ||
           (relation_.do_overlap && (!questions_.is_first_inside || first_leaves_) &&
            (!questions_.is_second_inside || second_leaves_));
  }
  bool meets(const Side& connected, const Side& other, bool is_complement);

  Side first_;
  Side second_;
  const RegionQuestions& questions_;
  const CancelPoll& cancel_;
  std::vector<Point> points_;  // three corners of each triangle of first_, then those of second_
  std::vector<Box> boxes_;     // the boxes of the second region's triangles
  std::uint64_t comparisons_ = 0;
  bool first_leaves_ = false;   // the first region meets the complement of the second
  bool second_leaves_ = false;  // the second region meets the complement of the first
  RegionRelation relation_;
};

void Comparison::note_overlap(Index triangle, Index other) {
  if (relation_.do_overlap) return;
  relation_.do_overlap = true;
  relation_.facet = triangle == kNone ? kNone : first_.surface->facet_of(triangle);
  relation_.other_facet = other == kNone ? kNone : second_.surface->facet_of(other);
}

/// Applies (1) to the two regions, and to each region with the complement of the other.
void Comparison::note(geometry::ContactClass contact, std::size_t i, std::size_t j) {
  const Index t = first_.triangles[i];
  const Index u = second_.triangles[j];
  const std::array<Point, 3> a = first_.surface->corners(t);
  const std::array<Point, 3> b = second_.surface->corners(u);
  if (contact == geometry::ContactClass::crossing) {
    note_overlap(t, u);
    first_leaves_ = second_leaves_ = true;
  } else if (contact == geometry::ContactClass::coplanar_overlap ||
             contact == geometry::ContactClass::duplicate) {
    first_.shares_area[i] = second_.shares_area[j] = 1;
    if (are_turned_alike(a, b)) {
      note_overlap(t, u);
      relation_.touch_side_by_side = true;
    } else {
      relation_.touch_back_to_back = true;
      first_leaves_ = second_leaves_ = true;
    }
  } else if (contact == geometry::ContactClass::vertex_face ||
             contact == geometry::ContactClass::edge_face) {
    // If the second triangle has corners of the first on both sides of its plane, the inside of the
    // first triangle is met; else the inside of the second.
    const Sides of_first = sides_to(b, a);
    const bool is_second_met = !of_first.are_both();
    const bool is_inner = is_second_met ? of_first.has_inner : sides_to(a, b).has_inner;
    if (is_inner) note_overlap(t, u);
    (is_second_met ? first_leaves_ : second_leaves_) |= !is_inner;
    (is_second_met ? second_leaves_ : first_leaves_) |= is_inner;
  }
}

void Comparison::compare(std::size_t i, std::size_t j) {
  if (is_done()) return;
  if (++comparisons_ % kCancelInterval == 0 && cancel_ && cancel_()) {
    relation_.is_cancelled = true;
    return;
  }
  const auto triangle = [](std::size_t at) {
    const auto begin = static_cast<Index>(3 * at);
    return Triangle{begin, begin + 1, begin + 2};
  };
  const geometry::ContactClass contact =
      geometry::classify_contact(points_, triangle(i), triangle(first_.triangles.size() + j));
  if (contact == geometry::ContactClass::disjoint) return;
  first_.is_touched[i] = second_.is_touched[j] = 1;
  note(contact, i, j);
}

void Comparison::find_contacts() {
  points_.reserve(3 * (first_.triangles.size() + second_.triangles.size()));
  for (const Side* side : {&first_, &second_}) {
    for (const Index triangle : side->triangles) {
      const std::array<Point, 3> corners = side->surface->corners(triangle);
      points_.insert(points_.end(), corners.begin(), corners.end());
    }
  }
  const std::size_t begin = first_.triangles.size();
  const auto box = [&](std::size_t at) {
    return watertight::geometry::box_of(std::span<const Point>(points_).subspan(3 * at, 3));
  };
  for (std::size_t j = 0; j < second_.triangles.size(); ++j) boxes_.push_back(box(begin + j));
  std::optional<BoxTree> tree;
  if (begin * boxes_.size() > kFewPairs) tree.emplace(boxes_);
  for (std::size_t i = 0; i < begin && !is_done(); ++i) {
    const Box own = box(i);
    const auto visit = [&](std::size_t j) {
      if (boxes_[j].overlaps(own)) compare(i, j);
    };
    if (tree) {
      tree->visit([&](const Box& reach) { return !is_done() && reach.overlaps(own); },
                  [&](Index j) { visit(j); });
    } else {
      for (std::size_t j = 0; j < boxes_.size(); ++j) visit(j);
    }
  }
}

/// Finds by (4) whether a triangle of a side lies inside or outside of the other region. Requires
/// that the triangle shares no area with the surface of that region.
class TriangleSides {
 public:
  TriangleSides(const Side& side, const RegionSurface& other) : side_(side), other_(other) {
    const auto triangles = side.surface->triangles();
    for (std::size_t i = 0; i < side.triangles.size(); ++i) {
      if (side.is_touched[i] != 0) continue;
      const Triangle& t = triangles[side.triangles[i]];
      free_.insert(free_.end(), t.begin(), t.end());
    }
    std::sort(free_.begin(), free_.end());
    free_.erase(std::unique(free_.begin(), free_.end()), free_.end());
    parts_ = geometry::DisjointSets(free_.size());
    known_.resize(free_.size(), Location::boundary);
    for (std::size_t i = 0; i < side.triangles.size(); ++i) {
      if (side.is_touched[i] != 0) continue;
      const Triangle& t = triangles[side.triangles[i]];
      const Index a = number_of(t[0]);
      parts_.join(a, number_of(t[1]));
      parts_.join(a, number_of(t[2]));
    }
  }

  /// `inside` or `outside` for triangle i of the side.
  Location operator()(std::size_t i) {
    const Index triangle = side_.triangles[i];
    for (const Index vertex : side_.surface->triangles()[triangle]) {
      const Index number = number_of(vertex);
      if (number == kNone) continue;
      Location& location = known_[parts_.root(number)];
      if (location == Location::boundary) {
        location = other_.locate(side_.surface->vertices()[vertex]);
      }
      return location;
    }
    // Any point of the triangle that is not on the other boundary decides. To locate a corner costs
    // less than to locate a point inside the triangle.
    for (const Index vertex : side_.surface->triangles()[triangle]) {
      const auto [place, is_new] = touched_.try_emplace(vertex, Location::boundary);
      if (is_new) place->second = other_.locate(side_.surface->vertices()[vertex]);
      if (place->second != Location::boundary) return place->second;
    }
    return locate_triangle(side_.surface->corners(triangle), other_);
  }

 private:
  /// The index of a vertex in free_, or kNone if all triangles at it meet the other surface.
  Index number_of(Index vertex) const {
    const auto at = std::lower_bound(free_.begin(), free_.end(), vertex);
    return at == free_.end() || *at != vertex ? kNone : static_cast<Index>(at - free_.begin());
  }

  const Side& side_;
  const RegionSurface& other_;
  /// The corners of the triangles that do not meet the other surface, ascending.
  std::vector<Index> free_;
  geometry::DisjointSets parts_{0};
  std::vector<Location> known_;
  std::map<Index, Location>
      touched_;  // corner of a triangle that meets the other surface -> location
};

/// True if the insides of two regions meet, by (3); requires that (1) has not shown it. With
/// `is_complement`, the complement of `other` is the second region. Notes the first triangle that
/// is in.
bool Comparison::meets(const Side& connected, const Side& other, bool is_complement) {
  const auto note_in = [&](Index of_connected, Index of_other) {
    if (is_complement) return;
    const bool is_first = &connected == &first_;
    note_overlap(is_first ? of_connected : of_other, is_first ? of_other : of_connected);
  };
  TriangleSides sides(other, *connected.surface);
  for (std::size_t i = 0; i < other.triangles.size(); ++i) {
    const Index triangle = other.triangles[i];
    if (++comparisons_ % kCancelInterval == 0 && cancel_ && cancel_()) {
      relation_.is_cancelled = true;
      return false;
    }
    if (other.shares_area[i] != 0) continue;
    const Box box = watertight::geometry::box_of(other.surface->corners(triangle));
    if (!contains(connected.surface->box(), box) || sides(i) != Location::inside) continue;
    note_in(kNone, triangle);
    return true;
  }
  // Triangles of `connected` that are not listed lie outside the box of the other region.
  if (connected.triangles.size() < connected.surface->triangles().size()) return is_complement;
  if (connected.shares_area[0] != 0) return false;
  TriangleSides own(connected, *other.surface);
  if ((own(0) == Location::inside) == is_complement) return false;
  note_in(connected.triangles[0], kNone);
  return true;
}

RegionRelation Comparison::run() {
  find_contacts();
  if (!is_done() && !relation_.do_overlap) meets(first_, second_, false);
  if (questions_.is_first_inside && !first_leaves_ && !relation_.is_cancelled) {
    first_leaves_ = meets(first_, second_, true);
  }
  if (questions_.is_second_inside && !second_leaves_ && !relation_.is_cancelled) {
    second_leaves_ = meets(second_, first_, true);
  }
  relation_.looks = comparisons_ + first_.triangles.size() + second_.triangles.size();
  relation_.is_first_inside = questions_.is_first_inside && !first_leaves_;
  relation_.is_second_inside = questions_.is_second_inside && !second_leaves_;
  return relation_;
}

}  // namespace

RegionSurface::RegionSurface(std::vector<Point> vertices, std::vector<Triangle> triangles,
                             std::vector<Index> facet_of)
    : vertices_(std::move(vertices)),
      triangles_(std::move(triangles)),
      facet_of_(std::move(facet_of)),
      box_(watertight::geometry::box_of(vertices_)),
      tree_(boxes_of(vertices_, triangles_)),
      locator_(vertices_, triangles_) {}

std::vector<Index> RegionSurface::triangles_in(const Box& box) const {
  std::vector<Index> list;
  tree_.visit([&](const Box& reach) { return reach.overlaps(box); },
              [&](Index triangle) {
                if (box_of(triangles_[triangle], vertices_).overlaps(box)) {
                  list.push_back(triangle);
                }
              });
  std::sort(list.begin(), list.end());
  return list;
}

RegionSurface surface_of_shells(const Solid& solid, std::span<const Point> vertices,
                                const tessellate::FacetTriangles& facets, IndexRange shells,
                                bool is_turned_over) {
  const Index first = facets.first[solid.facets_of(shells.begin).begin];
  const Index last = facets.first[solid.facets_of(shells.end - 1).end];
  std::vector<Triangle> triangles(facets.triangles.begin() + first,
                                  facets.triangles.begin() + last);
  std::vector<Index> facet_of(facets.facet_of.begin() + first, facets.facet_of.begin() + last);
  if (is_turned_over) {
    for (Triangle& t : triangles) std::swap(t[1], t[2]);
  }
  if (shells.size() == solid.shell_count()) {
    return {{vertices.begin(), vertices.end()}, std::move(triangles), std::move(facet_of)};
  }
  std::vector<Index> used;
  for (const Triangle& t : triangles) used.insert(used.end(), t.begin(), t.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<Point> own;
  own.reserve(used.size());
  for (const Index v : used) own.push_back(vertices[v]);
  for (Triangle& t : triangles) {
    for (Index& v : t) {
      v = static_cast<Index>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
    }
  }
  return {std::move(own), std::move(triangles), std::move(facet_of)};
}

bool contains(const Box& outer, const Box& inner) {
  for (int axis = 0; axis < 3; ++axis) {
    if (inner.min[axis] < outer.min[axis] || inner.max[axis] > outer.max[axis]) return false;
  }
  return true;
}

RegionRelation relate_regions(const RegionSurface& first, const RegionSurface& second,
                              const RegionQuestions& questions, const CancelPoll& cancel) {
  if (!first.box().overlaps(second.box())) return {};
  return Comparison(first, second, questions, cancel).run();
}

}  // namespace watertight::validate
