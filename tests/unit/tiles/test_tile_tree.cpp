// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <functional>
#include <random>
#include <set>

#include "tiles/tile_tree.h"

namespace watertight {
namespace {

using tiles::Tile;
using tiles::TileBox;
using tiles::TileItem;

TileItem item(std::int64_t number, double x, double y, double size, std::uint64_t weight = 1) {
  TileItem made;
  made.box = {{x, y, 0}, {x + size, y + size, size}};
  made.rank = {made.box.diagonal(), number};
  made.weight = weight;
  return made;
}

std::vector<TileItem> random_items(std::size_t count) {
  std::mt19937 random(7);
  std::vector<TileItem> items;
  for (std::size_t i = 0; i < count; ++i) {
    items.push_back(item(static_cast<std::int64_t>(i), static_cast<double>(random() % 1'000'000),
                         static_cast<double>(random() % 400'000),
                         static_cast<double>(random() % 20)));
  }
  return items;
}

bool contains(const TileBox& outer, const TileBox& inner) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (inner.min[axis] < outer.min[axis] || inner.max[axis] > outer.max[axis]) return false;
  }
  return true;
}

TEST_CASE("each feature is in one tile, within its box and that of all tiles above") {
  const std::vector<TileItem> items = random_items(5000);
  const std::vector<Tile> tree = tiles::tile_tree(items, {.items = 64});
  std::multiset<std::size_t> seen;
  std::set<std::tuple<int, std::uint32_t, std::uint32_t>> places;
  for (const Tile& tile : tree) {
    CHECK(tile.items.size() <= 64);
    CHECK(places.insert({tile.level, tile.x, tile.y}).second);
    for (const std::size_t i : tile.items) {
      seen.insert(i);
      CHECK(contains(tile.box, items[i].box));
    }
    for (const std::size_t child : tile.children) {
      CHECK(contains(tile.box, tree[child].box));
      CHECK(tree[child].level == tile.level + 1);
    }
  }
  CHECK(seen.size() == items.size());
  CHECK(std::set<std::size_t>(seen.begin(), seen.end()).size() == items.size());
}

TEST_CASE("no tile has a feature that is larger than one of the tile above") {
  const std::vector<TileItem> items = random_items(3000);
  const std::vector<Tile> tree = tiles::tile_tree(items, {.items = 50});
  for (const Tile& tile : tree) {
    const double least = items[tile.items.back()].box.diagonal();
    CHECK(tile.largest_below <= least);
    for (const std::size_t child : tile.children) {
      CHECK(items[tree[child].items.front()].box.diagonal() <= tile.largest_below);
    }
    CHECK((tile.largest_below == 0) == tile.children.empty());
  }
}

TEST_CASE("a tile has the items in its bounds that rank below those of the tile above") {
  const std::vector<TileItem> items = random_items(2000);
  const std::vector<Tile> tree = tiles::tile_tree(items, {.items = 40});
  const std::function<void(const Tile&, const tiles::TileRank*)> check =
      [&](const Tile& tile, const tiles::TileRank* above) {
        const tiles::TileRank last = items[tile.items.back()].rank;
        std::size_t count = 0;
        for (const TileItem& item : items) {
          count += tile.bounds.contains(item.box) && item.rank >= last &&
                   (above == nullptr || item.rank < *above);
        }
        CHECK(count == tile.items.size());
        for (const std::size_t child : tile.children) check(tree[child], &last);
      };
  check(tree.front(), nullptr);
}

TEST_CASE("features in one place are in tiles beside each other") {
  std::vector<TileItem> items;
  for (std::int64_t i = 0; i < 500; ++i) items.push_back(item(i, 10, 10, 5));
  const std::vector<Tile> tree = tiles::tile_tree(items, {.items = 10, .levels = 6});
  CHECK(tree.size() == 50);
  for (const Tile& tile : tree) CHECK(tile.items.size() == 10);
  CHECK(tree[6].children.size() == 43);
  CHECK(tree.back().part == 43);
}

TEST_CASE("a heavy feature has a tile for itself") {
  const std::vector<TileItem> items{item(0, 0, 0, 100, 1000), item(1, 500, 500, 10, 5),
                                    item(2, 0, 500, 9, 5)};
  const std::vector<Tile> tree = tiles::tile_tree(items, {.weight = 100});
  REQUIRE(tree.size() == 3);
  CHECK(tree[0].items == std::vector<std::size_t>{0});
}

TEST_CASE("without features there are no tiles") { CHECK(tiles::tile_tree({}).empty()); }

}  // namespace
}  // namespace watertight
