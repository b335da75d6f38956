// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/recovery/tetrahedron_mesh.h"

#include <algorithm>
#include <utility>

namespace watertight::delaunay {

TetrahedronMesh::TetrahedronMesh(std::vector<geometry::Tetrahedron> tetrahedra,
                                 std::size_t vertex_count)
    : tetrahedra_(std::move(tetrahedra)), at_vertex_(vertex_count, kNone) {
  neighbours_.assign(tetrahedra_.size(), {kNone, kNone, kNone, kNone});
  std::vector<Half> halves;
  halves.reserve(4 * tetrahedra_.size());
  for (Index t = 0; t < tetrahedra_.size(); ++t) {
    add_halves(t, halves);
    for (const Index vertex : tetrahedra_[t]) at_vertex_[vertex] = t;
  }
  sort_by_vertices(halves, vertex_count, [](const Half& half) { return half.vertices; });
  pair(halves);
}

void TetrahedronMesh::add_halves(Index t, std::vector<Half>& halves) const {
  for (Index corner = 0; corner < 4; ++corner) {
    halves.push_back({sorted(inward_face(tetrahedra_[t], corner)), t, corner});
  }
}

void TetrahedronMesh::pair(std::span<const Half> sorted_halves) {
  for (std::size_t i = 0; i + 1 < sorted_halves.size(); ++i) {
    const Half& a = sorted_halves[i];
    const Half& b = sorted_halves[i + 1];
    if (a.vertices != b.vertices) continue;
    neighbours_[a.tetrahedron][a.corner] = b.tetrahedron;
    neighbours_[b.tetrahedron][b.corner] = a.tetrahedron;
  }
}

void TetrahedronMesh::replace(std::span<const Index> old_ones,
                              std::span<const geometry::Tetrahedron> new_ones) {
  std::vector<Half>& halves = halves_;
  halves.clear();
  for (const Index t : old_ones) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const Index other = neighbours_[t][corner];
      if (other == kNone) continue;
      const auto back = std::find(neighbours_[other].begin(), neighbours_[other].end(), t);
      if (back == neighbours_[other].end()) continue;
      *back = kNone;
      const auto at = static_cast<Index>(back - neighbours_[other].begin());
      halves.push_back({sorted(inward_face(tetrahedra_[other], at)), other, at});
    }
    neighbours_[t] = {kNone, kNone, kNone, kNone};
  }
  for (const Index t : old_ones) {
    std::erase_if(halves, [t](const Half& half) { return half.tetrahedron == t; });
    tetrahedra_[t] = {};
    empty_.push_back(t);
  }
  for (const geometry::Tetrahedron& tetrahedron : new_ones) {
    if (empty_.empty()) {
      empty_.push_back(static_cast<Index>(tetrahedra_.size()));
      tetrahedra_.emplace_back();
      neighbours_.push_back({kNone, kNone, kNone, kNone});
    }
    const Index t = empty_.back();
    empty_.pop_back();
    tetrahedra_[t] = tetrahedron;
    add_halves(t, halves);
    for (const Index vertex : tetrahedron) {
      if (vertex >= at_vertex_.size()) at_vertex_.resize(std::size_t{vertex} + 1, kNone);
      at_vertex_[vertex] = t;
    }
  }
  std::sort(halves.begin(), halves.end(),
            [](const Half& a, const Half& b) { return a.vertices < b.vertices; });
  pair(halves);
}

std::vector<geometry::Tetrahedron> TetrahedronMesh::take() {
  std::erase_if(tetrahedra_, [](const geometry::Tetrahedron& t) { return t[0] == t[1]; });
  neighbours_.clear();
  at_vertex_.clear();
  empty_.clear();
  return std::move(tetrahedra_);
}

std::vector<Index> corners_of(const TetrahedronMesh& mesh, std::span<const Index> tetrahedra) {
  std::vector<Index> corners;
  for (const Index t : tetrahedra) {
    const geometry::Tetrahedron& tetrahedron = mesh.tetrahedron(t);
    corners.insert(corners.end(), tetrahedron.begin(), tetrahedron.end());
  }
  return corners;
}

}  // namespace watertight::delaunay
