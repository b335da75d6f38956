// SPDX-License-Identifier: GPL-3.0-or-later
//
// The content of a picture of a finding, in whole thousandths of its radius around its centre.
// Internal to report/.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "report/html/picture.h"

namespace watertight::report {

using Triple = std::array<double, 3>;

enum class Role : std::uint8_t { other_facet, first, second };

struct SceneFacet {
  Role role = Role::other_facet;
  std::vector<std::vector<Triple>> rings;  // the exterior ring is the first
};

struct Scene {
  std::vector<SceneFacet> facets;
  std::vector<std::vector<Triple>> lines;  // bad edges and rings concerned
  std::optional<Triple> witness;
  std::size_t hidden_facets = 0;  // the number of facets that are too far away to be shown
};

/// The scene of a finding; nullopt when there is no facet to show.
std::optional<Scene> scene_of(const pipeline::InspectedFeature& feature,
                              const PlacedFinding& placed, const PictureOptions& options);

/// The direction from which a picture is seen, degrees: azimuth from east, elevation above the
/// horizon.
struct View {
  double azimuth = 0;
  double elevation = 0;
};

/// A view in which the facets concerned face the viewer, from above where that is as good.
View best_view(const Scene& scene);

/// The <svg> element of a scene, painted from the back to the front.
std::string svg_of(const Scene& scene, const View& view);

/// The text {"f": [[role, ring, ...], ...], "l": [line, ...], "w": point, "v": [azimuth,
/// elevation]} with rings as flat arrays of whole numbers.
std::string json_of(const Scene& scene, const View& view);

}  // namespace watertight::report
