// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "codec/mode_polygon/families.h"
#include "codec/mode_polygon/position_coder.h"
#include "codec/mode_polygon/surface.h"
#include "codec/page/modes.h"

namespace watertight::codec::polygon {
namespace {

// In the order of PolygonFamily: the number of weight sets, then the size of the table of each
// context. The call of code() for a family says what its contexts mean.
constexpr FamilyShape kFamilies[] = {
    {4, {384, 64, 160, 128, 192}},  // kRingSize
    {1, {24, 192, 144}},            // kDegree
    {1, {216, 216, 108}},           // kNewVertex
    {1, {12}},                      // kOnLoop
    {1, {8, 4}},                    // kFollow
    {1, {9, 48}},                   // kMoreRings
    {1, {2}},                       // kRingStart
    {1, {4}},                       // kMoreShells
    {1, {1}},                       // kHasCopies
    {1, {1}},                       // kIsCopy
    {3, {48, 54, 162, 72}},         // kVertical
    {1, {63, 36, 24}},              // kKnownColumn
    {1, {112, 64}},                 // kAcrossSign
    {1, {112, 128, 224}},           // kAlongSign
    {2, {48, 128, 36}},             // kKnownHeight
};
static_assert(std::size(kFamilies) == kPolygonFamilies);

constexpr NumberShape kNumbers[] = {
    {1, {2}},           // kLongRing
    {1, {6, 12}},       // kLoopSteps
    {1, {1}},           // kGateSteps
    {1, {3}},           // kFirstPosition
    {1, {3}},           // kFirstOffset
    {7, {56, 12, 32}},  // kAcross
    {7, {42, 32, 32}},  // kAlong
    {1, {21, 12}},      // kColumnRank
    {2, {12, 4, 16}},   // kPlaneResidual
    {2, {32, 2}},       // kHeightResidual
};
static_assert(std::size(kNumbers) == kPolygonNumbers);

/// The solid with the fans of each vertex joined again.
IntegerSolid assemble(const WalkedSurface& walked, const CodedPositions& positions) {
  const PolygonSurface& surface = walked.surface;
  IntegerSolid solid;
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
  for (const Index fan : walked->truth_vertex) {
    points.push_back(solid.vertices[truth->vertex_of[fan]]);
  }
  auto positions = PositionCoder(stream, models, memory, walked->surface, points).run();
  if (!positions) return positions.error();
  if (stream.is_reading()) solid = assemble(*walked, *positions);
  return Done{};
}

}  // namespace watertight::codec::polygon
