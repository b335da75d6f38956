// SPDX-License-Identifier: GPL-3.0-or-later
//
// A solid that remedies change: facets as lists of rings, each with the facet of the submitted
// solid that it came from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "geometry/solid.h"

namespace watertight::repair {

/// The vertices of a ring by number; the closing vertex is not repeated.
using Ring = std::vector<Index>;

struct EditedFacet {
  std::vector<Ring> rings;  // the first one is exterior
  Index source = kNone;     // the facet of the submitted solid; kNone for a new one
  friend bool operator==(const EditedFacet&, const EditedFacet&) = default;
};

struct EditedSolid {
  std::vector<Point> vertices;
  std::vector<std::vector<EditedFacet>> shells;
  Lattice lattice;
  std::uint32_t srid = 0;
};

/// The solid with equal vertices merged.
EditedSolid edited(const Solid& solid);
/// The solid of all facets, in their order. Errors: limit_exceeded.
Result<Solid> solid_of(const EditedSolid& edited);
/// A facet as a solid of its own vertices.
struct FacetAlone {
  Solid solid;
  std::vector<Index> vertices;  // vertex -> vertex of the edited solid, ascending
};
/// Errors: limit_exceeded. Cost: linear in the facet.
Result<FacetAlone> alone(const EditedSolid& edited, const EditedFacet& facet);

/// A solid of one shell, which need not be closed. Errors: limit_exceeded.
Result<Solid> solid_of(const EditedSolid& edited, std::span<const EditedFacet> facets);

/// The facet turned over.
void turn_over(EditedFacet& facet);

/// The place of a vertex in metres, for measurements; the origin is anywhere.
std::array<double, 3> metres_of(const EditedSolid& edited, Index vertex,
                                const std::array<double, 3>& metres_per_unit);
std::array<double, 3> metres_per_unit(const EditedSolid& edited);
/// Twice the area vector of a ring, in square metres; for measurements.
std::array<double, 3> area_vector(const EditedSolid& edited, const Ring& ring,
                                  const std::array<double, 3>& metres_per_unit);

}  // namespace watertight::repair
