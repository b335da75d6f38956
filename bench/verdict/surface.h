// SPDX-License-Identifier: GPL-3.0-or-later
//
// The oracle's model of a solid: facets with exact rings and the plane pieces of which they
// consist, and the rules about the rings of one facet. It is a part of oracle.h.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "bench/verdict/arrangement.h"
#include "geometry/solid.h"

namespace watertight::verdict {

using ExactEdge = std::array<Vector, 2>;  // the ends (from, to)

struct FacetModel {
  std::size_t shell = 0;
  std::vector<std::vector<Vector>> rings;
  /// The directed edges of all rings, split where another vertex of the facet lies on them.
  std::vector<ExactEdge> edges;
  bool is_planar = true;
  std::vector<std::vector<std::vector<Vector>>> pieces;  // each piece is a list of rings
};

struct SurfaceModel {
  std::size_t shell_count = 0;
  std::vector<FacetModel> facets;
  bool is_known = true;  // every facet has a surface
  // Codes of problems of single facets; the other members are defined if there are none.
  std::set<int> ring_codes;
};
SurfaceModel model_of(const Solid& solid);

/// All pieces of the facets, with facet numbers from `first_facet` on.
std::vector<Piece> pieces_of(const SurfaceModel& model, std::size_t first_facet = 0);

/// Finds on which side of closed surfaces points lie, by rays that meet no edge.
class ParityLocator {
 public:
  explicit ParityLocator(std::vector<Piece> pieces);
  /// True if the point is inside. Requires a point that is on no piece.
  bool is_inside(const Vector& p) const;

 private:
  std::optional<bool> try_ray(const Vector& p, const Vector& direction) const;
  std::vector<Piece> pieces_;
  std::vector<Vector> normals_;
};

}  // namespace watertight::verdict
