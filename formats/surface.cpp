// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/surface.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace watertight::formats {
namespace {

Result<SubmittedSolid> submitted(SolidArrays arrays, const Lattice& lattice, SolidSource source,
                                 std::uint32_t srid, const Limits& limits) {
  auto solid = Solid::make(std::move(arrays), lattice, srid, limits);
  if (!solid) return std::move(solid).error();
  return SubmittedSolid{std::move(*solid), std::move(source), {}};
}

/// The number of the vertices of `all` that are not in `used`, and the first of them.
geometry::UnusedVertices unused_vertices(const std::vector<std::array<GridNumber, 3>>& all,
                                         const std::vector<Index>& used) {
  geometry::UnusedVertices unused{all.size() - used.size(), 0, {}};
  if (unused.count == 0) return unused;
  std::vector<bool> is_used(all.size(), false);
  for (const Index vertex : used) is_used[vertex] = true;
  const auto first = std::find(is_used.begin(), is_used.end(), false) - is_used.begin();
  unused.first = static_cast<std::uint64_t>(first);
  const auto point = geometry::lattice_of_decimals(std::span(&all[unused.first], 1));
  if (point) unused.place = point->lattice.world(point->points.front());
  return unused;
}

}  // namespace

bool is_surface(const SolidSource& source) {
  constexpr std::array<std::string_view, 9> kTypes{"MultiSurface",
                                                   "CompositeSurface",
                                                   "Surface",
                                                   "PolyhedralSurface",
                                                   "Polygon",
                                                   "Tin",
                                                   "Shell",
                                                   "TriangulatedSurface",
                                                   "OrientableSurface"};
  return std::find(kTypes.begin(), kTypes.end(), source.geometry_type) != kTypes.end();
}

std::vector<Index> number_by_first_use(SolidArrays& arrays, std::vector<Index>& number_of) {
  std::vector<Index> vertex_of;
  for (Index& vertex : arrays.ring_vertices) {
    if (number_of[vertex] == kNone) {
      number_of[vertex] = static_cast<Index>(vertex_of.size());
      vertex_of.push_back(vertex);
    }
    vertex = number_of[vertex];
  }
  for (const Index vertex : vertex_of) number_of[vertex] = kNone;
  return vertex_of;
}

Result<SubmittedSolid> indexed_solid(SolidArrays arrays, DecimalVertices& vertices,
                                     SolidSource source, const Limits& limits) {
  vertices.number_of.resize(vertices.positions.size(), kNone);
  const std::vector<Index> used = number_by_first_use(arrays, vertices.number_of);
  std::vector<std::array<GridNumber, 3>> positions;
  positions.reserve(used.size());
  for (const Index vertex : used) positions.push_back(vertices.positions[vertex]);
  auto points = geometry::lattice_of_decimals(positions);
  if (!points) return std::move(points).error();

  std::vector<bool> is_rounded(used.size(), false);
  for (const Index vertex : points->rounded) is_rounded[vertex] = true;
  arrays.vertices = std::move(points->points);
  auto solid = submitted(std::move(arrays), points->lattice, std::move(source), 0, limits);
  if (!solid) return solid;
  for (Index i = 0; i < used.size(); ++i) {
    if (is_rounded[i] || vertices.is_rounded[used[i]]) solid->rounded.push_back(i);
  }
  solid->unused = unused_vertices(vertices.positions, used);
  return solid;
}

Result<Document> one_shell_document(Document document, std::string geometry_type,
                                    SolidArrays arrays, DecimalVertices& vertices,
                                    const Limits& limits) {
  if (arrays.facet_offsets.size() == 1) document.notes.push_back("the file has no faces");
  arrays.end_shell();
  auto solid = indexed_solid(std::move(arrays), vertices,
                             SolidSource{"", std::move(geometry_type), "", 0, 0, ""}, limits);
  if (!solid) return std::move(solid).error();
  document.features.emplace_back();
  document.features.back().solids.push_back(std::move(*solid));
  return document;
}

Result<SubmittedSolid> solid_of_points(SolidArrays arrays, const geometry::LatticePoints& points,
                                       SolidSource source, std::uint32_t srid,
                                       const Limits& limits) {
  std::vector<Index> by_point(points.points.size());
  std::iota(by_point.begin(), by_point.end(), Index{0});
  std::sort(by_point.begin(), by_point.end(), [&](Index a, Index b) {
    const auto order = points.points[a] <=> points.points[b];
    return order != 0 ? order < 0 : a < b;
  });
  std::vector<Index> first(points.points.size());
  for (std::size_t i = 0; i < by_point.size(); ++i) {
    const bool is_same =
        i > 0 && (points.points[by_point[i]] <=> points.points[by_point[i - 1]]) == 0;
    first[by_point[i]] = is_same ? first[by_point[i - 1]] : by_point[i];
  }
  for (Index& vertex : arrays.ring_vertices) vertex = first[vertex];
  std::vector<Index> number_of(points.points.size(), kNone);
  const std::vector<Index> used = number_by_first_use(arrays, number_of);

  std::vector<bool> is_rounded(points.points.size(), false);
  for (const Index vertex : points.rounded) is_rounded[first[vertex]] = true;
  arrays.vertices.reserve(used.size());
  for (const Index vertex : used) arrays.vertices.push_back(points.points[vertex]);
  auto solid = submitted(std::move(arrays), points.lattice, std::move(source), srid, limits);
  if (!solid) return solid;
  for (Index i = 0; i < used.size(); ++i) {
    if (is_rounded[used[i]]) solid->rounded.push_back(i);
  }
  return solid;
}

}  // namespace watertight::formats
