// SPDX-License-Identifier: GPL-3.0-or-later
//
// Damages certificates of many solids at many positions: each damaged certificate must be refused,
// and for the right reason.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>
#include <set>
#include <string>

#include "delaunay/canonical_delaunay.h"
#include "delaunay/ladder.h"
#include "geometry/predicates/predicates.h"
#include "unit/delaunay/sample_solids.h"

namespace watertight {
namespace {

using samples::Shape;
using Refusals = std::set<delaunay::CertificateRefusal>;

constexpr delaunay::CertificateRefusal kNonconforming =
    delaunay::CertificateRefusal::facet_not_conforming;
constexpr delaunay::CertificateRefusal kNoComplex = delaunay::CertificateRefusal::not_a_complex;
constexpr delaunay::CertificateRefusal kNotConvex = delaunay::CertificateRefusal::not_convex;
constexpr delaunay::CertificateRefusal kVertex = delaunay::CertificateRefusal::vertex_missing;

/// The number of positions that are tried in each list.
constexpr std::size_t kPositions = 60;

struct Proof {
  std::string name;
  Shape shape;
  Solid solid;
  tessellate::FacetTriangles canonical;
  delaunay::Tetrahedralization data;

  delaunay::CertificateRefusal judge(const delaunay::Tetrahedralization& other) const {
    return delaunay::check_certificate(solid, canonical, other, delaunay::Rung::patch).refusal;
  }
};

delaunay::EngineWorkers& engines() {
  static delaunay::EngineWorkers workers;
  return workers;
}

Shape schoenhardt_in_a_cavity() {
  // Schoenhardt's prism as a cavity of a box: the certificate has Steiner points and an interior
  // shell.
  Shape shape = samples::box({-2000, -2000, -1000}, {2000, 2000, 2000});
  const Shape prism = samples::schoenhardt();
  const auto first = Index(shape.vertices.size());
  shape.vertices.insert(shape.vertices.end(), prism.vertices.begin(), prism.vertices.end());
  samples::Shell shell = prism.shells[0];
  for (samples::Facet& facet : shell) {
    std::reverse(facet[0].begin(), facet[0].end());
    for (Index& v : facet[0]) v += first;
  }
  shape.shells.push_back(shell);
  return shape;
}

Shape touching_pits_in_a_cavity() {
  // Small cavities lie above the rims and, inside the pits, below the rims: edges that leave a
  // vertex where rims touch need Steiner points.
  Shape shape = samples::box({-100, -100, -100}, {200, 200, 200});
  const Shape pits = samples::touching_pits();
  const auto first = Index(shape.vertices.size());
  shape.vertices.insert(shape.vertices.end(), pits.vertices.begin(), pits.vertices.end());
  shape.shells.push_back(pits.shells[0]);
  for (samples::Facet& facet : shape.shells.back()) {
    for (samples::Ring& ring : facet) {
      std::reverse(ring.begin(), ring.end());
      for (Index& v : ring) v += first;
    }
  }
  for (const Point& p : {Point{14, 5, 41}, {14, 9, 38}, {43, 15, 41}, {43, 18, 38}, {18, 17, 38}}) {
    samples::add_box(shape, p, {p.x + 1, p.y + 1, p.z + 1}, true);
  }
  return shape;
}

Shape boxes_in_a_box(int cavities) {
  Shape shape = samples::box({0, 0, 0}, {60.0 * cavities + 20, 90, 90});
  for (int i = 0; i < cavities; ++i) {
    samples::add_box(shape, {60.0 * i + 20, 25, 25}, {60.0 * i + 60, 65, 60}, true);
  }
  return shape;
}

/// Adds a solid with the certificate that the ladder makes, from the given rung on.
void add(std::vector<Proof>& proofs, const std::string& name, const Shape& shape,
         delaunay::Rung first) {
  Proof proof{name, shape, samples::make_solid(shape), {}, {}};
  proof.canonical = tessellate::triangulate_facets(proof.solid);
  delaunay::LadderOptions options;
  options.first_rung = first;
  delaunay::LadderResult result =
      delaunay::climb_ladder(proof.solid, proof.canonical, &engines(), options);
  INFO(name);
  REQUIRE(result.certificate.has_value());
  proof.data = std::move(result.certificate->tetrahedralization);
  REQUIRE(proof.judge(proof.data) == delaunay::CertificateRefusal::none);
  proofs.push_back(std::move(proof));
}

const std::vector<Proof>& proofs() {
  static const std::vector<Proof> made = [] {
    std::vector<Proof> list;
    add(list, "cube", samples::box({0, 0, 0}, {64, 64, 64}), delaunay::Rung::delaunay);
    add(list, "tunnel", samples::tunnelled_box(), delaunay::Rung::delaunay);
    add(list, "cavities", boxes_in_a_box(3), delaunay::Rung::delaunay);
    add(list, "prism", samples::prism({{0, 0}, {90, 10}, {40, 80}}, 50), delaunay::Rung::delaunay);
    add(list, "touching pits", samples::touching_pits(), delaunay::Rung::delaunay);
    if (engines().cgal() == nullptr) return list;
    add(list, "tunnel by CGAL", samples::tunnelled_box(), delaunay::Rung::patch);
    add(list, "Schoenhardt", samples::schoenhardt(), delaunay::Rung::patch);
    add(list, "Schoenhardt by triangles", samples::schoenhardt(), delaunay::Rung::triangles_scaled);
    add(list, "Schoenhardt in a cavity", schoenhardt_in_a_cavity(), delaunay::Rung::patch);
    add(list, "touching pits by CGAL", samples::touching_pits(), delaunay::Rung::patch);
    add(list, "touching pits in a cavity", touching_pits_in_a_cavity(), delaunay::Rung::patch);
    add(list, "stairs", samples::stairs(6), delaunay::Rung::patch);
    return list;
  }();
  return made;
}

/// Calls `change` with a copy of each proof's data and with some positions below count(data). The
/// changed data must be refused for one of the reasons. `change` returns false to skip a position.
template <class Count, class Change>
void check_refused(const Refusals& reasons, Count count, Change change) {
  std::size_t changes = 0;
  for (const Proof& proof : proofs()) {
    const std::size_t size = count(proof.data);
    const std::size_t step = std::max<std::size_t>(1, size / kPositions);
    for (std::size_t i = 0; i < size; i += step) {
      delaunay::Tetrahedralization damaged = proof.data;
      if (!change(damaged, i, proof)) continue;
      ++changes;
      const delaunay::CertificateRefusal refusal = proof.judge(damaged);
      INFO(proof.name << ", position " << i << ": " << delaunay::to_string(refusal));
      CHECK(reasons.contains(refusal));
    }
  }
  CHECK(changes > 10);
}

std::size_t face_count(const delaunay::Tetrahedralization& data) { return data.constrained.size(); }
std::size_t tetrahedron_count(const delaunay::Tetrahedralization& data) {
  return data.tetrahedra.size();
}
std::size_t input_count(const delaunay::Tetrahedralization& data) { return data.input_count; }
std::size_t steiner_count(const delaunay::Tetrahedralization& data) {
  return data.points.size() - data.input_count;
}

TEST_CASE("mutated certificate: a dropped face is refused") {
  check_refused({kNonconforming}, face_count, [](auto& data, std::size_t i, const Proof&) {
    data.constrained.erase(data.constrained.begin() + long(i));
    return true;
  });
}

TEST_CASE("mutated certificate: a wrong facet number is refused") {
  for (const Index shift : {Index{1}, Index{2}, Index{5}}) {
    check_refused({kNonconforming}, face_count,
                  [shift](auto& data, std::size_t i, const Proof& proof) {
                    const Index count = proof.solid.facet_count();
                    const Index facet = data.constrained[i].facet;
                    data.constrained[i].facet = (facet + shift) % count;
                    return data.constrained[i].facet != facet;
                  });
  }
  check_refused({delaunay::CertificateRefusal::foreign_face}, face_count,
                [](auto& data, std::size_t i, const Proof& proof) {
                  data.constrained[i].facet = proof.solid.facet_count() + Index(i);
                  return true;
                });
}

TEST_CASE("mutated certificate: two facets that change numbers are refused") {
  check_refused({kNonconforming}, face_count, [](auto& data, std::size_t i, const Proof& proof) {
    const Index a = data.constrained[i].facet;
    const Index b = (a + 1) % proof.solid.facet_count();
    for (delaunay::ConstrainedFace& face : data.constrained) {
      face.facet = face.facet == a ? b : face.facet == b ? a : face.facet;
    }
    return true;
  });
}

TEST_CASE("mutated certificate: a face that names no face of a tetrahedron is refused") {
  check_refused({kNonconforming}, face_count, [](auto& data, std::size_t i, const Proof&) {
    // The corners of the constrained face stay in the boundary; one of them becomes a corner of
    // another face.
    auto& corners = data.constrained[i].vertices;
    const Index other =
        data.constrained[(i + data.constrained.size() / 2) % data.constrained.size()].vertices[1];
    if (std::find(corners.begin(), corners.end(), other) != corners.end()) return false;
    corners[0] = other;
    return true;
  });
}

TEST_CASE("mutated certificate: a flipped tetrahedron is refused") {
  check_refused({kNoComplex}, tetrahedron_count, [](auto& data, std::size_t i, const Proof&) {
    std::swap(data.tetrahedra[i][i % 3], data.tetrahedra[i][3]);
    return true;
  });
}

TEST_CASE("mutated certificate: a dropped tetrahedron is refused") {
  check_refused({kNotConvex, kVertex}, tetrahedron_count,
                [](auto& data, std::size_t i, const Proof&) {
                  data.tetrahedra.erase(data.tetrahedra.begin() + long(i));
                  return true;
                });
}

TEST_CASE("mutated certificate: a tetrahedron with another corner is refused") {
  check_refused({kNoComplex, kNotConvex, kVertex}, tetrahedron_count,
                [](auto& data, std::size_t i, const Proof&) {
                  geometry::Tetrahedron& t = data.tetrahedra[i];
                  const Index other = Index((t[0] + 1 + i) % data.points.size());
                  if (std::find(t.begin(), t.end(), other) != t.end()) return false;
                  t[i % 4] = other;
                  return true;
                });
}

TEST_CASE("mutated certificate: a double cover is refused") {
  for (const Proof& proof : proofs()) {
    delaunay::Tetrahedralization twice = proof.data;
    const auto count = long(twice.tetrahedra.size());
    twice.tetrahedra.reserve(2 * std::size_t(count));
    std::copy_n(proof.data.tetrahedra.begin(), count, std::back_inserter(twice.tetrahedra));
    CHECK(proof.judge(twice) == kNoComplex);

    // The second sheet has points of its own, at the same places or beside them.
    for (const double aside : {0.0, 0.25, 1e6}) {
      twice = proof.data;
      const auto first = Index(twice.points.size());
      for (const Point& p : proof.data.points) twice.points.push_back({p.x + aside, p.y, p.z});
      for (const geometry::Tetrahedron& t : proof.data.tetrahedra) {
        twice.tetrahedra.push_back({t[0] + first, t[1] + first, t[2] + first, t[3] + first});
      }
      INFO(proof.name << " " << aside);
      CHECK(proof.judge(twice) == (aside == 0 ? kVertex : kNotConvex));
    }
  }
}

/// Replaces tetrahedron i by the four tetrahedra that its centre makes with its faces. Returns
/// false if rounding makes one of them flat.
bool split(delaunay::Tetrahedralization& data, std::size_t i) {
  const geometry::Tetrahedron t = data.tetrahedra[i];
  Point centre{};
  for (const Index v : t) {
    for (int axis = 0; axis < 3; ++axis) centre[axis] += data.points[v][axis] / 4;
  }
  const auto number = Index(data.points.size());
  data.points.push_back(centre);
  for (std::size_t k = 0; k < 4; ++k) {
    geometry::Tetrahedron part = t;
    part[k] = number;
    if (geometry::orient3d(data.points[part[0]], data.points[part[1]], data.points[part[2]],
                           data.points[part[3]]) <= 0) {
      return false;
    }
    k == 0 ? data.tetrahedra[i] = part : data.tetrahedra.emplace_back(part);
  }
  return true;
}

/// The four faces of a tetrahedron, each with sorted corners.
std::array<Triangle, 4> faces_of(const geometry::Tetrahedron& t) {
  std::array<Triangle, 4> faces{};
  for (std::size_t f = 0; f < 4; ++f) {
    for (std::size_t i = 0, used = 0; i < 4; ++i) {
      if (i != f) faces[f][used++] = t[i];
    }
    std::sort(faces[f].begin(), faces[f].end());
  }
  return faces;
}

/// A constrained face among the faces of the tetrahedron, or the end of the list.
auto constrained_face(delaunay::Tetrahedralization& data, const geometry::Tetrahedron& t) {
  const auto faces = faces_of(t);
  return std::find_if(data.constrained.begin(), data.constrained.end(), [&](const auto& face) {
    return std::find(faces.begin(), faces.end(), face.vertices) != faces.end();
  });
}

TEST_CASE("certificate accepts a needless Steiner point inside a tetrahedron") {
  // The data from which the bubbles below start must be accepted.
  for (const Proof& proof : proofs()) {
    delaunay::Tetrahedralization data = proof.data;
    REQUIRE(split(data, data.tetrahedra.size() / 2));
    CHECK(proof.judge(data) == delaunay::CertificateRefusal::none);
  }
}

TEST_CASE("mutated certificate: a bubble of new tetrahedra with a facet number is refused") {
  // The facet passes around a new tetrahedron: the complex is sound and the boundary is closed.
  check_refused({kNonconforming}, tetrahedron_count, [](auto& data, std::size_t i, const Proof&) {
    const auto at = constrained_face(data, data.tetrahedra[i]);
    if (at == data.constrained.end() || !split(data, i)) return false;
    const delaunay::ConstrainedFace base = *at;
    data.constrained.erase(at);
    const auto tip = Index(data.points.size() - 1);
    for (std::size_t k = 0; k < 3; ++k) {
      data.constrained.push_back({{base.vertices[k], base.vertices[(k + 1) % 3], tip}, base.facet});
    }
    return true;
  });
  // The facet has all faces of a new tetrahedron besides its own.
  check_refused({kNonconforming}, tetrahedron_count, [](auto& data, std::size_t i, const Proof&) {
    if (!split(data, i)) return false;
    for (const Triangle& face : faces_of(data.tetrahedra.back())) {
      data.constrained.push_back({face, Index(i % 3)});
    }
    return true;
  });
}

TEST_CASE("mutated certificate: a displaced Steiner vertex is refused") {
  REQUIRE(engines().cgal() != nullptr);
  for (const double distance : {1e-8, 1e-3, 1.0, 1e6}) {
    check_refused({kNonconforming, kNoComplex, kNotConvex}, steiner_count,
                  [distance](auto& data, std::size_t i, const Proof&) {
                    // The direction is in no plane of the samples.
                    Point& p = data.points[data.input_count + i];
                    p = {p.x + 0.37 * distance, p.y - 0.61 * distance, p.z + 0.83 * distance};
                    return true;
                  });
  }
}

TEST_CASE("mutated certificate: a moved input vertex is refused") {
  for (const double distance : {0x1p-40, 1.0, std::nan("")}) {
    check_refused({kVertex}, input_count, [distance](auto& data, std::size_t i, const Proof&) {
      data.points[i][int(i % 3)] += distance;
      return data.points[i] != Point{} || std::isnan(distance);
    });
  }
}

TEST_CASE("mutated certificate: a dropped input vertex is refused") {
  // The Delaunay tetrahedralization of the other vertices is sound, except that one vertex is
  // missing.
  for (const Proof& proof : proofs()) {
    for (Index v = 0; v < proof.data.input_count; ++v) {
      std::vector<Point> others(proof.data.points);
      others.erase(others.begin() + v);
      auto delaunay = delaunay::canonical_delaunay(others);
      REQUIRE(delaunay.has_value());
      delaunay::Tetrahedralization damaged = proof.data;
      damaged.tetrahedra = delaunay->tetrahedra;
      for (geometry::Tetrahedron& t : damaged.tetrahedra) {
        for (Index& corner : t) corner += corner >= v ? 1 : 0;
      }
      CHECK(proof.judge(damaged) == kVertex);

      damaged = proof.data;  // the point of the vertex is removed as well
      damaged.points.erase(damaged.points.begin() + v);
      --damaged.input_count;
      CHECK(proof.judge(damaged) == kVertex);
    }
  }
}

TEST_CASE("mutated certificate: a duplicated vertex is refused") {
  check_refused({kVertex}, tetrahedron_count, [](auto& data, std::size_t i, const Proof&) {
    Index& corner = data.tetrahedra[i][i % 4];
    data.points.push_back(data.points[corner]);
    corner = Index(data.points.size() - 1);
    return true;
  });
  check_refused({kVertex}, input_count, [](auto& data, std::size_t i, const Proof&) {
    data.points.push_back(data.points[i]);  // the new point is in no tetrahedron
    return true;
  });
}

TEST_CASE("mutated certificate: a solid with a facet or a shell turned over is refused") {
  for (const Proof& proof : proofs()) {
    Index facet_number = 0;
    for (std::size_t s = 0; s < proof.shape.shells.size(); ++s) {
      Shape shell_turned = proof.shape;
      for (samples::Facet& facet : shell_turned.shells[s]) {
        for (samples::Ring& ring : facet) std::reverse(ring.begin(), ring.end());
      }
      const Solid turned = samples::make_solid(shell_turned);
      CHECK(delaunay::check_certificate(turned, tessellate::triangulate_facets(turned), proof.data,
                                        delaunay::Rung::patch)
                .refusal == delaunay::CertificateRefusal::wrong_orientation);
      for (std::size_t f = 0; f < proof.shape.shells[s].size(); ++f, ++facet_number) {
        Shape facet_turned = proof.shape;
        for (samples::Ring& ring : facet_turned.shells[s][f])
          std::reverse(ring.begin(), ring.end());
        const Solid other = samples::make_solid(facet_turned);
        const delaunay::CertificateResult result = delaunay::check_certificate(
            other, tessellate::triangulate_facets(other), proof.data, delaunay::Rung::patch);
        INFO(proof.name << " facet " << facet_number);
        CHECK(result.refusal == delaunay::CertificateRefusal::wrong_orientation);
        CHECK(result.facet == facet_number);
      }
    }
  }
}

TEST_CASE("mutated certificate: other rings than those that touch are refused") {
  // The faces are unchanged, but facet 1 declares other rings.
  using Rings = samples::Facet;
  const auto joined = [](const samples::Ring& a, const samples::Ring& b, Index at) {
    samples::Ring ring = a;  // the ring runs along a, then along b, and so passes `at` twice
    samples::Ring other = b;
    std::rotate(ring.begin(), std::find(ring.begin(), ring.end(), at), ring.end());
    std::rotate(other.begin(), std::find(other.begin(), other.end(), at), other.end());
    ring.insert(ring.end(), other.begin(), other.end());
    return ring;
  };
  const Shape shape = samples::touching_pits();
  const Rings rings = shape.shells[0][1];
  REQUIRE(rings.size() == 4);
  const auto reversed = [](samples::Ring ring) {
    std::reverse(ring.begin(), ring.end());
    return ring;
  };
  const Index shared = 8;
  const std::vector<Rings> others = {{joined(rings[0], rings[1], 4), rings[2], rings[3]},
                                     {joined(rings[0], rings[3], 7), rings[1], rings[2]},
                                     {rings[0], joined(rings[1], rings[2], shared), rings[3]},
                                     {rings[0], rings[1], rings[2]},
                                     {rings[0], rings[1], rings[3]},
                                     {rings[0], rings[2], rings[3]},
                                     {rings[0], rings[1], rings[1], rings[2], rings[3]},
                                     {rings[0], rings[1], reversed(rings[2]), rings[3]},
                                     {rings[0], reversed(rings[1]), reversed(rings[2]), rings[3]},
                                     {reversed(rings[0]), rings[1], rings[2], rings[3]}};
  std::size_t judged = 0;
  for (const Proof& proof : proofs()) {
    if (proof.shape.shells[0] != shape.shells[0]) continue;
    ++judged;
    for (std::size_t i = 0; i < others.size(); ++i) {
      Shape other = shape;
      other.shells[0][1] = others[i];
      const Solid solid = samples::make_solid(other);
      const delaunay::CertificateResult result =
          delaunay::check_certificate(solid, proof.canonical, proof.data, delaunay::Rung::patch);
      INFO(proof.name << " " << i << ": " << result.detail);
      CHECK(result.refusal == kNonconforming);
      CHECK(result.facet == 1);
    }
  }
  CHECK(judged >= 1);
}

TEST_CASE("mutated certificate: a pit's mouth that belongs to the facet is refused") {
  // The mouth of a pit that touches another ring, if the mouth is a face of the tetrahedra.
  const Shape shape = samples::touching_pits();
  std::size_t closed = 0;
  for (const Proof& proof : proofs()) {
    if (proof.shape.shells[0] != shape.shells[0]) continue;
    for (std::size_t r = 1; r < 4; ++r) {
      const samples::Ring& rim = shape.shells[0][1][r];
      Triangle mouth{rim[0], rim[1], rim[2]};
      std::sort(mouth.begin(), mouth.end());
      const auto& tetrahedra = proof.data.tetrahedra;
      if (std::none_of(tetrahedra.begin(), tetrahedra.end(), [&](const geometry::Tetrahedron& t) {
            const auto faces = faces_of(t);
            return std::find(faces.begin(), faces.end(), mouth) != faces.end();
          })) {
        continue;
      }
      ++closed;
      delaunay::Tetrahedralization damaged = proof.data;
      damaged.constrained.push_back({mouth, 1});
      CHECK(proof.judge(damaged) == kNonconforming);
      Shape without = shape;  // the ring of the mouth is not declared either
      without.shells[0][1].erase(without.shells[0][1].begin() + long(r));
      const Solid solid = samples::make_solid(without);
      CHECK(delaunay::check_certificate(solid, tessellate::triangulate_facets(solid), damaged,
                                        delaunay::Rung::patch)
                .refusal != delaunay::CertificateRefusal::none);
    }
  }
  CHECK(closed >= 1);
}

TEST_CASE("mutated certificate: random numbers in place of indices are never accepted") {
  std::mt19937 generator(7);
  for (const Proof& proof : proofs()) {
    for (int round = 0; round < 120; ++round) {
      delaunay::Tetrahedralization damaged = proof.data;
      const auto changes = 1 + generator() % 4;
      for (auto i = changes; i > 0; --i) {
        const bool is_face = generator() % 2 == 0;
        const auto value = Index(generator() % (damaged.points.size() + 2));
        auto& face = damaged.constrained[generator() % damaged.constrained.size()];
        auto& tetrahedron = damaged.tetrahedra[generator() % damaged.tetrahedra.size()];
        Index& place = is_face ? face.vertices[generator() % 3] : tetrahedron[generator() % 4];
        place = value;
      }
      const bool is_changed = damaged.tetrahedra != proof.data.tetrahedra ||
                              damaged.constrained != proof.data.constrained;
      if (is_changed) CHECK(proof.judge(damaged) != delaunay::CertificateRefusal::none);
    }
  }
}

TEST_CASE("a cancelled certificate reports the cancellation and nothing else") {
  for (const Proof& proof : proofs()) {
    const delaunay::CertificateResult result = delaunay::check_certificate(
        proof.solid, proof.canonical, proof.data, delaunay::Rung::patch, [] { return true; });
    CHECK(result.refusal == delaunay::CertificateRefusal::cancelled);
    CHECK(result.certificate.tetrahedralization.tetrahedra.empty());
  }
}

}  // namespace
}  // namespace watertight
