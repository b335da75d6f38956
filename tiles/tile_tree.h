// SPDX-License-Identifier: GPL-3.0-or-later
//
// A quadtree of features: a tile has the largest features of its square that no tile above it has,
// so that from afar the large ones are drawn first (3D Tiles, refinement ADD).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace watertight::tiles {

/// A box in the coordinates of the tree's items; empty when min > max.
struct TileBox {
  static constexpr double kEndless = std::numeric_limits<double>::infinity();
  std::array<double, 3> min{kEndless, kEndless, kEndless};
  std::array<double, 3> max{-kEndless, -kEndless, -kEndless};

  bool is_empty() const { return min[0] > max[0]; }
  void include(const TileBox& box);
  double diagonal() const;
};

/// A part of the plane: lower bounds are in it, upper bounds are not.
struct TileBounds {
  std::array<double, 2> min{};
  std::array<double, 2> max{};

  bool contains(const TileBox& box) const;  // by the middle of the box
};

/// The features' order: larger ones first; of equal ones that with the larger number.
struct TileRank {
  double size = 0;
  std::int64_t number = 0;
  friend auto operator<=>(const TileRank&, const TileRank&) = default;
};

/// The facts about a feature that the tree needs.
struct TileItem {
  TileBox box;
  TileRank rank;             // unlike that of any other item
  std::uint64_t weight = 1;  // the cost of showing it
};

struct Tile {
  int level = 0;
  std::uint32_t x = 0;  // the number of the square in its level, from west and south
  std::uint32_t y = 0;
  std::size_t part = 0;  // of the tiles of one square, where it cannot be divided further
  TileBounds bounds;
  std::vector<std::size_t> items;     // the tile's own, the largest first
  std::vector<std::size_t> children;  // numbers of tiles
  TileBox box;                        // around the items of the tile and of all tiles below
  double largest_below = 0;           // the size of the largest item below; 0 for none
};

struct TileLimits {
  std::size_t items = 1024;      // the most of a tile
  std::uint64_t weight = 65536;  // the most of a tile of several items
  int levels = 24;               // beyond, squares are not divided further
};

/// The tiles, each before its children; none without items. A tile has the items in its bounds that
/// rank from its last one to the last one of the tile above. The same items give the same tiles.
/// Requires boxes that are not empty and have finite bounds. Cost: O(n log n + n levels).
std::vector<Tile> tile_tree(std::span<const TileItem> items, const TileLimits& limits = {});

}  // namespace watertight::tiles
