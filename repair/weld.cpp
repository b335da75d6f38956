// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "geometry/vector3.h"
#include "repair/border_loops.h"
#include "repair/remedies.h"
#include "validate/overlap/box_tree.h"
#include "validate/snap.h"

namespace watertight::repair {
namespace {

using geometry::cross;
using geometry::dot;
using geometry::operator-;
using geometry::Vector3;

/// An edge that one facet uses, as its ring passes it.
struct OpenEdge {
  std::size_t facet = 0;
  std::size_t ring = 0;
  std::size_t position = 0;  // of the start
  Index from = 0;
  Index to = 0;
};

/// A vertex that is near an open edge, and how far along it, 0 to 1.
struct Near {
  OpenEdge edge;
  double share = 0;
  Index vertex = 0;
};

/// How far along the segment from a to b the vertex p is, if it is at most `metres` from a point
/// inside it; negative if not.
double share_if_near(const Vector3& a, const Vector3& b, const Vector3& p, double metres) {
  const Vector3 way = b - a;
  const double square = dot(way, way);
  if (square == 0) return -1;
  const double share = dot(p - a, way) / square;
  if (share <= 0 || share >= 1) return -1;
  const Vector3 off = cross(p - a, way);
  return dot(off, off) <= metres * metres * square ? share : -1;
}

std::vector<OpenEdge> open_edges(const std::vector<EditedFacet>& facets) {
  std::set<std::pair<Index, Index>> open;  // as the facet there runs
  for (const Ring& loop : border_loops(facets).loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      open.emplace(loop[(i + 1) % loop.size()], loop[i]);
    }
  }
  std::vector<OpenEdge> edges;
  for (std::size_t facet = 0; facet < facets.size(); ++facet) {
    for (std::size_t r = 0; r < facets[facet].rings.size(); ++r) {
      const Ring& ring = facets[facet].rings[r];
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const OpenEdge edge{facet, r, i, ring[i], ring[(i + 1) % ring.size()]};
        if (open.contains({edge.from, edge.to})) edges.push_back(edge);
      }
    }
  }
  return edges;
}

/// The box of an edge, larger by `metres` on all sides.
Box box_around(const EditedSolid& solid, const OpenEdge& edge, double metres,
               const Vector3& metres_per_unit) {
  Box box;
  for (const Index vertex : {edge.from, edge.to}) box.include(solid.vertices[vertex]);
  for (int axis = 0; axis < 3; ++axis) {
    const double unit = metres_per_unit[static_cast<std::size_t>(axis)] * solid.lattice.scale(axis);
    const double reach = std::ceil(metres / unit) + 1;  // one more for rounding
    box.min[axis] -= reach;
    box.max[axis] += reach;
  }
  return box;
}

std::vector<Near> near_edges(const EditedSolid& solid, const std::vector<EditedFacet>& facets,
                             double metres) {
  const std::vector<OpenEdge> edges = open_edges(facets);
  std::vector<Index> ends;
  for (const OpenEdge& edge : edges) ends.push_back(edge.from);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<Box> places(ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i) places[i].include(solid.vertices[ends[i]]);
  const validate::BoxTree tree(places);
  const auto units = metres_per_unit(solid);
  std::vector<Near> near;
  for (const OpenEdge& edge : edges) {
    const Ring& ring = facets[edge.facet].rings[edge.ring];
    const Box around = box_around(solid, edge, metres, units);
    tree.visit([&](const Box& box) { return box.overlaps(around); },
               [&](Index place) {
                 const Index vertex = ends[place];
                 if (!places[place].overlaps(around)) return;
                 const double share = share_if_near(metres_of(solid, edge.from, units),
                                                    metres_of(solid, edge.to, units),
                                                    metres_of(solid, vertex, units), metres);
                 if (share < 0 || std::ranges::find(ring, vertex) != ring.end()) return;
                 near.push_back({edge, share, vertex});
               });
  }
  return near;
}

std::size_t insert_near(EditedSolid& solid, double metres) {
  std::size_t inserted = 0;
  for (std::vector<EditedFacet>& facets : solid.shells) {
    std::vector<Near> near = near_edges(solid, facets, metres);
    // From the last place on, so that the places before it stay.
    std::ranges::sort(near, [](const Near& a, const Near& b) {
      return std::tie(b.edge.facet, b.edge.ring, b.edge.position, b.share, b.vertex) <
             std::tie(a.edge.facet, a.edge.ring, a.edge.position, a.share, a.vertex);
    });
    for (const Near& one : near) {
      Ring& ring = facets[one.edge.facet].rings[one.edge.ring];
      ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(one.edge.position) + 1, one.vertex);
    }
    inserted += near.size();
  }
  return inserted;
}

/// The largest distance in metres between the vertices of a solid and the places they get.
double largest_distance(const EditedSolid& solid, std::span<const Point> places) {
  EditedSolid both{solid.vertices, {}, solid.lattice, solid.srid};
  both.vertices.insert(both.vertices.end(), places.begin(), places.end());
  const auto units = metres_per_unit(solid);
  double largest = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto from = static_cast<Index>(i);
    const auto to = static_cast<Index>(places.size() + i);
    const Vector3 way = metres_of(both, to, units) - metres_of(both, from, units);
    largest = std::max(largest, geometry::length(way));
  }
  return largest;
}

}  // namespace

std::size_t weld(EditedSolid& solid, double metres, Moves& moves) {
  moves = {};
  const Result<Solid> before = solid_of(solid);
  if (!before) return 0;
  const auto snapped = validate::snap_vertices(*before, metres);
  if (!snapped) return 0;
  std::size_t changes = 0;
  if (snapped->moved > 0) {
    const double largest_move = largest_distance(solid, snapped->solid.vertices());
    const geometry::MergedSolid merged = geometry::merge_equal_vertices(snapped->solid);
    for (auto& facets : solid.shells) {
      for (EditedFacet& facet : facets) {
        for (Ring& ring : facet.rings) {
          for (Index& vertex : ring) vertex = merged.vertex_of[vertex];
        }
      }
    }
    solid.vertices.assign(merged.solid.vertices().begin(), merged.solid.vertices().end());
    changes += snapped->moved;
    moves = {snapped->moved, largest_move};
    mend_rings(solid);
  }
  return changes + insert_near(solid, metres);
}

}  // namespace watertight::repair
