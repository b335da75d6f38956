// SPDX-License-Identifier: GPL-3.0-or-later
#include "surfaces/tessellate_boundary.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "surfaces/face_senses.h"
#include "surfaces/sample_edge.h"
#include "surfaces/tessellate_face.h"

namespace watertight::surfaces {
namespace {

constexpr int kMostSamplings = 8;    // of sampling edges whose chords cross
constexpr int kMostForDistance = 2;  // of sampling edges because triangles beside them are far off
constexpr double kLatticeShare = 0.01;
constexpr double kEdgeShare =
    0.5;  // of the chord, for edges: triangles beside them are farther off
constexpr int kFinestLattice = -9;
constexpr int kCoarsestLattice = 3;
constexpr double kLargestCoordinate = 4503599627370496.0;  // 2^52 steps

using Position = std::array<std::int64_t, 3>;

Error fail(ErrorCode code, std::string message) { return Error{code, std::move(message), {}, {}}; }

double power_of_ten(int exponent) {
  double power = 1;
  for (int i = 0; i < std::abs(exponent); ++i) power *= 10;
  return power;
}

/// Metres in steps of a lattice.
double in_steps(double metres, int exponent) {
  return exponent < 0 ? metres * power_of_ten(exponent) : metres / power_of_ten(exponent);
}
double metres_of_step(int exponent) {
  return exponent < 0 ? 1 / power_of_ten(exponent) : power_of_ten(exponent);
}

class Tessellation {
 public:
  Tessellation(const BoundaryRepresentation& solid, const TessellateOptions& options)
      : solid_(solid), options_(options) {}

  Result<TessellatedBoundary> run() {
    if (Status status = prepare(); !status) return status.error();
    for (int round = 1; round <= kMostSamplings; ++round) {
      result_.measures.rounds = round;
      if (Status status = sample_edges(); !status) return status.error();
      if (Status status = mesh_faces(round); !status) return status.error();
      if (!is_too_coarse_) break;
    }
    if (Status status = weld(); !status) return status.error();
    make_rings();
    is_turned_ = wrongly_oriented(solid_.faces.size(), uses_of_edges());
    result_.measures.turned =
        static_cast<std::uint64_t>(std::count(is_turned_.begin(), is_turned_.end(), true));
    add_shells();
    add_strips();
    return std::move(result_);
  }

 private:
  Status prepare() {
    const double chord = options_.chord;
    if (!(chord > 0) || !std::isfinite(chord)) {
      return fail(ErrorCode::invalid_argument, "the chord is not a positive number of metres");
    }
    int exponent = options_.lattice_exponent.value_or(kCoarsestLattice);
    if (exponent < kFinestLattice || exponent > kCoarsestLattice) {
      return fail(ErrorCode::invalid_argument,
                  "the lattice is no power of ten from 1e-9 to 1000 metres");
    }
    while (!options_.lattice_exponent && exponent > kFinestLattice &&
           metres_of_step(exponent) > kLatticeShare * chord) {
      --exponent;
    }
    result_.lattice_exponent = exponent;
    // Rounding moves a vertex by half the diagonal of a cell at most.
    const double rounding = std::sqrt(0.75) * metres_of_step(result_.lattice_exponent);
    if (rounding >= chord) {
      return fail(ErrorCode::invalid_argument, "the lattice is too coarse for the chord");
    }
    chord_ = chord - rounding;
    finer_.assign(solid_.edges.size(), 1);
    return check_indices();
  }

  Status check_indices() const {
    for (const BoundaryEdge& edge : solid_.edges) {
      if (edge.start >= solid_.vertices.size() || edge.end >= solid_.vertices.size()) {
        return fail(ErrorCode::malformed, "an edge names a vertex that there is not");
      }
    }
    for (const BoundaryFace& face : solid_.faces) {
      for (const EdgeLoop& loop : face.loops) {
        for (const OrientedEdge& oriented : loop) {
          if (oriented.edge >= solid_.edges.size()) {
            return fail(ErrorCode::malformed, "a loop names an edge that there is not");
          }
        }
      }
    }
    for (const std::vector<Index>& shell : solid_.shells) {
      for (const Index face : shell) {
        if (face >= solid_.faces.size()) {
          return fail(ErrorCode::malformed, "a shell names a face that there is not");
        }
      }
    }
    return Done{};
  }

  Position position_of(const Vector3& place) const {
    Position position{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis] = std::llround(in_steps(place[axis], result_.lattice_exponent));
    }
    return position;
  }

  bool is_in_range(const Vector3& place) const {
    return std::all_of(place.begin(), place.end(), [&](double x) {
      return std::abs(in_steps(x, result_.lattice_exponent)) < kLargestCoordinate;
    });
  }

  Status sample_edges() {
    pool_ = {};
    for (const Vector3& vertex : solid_.vertices) pool_.add(vertex);
    samples_.assign(solid_.edges.size(), {});
    result_.measures.samples = solid_.vertices.size();
    for (Index edge = 0; edge < solid_.edges.size(); ++edge) {
      auto points =
          sample_edge(solid_, edge, kEdgeShare * chord_ / finer_[edge], options_.most_triangles);
      if (!points) return std::move(points).error();
      result_.measures.gap = std::max(result_.measures.gap, points->gap);
      EdgeSamples& samples = samples_[edge];
      samples.push_back(solid_.edges[edge].start);
      // Points that the lattice makes equal are one.
      Position last = position_of(solid_.vertices[solid_.edges[edge].start]);
      const Position end = position_of(solid_.vertices[solid_.edges[edge].end]);
      for (const Vector3& place : points->inner) {
        const Position position = position_of(place);
        if (position == last || position == end) continue;
        samples.push_back(pool_.add(place));
        last = position;
      }
      samples.push_back(solid_.edges[edge].end);
      result_.measures.samples += samples.size() - 2;
      if (pool_.size() > options_.most_triangles) {
        return fail(ErrorCode::limit_exceeded, "the edges of a solid need more than " +
                                                   std::to_string(options_.most_triangles) +
                                                   " points for this chord");
      }
    }
    return Done{};
  }

  /// Lists the curved faces at each vertex that edges have.
  void list_curved_faces() {
    curved_faces_.assign(pool_.size(), {});
    for (Index face = 0; face < solid_.faces.size(); ++face) {
      if (!solid_.faces[face].surface) continue;
      for (const EdgeLoop& loop : solid_.faces[face].loops) {
        for (const OrientedEdge& oriented : loop) {
          for (const Index vertex : samples_[oriented.edge]) {
            std::vector<Index>& faces = curved_faces_[vertex];
            if (faces.empty() || faces.back() != face) faces.push_back(face);
          }
        }
      }
    }
  }

  Status mesh_faces(int round) {
    list_curved_faces();
    triangles_.assign(solid_.faces.size(), {});
    result_.left_out.clear();
    result_.measures.triangles = 0;
    result_.measures.chord_error = 0;
    is_too_coarse_ = false;
    for (Index f = 0; f < solid_.faces.size(); ++f) {
      const BoundaryFace& face = solid_.faces[f];
      if (!face.unreadable.empty()) {
        result_.left_out.push_back({face.name, face.unreadable});
        continue;
      }
      if (!face.surface) continue;
      auto mesh = tessellate_face(face, samples_, {f, curved_faces_}, solid_.tolerance, chord_,
                                  options_.most_triangles, pool_);
      if (!mesh && mesh.error().code == ErrorCode::limit_exceeded) return mesh.error();
      if (!mesh) {
        result_.left_out.push_back({face.name, mesh.error().message});
        continue;
      }
      const bool has_crossing = !mesh->crossing.empty();
      if (has_crossing ? round == kMostSamplings : mesh->triangles.empty()) {
        result_.left_out.push_back({face.name, "its loops cross or touch on the surface"});
        continue;
      }
      if (has_crossing || (round <= kMostForDistance && !mesh->coarse.empty())) {
        for (const Index edge : has_crossing ? mesh->crossing : mesh->coarse) finer_[edge] *= 4;
        is_too_coarse_ = true;
        if (has_crossing) return Done{};
        continue;
      }
      result_.measures.gap = std::max(result_.measures.gap, mesh->gap);
      result_.measures.chord_error = std::max(result_.measures.chord_error, mesh->chord_error);
      result_.measures.triangles += mesh->triangles.size();
      triangles_[f] = std::move(mesh->triangles);
      if (result_.measures.triangles > options_.most_triangles) {
        return fail(ErrorCode::limit_exceeded, "a solid needs more than " +
                                                   std::to_string(options_.most_triangles) +
                                                   " triangles for this chord");
      }
    }
    return Done{};
  }

  /// Numbers the positions of all vertices; equal ones are one.
  Status weld() {
    std::vector<Position> positions(pool_.size());
    for (Index vertex = 0; vertex < pool_.size(); ++vertex) {
      if (!is_in_range(pool_.place(vertex))) {
        return fail(ErrorCode::limit_exceeded, "a vertex is too far away for the lattice");
      }
      positions[vertex] = position_of(pool_.place(vertex));
    }
    std::vector<Index> order(pool_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      return positions[a] != positions[b] ? positions[a] < positions[b] : a < b;
    });
    number_.assign(pool_.size(), kNone);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const bool is_new = i == 0 || positions[order[i]] != positions[order[i - 1]];
      if (is_new) result_.positions.push_back(positions[order[i]]);
      number_[order[i]] = static_cast<Index>(result_.positions.size() - 1);
    }
    return Done{};
  }

  void add_shells() {
    result_.measures.faces = solid_.faces.size();
    result_.measures.edges = solid_.edges.size();
    for (const std::vector<Index>& shell : solid_.shells) {
      for (const Index face : shell) {
        if (!solid_.faces[face].unreadable.empty()) continue;
        if (solid_.faces[face].surface) {
          add_triangles(face);
        } else {
          add_polygon(face);
        }
      }
      result_.arrays.end_shell();
      turn_outwards(result_.arrays.shell_offsets.size() == 2);
    }
  }

  /// Turns the last shell over if it is inside out: a cavity encloses a negative volume.
  void turn_outwards(bool is_outer) {
    SolidArrays& arrays = result_.arrays;
    const Index first_facet = *(arrays.shell_offsets.end() - 2);
    const Index first_ring = arrays.facet_offsets[first_facet];
    const Index first = arrays.ring_offsets[first_ring];
    if (first == arrays.ring_vertices.size()) return;
    const Position& origin = result_.positions[arrays.ring_vertices[first]];
    const auto corner = [&](Index at) {
      const Position& own = result_.positions[arrays.ring_vertices[at]];
      return Vector3{static_cast<double>(own[0] - origin[0]),
                     static_cast<double>(own[1] - origin[1]),
                     static_cast<double>(own[2] - origin[2])};
    };
    double volume = 0;
    for (Index r = first_ring; r + 1 < arrays.ring_offsets.size(); ++r) {
      const Index begin = arrays.ring_offsets[r];
      for (Index i = begin + 1; i + 1 < arrays.ring_offsets[r + 1]; ++i) {
        volume += dot(corner(begin), cross(corner(i), corner(i + 1)));
      }
    }
    if (is_outer ? volume >= 0 : volume <= 0) return;
    for (Index r = first_ring; r + 1 < arrays.ring_offsets.size(); ++r) {
      std::reverse(arrays.ring_vertices.begin() + arrays.ring_offsets[r],
                   arrays.ring_vertices.begin() + arrays.ring_offsets[r + 1]);
    }
  }

  /// Makes the rings of planar faces; the first one is exterior, the others turn the other way.
  void make_rings() {
    rings_.resize(solid_.faces.size());
    for (Index f = 0; f < solid_.faces.size(); ++f) {
      const BoundaryFace& face = solid_.faces[f];
      if (face.surface || !face.unreadable.empty()) continue;
      std::vector<std::vector<Index>>& rings = rings_[f];
      for (const EdgeLoop& loop : face.loops) {
        // A ring of two vertices is a slit, which has no part in the boundary.
        std::vector<Index> ring = ring_of(loop);
        if (ring.size() >= 3) rings.push_back(std::move(ring));
      }
      const bool has_outer = face.outer && rings.size() == face.loops.size();
      std::size_t outer = has_outer ? *face.outer : 0;
      for (std::size_t i = 1; !has_outer && i < rings.size(); ++i) {
        if (length(area_of(rings[i])) > length(area_of(rings[outer]))) outer = i;
      }
      if (outer < rings.size()) std::swap(rings[0], rings[outer]);
      for (std::size_t i = 1; i < rings.size(); ++i) {
        if (dot(area_of(rings[0]), area_of(rings[i])) <= 0) continue;
        std::reverse(rings[i].begin(), rings[i].end());
      }
    }
  }

  using DirectedEdge = std::pair<Index, Index>;

  /// The edges around a face, each once in its direction; sorted.
  std::vector<DirectedEdge> border_of(Index face) const {
    std::vector<DirectedEdge> edges;
    for (const Triangle& t : triangles_[face]) {
      for (std::size_t k = 0; k < 3; ++k) {
        edges.emplace_back(number_[t[k]], number_[t[(k + 1) % 3]]);
      }
    }
    for (const std::vector<Index>& ring : rings_[face]) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        edges.emplace_back(ring[i], ring[(i + 1) % ring.size()]);
      }
    }
    std::sort(edges.begin(), edges.end());
    std::vector<DirectedEdge> border;
    for (const DirectedEdge& edge : edges) {
      if (!std::binary_search(edges.begin(), edges.end(), DirectedEdge{edge.second, edge.first})) {
        border.push_back(edge);
      }
    }
    return border;
  }

  std::vector<std::vector<EdgeUse>> uses_of_edges() const {
    std::vector<std::vector<EdgeUse>> uses(solid_.edges.size());
    for (Index face = 0; face < solid_.faces.size(); ++face) {
      const std::vector<DirectedEdge> border = border_of(face);
      const auto has = [&](Index from, Index to) {
        return std::binary_search(border.begin(), border.end(), DirectedEdge{from, to});
      };
      for (const EdgeLoop& loop : solid_.faces[face].loops) {
        for (const OrientedEdge& oriented : loop) {
          const EdgeSamples& samples = samples_[oriented.edge];
          std::size_t i = 0;
          while (i + 2 < samples.size() && number_[samples[i]] == number_[samples[i + 1]]) ++i;
          const Index from = number_[samples[i]];
          const Index to = number_[samples[i + 1]];
          if (has(from, to) || has(to, from)) uses[oriented.edge].push_back({face, has(from, to)});
        }
      }
    }
    return uses;
  }

  void add_triangles(Index face) {
    const auto first = static_cast<Index>(result_.arrays.facet_offsets.size() - 1);
    for (const Triangle& triangle : triangles_[face]) {
      Triangle t{number_[triangle[0]], number_[triangle[1]], number_[triangle[2]]};
      if (is_turned_[face]) std::swap(t[1], t[2]);
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      result_.arrays.ring_vertices.insert(result_.arrays.ring_vertices.end(), t.begin(), t.end());
      result_.arrays.end_ring();
      result_.arrays.end_facet();
    }
    curved_.push_back({face, first, static_cast<Index>(result_.arrays.facet_offsets.size() - 1)});
  }

  /// Makes the strips of curved faces, whose triangles are the way round that they stay.
  void add_strips() {
    const SolidArrays& arrays = result_.arrays;
    TriangleShapes shapes;
    for (const CurvedFacets& facets : curved_) {
      std::vector<Triangle> triangles;
      for (Index facet = facets.begin; facet < facets.end; ++facet) {
        const auto corner =
            arrays.ring_vertices.begin() + arrays.ring_offsets[arrays.facet_offsets[facet]];
        triangles.push_back({corner[0], corner[1], corner[2]});
      }
      auto strips = shapes.add(triangles, result_.positions);
      if (options_.keeps_strips) {
        result_.strips.push_back({solid_.faces[facets.face].name, std::move(strips)});
      }
    }
    result_.measures.strips = shapes.strips();
    result_.measures.indices = shapes.indices();
    result_.measures.mean_least_angle = shapes.mean_least_angle();
    result_.measures.worst_least_angle = shapes.worst_least_angle();
  }

  std::vector<Index> ring_of(const EdgeLoop& loop) const {
    std::vector<Index> ring;
    for (const OrientedEdge& oriented : loop) {
      const EdgeSamples& samples = samples_[oriented.edge];
      for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
        const Index vertex = number_[samples[oriented.is_forward ? i : samples.size() - 1 - i]];
        if (ring.empty() || ring.back() != vertex) ring.push_back(vertex);
      }
    }
    if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    return ring;
  }

  /// Twice the area of a ring as a vector, in squared steps.
  Vector3 area_of(const std::vector<Index>& ring) const {
    if (ring.empty()) return {};
    Vector3 sum{};
    const auto corner = [&](std::size_t i) {
      const Position& first = result_.positions[ring[0]];
      const Position& own = result_.positions[ring[i % ring.size()]];
      return Vector3{static_cast<double>(own[0] - first[0]), static_cast<double>(own[1] - first[1]),
                     static_cast<double>(own[2] - first[2])};
    };
    for (std::size_t i = 0; i < ring.size(); ++i) sum = sum + cross(corner(i), corner(i + 1));
    return sum;
  }

  void add_polygon(Index face) {
    if (rings_[face].empty()) return;
    for (std::vector<Index>& ring : rings_[face]) {
      if (is_turned_[face]) std::reverse(ring.begin(), ring.end());
      result_.arrays.ring_vertices.insert(result_.arrays.ring_vertices.end(), ring.begin(),
                                          ring.end());
      result_.arrays.end_ring();
    }
    result_.arrays.end_facet();
  }

  /// The facets [begin, end) of a curved face.
  struct CurvedFacets {
    Index face = kNone;
    Index begin = 0;
    Index end = 0;
  };

  const BoundaryRepresentation& solid_;
  const TessellateOptions& options_;
  double chord_ = 0;           // what rounding leaves of the chord
  std::vector<double> finer_;  // edge -> by how much its chord is shortened
  VertexPool pool_;
  std::vector<EdgeSamples> samples_;
  std::vector<std::vector<Index>> curved_faces_;        // vertex -> faces
  std::vector<std::vector<Triangle>> triangles_;        // by face
  std::vector<std::vector<std::vector<Index>>> rings_;  // by face, of planar ones: positions
  std::vector<Index> number_;                           // vertex of the pool -> position
  bool is_too_coarse_ = false;                          // edges need more points
  std::vector<bool> is_turned_;                         // by face
  std::vector<CurvedFacets> curved_;
  TessellatedBoundary result_;
};

}  // namespace

Result<TessellatedBoundary> tessellate(const BoundaryRepresentation& solid,
                                       const TessellateOptions& options) {
  return Tessellation(solid, options).run();
}

}  // namespace watertight::surfaces
