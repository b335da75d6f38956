// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/canonical_order.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace watertight {
namespace {

/// The same orientation with the smallest index first and the second smallest second: an even
/// permutation, which exists and is unique.
Tetrahedron canonical_tetrahedron(Tetrahedron t) {
  const auto smallest = static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
  if (smallest != 0) {
    // Two disjoint swaps keep the orientation.
    std::swap(t[0], t[smallest]);
    std::swap(t[smallest == 1 ? 2 : 1], t[smallest == 3 ? 2 : 3]);
  }
  std::rotate(t.begin() + 1, std::min_element(t.begin() + 1, t.end()), t.end());
  return t;
}

/// Faces are told apart by their three vertices, tetrahedra by their first three: two with the same
/// would lie on the same side of a face.
const Triangle& key_of(const ListedFace& face) { return face.vertices; }
Triangle key_of(const Tetrahedron& t) { return {t[0], t[1], t[2]}; }

/// Sorts by the key: by counting as to its first vertex, then the few that share it.
template <class Record>
void sort_by_key(std::vector<Record>& records, Index vertex_count) {
  std::vector<std::size_t> ends(std::size_t{vertex_count} + 1);
  for (const Record& record : records) ++ends[key_of(record)[0] + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) ends[v + 1] += ends[v];
  std::vector<Record> sorted(records.size());
  for (const Record& record : records) sorted[ends[key_of(record)[0]]++] = record;
  const auto rest = [](const Record& record) {
    return std::uint64_t{key_of(record)[1]} << 32 | key_of(record)[2];
  };
  std::size_t begin = 0;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
              sorted.begin() + static_cast<std::ptrdiff_t>(ends[v]),
              [&](const Record& a, const Record& b) { return rest(a) < rest(b); });
    begin = ends[v];
  }
  records.swap(sorted);
}

}  // namespace

ListedFace face_opposite(const Tetrahedron& tetrahedron, std::size_t corner, Index beyond) {
  // A cycle of four is an odd permutation: the apex is on the positive side for odd corners.
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

CanonicalDelaunay list_canonically(std::vector<Tetrahedron> tetrahedra,
                                   std::vector<ListedFace> faces, Index vertex_count) {
  CanonicalDelaunay result;
  result.tetrahedra = std::move(tetrahedra);
  for (Tetrahedron& t : result.tetrahedra) t = canonical_tetrahedron(t);
  sort_by_key(result.tetrahedra, vertex_count);
  sort_by_key(faces, vertex_count);
  result.faces.reserve(faces.size());
  result.apexes.reserve(faces.size());
  for (const ListedFace& face : faces) {
    result.faces.push_back(face.vertices);
    result.apexes.push_back(face.apexes);
  }
  return result;
}

}  // namespace watertight
