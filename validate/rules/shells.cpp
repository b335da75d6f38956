// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rules of shells that need only edges and vertices: two-sided (300), enough facets (301), closed
// (302), 2-manifold (303), one component (305), facets turned alike (307). Exact: two vertices are
// one only if they are equal.
#include <map>

#include "base/quantity.h"
#include "geometry/disjoint_sets.h"
#include "geometry/measures.h"
#include "geometry/mesh/edge_sides.h"
#include "validate/edge_table.h"
#include "validate/overlap/wedges.h"
#include "validate/rules/open_edges.h"
#include "validate/rules/rules.h"

namespace watertight::validate {
namespace {

class ShellExaminer {
 public:
  /// Requires that edges.examine(shell) was called.
  ShellExaminer(ExaminedSolid& examined, const EdgeTable& edges, Index shell)
      : examined_(examined),
        solid_(examined.solid()),
        edges_(edges),
        shell_(shell),
        facets_(examined.solid().facets_of(shell)),
        uses_(edges.uses()),
        is_shell_faulty_(examined.is_shell_faulty(shell)) {}

  ShellTopology examine();

 private:
  using EdgeSpan = std::span<const EdgeUse>;

  void sort_edges();
  void check_facet_count();
  void report_crowded_edge(EdgeSpan edge);
  void check_open();
  void report_junction(const TJunction& junction);
  void report_border(const Border& border);
  void link_wedges(geometry::DisjointSets& fans, Index first_corner, Index last_corner);
  void check_fans();
  void report_pinch(Index vertex, Index facet, std::size_t fans);
  std::string_view interior_connected();
  void check_components();
  void check_orientation();
  void report_turned(const std::vector<Index>& members, const std::vector<char>& turn);

  static void keep_distinct(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  Index number_of(Index vertex) const { return edges_.number_of(vertex); }
  Index local(Index facet) const { return facet - facets_.begin; }
  bool is_faulty(EdgeSpan edge) const {
    return std::any_of(edge.begin(), edge.end(),
                       [&](const EdgeUse& use) { return examined_.is_faulty(use.facet); });
  }
  bool bounds_region(Index facet) const {
    return examined_.triangles().state[facet] == tessellate::FacetState::triangulated;
  }
  /// The first corner of the first ring of a facet that is not empty. Requires a facet with an
  /// edge.
  Place first_corner(Index facet) const {
    const Solid& submitted = examined_.submitted();
    const Index begin = submitted.rings_of(facet).begin;
    Index ring = 0;
    while (submitted.ring(begin + ring).empty()) ++ring;
    return examined_.at_corner(facet, ring, 0);
  }
  Place place_of(const EdgeUse& use) const {
    const CornerPlace place = place_of_corner(solid_, use.facet, use.corner);
    return examined_.at_corner(use.facet, place.ring_in_facet, place.position);
  }

  /// Calls visit(a, b) for the two uses of each edge that is used exactly twice.
  template <class Visit>
  void for_each_pair(Visit visit) const {
    geometry::for_each_edge(uses_, [&](EdgeSpan edge) {
      if (edge.size() == 2) visit(edge[0], edge[1]);
    });
  }

  ExaminedSolid& examined_;
  const Solid& solid_;
  const EdgeTable& edges_;
  Index shell_;
  IndexRange facets_;
  EdgeSpan uses_;
  std::vector<EdgeUse> open_;   // the edges used once
  std::vector<Index> crowded_;  // vertices of edges used more than twice, ascending
  bool is_shell_faulty_ = false;
  std::string interior_connected_;
  ShellTopology topology_;
};

void ShellExaminer::check_facet_count() {
  if (facets_.size() >= 4 || solid_.facet_count() == 0) return;
  examined_.findings.add({.code = kTooFewPolygons,
                          .place = examined_.at_shell(shell_),
                          .measured = static_cast<double>(facets_.size()),
                          .limit = 4,
                          .unit = "facets",
                          .detail = "the shell has " + quantity(facets_.size(), "facet")});
}

void ShellExaminer::sort_edges() {
  topology_.is_manifold = true;
  geometry::for_each_edge(uses_, [&](EdgeSpan edge) {
    if (edge.size() == 1) {
      open_.push_back(edge[0]);
    } else if (edge.size() > 2) {
      topology_.is_manifold = false;
      crowded_.push_back(edge[0].low);
      crowded_.push_back(edge[0].high);
      report_crowded_edge(edge);
    }
  });
  keep_distinct(crowded_);
  topology_.is_closed = open_.empty() && topology_.is_manifold && !uses_.empty();
}

void ShellExaminer::report_crowded_edge(EdgeSpan edge) {
  examined_.findings.add({.code = kNonManifold,
                          .place = place_of(edge[0]),
                          .other = place_of(edge[edge.size() - 1]),
                          .witness = examined_.world(edge[0].low),
                          .measured = static_cast<double>(edge.size()),
                          .limit = 2,
                          .unit = "facets",
                          .detail = "an edge is used by " + std::to_string(edge.size()) + " facets",
                          .uncertain = is_faulty(edge)});
}

void ShellExaminer::report_junction(const TJunction& junction) {
  examined_.note_junction(junction.edge.facet, junction.vertex);
  Finding finding;
  finding.code = kShellNotClosed;
  finding.place = place_of(junction.edge);
  finding.place.vertex = examined_.submitted_vertex(junction.vertex);
  finding.other = place_of(junction.across);
  finding.witness = examined_.world(junction.vertex);
  finding.detail = "T-junction: vertex " + std::to_string(finding.place.vertex) +
                   " lies inside an edge of facet " + std::to_string(junction.edge.facet) +
                   ", which does not have it";
  finding.uncertain =
      examined_.is_faulty(junction.edge.facet) || examined_.is_faulty(junction.across.facet);
  examined_.findings.add(std::move(finding));
}

void ShellExaminer::report_border(const Border& border) {
  const EdgeUse& first = border.edges.front();
  examined_.findings.add({.code = kShellNotClosed,
                          .place = place_of(first),
                          .witness = examined_.world(first.low),
                          .measured = static_cast<double>(border.edges.size()),
                          .limit = 0,
                          .unit = "edges",
                          .detail = "a hole: a border of " + quantity(border.edges.size(), "edge") +
                                    " that only one facet uses",
                          .uncertain = is_faulty(border.edges)});
}

void ShellExaminer::check_open() {
  if (open_.empty()) return;
  const OpenEdges result =
      examine_open_edges(solid_, open_, [this] { return examined_.is_cancelled(); });
  for (const TJunction& junction : result.junctions) report_junction(junction);
  for (const Border& border : result.borders) report_border(border);
  if (!result.is_complete) {
    examined_.findings.skip({kShellNotClosed},
                            "not all T-junctions were looked for: too many "
                            "open edges in shell " +
                                std::to_string(shell_));
  }
}

/// Links the two edges that bound the inside of a facet at a vertex. They are the edges of one
/// corner, unless several rings of the facet pass the vertex.
void ShellExaminer::link_wedges(geometry::DisjointSets& fans, Index first_corner,
                                Index last_corner) {
  std::vector<Wedge> shared;
  for (Index facet = facets_.begin; facet < facets_.end; ++facet) {
    const std::vector<Wedge> wedges = shared_wedges(solid_, examined_.triangles(), facet);
    shared.insert(shared.end(), wedges.begin(), wedges.end());
  }
  std::sort(shared.begin(), shared.end(),
            [](const Wedge& a, const Wedge& b) { return a.from < b.from; });
  auto wedge = shared.begin();
  for (Index corner = first_corner; corner < last_corner; ++corner) {
    Index to = corner;
    if (wedge != shared.end() && wedge->from == corner) to = (wedge++)->to;
    fans.join(2 * (corner - first_corner) + 1, 2 * (to - first_corner));
  }
}

/// Reports vertices with several fans. The ring edges around a vertex, linked by the facets between
/// them, form the fans. The edge that arrives at corner c has the number 2 c, the edge that leaves
/// it 2 c + 1, both counted from the first corner of the shell.
void ShellExaminer::check_fans() {
  const auto& offsets = solid_.arrays().ring_offsets;
  const auto& ring_vertices = solid_.arrays().ring_vertices;
  const Index first_corner = offsets[solid_.arrays().facet_offsets[facets_.begin]];
  const Index last_corner = offsets[solid_.arrays().facet_offsets[facets_.end]];
  geometry::DisjointSets fans(2 * std::size_t{last_corner - first_corner});
  const auto arriving = [&](Index corner) { return 2 * (corner - first_corner); };
  const auto leaving = [&](Index corner) { return arriving(corner) + 1; };
  link_wedges(fans, first_corner, last_corner);
  const auto ends = [&](const EdgeUse& use) {  // the numbers at the low and at the high vertex
    const Index next = place_of_corner(solid_, use.facet, use.corner).next;
    return edges_.is_forward(use) ? std::pair(leaving(use.corner), arriving(next))
                                  : std::pair(arriving(next), leaving(use.corner));
  };
  for_each_pair([&](const EdgeUse& a, const EdgeUse& b) {
    const auto [low_of_a, high_of_a] = ends(a);
    const auto [low_of_b, high_of_b] = ends(b);
    fans.join(low_of_a, low_of_b);
    fans.join(high_of_a, high_of_b);
  });
  // Every fan lies around one vertex.
  struct Around {
    Index fans = 0;
    Index facet = kNone;  // the first facet at the vertex
  };
  std::vector<Around> around(edges_.vertices().size());
  std::vector<bool> is_seen(2 * std::size_t{last_corner - first_corner}, false);
  for (const EdgeUse& use : uses_) {
    const Index root = fans.root(leaving(use.corner));
    Around& here = around[number_of(ring_vertices[use.corner])];
    here.facet = std::min(here.facet, use.facet);
    if (is_seen[root]) continue;
    is_seen[root] = true;
    ++here.fans;
  }
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (around[i].fans < 2) continue;
    const Index vertex = edges_.vertices()[i];
    if (std::binary_search(crowded_.begin(), crowded_.end(), vertex)) continue;
    report_pinch(vertex, around[i].facet, around[i].fans);
  }
}

void ShellExaminer::report_pinch(Index vertex, Index facet, std::size_t fans) {
  topology_.is_manifold = false;
  Finding finding;
  finding.code = kNonManifold;
  finding.place = examined_.at_facet(facet);
  finding.place.vertex = examined_.submitted_vertex(vertex);
  finding.witness = examined_.world(vertex);
  finding.measured = static_cast<double>(fans);
  finding.limit = 1;
  finding.unit = "groups";
  finding.detail = std::to_string(fans) + " separate groups of facets meet in one vertex";
  if (topology_.is_closed) {
    finding.detail += "; interior_connected: " + std::string(interior_connected());
  }
  finding.uncertain = is_shell_faulty_;
  examined_.findings.add(std::move(finding));
}

/// "yes" or "no" for a closed shell that touches itself in vertices. Each part of the shell that is
/// connected through edges bounds a region. The interior is connected if there is one part, or if
/// all parts but one are turned inward (cavities that touch the outside in a vertex).
std::string_view ShellExaminer::interior_connected() {
  if (!interior_connected_.empty()) return interior_connected_;
  geometry::DisjointSets parts(facets_.size());
  for_each_pair(
      [&](const EdgeUse& a, const EdgeUse& b) { parts.join(local(a.facet), local(b.facet)); });
  std::map<Index, std::vector<Triangle>> triangles;
  const tessellate::FacetTriangles& all = examined_.triangles();
  for (Index facet = facets_.begin; facet < facets_.end; ++facet) {
    auto& list = triangles[parts.root(local(facet))];
    list.insert(list.end(), all.triangles.begin() + all.first[facet],
                all.triangles.begin() + all.first[facet + 1]);
  }
  std::size_t outward = 0;
  for (const auto& [root, list] : triangles) {
    if (geometry::volume_sign(solid_.vertices(), list) > 0) ++outward;
  }
  interior_connected_ = triangles.size() == 1 || outward == 1 ? "yes" : "no";
  return interior_connected_;
}

void ShellExaminer::check_components() {
  geometry::DisjointSets vertices(edges_.vertices().size());
  for (const EdgeUse& use : uses_) vertices.join(number_of(use.low), number_of(use.high));
  // Joins the rings of each facet: edges alone need not connect an interior ring to the exterior
  // ring.
  std::vector<Index> anchor(facets_.size(), kNone);
  for (const EdgeUse& use : uses_) {
    Index& first = anchor[local(use.facet)];
    if (first == kNone) first = number_of(use.low);
    vertices.join(first, number_of(use.low));
  }
  const auto is_apart = [&](Index first) {
    return first != kNone && vertices.root(first) != vertices.root(0);
  };
  topology_.is_connected = std::none_of(anchor.begin(), anchor.end(), is_apart);
  if (topology_.is_connected) return;
  std::map<Index, std::vector<Index>> components;  // root of a set of vertices -> facets
  for (Index i = 0; i < anchor.size(); ++i) {
    if (anchor[i] != kNone) components[vertices.root(anchor[i])].push_back(facets_.begin + i);
  }
  const auto largest = std::max_element(
      components.begin(), components.end(),
      [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  for (auto part = components.begin(); part != components.end(); ++part) {
    if (part == largest) continue;
    Finding finding;
    finding.code = kMultipleComponents;
    finding.place = first_corner(part->second.front());
    finding.witness = examined_.submitted().world(finding.place.vertex);
    finding.measured = static_cast<double>(part->second.size());
    finding.unit = "facets";
    finding.detail = "a part of " + quantity(part->second.size(), "facet") +
                     " shares no vertex with the rest of the shell";
    finding.uncertain = is_shell_faulty_;
    examined_.findings.add(std::move(finding));
  }
}

void ShellExaminer::check_orientation() {
  // Two facets that are neighbours at an edge; in a conflict they turn in opposite directions.
  struct Link {
    Index from, to;
    bool is_conflict;
  };
  topology_.is_oriented = true;
  for_each_pair([&](const EdgeUse& a, const EdgeUse& b) {
    if (edges_.is_forward(a) == edges_.is_forward(b)) topology_.is_oriented = false;
  });
  if (topology_.is_oriented) return;
  std::vector<Link> links;
  for_each_pair([&](const EdgeUse& a, const EdgeUse& b) {
    if (!bounds_region(a.facet) || !bounds_region(b.facet))
      return;  // a facet without a region has no side
    const bool is_conflict = edges_.is_forward(a) == edges_.is_forward(b);
    links.push_back({local(a.facet), local(b.facet), is_conflict});
    links.push_back({local(b.facet), local(a.facet), is_conflict});
  });
  std::stable_sort(links.begin(), links.end(),
                   [](const Link& a, const Link& b) { return a.from < b.from; });
  std::vector<std::size_t> first(facets_.size() + 1, 0);
  for (const Link& link : links) ++first[link.from + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());

  // +1: the facet turns as the first facet of its part does, -1: the other way, 0: not known yet.
  std::vector<char> turn(facets_.size(), 0);
  for (Index start = 0; start < facets_.size(); ++start) {
    if (turn[start] != 0) continue;
    turn[start] = 1;
    std::vector<Index> members{start};
    bool is_orientable = true;
    for (std::size_t next = 0; next < members.size(); ++next) {
      const Index facet = members[next];
      for (std::size_t l = first[facet]; l < first[facet + 1]; ++l) {
        const auto wanted = static_cast<char>(links[l].is_conflict ? -turn[facet] : turn[facet]);
        if (turn[links[l].to] == 0) {
          turn[links[l].to] = wanted;
          members.push_back(links[l].to);
        } else if (turn[links[l].to] != wanted) {
          is_orientable = false;
        }
      }
    }
    if (is_orientable) {
      report_turned(members, turn);
      continue;
    }
    examined_.findings.add(
        {.code = kNotValid2Manifold,
         .place = examined_.at_facet(facets_.begin + start),
         .measured = static_cast<double>(members.size()),
         .unit = "facets",
         .detail = "the facets cannot be turned alike: the surface has only one side",
         .uncertain = is_shell_faulty_});
  }
}

/// Reports the facets that are turned over: of the two groups that turn in opposite directions, the
/// smaller.
void ShellExaminer::report_turned(const std::vector<Index>& members,
                                  const std::vector<char>& turn) {
  const auto opposite = static_cast<std::size_t>(
      std::count_if(members.begin(), members.end(), [&](Index facet) { return turn[facet] < 0; }));
  if (opposite == 0) return;
  const char turned = opposite * 2 <= members.size() ? -1 : 1;
  std::vector<Index> sorted = members;
  std::sort(sorted.begin(), sorted.end());
  for (const Index facet : sorted) {
    if (turn[facet] != turned) continue;
    examined_.findings.add({.code = kPolygonWrongOrientation,
                            .place = examined_.at_facet(facets_.begin + facet),
                            .detail = "the facet is turned over against most of its neighbours",
                            .uncertain = is_shell_faulty_});
  }
}

ShellTopology ShellExaminer::examine() {
  check_facet_count();
  if (uses_.empty()) return topology_;
  sort_edges();
  for (const auto check : {&ShellExaminer::check_open, &ShellExaminer::check_fans,
                           &ShellExaminer::check_components, &ShellExaminer::check_orientation}) {
    if (examined_.is_cancelled()) return {};
    (this->*check)();
  }
  return topology_;
}

}  // namespace

std::vector<ShellTopology> check_shells(ExaminedSolid& examined) {
  std::vector<ShellTopology> result(examined.solid().shell_count());
  EdgeTable edges(examined.solid());
  for (Index shell = 0; shell < result.size(); ++shell) {
    if (examined.is_cancelled()) break;
    edges.examine(shell);
    result[shell] = ShellExaminer(examined, edges, shell).examine();
  }
  if (examined.was_cancelled()) {
    examined.findings.skip({300, 302, 303, 305, 307}, "the search was cancelled");
  }
  examined.index_junctions();
  return result;
}

}  // namespace watertight::validate
