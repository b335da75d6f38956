// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/verdict/oracle.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "bench/verdict/surface.h"

namespace watertight::verdict {
namespace {

using Numbers = std::set<std::size_t>;

class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

/// The regions and facets at each edge and point of a complex.
struct Incidence {
  // A region is listed twice if it is on both sides.
  std::vector<std::vector<std::size_t>> regions_at_edge;
  std::vector<Numbers> facets_at_edge;
  std::vector<Numbers> facets_at_point;
};

Incidence incidence_of(const Complex& complex) {
  Incidence incidence;
  incidence.regions_at_edge.resize(complex.edges.size());
  incidence.facets_at_edge.resize(complex.edges.size());
  incidence.facets_at_point.resize(complex.points.size());
  const auto add_point = [&](std::size_t point, std::size_t region) {
    const auto& facets = complex.regions[region].facets;
    incidence.facets_at_point[point].insert(facets.begin(), facets.end());
  };
  for (std::size_t region = 0; region < complex.regions.size(); ++region) {
    for (const std::size_t edge : complex.regions[region].edges) {
      incidence.regions_at_edge[edge].push_back(region);
      const auto& facets = complex.regions[region].facets;
      incidence.facets_at_edge[edge].insert(facets.begin(), facets.end());
      for (const std::size_t point : complex.edges[edge]) add_point(point, region);
    }
  }
  for (const LonePoint& lone : complex.lone_points) add_point(lone.point, lone.region);
  return incidence;
}

/// The ring edges and the vertices at the points of the complex.
struct RingCells {
  std::set<std::array<std::size_t, 2>> edges;  // the ring edges, as wholes, on which the cell lies
  bool is_vertex = false;
};

class SolidOracle {
 public:
  explicit SolidOracle(const Solid& solid) : model_(model_of(solid)) {}

  Truth decide() {
    truth_.is_known = model_.is_known;
    truth_.is_planar = std::all_of(model_.facets.begin(), model_.facets.end(),
                                   [](const FacetModel& facet) { return facet.is_planar; });
    if (!model_.is_known) return truth_;
    if (!model_.ring_codes.empty()) return refuse(model_.ring_codes, "rings");
    complex_ = arrange(pieces_of(model_));
    incidence_ = incidence_of(complex_);
    number_points();
    check_facet_interiors();
    check_directions();
    check_shared_regions();
    check_edges();
    check_points();
    check_links();
    check_components();
    if (truth_.codes.empty()) check_nesting();
    if (truth_.codes.empty()) check_orientation();
    if (truth_.codes.empty()) check_interior();
    note_crossing_edges();
    return truth_;
  }

 private:
  Truth refuse(const std::set<int>& codes, const char* reason) {
    truth_.codes.insert(codes.begin(), codes.end());
    if (truth_.reason.empty()) truth_.reason = reason;
    return truth_;
  }
  std::size_t shell_of(std::size_t facet) const { return model_.facets[facet].shell; }

  void number_points() {
    for (std::size_t i = 0; i < complex_.points.size(); ++i) number_[complex_.points[i]] = i;
    for (const FacetModel& facet : model_.facets) {
      auto& edges = ring_edges_.emplace_back();
      auto& vertices = ring_vertices_.emplace_back();
      for (const ExactEdge& edge : facet.edges) {
        edges.push_back({number_.at(edge[0]), number_.at(edge[1])});
        vertices.insert(number_.at(edge[0]));
      }
    }
  }

  /// The ring edges of a facet, by their sorted end points, that contain all of the given points.
  std::set<std::array<std::size_t, 2>> ring_edges_with(std::size_t facet,
                                                       const std::vector<std::size_t>& points) {
    std::set<std::array<std::size_t, 2>> found;
    for (const auto& [from, to] : ring_edges_[facet]) {
      const bool has_all = std::all_of(points.begin(), points.end(), [&, a = from, b = to](auto p) {
        return p == a || p == b ||
               is_on_segment(complex_.points[p], complex_.points[a], complex_.points[b]);
      });
      if (has_all) found.insert({std::min(from, to), std::max(from, to)});
    }
    return found;
  }

  /// Checks that the interior of each facet is connected (205).
  void check_facet_interiors() {
    Sets sets(complex_.regions.size());
    std::vector<Numbers> parts(model_.facets.size());
    for (std::size_t facet = 0; facet < model_.facets.size(); ++facet) {
      for (std::size_t edge = 0; edge < complex_.edges.size(); ++edge) {
        if (incidence_.facets_at_edge[edge].count(facet) == 0) continue;
        const auto& ends = complex_.edges[edge];
        if (!ring_edges_with(facet, {ends[0], ends[1]}).empty()) continue;
        std::vector<std::size_t> own;
        for (const std::size_t region : incidence_.regions_at_edge[edge]) {
          if (has_facet(region, facet)) own.push_back(region);
        }
        for (const std::size_t region : own) sets.join(region, own.front());
      }
      for (std::size_t region = 0; region < complex_.regions.size(); ++region) {
        if (has_facet(region, facet)) parts[facet].insert(region);
      }
      Numbers roots;
      for (const std::size_t region : parts[facet]) roots.insert(sets.find(region));
      if (roots.size() > 1) refuse({205}, "a facet's interior falls apart");
      sets = Sets(complex_.regions.size());
    }
  }
  bool has_facet(std::size_t region, std::size_t facet) const {
    const auto& facets = complex_.regions[region].facets;
    return std::binary_search(facets.begin(), facets.end(), facet);
  }

  /// Checks that each ring edge belongs to two facets of its shell, with opposite directions.
  void check_directions() {
    // The key is a shell and two ends.
    std::map<std::array<std::size_t, 3>, std::array<std::size_t, 2>> uses;
    for (std::size_t facet = 0; facet < model_.facets.size(); ++facet) {
      for (const auto& [from, to] : ring_edges_[facet]) {
        ++uses[{shell_of(facet), std::min(from, to), std::max(from, to)}][from < to ? 0 : 1];
      }
    }
    for (const auto& [edge, counts] : uses) {
      const std::size_t all = counts[0] + counts[1];
      if (all == 1) refuse({302}, "an edge has one facet");
      if (all > 2) refuse({303}, "an edge has more than two facets");
      if (all == 2 && counts[0] != 1) refuse({307, 300}, "two facets turn against each other");
    }
  }

  void check_shared_regions() {
    for (const Region& region : complex_.regions) {
      std::map<std::size_t, std::size_t> count;
      for (const std::size_t facet : region.facets) ++count[shell_of(facet)];
      for (const auto& [shell, facets] : count) {
        if (facets > 1) refuse({303, 306}, "two facets of a shell share an area");
      }
    }
  }

  /// Checks that two facets of a shell that share an edge of the complex share the ring edge there.
  void check_edges() {
    for (std::size_t edge = 0; edge < complex_.edges.size(); ++edge) {
      const std::vector<std::size_t> ends(complex_.edges[edge].begin(), complex_.edges[edge].end());
      std::map<std::size_t, std::set<std::set<std::array<std::size_t, 2>>>> by_shell;
      std::map<std::size_t, std::size_t> facets;
      for (const std::size_t facet : incidence_.facets_at_edge[edge]) {
        by_shell[shell_of(facet)].insert(ring_edges_with(facet, ends));
        ++facets[shell_of(facet)];
      }
      for (const auto& [shell, found] : by_shell) {
        const bool is_common = found.size() == 1 && found.begin()->size() == 1;
        if (facets[shell] > 1 && !is_common) {
          refuse({303, 306}, "two facets meet along a segment that is no edge of both");
        }
      }
    }
  }

  /// Checks that two facets of a shell that share a point have it as a vertex, or on a common ring
  /// edge.
  void check_points() {
    for (std::size_t point = 0; point < complex_.points.size(); ++point) {
      const auto& facets = incidence_.facets_at_point[point];
      for (auto i = facets.begin(); i != facets.end(); ++i) {
        for (auto j = facets.begin(); j != i; ++j) {
          if (shell_of(*i) == shell_of(*j) && !may_share(point, *i, *j)) {
            refuse({303, 306}, "two facets meet in a point that is no vertex of both");
          }
        }
      }
    }
  }
  bool may_share(std::size_t point, std::size_t first, std::size_t second) {
    if (ring_vertices_[first].count(point) != 0 && ring_vertices_[second].count(point) != 0) {
      return true;
    }
    const auto edges = ring_edges_with(second, {point});
    for (const auto& edge : ring_edges_with(first, {point})) {
      if (edges.count(edge) != 0) return true;
    }
    return false;
  }

  /// Checks that the corners of a shell's facets around each vertex form one cycle.
  void check_links() {
    // The key is a point and a shell.
    std::map<std::array<std::size_t, 2>, std::vector<const Corner*>> corners;
    for (const Corner& corner : complex_.corners) {
      Numbers shells;
      for (const std::size_t facet : complex_.regions[corner.region].facets) {
        shells.insert(shell_of(facet));
      }
      for (const std::size_t shell : shells) corners[{corner.point, shell}].push_back(&corner);
    }
    for (const auto& [place, around] : corners) {
      Sets sets(complex_.edges.size());
      std::map<std::size_t, std::size_t> degree;
      for (const Corner* corner : around) {
        sets.join(corner->edges[0], corner->edges[1]);
        for (const std::size_t edge : corner->edges) ++degree[edge];
      }
      Numbers roots;
      for (const auto& [edge, count] : degree) {
        roots.insert(sets.find(edge));
        if (count != 2) refuse({302, 303, 306}, "the surface at an edge is not two half planes");
      }
      if (roots.size() > 1) refuse({303, 306}, "the facets around a vertex are several fans");
    }
  }

  void check_components() {
    Sets sets(model_.facets.size());
    std::map<std::array<std::size_t, 2>, std::size_t> facet_at;  // the key is a shell and a vertex
    for (std::size_t facet = 0; facet < model_.facets.size(); ++facet) {
      for (const std::size_t vertex : ring_vertices_[facet]) {
        sets.join(facet,
                  facet_at.emplace(std::array{shell_of(facet), vertex}, facet).first->second);
      }
    }
    std::map<std::size_t, Numbers> roots;
    for (std::size_t i = 0; i < model_.facets.size(); ++i) {
      roots[shell_of(i)].insert(sets.find(i));
    }
    for (const auto& [shell, parts] : roots) {
      if (parts.size() > 1) refuse({305}, "a shell falls apart");
    }
  }

  bool has_shell(std::size_t region, std::size_t shell) const {
    const auto& facets = complex_.regions[region].facets;
    return std::any_of(facets.begin(), facets.end(),
                       [&](std::size_t facet) { return shell_of(facet) == shell; });
  }

  /// A point of each part into which other shells can cut a shell.
  std::vector<Vector> samples_of(std::size_t shell) {
    Sets sets(complex_.regions.size());
    for (std::size_t edge = 0; edge < complex_.edges.size(); ++edge) {
      const auto& facets = incidence_.facets_at_edge[edge];
      const bool is_own = std::all_of(facets.begin(), facets.end(),
                                      [&](auto facet) { return shell_of(facet) == shell; });
      if (!is_own) continue;
      const auto& regions = incidence_.regions_at_edge[edge];
      for (const std::size_t region : regions) sets.join(region, regions.front());
    }
    std::vector<Vector> samples;
    for (std::size_t region = 0; region < complex_.regions.size(); ++region) {
      if (has_shell(region, shell) && sets.find(region) == region) {
        samples.push_back(complex_.regions[region].sample);
      }
    }
    return samples;
  }

  /// The numbers of parts of one shell that lie outside and inside another.
  std::array<std::size_t, 2> parts_in(std::size_t shell, std::size_t other) {
    std::vector<Piece> pieces;
    for (Piece& piece : pieces_of(model_)) {
      if (shell_of(piece.facet) == other) pieces.push_back(std::move(piece));
    }
    const ParityLocator locator(std::move(pieces));
    std::array<std::size_t, 2> counts{};
    for (const Vector& sample : samples_of(shell)) ++counts[locator.is_inside(sample) ? 1 : 0];
    return counts;
  }

  void check_nesting() {
    for (const Region& region : complex_.regions) {
      if (region.facets.size() > 1) {
        refuse({401, 402}, "two shells share an area");
        return;
      }
    }
    for (std::size_t inner = 1; inner < model_.shell_count; ++inner) {
      const auto [outside, inside] = parts_in(inner, 0);
      const bool holds_exterior = parts_in(0, inner)[1] != 0;
      if (outside != 0 && inside != 0) refuse({401}, "a cavity crosses the exterior shell");
      if (outside == 0 && holds_exterior) refuse({401}, "a cavity holds a part of the outside");
      if (inside == 0 && holds_exterior) refuse({401, 403}, "a cavity holds the exterior shell");
      if (inside == 0 && !holds_exterior) refuse({403}, "a cavity is outside");
      for (std::size_t other = 1; other < inner; ++other) {
        if (parts_in(inner, other)[1] + parts_in(other, inner)[1] != 0) {
          refuse({401}, "two cavities have common points inside");
        }
      }
    }
  }

  void check_orientation() {
    std::vector<Number> volume(model_.shell_count);
    for (const FacetModel& facet : model_.facets) {
      for (const auto& rings : facet.pieces) {
        for (const auto& ring : rings) {
          for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
            volume[facet.shell] += dot(ring[0], cross(ring[k], ring[k + 1]));
          }
        }
      }
    }
    for (std::size_t shell = 0; shell < volume.size(); ++shell) {
      if (sgn(volume[shell]) * (shell == 0 ? 1 : -1) <= 0) refuse({405}, "a shell is inside out");
    }
  }

  /// Checks that space without the complex has as components the outside, each cavity, and one
  /// interior.
  void check_interior() {
    if (complement_components(complex_) != model_.shell_count + 1) {
      refuse({404}, "the interior falls into parts");
    }
  }

  /// Notes a point of the complex that lies on ring edges of two shells and is no vertex.
  void note_crossing_edges() {
    for (std::size_t point = 0; point < complex_.points.size(); ++point) {
      Numbers shells;
      bool is_vertex = false;
      for (const std::size_t facet : incidence_.facets_at_point[point]) {
        is_vertex = is_vertex || ring_vertices_[facet].count(point) != 0;
        if (!ring_edges_with(facet, {point}).empty()) shells.insert(shell_of(facet));
      }
      truth_.has_crossing_edges = truth_.has_crossing_edges || (!is_vertex && shells.size() > 1);
    }
  }

  SurfaceModel model_;
  Complex complex_;
  Incidence incidence_;
  std::map<Vector, std::size_t> number_;
  // For each facet, pairs of ends (from, to).
  std::vector<std::vector<std::array<std::size_t, 2>>> ring_edges_;
  std::vector<Numbers> ring_vertices_;
  Truth truth_;
};

/// True if the interiors of two solids are on the same side of facets at one place: behind both.
bool are_on_one_side(const FacetModel& first, const FacetModel& second) {
  const auto normal = [](const FacetModel& facet) {
    const auto& ring = facet.pieces.front().front();
    Vector sum{0, 0, 0};
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
      const Vector part = cross(difference(ring[k], ring[0]), difference(ring[k + 1], ring[0]));
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += part[axis];
    }
    return sum;
  };
  return sgn(dot(normal(first), normal(second))) > 0;
}

}  // namespace

Truth truth_of(const Solid& solid) { return SolidOracle(solid).decide(); }

PairTruth pair_truth_of(const Solid& first, const Solid& second) {
  const std::array<SurfaceModel, 2> models{model_of(first), model_of(second)};
  const std::size_t split = models[0].facets.size();
  std::vector<Piece> pieces = pieces_of(models[0]);
  const std::vector<Piece> more = pieces_of(models[1], split);
  pieces.insert(pieces.end(), more.begin(), more.end());
  const Complex complex = arrange(pieces);
  const std::array<ParityLocator, 2> locators{ParityLocator(pieces_of(models[0])),
                                              ParityLocator(pieces_of(models[1]))};
  PairTruth truth;
  truth.are_equal = true;
  for (const Region& region : complex.regions) {
    const bool in_first = region.facets.front() < split;
    const bool in_second = region.facets.back() >= split;
    if (in_first && in_second) {
      truth.share_area = true;
      const bool are_alike = are_on_one_side(models[0].facets[region.facets.front()],
                                             models[1].facets[region.facets.back() - split]);
      truth.overlap = truth.overlap || are_alike;
      truth.are_equal = truth.are_equal && are_alike;
      continue;
    }
    truth.are_equal = false;
    if (!truth.overlap && locators[in_first ? 1 : 0].is_inside(region.sample)) truth.overlap = true;
  }
  return truth;
}

}  // namespace watertight::verdict
