// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/smooth/smooth_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "geometry/vector3.h"
#include "repair/smooth/flatten.h"
#include "repair/smooth/sample_surface.h"
#include "spline/dms_surface.h"
#include "spline/extend_triangulation.h"
#include "spline/fit_surface.h"
#include "spline/knot_clouds.h"
#include "spline/spline_json.h"
#include "spline/thin_plate.h"

namespace watertight::repair {
namespace {

using geometry::operator-;
using geometry::Vector3;

/// How stiff the surface through the collar's vertices is, in squares of the mean edge: small, so
/// that it comes near the vertices, and above 0, so that they determine it.
constexpr double kStiffness = 1e-4;

/// Where no chord is asked for, it is this share of the mean edge of the border.
constexpr double kChordShare = 0.05;

Refused not_flattenable(const Error& error) {
  return {SmoothRefusal::not_flattenable, error.message};
}

/// Collar and hole in the plane: vertices of the collar, the border first, then new ones.
struct PatchDomain {
  std::vector<Point> places;
  std::vector<Triangle> triangles;  // of the collar, then of the hole
  std::size_t collar_triangles = 0;
};

Result<PatchDomain> domain_with(double density, const Collar& collar, const Flattened& flat,
                                const SmoothOptions& options) {
  std::vector<std::vector<Point>> polygons;
  std::size_t border = 0;
  for (const Ring& loop : collar.loops) {
    auto& polygon = polygons.emplace_back();
    for (const Index vertex : loop) polygon.push_back(flat.places[vertex]);
    border += loop.size();
  }
  spline::ExtendOptions extending;
  extending.density = density;
  extending.regularity = options.regularity;
  extending.smoothing_rounds = 2;
  extending.most_vertices = options.most_triangles;
  const auto hole = spline::extend_triangulation(polygons, extending);
  if (!hole) return hole.error();
  PatchDomain domain{flat.places, collar.triangles, collar.triangles.size()};
  domain.places.insert(domain.places.end(),
                       hole->vertices.begin() + static_cast<std::ptrdiff_t>(border),
                       hole->vertices.end());
  const auto shift = static_cast<Index>(flat.places.size() - border);
  for (Triangle t : hole->triangles) {
    for (Index& corner : t) corner += corner < border ? 0 : shift;
    domain.triangles.push_back(t);
  }
  if (domain.triangles.size() <= options.most_triangles) return domain;
  return Error{ErrorCode::limit_exceeded,
               "the domain has more than " + std::to_string(options.most_triangles) + " triangles"};
}

/// The domain with the density that was asked for, or with a coarser one where it is too large.
Result<PatchDomain> domain_of(const Collar& collar, const Flattened& flat,
                              const SmoothOptions& options) {
  double density = options.density;
  for (;;) {
    auto domain = domain_with(density, collar, flat, options);
    if (domain || domain.error().code != ErrorCode::limit_exceeded) return domain;
    density *= 2;
    if (density > kMostDensity) return domain;
  }
}

/// Knots keep this share of the shortest edge from their vertex; thin triangles of the hole, which
/// the knots of the collar do not know, need less.
constexpr std::array kKnotShares{0.12, 0.03, 0.0075};

/// The domain with knots: those of the collar first, so that they lie beyond its border.
Result<spline::DmsDomain> with_knots(PatchDomain& domain, const Collar& collar, double knot_share) {
  spline::CloudOptions clouding;
  clouding.radius = knot_share;
  const auto old = spline::make_clouds(std::span(domain.places).first(collar.vertices.size()),
                                       collar.triangles, {}, {}, clouding);
  if (!old) return old.error();
  auto places = spline::move_off_lines(domain.places, domain.triangles, *old, clouding);
  if (!places) return std::move(places).error();
  domain.places = *std::move(places);
  auto clouds = spline::make_clouds(domain.places, domain.triangles, *old, {}, clouding);
  if (!clouds) return std::move(clouds).error();
  return spline::DmsDomain::make({2, domain.places, *std::move(clouds), domain.triangles});
}

double mean_squared_edge(const PatchDomain& domain) {
  double sum = 0;
  for (std::size_t i = 0; i < domain.collar_triangles; ++i) {
    const Triangle& t = domain.triangles[i];
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector3 edge = geometry::difference(domain.places[t[(j + 1) % 3]], domain.places[t[j]]);
      sum += geometry::dot(edge, edge);
    }
  }
  return sum / (3 * static_cast<double>(domain.collar_triangles));
}

/// The coefficients of the surface that comes near the collar's vertices and bends the least.
Result<spline::FittedSurface> through_collar(const spline::DmsDomain& domain,
                                             const PatchDomain& patch,
                                             std::span<const Vector3> metres) {
  std::vector<bool> is_taken(metres.size(), false);
  std::vector<spline::FitPoint> points;
  for (Index t = 0; t < patch.collar_triangles; ++t) {
    for (const Index vertex : patch.triangles[t]) {
      if (is_taken[vertex]) continue;
      is_taken[vertex] = true;
      const auto& [x, y, z] = metres[vertex];
      points.push_back({t, patch.places[vertex], {x, y, z}});
    }
  }
  return spline::fit_surface(domain, points, kStiffness * mean_squared_edge(patch));
}

/// The surface in world coordinates as JSON.
std::string world_json(const EditedSolid& solid, const Vector3& units,
                       const spline::DmsSurface& surface) {
  const std::array<double, 3> origin = solid.lattice.world(solid.vertices.front());
  std::vector<Point> coefficients;
  for (const Point& c : surface.coefficients()) {
    coefficients.push_back(
        {origin[0] + c.x / units[0], origin[1] + c.y / units[1], origin[2] + c.z / units[2]});
  }
  const auto world = spline::DmsSurface::make(surface.domain(), std::move(coefficients));
  return world ? spline::to_json(*world) : std::string();
}

std::vector<Triangle> local_triangles(const Collar& collar, std::span<const Triangle> closing) {
  std::map<Index, Index> number_of;
  for (Index i = 0; i < collar.vertices.size(); ++i) number_of.emplace(collar.vertices[i], i);
  std::vector<Triangle> local;
  for (const auto& [a, b, c] : closing)
    local.push_back({number_of.at(a), number_of.at(b), number_of.at(c)});
  return local;
}

double mean_border_edge(const Collar& collar, std::span<const Vector3> metres) {
  double sum = 0;
  std::size_t edges = 0;
  for (const Ring& loop : collar.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      sum += geometry::length(metres[loop[(i + 1) % loop.size()]] - metres[loop[i]]);
    edges += loop.size();
  }
  return sum / static_cast<double>(edges);
}

/// The angles across edges of the border.
void measure_turns(const EditedSolid& solid, const ShellSurface& surface, const HoleLoops& loops,
                   SmoothPatch& patch) {
  std::map<std::pair<Index, Index>, Vector3> third_of;
  const auto place_of = [&](Index corner) {
    return corner < patch.border.size() ? metres_of(solid, patch.border[corner], surface.units())
                                        : patch.new_vertices[corner - patch.border.size()];
  };
  for (const Triangle& t : patch.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (t[i] < patch.border.size() && t[(i + 1) % 3] < patch.border.size())
        third_of[{patch.border[t[i]], patch.border[t[(i + 1) % 3]]}] = place_of(t[(i + 2) % 3]);
    }
  }
  double sum = 0;
  std::size_t edges = 0;
  for (const Ring& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Index from = loop[i];
      const Index to = loop[(i + 1) % loop.size()];
      const Index behind = surface.third(to, from);
      const auto ahead = third_of.find({from, to});
      if (behind == kNone || ahead == third_of.end()) continue;
      const double cosine = cosine_at_edge(metres_of(solid, from, surface.units()),
                                           metres_of(solid, to, surface.units()), ahead->second,
                                           metres_of(solid, behind, surface.units()));
      const double turn = std::acos(cosine) * 180 / std::numbers::pi;
      patch.measures.largest_turn = std::max(patch.measures.largest_turn, turn);
      sum += turn;
      ++edges;
    }
  }
  patch.measures.mean_turn = edges > 0 ? sum / static_cast<double>(edges) : 0;
}

/// A sharp edge is the cause of a collar that does not lie in the plane.
Refused with_cause(Refused refused, const Collar& collar) {
  if (refused.refusal != SmoothRefusal::not_flattenable || collar.sharp_vertex == kNone)
    return refused;
  return {SmoothRefusal::too_sharp, "an edge that turns more than 100 degrees ends at vertex " +
                                        std::to_string(collar.sharp_vertex) + " of the border"};
}

using PatchOrRefusal = std::variant<SmoothPatch, Refused>;

/// A collar in the plane with its hole, and the functions over both.
struct FlatHole {
  PatchDomain patch;
  spline::DmsDomain domain;
  double stretch = 1;
};

/// The first of the maps into the plane that gives a domain.
std::variant<FlatHole, Refused> flat_hole(const Collar& collar, std::span<const Flattened> maps,
                                          const SmoothOptions& options) {
  Refused refused{SmoothRefusal::not_flattenable,
                  "a triangle of the collar turns over in the plane"};
  for (const Flattened& flat : maps) {
    auto patch = domain_of(collar, flat, options);
    if (!patch && patch.error().code == ErrorCode::limit_exceeded)
      return Refused{SmoothRefusal::too_large, patch.error().message};
    if (!patch) {
      refused = not_flattenable(patch.error());
      continue;
    }
    for (const double knot_share : kKnotShares) {
      auto domain = with_knots(*patch, collar, knot_share);
      if (domain) return FlatHole{*std::move(patch), *std::move(domain), flat.stretch};
      refused = not_flattenable(domain.error());
    }
  }
  return refused;
}

/// The numbers of the hole's triangles.
std::vector<Index> hole_triangles(const PatchDomain& patch) {
  std::vector<Index> hole(patch.triangles.size() - patch.collar_triangles);
  std::iota(hole.begin(), hole.end(), static_cast<Index>(patch.collar_triangles));
  return hole;
}

PatchOrRefusal patch_with_collar(const EditedSolid& solid, const ShellSurface& surface,
                                 const HoleLoops& loops, std::span<const Triangle> closing,
                                 const SmoothOptions& options) {
  const auto made = collar_of(solid, surface, loops, options.collar);
  if (const auto* refused = std::get_if<Refused>(&made)) return *refused;
  const auto& collar = std::get<Collar>(made);
  std::vector<Vector3> metres;
  for (const Index vertex : collar.vertices)
    metres.push_back(metres_of(solid, vertex, surface.units()));
  const auto laid =
      flat_hole(collar, flatten(collar, local_triangles(collar, closing), metres), options);
  if (const auto* refused = std::get_if<Refused>(&laid)) return with_cause(*refused, collar);
  const auto& [domain, functions, stretch] = std::get<FlatHole>(laid);
  auto fitted = through_collar(functions, domain, metres);
  if (!fitted) return not_flattenable(fitted.error());
  auto plate =
      spline::least_thin_plate(functions, hole_triangles(domain), std::move(fitted->coefficients));
  if (!plate) return not_flattenable(plate.error());
  const auto spline = spline::DmsSurface::make(functions, std::move(plate->coefficients));
  if (!spline) return not_flattenable(spline.error());

  SmoothPatch patch;
  for (const Ring& loop : loops) patch.border.insert(patch.border.end(), loop.begin(), loop.end());
  patch.measures.unknowns = plate->unknowns;
  patch.measures.energy = plate->energy;
  patch.measures.condition = plate->condition;
  patch.measures.stretch = stretch;
  const SampledHole sampled{*spline, std::span(metres).first(patch.border.size()), metres.size(),
                            domain.collar_triangles};
  const double chord = options.chord_metres > 0 ? options.chord_metres
                                                : kChordShare * mean_border_edge(collar, metres);
  if (auto refused = sample(sampled, chord, options.most_vertices, patch)) return *refused;
  measure_turns(solid, surface, loops, patch);
  if (options.keeps_surface) patch.spline = world_json(solid, surface.units(), *spline);
  return patch;
}

}  // namespace

PatchOrRefusal smooth_patch(const EditedSolid& solid, const ShellSurface& surface,
                            const HoleLoops& loops, std::span<const Triangle> closing,
                            const SmoothOptions& options) {
  SmoothOptions own = options;
  for (;;) {
    auto patch = patch_with_collar(solid, surface, loops, closing, own);
    const auto* refused = std::get_if<Refused>(&patch);
    const bool may_help =
        refused != nullptr && (refused->refusal == SmoothRefusal::not_flattenable ||
                               refused->refusal == SmoothRefusal::too_sharp);
    if (!may_help || --own.collar.rings < 1) return patch;
  }
}

}  // namespace watertight::repair
