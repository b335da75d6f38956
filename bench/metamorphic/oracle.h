// SPDX-License-Identifier: GPL-3.0-or-later
//
// Oracles of their own for solids, by CGAL: Polygon Mesh Processing for one shell and for shells
// that do not touch, Nef polyhedra for shells that may. They share only the triangulation of the
// facets with the validator.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight {

/// A shell as triangles on merged vertices.
using ShellTriangles = std::vector<Triangle>;

struct ShellFacts {
  bool is_mesh = false;  // 2-manifold and oriented; the facts below need it
  bool is_closed = false;
  std::size_t components = 0;
  bool meets_itself = false;   // other than in shared vertices and edges; known for any triangles
  bool bounds_volume = false;  // when closed and not meeting itself
  bool is_outward = false;     // likewise
};
ShellFacts ask_pmp(std::span<const Point> vertices, const ShellTriangles& shell);

/// Facts about sound shells (closed, one component, not meeting themselves); the first is exterior.
struct NefFacts {
  bool cavities_inside = false;    // each within the exterior shell, sharing no area with it
  bool cavities_apart = false;     // no two with common interior points or areas
  std::size_t interior_parts = 0;  // of what is left
};
NefFacts ask_nef(std::span<const Point> vertices, std::span<const ShellTriangles> shells);

}  // namespace watertight
