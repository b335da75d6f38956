// SPDX-License-Identifier: GPL-3.0-or-later
//
// Faces of facets with three or four vertices, which the certificate checks at sight.
#include <catch2/catch_test_macros.hpp>
#include <vector>

#include "delaunay/certificate/small_faces.h"

namespace watertight {
namespace {

using delaunay::ConstrainedFace;

delaunay::SmallFaces faces_of(const std::vector<Index>& ring,
                              const std::vector<Triangle>& canonical,
                              const std::vector<Triangle>& faces) {
  std::vector<ConstrainedFace> constrained;
  for (const Triangle& face : faces) constrained.push_back({face, 0});
  return delaunay::small_faces(ring, canonical, constrained);
}

TEST_CASE("the face of a triangle is turned as its ring") {
  const auto small = faces_of({9, 7, 8}, {{7, 8, 9}}, {{7, 8, 9}});
  REQUIRE(small.count == 1);
  CHECK(small.triangles[0] == Triangle{9, 7, 8});
  CHECK(faces_of({9, 8, 7}, {{7, 9, 8}}, {{7, 8, 9}}).triangles[0] == Triangle{9, 8, 7});
}

TEST_CASE("the faces of a quad along its canonical diagonal are turned as its ring") {
  const auto small = faces_of({4, 7, 5, 6}, {{4, 7, 5}, {4, 5, 6}}, {{4, 5, 6}, {4, 5, 7}});
  REQUIRE(small.count == 2);
  CHECK(small.triangles[0] == Triangle{4, 5, 6});
  CHECK(small.triangles[1] == Triangle{4, 7, 5});
}

TEST_CASE("faces that are not the canonical triangles are left to the whole check") {
  const std::vector<Triangle> canonical{{4, 7, 5}, {4, 5, 6}};
  const std::vector<Index> ring{4, 7, 5, 6};
  CHECK(faces_of(ring, canonical, {{4, 6, 7}, {5, 6, 7}}).count == 0);  // the other diagonal
  CHECK(faces_of(ring, canonical, {{4, 5, 7}, {4, 5, 7}}).count == 0);  // one of them twice
  CHECK(faces_of(ring, canonical, {{4, 5, 7}, {4, 6, 7}}).count == 0);  // they overlap
  CHECK(faces_of(ring, canonical, {{4, 5, 7}, {4, 5, 9}}).count == 0);  // a vertex beyond the ring
  CHECK(faces_of(ring, canonical, {{4, 8, 9}, {4, 5, 6}}).count == 0);
  CHECK(faces_of(ring, canonical, {{4, 5, 7}}).count == 0);
  CHECK(faces_of({4, 7, 4, 6}, {{4, 7, 6}, {4, 7, 6}}, {{4, 6, 7}, {4, 6, 7}}).count == 0);
  CHECK(faces_of({7, 8, 9}, {{7, 8, 9}}, {{7, 8, 6}}).count == 0);
  CHECK(faces_of({7, 8, 9}, {{7, 8, 9}}, {{4, 5, 6}}).count == 0);
}

}  // namespace
}  // namespace watertight
