// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the seven decomposition steps and the seven composition steps of Verbree & Si 2008, section
// 4.1.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <set>

#include "codec/mode_bitmap/compose.h"
#include "codec/mode_bitmap/decompose.h"
#include "codec/mode_bitmap/face_marks.h"
#include "codec/sections/coordinates.h"
#include "delaunay/certificate.h"
#include "tests/generated/generated_solids.h"

using namespace watertight;

namespace {

codec::bitmap::BoundaryComplex complex_of(const geometry::CanonicalSolid& solid,
                                          const delaunay::Certificate* certificate = nullptr) {
  auto complex = codec::bitmap::create_cdt(solid, certificate);
  if (!complex) FAIL(to_string(complex.error()));
  return *complex;
}

codec::bitmap::MarkedFaces marked_of(const codec::bitmap::BoundaryComplex& complex) {
  auto marked = codec::bitmap::mark_cdt_faces(complex);
  if (!marked) FAIL(to_string(marked.error()));
  return *marked;
}

delaunay::CanonicalDelaunay delaunay_of(const codec::bitmap::BoundaryComplex& complex) {
  auto delaunay = codec::bitmap::create_delaunay(complex);
  if (!delaunay) FAIL(to_string(delaunay.error()));
  return *delaunay;
}

/// A decomposition, and the sections that a decoder finds in its blob.
struct Stored {
  codec::bitmap::Decomposition parts;
  codec::bitmap::BitmapSections sections;
  explicit Stored(codec::bitmap::Decomposition from) : parts(std::move(from)) {
    sections.vertices = parts.vertices;
    sections.steiner = parts.steiner;
    sections.bitmap_coding = parts.bitmap_coding;
    sections.bitmap = parts.bitmap;
    sections.unrecovered = parts.unrecovered;
    if (parts.facets) {
      sections.facet_coding = parts.facets->coding;
      sections.facets = parts.facets->bytes;
    }
  }
};

Stored stored_schoenhardt(const delaunay::Certificate* certificate) {
  auto parts =
      codec::bitmap::decompose(geometry::canonical_form(generated::schoenhardt()), certificate);
  if (!parts) FAIL(to_string(parts.error()));
  return Stored(std::move(parts).value());
}

}  // namespace

TEST_CASE("decomposition step 1: a CDT covers the boundary with triangles of its nodes") {
  const geometry::CanonicalSolid box = geometry::canonical_form(generated::box());
  const codec::bitmap::BoundaryComplex complex = complex_of(box);
  CHECK(complex.points.size() == 8);
  CHECK(complex.vertex_count == 8);
  CHECK(complex.triangles.size() == 12);
  std::vector<int> triangles_of(6, 0);
  for (const Index facet : complex.facet_of) ++triangles_of[facet];
  CHECK(triangles_of == std::vector<int>{2, 2, 2, 2, 2, 2});
}

TEST_CASE("decomposition step 1: with a certificate the nodes are its nodes, Steiner points last") {
  const delaunay::Certificate certificate = generated::schoenhardt_certificate();
  const geometry::CanonicalSolid solid = geometry::canonical_form(generated::schoenhardt());
  const codec::bitmap::BoundaryComplex complex = complex_of(solid, &certificate);
  REQUIRE(complex.points.size() == 7);
  CHECK(complex.vertex_count == 6);
  CHECK(complex.points[6] == Point{10000.5, 10000.125, 4500});
  CHECK(std::is_sorted(complex.points.begin(), complex.points.begin() + 6));
  // The certificate has source vertices, the complex canonical ones.
  for (std::size_t i = 0; i < complex.triangles.size(); ++i) {
    const auto ring = solid.boundary.solid().ring(complex.facet_of[i]);
    Triangle sorted{ring[0], ring[1], ring[2]};
    std::sort(sorted.begin(), sorted.end());
    CHECK(complex.triangles[i] == sorted);
  }
}

TEST_CASE("decomposition step 2: the nodes are stored apart, integers and doubles exactly") {
  const delaunay::Certificate certificate = generated::schoenhardt_certificate();
  const codec::bitmap::BoundaryComplex complex =
      complex_of(geometry::canonical_form(generated::schoenhardt()), &certificate);
  codec::bitmap::Decomposition result;
  codec::bitmap::store_nodes(complex, result);
  const auto vertices = codec::read_vertices(result.vertices, {});
  const auto steiner = codec::read_steiner_vertices(result.steiner, {});
  REQUIRE(vertices);
  REQUIRE(steiner);
  CHECK(std::equal(vertices->begin(), vertices->end(), complex.points.begin()));
  CHECK(vertices->size() == 6);
  CHECK(*steiner == std::vector<Point>{complex.points[6]});
  // z is an integer, x and y are not: a flag byte, two doubles and two bytes.
  CHECK(result.steiner.size() == 1 + 1 + 8 + 8 + 2);
}

TEST_CASE("decomposition step 3: the CDT faces on the boundary are marked once each, in order") {
  codec::bitmap::BoundaryComplex complex = complex_of(geometry::canonical_form(generated::box()));
  const codec::bitmap::MarkedFaces marked = marked_of(complex);
  CHECK(marked.triangles.size() == 12);
  CHECK(std::is_sorted(marked.triangles.begin(), marked.triangles.end()));
  complex.triangles.push_back(complex.triangles.front());
  complex.facet_of.push_back(complex.facet_of.front());
  const auto doubled = codec::bitmap::mark_cdt_faces(complex);
  REQUIRE_FALSE(doubled);
  CHECK(doubled.error().code == ErrorCode::not_encodable);
}

TEST_CASE("decomposition step 4: the Delaunay tetrahedralization of the nodes has ordered faces") {
  const delaunay::CanonicalDelaunay delaunay =
      delaunay_of(complex_of(geometry::canonical_form(generated::box())));
  CHECK(delaunay.faces.size() == 18);
  CHECK(std::is_sorted(delaunay.faces.begin(), delaunay.faces.end()));
  for (const Triangle& face : delaunay.faces) CHECK((face[0] < face[1] && face[1] < face[2]));
}

TEST_CASE("decomposition step 5: a Delaunay face is marked if it is a marked CDT face") {
  const codec::bitmap::BoundaryComplex complex =
      complex_of(geometry::canonical_form(generated::schoenhardt()));
  const codec::bitmap::MarkedFaces marked = marked_of(complex);
  const delaunay::CanonicalDelaunay delaunay = delaunay_of(complex);
  const std::vector<bool> marks = codec::bitmap::mark_delaunay_faces(marked, delaunay);
  const std::set<Triangle> wanted(marked.triangles.begin(), marked.triangles.end());
  for (std::size_t i = 0; i < marks.size(); ++i) {
    CHECK(marks[i] == wanted.contains(delaunay.faces[i]));
  }
  CHECK(std::count(marks.begin(), marks.end(), true) == 4);
}

TEST_CASE("decomposition step 6: the bitmap is one bit per Delaunay face in either coding") {
  for (const auto& [name, boundary] : generated::all(5)) {
    INFO(name);
    const codec::bitmap::BoundaryComplex complex = complex_of(geometry::canonical_form(boundary));
    const delaunay::CanonicalDelaunay delaunay = delaunay_of(complex);
    const std::vector<bool> marks =
        codec::bitmap::mark_delaunay_faces(marked_of(complex), delaunay);
    const Bytes plain =
        codec::bitmap::write_marks(codec::bitmap::BitCoding::plain, delaunay, marks);
    CHECK(plain.size() == (delaunay.faces.size() + 7) / 8);
    for (const codec::bitmap::BitCoding coding :
         {codec::bitmap::BitCoding::plain, codec::bitmap::BitCoding::arithmetic}) {
      const auto back = codec::bitmap::read_marks(
          codec::bitmap::write_marks(coding, delaunay, marks), coding, delaunay);
      REQUIRE(back);
      CHECK(*back == marks);
    }
    codec::bitmap::Decomposition result;
    codec::bitmap::store_bitmap(delaunay, marks, result);
    CHECK(result.bitmap.size() <= plain.size());
  }
}

TEST_CASE("decomposition step 7: marked CDT faces without a Delaunay face are listed") {
  const codec::bitmap::BoundaryComplex complex =
      complex_of(geometry::canonical_form(generated::schoenhardt()));
  const codec::bitmap::MarkedFaces marked = marked_of(complex);
  const delaunay::CanonicalDelaunay delaunay = delaunay_of(complex);
  codec::bitmap::Decomposition result;
  codec::bitmap::store_unrecovered_faces(marked, delaunay, result);
  const auto unrecovered = codec::bitmap::read_face_list(result.unrecovered, complex.points.size());
  REQUIRE(unrecovered);
  CHECK(unrecovered->size() == 4);
  for (const Triangle& face : *unrecovered) {
    CHECK(std::binary_search(marked.triangles.begin(), marked.triangles.end(), face));
    CHECK_FALSE(std::binary_search(delaunay.faces.begin(), delaunay.faces.end(), face));
  }
  codec::bitmap::Decomposition none;
  const codec::bitmap::BoundaryComplex box = complex_of(geometry::canonical_form(generated::box()));
  codec::bitmap::store_unrecovered_faces(marked_of(box), delaunay_of(box), none);
  CHECK(none.unrecovered.empty());
}

TEST_CASE("composition step 1: the nodes are read, Steiner vertices after the vertices") {
  const delaunay::Certificate certificate = generated::schoenhardt_certificate();
  const Stored stored = stored_schoenhardt(&certificate);
  const auto nodes = codec::bitmap::read_nodes(stored.sections, {});
  REQUIRE(nodes);
  CHECK(nodes->vertex_count == 6);
  CHECK(nodes->points ==
        complex_of(geometry::canonical_form(generated::schoenhardt()), &certificate).points);
  const auto refused = codec::bitmap::read_nodes(stored.sections, Limits{.vertices = 5});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("composition step 2: the same nodes give the same Delaunay tetrahedralization") {
  const delaunay::Certificate certificate = generated::schoenhardt_certificate();
  const auto nodes = codec::bitmap::read_nodes(stored_schoenhardt(&certificate).sections, {});
  REQUIRE(nodes);
  const auto delaunay = codec::bitmap::create_delaunay(*nodes);
  REQUIRE(delaunay);
  const delaunay::CanonicalDelaunay encoder =
      delaunay_of(complex_of(geometry::canonical_form(generated::schoenhardt()), &certificate));
  CHECK(delaunay->faces == encoder.faces);
  CHECK(delaunay->tetrahedra == encoder.tetrahedra);
  codec::bitmap::Nodes flat = *nodes;
  for (Point& p : flat.points) p.z = 0;
  CHECK_FALSE(codec::bitmap::create_delaunay(flat));
  codec::bitmap::Nodes huge = *nodes;
  huge.points[0].x = -0x1p101;
  CHECK_FALSE(codec::bitmap::create_delaunay(huge));
}

TEST_CASE("composition step 3: the bitmap read is the bitmap stored") {
  const Stored stored = stored_schoenhardt(nullptr);
  const codec::bitmap::BoundaryComplex complex =
      complex_of(geometry::canonical_form(generated::schoenhardt()));
  const delaunay::CanonicalDelaunay delaunay = delaunay_of(complex);
  const auto marks = codec::bitmap::read_bitmap(stored.sections, delaunay);
  REQUIRE(marks);
  CHECK(*marks == codec::bitmap::mark_delaunay_faces(marked_of(complex), delaunay));
  codec::bitmap::BitmapSections longer = stored.sections;
  Bytes bytes(stored.parts.bitmap);
  bytes.insert(bytes.end(), 5, 0);
  longer.bitmap = bytes;
  CHECK_FALSE(codec::bitmap::read_bitmap(longer, delaunay));
}

TEST_CASE("composition steps 4 and 5: the marked Delaunay faces in order are the surface") {
  delaunay::CanonicalDelaunay delaunay;
  delaunay.faces = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
  CHECK(codec::bitmap::create_surface(delaunay, {true, false, true, true}) ==
        std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {1, 2, 3}});
}

TEST_CASE("composition step 6: the unrecovered faces read are those stored") {
  const Stored stored = stored_schoenhardt(nullptr);
  const auto faces = codec::bitmap::read_unrecovered_faces(stored.sections, 6);
  REQUIRE(faces);
  CHECK(codec::bitmap::write_face_list(*faces) == stored.parts.unrecovered);
  CHECK_FALSE(codec::bitmap::read_unrecovered_faces(stored.sections, 5));
  const auto none = codec::bitmap::read_unrecovered_faces(codec::bitmap::BitmapSections{}, 6);
  REQUIRE(none);
  CHECK(none->empty());
}

TEST_CASE("composition step 7: surface and unrecovered faces close to the polyhedron") {
  const delaunay::Certificate certificate = generated::schoenhardt_certificate();
  const Solid canonical = geometry::canonical_form(generated::schoenhardt()).boundary.solid();
  for (const delaunay::Certificate* used :
       {static_cast<const delaunay::Certificate*>(nullptr), &certificate}) {
    const Stored stored = stored_schoenhardt(used);
    const auto composition = codec::bitmap::compose(stored.sections, {});
    REQUIRE(composition);
    CHECK(composition->counts.marked_faces + composition->counts.unrecovered_faces == 8);
    CHECK(composition->counts == stored.parts.counts);
    auto solid = Solid::make(composition->arrays, canonical.lattice(), canonical.srid());
    REQUIRE(solid);
    auto boundary = OrientedBoundary::make(*solid);
    REQUIRE(boundary);
    CHECK(geometry::canonical_form(*boundary).boundary.solid() == canonical);
  }
  // A face that is both marked and listed as unrecovered makes the blob malformed.
  const Stored stored = stored_schoenhardt(nullptr);
  const auto nodes = codec::bitmap::read_nodes(stored.sections, {});
  REQUIRE(nodes);
  CHECK_FALSE(
      codec::bitmap::complete_boundary(stored.sections, *nodes, {{0, 1, 2}}, {{0, 1, 2}}, {}));
}
