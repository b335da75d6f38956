// SPDX-License-Identifier: GPL-3.0-or-later
//
// The geometry of a feature as triangles, whatever its defects are.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/geo_json/city_shapes.h"
#include "geometry/point.h"
#include "tiles/frame.h"
#include "tiles/tile_tree.h"

namespace watertight::tiles {

/// What a surface looks like: a material of its own.
enum class Look : std::uint8_t {
  roof,
  wall,
  ground,
  building,  // a part of a building without semantics
  terrain,
  vegetation,
  water,
  transport,
  other,
  finding
};
inline constexpr std::size_t kLooks = 10;

struct FeatureMesh {
  std::string id;
  std::string type;  // of the top-level object
  /// Names and values (JSON texts).
  std::vector<std::pair<std::string, std::string>> properties;
  std::vector<GridPosition> vertices;
  std::array<std::vector<Triangle>, kLooks> triangles;  // by look; corners are vertices
  std::vector<std::array<Index, 2>> lines;
  std::vector<Index> points;
  /// Facets that could not be filled: their rings cross too often.
  std::uint64_t unfilled_facets = 0;

  /// Whether there is nothing to draw.
  bool is_empty() const { return triangle_count() == 0 && lines.empty() && points.empty(); }
  std::size_t triangle_count() const;
  /// The box around the vertices, metres of the frame.
  TileBox box() const;
};

/// The look of the surfaces of a city object that have no semantics.
Look look_of_type(std::string_view type);

/// Triangulates a feature in EPSG system `srid`. Facets get their canonical triangles
/// (tessellate/facets.h), those with bad rings are filled by the even-odd rule, and those on a line
/// have none. The vertices are rounded to the grid of the frame after that. The attributes become
/// properties. Errors: those of Frame::place(). Cost: O(n log n).
Result<FeatureMesh> mesh_of(formats::CityFeature feature, std::string id, std::string type,
                            std::uint32_t srid, const Frame& frame);

}  // namespace watertight::tiles
