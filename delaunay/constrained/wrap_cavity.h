// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fills a polyhedral cavity with its constrained Delaunay tetrahedralization. Private to delaunay/.
#pragma once

#include <span>
#include <vector>

#include "delaunay/constrained/test_budget.h"
#include "geometry/point.h"

namespace watertight::delaunay {

/// Fills a cavity by gift wrapping: over each triangle comes the vertex in whose sphere no other
/// vertex lies that the triangle sees. `front` has the triangles around the cavity, each turned so
/// that the inside is where orient3d is positive; a triangle inside that must stay is there twice,
/// once for each side. Returns positive tetrahedra that fill the inside once, or none if the front
/// has no constrained Delaunay tetrahedralization or the budget is used up.
/// Cost: the square of the front for each tetrahedron at most.
/// Source: L. Diazzi, D. Panozzo, A. Vaxman, M. Attene, "Constrained Delaunay Tetrahedrization"
/// (2023), section 4.3, and J. R. Shewchuk, "Constrained Delaunay Tetrahedralizations and Provably
/// Good Boundary Recovery" (2002). Departure: ties are broken by the perturbation of the canonical
/// Delaunay tetrahedralization.
std::vector<geometry::Tetrahedron> wrap_cavity(std::span<const Point> points,
                                               std::vector<Triangle> front, TestBudget& budget);

}  // namespace watertight::delaunay
