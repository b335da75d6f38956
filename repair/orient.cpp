// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <span>
#include <utility>

#include "geometry/measures.h"
#include "geometry/predicates/predicates.h"
#include "repair/remedies.h"
#include "repair/turn.h"
#include "tessellate/facets.h"

namespace watertight::repair {
namespace {

/// A facet that passes an edge, and whether it does so from the smaller vertex on.
struct Pass {
  std::pair<Index, Index> edge;  // the smaller vertex first
  std::size_t facet = 0;
  bool is_forward = false;
};

/// The passes of all facets, those of an edge beside each other in the order of the facets.
std::vector<Pass> passes_of(const std::vector<EditedFacet>& facets) {
  std::vector<Pass> passes;
  for (std::size_t facet = 0; facet < facets.size(); ++facet) {
    for (const Ring& ring : facets[facet].rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Index from = ring[i];
        const Index to = ring[(i + 1) % ring.size()];
        passes.push_back({std::minmax(from, to), facet, from < to});
      }
    }
  }
  std::ranges::stable_sort(passes, {}, &Pass::edge);
  return passes;
}

/// Calls a function with the passes of each edge.
template <class Function>
void for_each_edge(std::span<const Pass> passes, const Function& function) {
  while (!passes.empty()) {
    std::size_t count = 1;
    while (count < passes.size() && passes[count].edge == passes[0].edge) ++count;
    function(passes.first(count));
    passes = passes.subspan(count);
  }
}

/// Facets that meet across edges of two facets, and whether the two disagree.
std::vector<std::vector<std::pair<std::size_t, bool>>> neighbours_of(
    const std::vector<EditedFacet>& facets) {
  std::vector<std::vector<std::pair<std::size_t, bool>>> neighbours(facets.size());
  for_each_edge(passes_of(facets), [&](std::span<const Pass> passes) {
    if (passes.size() != 2 || passes[0].facet == passes[1].facet) return;
    const bool disagree = passes[0].is_forward == passes[1].is_forward;
    neighbours[passes[0].facet].emplace_back(passes[1].facet, disagree);
    neighbours[passes[1].facet].emplace_back(passes[0].facet, disagree);
  });
  return neighbours;
}

/// Turns facets so that neighbours agree. A set that no choice satisfies (a Moebius strip) stays.
std::size_t agree(std::vector<EditedFacet>& facets) {
  const auto neighbours = neighbours_of(facets);
  std::vector<int> side(facets.size(), 0);  // +1 and -1 in the two parts of a connected set
  std::size_t turned = 0;
  for (std::size_t start = 0; start < facets.size(); ++start) {
    if (side[start] != 0) continue;
    std::vector<std::size_t> set{start};
    side[start] = 1;
    bool is_orientable = true;
    for (std::size_t next = 0; next < set.size(); ++next) {
      for (const auto& [other, disagree] : neighbours[set[next]]) {
        const int wanted = disagree ? -side[set[next]] : side[set[next]];
        if (side[other] == 0) {
          side[other] = wanted;
          set.push_back(other);
        } else if (side[other] != wanted) {
          is_orientable = false;
        }
      }
    }
    if (!is_orientable) continue;
    const auto behind = static_cast<std::size_t>(
        std::ranges::count_if(set, [&](std::size_t facet) { return side[facet] < 0; }));
    const int smaller = 2 * behind <= set.size() ? -1 : 1;
    for (const std::size_t facet : set) {
      if (side[facet] != smaller) continue;
      turn_over(facets[facet]);
      ++turned;
    }
  }
  return turned;
}

std::size_t turn_interior_rings(const EditedSolid& solid, std::vector<EditedFacet>& facets) {
  std::size_t turned = 0;
  for (EditedFacet& facet : facets) {
    if (facet.rings.size() < 2) continue;
    const auto axis = projection_axis(solid, facet);
    const int exterior = axis ? turn_of(solid, facet.rings[0], *axis) : 0;
    for (std::size_t i = 1; i < facet.rings.size() && exterior != 0; ++i) {
      if (turn_of(solid, facet.rings[i], *axis) != exterior) continue;
      std::reverse(facet.rings[i].begin(), facet.rings[i].end());
      ++turned;
    }
  }
  return turned;
}

/// The sign of the volume that a closed shell encloses; 0 where facets have no triangles.
int sign_of_volume(const EditedSolid& edited, std::span<const EditedFacet> shell) {
  const Result<Solid> solid = solid_of(edited, shell);
  if (!solid) return 0;
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(*solid);
  const bool has_all = std::ranges::all_of(facets.state, [](tessellate::FacetState state) {
    return state == tessellate::FacetState::triangulated;
  });
  if (!has_all) return 0;
  const double volume = geometry::measure(facets.divided_solid(*solid), facets.triangles).volume;
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

bool is_closed(const std::vector<EditedFacet>& facets) {
  bool is_closed = true;
  for_each_edge(passes_of(facets), [&](std::span<const Pass> passes) {
    const bool has_partner = passes.size() == 2 && passes[0].is_forward != passes[1].is_forward;
    is_closed = is_closed && has_partner;
  });
  return is_closed;
}

}  // namespace

std::optional<int> projection_axis(const EditedSolid& edited, const EditedFacet& facet) {
  const Result<FacetAlone> own = alone(edited, facet);
  if (!own) return std::nullopt;
  const tessellate::Projection projection = tessellate::facet_projection(own->solid, 0);
  if (projection.is_degenerate) return std::nullopt;
  return projection.axis;
}

int turn_of(const EditedSolid& edited, const Ring& ring, int axis) {
  if (ring.size() < 3) return 0;
  const auto u = (axis + 1) % 3;
  const auto v = (axis + 2) % 3;
  const auto smallest = std::ranges::min_element(ring, [&](Index a, Index b) {
    const Point& p = edited.vertices[a];
    const Point& q = edited.vertices[b];
    return std::pair(p[u], p[v]) < std::pair(q[u], q[v]);
  });
  const auto place = static_cast<std::size_t>(smallest - ring.begin());
  return geometry::orient2d(edited.vertices[ring[(place + ring.size() - 1) % ring.size()]],
                            edited.vertices[ring[place]],
                            edited.vertices[ring[(place + 1) % ring.size()]], axis);
}

std::size_t orient(EditedSolid& solid) {
  std::size_t turned = 0;
  for (std::size_t shell = 0; shell < solid.shells.size(); ++shell) {
    std::vector<EditedFacet>& facets = solid.shells[shell];
    turned += turn_interior_rings(solid, facets) + agree(facets);
    if (!is_closed(facets)) continue;
    const int wanted = shell == 0 ? 1 : -1;
    if (sign_of_volume(solid, facets) != -wanted) continue;
    for (EditedFacet& facet : facets) turn_over(facet);
    turned += facets.size();
  }
  return turned;
}

}  // namespace watertight::repair
