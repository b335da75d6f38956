// SPDX-License-Identifier: GPL-3.0-or-later
//
// The triangles of a shell around a hole, as far as the surface is smooth. Internal to repair/.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "repair/hole_groups.h"
#include "repair/shell_surface.h"
#include "repair/smooth/smooth_options.h"

namespace watertight::repair {

/// Why a hole gets no smooth patch.
enum class SmoothRefusal : std::uint8_t {
  border_not_manifold,  // at a vertex of the border more than two open edges meet
  not_flattenable,      // hole and collar do not lie in the plane one-to-one, or hold no surface
  too_sharp,            // the same, where an edge at the border turns more than 100 degrees
  too_large,            // more triangles or vertices than the limits allow
  patch_crosses,        // the patch meets other facets or itself
  not_valid             // the solid with its smooth patches is not valid
};
std::string_view to_string(SmoothRefusal refusal);

/// A refusal with its place or measure in a sentence.
struct Refused {
  SmoothRefusal refusal = SmoothRefusal::not_flattenable;
  std::string detail;
};

/// Triangles of the collar by local numbers.
struct Collar {
  std::vector<Index> vertices;  // local number -> vertex of the solid
  std::vector<Triangle> triangles;
  HoleLoops loops;  // by local numbers, in the sense of the missing facet
  /// A vertex of the border at which an edge ends that turns more than 100 degrees; kNone without.
  Index sharp_vertex = kNone;
};

/// The first ring has all triangles at vertices of the border, each further one those at vertices
/// of the last that are not beyond a crease. Cost: O(n log n) for n triangles of the collar.
std::variant<Collar, Refused> collar_of(const EditedSolid& solid, const ShellSurface& surface,
                                        const HoleLoops& loops, const CollarOptions& options);

/// The cosine of the angle by which a surface turns between two triangles on an edge, given by
/// their third places; 1 where one has no area.
double cosine_at_edge(const geometry::Vector3& from, const geometry::Vector3& to,
                      const geometry::Vector3& left, const geometry::Vector3& right);

}  // namespace watertight::repair
