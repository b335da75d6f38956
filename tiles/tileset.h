// SPDX-License-Identifier: GPL-3.0-or-later
//
// A tileset of 3D Tiles 1.1 (OGC 22-025r4): its tree as JSON, and the places of its tiles.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "tiles/frame.h"
#include "tiles/tile_tree.h"

namespace watertight::tiles {

/// The middle of a tile's box, which is the origin of its content. The boxes of tiles that are
/// written are in metres of a frame.
GridPosition origin_of(const Tile& tile);

/// The name of a tile's content: "LEVEL/X/Y.glb", or "LEVEL/X/Y-PART.glb".
std::string content_name(const Tile& tile);

/// The text of tileset.json of tiles in metres of a frame. `uri` gives the address of a tile's
/// content. Tiles add to what tiles above them show; their geometric error is the size of the
/// largest feature that is not shown yet. A tileset without tiles has a root without content. Cost:
/// linear.
std::string tileset_json(std::span<const Tile> tiles, const Frame& frame,
                         const std::function<std::string(const Tile&)>& uri);

}  // namespace watertight::tiles
