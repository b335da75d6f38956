// SPDX-License-Identifier: GPL-3.0-or-later
//
// A solid as the oracle sees it: facets with exact rings and the plane pieces that they consist of,
// and the rules about the rings of one facet. A part of oracle.h.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "bench/verdict/arrangement.h"
#include "geometry/solid.h"

namespace watertight::verdict {

using ExactEdge = std::array<Vector, 2>;  // from, to

struct FacetModel {
  std::size_t shell = 0;
  std::vector<std::vector<Vector>> rings;
  /// Directed edges of all rings, split where another vertex of the facet lies on them.
  std::vector<ExactEdge> edges;
  bool is_planar = true;
  std::vector<std::vector<std::vector<Vector>>> pieces;  // each a list of rings
};

struct SurfaceModel {
  std::size_t shell_count = 0;
  std::vector<FacetModel> facets;
  bool is_known = true;      // every facet has a surface
  std::set<int> ring_codes;  // of problems of single facets; the rest is defined when empty
};
SurfaceModel model_of(const Solid& solid);

/// All pieces of the facets, numbered from `first_facet`.
std::vector<Piece> pieces_of(const SurfaceModel& model, std::size_t first_facet = 0);

/// Tells on which side of closed surfaces points lie, by rays that meet no edge.
class ParityLocator {
 public:
  explicit ParityLocator(std::vector<Piece> pieces);
  /// Requires a point that is on no piece.
  bool is_inside(const Vector& p) const;

 private:
  std::optional<bool> try_ray(const Vector& p, const Vector& direction) const;
  std::vector<Piece> pieces_;
  std::vector<Vector> normals_;
};

}  // namespace watertight::verdict
