// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solids: shells turned the right way (405), none twice (402), cavities inside the exterior shell
// (403) and not inside each other (401). Exact.
#include <algorithm>
#include <optional>

#include "geometry/measures.h"
#include "validate/point_location.h"
#include "validate/rules.h"

namespace watertight {
namespace {

/// Triangles looked at while shells are located against each other: a few seconds of work.
constexpr std::uint64_t kMostTriangleLooks = 1'000'000'000;

std::span<const Triangle> triangles_of(const ExaminedSolid& examined, Index shell) {
  const IndexRange facets = examined.solid().facets_of(shell);
  const FacetTriangles& all = examined.triangles();
  return std::span<const Triangle>(all.triangles)
      .subspan(all.first[facets.begin], all.first[facets.end] - all.first[facets.begin]);
}

bool is_triangulated(const ExaminedSolid& examined, Index shell) {
  const IndexRange facets = examined.solid().facets_of(shell);
  for (Index facet = facets.begin; facet < facets.end; ++facet) {
    if (examined.triangles().state[facet] != FacetState::triangulated) return false;
  }
  return true;
}

class SolidExaminer {
 public:
  SolidExaminer(ExaminedSolid& examined, const std::vector<ShellTopology>& shells,
                const std::vector<Index>& duplicate_of, const ShellContacts& contacts)
      : examined_(examined), shells_(shells), duplicate_of_(duplicate_of), contacts_(contacts) {
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
  void check_inside_exterior(Index shell);
  void check_apart(Index a, Index b);
  bool is_uncertain() const { return examined_.findings.has_errors_up_to_level(3); }
  void skip(std::vector<int> codes, const std::string& reason);

  ExaminedSolid& examined_;
  const std::vector<ShellTopology>& shells_;
  const std::vector<Index>& duplicate_of_;
  const ShellContacts& contacts_;
  std::vector<Box> boxes_;
  std::vector<bool> is_surface_;  // closed and triangulated
  std::uint64_t looks_ = 0;
  std::vector<std::string> reasons_;
};

/// Each reason once.
void SolidExaminer::skip(std::vector<int> codes, const std::string& reason) {
  if (std::find(reasons_.begin(), reasons_.end(), reason) != reasons_.end()) return;
  reasons_.push_back(reason);
  examined_.findings.skip(std::move(codes), reason);
}

void SolidExaminer::check_orientation() {
  for (Index shell = 0; shell < shells_.size(); ++shell) {
    if (!is_surface_[shell] || !shells_[shell].is_oriented) {
      skip({kWrongOrientationShell},
           "the orientation of a shell that is not closed, turned alike and triangulated has no "
           "meaning");
      continue;
    }
    const int sign = volume_sign(examined_.solid().vertices(), triangles_of(examined_, shell));
    if (sign == (shell == 0 ? 1 : -1)) continue;
    Finding finding;
    finding.code = kWrongOrientationShell;
    finding.place = examined_.at_shell(shell);
    finding.detail = sign == 0    ? "the shell encloses no volume"
                     : shell == 0 ? "the normals of the exterior shell point inward"
                                  : "the normals of the inner shell point out of the cavity";
    finding.uncertain = is_uncertain();
    examined_.findings.add(std::move(finding));
  }
}

/// Where `shell` lies to `around`, by its points that are not on `around`: by the first when the
/// shells have no point in common, else by all. Requires shells whose facets neither cross nor
/// overlap.
SolidExaminer::Sides SolidExaminer::locate_shell(Index shell, Index around) {
  const std::span<const Point> vertices = examined_.solid().vertices();
  const std::span<const Triangle> surface = triangles_of(examined_, around);
  const bool is_one_enough = !contacts_.is_touching[shell] || !contacts_.is_touching[around];
  Sides sides;
  const auto look = [&](const Point& p) {
    looks_ += surface.size();
    const Location location =
        boxes_[around].overlaps(Box{p, p}) ? locate(p, vertices, surface) : Location::outside;
    sides.has_inside = sides.has_inside || location == Location::inside;
    sides.has_outside = sides.has_outside || location == Location::outside;
    return location != Location::boundary;
  };
  for (const Triangle& t : triangles_of(examined_, shell)) {
    if (looks_ > kMostTriangleLooks) break;
    bool is_seen = false;
    for (const Index vertex : t) is_seen = look(vertices[vertex]) || is_seen;
    // All three corners touch: a point inside the triangle. Quarters of lattice integers are exact.
    for (std::size_t i = 0; i < 3 && !is_seen; ++i) {
      Point inner;
      for (int axis = 0; axis < 3; ++axis) {
        inner[axis] = vertices[t[i]][axis] / 2 + vertices[t[(i + 1) % 3]][axis] / 4 +
                      vertices[t[(i + 2) % 3]][axis] / 4;
      }
      is_seen = look(inner);
    }
    if (is_seen && is_one_enough) break;
    if (sides.has_inside && sides.has_outside) break;
  }
  return sides;
}

void SolidExaminer::report(int code, Index shell, Index other, std::string detail) {
  Finding finding;
  finding.code = code;
  finding.place = examined_.at_shell(shell);
  finding.other = examined_.at_shell(other);
  finding.witness = examined_.world(triangles_of(examined_, shell).front()[0]);
  finding.detail = std::move(detail);
  finding.uncertain = is_uncertain();
  examined_.findings.add(std::move(finding));
}

void SolidExaminer::check_inside_exterior(Index shell) {
  if (duplicate_of_[shell] == 0 || do_intersect(0, shell)) return;
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
    skip({kInnerShellOutside}, "an inner shell could not be located in the exterior shell");
  }
}

/// Requires overlapping boxes, a != b.
void SolidExaminer::check_apart(Index a, Index b) {
  const Index first = std::min(a, b);
  const Index second = std::max(a, b);
  if (duplicate_of_[first] != kNone || duplicate_of_[second] != kNone) return;
  if (do_intersect(first, second)) return;
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
  for (Index shell = 1; shell < shells_.size() && looks_ <= kMostTriangleLooks; ++shell) {
    check_inside_exterior(shell);
  }
  // Inner shells against each other: a sweep along x.
  std::vector<Index> order;
  for (Index shell = 1; shell < shells_.size(); ++shell) {
    if (!boxes_[shell].is_empty()) order.push_back(shell);
  }
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::pair(boxes_[a].min.x, a) < std::pair(boxes_[b].min.x, b);
  });
  std::vector<Index> active;
  for (const Index shell : order) {
    if (looks_ > kMostTriangleLooks) break;
    std::erase_if(active, [&](Index a) { return boxes_[a].max.x < boxes_[shell].min.x; });
    looks_ += active.size();
    for (const Index other : active) {
      if (boxes_[other].overlaps(boxes_[shell])) check_apart(other, shell);
    }
    active.push_back(shell);
  }
  if (looks_ > kMostTriangleLooks) {
    skip({kIntersectionShells, kInnerShellOutside},
         "there are too many shells to locate each against the others");
  }
}

}  // namespace

std::vector<Index> check_duplicate_shells(ExaminedSolid& examined) {
  const Solid& solid = examined.solid();
  std::vector<Index> result(solid.shell_count(), kNone);
  if (solid.shell_count() < 2) return result;
  // Shells as sorted lists of sorted triangles, whichever way they are turned.
  std::vector<std::pair<std::vector<Triangle>, Index>> shells;
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const std::span<const Triangle> source = triangles_of(examined, shell);
    std::vector<Triangle> triangles(source.begin(), source.end());
    for (Triangle& t : triangles) std::sort(t.begin(), t.end());
    std::sort(triangles.begin(), triangles.end());
    if (!triangles.empty()) shells.emplace_back(std::move(triangles), shell);
  }
  std::sort(shells.begin(), shells.end());
  std::vector<ShellPair> pairs;  // duplicate, original
  for (std::size_t i = 1; i < shells.size(); ++i) {
    if (shells[i].first != shells[i - 1].first) continue;
    const Index before = shells[i - 1].second;
    const Index original = result[before] == kNone ? before : result[before];
    result[shells[i].second] = original;
    pairs.emplace_back(shells[i].second, original);
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [shell, original] : pairs) {
    Finding finding;
    finding.code = kDuplicatedShells;
    finding.place = examined.at_shell(shell);
    finding.other = examined.at_shell(original);
    finding.detail = "the shells have the same faces";
    finding.uncertain = examined.is_shell_faulty(shell);
    examined.findings.add(std::move(finding));
  }
  return result;
}

void check_solid(ExaminedSolid& examined, const std::vector<ShellTopology>& shells,
                 const std::vector<Index>& duplicate_of, const ShellContacts& contacts) {
  SolidExaminer examiner(examined, shells, duplicate_of, contacts);
  examiner.check_orientation();
  examiner.check_nesting();
}

}  // namespace watertight
