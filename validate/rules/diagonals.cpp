// SPDX-License-Identifier: GPL-3.0-or-later
//
// Facets that are planar within the tolerance but not exactly (804): decides whether one flip of a
// diagonal of the canonical triangulation would make or undo an intersection with another facet.
// Exact on the flipped triangles. Flips of several diagonals at once are not examined.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "geometry/intersection/triangle_triangle.h"
#include "geometry/predicates/predicates.h"
#include "tessellate/flatness.h"
#include "validate/facet_diagonals.h"
#include "validate/overlap/box_tree.h"
#include "validate/planarity.h"
#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

/// The largest number of pairs of triangles that are classified: half a second of work.
constexpr std::uint64_t kMostPairs = 3'000'000;

class DiagonalExaminer {
 public:
  DiagonalExaminer(ExaminedSolid& examined, const ShellContacts& contacts)
      : examined_(examined),
        contacts_(contacts),
        vertices_(examined.solid().vertices()),
        all_(examined.triangles()),
        boxes_(boxes()),
        tree_(boxes_) {}

  void examine();

 private:
  std::vector<Box> boxes() const;
  std::vector<Diagonal> diagonals_of(Index facet) const {
    return other_diagonals(examined_.solid(), all_, facet);
  }
  std::vector<Index> near(const Box& around, Index facet) const;
  void find_made(Index facet, const std::vector<Diagonal>& diagonals);
  void find_undone(std::span<const TrianglePair> group);
  bool is_undone(std::span<const TrianglePair> group, Index facet, Index other);
  bool must_end() { return pairs_ > kMostPairs || examined_.is_cancelled(); }
  std::optional<geometry::ContactClass> contact_of(const Diagonal& flip, const Triangle& t,
                                                   Index facet, Index triangle);
  bool is_diagonal(Index facet, Index a, Index b);
  bool is_common_boundary(const Diagonal& flip, const Triangle& t, Index facet, const Triangle& u,
                          Index other);
  bool is_reported(Index a, Index b) const;
  void report(const Diagonal& diagonal, Index facet, Index other, const Point& witness,
              const std::string& what);

  ExaminedSolid& examined_;
  const ShellContacts& contacts_;
  std::span<const Point> vertices_;
  const tessellate::FacetTriangles& all_;
  std::vector<Box> boxes_;                         // the boxes of all triangles
  BoxTree tree_;                                   // the tree of boxes_
  std::map<Index, std::vector<FacetEdge>> edges_;  // facet -> edges, for facets examined so far
  std::uint64_t pairs_ = 0;
};

std::vector<Box> DiagonalExaminer::boxes() const {
  std::vector<Box> boxes;
  boxes.reserve(all_.triangles.size());
  for (const Triangle& t : all_.triangles) boxes.push_back(box_of(t, vertices_));
  return boxes;
}

/// True if the segment ab is a diagonal of the canonical triangulation of a facet.
bool DiagonalExaminer::is_diagonal(Index facet, Index a, Index b) {
  auto place = edges_.find(facet);
  if (place == edges_.end()) place = edges_.emplace(facet, facet_edges(all_, facet)).first;
  const auto [low, high] = std::minmax(a, b);
  const auto edge =
      std::lower_bound(place->second.begin(), place->second.end(), std::pair(low, high),
                       [](const FacetEdge& e, const std::pair<Index, Index>& key) {
                         return std::pair(e.low, e.high) < key;
                       });
  return edge != place->second.end() && edge->low == low && edge->high == high &&
         edge->is_diagonal();
}

/// True if facets of a shell may share the common edge of a flipped triangle t and a triangle u:
/// the edge is on the boundary of both facets. Contacts of other diagonals than the flipped one
/// with edges of other facets are among the contacts found before.
bool DiagonalExaminer::is_common_boundary(const Diagonal& flip, const Triangle& t, Index facet,
                                          const Triangle& u, Index other) {
  const auto has = [](const Triangle& triangle, Index vertex) {
    return std::find(triangle.begin(), triangle.end(), vertex) != triangle.end();
  };
  if (has(u, flip.left) && has(u, flip.right)) return false;
  if (!is_reported(facet, other)) return true;
  const Index a = has(u, t[0]) ? t[0] : t[1];
  const Index b = has(u, t[2]) ? t[2] : t[1];
  return !is_diagonal(facet, a, b) && !is_diagonal(other, a, b);
}

/// The contact of a flipped triangle of `facet` with a triangle of another facet, if the contact is
/// a finding; else nothing.
std::optional<geometry::ContactClass> DiagonalExaminer::contact_of(const Diagonal& flip,
                                                                   const Triangle& t, Index facet,
                                                                   Index triangle) {
  ++pairs_;
  geometry::ContactClass contact =
      geometry::classify_contact(vertices_, t, all_.triangles[triangle]);
  const Index other = all_.facet_of[triangle];
  const bool is_one_shell = examined_.shell_of(facet) == examined_.shell_of(other);
  if (is_one_shell && contact == geometry::ContactClass::shared_edge &&
      !is_common_boundary(flip, t, facet, all_.triangles[triangle], other)) {
    contact = geometry::ContactClass::edge_overlap;
  }
  if (!geometry::is_intersection(contact)) return std::nullopt;
  if (!is_one_shell && contact < geometry::ContactClass::crossing) return std::nullopt;
  if (is_one_shell && examined_.is_junction_contact(contact, facet, other)) return std::nullopt;
  return contact;
}

bool DiagonalExaminer::is_reported(Index a, Index b) const {
  const auto key = std::pair(std::min(a, b), std::max(a, b));
  const auto place = std::lower_bound(contacts_.found.begin(), contacts_.found.end(), key,
                                      [](const TrianglePair& pair, const auto& k) {
                                        return std::tie(pair.first_facet, pair.second_facet) <
                                               std::tie(k.first, k.second);
                                      });
  return place != contacts_.found.end() && place->first_facet == key.first &&
         place->second_facet == key.second;
}

void DiagonalExaminer::report(const Diagonal& diagonal, Index facet, Index other,
                              const Point& witness, const std::string& what) {
  Finding finding;
  finding.code = kTriangulationDependent;
  finding.place = examined_.at_facet(facet);
  finding.place.vertex = examined_.submitted_vertex(diagonal.left);
  finding.other = examined_.at_facet(other);
  finding.witness = examined_.world(witness);
  // The distance between the lines of the two diagonals: how far the two surfaces are apart.
  const Vector along = examined_.metres(diagonal.u, diagonal.v);
  const Vector across = examined_.metres(diagonal.left, diagonal.right);
  finding.measured =
      std::fabs(dot(unit_normal(along, across), examined_.metres(diagonal.u, diagonal.left)));
  finding.limit = 0;
  finding.unit = std::string(1, 'm');
  finding.detail = "with the diagonal between vertices " +
                   std::to_string(examined_.submitted_vertex(diagonal.left)) + " and " +
                   std::to_string(examined_.submitted_vertex(diagonal.right)) + " facet " +
                   std::to_string(facet) + what + std::to_string(other);
  finding.uncertain = examined_.is_faulty(facet) || examined_.is_faulty(other);
  examined_.findings.add(std::move(finding));
}

/// The triangles of other facets whose boxes overlap a box, ascending.
std::vector<Index> DiagonalExaminer::near(const Box& around, Index facet) const {
  std::vector<Index> triangles;
  tree_.visit([&](const Box& box) { return box.overlaps(around); },
              [&](Index triangle) {
                if (all_.facet_of[triangle] != facet && boxes_[triangle].overlaps(around)) {
                  triangles.push_back(triangle);
                }
              });
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Reports one finding for each other facet that the facet would intersect with another diagonal.
void DiagonalExaminer::find_made(Index facet, const std::vector<Diagonal>& diagonals) {
  std::vector<Index> reported;
  for (const Diagonal& diagonal : diagonals) {
    if (must_end()) return;
    Box quadrilateral = boxes_[diagonal.first];
    quadrilateral.include(vertices_[diagonal.left]);
    const std::vector<Index> candidates = near(quadrilateral, facet);
    for (const Triangle& t : diagonal.flipped()) {
      const Box around = box_of(t, vertices_);
      for (const Index triangle : candidates) {
        if (!boxes_[triangle].overlaps(around)) continue;
        const Index other = all_.facet_of[triangle];
        if (pairs_ > kMostPairs) return;
        if (!contact_of(diagonal, t, facet, triangle) || is_reported(facet, other)) continue;
        if (std::find(reported.begin(), reported.end(), other) != reported.end()) continue;
        reported.push_back(other);
        report(diagonal, facet, other,
               geometry::contact_witness(vertices_, t, all_.triangles[triangle]),
               " would intersect facet ");
      }
    }
  }
}

/// True, with a finding, if another diagonal of `facet` undoes all its intersections with `other`.
/// Requires all pairs of triangles of the two facets that make the finding.
bool DiagonalExaminer::is_undone(std::span<const TrianglePair> group, Index facet, Index other) {
  const auto mine = [&](const TrianglePair& pair) {
    return pair.first_facet == facet ? pair.first : pair.second;
  };
  for (const Diagonal& diagonal : diagonals_of(facet)) {
    const bool has_all = std::all_of(group.begin(), group.end(), [&](const TrianglePair& pair) {
      return mine(pair) == diagonal.first || mine(pair) == diagonal.second;
    });
    if (!has_all || must_end()) continue;
    bool is_met = false;
    for (const Triangle& t : diagonal.flipped()) {
      for (Index triangle = all_.first[other]; triangle < all_.first[other + 1]; ++triangle) {
        is_met = is_met || contact_of(diagonal, t, facet, triangle);
      }
    }
    if (is_met) continue;
    const Triangle& a = all_.triangles[group.front().first];
    const Triangle& b = all_.triangles[group.front().second];
    report(diagonal, facet, other, geometry::contact_witness(vertices_, a, b),
           " would not intersect facet ");
    return true;
  }
  return false;
}

void DiagonalExaminer::find_undone(std::span<const TrianglePair> group) {
  const Index first = group.front().first_facet;
  const Index second = group.front().second_facet;
  if (examined_.is_not_planar(first) && is_undone(group, first, second)) return;
  if (examined_.is_not_planar(second)) is_undone(group, second, first);
}

void DiagonalExaminer::examine() {
  for (Index facet = 0; facet < examined_.solid().facet_count() && !must_end(); ++facet) {
    if (examined_.is_not_planar(facet)) find_made(facet, diagonals_of(facet));
  }
  const std::span<const TrianglePair> found(contacts_.found);
  for (std::size_t begin = 0; begin < found.size() && !must_end();) {
    std::size_t end = begin + 1;
    while (end < found.size() && found[end].first_facet == found[begin].first_facet &&
           found[end].second_facet == found[begin].second_facet) {
      ++end;
    }
    find_undone(found.subspan(begin, end - begin));
    begin = end;
  }
  if (examined_.was_cancelled()) {
    examined_.findings.skip({kTriangulationDependent}, "the search was cancelled");
  } else if (pairs_ > kMostPairs) {
    examined_.findings.skip({kTriangulationDependent}, "there are too many diagonals to try each");
  }
}

}  // namespace

void check_diagonals(ExaminedSolid& examined, const ShellContacts& contacts) {
  for (Index facet = 0; facet < examined.solid().facet_count(); ++facet) {
    if (!examined.is_not_planar(facet)) continue;
    DiagonalExaminer(examined, contacts).examine();
    return;
  }
}

}  // namespace watertight::validate
