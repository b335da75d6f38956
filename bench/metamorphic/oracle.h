// SPDX-License-Identifier: GPL-3.0-or-later
//
// Independent oracles for solids, by CGAL: Polygon Mesh Processing for one shell and for shells
// that do not touch, Nef polyhedra for shells that may touch. They share only the triangulation of
// the facets with the validator.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geometry/point.h"

namespace watertight {

/// A shell as triangles on merged vertices.
using ShellTriangles = std::vector<Triangle>;

struct ShellFacts {
  bool is_mesh = false;  // 2-manifold and oriented, which the facts below require
  bool is_closed = false;
  std::size_t components = 0;
  // The shell meets itself other than in shared vertices and edges; known for any triangles.
  bool meets_itself = false;
  bool bounds_volume = false;  // known if the shell is closed and does not meet itself
  bool is_outward = false;     // known if the shell is closed and does not meet itself
};
ShellFacts ask_pmp(std::span<const Point> vertices, const ShellTriangles& shell);

/// Facts about sound shells (closed, one component, not meeting themselves), the first of them
/// exterior.
struct NefFacts {
  bool cavities_inside = false;    // each is within the exterior shell and shares no area with it
  bool cavities_apart = false;     // no two have common interior points or areas
  std::size_t interior_parts = 0;  // the number of parts of the interior without the cavities
};
NefFacts ask_nef(std::span<const Point> vertices, std::span<const ShellTriangles> shells);

}  // namespace watertight
