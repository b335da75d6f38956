// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_bitmap/facet_structure.h"

#include <algorithm>
#include <array>

#include "codec/mode_bitmap/boundary_surface.h"
#include "geometry/canonical_form.h"
#include "geometry/predicates/predicates.h"
#include "geometry/vector3.h"

namespace watertight::codec::bitmap {
namespace {

using geometry::cross;
using geometry::difference;
using geometry::dot;

/// Classes of the angle at which two triangles meet, by which the models guess whether they belong
/// to one facet. An exact predicate decides class 0; IEEE products and sums in a fixed order decide
/// the others, so that every machine finds the same.
constexpr int kBendClasses = 6;

int bend_class(std::span<const Point> points, const Joint& joint) {
  const Point& a = points[joint.from];
  const Point& b = points[joint.to];
  const Point& p = points[joint.corners[0]];
  const Point& q = points[joint.corners[1]];
  const auto along = difference(b, a);
  const auto first = cross(along, difference(p, a));
  const auto second = cross(along, difference(q, a));
  const double product = dot(first, second);
  if (!(product < 0)) return 5;  // the triangles form a right angle or a sharper one
  if (geometry::orient3d(a, b, p, q) == 0) return 0;
  const double cosine_squared = product * product;
  const double all = dot(first, first) * dot(second, second);
  if (cosine_squared > 0.999999 * all) return 1;  // bent by at most 0.06 degrees
  if (cosine_squared > 0.9998 * all) return 2;    // bent by at most 0.8 degrees
  if (cosine_squared > 0.98 * all) return 3;      // bent by at most 8 degrees
  return 4;
}

/// The contents of the facet section.
struct Structure {
  std::vector<bool> is_interior;  // joint -> whether it lies inside a facet
  std::vector<bool> is_flipped;   // component -> whether its smallest triangle turns the other way
  Index exterior_component = 0;
  std::vector<Index> exterior_ring;  // facet -> index of its exterior ring among its sorted rings
};

struct Models {
  std::array<AdaptiveBit, kBendClasses> is_interior{AdaptiveBit(62000, 2), AdaptiveBit(50000, 1),
                                                    AdaptiveBit(40000, 0), AdaptiveBit(20000, 0),
                                                    AdaptiveBit(4000, 2),  AdaptiveBit(1000, 4)};
  AdaptiveBit is_flipped{32768, 0};
  AdaptiveBit is_not_exterior_component{20000, 0};
  AdaptiveBit is_not_exterior_ring{8000, 0};
};

Bytes write_structure(BitCoding coding, const std::vector<int>& bends, const Structure& structure,
                      const std::vector<std::vector<VertexRing>>& rings) {
  BitEncoder encoder(coding);
  Models models;
  for (std::size_t i = 0; i < bends.size(); ++i) {
    encoder.bit(structure.is_interior[i], models.is_interior[static_cast<std::size_t>(bends[i])]);
  }
  for (const bool flipped : structure.is_flipped) encoder.bit(flipped, models.is_flipped);
  if (structure.is_flipped.size() > 1) {
    encoder.unary(structure.exterior_component, models.is_not_exterior_component);
  }
  for (std::size_t facet = 0; facet < rings.size(); ++facet) {
    if (rings[facet].size() > 1) {
      encoder.unary(structure.exterior_ring[facet], models.is_not_exterior_ring);
    }
  }
  return std::move(encoder).finish();
}

std::vector<int> bend_classes(std::span<const Point> points, const BoundarySurface& surface) {
  std::vector<int> bends;
  bends.reserve(surface.joints().size());
  for (const Joint& joint : surface.joints()) bends.push_back(bend_class(points, joint));
  return bends;
}

/// True if a ring of the facet of the solid has the edge from -> to.
bool facet_has_edge(const Solid& solid, Index facet, Index from, Index to) {
  const IndexRange rings = solid.rings_of(facet);
  for (Index r = rings.begin; r < rings.end; ++r) {
    const auto ring = solid.ring(r);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ring[i] == from && ring[(i + 1) % ring.size()] == to) return true;
    }
  }
  return false;
}

/// Finds the components that are flipped. Requires a surface oriented without flips: a component is
/// flipped if a ring of one of its facets runs against the ring of the solid.
std::vector<bool> find_flips(const BoundarySurface& surface, const MarkedFaces& faces,
                             const Solid& solid) {
  std::vector<bool> is_flipped(surface.component_count(), false);
  std::vector<bool> is_known(surface.component_count(), false);
  const auto rings = surface.rings_of_facets();
  for (Index facet = 0; facet < rings.size(); ++facet) {
    const Index first = surface.first_triangle_of(facet);
    const Index component = surface.component_of(first);
    if (is_known[component] || rings[facet].empty() || rings[facet][0].size() < 3) continue;
    const VertexRing& ring = rings[facet][0];
    is_flipped[component] = !facet_has_edge(solid, faces.facet_of[first], ring[0], ring[1]);
    is_known[component] = true;
  }
  return is_flipped;
}

Index find_exterior_component(const BoundarySurface& surface, const MarkedFaces& faces,
                              const Solid& solid) {
  const Index end = solid.facets_of(0).end;
  for (Index i = 0; i < faces.triangles.size(); ++i) {
    if (faces.facet_of[i] < end) return surface.component_of(i);
  }
  return 0;
}

/// The index of the exterior ring among the sorted rings of each facet. Requires canonical rings.
std::vector<Index> find_exterior_rings(const BoundarySurface& surface,
                                       const std::vector<std::vector<VertexRing>>& rings,
                                       const MarkedFaces& faces, const Solid& solid) {
  std::vector<Index> exterior(rings.size(), 0);
  for (Index facet = 0; facet < rings.size(); ++facet) {
    if (rings[facet].size() < 2) continue;
    const Index source = faces.facet_of[surface.first_triangle_of(facet)];
    const auto ring = solid.ring(solid.rings_of(source).begin);
    const VertexRing wanted(ring.begin(), ring.end());
    const auto found = std::find(rings[facet].begin(), rings[facet].end(), wanted);
    if (found != rings[facet].end()) {
      exterior[facet] = static_cast<Index>(found - rings[facet].begin());
    }
  }
  return exterior;
}

/// True if the canonical form of the arrays is `canonical`.
bool tells(SolidArrays arrays, const Solid& canonical) {
  arrays.vertices.assign(canonical.vertices().begin(), canonical.vertices().end());
  const Limits none{.vertices = kNone, .facets = kNone, .rings = kNone, .shells = kNone};
  auto solid = Solid::make(std::move(arrays), canonical.lattice(), canonical.srid(), none);
  if (!solid) return false;
  auto boundary = OrientedBoundary::make(std::move(solid).value());
  if (!boundary) return false;
  return geometry::canonical_form(*boundary).boundary.solid() == canonical;
}

}  // namespace

std::optional<CodedFacets> write_facet_structure(std::span<const Point> points,
                                                 const MarkedFaces& faces, const Solid& canonical) {
  BoundarySurface surface(faces.triangles, canonical.vertex_count());
  Structure structure;
  for (const Joint& joint : surface.joints()) {
    structure.is_interior.push_back(faces.facet_of[joint.triangles[0]] ==
                                    faces.facet_of[joint.triangles[1]]);
  }
  surface.set_interior(structure.is_interior);
  if (!surface.orient(std::vector<bool>(surface.component_count(), false))) return std::nullopt;
  structure.is_flipped = find_flips(surface, faces, canonical);
  if (!surface.orient(structure.is_flipped)) return std::nullopt;
  const auto rings = surface.rings_of_facets();
  structure.exterior_component = find_exterior_component(surface, faces, canonical);
  structure.exterior_ring = find_exterior_rings(surface, rings, faces, canonical);
  if (!tells(surface.assemble(rings, structure.exterior_component, structure.exterior_ring),
             canonical)) {
    return std::nullopt;
  }
  const std::vector<int> bends = bend_classes(points, surface);
  CodedFacets plain{BitCoding::plain, write_structure(BitCoding::plain, bends, structure, rings)};
  CodedFacets coded{BitCoding::arithmetic,
                    write_structure(BitCoding::arithmetic, bends, structure, rings)};
  return coded.bytes.size() < plain.bytes.size() ? coded : plain;
}

Result<SolidArrays> read_facet_structure(ByteView section, BitCoding coding,
                                         std::span<const Point> points,
                                         std::span<const Triangle> triangles, Index vertex_count) {
  const Error malformed{ErrorCode::malformed, "truncated or malformed facet section"};
  BoundarySurface surface(triangles, vertex_count);
  BitDecoder decoder(section, coding);
  Models models;
  std::vector<bool> is_interior;
  is_interior.reserve(surface.joints().size());
  for (const Joint& joint : surface.joints()) {
    const auto bend = static_cast<std::size_t>(bend_class(points, joint));
    is_interior.push_back(decoder.bit(models.is_interior[bend]));
    if (decoder.failed()) return malformed;
  }
  surface.set_interior(std::move(is_interior));
  std::vector<bool> is_flipped;
  for (Index i = 0; i < surface.component_count(); ++i) {
    is_flipped.push_back(decoder.bit(models.is_flipped));
  }
  Index exterior_component = 0;
  if (surface.component_count() > 1) {
    exterior_component = static_cast<Index>(
        decoder.unary(surface.component_count() - 1, models.is_not_exterior_component));
  }
  if (decoder.failed()) return malformed;
  if (auto status = surface.orient(is_flipped); !status) return status.error();
  const auto rings = surface.rings_of_facets();
  std::vector<Index> exterior_ring(rings.size(), 0);
  for (std::size_t facet = 0; facet < rings.size(); ++facet) {
    if (rings[facet].size() < 2) continue;
    exterior_ring[facet] =
        static_cast<Index>(decoder.unary(rings[facet].size() - 1, models.is_not_exterior_ring));
    if (decoder.failed()) return malformed;
  }
  if (!decoder.is_finished()) return malformed;
  return surface.assemble(rings, exterior_component, exterior_ring);
}

}  // namespace watertight::codec::bitmap
