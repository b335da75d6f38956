// SPDX-License-Identifier: GPL-3.0-or-later
//
// Shells that touch along edges may divide the interior (404). The test is exact and needs no
// tetrahedralization:
//
// The canonical triangles, divided where shells touch (delaunay/shell_contacts.h), form a complex:
// they meet in common vertices and edges only. The inner side of a triangle is the side on which
// the interior is. If exactly two triangles have an edge, their inner sides belong to the same part
// of the interior. Around an edge of several shells the triangles are sorted by angle, and two
// neighbours with interior between them belong to the same part. Each class of triangles that are
// linked in this way is a closed surface: moved inward by an infinitely small distance, it is a
// component of the boundary of one part. A connected bounded region has exactly one outer boundary
// component, whose volume is positive; the volumes of its other components are negative. So there
// are as many parts as classes of positive volume. Vertices that shells share link no triangles: a
// small sphere around such a vertex meets the space that is not interior in discs, and to cut off
// the tips of that space neither joins nor divides parts.
//
// Shells that do not touch divide nothing: the complement of n disjoint closed connected surfaces
// has n + 1 components (Alexander duality): n - 1 cavities, the outside and one more.
#include <algorithm>
#include <map>
#include <optional>

#include "delaunay/canonical/sort_by_vertices.h"
#include "geometry/disjoint_sets.h"
#include "geometry/intersection/box_partition.h"
#include "geometry/measures.h"
#include "geometry/predicates/predicates.h"
#include "validate/facet_diagonals.h"
#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

/// Other diagonals are tried on solids of at most kMostTriangles triangles, at most kMostFlips for
/// each solid: a second of work.
constexpr std::size_t kMostTriangles = 5'000;
constexpr std::size_t kMostFlips = 32;

/// A triangle at one of its edges.
struct Sheet {
  Triangle key{};  // the edge's smaller vertex, the edge's larger vertex, the triangle
  Index apex = 0;  // the vertex of the triangle that is not on the edge
  /// True if the triangle passes the edge from the smaller to the larger vertex: seen against that
  /// direction, the interior is clockwise of the triangle.
  bool is_forward = false;
};

/// The parts into which a boundary divides the interior.
struct InteriorParts {
  std::size_t count = 0;
  Index facet = kNone;  // the first facet of the boundary of the smallest part
};

class PartCounter {
 public:
  PartCounter(std::span<const Point> points, const tessellate::FacetTriangles& facets)
      : points_(points), facets_(facets), sides_(facets.triangles.size()) {}

  /// The parts of the interior; nothing if the triangles form no boundary of an interior.
  std::optional<InteriorParts> run() {
    collect_sheets();
    for (std::size_t begin = 0; begin < sheets_.size();) {
      std::size_t end = begin + 1;
      while (end < sheets_.size() && sheets_[end].key[0] == sheets_[begin].key[0] &&
             sheets_[end].key[1] == sheets_[begin].key[1]) {
        ++end;
      }
      if (!link_around(std::span(sheets_).subspan(begin, end - begin))) return std::nullopt;
      begin = end;
    }
    return count();
  }

 private:
  void collect_sheets() {
    sheets_.reserve(3 * facets_.triangles.size());
    for (Index t = 0; t < facets_.triangles.size(); ++t) {
      const Triangle& corners = facets_.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = corners[k];
        const Index b = corners[(k + 1) % 3];
        sheets_.push_back({{std::min(a, b), std::max(a, b), t}, corners[(k + 2) % 3], a < b});
      }
    }
    delaunay::sort_by_vertices(sheets_, points_.size(),
                               [](const Sheet& sheet) { return sheet.key; });
  }

  /// Links the triangles at one edge whose inner sides belong to the same part there. False if
  /// inside and outside do not alternate around the edge.
  bool link_around(std::span<Sheet> sheets) {
    if (sheets.size() > 2) sort_by_angle(sheets);
    for (std::size_t i = 0; i < sheets.size(); ++i) {
      const Sheet& next = sheets[(i + 1) % sheets.size()];
      if (sheets[i].is_forward == next.is_forward) return false;
      if (!sheets[i].is_forward) sides_.join(sheets[i].key[2], next.key[2]);
    }
    return true;
  }

  /// Sorts the triangles at one edge by their angle around the edge: the first triangle stays, and
  /// the others follow counter-clockwise, seen against the direction of the edge.
  void sort_by_angle(std::span<Sheet> sheets) const {
    const Point& low = points_[sheets[0].key[0]];
    const Point& high = points_[sheets[0].key[1]];
    const Index first = sheets[0].apex;
    const auto turn = [&](Index a, Index b) {
      return a == b ? 0 : geometry::orient3d(low, high, points_[a], points_[b]);
    };
    // The class of a triangle's angle from the first triangle: 0 for the angle 0, 1 for less than
    // half a turn, 2 for half a turn, 3 for more.
    const auto sector = [&](const Sheet& sheet) {
      if (sheet.apex == first) return 0;
      const int side = turn(first, sheet.apex);
      return side > 0 ? 1 : side == 0 ? 2 : 3;
    };
    std::sort(sheets.begin(), sheets.end(), [&](const Sheet& a, const Sheet& b) {
      const int of_a = sector(a);
      const int of_b = sector(b);
      if (of_a != of_b) return of_a < of_b;
      const int side = turn(a.apex, b.apex);
      return side != 0 ? side > 0 : a.key[2] < b.key[2];
    });
  }

  std::optional<InteriorParts> count() {
    std::map<Index, std::vector<Index>> classes;  // root of a class -> triangles
    for (Index t = 0; t < facets_.triangles.size(); ++t) classes[sides_.root(t)].push_back(t);
    InteriorParts parts;
    double least = 0;
    for (const auto& [root, members] : classes) {
      std::vector<Triangle> triangles;
      for (const Index t : members) triangles.push_back(facets_.triangles[t]);
      const int sign = geometry::volume_sign(points_, triangles);
      if (sign == 0) return std::nullopt;
      if (sign < 0) continue;
      const double volume = geometry::six_volume(points_, triangles);
      if (parts.count++ > 0 && volume >= least) continue;
      least = volume;
      parts.facet = facets_.facet_of[members.front()];
    }
    if (parts.count == 0) return std::nullopt;
    return parts;
  }

  std::span<const Point> points_;
  const tessellate::FacetTriangles& facets_;
  std::vector<Sheet> sheets_;
  geometry::DisjointSets sides_;  // the classes of triangles, linked through their inner sides
};

/// True if no two triangles of different facets meet in more than a vertex or an edge of both.
bool is_complex(const Solid& solid, const tessellate::FacetTriangles& facets,
                const CancelPoll& cancel) {
  geometry::IntersectionOptions options;
  options.limit = 1;
  options.cancel = cancel;
  options.group_of = facets.facet_of;
  const auto pairs = geometry::intersecting_pairs(solid.vertices(), facets.triangles, options);
  return pairs && pairs->empty();
}

/// The parts of the interior; nothing if the contacts of shells cannot be written with the vertices
/// of the solid, or the triangles form no complex or no boundary.
std::optional<InteriorParts> parts_of(const Solid& solid, const tessellate::FacetTriangles& facets,
                                      const delaunay::ContactTriangles& contacts,
                                      const CancelPoll& cancel) {
  if (!contacts.obstacle.empty()) return std::nullopt;
  const tessellate::FacetTriangles& divided = contacts.has_contacts() ? contacts.triangles : facets;
  if (!is_complex(solid, divided, cancel)) return std::nullopt;
  return PartCounter(solid.vertices(), divided).run();
}

/// The canonical triangles with one diagonal flipped.
tessellate::FacetTriangles with_flip(tessellate::FacetTriangles facets, const Diagonal& diagonal) {
  const auto [first, second] = diagonal.flipped();
  facets.triangles[diagonal.first] = first;
  facets.triangles[diagonal.second] = second;
  return facets;
}

class InteriorExaminer {
 public:
  InteriorExaminer(ExaminedSolid& examined, const delaunay::ContactTriangles& contacts)
      : examined_(examined),
        solid_(examined.solid()),
        contacts_(contacts),
        cancel_([this] { return examined_.ask_cancelled(); }) {}

  /// Applies rule 404 and its part of 804. False if 404 could not be decided.
  bool examine() {
    const auto parts = parts_of(solid_, examined_.triangles(), contacts_, cancel_);
    if (!parts) return false;
    if (parts->count > 1) report(*parts);
    try_other_diagonals(parts->count);
    return true;
  }

 private:
  void report(const InteriorParts& parts) {
    examined_.findings.add(
        {.code = kSolidInteriorDisconnected,
         .place = examined_.at_facet(parts.facet),
         .witness = examined_.world(solid_.ring(solid_.rings_of(parts.facet).begin).front()),
         .detail = "the interior has " + std::to_string(parts.count) +
                   " parts; this facet bounds the smallest"});
  }

  /// Reports 804 where one other diagonal of a facet that is not flat makes or undoes 404.
  void try_other_diagonals(std::size_t count) {
    std::size_t flips = 0;
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      if (!examined_.is_not_planar(facet)) continue;
      for (const Diagonal& diagonal : other_diagonals(solid_, examined_.triangles(), facet)) {
        if (examined_.triangles().triangles.size() > kMostTriangles || ++flips > kMostFlips) {
          return examined_.findings.skip({kTriangulationDependent},
                                         "there are too many diagonals to try each");
        }
        if (cancel_()) return;
        const tessellate::FacetTriangles flipped = with_flip(examined_.triangles(), diagonal);
        const auto contacts = delaunay::divide_at_contacts(solid_, flipped, cancel_);
        if (!contacts) return;
        const auto parts = parts_of(solid_, flipped, *contacts, cancel_);
        if (parts && (parts->count > 1) != (count > 1)) report_flip(facet, diagonal, *parts);
      }
    }
  }

  void report_flip(Index facet, const Diagonal& diagonal, const InteriorParts& parts) {
    Finding finding;
    finding.code = kTriangulationDependent;
    finding.place = examined_.at_facet(facet);
    finding.place.vertex = examined_.submitted_vertex(diagonal.left);
    finding.witness = examined_.world(diagonal.left);
    finding.detail =
        "with the diagonal between vertices " +
        std::to_string(examined_.submitted_vertex(diagonal.left)) + " and " +
        std::to_string(examined_.submitted_vertex(diagonal.right)) +
        (parts.count > 1 ? " the interior would be in parts" : " the interior would be connected");
    examined_.findings.add(std::move(finding));
  }

  ExaminedSolid& examined_;
  const Solid& solid_;
  const delaunay::ContactTriangles& contacts_;
  CancelPoll cancel_;
};

}  // namespace

bool check_interior(ExaminedSolid& examined, const delaunay::ContactTriangles& contacts) {
  return InteriorExaminer(examined, contacts).examine();
}

}  // namespace watertight::validate
