// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: Verbree & Si 2008, section 3.1 (validation by a constrained Delaunay
// tetrahedralization and its regions).
// Departures: nothing an engine says is believed. The complex is proved to be embedded and convex,
// facets are proved to be unions of faces, and only then regions are flooded.
//
// The order of the checks matters: faults that a wrong engine can cause are looked for before
// faults that only a wrong solid can cause.
#include "delaunay/certificate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "delaunay/cancellation.h"
#include "delaunay/canonical/sort_by_vertices.h"
#include "delaunay/certificate/complex.h"
#include "delaunay/certificate/facet_surface.h"
#include "geometry/disjoint_sets.h"
#include "geometry/measures.h"
#include "geometry/predicates/predicates.h"
#include "tessellate/flatness.h"

namespace watertight::delaunay {
namespace {

/// The relative rounding error of one term of the sums of volumes: at most 32 operations.
constexpr double kVolumeArithmetic = 32 * 0x1p-53;

struct Refusal {
  CertificateRefusal refusal = CertificateRefusal::none;
  std::string detail;
  Index facet = kNone;
};
using Checked = std::optional<Refusal>;

/// A face of the complex that belongs to a facet, turned as the facet declares it.
struct OrientedFace {
  Index face = kNone;  // index into Complex::faces
  Index facet = kNone;
  Index outer = kNone;  // the tetrahedron to which the declared normal points; kNone: the outside
  Index inner = kNone;
};

/// An edge of a face. The corners of face f are numbered 3 f, 3 f + 1, 3 f + 2.
struct FaceEdge {
  Triangle key{};     // the smaller vertex, the larger vertex, the corner at the smaller one
  Index at_high = 0;  // the corner at the larger vertex
  Index shell = 0;
  bool is_same_edge(const FaceEdge& other) const {
    return key[0] == other.key[0] && key[1] == other.key[1] && shell == other.shell;
  }
};

class Examination {
 public:
  Examination(const Solid& solid, const tessellate::FacetTriangles& canonical,
              Certificate& certificate, const CancelPoll& is_cancelled)
      : solid_(solid),
        canonical_(canonical),
        certificate_(certificate),
        data_(certificate.tetrahedralization),
        cancellation_(is_cancelled) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double largest = 0;
      for (const Point& p : solid.vertices()) {
        largest = std::max(largest, std::fabs(p[static_cast<int>(axis)]));
      }
      unit_[axis] = largest > 0 ? std::ldexp(1.0, std::ilogb(largest)) : 1;
    }
  }

  Checked run() {
    using Step = Checked (Examination::*)();
    for (const Step step :
         {&Examination::check_indices, &Examination::check_points, &Examination::check_complex,
          &Examination::check_facets, &Examination::check_regions, &Examination::check_orientation,
          &Examination::check_interior, &Examination::check_cavities, &Examination::check_manifold,
          &Examination::check_volume}) {
      if (Checked refused = (this->*step)()) return refused;
      if (cancellation_.is_wanted()) return cancelled();
    }
    return std::nullopt;
  }

 private:
  static Checked refuse(CertificateRefusal refusal, std::string detail, Index facet = kNone) {
    return Refusal{refusal, std::move(detail), facet};
  }

  static Checked cancelled() {
    return refuse(CertificateRefusal::cancelled, "cancelled by the caller");
  }

  Checked check_indices() {
    const std::size_t points = data_.points.size();
    if (data_.input_count != solid_.vertex_count() || points < data_.input_count ||
        canonical_.first.size() != std::size_t{solid_.facet_count()} + 1) {
      return refuse(CertificateRefusal::vertex_missing, "the number of input vertices differs");
    }
    for (const geometry::Tetrahedron& t : data_.tetrahedra) {
      for (const Index v : t) {
        if (v >= points) {
          return refuse(CertificateRefusal::not_a_complex,
                        "a tetrahedron has a corner that is not a vertex");
        }
      }
    }
    return std::nullopt;
  }

  Checked check_complex() {
    std::optional<ComplexFault> fault = build_complex(data_, complex_);
    if (!fault) fault = check_convex(data_, complex_);
    if (!fault) return std::nullopt;
    return refuse(fault->kind == ComplexFault::Kind::not_convex ? CertificateRefusal::not_convex
                                                                : CertificateRefusal::not_a_complex,
                  fault->detail);
  }

  /// Checks that no input vertex was moved, every point is used, and no two points are equal.
  Checked check_points() {
    for (Index v = 0; v < data_.input_count; ++v) {
      if (data_.points[v] != solid_.vertices()[v]) {
        return refuse(CertificateRefusal::vertex_missing,
                      "vertex " + std::to_string(v) + " was moved");
      }
    }
    std::vector<char> is_used(data_.points.size(), 0);
    for (const geometry::Tetrahedron& t : data_.tetrahedra) {
      for (const Index v : t) is_used[v] = 1;
    }
    for (Index v = 0; v < is_used.size(); ++v) {
      if (is_used[v] == 0) {
        return refuse(CertificateRefusal::vertex_missing,
                      "vertex " + std::to_string(v) + " is in no tetrahedron");
      }
    }
    std::vector<Point> sorted = data_.points;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      return refuse(CertificateRefusal::vertex_missing, "two vertices are equal");
    }
    return std::nullopt;
  }

  /// Checks that each facet is a union of faces, and no face belongs to two facets or to none.
  Checked check_facets() {
    std::vector<ConstrainedFace> faces = data_.constrained;
    std::sort(faces.begin(), faces.end(), [](const ConstrainedFace& a, const ConstrainedFace& b) {
      return std::pair(a.facet, a.vertices) < std::pair(b.facet, b.vertices);
    });
    if (!faces.empty() && faces.back().facet >= solid_.facet_count()) {
      return refuse(CertificateRefusal::foreign_face, "a constrained face belongs to no facet");
    }
    std::vector<Index> places;  // constrained face -> face of the complex
    places.reserve(faces.size());
    for (const ConstrainedFace& face : faces) {
      places.push_back(complex_.find(face.vertices));
      if (places.back() == kNone) {
        return refuse(CertificateRefusal::facet_not_conforming,
                      "a constrained face is not a face of the tetrahedralization", face.facet);
      }
    }
    constraint_of_.assign(complex_.faces.size(), kNone);
    FacetSurfaces surfaces(solid_, canonical_, data_, unit_);
    std::size_t steps = 0;
    auto begin = faces.begin();
    for (Index facet = 0; facet < solid_.facet_count(); ++facet) {
      auto end = begin;
      if (cancellation_.is_due_and_wanted(1 + steps)) return cancelled();
      while (end != faces.end() && end->facet == facet) ++end;
      const auto checked = surfaces.check(facet, {begin, end});
      if (const auto* fault = std::get_if<FacetFault>(&checked)) {
        return refuse(CertificateRefusal::facet_not_conforming,
                      "facet " + std::to_string(facet) + ": " + fault->reason, facet);
      }
      const auto& surface = std::get<FacetSurface>(checked);
      const auto first = static_cast<std::size_t>(begin - faces.begin());
      const auto own = std::span(std::as_const(places)).subspan(first, surface.faces.size());
      if (Checked refused = take(facet, surface, own)) return refused;
      steps = surface.faces.size();
      begin = end;
    }
    return std::nullopt;
  }

  /// Takes the faces of a facet. Element i of `places` is face i in the complex.
  Checked take(Index facet, const FacetSurface& surface, std::span<const Index> places) {
    for (std::size_t i = 0; i < surface.faces.size(); ++i) {
      const Triangle& t = surface.faces[i];
      const Index place = places[i];
      const ComplexFace& face = complex_.faces[place];
      if (constraint_of_[place] != kNone) {
        return refuse(CertificateRefusal::not_a_boundary, "a face belongs to two facets", facet);
      }
      constraint_of_[place] = static_cast<Index>(oriented_.size());
      // The declared normal of (a, b, c) points to `above` if (a, b, c) is the sorted order,
      // rotated.
      const bool is_sorted =
          t[0] < t[1] ? (t[1] < t[2] || t[2] < t[0]) : (t[1] < t[2] && t[2] < t[0]);
      oriented_.push_back(
          {place, facet, is_sorted ? face.above : face.below, is_sorted ? face.below : face.above});
    }
    certificate_.largest_deviation =
        std::max(certificate_.largest_deviation, surface.largest_deviation);
    volume_slack_ += surface.volume_slack;
    if (!surface.follows_canonical && !tessellate::is_flat(solid_, facet)) {
      certificate_.refilled_facets.push_back(facet);
    }
    return std::nullopt;
  }

  /// Checks that the faces of each shell are a 2-manifold: every edge has two of them, and the
  /// faces around each vertex form one fan. The exact tests check the canonical triangles for this;
  /// this step checks the faces themselves.
  Checked check_manifold() {
    std::vector<FaceEdge> edges;
    edges.reserve(3 * oriented_.size());
    std::vector<Index> seen_in(data_.points.size(), kNone);  // vertex -> last shell that has it
    std::size_t vertices = 0;  // the sum of the numbers of vertices of the shells
    Index shell = 0;
    for (Index f = 0; f < oriented_.size(); ++f) {
      while (oriented_[f].facet >= solid_.facets_of(shell).end) ++shell;
      const Triangle& t = complex_.faces[oriented_[f].face].vertices;
      for (const Index v : t) vertices += std::exchange(seen_in[v], shell) == shell ? 0 : 1;
      edges.push_back({{t[0], t[1], 3 * f}, 3 * f + 1, shell});
      edges.push_back({{t[0], t[2], 3 * f}, 3 * f + 2, shell});
      edges.push_back({{t[1], t[2], 3 * f + 1}, 3 * f + 2, shell});
    }
    sort_by_vertices(edges, data_.points.size(), [](const FaceEdge& edge) { return edge.key; });
    return check_fans(edges, vertices);
  }

  /// Checks that every edge has two faces and every vertex one fan. Requires edges sorted by their
  /// ends, then by shell.
  Checked check_fans(std::span<const FaceEdge> edges, std::size_t vertices) {
    geometry::DisjointSets corners(edges.size());
    for (std::size_t i = 0; i < edges.size(); i += 2) {
      const bool is_pair = i + 1 < edges.size() && edges[i + 1].is_same_edge(edges[i]) &&
                           (i + 2 == edges.size() || !edges[i + 2].is_same_edge(edges[i]));
      if (!is_pair) {
        return refuse(CertificateRefusal::not_a_manifold,
                      "an edge of the boundary does not have two faces of its shell",
                      oriented_[edges[i].at_high / 3].facet);
      }
      corners.join(edges[i].key[2], edges[i + 1].key[2]);
      corners.join(edges[i].at_high, edges[i + 1].at_high);
    }
    std::size_t fans = 0;
    for (Index corner = 0; corner < edges.size(); ++corner) {
      if (corners.root(corner) == corner) ++fans;
    }
    if (fans == vertices) return std::nullopt;
    return refuse(CertificateRefusal::not_a_manifold,
                  "the faces of a shell around a vertex do not form one fan");
  }

  /// The region of a tetrahedron; kNone stands for the outside.
  Index region(Index tetrahedron) const {
    return region_of_[tetrahedron == kNone ? data_.tetrahedra.size() : tetrahedron];
  }

  /// Finds the regions: sets of tetrahedra that unconstrained faces connect. Region 0 is the
  /// outside. Each constrained face must separate an odd region from an even one.
  Checked check_regions() {
    const auto outside = static_cast<Index>(data_.tetrahedra.size());
    geometry::DisjointSets sets(data_.tetrahedra.size() + 1);
    for (std::size_t f = 0; f < complex_.faces.size(); ++f) {
      if (constraint_of_[f] != kNone) continue;
      const ComplexFace& face = complex_.faces[f];
      sets.join(face.above == kNone ? outside : face.above,
                face.below == kNone ? outside : face.below);
    }
    std::vector<Index> region_of_root(data_.tetrahedra.size() + 1, kNone);
    region_of_root[sets.root(outside)] = 0;
    region_of_.assign(data_.tetrahedra.size() + 1, 0);
    region_count_ = 1;
    for (Index t = 0; t < outside; ++t) {
      Index& region = region_of_root[sets.root(t)];
      if (region == kNone) region = region_count_++;
      region_of_[t] = region;
    }
    return check_parity();
  }

  Checked check_parity() {
    std::vector<std::vector<Index>> crossings(region_count_);  // region -> oriented faces
    for (Index i = 0; i < oriented_.size(); ++i) {
      const Index outer = region(oriented_[i].outer);
      const Index inner = region(oriented_[i].inner);
      if (outer == inner) {
        return refuse(CertificateRefusal::not_a_boundary,
                      "a face has the same region on both sides", oriented_[i].facet);
      }
      crossings[outer].push_back(i);
      crossings[inner].push_back(i);
    }
    parity_.assign(region_count_, kNone);
    parity_[0] = 0;
    std::vector<Index> pending{0};
    while (!pending.empty()) {
      const Index current = pending.back();
      pending.pop_back();
      for (const Index i : crossings[current]) {
        const Index outer = region(oriented_[i].outer);
        const Index next = outer == current ? region(oriented_[i].inner) : outer;
        if (parity_[next] == kNone) {
          parity_[next] = 1 - parity_[current];
          pending.push_back(next);
        } else if (parity_[next] == parity_[current]) {
          return refuse(CertificateRefusal::not_a_boundary,
                        "inside and outside cannot be distinguished", oriented_[i].facet);
        }
      }
    }
    return std::nullopt;
  }

  Checked check_orientation() {
    for (const OrientedFace& face : oriented_) {
      if (parity_[region(face.outer)] != 0) {
        return refuse(CertificateRefusal::wrong_orientation,
                      "the normal of facet " + std::to_string(face.facet) + " points inward",
                      face.facet);
      }
    }
    return std::nullopt;
  }

  /// The first facet of the part of the interior with the fewest facets. The result does not depend
  /// on the tetrahedralization.
  Index facet_of_smallest_part() const {
    std::vector<std::vector<Index>> facets(region_count_);
    for (const OrientedFace& face : oriented_) facets[region(face.inner)].push_back(face.facet);
    std::vector<Index> smallest;
    for (Index part = 0; part < region_count_; ++part) {
      if (parity_[part] != 1) continue;
      std::sort(facets[part].begin(), facets[part].end());
      facets[part].erase(std::unique(facets[part].begin(), facets[part].end()), facets[part].end());
      const bool is_first = smallest.empty();
      if (is_first || std::pair(facets[part].size(), facets[part].front()) <
                          std::pair(smallest.size(), smallest.front())) {
        smallest = std::move(facets[part]);
      }
    }
    return smallest.front();
  }

  Checked check_interior() {
    const auto interior = std::count(parity_.begin(), parity_.end(), Index{1});
    if (interior == 0) return refuse(CertificateRefusal::not_a_boundary, "there is no interior");
    if (interior > 1) {
      return refuse(CertificateRefusal::interior_disconnected,
                    "the interior has " + std::to_string(interior) +
                        " parts; this facet bounds the one with the fewest facets",
                    facet_of_smallest_part());
    }
    certificate_.is_interior.resize(data_.tetrahedra.size());
    for (Index t = 0; t < data_.tetrahedra.size(); ++t) {
      certificate_.is_interior[t] = parity_[region_of_[t]] == 1;
    }
    return std::nullopt;
  }

  /// Checks that the exterior shell bounds the outside, and each interior shell one cavity of its
  /// own.
  Checked check_cavities() {
    std::vector<Index> shell_of_region(region_count_, kNone);
    std::vector<Index> region_of_shell(solid_.shell_count(), kNone);
    for (const OrientedFace& face : oriented_) {
      const Index outer = region(face.outer);
      const Index shell = solid_.shell_of(face.facet);
      if (shell_of_region[outer] == kNone && region_of_shell[shell] == kNone) {
        shell_of_region[outer] = shell;
        region_of_shell[shell] = outer;
      } else if (shell_of_region[outer] != shell || region_of_shell[shell] != outer) {
        return refuse(CertificateRefusal::cavity_mismatch,
                      "shell " + std::to_string(shell) + " does not bound one region of its own",
                      face.facet);
      }
    }
    for (Index shell = 0; shell < solid_.shell_count(); ++shell) {
      if (region_of_shell[shell] == kNone || (shell == 0) != (region_of_shell[shell] == 0)) {
        return refuse(CertificateRefusal::cavity_mismatch,
                      shell == 0 ? "the exterior shell does not bound the outside"
                                 : "inner shell " + std::to_string(shell) + " bounds no cavity");
      }
    }
    return std::nullopt;
  }

  /// Compares six times the volume, in coordinates divided by the unit: that of the canonical
  /// triangles, exactly, with the sum over interior tetrahedra. The two may differ by the rounding
  /// of Steiner points, by how facets that are not planar are filled, and by the arithmetic of the
  /// sum.
  Checked check_volume() {
    std::vector<Point> scaled = data_.points;
    for (Point& p : scaled) p = {p.x / unit_[0], p.y / unit_[1], p.z / unit_[2]};
    const double expected = expected_volume(scaled);
    double sum = 0;
    double terms = 0;
    for (Index i = 0; i < data_.tetrahedra.size(); ++i) {
      if (!certificate_.is_interior[i]) continue;
      const geometry::Tetrahedron& t = data_.tetrahedra[i];
      std::array<std::array<double, 3>, 3> m{};
      for (std::size_t row = 0; row < 3; ++row) {
        for (int axis = 0; axis < 3; ++axis) {
          m[row][static_cast<std::size_t>(axis)] = scaled[t[row + 1]][axis] - scaled[t[0]][axis];
        }
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double first = m[0][k] * m[1][(k + 1) % 3] * m[2][(k + 2) % 3];
        const double second = m[0][k] * m[1][(k + 2) % 3] * m[2][(k + 1) % 3];
        sum += first - second;
        terms += std::fabs(first) + std::fabs(second);
      }
    }
    // Each term has a rounding of its own, and each addition that of the sum so far.
    const double additions = 6 * (static_cast<double>(data_.tetrahedra.size()) + 1) * 0x1p-53;
    const double slack =
        volume_slack_ + terms * (kVolumeArithmetic + additions) + std::fabs(expected) * 0x1p-52;
    // Not ">": a volume that is not a number must fail.
    if (!(std::fabs(sum - expected) <= slack)) {
      return refuse(CertificateRefusal::volume_mismatch,
                    "the tetrahedra's volume differs from the boundary's");
    }
    return std::nullopt;
  }

  double expected_volume(std::span<const Point> scaled) const {
    // Doubles of any size could overflow, so they are scaled first. Integers cannot overflow, and
    // unscaled ones take less time.
    if (solid_.lattice().kind == LatticeKind::float64) {
      return geometry::six_volume(scaled.first(data_.input_count), canonical_.triangles);
    }
    return geometry::six_volume(solid_.vertices(), canonical_.triangles) / unit_[0] / unit_[1] /
           unit_[2];
  }

  const Solid& solid_;
  const tessellate::FacetTriangles& canonical_;
  Certificate& certificate_;
  const Tetrahedralization& data_;
  std::array<double, 3> unit_{1, 1, 1};
  Complex complex_;
  std::vector<OrientedFace> oriented_;
  std::vector<Index> constraint_of_;  // face of the complex -> index in oriented_
  std::vector<Index> region_of_;      // tetrahedron (and at the end the outside) -> region
  std::vector<Index> parity_;         // region -> 0 outside or cavity, 1 interior
  Index region_count_ = 0;
  double volume_slack_ = 0;
  Cancellation cancellation_;
};

}  // namespace

CertificateResult check_certificate(const Solid& solid, const tessellate::FacetTriangles& facets,
                                    Tetrahedralization tetrahedralization, Rung rung,
                                    const CancelPoll& is_cancelled) {
  CertificateResult result;
  result.certificate.rung = rung;
  result.certificate.tetrahedralization = std::move(tetrahedralization);
  const Checked refused = Examination(solid, facets, result.certificate, is_cancelled).run();
  result.refilled_facets = result.certificate.refilled_facets;
  if (refused) {
    result.refusal = refused->refusal;
    result.detail = refused->detail;
    result.facet = refused->facet;
    result.certificate = Certificate{};
  }
  return result;
}

}  // namespace watertight::delaunay
