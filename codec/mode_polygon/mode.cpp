// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "codec/mode_polygon/families.h"
#include "codec/mode_polygon/position_coder.h"
#include "codec/mode_polygon/surface.h"
#include "codec/page/modes.h"

namespace watertight::codec::polygon {
namespace {

/// The solid of a walked surface, with the fans of each vertex joined again.
IntegerSolid assemble(const WalkedSurface& walked, const CodedPositions& positions) {
  const PolygonSurface& surface = walked.surface;
  IntegerSolid solid;
  solid.vertices.reserve(surface.vertex_count());
  solid.ring_vertices.reserve(surface.vertex.size());
  solid.ring_offsets.reserve(surface.ring_offsets.size());
  std::vector<Index> number(surface.vertex_count(), kNone);
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex) {
    if (positions.same_as[vertex] != vertex) {
      number[vertex] = number[positions.same_as[vertex]];
      continue;
    }
    number[vertex] = static_cast<Index>(solid.vertices.size());
    solid.vertices.push_back(positions.points[vertex]);
  }
  const auto append = [&](Index ring) {
    for (Index half = surface.ring_offsets[ring]; half < surface.ring_offsets[ring + 1]; ++half) {
      solid.ring_vertices.push_back(number[surface.vertex[half]]);
    }
    solid.ring_offsets.push_back(static_cast<Index>(solid.ring_vertices.size()));
  };
  for (Index facet = 0; facet < surface.facet_count(); ++facet) {
    append(walked.exterior[facet]);
    for (Index ring = surface.facet_offsets[facet]; ring < surface.facet_offsets[facet + 1];
         ++ring) {
      if (ring != walked.exterior[facet]) append(ring);
    }
  }
  solid.facet_offsets = surface.facet_offsets;
  solid.shell_offsets = surface.shell_offsets;
  return solid;
}

}  // namespace

const ModelLayout& model_layout() {
  static constexpr ModelLayout layout{kFamilies, kNumbers};
  return layout;
}

Status code_solid(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                  IntegerSolid& solid, const WriterChoice& /*choice*/, const Limits& limits) {
  std::optional<SurfaceTruth> truth;
  if (!stream.is_reading()) {
    auto surface = surface_of(solid, memory);
    if (!surface) return surface.error();
    truth = std::move(surface).value();
  }
  stream.enter(StreamPart::connectivity);
  auto walked = code_surface(stream, models, truth ? &*truth : nullptr, limits);
  if (!walked) return walked.error();
  std::vector<GridPoint> points;
  points.reserve(walked->truth_vertex.size());
  for (const Index fan : walked->truth_vertex) {
    points.push_back(solid.vertices[truth->vertex_of[fan]]);
  }
  auto positions = PositionCoder(stream, models, memory, walked->surface, points).run();
  if (!positions) return positions.error();
  if (stream.is_reading()) solid = assemble(*walked, *positions);
  return Done{};
}

}  // namespace watertight::codec::polygon
