// SPDX-License-Identifier: GPL-3.0-or-later
//
// A small 3D picture of a finding: the facets around it in parallel projection, the facets
// concerned in colour, the witness marked. For people: nothing is decided here. Internal to
// report/.
#pragma once

#include <optional>
#include <string>

#include "report/place.h"

namespace watertight::report {

struct Picture {
  std::string svg;    // one <svg> element; classes are those of the page's style
  std::string scene;  // the same in three dimensions, as JSON of numbers, for turning it
};

struct PictureOptions {
  std::size_t most_facets = 160;    // shown; the nearest ones
  std::size_t most_corners = 4000;  // shown; longer rings are thinned out, later ones left out
};

/// Nothing when the finding has no place to show. Coordinates are rounded to a thousandth of the
/// picture. Cost: linear in the facets of the solids concerned.
std::optional<Picture> picture_of(const pipeline::InspectedFeature& feature,
                                  const PlacedFinding& placed, const PictureOptions& options);

}  // namespace watertight::report
