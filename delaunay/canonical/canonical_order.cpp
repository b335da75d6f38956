// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/canonical/canonical_order.h"

#include <algorithm>
#include <utility>

#include "delaunay/canonical/sort_by_vertices.h"

namespace watertight::delaunay {
namespace {

/// The tetrahedron with the same orientation, the smallest index first and the second smallest
/// second: an even permutation, which exists and is unique.
geometry::Tetrahedron canonical_tetrahedron(geometry::Tetrahedron t) {
  const auto smallest = static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
  if (smallest != 0) {
    // Two disjoint swaps keep the orientation.
    std::swap(t[0], t[smallest]);
    std::swap(t[smallest == 1 ? 2 : 1], t[smallest == 3 ? 2 : 3]);
  }
  std::rotate(t.begin() + 1, std::min_element(t.begin() + 1, t.end()), t.end());
  return t;
}

}  // namespace

ListedFace face_opposite(const geometry::Tetrahedron& tetrahedron, std::size_t corner,
                         Index beyond) {
  // A cyclic permutation of four corners is odd. So the corner opposite to the face (a, b, c) is on
  // the positive side of the face if `corner` is odd, and on the negative side if it is even.
  Index a = tetrahedron[(corner + 1) % 4];
  Index b = tetrahedron[(corner + 2) % 4];
  Index c = tetrahedron[(corner + 3) % 4];
  std::size_t side = 1 - corner % 2;
  const auto order = [&side](Index& low, Index& high) {
    if (low < high) return;
    std::swap(low, high);
    side = 1 - side;
  };
  order(a, b);
  order(b, c);
  order(a, b);
  ListedFace face{{a, b, c}};
  face.apexes[side] = tetrahedron[corner];
  face.apexes[1 - side] = beyond;
  return face;
}

CanonicalDelaunay list_canonically(std::vector<geometry::Tetrahedron> tetrahedra,
                                   std::vector<ListedFace> faces, Index vertex_count) {
  CanonicalDelaunay result;
  result.tetrahedra = std::move(tetrahedra);
  for (geometry::Tetrahedron& t : result.tetrahedra) t = canonical_tetrahedron(t);
  // Three vertices identify a face, and the first three vertices a tetrahedron: two tetrahedra with
  // the same three would lie on the same side of a face.
  sort_by_vertices(result.tetrahedra, vertex_count, [](const geometry::Tetrahedron& t) {
    return Triangle{t[0], t[1], t[2]};
  });
  sort_by_vertices(faces, vertex_count, [](const ListedFace& face) { return face.vertices; });
  result.faces.reserve(faces.size());
  result.apexes.reserve(faces.size());
  for (const ListedFace& face : faces) {
    result.faces.push_back(face.vertices);
    result.apexes.push_back(face.apexes);
  }
  return result;
}

}  // namespace watertight::delaunay
