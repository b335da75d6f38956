// SPDX-License-Identifier: GPL-3.0-or-later
//
// A small 3D picture of a finding: the facets around it in parallel projection, the facets
// concerned in colour, the witness marked. Pictures are for people: nothing is decided by them.
// Internal to report/.
#pragma once

#include <optional>
#include <string>

#include "report/place.h"

namespace watertight::report {

struct Picture {
  std::string svg;    // one <svg> element; classes are those of the page's style
  std::string scene;  // the picture in three dimensions, as JSON, for turning it
};

struct PictureOptions {
  std::size_t most_facets = 160;    // the nearest facets are shown
  std::size_t most_corners = 4000;  // longer rings are thinned out, later rings left out
};

/// Draws a finding; nullopt when it has no place to show. Coordinates are rounded to a thousandth
/// of the picture. Cost: linear in the facets of the solids concerned.
std::optional<Picture> picture_of(const pipeline::InspectedFeature& feature,
                                  const PlacedFinding& placed, const PictureOptions& options);

}  // namespace watertight::report
