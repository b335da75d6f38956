// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_walk/facet_flags.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "codec/mode_walk/families.h"
#include "geometry/disjoint_sets.h"
#include "geometry/mesh/facet_rings.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/vector3.h"

namespace watertight::codec::walk {
namespace {

__extension__ typedef __int128 Wide;  // NOLINT(modernize-use-using)
using Vector = geometry::Vector3;
using geometry::cross;
using geometry::difference;
using geometry::dot;

// The contexts of family Exterior, one for each question.
constexpr Context<3> kAllTriangles{0U};
constexpr Context<3> kIsNotExteriorShell{1U};
constexpr Context<3> kIsNotExteriorRing{2U};

// Fixed by the format (docs/format-walk.md, "Facets of triangles").
// in grid steps, squared
constexpr std::array<double, 7> kDistances2{0.36, 1.44, 6.25, 25, 100, 900, 10000};
constexpr std::array<double, 6> kCosines{0.9999999, 0.99999, 0.999, 0.99, 0.9, 0.0};
constexpr std::uint32_t kOffsets = kDistances2.size() + 2;
constexpr std::uint32_t kAngles = kCosines.size() + 1;
constexpr std::uint32_t kDirections = 3;  // classes of the direction of a normal or an edge
constexpr std::uint32_t kLengths = 16;
constexpr std::uint32_t kKnown = 16;
constexpr std::uint32_t kHistory = 4;           // the number of flags that are remembered
constexpr std::uint32_t kRememberedOffset = 3;  // flags of offset classes below this one are
                                                // remembered
// The number that a flag adds to `known_` of its two triangles.
constexpr std::uint8_t kInteriorEdge = 1;
constexpr std::uint8_t kOtherEdge = 4;

Error not_encodable() {
  return {ErrorCode::not_encodable,
          "mode walk cannot code the facets: their edges do not separate them"};
}

/// True if three vectors lie in one plane, decided exactly. Requires whole coordinates below 2^31.
bool is_flat(const Vector& u, const Vector& v, const Vector& w) {
  const auto whole = [](double x) { return static_cast<Wide>(static_cast<std::int64_t>(x)); };
  return whole(w[0]) * (whole(u[1]) * whole(v[2]) - whole(u[2]) * whole(v[1])) +
             whole(w[1]) * (whole(u[2]) * whole(v[0]) - whole(u[0]) * whole(v[2])) +
             whole(w[2]) * (whole(u[0]) * whole(v[1]) - whole(u[1]) * whole(v[0])) ==
         0;
}

/// The classes of two triangles that meet at an edge.
struct Meeting {
  /// Distance of a triangle's corner from the plane of the other, in grid steps; 0: in the plane.
  Context<kOffsets> offset;
  Context<kAngles> angle;       // the angle between the normals
  Context<kDirections> slope;   // the first triangle is horizontal, vertical, other
  Context<kDirections> course;  // the edge is vertical, horizontal, other
  Context<kLengths> length;     // the octave of the length of the edge
};

/// 0, 1 or 2: the vector is along the z axis, in the xy plane, or neither.
Context<kDirections> direction_of(const Vector& v) {
  return Context<kDirections>(v[0] == 0 && v[1] == 0 ? 0U : v[2] == 0 ? 1U : 2U);
}

Meeting meeting(const Point& a, const Point& b, const Point& o, const Point& w) {
  const Vector along = difference(b, a);
  const Vector to_o = difference(o, a);
  const Vector to_w = difference(w, a);
  const Vector first = cross(along, to_o);
  const Vector second = cross(to_w, along);
  const double first2 = dot(first, first);
  const double second2 = dot(second, second);
  std::uint32_t offset = 0;
  if (!is_flat(along, to_o, to_w)) {
    const double volume = dot(first, to_w);
    const double most = std::max(first2, second2);
    offset = 1;
    for (const double square : kDistances2) offset += volume * volume > square * most ? 1U : 0U;
  }
  const double product = dot(first, second);
  const double both = std::sqrt(first2 * second2);
  std::uint32_t angle = 0;
  while (angle < kCosines.size() && !(product > kCosines[angle] * both)) ++angle;
  const auto squared = static_cast<std::uint64_t>(std::min(dot(along, along), 0x1p62));
  return {.offset = Context<kOffsets>(offset),
          .angle = Context<kAngles>(angle),
          .slope = direction_of(first),
          .course = direction_of(along),
          .length = capped<kLengths>(std::bit_width(squared) / 2)};
}

/// A ring of a facet of the mesh, its smallest vertex first.
struct FlagRing {
  Index facet = 0;
  std::vector<Index> vertices;
  double size = 0;  // squared diagonal of its box
};

double squared_diagonal(std::span<const Point> points, std::span<const Index> vertices) {
  Box box;
  for (const Index v : vertices) box.include(points[v]);
  const Vector diagonal = difference(box.max, box.min);
  return dot(diagonal, diagonal);
}

class Facets {
 public:
  Facets(EntropyStream& stream, ModelBank& models, std::span<const Point> points,
         const BoundaryMesh& mesh, std::span<const Index> facet_of, IntegerSolid& solid)
      : stream_(stream),
        models_(models),
        points_(points),
        mesh_(mesh),
        facet_of_(facet_of),
        solid_(solid),
        facets_(mesh.triangles.size()),
        inner_twin_(mesh.twin.size(), kNone),
        known_(mesh.triangles.size(), 0) {}

  Status run();

 private:
  bool is_reading() const { return stream_.is_reading(); }
  bool code_exterior(Context<3> question, bool value) {
    return models_.code<kExterior>(stream_, {question}, value);
  }
  void code_flags();
  void code_flag(Index half_edge);
  void number_facets();
  void find_rings();
  bool order_rings();
  bool order_shells();
  template <class Matches>
  std::size_t code_choice(Context<3> question, std::size_t count, const Matches& matches);
  bool matches_solid() const;
  void write_arrays();

  EntropyStream& stream_;
  ModelBank& models_;
  std::span<const Point> points_;
  const BoundaryMesh& mesh_;
  std::span<const Index> facet_of_;
  IntegerSolid& solid_;
  geometry::DisjointSets facets_;      // sets of triangles
  std::vector<Index> inner_twin_;      // half-edge -> its twin if inside a facet, else kNone
  std::vector<std::uint8_t> known_;    // triangle -> the sum over the coded flags of its edges
  Answers<kHistory> history_;          // the last flags of edges whose offset class is below
                                       // kRememberedOffset
  std::vector<Index> facet_;           // triangle -> facet
  std::vector<Index> first_triangle_;  // facet -> its first triangle
  std::vector<FlagRing> rings_;
  std::vector<Index> first_ring_;  // facet -> index of its first ring in rings_
  std::vector<Index> shells_;      // components, the exterior one first
};

void Facets::code_flag(Index half_edge) {
  const Index twin = mesh_.twin[half_edge];
  const Index t = half_edge / 3;
  const Index u = twin / 3;
  const Meeting m = meeting(points_[geometry::start_of(mesh_.triangles, twin)],
                            points_[geometry::end_of(mesh_.triangles, twin)],
                            points_[geometry::corner_of(mesh_.triangles, twin)],
                            points_[geometry::corner_of(mesh_.triangles, half_edge)]);
  const Context<2> linked(facets_.root(t) == facets_.root(u));
  const Context<kKnown> known_t(known_[t]);
  const Context<kKnown> known_u(known_[u]);
  const bool interior = models_.code<kInterior>(
      stream_, m.offset,
      {combine(m.offset, m.angle, known_t, known_u), combine(m.offset, m.slope, m.course, linked),
       combine(m.angle, m.slope, m.course, linked), combine(m.offset, m.angle, m.slope, m.course),
       combine(m.offset, m.length, m.course), combine(m.offset, history_.last(), linked)},
      !facet_of_.empty() && facet_of_[t] == facet_of_[u]);
  if (m.offset.value < kRememberedOffset) history_.add(interior);
  const std::uint8_t flag = interior ? kInteriorEdge : kOtherEdge;
  known_[t] = static_cast<std::uint8_t>(known_[t] + flag);
  known_[u] = static_cast<std::uint8_t>(known_[u] + flag);
  if (!interior) return;
  inner_twin_[half_edge] = twin;
  inner_twin_[twin] = half_edge;
  facets_.join(t, u);
}

void Facets::code_flags() {
  bool all_triangles = false;
  if (!is_reading()) all_triangles = solid_.facet_count() == mesh_.triangles.size();
  if (code_exterior(kAllTriangles, all_triangles)) return;
  for (Index h = 0; h < mesh_.twin.size(); ++h) {
    if (mesh_.twin[h] < h && !stream_.failed()) code_flag(h);
  }
}

void Facets::number_facets() {
  geometry::NumberedSets facets = facets_.numbered();
  facet_ = std::move(facets.set_of);
  first_triangle_ = std::move(facets.first);
}

/// Finds all rings and sorts them by facet, then by size, the largest first.
void Facets::find_rings() {
  for (geometry::FacetRing& ring : geometry::facet_rings(mesh_.triangles, inner_twin_)) {
    const double size = squared_diagonal(points_, ring.vertices);
    rings_.push_back({facet_[ring.triangle], std::move(ring.vertices), size});
  }
  std::stable_sort(rings_.begin(), rings_.end(), [](const FlagRing& x, const FlagRing& y) {
    return x.facet != y.facet ? x.facet < y.facet : x.size > y.size;
  });
  first_ring_.assign(first_triangle_.size() + 1, 0);
  for (const FlagRing& ring : rings_) ++first_ring_[ring.facet + 1];
  for (std::size_t f = 0; f < first_triangle_.size(); ++f) first_ring_[f + 1] += first_ring_[f];
}

/// Codes the index of the alternative that matches, of `count`: one decision for each alternative
/// until one matches. When writing, returns `count` if none matches.
template <class Matches>
std::size_t Facets::code_choice(Context<3> question, std::size_t count, const Matches& matches) {
  std::size_t choice = 0;
  if (!is_reading()) {
    while (choice < count && !matches(choice)) ++choice;
    if (choice == count) return count;
  }
  for (std::size_t i = 0; i + 1 < count; ++i) {
    if (!code_exterior(question, i != choice)) return i;
    if (stream_.failed()) return 0;
  }
  return count - 1;
}

/// Puts the exterior ring of each facet first. Returns false if a facet has no ring or, when
/// writing, if its exterior ring is not among the rings found.
bool Facets::order_rings() {
  for (std::size_t f = 0; f + 1 < first_ring_.size(); ++f) {
    const auto begin = rings_.begin() + first_ring_[f];
    const std::size_t count = first_ring_[f + 1] - first_ring_[f];
    if (count == 0) return false;
    const std::size_t exterior = code_choice(kIsNotExteriorRing, count, [&](std::size_t i) {
      const auto wanted = solid_.ring(solid_.facet_offsets[facet_of_[first_triangle_[f]]]);
      const auto& ring = (begin + static_cast<std::ptrdiff_t>(i))->vertices;
      return std::equal(wanted.begin(), wanted.end(), ring.begin(), ring.end());
    });
    if (exterior == count) return false;
    std::swap(*begin, *(begin + static_cast<std::ptrdiff_t>(exterior)));
  }
  return true;
}

/// Lists the components, the exterior shell first. When writing, returns false if none is exterior.
bool Facets::order_shells() {
  struct Sized {
    Index component;
    double size;
  };
  std::vector<Sized> sized;
  for (Index c = 0; c < mesh_.component_count(); ++c) {
    Box box;
    for (Index t = mesh_.component_first[c]; t < mesh_.component_first[c + 1]; ++t) {
      for (const Index v : mesh_.triangles[t]) box.include(points_[v]);
    }
    const Vector diagonal = difference(box.max, box.min);
    sized.push_back({c, dot(diagonal, diagonal)});
  }
  std::stable_sort(sized.begin(), sized.end(),
                   [](const Sized& x, const Sized& y) { return x.size > y.size; });
  const std::size_t exterior = code_choice(kIsNotExteriorShell, sized.size(), [&](std::size_t i) {
    return facet_of_[mesh_.component_first[sized[i].component]] < solid_.shell_offsets[1];
  });
  if (exterior == sized.size()) return false;
  std::swap(sized[0], sized[exterior]);
  for (const Sized& component : sized) shells_.push_back(component.component);
  return true;
}

/// For writing: true if the facets found are those of the solid, ring by ring.
bool Facets::matches_solid() const {
  if (mesh_.component_count() != solid_.shell_count()) return false;
  if (first_triangle_.size() != solid_.facet_count() || rings_.size() != solid_.ring_count()) {
    return false;
  }
  for (std::size_t f = 0; f < first_triangle_.size(); ++f) {
    const Index facet = facet_of_[first_triangle_[f]];
    const Index begin = solid_.facet_offsets[facet];
    const Index end = solid_.facet_offsets[facet + 1];
    if (first_ring_[f + 1] - first_ring_[f] != end - begin) return false;
    for (Index r = first_ring_[f]; r < first_ring_[f + 1]; ++r) {
      bool is_there = false;
      for (Index i = begin; i < end && !is_there; ++i) {
        const auto ring = solid_.ring(i);
        is_there = std::equal(ring.begin(), ring.end(), rings_[r].vertices.begin(),
                              rings_[r].vertices.end());
      }
      if (!is_there) return false;
    }
  }
  return true;
}

void Facets::write_arrays() {
  std::vector<std::vector<Index>> facets_of(mesh_.component_count());
  Index component = 0;
  for (Index f = 0; f < first_triangle_.size(); ++f) {
    while (first_triangle_[f] >= mesh_.component_first[component + 1]) ++component;
    facets_of[component].push_back(f);
  }
  for (const Index shell : shells_) {
    for (const Index f : facets_of[shell]) {
      for (Index r = first_ring_[f]; r < first_ring_[f + 1]; ++r) {
        const auto& ring = rings_[r].vertices;
        solid_.ring_vertices.insert(solid_.ring_vertices.end(), ring.begin(), ring.end());
        solid_.ring_offsets.push_back(static_cast<Index>(solid_.ring_vertices.size()));
      }
      solid_.facet_offsets.push_back(solid_.ring_count());
    }
    solid_.shell_offsets.push_back(solid_.facet_count());
  }
}

Status Facets::run() {
  const Error malformed{ErrorCode::malformed, "the facets of the triangles"};
  code_flags();
  if (stream_.failed()) return malformed;
  number_facets();
  find_rings();
  if (!is_reading() && !matches_solid()) return not_encodable();
  const bool is_ordered = order_rings() && order_shells();
  if (!is_ordered || stream_.failed()) return is_reading() ? malformed : not_encodable();
  if (is_reading()) write_arrays();
  return Done{};
}

}  // namespace

Status code_facets(EntropyStream& stream, ModelBank& models, std::span<const Point> points,
                   const BoundaryMesh& mesh, std::span<const Index> facet_of, IntegerSolid& solid) {
  stream.enter(StreamPart::facets);
  return Facets(stream, models, points, mesh, facet_of, solid).run();
}

}  // namespace watertight::codec::walk
