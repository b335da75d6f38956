// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/canonical_form.h"

#include <algorithm>
#include <compare>
#include <numeric>

#include "base/assert.h"
#include "base/bytes.h"
#include "base/checksum.h"

namespace watertight::geometry {
namespace {

constexpr Limits kNoLimits{.vertices = kNone, .facets = kNone, .rings = kNone, .shells = kNone};

std::vector<Index> identity(Index size) {
  std::vector<Index> order(size);
  std::iota(order.begin(), order.end(), Index{0});
  return order;
}

bool is_identity_permutation(std::span<const Index> order) {
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] != i) return false;
  }
  return true;
}

/// The inverse, or nothing if `order` is not a permutation of 0 .. order.size() - 1.
std::optional<std::vector<Index>> inverse_of(std::span<const Index> order) {
  std::vector<Index> inverse(order.size(), kNone);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] >= order.size() || inverse[order[i]] != kNone) return std::nullopt;
    inverse[order[i]] = static_cast<Index>(i);
  }
  return inverse;
}

/// Finds the canonical order of a solid bottom up: vertices, ring starts, rings, facets, shells.
/// Does not change the solid; ring vertices are renumbered and rotated in a copy.
class Arranger {
 public:
  explicit Arranger(const Solid& solid) : solid_(solid) {
    sort_vertices();
    rotate_rings();
    sort_interior_rings();
    sort_facets();
    sort_inner_shells();
  }

  CanonicalSolid arrange() const;

 private:
  void sort_vertices();
  void rotate_rings();
  void sort_interior_rings();
  void sort_facets();
  void sort_inner_shells();

  std::span<const Index> rotated_ring(Index ring) const {
    const auto& offsets = solid_.arrays().ring_offsets;
    return std::span<const Index>(rotated_).subspan(offsets[ring],
                                                    offsets[ring + 1] - offsets[ring]);
  }
  std::strong_ordering compare_rings(Index a, Index b) const;
  std::strong_ordering compare_facets(Index a, Index b) const;
  std::strong_ordering compare_shells(Index a, Index b) const;

  const Solid& solid_;
  std::vector<Index> vertex_order_;  // canonical vertex -> source vertex
  std::vector<Index> rotated_;       // the ring vertices in canonical numbers, each ring rotated
  std::vector<Index> ring_start_;    // source ring -> index of its first vertex once it is rotated
  std::vector<Index> ring_order_;    // the source rings, sorted within each facet
  std::vector<Index> facet_order_;   // the source facets, sorted within each shell
  std::vector<Index> shell_order_;   // canonical shell -> source shell
};

void Arranger::sort_vertices() {
  const auto vertices = solid_.vertices();
  vertex_order_ = identity(solid_.vertex_count());
  std::sort(vertex_order_.begin(), vertex_order_.end(),
            [&](Index a, Index b) { return vertices[a] < vertices[b]; });
}

void Arranger::rotate_rings() {
  std::vector<Index> canonical(vertex_order_.size());
  for (std::size_t i = 0; i < vertex_order_.size(); ++i) {
    canonical[vertex_order_[i]] = static_cast<Index>(i);
  }
  rotated_ = solid_.arrays().ring_vertices;
  for (Index& vertex : rotated_) vertex = canonical[vertex];

  ring_start_.resize(solid_.ring_count());
  const auto& offsets = solid_.arrays().ring_offsets;
  for (Index ring = 0; ring < solid_.ring_count(); ++ring) {
    const auto begin = rotated_.begin() + offsets[ring];
    const auto end = rotated_.begin() + offsets[ring + 1];
    const auto smallest = std::min_element(begin, end);
    ring_start_[ring] = smallest == begin ? 0 : static_cast<Index>(end - smallest);
    std::rotate(begin, smallest, end);
  }
}

std::strong_ordering Arranger::compare_rings(Index a, Index b) const {
  const auto left = rotated_ring(a);
  const auto right = rotated_ring(b);
  return std::lexicographical_compare_three_way(left.begin(), left.end(), right.begin(),
                                                right.end());
}

std::strong_ordering Arranger::compare_facets(Index a, Index b) const {
  const IndexRange left = solid_.rings_of(a);
  const IndexRange right = solid_.rings_of(b);
  return std::lexicographical_compare_three_way(
      ring_order_.begin() + left.begin, ring_order_.begin() + left.end,
      ring_order_.begin() + right.begin, ring_order_.begin() + right.end,
      [&](Index ring_a, Index ring_b) { return compare_rings(ring_a, ring_b); });
}

std::strong_ordering Arranger::compare_shells(Index a, Index b) const {
  const IndexRange left = solid_.facets_of(a);
  const IndexRange right = solid_.facets_of(b);
  return std::lexicographical_compare_three_way(
      facet_order_.begin() + left.begin, facet_order_.begin() + left.end,
      facet_order_.begin() + right.begin, facet_order_.begin() + right.end,
      [&](Index facet_a, Index facet_b) { return compare_facets(facet_a, facet_b); });
}

void Arranger::sort_interior_rings() {
  ring_order_ = identity(solid_.ring_count());
  for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
    const IndexRange rings = solid_.rings_of(facet);
    std::sort(ring_order_.begin() + rings.begin + 1, ring_order_.begin() + rings.end,
              [&](Index a, Index b) {
                const auto order = compare_rings(a, b);
                return order != 0 ? order < 0 : a < b;
              });
  }
}

void Arranger::sort_facets() {
  facet_order_ = identity(solid_.facet_count());
  // The first two vertices of the exterior ring decide nearly every comparison.
  std::vector<std::uint64_t> key(solid_.facet_count());
  for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
    const auto ring = rotated_ring(solid_.rings_of(facet).begin);
    key[facet] = (std::uint64_t{ring[0]} << 32U) | ring[1];
  }
  for (Index shell = 0; shell < solid_.shell_count(); ++shell) {
    const IndexRange facets = solid_.facets_of(shell);
    std::sort(facet_order_.begin() + facets.begin, facet_order_.begin() + facets.end,
              [&](Index a, Index b) {
                if (key[a] != key[b]) return key[a] < key[b];
                const auto order = compare_facets(a, b);
                return order != 0 ? order < 0 : a < b;
              });
  }
}

void Arranger::sort_inner_shells() {
  shell_order_ = identity(solid_.shell_count());
  std::sort(shell_order_.begin() + 1, shell_order_.end(), [&](Index a, Index b) {
    const auto order = compare_shells(a, b);
    return order != 0 ? order < 0 : a < b;
  });
}

CanonicalSolid Arranger::arrange() const {
  SourceOrder order;
  order.vertex = vertex_order_;
  order.shell = shell_order_;
  SolidArrays arrays;
  arrays.vertices.reserve(vertex_order_.size());
  arrays.ring_vertices.reserve(rotated_.size());
  arrays.ring_offsets.reserve(ring_order_.size() + 1);
  arrays.facet_offsets.reserve(facet_order_.size() + 1);
  order.facet.reserve(facet_order_.size());
  order.ring.reserve(ring_order_.size());
  order.ring_start.reserve(ring_order_.size());
  for (const Index vertex : vertex_order_) arrays.vertices.push_back(solid_.vertices()[vertex]);
  for (const Index shell : shell_order_) {
    const IndexRange facets = solid_.facets_of(shell);
    for (Index i = facets.begin; i < facets.end; ++i) {
      const Index facet = facet_order_[i];
      order.facet.push_back(facet);
      const IndexRange rings = solid_.rings_of(facet);
      for (Index j = rings.begin; j < rings.end; ++j) {
        const Index ring = ring_order_[j];
        order.ring.push_back(ring);
        order.ring_start.push_back(ring_start_[ring]);
        const auto vertices = rotated_ring(ring);
        arrays.ring_vertices.insert(arrays.ring_vertices.end(), vertices.begin(), vertices.end());
        arrays.end_ring();
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  // A rearranged solid or oriented boundary is still one, so the two make() calls succeed.
  auto solid = Solid::make(std::move(arrays), solid_.lattice(), solid_.srid(), kNoLimits);
  WATERTIGHT_ASSERT(solid.has_value());
  auto boundary = OrientedBoundary::make(std::move(solid).value());
  WATERTIGHT_ASSERT(boundary.has_value());
  return {std::move(boundary).value(), std::move(order)};
}

Error malformed_order(const char* what) {
  return {ErrorCode::malformed, std::string("the source order does not fit the solid: ") + what};
}

/// The inverses of the permutations of a SourceOrder.
struct Inverse {
  std::vector<Index> vertex;  // source vertex -> canonical vertex
  std::vector<Index> shell;   // source shell -> canonical shell
  std::vector<Index> facet;   // source facet -> canonical facet
  std::vector<Index> ring;    // source ring -> canonical ring
};

Result<Inverse> invert(const Solid& canonical, const SourceOrder& order) {
  if (order.vertex.size() != canonical.vertex_count() ||
      order.shell.size() != canonical.shell_count() ||
      order.facet.size() != canonical.facet_count() ||
      order.ring.size() != canonical.ring_count() || order.ring_start.size() != order.ring.size()) {
    return malformed_order("sizes differ");
  }
  auto vertex = inverse_of(order.vertex);
  auto shell = inverse_of(order.shell);
  auto facet = inverse_of(order.facet);
  auto ring = inverse_of(order.ring);
  if (!vertex || !shell || !facet || !ring) return malformed_order("not a permutation");
  if (!order.shell.empty() && order.shell[0] != 0) {
    return malformed_order("the exterior shell is not first");
  }
  for (Index i = 0; i < canonical.ring_count(); ++i) {
    const std::size_t size = canonical.ring(i).size();
    if (order.ring_start[i] >= std::max<std::size_t>(size, 1)) {
      return malformed_order("a ring starts beyond its end");
    }
  }
  return Inverse{std::move(*vertex), std::move(*shell), std::move(*facet), std::move(*ring)};
}

/// True if each source shell has the facets of its canonical shell.
bool facets_stay_in_shells(const Solid& canonical, const Inverse& inverse) {
  Index source_facet = 0;
  for (const Index shell : inverse.shell) {
    const IndexRange facets = canonical.facets_of(shell);
    for (Index i = 0; i < facets.size(); ++i, ++source_facet) {
      const Index facet = inverse.facet[source_facet];
      if (facet < facets.begin || facet >= facets.end) return false;
    }
  }
  return true;
}

/// True if each source facet has the rings of its canonical facet, the exterior ring first.
bool rings_stay_in_facets(const Solid& canonical, const Inverse& inverse) {
  Index source_ring = 0;
  for (const Index facet : inverse.facet) {
    const IndexRange rings = canonical.rings_of(facet);
    for (Index i = 0; i < rings.size(); ++i, ++source_ring) {
      const Index ring = inverse.ring[source_ring];
      if (ring < rings.begin || ring >= rings.end) return false;
      if (i == 0 && ring != rings.begin) return false;
    }
  }
  return true;
}

void append_grid_number(ByteWriter& writer, const GridNumber& number) {
  writer.u64(static_cast<std::uint64_t>(number.mantissa));
  writer.u32(static_cast<std::uint32_t>(number.exponent));
}

}  // namespace

bool SourceOrder::is_identity() const {
  return is_identity_permutation(vertex) && is_identity_permutation(shell) &&
         is_identity_permutation(facet) && is_identity_permutation(ring) &&
         std::all_of(ring_start.begin(), ring_start.end(), [](Index start) { return start == 0; });
}

CanonicalSolid canonical_form(const OrientedBoundary& boundary) {
  return Arranger(boundary.solid()).arrange();
}

Result<Solid> restore_order(const Solid& canonical, const SourceOrder& order) {
  auto inverse = invert(canonical, order);
  if (!inverse) return inverse.error();
  if (!facets_stay_in_shells(canonical, *inverse))
    return malformed_order("a facet leaves its shell");
  if (!rings_stay_in_facets(canonical, *inverse)) return malformed_order("a ring leaves its facet");

  SolidArrays arrays;
  arrays.vertices.reserve(canonical.vertex_count());
  arrays.ring_vertices.reserve(canonical.arrays().ring_vertices.size());
  arrays.ring_offsets.reserve(canonical.ring_count() + std::size_t{1});
  arrays.facet_offsets.reserve(canonical.facet_count() + std::size_t{1});
  for (const Index vertex : inverse->vertex)
    arrays.vertices.push_back(canonical.vertices()[vertex]);
  Index source_facet = 0;
  Index source_ring = 0;
  for (const Index shell : inverse->shell) {
    for (Index i = 0; i < canonical.facets_of(shell).size(); ++i, ++source_facet) {
      const Index facet = inverse->facet[source_facet];
      for (Index j = 0; j < canonical.rings_of(facet).size(); ++j, ++source_ring) {
        const Index ring = inverse->ring[source_ring];
        const auto vertices = canonical.ring(ring);
        const std::size_t start = order.ring_start[ring];
        for (std::size_t k = 0; k < vertices.size(); ++k) {
          arrays.ring_vertices.push_back(order.vertex[vertices[(start + k) % vertices.size()]]);
        }
        arrays.end_ring();
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  return Solid::make(std::move(arrays), canonical.lattice(), canonical.srid(), kNoLimits);
}

std::uint64_t solid_hash(const OrientedBoundary& boundary) {
  const CanonicalSolid canonical = canonical_form(boundary);
  const Solid& solid = canonical.boundary.solid();
  const SolidArrays& arrays = solid.arrays();
  ByteWriter writer;
  writer.u8(static_cast<std::uint8_t>(solid.lattice().kind));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    append_grid_number(writer, solid.lattice().step[axis]);
    append_grid_number(writer, solid.lattice().origin[axis]);
  }
  writer.u32(solid.srid());
  writer.u64(arrays.vertices.size());
  for (const Point& p : arrays.vertices) {
    for (int axis = 0; axis < 3; ++axis) writer.f64(p[axis]);
  }
  for (const auto* indices : {&arrays.ring_vertices, &arrays.ring_offsets, &arrays.facet_offsets,
                              &arrays.shell_offsets}) {
    writer.u64(indices->size());
    for (const Index index : *indices) writer.u32(index);
  }
  return content_hash(writer.bytes());
}

}  // namespace watertight::geometry
