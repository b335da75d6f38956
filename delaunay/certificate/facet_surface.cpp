// SPDX-License-Identifier: GPL-3.0-or-later
//
// Steps for one facet:
//   1. every edge of the facet's faces belongs to two of these faces, on opposite sides, or to one
//      (the boundary);
//   2. the faces are connected by edges and have the Euler characteristic of a disc with as many
//      holes as there are interior rings, so there is no handle, bubble or pinch. Rings may touch
//      in vertices: each such touch joins two components of the boundary into one;
//   3. when the faces are turned consistently, the boundary runs along the rings: each ring edge is
//      a chain of edges through points that lie on the ring edge, in order: Steiner points but for
//      rounding, vertices of other shells exactly. Each edge of the boundary is in one chain;
//   4. each vertex of the faces is a vertex of the rings, or a vertex of another shell that lies
//      exactly on a canonical triangle (shells may touch in points), or a Steiner point in the
//      facet's slab (the space between the two parallels of its fitted plane that hold the rings)
//      but for rounding;
//   5. in projection the faces cover no more area than the canonical triangles: together with step
//      3 this excludes folds.
#include "delaunay/certificate/facet_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "delaunay/shell_contacts.h"
#include "geometry/mesh/edge_sides.h"
#include "geometry/predicates/predicates.h"

namespace watertight::delaunay {
namespace {

/// The relative rounding error of one term of the sums below: at most 32 operations.
constexpr double kPlaneArithmetic = 32 * 0x1p-53;

}  // namespace

std::array<double, 3> steiner_rounding(std::span<const Point> vertices) {
  std::array<double, 3> rounding{};
  for (const Point& p : vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rounding[axis] = std::max(rounding[axis], std::fabs(p[static_cast<int>(axis)]));
    }
  }
  for (double& value : rounding) value *= kSteinerUnits * 0x1p-53;
  return rounding;
}

/// Normal and centre in coordinates divided by the unit; `half_width` is the largest
/// |normal . (ring vertex - centre)|. The *height* of a point p is normal . (p - centre).
struct FacetSurfaces::Plane {
  std::array<double, 3> normal{};
  std::array<double, 3> centre{};
  double half_width = 0;
  double slack = 0;         // the largest rounding error of the height of a Steiner point
  double world_length = 0;  // a height divided by this is a distance in world units
};

/// The faces of a facet with their edges. One mesh takes facet after facet and keeps its memory.
class FacetSurfaces::Mesh {
 public:
  void take(std::span<const ConstrainedFace> faces) {
    faces_.clear();
    vertices_.clear();
    by_vertex_.clear();
    for (const ConstrainedFace& face : faces) {
      faces_.push_back(face.vertices);
      vertices_.insert(vertices_.end(), face.vertices.begin(), face.vertices.end());
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    sort_sides();
  }

  const std::vector<Triangle>& faces() const { return faces_; }
  const std::vector<Index>& vertices() const { return vertices_; }
  /// The directed boundary edges, sorted. Requires turn() before.
  const std::vector<std::pair<Index, Index>>& boundary() const { return boundary_; }

  /// Turns the faces consistently. Returns the fault as a clause, or null.
  const char* turn() {
    if (!link()) return "an edge of its faces has more than two of them";
    is_seen_.assign(faces_.size(), 0);
    pending_.assign(1, 0);
    is_seen_[0] = 1;
    std::size_t seen = 1;
    while (!pending_.empty()) {
      const Index f = pending_.back();
      pending_.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const Index g = neighbour_[f][k];
        if (g == kNone) continue;
        const bool agrees = runs(g, faces_[f][(k + 1) % 3], faces_[f][k]);
        if (is_seen_[g] != 0 && !agrees) return "its faces cannot be turned consistently";
        if (is_seen_[g] != 0) continue;
        if (!agrees) flip(g);
        is_seen_[g] = 1;
        ++seen;
        pending_.push_back(g);
      }
    }
    if (seen != faces_.size()) return "its faces are not connected";
    collect_boundary();
    return nullptr;
  }

  void reverse() {
    for (Triangle& t : faces_) std::swap(t[1], t[2]);
    for (auto& [from, to] : boundary_) std::swap(from, to);
    std::sort(boundary_.begin(), boundary_.end());
  }

  /// True if the faces are a disc with `rings` - 1 holes, whose rings may touch in vertices.
  ///
  /// Take the vertices apart, one for each fan of faces: a surface of genus g whose boundary has as
  /// many components as can be walked from fan to fan. Putting t vertices back where the boundary
  /// leaves a vertex more than once, and u elsewhere, lowers the Euler characteristic to
  /// 2 - 2g - components - t - u. If that is 2 - rings, and rings - t components are walked
  /// (each touch joins two), then g and u are 0.
  bool is_disc(std::size_t rings) {
    std::size_t touches = 0;
    for (std::size_t i = 0; i + 1 < boundary_.size(); ++i) {
      if (boundary_[i].first == boundary_[i + 1].first) ++touches;
    }
    return vertices_.size() + faces_.size() + rings == edge_count_ + 2 &&
           boundary_walks() + touches == rings;
  }

  /// The vertices that are joined to `vertex` by an edge of a face, as (vertex, other).
  std::span<const std::pair<Index, Index>> neighbours(Index vertex) {
    if (by_vertex_.empty()) list_neighbours();
    const auto begin =
        std::lower_bound(by_vertex_.begin(), by_vertex_.end(), std::pair(vertex, Index{0}));
    const auto end = std::upper_bound(begin, by_vertex_.end(), std::pair(vertex, kNone));
    return {begin, end};
  }
  bool has_edge(Index a, Index b) const {
    const std::uint64_t edge = edge_of(a, b);
    const auto at =
        std::lower_bound(sides_.begin(), sides_.end(), edge,
                         [](const Side& side, std::uint64_t key) { return side.edge < key; });
    return at != sides_.end() && at->edge == edge;
  }

 private:
  /// One side of the edge between two vertices.
  struct Side {
    std::uint64_t edge = 0;  // the smaller vertex in the upper half, the larger in the lower
    Index half_edge = 0;
    bool has_edge_of(const Side& other) const { return edge == other.edge; }
  };

  static std::uint64_t edge_of(Index a, Index b) {
    const auto [low, high] = std::minmax(a, b);
    return std::uint64_t{low} << 32 | high;
  }

  void sort_sides() {
    sides_.clear();
    for (Index h = 0; h < 3 * faces_.size(); ++h) {
      const Triangle& t = faces_[h / 3];
      sides_.push_back({edge_of(t[h % 3], t[(h + 1) % 3]), h});
    }
    std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
      return a.edge != b.edge ? a.edge < b.edge : a.half_edge < b.half_edge;
    });
  }

  /// Few facets need the neighbours of a vertex: those with a diagonal that is not an edge.
  void list_neighbours() {
    geometry::for_each_edge(std::span(std::as_const(sides_)), [&](std::span<const Side> sides) {
      const auto low = static_cast<Index>(sides[0].edge >> 32);
      const auto high = static_cast<Index>(sides[0].edge);
      by_vertex_.emplace_back(low, high);
      by_vertex_.emplace_back(high, low);
    });
    std::sort(by_vertex_.begin(), by_vertex_.end());
  }

  /// Finds the neighbours of each face. Returns false if an edge has more than two faces. Requires
  /// the faces as given, not turned.
  bool link() {
    neighbour_.assign(faces_.size(), {kNone, kNone, kNone});
    edge_count_ = 0;
    bool is_surface = true;
    geometry::for_each_edge(std::span(std::as_const(sides_)), [&](std::span<const Side> edge) {
      is_surface = is_surface && edge.size() <= 2;
      if (edge.size() == 2) {
        neighbour_of(edge[0].half_edge) = edge[1].half_edge / 3;
        neighbour_of(edge[1].half_edge) = edge[0].half_edge / 3;
      }
      ++edge_count_;
    });
    return is_surface;
  }

  Index& neighbour_of(Index half_edge) { return neighbour_[half_edge / 3][half_edge % 3]; }

  bool runs(Index face, Index from, Index to) const {
    const std::size_t k = corner(face, from);
    return k < 3 && faces_[face][(k + 1) % 3] == to;
  }

  /// The index of a vertex in a face; 3 if the face does not have the vertex.
  std::size_t corner(Index face, Index vertex) const {
    const Triangle& t = faces_[face];
    return static_cast<std::size_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
  }

  /// The number of closed walks along the boundary. At the end of a boundary edge a walk turns
  /// through the fan of faces beside it, and goes on with the boundary edge at the end of the fan.
  std::size_t boundary_walks() {
    const auto place = [&](Index from, Index to) {
      return static_cast<std::size_t>(
          std::lower_bound(boundary_.begin(), boundary_.end(), std::pair(from, to)) -
          boundary_.begin());
    };
    next_.assign(boundary_.size(), 0);
    for (Index f = 0; f < faces_.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (neighbour_[f][k] != kNone) continue;
        const Index pivot = faces_[f][(k + 1) % 3];
        Index face = f;
        std::size_t at = (k + 1) % 3;
        while (neighbour_[face][at] != kNone) {
          face = neighbour_[face][at];
          at = corner(face, pivot);
        }
        next_[place(faces_[f][k], pivot)] = place(pivot, faces_[face][(at + 1) % 3]);
      }
    }
    std::size_t walks = 0;
    is_seen_.assign(next_.size(), 0);
    for (std::size_t start = 0; start < next_.size(); ++start) {
      if (is_seen_[start] != 0) continue;
      ++walks;
      for (std::size_t at = start; is_seen_[at] == 0; at = next_[at]) is_seen_[at] = 1;
    }
    return walks;
  }

  /// (a, b, c) becomes (a, c, b): its edges ab, bc, ca become ac, cb, ba.
  void flip(Index face) {
    std::swap(faces_[face][1], faces_[face][2]);
    std::swap(neighbour_[face][0], neighbour_[face][2]);
  }

  void collect_boundary() {
    boundary_.clear();
    for (Index f = 0; f < faces_.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (neighbour_[f][k] == kNone) boundary_.emplace_back(faces_[f][k], faces_[f][(k + 1) % 3]);
      }
    }
    std::sort(boundary_.begin(), boundary_.end());
  }

  std::vector<Triangle> faces_;
  std::vector<Index> vertices_;
  std::vector<Side> sides_;  // the sides of the faces as given, sorted
  std::vector<std::array<Index, 3>> neighbour_;
  std::vector<std::pair<Index, Index>> by_vertex_;  // empty until neighbours() is asked
  std::vector<std::pair<Index, Index>> boundary_;
  std::vector<std::size_t> next_;  // edge of the boundary -> the edge on which a walk goes on
  std::vector<char> is_seen_;
  std::vector<Index> pending_;
  std::size_t edge_count_ = 0;
};

FacetSurfaces::FacetSurfaces(const Solid& solid, const tessellate::FacetTriangles& canonical,
                             const Tetrahedralization& tetrahedralization,
                             const std::array<double, 3>& unit)
    : solid_(solid),
      canonical_(canonical),
      data_(tetrahedralization),
      unit_(unit),
      rounding_(steiner_rounding(solid.vertices())),
      mesh_(std::make_unique<Mesh>()),
      facet_stamp_(solid.vertex_count(), kNone) {}

FacetSurfaces::~FacetSurfaces() = default;

std::span<const Triangle> FacetSurfaces::canonical_of(Index facet) const {
  return std::span(canonical_.triangles)
      .subspan(canonical_.first[facet], canonical_.first[facet + 1] - canonical_.first[facet]);
}

FacetSurfaces::Plane FacetSurfaces::plane_of(Index facet) const {
  const auto at = [&](Index vertex, std::size_t axis) {
    return data_.points[vertex][static_cast<int>(axis)] / unit_[axis];
  };
  Plane plane;
  std::array<double, 3> terms{};  // the sums of the magnitudes of the terms, for the rounding
  std::array<double, 3> reach{};
  for (const auto& [a, b, c] : canonical_of(facet)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      const double first = (at(b, u) - at(a, u)) * (at(c, v) - at(a, v));
      const double second = (at(b, v) - at(a, v)) * (at(c, u) - at(a, u));
      plane.normal[axis] += first - second;
      terms[axis] += std::fabs(first) + std::fabs(second);
    }
  }
  const IndexRange rings = solid_.rings_of(facet);
  const std::span<const Index> exterior = solid_.ring(rings.begin);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Index v : exterior) {
      plane.centre[axis] += at(v, axis) / static_cast<double>(exterior.size());
    }
  }
  for (Index ring = rings.begin; ring < rings.end; ++ring) {
    for (const Index v : solid_.ring(ring)) {
      double height = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        height += plane.normal[axis] * (at(v, axis) - plane.centre[axis]);
        reach[axis] = std::max(reach[axis], std::fabs(at(v, axis) - plane.centre[axis]));
      }
      plane.half_width = std::max(plane.half_width, std::fabs(height));
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    plane.slack += kPlaneArithmetic * terms[axis] * reach[axis];
    const double scale = unit_[axis] * solid_.lattice().scale(static_cast<int>(axis));
    plane.world_length += (plane.normal[axis] / scale) * (plane.normal[axis] / scale);
  }
  plane.world_length = std::sqrt(plane.world_length);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    plane.slack +=
        std::fabs(plane.normal[axis]) * (rounding_[axis] / unit_[axis] + kPlaneArithmetic);
  }
  return plane;
}

double FacetSurfaces::height(const Plane& plane, Index vertex) const {
  double height = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    height += plane.normal[axis] *
              (data_.points[vertex][static_cast<int>(axis)] / unit_[axis] - plane.centre[axis]);
  }
  return height;
}

std::optional<FacetFault> FacetSurfaces::check_vertices(Index facet, const Plane& plane,
                                                        const Mesh& mesh) {
  const IndexRange rings = solid_.rings_of(facet);
  for (Index ring = rings.begin; ring < rings.end; ++ring) {
    for (const Index v : solid_.ring(ring)) facet_stamp_[v] = facet;
  }
  for (const Index v : mesh.vertices()) {
    if (!is_steiner(v)) {
      if (facet_stamp_[v] != facet && !is_contact(facet, v)) {
        return FacetFault{"its faces use vertex " + std::to_string(v) +
                          ", which is neither on its rings nor exactly on the facet"};
      }
      continue;
    }
    // Not ">": a height that is not a number must fail.
    if (!(std::fabs(height(plane, v)) <= plane.half_width + plane.slack)) {
      return FacetFault{"Steiner point " + std::to_string(v) + " is off its plane"};
    }
  }
  return std::nullopt;
}

/// The largest distance of a Steiner point from the plane, in world units.
double FacetSurfaces::largest_deviation(const Plane& plane, const Mesh& mesh) const {
  double largest = 0;
  if (!(plane.world_length > 0)) return largest;
  for (const Index v : mesh.vertices()) {
    if (!is_steiner(v)) continue;
    largest = std::max(largest, std::fabs(height(plane, v)) / plane.world_length);
  }
  return largest;
}

/// The position of the vertex along the segment, between 0 and 1; nothing if the vertex is not near
/// the segment. The position is measured along the axis in which the segment is longest in terms of
/// the rounding, so that the rounding of the position moves the foot point by no more than one
/// rounding in any axis.
std::optional<double> FacetSurfaces::place_near_segment(Index vertex, Index from, Index to) const {
  const Point& p = data_.points[vertex];
  const Point& a = data_.points[from];
  const Point& b = data_.points[to];
  int along = 0;
  double longest = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const double unit = rounding_[static_cast<std::size_t>(axis)];
    const double length = unit > 0 ? std::fabs(b[axis] - a[axis]) / unit : 0;
    if (length > longest) {
      longest = length;
      along = axis;
    }
  }
  if (!(longest > 0)) return std::nullopt;
  const double place = (p[along] - a[along]) / (b[along] - a[along]);
  for (int axis = 0; axis < 3; ++axis) {
    const double off = std::fabs(p[axis] - a[axis] - place * (b[axis] - a[axis]));
    if (!(off <= 2 * rounding_[static_cast<std::size_t>(axis)])) return std::nullopt;
  }
  return place > 0 && place < 1 ? std::optional(place) : std::nullopt;
}

/// True for an input vertex that lies exactly on the facet: on one of its canonical triangles.
bool FacetSurfaces::is_contact(Index facet, Index vertex) const {
  const int axis = tessellate::facet_projection(solid_, facet).axis;
  const std::span<const Triangle> canonical = canonical_of(facet);
  return std::any_of(canonical.begin(), canonical.end(), [&](const Triangle& t) {
    return is_on_triangle(data_.points, t, data_.points[vertex], axis);
  });
}

/// The position at which a chain along the segment passes the vertex, as place_near_segment() gives
/// it; nothing if the chain may not pass the vertex. A chain may pass a Steiner point near the
/// segment, and another shell's vertex exactly on the segment. Requires the ring vertices in
/// facet_stamp_.
std::optional<double> FacetSurfaces::place_on_chain(Index facet, Index vertex, Index from,
                                                    Index to) const {
  if (!is_steiner(vertex)) {
    if (facet_stamp_[vertex] == facet) return std::nullopt;
    const auto& p = data_.points;
    if (!geometry::is_on_segment(p[from], p[to], p[vertex])) return std::nullopt;
  }
  return place_near_segment(vertex, from, to);
}

/// The edge of the boundary on which a chain along the segment goes on from `current`, as an index
/// into mesh.boundary(), or the size of that list if there is none. Where rings touch, several
/// edges leave a vertex: the one that follows the segment is taken. A single edge is taken without
/// a test.
std::size_t FacetSurfaces::boundary_step(Index facet, const Mesh& mesh, Index current, Index from,
                                         Index to) const {
  const auto& boundary = mesh.boundary();
  const auto begin =
      std::lower_bound(boundary.begin(), boundary.end(), std::pair(current, Index{0}));
  const auto end = std::upper_bound(begin, boundary.end(), std::pair(current, kNone));
  const auto place_of = [&](auto step) {
    return static_cast<std::size_t>(step - boundary.begin());
  };
  if (begin == end) return boundary.size();
  if (end - begin == 1) return place_of(begin);
  // The boundary touches itself at a Steiner point or at a vertex of another shell.
  if (current != from) return boundary.size();
  const auto straight = std::lower_bound(begin, end, std::pair(current, to));
  if (straight != end && straight->second == to) return place_of(straight);
  const auto step = std::find_if(begin, end, [&](const std::pair<Index, Index>& edge) {
    return place_on_chain(facet, edge.second, from, to).has_value();
  });
  return step == end ? boundary.size() : place_of(step);
}

std::optional<FacetFault> FacetSurfaces::check_rings(Index facet, const Mesh& mesh) {
  const auto& boundary = mesh.boundary();
  is_used_.assign(boundary.size(), 0);
  std::size_t used = 0;
  const IndexRange rings = solid_.rings_of(facet);
  for (Index r = rings.begin; r < rings.end; ++r) {
    const std::span<const Index> ring = solid_.ring(r);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Index to = ring[(i + 1) % ring.size()];
      double last = 0;
      Index current = ring[i];
      while (current != to) {
        const std::size_t step = boundary_step(facet, mesh, current, ring[i], to);
        if (step == boundary.size() || is_used_[step] != 0) {
          return FacetFault{"ring edge (" + std::to_string(ring[i]) + ", " + std::to_string(to) +
                            ") is missing"};
        }
        is_used_[step] = 1;
        ++used;
        current = boundary[step].second;
        if (current == to) break;
        const auto place = place_on_chain(facet, current, ring[i], to);
        if (!place || *place <= last) {
          return FacetFault{"ring edge (" + std::to_string(ring[i]) + ", " + std::to_string(to) +
                            ") is not straight"};
        }
        last = *place;
      }
    }
  }
  if (used != boundary.size()) {
    return FacetFault{"its faces have edges of a boundary that are not on its rings"};
  }
  return std::nullopt;
}

std::optional<FacetFault> FacetSurfaces::check_area(Index facet,
                                                    std::span<const Triangle> faces) const {
  const auto axis = static_cast<std::size_t>(tessellate::facet_projection(solid_, facet).axis);
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  const std::array<double, 2> moved{rounding_[u] / unit_[u], rounding_[v] / unit_[v]};
  double slack = 0;
  const auto area = [&](const Triangle& t) {
    std::array<std::array<double, 2>, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = {data_.points[t[k]][static_cast<int>(u)] / unit_[u],
              data_.points[t[k]][static_cast<int>(v)] / unit_[v]};
    }
    const std::array<double, 2> b{p[1][0] - p[0][0], p[1][1] - p[0][1]};
    const std::array<double, 2> c{p[2][0] - p[0][0], p[2][1] - p[0][1]};
    // Each corner may be off by `moved`, which changes the doubled area by at most four times the
    // extents of the triangle times `moved`; the arithmetic changes it by less.
    slack += 4 * ((std::fabs(b[0]) + std::fabs(c[0])) * (moved[1] + kPlaneArithmetic) +
                  (std::fabs(b[1]) + std::fabs(c[1])) * (moved[0] + kPlaneArithmetic) +
                  moved[0] * moved[1]);
    return std::fabs(b[0] * c[1] - b[1] * c[0]);
  };
  double expected = 0;
  double covered = 0;
  for (const Triangle& t : canonical_of(facet)) expected += area(t);
  for (const Triangle& t : faces) covered += area(t);
  // Not ">": an area that is not a number must fail.
  if (!(covered <= expected + slack)) return FacetFault{"its faces fold over each other"};
  return std::nullopt;
}

/// True if edges of the faces lead from `from` to `to` along the straight segment.
bool FacetSurfaces::has_chain(Index facet, Mesh& mesh, Index from, Index to) const {
  double reached = 0;
  Index current = from;
  for (std::size_t step = 0; step < mesh.vertices().size(); ++step) {
    if (mesh.has_edge(current, to)) return true;
    Index next = kNone;
    double nearest = 1;
    for (const auto& [own, candidate] : mesh.neighbours(current)) {
      const auto place = place_on_chain(facet, candidate, from, to);
      if (place && *place > reached && *place < nearest) {
        nearest = *place;
        next = candidate;
      }
    }
    if (next == kNone) return false;
    reached = nearest;
    current = next;
  }
  return false;
}

std::variant<FacetSurface, FacetFault> FacetSurfaces::check(
    Index facet, std::span<const ConstrainedFace> faces) {
  if (canonical_of(facet).empty()) return FacetFault{"it has no canonical triangulation"};
  if (faces.empty()) return FacetFault{"it has no faces"};
  const IndexRange rings = solid_.rings_of(facet);
  if (rings.size() == 1) {
    small_faces_ = small_faces(solid_.ring(rings.begin), canonical_of(facet), faces);
    if (small_faces_.count > 0) {
      FacetSurface surface;
      surface.faces = std::span(small_faces_.triangles).first(small_faces_.count);
      return surface;
    }
  }
  Mesh& mesh = *mesh_;
  mesh.take(faces);
  if (const char* wrong = mesh.turn()) return FacetFault{wrong};
  if (!mesh.is_disc(rings.size())) {
    return FacetFault{"its faces do not form a disc"};
  }
  const Plane plane = plane_of(facet);
  if (auto fault = check_vertices(facet, plane, mesh)) return *std::move(fault);
  if (auto fault = check_rings(facet, mesh)) {
    mesh.reverse();
    if (check_rings(facet, mesh)) return *std::move(fault);
  }
  if (auto fault = check_area(facet, mesh.faces())) return *std::move(fault);
  FacetSurface surface;
  surface.faces = mesh.faces();
  surface.largest_deviation = largest_deviation(plane, mesh);
  surface.volume_slack = 6 * (plane.half_width + plane.slack);
  for (const Triangle& t : canonical_of(facet)) {
    for (std::size_t k = 0; k < 3 && surface.follows_canonical; ++k) {
      surface.follows_canonical = has_chain(facet, mesh, t[k], t[(k + 1) % 3]);
    }
  }
  return surface;
}

}  // namespace watertight::delaunay
