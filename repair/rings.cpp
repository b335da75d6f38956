// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <utility>

#include "geometry/predicates/predicates.h"
#include "repair/border_loops.h"
#include "repair/remedies.h"
#include "repair/turn.h"
#include "tessellate/facets.h"
#include "validate/edge_table.h"
#include "validate/rules/open_edges.h"

namespace watertight::repair {
namespace {

/// Drops repeated points and spikes. Answers with the number of points that went.
std::size_t clean(Ring& ring) {
  Ring kept;
  for (const Index vertex : ring) {
    if (!kept.empty() && kept.back() == vertex) continue;
    if (kept.size() > 1 && kept[kept.size() - 2] == vertex) {
      kept.pop_back();
    } else {
      kept.push_back(vertex);
    }
  }
  // Where the ring closes.
  std::size_t begin = 0;
  while (kept.size() - begin > 1) {
    const std::size_t size = kept.size() - begin;
    const bool is_spike_at_end = size > 2 && kept[kept.size() - 2] == kept[begin];
    if (kept.back() == kept[begin] || is_spike_at_end) {
      kept.pop_back();
    } else if (size > 2 && kept.back() == kept[begin + 1]) {
      ++begin;
    } else {
      break;
    }
  }
  kept.erase(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(begin));
  const std::size_t dropped = ring.size() - kept.size();
  ring = std::move(kept);
  return dropped;
}

bool is_on_line(const EditedSolid& solid, const Ring& ring) {
  for (std::size_t i = 2; i < ring.size(); ++i) {
    if (!geometry::are_collinear(solid.vertices[ring[0]], solid.vertices[ring[1]],
                                 solid.vertices[ring[i]])) {
      return false;
    }
  }
  return true;
}

/// Drops facets whose doubled area vector is zero. Answers with their number.
std::size_t drop_without_area(const EditedSolid& edited, std::vector<EditedFacet>& facets) {
  const Result<Solid> solid = solid_of(edited, facets);
  if (!solid) return 0;
  Index number = 0;
  return std::erase_if(facets, [&](const EditedFacet&) {
    return tessellate::facet_projection(*solid, number++).is_degenerate;
  });
}

/// The ring from its smallest vertex on.
Ring from_smallest(Ring ring) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  return ring;
}

/// Rings that are equal for equal facets, whatever vertex they begin with.
std::vector<Ring> key_of(const EditedFacet& facet) {
  std::vector<Ring> key;
  for (const Ring& ring : facet.rings) key.push_back(from_smallest(ring));
  std::sort(key.begin() + 1, key.end());
  return key;
}

std::vector<Ring> key_from_behind(EditedFacet facet) {
  turn_over(facet);
  return key_of(facet);
}

/// Of equal facets one stays, and of two that face each other none.
std::size_t drop_duplicates(std::vector<EditedFacet>& facets) {
  std::map<std::vector<Ring>, std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < facets.size(); ++i) places[key_of(facets[i])].push_back(i);
  std::vector<bool> is_dropped(facets.size());
  for (const auto& [key, same] : places) {
    const auto opposite = places.find(key_from_behind(facets[same.front()]));
    const std::size_t others = opposite == places.end() ? 0 : opposite->second.size();
    const std::size_t kept = same.size() > others ? 1 : 0;
    for (std::size_t i = kept; i < same.size(); ++i) is_dropped[same[i]] = true;
  }
  std::size_t place = 0;
  const std::size_t before = facets.size();
  std::erase_if(facets, [&](const EditedFacet&) { return is_dropped[place++]; });
  return before - facets.size();
}

/// Divides facets of one ring that passes a vertex twice, where all parts turn alike.
std::size_t divide_rings(const EditedSolid& solid, std::vector<EditedFacet>& facets) {
  std::vector<EditedFacet> result;
  std::size_t divided = 0;
  for (EditedFacet& facet : facets) {
    std::vector<Ring> parts;
    if (facet.rings.size() == 1) parts = simple_loops_of(facet.rings[0]);
    const auto axis = parts.size() > 1 ? projection_axis(solid, facet) : std::nullopt;
    const int turn = axis ? turn_of(solid, parts[0], *axis) : 0;
    const bool is_alike = turn != 0 && std::ranges::all_of(parts, [&](const Ring& part) {
                            return part.size() > 2 && turn_of(solid, part, *axis) == turn;
                          });
    if (!is_alike) {
      result.push_back(std::move(facet));
      continue;
    }
    ++divided;
    for (Ring& part : parts) result.push_back({{std::move(part)}, facet.source});
  }
  facets = std::move(result);
  return divided;
}

}  // namespace

std::size_t mend_rings(EditedSolid& solid) {
  std::size_t changes = 0;
  for (std::vector<EditedFacet>& facets : solid.shells) {
    for (EditedFacet& facet : facets) {
      for (Ring& ring : facet.rings) changes += clean(ring);
      const auto is_first = [&](const Ring& ring) { return &ring == &facet.rings.front(); };
      changes += std::erase_if(facet.rings, [&](const Ring& ring) {
        return !is_first(ring) && is_on_line(solid, ring);
      });
    }
    changes += std::erase_if(facets, [&](const EditedFacet& facet) { return facet.rings.empty(); });
    changes += divide_rings(solid, facets);
    changes += drop_without_area(solid, facets);
    changes += drop_duplicates(facets);
  }
  std::erase_if(solid.shells, [](const auto& facets) { return facets.empty(); });
  return changes;
}

std::size_t insert_junctions(EditedSolid& edited) {
  std::size_t inserted = 0;
  for (std::vector<EditedFacet>& facets : edited.shells) {
    const Result<Solid> solid = solid_of(edited, facets);
    if (!solid) continue;
    validate::EdgeTable table(*solid);
    table.examine(0);
    std::vector<validate::EdgeUse> open;
    const auto uses = table.uses();
    for (std::size_t i = 0; i < uses.size(); ++i) {
      const bool is_shared = (i > 0 && uses[i - 1].has_edge_of(uses[i])) ||
                             (i + 1 < uses.size() && uses[i + 1].has_edge_of(uses[i]));
      if (!is_shared) open.push_back(uses[i]);
    }
    auto junctions = validate::examine_open_edges(*solid, open, [] { return false; }).junctions;
    // The last place of a ring first, so that the places before it stay. Along an edge the vertices
    // are listed from its smaller vertex on; a ring that runs the other way has them in that order
    // when each is put behind the corner.
    std::stable_sort(junctions.begin(), junctions.end(),
                     [](const auto& a, const auto& b) { return a.edge.corner > b.edge.corner; });
    for (std::size_t i = 0; i < junctions.size();) {
      std::size_t end = i;
      std::vector<Index> inside;
      while (end < junctions.size() && junctions[end].edge.corner == junctions[i].edge.corner) {
        inside.push_back(junctions[end++].vertex);
      }
      const validate::EdgeUse& edge = junctions[i].edge;
      const auto place = validate::place_of_corner(*solid, edge.facet, edge.corner);
      Ring& ring = facets[edge.facet].rings[place.ring_in_facet];
      if (ring[place.position] != edge.low) std::reverse(inside.begin(), inside.end());
      inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
      ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(place.position) + 1, inside.begin(),
                  inside.end());
      inserted += inside.size();
      i = end;
    }
  }
  return inserted;
}

std::size_t triangulate(EditedSolid& solid, std::span<const Index> facets) {
  if (facets.empty()) return 0;
  const Result<Solid> whole = solid_of(solid);
  if (!whole) return 0;
  const tessellate::FacetTriangles triangles = tessellate::triangulate_facets(*whole);
  std::vector<bool> is_chosen(whole->facet_count());
  for (const Index facet : facets) is_chosen[facet] = true;
  std::size_t replaced = 0;
  Index number = 0;
  for (std::vector<EditedFacet>& list : solid.shells) {
    std::vector<EditedFacet> result;
    for (EditedFacet& facet : list) {
      const Index here = number++;
      const bool has_triangles = triangles.state[here] == tessellate::FacetState::triangulated;
      if (!is_chosen[here] || !has_triangles ||
          triangles.first[here + 1] - triangles.first[here] == 1) {
        result.push_back(std::move(facet));
        continue;
      }
      ++replaced;
      for (Index i = triangles.first[here]; i < triangles.first[here + 1]; ++i) {
        const Triangle& triangle = triangles.triangles[i];
        result.push_back({{Ring(triangle.begin(), triangle.end())}, facet.source});
      }
    }
    list = std::move(result);
  }
  return replaced;
}

}  // namespace watertight::repair
