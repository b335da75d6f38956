// SPDX-License-Identifier: GPL-3.0-or-later
//
// Each triangle is cut by itself: what is left of it has the edges that are left of the triangle,
// and a chord on the height. The edges inside a facet meet their opposites and vanish, so that the
// boundary of the facet's rest remains. The chords, the other way round, bound the sections.
#include "tessellate/clip_z.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <unordered_map>
#include <utility>

#include "geometry/disjoint_sets.h"
#include "geometry/mass/mass.h"
#include "geometry/measures.h"
#include "geometry/predicates/predicates.h"
#include "tessellate/edge_loops.h"
#include "tessellate/facets.h"

namespace watertight::tessellate {
namespace {

using Place = std::array<double, 3>;

/// Rounds to decimals that are fine for the extent of a solid.
class FineDecimals {
 public:
  explicit FineDecimals(const Solid& solid) {
    double largest = 0;
    Place low = solid.world(0);
    Place high = low;
    for (Index vertex = 0; vertex < solid.vertex_count(); ++vertex) {
      const Place place = solid.world(vertex);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], place[axis]);
        high[axis] = std::max(high[axis], place[axis]);
        largest = std::max(largest, std::abs(place[axis]));
      }
    }
    const double extent = std::max(high[0] - low[0], high[1] - low[1]);
    constexpr double kFine = 1e8;      // steps of the extent
    constexpr double kLargest = 9e15;  // 2^53
    while (steps_ < 1e22 && extent * steps_ < kFine && largest * steps_ * 10 < kLargest) {
      steps_ *= 10;
    }
  }

  double rounded(double number) const { return std::round(number * steps_) / steps_; }

 private:
  double steps_ = 1;  // of a unit; a power of ten, exact up to 1e22
};

/// The solid with its corners by height, and the corners that the cut makes.
class Section {
 public:
  Section(const Solid& solid, double height, HeightSide side)
      : height_(height), side_(side), decimals_(solid) {
    for (Index vertex = 0; vertex < solid.vertex_count(); ++vertex) {
      places_.push_back(solid.world(vertex));
      if (places_.back()[2] == height) at_height_.emplace(key_of(places_.back()), vertex);
    }
  }

  /// Whether a corner is strictly on the side that is kept.
  bool is_kept(Index vertex) const {
    return side_ == HeightSide::below ? places_[vertex][2] < height_ : places_[vertex][2] > height_;
  }

  /// Where an edge from a kept corner to another one leaves the part: the other one if it is on the
  /// height, else a new corner. It is the same for both facets of the edge.
  Index crossing(Index kept, Index other) {
    const Place from = places_[kept];
    const Place to = places_[other];
    if (to[2] == height_) return other;
    const double share = (height_ - from[2]) / (to[2] - from[2]);
    const Place place{decimals_.rounded(from[0] + share * (to[0] - from[0])),
                      decimals_.rounded(from[1] + share * (to[1] - from[1])), height_};
    const auto [found, is_new] =
        at_height_.emplace(key_of(place), static_cast<Index>(places_.size()));
    if (is_new) places_.push_back(place);
    return found->second;
  }

  const std::vector<Place>& places() const { return places_; }
  HeightSide side() const { return side_; }

 private:
  static std::pair<double, double> key_of(const Place& place) { return {place[0], place[1]}; }

  double height_;
  HeightSide side_;
  FineDecimals decimals_;
  std::vector<Place> places_;  // of the corners of the solid, and then of new ones
  std::map<std::pair<double, double>, Index> at_height_;
};

/// What is left of a facet.
struct CutFacet {
  std::vector<DirectedEdge> edges;
  std::vector<DirectedEdge> chords;  // those of the edges that lie on the height
};

/// Joins chords at the corners that are inside the facet, on diagonals of its triangles.
template <class IsInner>
void join_chords(std::vector<DirectedEdge>& chords, const IsInner& is_inner) {
  std::unordered_map<Index, Index> next;
  for (const auto& [from, to] : chords) {
    if (is_inner(from)) next.emplace(from, to);
  }
  if (next.empty()) return;
  std::vector<DirectedEdge> joined;
  for (auto [from, to] : chords) {
    if (is_inner(from)) continue;
    // A corner is passed once, so that a ring of chords alone has an end.
    for (auto found = next.find(to); found != next.end(); found = next.find(to)) {
      to = found->second;
      next.erase(found);
    }
    joined.push_back({from, to});
  }
  chords = std::move(joined);
}

class ClippedFacets {
 public:
  ClippedFacets(const Solid& solid, Section& section, FacetRest rest)
      : solid_(solid), section_(section), rest_(rest) {}

  /// Cuts all facets, and closes the sections.
  Status cut() {
    const FacetTriangles triangles = triangulate_facets(solid_);
    const Solid& divided = triangles.divided_solid(solid_);
    std::vector<DirectedEdge> chords;
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      const std::span<const Triangle> own =
          std::span(triangles.triangles)
              .subspan(triangles.first[facet], triangles.first[facet + 1] - triangles.first[facet]);
      if (keep_or_drop(own, facet)) continue;
      const std::size_t step = rest_ == FacetRest::whole ? own.size() : 1;
      for (std::size_t first = 0; first < own.size(); first += step) {
        CutFacet rest = cut_facet(own.subspan(first, step));
        for (const auto& [from, to] : rest.chords) chords.push_back({to, from});
        cut_.emplace_back(std::move(rest.edges), facet_projection(divided, facet));
      }
    }
    std::ranges::sort(chords);
    drop_ridges(chords);
    cut_.emplace_back(std::move(chords),
                      Projection{.axis = 2, .is_mirrored = section_.side() == HeightSide::above});
    return make_rings();
  }

  /// Facets of rings of corners of the section; those that close sections come last.
  const std::vector<LoopedFacet>& facets() const { return facets_; }
  bool is_section(Index facet) const { return facet >= first_section_; }
  const std::vector<Point>& points() const { return points_.points; }
  const Lattice& lattice() const { return points_.lattice; }

 private:
  /// Whether a facet is on one side as a whole; then it is kept or dropped.
  bool keep_or_drop(std::span<const Triangle> triangles, Index facet) {
    std::size_t kept = 0;
    std::size_t all = 0;
    for (const Triangle& triangle : triangles) {
      for (const Index corner : triangle) kept += section_.is_kept(corner) ? 1 : 0;
      all += 3;
    }
    if (kept == 0) return true;
    if (kept < all) return false;
    LoopedFacet rings;
    const IndexRange range = solid_.rings_of(facet);
    for (Index ring = range.begin; ring < range.end; ++ring) {
      rings.emplace_back(solid_.ring(ring).begin(), solid_.ring(ring).end());
    }
    facets_.push_back(std::move(rings));
    return true;
  }

  CutFacet cut_facet(std::span<const Triangle> triangles) {
    CutFacet rest;
    for (const Triangle& triangle : triangles) cut_triangle(triangle, rest);
    cancel_opposite_edges(rest.edges);
    cancel_opposite_edges(rest.chords);
    std::vector<Index> border;
    for (const DirectedEdge& edge : rest.edges)
      border.insert(border.end(), edge.begin(), edge.end());
    std::ranges::sort(border);
    join_chords(rest.chords, [&](Index corner) {
      return corner >= solid_.vertex_count() && !std::ranges::binary_search(border, corner);
    });
    cancel_opposite_edges(rest.chords);
    rest.edges.insert(rest.edges.end(), rest.chords.begin(), rest.chords.end());
    std::ranges::sort(rest.edges);
    return rest;
  }

  /// Adds the edges of what is left of a triangle; the chord apart.
  void cut_triangle(const Triangle& triangle, CutFacet& rest) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangle[k];
      const Index b = triangle[(k + 1) % 3];
      const bool is_from = section_.is_kept(a);
      const bool is_to = section_.is_kept(b);
      if (is_from && is_to) rest.edges.push_back({a, b});
      if (is_from && !is_to) {
        const Index out = section_.crossing(a, b);
        const Index c = triangle[(k + 2) % 3];
        const Index in = section_.is_kept(c) ? section_.crossing(c, b) : section_.crossing(a, c);
        rest.edges.push_back({a, out});
        rest.chords.push_back({out, in});
        if (out < solid_.vertex_count() && in < solid_.vertex_count()) {
          kept_corner_.emplace(DirectedEdge{out, in}, a);
        }
      }
      if (!is_from && is_to) rest.edges.push_back({section_.crossing(b, a), b});
    }
  }

  /// An edge of the solid on the height, both facets of which are kept, is twice in the section,
  /// there and back. A ridge has nothing between both, and vanishes; at a notch two parts touch.
  void drop_ridges(std::vector<DirectedEdge>& chords) const {
    const std::vector<DirectedEdge> all = chords;
    std::erase_if(chords, [&](const DirectedEdge& edge) {
      const DirectedEdge opposite{edge[1], edge[0]};
      return std::ranges::binary_search(all, opposite) && !is_notch(edge, opposite);
    });
  }

  bool is_notch(const DirectedEdge& edge, const DirectedEdge& opposite) const {
    const auto one = kept_corner_.find(edge);
    const auto other = kept_corner_.find(opposite);
    if (one == kept_corner_.end() || other == kept_corner_.end()) return false;
    const std::span<const Point> corners = solid_.vertices();
    return geometry::orient3d(corners[edge[0]], corners[edge[1]], corners[one->second],
                              corners[other->second]) > 0;
  }

  /// Makes rings of the edges of cut facets and sections, on the lattice of all corners.
  Status make_rings() {
    auto points = geometry::lattice_of_doubles(section_.places());
    if (!points) return points.error();
    points_ = *std::move(points);
    for (const auto& [edges, projection] : cut_) {
      first_section_ = facets_.size();  // those of the last edges are the sections
      auto made = facets_of_edges(edges, points_.points, projection);
      if (!made) {
        return Error{ErrorCode::malformed,
                     "the cut at this height is narrower than the coordinates are fine (" +
                         made.error().message + "); another height may do"};
      }
      std::ranges::move(*made, std::back_inserter(facets_));
    }
    return Done{};
  }

  const Solid& solid_;
  Section& section_;
  FacetRest rest_;
  std::vector<std::pair<std::vector<DirectedEdge>, Projection>> cut_;
  std::map<DirectedEdge, Index> kept_corner_;  // of the triangle of a chord along an edge
  std::vector<LoopedFacet> facets_;
  std::size_t first_section_ = 0;
  geometry::LatticePoints points_;
};

/// The facets of each connected surface. Where two parts touch along an edge on the height, four
/// facets have it: that of a section belongs to the one that was cut there.
std::vector<std::vector<Index>> connected_surfaces(const ClippedFacets& clipped) {
  const std::vector<LoopedFacet>& facets = clipped.facets();
  std::map<DirectedEdge, Index> facet_at;
  std::map<DirectedEdge, Index> section_at;
  for (Index facet = 0; facet < facets.size(); ++facet) {
    for (const std::vector<Index>& ring : facets[facet]) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const DirectedEdge edge{ring[i], ring[(i + 1) % ring.size()]};
        (clipped.is_section(facet) ? section_at : facet_at).emplace(edge, facet);
      }
    }
  }
  geometry::DisjointSets sets(facets.size());
  for (const auto& [edge, facet] : facet_at) {
    const DirectedEdge opposite{edge[1], edge[0]};
    if (const auto section = section_at.find(opposite); section != section_at.end()) {
      sets.join(facet, section->second);
    } else if (const auto other = facet_at.find(opposite); other != facet_at.end()) {
      sets.join(facet, other->second);
    }
  }
  const geometry::NumberedSets numbered = sets.numbered();
  std::vector<std::vector<Index>> surfaces(numbered.first.size());
  for (Index facet = 0; facet < facets.size(); ++facet) {
    surfaces[numbered.set_of[facet]].push_back(facet);
  }
  return surfaces;
}

/// A closed surface: its facets, and itself as a solid of one shell.
struct Surface {
  std::vector<Index> facets;
  Solid solid;
  std::vector<Triangle> triangles;
};

/// Puts surfaces into solids, the exterior one of each first.
class Parts {
 public:
  Parts(const ClippedFacets& facets, std::uint32_t srid) : facets_(facets), srid_(srid) {}

  Result<std::vector<Solid>> solids() {
    std::vector<Surface> exteriors;
    std::vector<Surface> cavities;
    for (std::vector<Index>& facets : connected_surfaces(facets_)) {
      auto solid = solid_of({facets});
      if (!solid) return solid.error();
      std::vector<Triangle> triangles = triangulate_facets(*solid).triangles;
      const bool is_exterior = geometry::volume_sign(solid->vertices(), triangles) > 0;
      (is_exterior ? exteriors : cavities)
          .push_back({std::move(facets), *std::move(solid), std::move(triangles)});
    }
    std::vector<std::vector<std::vector<Index>>> shells;
    for (const Surface& exterior : exteriors) shells.push_back({exterior.facets});
    for (const Surface& cavity : cavities) {
      const std::size_t part = part_around(cavity.solid, exteriors);
      if (part == shells.size()) {
        return Error{ErrorCode::malformed, "a cavity is in no part of the solid"};
      }
      shells[part].push_back(cavity.facets);
    }
    std::vector<Solid> parts;
    for (const auto& part : shells) {
      auto solid = solid_of(part);
      if (!solid) return solid.error();
      parts.push_back(*std::move(solid));
    }
    return parts;
  }

 private:
  /// The surface that a cavity is inside of, by a corner that is not on it.
  static std::size_t part_around(const Solid& cavity, const std::vector<Surface>& exteriors) {
    if (exteriors.size() == 1) return 0;
    for (std::size_t i = 0; i < exteriors.size(); ++i) {
      int place = 0;
      for (Index corner = 0; corner < cavity.vertex_count() && place == 0; ++corner) {
        place = geometry::locate(exteriors[i].solid, exteriors[i].triangles, cavity.world(corner));
      }
      if (place > 0) return i;
    }
    return exteriors.size();
  }

  Result<Solid> solid_of(const std::vector<std::vector<Index>>& shells) const {
    SolidArrays arrays;
    std::vector<Index> vertex_of(facets_.points().size(), kNone);
    for (const std::vector<Index>& shell : shells) {
      for (const Index facet : shell) {
        for (const std::vector<Index>& ring : facets_.facets()[facet]) {
          for (const Index corner : ring) {
            if (vertex_of[corner] == kNone) {
              vertex_of[corner] = static_cast<Index>(arrays.vertices.size());
              arrays.vertices.push_back(facets_.points()[corner]);
            }
            arrays.ring_vertices.push_back(vertex_of[corner]);
          }
          arrays.end_ring();
        }
        arrays.end_facet();
      }
      arrays.end_shell();
    }
    return Solid::make(std::move(arrays), facets_.lattice(), srid_);
  }

  const ClippedFacets& facets_;
  std::uint32_t srid_;
};

}  // namespace

Result<std::vector<Solid>> clip_z(const Solid& solid, double height, HeightSide side,
                                  FacetRest rest) {
  if (solid.vertex_count() == 0) return std::vector<Solid>{};
  Section section(solid, height, side);
  ClippedFacets facets(solid, section, rest);
  if (const Status cut = facets.cut(); !cut) return cut.error();
  return Parts(facets, solid.srid()).solids();
}

}  // namespace watertight::tessellate
