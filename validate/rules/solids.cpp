// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rules of solids: shells turned the right way (405), no shell twice (402), cavities inside the
// exterior shell (403) and not inside each other (401), shells with a volume (806). Exact.
#include <algorithm>
#include <map>

#include "geometry/measures.h"
#include "geometry/predicates/point_in_solid.h"
#include "validate/overlap/point_location.h"
#include "validate/overlap/region_relation.h"
#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

/// The largest number of points that are located and boxes that are compared to locate the shells:
/// a few seconds of work.
constexpr std::uint64_t kMostLooks = 10'000'000;
/// The exponent of the points inside a triangle (seven) that are located where its corners decide
/// nothing.
constexpr int kPointExponent = 6;

std::span<const Triangle> triangles_of(const ExaminedSolid& examined, Index shell) {
  const IndexRange facets = examined.solid().facets_of(shell);
  const tessellate::FacetTriangles& all = examined.triangles();
  return std::span<const Triangle>(all.triangles)
      .subspan(all.first[facets.begin], all.first[facets.end] - all.first[facets.begin]);
}

bool is_triangulated(const ExaminedSolid& examined, Index shell) {
  const IndexRange facets = examined.solid().facets_of(shell);
  for (Index facet = facets.begin; facet < facets.end; ++facet) {
    if (examined.triangles().state[facet] != tessellate::FacetState::triangulated) return false;
  }
  return true;
}

class SolidExaminer {
 public:
  SolidExaminer(ExaminedSolid& examined, const std::vector<ShellTopology>& shells,
                const std::vector<Index>& duplicate_of, const ShellContacts& contacts)
      : examined_(examined),
        shells_(shells),
        duplicate_of_(duplicate_of),
        contacts_(contacts),
        volume_signs_(shells.size(), 0) {
    for (Index shell = 0; shell < shells.size(); ++shell) {
      Box box;
      for (const Triangle& t : triangles_of(examined, shell)) {
        for (const Index vertex : t) box.include(examined.solid().vertices()[vertex]);
      }
      boxes_.push_back(box);
      is_surface_.push_back(shells[shell].is_closed && is_triangulated(examined, shell));
    }
  }

  void check_orientation();
  void check_nesting();
  /// The reason why a shell could not be located, "" if all were located.
  const std::string& unlocated() const { return unlocated_; }

 private:
  bool can_be_located_in(Index shell) const { return is_surface_[shell]; }
  bool do_intersect(Index a, Index b) const {
    return std::binary_search(contacts_.intersecting.begin(), contacts_.intersecting.end(),
                              ShellPair(std::min(a, b), std::max(a, b)));
  }
  struct Sides {
    bool has_inside = false;
    bool has_outside = false;
  };
  Sides locate_shell(Index shell, Index around);
  void report(int code, Index shell, Index other, std::string detail);
  void report_no_volume(Index shell);
  Location locate(const Point& p, Index around);
  Location locate_inside(const geometry::TrianglePoint& point, Index around);
  bool can_be_related(Index a, Index b) const;
  const RegionSurface& region(Index shell);
  RegionRelation relate(Index a, Index b);
  void check_inside_exterior(Index shell);
  void check_apart(Index a, Index b);
  bool is_uncertain() const { return examined_.findings.has_errors_up_to_level(3); }
  void skip(std::vector<int> codes, const std::string& reason);

  ExaminedSolid& examined_;
  const std::vector<ShellTopology>& shells_;
  const std::vector<Index>& duplicate_of_;
  const ShellContacts& contacts_;
  std::vector<Box> boxes_;
  std::vector<bool> is_surface_;   // shell -> whether it is closed and triangulated
  std::vector<int> volume_signs_;  // shell -> sign of its volume; 0 if it has no meaning
  std::map<Index, PointLocator> locators_;
  std::map<Index, RegionSurface> regions_;
  std::string unlocated_;
  std::uint64_t looks_ = 0;
  std::vector<std::string> reasons_;
};

/// Notes rules that were not evaluated; each reason once.
void SolidExaminer::skip(std::vector<int> codes, const std::string& reason) {
  if (std::find(reasons_.begin(), reasons_.end(), reason) != reasons_.end()) return;
  reasons_.push_back(reason);
  examined_.findings.skip(std::move(codes), reason);
}

/// Reports a shell without volume (806). A closed 2-manifold that does not meet itself encloses a
/// volume, so such a shell always has another finding too.
void SolidExaminer::report_no_volume(Index shell) {
  examined_.findings.add({.code = kZeroVolume,
                          .place = examined_.at_shell(shell),
                          .measured = 0,
                          .unit = "cubic units",
                          .detail = "the closed shell encloses a volume of exactly zero",
                          .uncertain = is_uncertain()});
}

void SolidExaminer::check_orientation() {
  for (Index shell = 0; shell < shells_.size(); ++shell) {
    if (!is_surface_[shell] || !shells_[shell].is_oriented) {
      skip({kWrongOrientationShell},
           "the orientation of a shell that is not closed, turned alike and triangulated has no "
           "meaning");
      continue;
    }
    if (examined_.is_cancelled()) return;
    const int sign =
        geometry::volume_sign(examined_.solid().vertices(), triangles_of(examined_, shell));
    volume_signs_[shell] = sign;
    if (sign == (shell == 0 ? 1 : -1)) continue;
    if (sign == 0) {
      report_no_volume(shell);
      continue;
    }
    examined_.findings.add(
        {.code = kWrongOrientationShell,
         .place = examined_.at_shell(shell),
         .detail = shell == 0 ? "the normals of the exterior shell point inward (or the axes are "
                                "in north, east order)"
                              : "the normals of the inner shell point out of the cavity",
         .uncertain = is_uncertain()});
  }
}

/// Locates a point to a shell: tests the triangles of a small shell one by one, and makes a tree
/// for a large shell at first use.
Location SolidExaminer::locate(const Point& p, Index around) {
  constexpr std::size_t kSmall = 64;
  if (!boxes_[around].overlaps(Box{p, p})) return Location::outside;
  const std::span<const Point> vertices = examined_.solid().vertices();
  const std::span<const Triangle> surface = triangles_of(examined_, around);
  if (surface.size() <= kSmall) return watertight::validate::locate(p, vertices, surface);
  auto place = locators_.find(around);
  if (place == locators_.end()) {
    place = locators_.emplace(around, PointLocator(vertices, surface)).first;
  }
  return place->second.locate(p);
}

Location SolidExaminer::locate_inside(const geometry::TrianglePoint& point, Index around) {
  if (const auto exact = geometry::exact_doubles(point)) return locate(*exact, around);
  return Location{static_cast<signed char>(geometry::locate_exactly(
      point, examined_.solid().vertices(), triangles_of(examined_, around)))};
}

/// The sides of `around` on which `shell` lies, for shells that have no point in common, or of
/// which one has defects of its own. Points of `shell` that are not on `around` decide: the first
/// of them when the shells have no point in common, else all. Requires shells whose facets neither
/// cross nor overlap.
SolidExaminer::Sides SolidExaminer::locate_shell(Index shell, Index around) {
  const std::span<const Point> vertices = examined_.solid().vertices();
  const bool is_one_enough = !contacts_.is_touching[shell] || !contacts_.is_touching[around];
  Sides sides;
  const auto note = [&](Location location) {
    sides.has_inside = sides.has_inside || location == Location::inside;
    sides.has_outside = sides.has_outside || location == Location::outside;
    return location != Location::boundary;
  };
  const auto look = [&](const Point& p) {
    ++looks_;
    return note(locate(p, around));
  };
  for (const Triangle& t : triangles_of(examined_, shell)) {
    if (looks_ > kMostLooks || examined_.is_cancelled()) break;
    bool is_seen = false;
    for (const Index vertex : t) is_seen = look(vertices[vertex]) || is_seen;
    // If all three corners are on `around`, points inside the triangle are located.
    for (std::uint64_t i = 1; i <= geometry::triangle_points(kPointExponent) && !is_seen; ++i) {
      ++looks_;
      const std::array<Point, 3> corners{vertices[t[0]], vertices[t[1]], vertices[t[2]]};
      is_seen = note(locate_inside(geometry::triangle_point(corners, kPointExponent, i), around));
    }
    if (is_seen && is_one_enough) break;
    if (sides.has_inside && sides.has_outside) break;
  }
  return sides;
}

void SolidExaminer::report(int code, Index shell, Index other, std::string detail) {
  examined_.findings.add({.code = code,
                          .place = examined_.at_shell(shell),
                          .other = examined_.at_shell(other),
                          .witness = examined_.world(triangles_of(examined_, shell).front()[0]),
                          .detail = std::move(detail),
                          .uncertain = is_uncertain()});
}

/// True if two shells touch and both are surfaces without a defect of their own, so that the
/// regions inside them can be compared. For other shells, single points are located.
bool SolidExaminer::can_be_related(Index a, Index b) const {
  const auto is_region = [&](Index shell) {
    return contacts_.is_touching[shell] && is_surface_[shell] && shells_[shell].is_sound() &&
           volume_signs_[shell] != 0;
  };
  return !is_uncertain() && is_region(a) && is_region(b);
}

/// The region inside a shell, made at the first call for this shell.
const RegionSurface& SolidExaminer::region(Index shell) {
  auto place = regions_.find(shell);
  if (place == regions_.end()) {
    const Solid& solid = examined_.solid();
    place = regions_
                .emplace(shell, surface_of_shells(solid, solid.vertices(), examined_.triangles(),
                                                  {shell, shell + 1}, volume_signs_[shell] < 0))
                .first;
  }
  return place->second;
}

RegionRelation SolidExaminer::relate(Index a, Index b) {
  const RegionRelation relation =
      relate_regions(region(a), region(b), {true, true}, [&] { return examined_.ask_cancelled(); });
  looks_ += relation.looks;
  return relation;
}

void SolidExaminer::check_inside_exterior(Index shell) {
  if (duplicate_of_[shell] == 0 || do_intersect(0, shell)) return;
  if (can_be_related(shell, 0)) {
    const RegionRelation relation = relate(shell, 0);
    if (relation.is_cancelled || relation.is_first_inside) return;
    if (!relation.do_overlap || relation.is_second_inside) {
      report(kInnerShellOutside, shell, 0, "the inner shell lies outside the exterior shell");
    } else {
      report(kIntersectionShells, shell, 0, "the shells cross along vertices or edges");
    }
    return;
  }
  if (!can_be_located_in(0) || triangles_of(examined_, shell).empty()) {
    skip({kInnerShellOutside}, "inner shells cannot be located in a shell that is not closed");
    return;
  }
  const Sides sides = locate_shell(shell, 0);
  if (sides.has_inside && sides.has_outside) {
    report(kIntersectionShells, shell, 0, "the shells cross along vertices or edges");
  } else if (sides.has_outside) {
    report(kInnerShellOutside, shell, 0, "the inner shell lies outside the exterior shell");
  } else if (!sides.has_inside) {
    unlocated_ = "an inner shell could not be located in the exterior shell";
    skip({kInnerShellOutside}, unlocated_);
  }
}

/// Reports two interior shells that cross or are nested. Requires overlapping boxes, a != b.
void SolidExaminer::check_apart(Index a, Index b) {
  const Index first = std::min(a, b);
  const Index second = std::max(a, b);
  if (duplicate_of_[first] != kNone || duplicate_of_[second] != kNone) return;
  if (do_intersect(first, second)) return;
  if (can_be_related(first, second)) {
    const RegionRelation relation = relate(first, second);
    if (relation.is_cancelled || !relation.do_overlap) return;
    const bool is_one_inside = relation.is_first_inside || relation.is_second_inside;
    report(kIntersectionShells, relation.is_second_inside ? second : first,
           relation.is_second_inside ? first : second,
           is_one_inside ? "an inner shell lies inside another"
                         : "the shells cross along vertices or edges");
    return;
  }
  for (const auto& [inner, outer] : {std::pair(first, second), std::pair(second, first)}) {
    if (!can_be_located_in(outer) || triangles_of(examined_, inner).empty()) continue;
    const Sides sides = locate_shell(inner, outer);
    if (!sides.has_inside) continue;
    report(kIntersectionShells, inner, outer,
           sides.has_outside ? "the shells cross along vertices or edges"
                             : "an inner shell lies inside another");
    return;
  }
}

void SolidExaminer::check_nesting() {
  const auto must_end = [&] { return looks_ > kMostLooks || examined_.is_cancelled(); };
  for (Index shell = 1; shell < shells_.size() && !must_end(); ++shell) {
    check_inside_exterior(shell);
  }
  // Each interior shell is compared with the earlier interior shells whose boxes overlap its box.
  std::vector<Index> shells;
  std::vector<Box> boxes;
  for (Index shell = 1; shell < shells_.size(); ++shell) {
    if (boxes_[shell].is_empty()) continue;
    shells.push_back(shell);
    boxes.push_back(boxes_[shell]);
  }
  const BoxTree tree(boxes);
  for (const Index shell : shells) {
    if (must_end()) break;
    std::vector<Index> others;
    tree.visit([&](const Box& box) { return box.overlaps(boxes_[shell]); },
               [&](Index item) {
                 const Index other = shells[item];
                 ++looks_;
                 if (other < shell && boxes_[other].overlaps(boxes_[shell])) {
                   others.push_back(other);
                 }
               });
    std::sort(others.begin(), others.end());
    for (const Index other : others) {
      if (must_end()) break;
      check_apart(other, shell);
    }
  }
  if (looks_ > kMostLooks) {
    unlocated_ = "there are too many shells to locate each against the others";
    skip({kIntersectionShells, kInnerShellOutside}, unlocated_);
  }
  if (examined_.was_cancelled()) {
    skip({kIntersectionShells, kInnerShellOutside, kWrongOrientationShell},
         "the search was cancelled");
  }
}

}  // namespace

std::vector<Index> check_duplicate_shells(ExaminedSolid& examined) {
  const Solid& solid = examined.solid();
  std::vector<Index> result(solid.shell_count(), kNone);
  if (solid.shell_count() < 2) return result;
  // Each shell as a sorted list of triangles with sorted vertices, so that orientation is ignored.
  std::vector<std::pair<std::vector<Triangle>, Index>> shells;
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const std::span<const Triangle> source = triangles_of(examined, shell);
    std::vector<Triangle> triangles(source.begin(), source.end());
    for (Triangle& t : triangles) std::sort(t.begin(), t.end());
    std::sort(triangles.begin(), triangles.end());
    if (!triangles.empty()) shells.emplace_back(std::move(triangles), shell);
  }
  std::sort(shells.begin(), shells.end());
  std::vector<ShellPair> pairs;  // pairs of a duplicate and its original
  for (std::size_t i = 1; i < shells.size(); ++i) {
    if (shells[i].first != shells[i - 1].first) continue;
    const Index before = shells[i - 1].second;
    const Index original = result[before] == kNone ? before : result[before];
    result[shells[i].second] = original;
    pairs.emplace_back(shells[i].second, original);
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [shell, original] : pairs) {
    examined.findings.add({.code = kDuplicatedShells,
                           .place = examined.at_shell(shell),
                           .other = examined.at_shell(original),
                           .detail = "the shells have the same faces",
                           .uncertain = examined.is_shell_faulty(shell)});
  }
  return result;
}

std::string check_solid(ExaminedSolid& examined, const std::vector<ShellTopology>& shells,
                        const std::vector<Index>& duplicate_of, const ShellContacts& contacts) {
  SolidExaminer examiner(examined, shells, duplicate_of, contacts);
  examiner.check_orientation();
  examiner.check_nesting();
  return examiner.unlocated();
}

}  // namespace watertight::validate
