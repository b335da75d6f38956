// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/canonical_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>

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

/// Stable sorting by counting, one key (a vertex) after the other from the least significant on.
class CountingSort {
 public:
  CountingSort(std::size_t count, Index vertex_count) : starts_(vertex_count + 1), order_(count) {
    std::iota(order_.begin(), order_.end(), Index{0});
    sorted_.resize(count);
  }

  template <class Key>
  void sort_by(Key key) {
    std::fill(starts_.begin(), starts_.end(), Index{0});
    for (const Index i : order_) ++starts_[key(i) + 1];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    for (const Index i : order_) sorted_[starts_[key(i)]++] = i;
    order_.swap(sorted_);
  }
  const std::vector<Index>& order() const { return order_; }

 private:
  std::vector<Index> starts_;
  std::vector<Index> order_;
  std::vector<Index> sorted_;
};

/// No two tetrahedra share their first three vertices: they would lie on the same side of a face.
void sort_tetrahedra(std::vector<Tetrahedron>& tetrahedra, Index vertex_count) {
  CountingSort sort(tetrahedra.size(), vertex_count);
  for (const std::size_t corner : {2, 1, 0}) {
    sort.sort_by([&](Index i) { return tetrahedra[i][corner]; });
  }
  std::vector<Tetrahedron> sorted;
  sorted.reserve(tetrahedra.size());
  for (const Index i : sort.order()) sorted.push_back(tetrahedra[i]);
  tetrahedra.swap(sorted);
}

/// A face as one of its tetrahedra has it: its vertices increase, `side` is 0 if the apex lies on
/// their positive side.
struct Corner {
  Triangle face;
  Index apex;
  std::size_t side;
};

/// The face of a canonical tetrahedron that leaves out its i-th smallest vertex.
Corner corner_of(const Tetrahedron& t, std::size_t i) {
  const bool is_even = t[2] < t[3];
  const std::array<Index, 4> sorted{t[0], t[1], is_even ? t[2] : t[3], is_even ? t[3] : t[2]};
  const Triangle face{sorted[i == 0 ? 1 : 0], sorted[i <= 1 ? 2 : 1], sorted[i <= 2 ? 3 : 2]};
  // Moving the apex behind its face takes 3 - i transpositions.
  return {face, sorted[i], ((3 - i) + (is_even ? 0U : 1U)) % 2};
}

/// Numbers 4 t + i stand for the i-th face of tetrahedron t; inner faces come twice.
void list_faces(CanonicalDelaunay& delaunay, Index vertex_count) {
  const std::vector<Tetrahedron>& tetrahedra = delaunay.tetrahedra;
  const auto corner = [&](Index i) { return corner_of(tetrahedra[i / 4], i % 4); };
  CountingSort sort(4 * tetrahedra.size(), vertex_count);
  for (const std::size_t k : {2, 1, 0}) {
    sort.sort_by([&](Index i) { return corner(i).face[k]; });
  }
  const std::size_t most = 2 * tetrahedra.size() + 2 * std::size_t{vertex_count};
  delaunay.faces.reserve(std::min(most, 4 * tetrahedra.size()));
  delaunay.apexes.reserve(std::min(most, 4 * tetrahedra.size()));
  for (const Index i : sort.order()) {
    const auto [face, apex, side] = corner(i);
    if (delaunay.faces.empty() || delaunay.faces.back() != face) {
      delaunay.faces.push_back(face);
      delaunay.apexes.push_back({kNone, kNone});
    }
    delaunay.apexes.back()[side] = apex;
  }
}

}  // namespace

CanonicalDelaunay list_canonically(std::vector<Tetrahedron> tetrahedra, Index vertex_count) {
  CanonicalDelaunay result;
  result.tetrahedra = std::move(tetrahedra);
  for (Tetrahedron& t : result.tetrahedra) t = canonical_tetrahedron(t);
  sort_tetrahedra(result.tetrahedra, vertex_count);
  list_faces(result, vertex_count);
  return result;
}

}  // namespace watertight
