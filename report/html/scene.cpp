// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/crs/crs.h"
#include "geometry/divided_rings.h"
#include "validate/finding_kinds.h"

namespace watertight::report {
namespace {

constexpr double kRadius = 1000;  // the radius of a scene

/// Solids with more corners than this get no lines for open edges: a sort of all edges finds them.
constexpr std::size_t kMostCornersForEdges = 1'000'000;

/// Converts to metres around a point of the document, so that far coordinates and degrees look
/// alike.
class LocalMetres {
 public:
  LocalMetres(const Solid& solid, const Triple& centre)
      : centre_(centre), metres_(geometry::axis_units(solid.srid(), centre).metres_per_unit) {}
  Triple operator()(const Triple& world) const {
    Triple local{};
    for (std::size_t i = 0; i < 3; ++i) local[i] = (world[i] - centre_[i]) * metres_[i];
    return local;
  }
  Triple operator()(const Solid& solid, Index vertex) const { return (*this)(solid.world(vertex)); }

 private:
  Triple centre_;
  Triple metres_;
};

struct Candidate {
  const Solid* solid = nullptr;
  Index facet = kNone;
  Role role = Role::other_facet;
  double distance = 0;  // squared, from the centre to the facet's box
  double size = 0;      // squared diagonal of the facet's box
};

double squared_diagonal(const Triple& low, const Triple& high) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (high[i] - low[i]) * (high[i] - low[i]);
  return sum;
}

double squared_distance_to_box(const Triple& low, const Triple& high) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = low[i] > 0 ? low[i] : high[i] < 0 ? -high[i] : 0;
    sum += d * d;
  }
  return sum;
}

/// Approximate positions of all vertices, which cost less than those of Solid::world().
std::vector<Triple> positions_of(const Solid& solid, const LocalMetres& metres) {
  std::vector<Triple> positions;
  positions.reserve(solid.vertex_count());
  Triple origin{};
  Triple scale{};
  for (int axis = 0; axis < 3; ++axis) {
    origin[static_cast<std::size_t>(axis)] = solid.lattice().world(0, axis);
    scale[static_cast<std::size_t>(axis)] = solid.lattice().scale(axis);
  }
  for (const Point& p : solid.vertices()) {
    positions.push_back(metres(
        {origin[0] + scale[0] * p.x, origin[1] + scale[1] * p.y, origin[2] + scale[2] * p.z}));
  }
  return positions;
}

void add_candidates(const Solid& solid, const LocalMetres& metres, Role role_of_all,
                    std::vector<Candidate>& candidates) {
  const std::vector<Triple> positions = positions_of(solid, metres);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    const IndexRange rings = solid.rings_of(facet);
    if (rings.size() == 0) continue;
    Triple low{kFar, kFar, kFar};
    Triple high{-kFar, -kFar, -kFar};
    for (const Index vertex : solid.ring(rings.begin)) {
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], positions[vertex][i]);
        high[i] = std::max(high[i], positions[vertex][i]);
      }
    }
    if (low[0] > high[0]) continue;
    candidates.push_back({&solid, facet, role_of_all, squared_distance_to_box(low, high),
                          squared_diagonal(low, high)});
  }
}

/// The order of facets: those concerned first, then by distance; ties in order of the document.
bool is_nearer(const Candidate& a, const Candidate& b) {
  const bool a_first = a.role != Role::other_facet;
  const bool b_first = b.role != Role::other_facet;
  if (a_first != b_first) return a_first;
  if (a.distance != b.distance) return a.distance < b.distance;
  return a.facet < b.facet;
}

/// The number of sorted candidates to show: all that fit; of a large solid those within a few times
/// the size of the facets concerned, so that the facets concerned can be seen.
std::size_t count_shown(const std::vector<Candidate>& sorted, std::size_t total,
                        std::size_t concerned) {
  constexpr std::size_t kFewest = 24;
  constexpr double kReach = 2;
  if (sorted.size() == total || concerned == 0 || concerned >= sorted.size()) return sorted.size();
  double size = 0;
  for (std::size_t i = 0; i < concerned; ++i) size = std::max(size, sorted[i].size);
  std::size_t shown = std::min(std::max(kFewest, concerned), sorted.size());
  while (shown < sorted.size() && sorted[shown].distance <= kReach * kReach * size) ++shown;
  return shown;
}

std::vector<Triple> ring_points(const Solid& solid, Index ring, const LocalMetres& metres,
                                std::size_t most) {
  const std::span<const Index> vertices = solid.ring(ring);
  const std::size_t stride = vertices.size() / std::max<std::size_t>(most, 3) + 1;
  std::vector<Triple> points;
  for (std::size_t i = 0; i < vertices.size(); i += stride) {
    points.push_back(metres(solid, vertices[i]));
  }
  return points;
}

std::size_t corner_count(const SceneFacet& facet) {
  std::size_t corners = 0;
  for (const auto& ring : facet.rings) corners += ring.size();
  return corners;
}

SceneFacet facet_of(const Candidate& candidate, const LocalMetres& metres,
                    std::size_t most_corners) {
  SceneFacet facet;
  facet.role = candidate.role;
  const IndexRange rings = candidate.solid->rings_of(candidate.facet);
  std::size_t corners = 0;
  for (Index ring = rings.begin; ring < rings.end && corners < most_corners; ++ring) {
    std::vector<Triple> points =
        ring_points(*candidate.solid, ring, metres, most_corners - corners);
    if (points.empty()) continue;
    corners += points.size();
    facet.rings.push_back(std::move(points));
  }
  return facet;
}

/// Adds lines for the edges that are not used exactly twice, for findings about such edges. An edge
/// that a vertex of another ring of its facet splits counts as its parts.
void add_bad_edges(const Solid& solid, const LocalMetres& metres, std::size_t most, Scene& scene) {
  if (solid.arrays().ring_vertices.size() > kMostCornersForEdges) return;
  const Solid merged = geometry::merge_equal_vertices(solid).solid;
  const Solid divided = geometry::divide_rings(merged, geometry::ring_touches(merged)).solid;
  std::vector<std::array<Index, 2>> edges;
  for (Index ring = 0; ring < divided.ring_count(); ++ring) {
    const std::span<const Index> vertices = divided.ring(ring);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Index a = vertices[i];
      const Index b = vertices[(i + 1) % vertices.size()];
      if (a != b) edges.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size() && scene.lines.size() < most;) {
    const auto end =
        std::upper_bound(edges.begin() + static_cast<std::ptrdiff_t>(i), edges.end(), edges[i]);
    const auto next = static_cast<std::size_t>(end - edges.begin());
    if (next - i != 2) {
      scene.lines.push_back({metres(divided, edges[i][0]), metres(divided, edges[i][1])});
    }
    i = next;
  }
}

void add_ring_line(const Solid* solid, const Place& place, const LocalMetres& metres,
                   std::size_t most, Scene& scene) {
  if (solid == nullptr || place.facet >= solid->facet_count()) return;
  const IndexRange rings = solid->rings_of(place.facet);
  if (place.ring >= rings.size()) return;
  std::vector<Triple> line = ring_points(*solid, rings.begin + place.ring, metres, most);
  if (line.empty()) return;
  line.push_back(line.front());
  scene.lines.push_back(std::move(line));
}

/// The middle of a solid's box, where a finding without a place of its own is shown.
Triple middle_of(const Solid& solid) {
  const Box box = solid.box();
  Triple middle{};
  for (int axis = 0; axis < 3; ++axis) {
    const double half = box.min[axis] + (box.max[axis] - box.min[axis]) / 2;
    middle[static_cast<std::size_t>(axis)] = solid.lattice().world(half, axis);
  }
  return middle;
}

template <class Function>
void for_each_point(Scene& scene, Function function) {
  for (SceneFacet& facet : scene.facets) {
    for (auto& ring : facet.rings) std::for_each(ring.begin(), ring.end(), function);
  }
  for (auto& line : scene.lines) std::for_each(line.begin(), line.end(), function);
  if (scene.witness) function(*scene.witness);
}

/// Scales the scene into a ball of kRadius around the middle of its facets; false if they have no
/// extent. When farther facets are left out, the ball is that of `reach` metres and large facets
/// stick out of it.
bool fit(Scene& scene, double reach) {
  Triple low;
  Triple high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const SceneFacet& facet : scene.facets) {
    for (const auto& ring : facet.rings) {
      for (const Triple& p : ring) {
        for (std::size_t i = 0; i < 3; ++i) {
          const bool is_cut = scene.hidden_facets > 0;
          low[i] = std::min(low[i], is_cut ? std::max(p[i], -reach) : p[i]);
          high[i] = std::max(high[i], is_cut ? std::min(p[i], reach) : p[i]);
        }
      }
    }
  }
  Triple middle{};
  double diagonal = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = low[i] + (high[i] - low[i]) / 2;
    diagonal += (high[i] - low[i]) * (high[i] - low[i]);
  }
  const double radius = std::sqrt(diagonal) / 2;
  if (!std::isfinite(radius) || !(radius > 0)) return false;
  constexpr double kFarthest = 100 * kRadius;
  for_each_point(scene, [&](Triple& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = std::clamp(std::round((p[i] - middle[i]) / radius * kRadius), -kFarthest, kFarthest);
      if (p[i] == 0) p[i] = 0;  // no -0
    }
  });
  return true;
}

Role role_in(const PlacedFinding& placed, const pipeline::InspectedFeature& feature,
             const Candidate& candidate) {
  const Finding& finding = *placed.finding;
  const bool is_here = submitted_solid(feature, placed.solid) == candidate.solid;
  if (is_here && finding.place.facet == candidate.facet) return Role::first;
  const bool is_there =
      finding.other && submitted_solid(feature, placed.other_solid) == candidate.solid;
  if (is_there && finding.other->facet == candidate.facet) return Role::second;
  return candidate.role;
}

}  // namespace

std::optional<Scene> scene_of(const pipeline::InspectedFeature& feature,
                              const PlacedFinding& placed, const PictureOptions& options) {
  const Solid* here = submitted_solid(feature, placed.solid);
  const Solid* there = submitted_solid(feature, placed.other_solid);
  if (here == nullptr || here->facet_count() == 0) return std::nullopt;
  const auto point = point_of(feature, placed);
  const LocalMetres metres(*here, point ? *point : middle_of(*here));
  const bool is_pair_of_solids = there != nullptr && there != here;
  std::vector<Candidate> candidates;
  add_candidates(*here, metres, Role::other_facet, candidates);
  if (is_pair_of_solids) add_candidates(*there, metres, Role::other_facet, candidates);
  for (Candidate& candidate : candidates) {
    const bool is_of_second = is_pair_of_solids && candidate.solid == there;
    if (is_pair_of_solids) candidate.role = is_of_second ? Role::second : Role::first;
    candidate.role = role_in(placed, feature, candidate);
  }
  const std::size_t total = candidates.size();
  const auto concerned = static_cast<std::size_t>(
      std::count_if(candidates.begin(), candidates.end(),
                    [](const Candidate& c) { return c.role != Role::other_facet; }));
  const std::size_t most = std::min(total, options.most_facets);
  std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(most),
                    candidates.end(), is_nearer);
  candidates.resize(most);
  const std::size_t shown = count_shown(candidates, total, concerned);
  Scene scene;
  scene.hidden_facets = total - shown;
  std::size_t corners = 0;
  for (std::size_t i = 0; i < shown && corners < options.most_corners; ++i) {
    scene.facets.push_back(facet_of(candidates[i], metres, options.most_corners - corners));
    corners += corner_count(scene.facets.back());
  }
  const int code = placed.finding->code;
  if (code == validate::kShellNotClosed || code == validate::kNonManifold) {
    add_bad_edges(*here, metres, options.most_facets, scene);
  }
  const bool is_about_rings =
      code < validate::kNonPlanarDistance || validate::finding_level(code) == 2;
  const bool is_about_planes =
      code == validate::kNonPlanarDistance || code == validate::kNonPlanarNormals;
  if (is_about_rings && !is_about_planes) {
    add_ring_line(here, placed.finding->place, metres, options.most_corners, scene);
    if (placed.finding->other) {
      add_ring_line(there, *placed.finding->other, metres, options.most_corners, scene);
    }
  }
  if (point) scene.witness = metres(*point);
  const double reach = shown == 0 ? 0 : std::sqrt(candidates[shown - 1].distance);
  if (!fit(scene, reach)) return std::nullopt;
  return scene;
}

std::optional<Picture> picture_of(const pipeline::InspectedFeature& feature,
                                  const PlacedFinding& placed, const PictureOptions& options) {
  const auto scene = scene_of(feature, placed, options);
  if (!scene) return std::nullopt;
  const View view = best_view(*scene);
  return Picture{svg_of(*scene, view), json_of(*scene, view)};
}

}  // namespace watertight::report
