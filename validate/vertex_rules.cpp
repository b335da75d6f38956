// SPDX-License-Identifier: GPL-3.0-or-later
//
// Warnings about vertices and very narrow facets (801, 802, 803, 805): nothing is wrong, something
// is likely not meant. Measured in metres.
#include <algorithm>
#include <cmath>

#include "validate/planarity.h"
#include "validate/rules.h"

namespace watertight {
namespace {

/// Closer vertices are worth a warning: the snap tolerance that val3dity takes by default.
constexpr double kNearMetres = 0.001;
/// Facets narrower than that are worth a warning: the same length, across the facet.
constexpr double kSliverMetres = 0.001;
/// Pairs of vertices measured; beyond it the closest pair is the closest of those.
constexpr std::uint64_t kMostPairs = 5'000'000;

double length(const Vector& v) { return std::sqrt(dot(v, v)); }

void check_near(ExaminedSolid& examined) {
  const Solid& solid = examined.solid();
  if (solid.vertex_count() < 2) return;
  std::vector<std::pair<double, Index>> order;  // metres along x
  for (Index v = 0; v < solid.vertex_count(); ++v) order.emplace_back(examined.metres(0, v)[0], v);
  std::sort(order.begin(), order.end());
  std::uint64_t looks = 0;
  std::uint64_t pairs = 0;
  double closest = kNearMetres;
  ShellPair who{kNone, kNone};
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      if (order[j].first - order[i].first >= kNearMetres || ++looks > kMostPairs) break;
      const double distance = length(examined.metres(order[i].second, order[j].second));
      if (distance >= kNearMetres) continue;
      ++pairs;
      if (distance >= closest) continue;
      closest = distance;
      who = std::minmax(order[i].second, order[j].second);
    }
  }
  if (who.first == kNone) return;
  Finding finding;
  finding.code = kNearDuplicateVertices;
  finding.place.vertex = examined.submitted_vertex(who.first);
  finding.other = Place{};
  finding.other->vertex = examined.submitted_vertex(who.second);
  finding.witness = examined.world(who.first);
  finding.measured = closest;
  finding.limit = kNearMetres;
  finding.unit = std::string(1, 'm');
  finding.detail = (looks > kMostPairs ? "at least " : "") + std::to_string(pairs) +
                   (pairs == 1 ? " pair" : " pairs") +
                   " of different vertices nearly coincide; these are the closest";
  examined.findings.add(std::move(finding));
}

void check_unused(ExaminedSolid& examined) {
  Index first = kNone;
  Index count = 0;
  for (Index vertex = 0; vertex < examined.submitted().vertex_count(); ++vertex) {
    if (examined.merged_of()[vertex] != kNone) continue;
    if (first == kNone) first = vertex;
    ++count;
  }
  if (count == 0) return;
  Finding finding;
  finding.code = kUnusedVertices;
  finding.place.vertex = first;
  finding.witness = examined.submitted().world(first);
  finding.measured = static_cast<double>(count);
  finding.limit = 0;
  finding.unit = "vertices";
  finding.detail = std::to_string(count) + (count == 1 ? " vertex is" : " vertices are") +
                   " used by no ring; this is the first";
  examined.findings.add(std::move(finding));
}

/// Width across the longest extent of a facet: its area divided by that extent, doubled (exact for
/// a triangle: its height).
void check_slivers(ExaminedSolid& examined) {
  const FacetTriangles& all = examined.triangles();
  for (Index facet = 0; facet < examined.solid().facet_count(); ++facet) {
    if (all.state[facet] != FacetState::triangulated) continue;
    double doubled_area = 0;
    double extent = 0;
    for (Index t = all.first[facet]; t < all.first[facet + 1]; ++t) {
      const Triangle& triangle = all.triangles[t];
      const Vector a = examined.metres(triangle[0], triangle[1]);
      const Vector b = examined.metres(triangle[0], triangle[2]);
      doubled_area += length(cross(a, b));
      extent = std::max(
          {extent, length(a), length(b), length(examined.metres(triangle[1], triangle[2]))});
    }
    if (!(extent > 0) || doubled_area >= kSliverMetres * extent || extent < kSliverMetres) continue;
    Finding finding;
    finding.code = kSliverFacet;
    finding.place = examined.at_facet(facet);
    finding.witness = examined.world(all.triangles[all.first[facet]][0]);
    finding.measured = doubled_area / extent;
    finding.limit = kSliverMetres;
    finding.unit = std::string(1, 'm');
    finding.detail = "the facet is very narrow for its length";
    examined.findings.add(std::move(finding));
  }
}

}  // namespace

void check_vertices(ExaminedSolid& examined) {
  check_near(examined);
  check_unused(examined);
  check_slivers(examined);
}

void check_rounded(ExaminedSolid& examined, std::span<const Index> rounded) {
  if (rounded.empty() || rounded[0] >= examined.submitted().vertex_count()) return;
  Finding finding;
  finding.code = kCoordinatesRounded;
  finding.place.vertex = rounded[0];
  finding.witness = examined.submitted().world(rounded[0]);
  finding.measured = static_cast<double>(rounded.size());
  finding.limit = 0;
  finding.unit = "vertices";
  finding.detail = "the digits of " + std::to_string(rounded.size()) +
                   (rounded.size() == 1 ? " vertex" : " vertices") +
                   " fit no grid and were rounded; this is the first";
  examined.findings.add(std::move(finding));
}

}  // namespace watertight
