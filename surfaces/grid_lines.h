// SPDX-License-Identifier: GPL-3.0-or-later
//
// Lines of constant u and v on a surface, close enough for triangles between them.
#pragma once

#include <vector>

#include "surfaces/curves/pieces.h"

namespace watertight::surfaces {

/// A rectangle of the plane of (u, v).
struct ParameterBox {
  Parameters low{};
  Parameters high{};
};

/// Values of u and v strictly inside the box, ascending.
struct GridLines {
  std::vector<double> us;
  std::vector<double> vs;
};

/// Lines so close to each other that a triangle within a cell is about as near to the surface as
/// `chord`, closer where the surface bends more. The bend is measured at nine points of each of
/// many cells, so triangles need a look of their own. `scale` is the length of u and of v on the
/// surface. At most `most` lines of a kind. Cost: some hundred points of each patch that the box
/// meets. Source: section 3 of the paper: h_u <= sqrt(8 c / M_uu), h_u h_v <= 4 c / M_uv, with the
/// part of the second derivatives that stands on the surface.
GridLines grid_lines(const Surface& surface, const ParameterBox& box, const Parameters& scale,
                     double chord, std::size_t most);

}  // namespace watertight::surfaces
