// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/verdict/surface.h"

#include <algorithm>

#include "tessellate/facets.h"

namespace watertight::verdict {
namespace {

using ExactRing = std::vector<Vector>;

Vector ring_normal(const ExactRing& ring) {
  Vector sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Vector part = cross(difference(ring[i], ring[0]), difference(ring[i + 1], ring[0]));
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += part[axis];
  }
  return sum;
}

bool is_planar(const std::vector<ExactRing>& rings, const Vector& normal) {
  for (const ExactRing& ring : rings) {
    for (const Vector& p : ring) {
      if (sgn(dot(normal, difference(p, rings[0][0]))) != 0) return false;
    }
  }
  return true;
}

enum class Meeting { none, point, overlap };

/// The way in which two segments of one plane meet; `point` is set for Meeting::point.
Meeting meeting_of(const ExactEdge& a, const ExactEdge& b, Vector& point) {
  std::set<Vector> ends;
  for (const Vector& p : a) {
    if (is_on_segment(p, b[0], b[1])) ends.insert(p);
  }
  for (const Vector& p : b) {
    if (is_on_segment(p, a[0], a[1])) ends.insert(p);
  }
  if (ends.size() > 1) return Meeting::overlap;
  if (ends.size() == 1) {
    point = *ends.begin();
    return Meeting::point;
  }
  const Vector direction = difference(a[1], a[0]);
  const Vector normal = cross(direction, difference(b[1], b[0]));
  if (is_zero(normal)) return Meeting::none;
  const Vector side_b = cross(normal, direction);  // in the plane, at a right angle to a
  const Vector side_a = cross(normal, difference(b[1], b[0]));
  const Number b0 = dot(side_b, difference(b[0], a[0]));
  const Number b1 = dot(side_b, difference(b[1], a[0]));
  const Number a0 = dot(side_a, difference(a[0], b[0]));
  const Number a1 = dot(side_a, difference(a[1], b[0]));
  if (sgn(a0) * sgn(a1) >= 0 || sgn(b0) * sgn(b1) >= 0) return Meeting::none;
  point = between(b[0], b[1], b0 / (b0 - b1));
  return Meeting::point;
}

ExactEdge edge_of(const ExactRing& ring, std::size_t k) {
  return {ring[k], ring[(k + 1) % ring.size()]};
}

/// Appends the parts of an edge between the vertices of the facet that lie on the edge.
void append_split(const ExactEdge& edge, const std::vector<ExactRing>& rings,
                  std::vector<ExactEdge>& edges) {
  std::set<Vector> on{edge[0], edge[1]};
  for (const ExactRing& ring : rings) {
    for (const Vector& p : ring) {
      if (is_on_segment(p, edge[0], edge[1])) on.insert(p);
    }
  }
  std::vector<Vector> along(on.begin(), on.end());
  if (along.front() != edge[0]) std::reverse(along.begin(), along.end());
  for (std::size_t k = 0; k + 1 < along.size(); ++k) edges.push_back({along[k], along[k + 1]});
}

bool is_simple(const ExactRing& ring) {
  Vector point;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Meeting meeting = meeting_of(edge_of(ring, i), edge_of(ring, j), point);
      if (meeting == Meeting::overlap) return false;
      const bool are_neighbours = i == j + 1 || (j == 0 && i + 1 == ring.size());
      const bool is_shared = are_neighbours && point == (i == j + 1 ? ring[i] : ring[0]);
      if (meeting == Meeting::point && !is_shared) return false;
    }
  }
  return ring.size() >= 3;
}

/// True if the rings overlap, or cross in a point that is a vertex of neither.
bool do_cross(const ExactRing& first, const ExactRing& second) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t j = 0; j < second.size(); ++j) {
      const ExactEdge a = edge_of(first, i);
      const ExactEdge b = edge_of(second, j);
      Vector point;
      const Meeting meeting = meeting_of(a, b, point);
      if (meeting == Meeting::overlap) return true;
      const bool is_vertex = point == a[0] || point == a[1] || point == b[0] || point == b[1];
      if (meeting == Meeting::point && !is_vertex) return true;
    }
  }
  return false;
}

/// The numbers of parts of a ring, split by the vertices of both rings, that are outside and inside
/// another ring.
std::array<std::size_t, 2> parts_outside_and_inside(const ExactRing& ring, const ExactRing& other) {
  std::vector<ExactEdge> parts;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    append_split(edge_of(ring, k), {ring, other}, parts);
  }
  const Piece piece{0, {other}};
  const int axis = dropped_axis(piece);
  std::array<std::size_t, 2> counts{};
  for (const ExactEdge& part : parts) {
    const Side side = locate_in(piece, between(part[0], part[1], Number(1, 2)), axis);
    ++counts[side == Side::inside ? 1 : 0];
  }
  return counts;
}

void check_ring_pair(const FacetModel& facet, std::size_t i, std::size_t j, std::set<int>& codes) {
  const ExactRing& outer = facet.rings[i];
  const ExactRing& inner = facet.rings[j];
  if (do_cross(outer, inner)) {
    codes.insert({201, 202});
    return;
  }
  const auto [j_outside, j_inside] = parts_outside_and_inside(inner, outer);
  if (j_outside != 0 && j_inside != 0) codes.insert(201);
  if (i == 0) {
    if (j_inside == 0) codes.insert(206);
    return;
  }
  const auto [i_outside, i_inside] = parts_outside_and_inside(outer, inner);
  if (i_outside != 0 && i_inside != 0) codes.insert(201);
  if (j_outside == 0 || i_outside == 0) codes.insert(207);
}

void check_rings(const FacetModel& facet, const Vector& normal, std::set<int>& codes) {
  for (const ExactRing& ring : facet.rings) {
    if (!is_simple(ring)) {
      codes.insert({101, 102, 104});
      return;
    }
  }
  for (std::size_t j = 1; j < facet.rings.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) check_ring_pair(facet, i, j, codes);
    if (sgn(dot(ring_normal(facet.rings[j]), normal)) >= 0) codes.insert(208);
  }
}

std::vector<ExactRing> rings_of(const Solid& solid, Index facet) {
  std::vector<ExactRing> rings;
  for (Index r = solid.rings_of(facet).begin; r < solid.rings_of(facet).end; ++r) {
    ExactRing& ring = rings.emplace_back();
    for (const Index vertex : solid.ring(r)) ring.push_back(exact(solid.vertices()[vertex]));
  }
  return rings;
}

}  // namespace

SurfaceModel model_of(const Solid& submitted) {
  const Solid solid = geometry::merge_equal_vertices(submitted).solid;
  SurfaceModel model;
  model.shell_count = solid.shell_count();
  std::optional<tessellate::FacetTriangles> triangles;
  for (Index f = 0; f < solid.facet_count(); ++f) {
    FacetModel& facet = model.facets.emplace_back();
    facet.shell = solid.shell_of(f);
    facet.rings = rings_of(solid, f);
    for (const ExactRing& ring : facet.rings) {
      for (std::size_t k = 0; k < ring.size(); ++k) {
        append_split(edge_of(ring, k), facet.rings, facet.edges);
      }
    }
    const Vector normal = ring_normal(facet.rings.front());
    facet.is_planar = is_planar(facet.rings, normal);
    if (facet.is_planar) {
      facet.pieces.push_back(facet.rings);
      if (is_zero(normal)) model.ring_codes.insert({101, 102, 104});
      if (!is_zero(normal)) check_rings(facet, normal, model.ring_codes);
      continue;
    }
    if (!triangles) triangles = tessellate::triangulate_facets(solid);
    model.is_known = model.is_known && triangles->state[f] == tessellate::FacetState::triangulated;
    for (Index t = triangles->first[f]; t < triangles->first[f + 1]; ++t) {
      ExactRing& corners = facet.pieces.emplace_back(1).front();
      for (const Index vertex : triangles->triangles[t]) {
        corners.push_back(exact(solid.vertices()[vertex]));
      }
    }
  }
  return model;
}

std::vector<Piece> pieces_of(const SurfaceModel& model, std::size_t first_facet) {
  std::vector<Piece> pieces;
  for (std::size_t facet = 0; facet < model.facets.size(); ++facet) {
    for (const auto& rings : model.facets[facet].pieces) {
      pieces.push_back({first_facet + facet, rings});
    }
  }
  return pieces;
}

ParityLocator::ParityLocator(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  for (const Piece& piece : pieces_) normals_.push_back(ring_normal(piece.rings.front()));
}

std::optional<bool> ParityLocator::try_ray(const Vector& p, const Vector& direction) const {
  bool is_inside = false;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Number height = dot(normals_[i], difference(pieces_[i].rings[0][0], p));
    const Number speed = dot(normals_[i], direction);
    if (sgn(speed) == 0) {
      if (sgn(height) == 0) return std::nullopt;
      continue;
    }
    const Number t = height / speed;
    if (sgn(t) <= 0) continue;
    Vector hit = p;
    for (std::size_t axis = 0; axis < 3; ++axis) hit[axis] += direction[axis] * t;
    const Side side = locate_in(pieces_[i], hit, dropped_axis(pieces_[i]));
    if (side == Side::boundary) return std::nullopt;
    if (side == Side::inside) is_inside = !is_inside;
  }
  return is_inside;
}

bool ParityLocator::is_inside(const Vector& p) const {
  long a = 3;
  long b = 5;
  while (true) {  // few directions meet an edge, and no two of the directions are parallel
    const auto found = try_ray(p, {Number(a), Number(b), Number(7)});
    if (found) return *found;
    a += 17;
    b -= 31;
  }
}

}  // namespace watertight::verdict
