// SPDX-License-Identifier: GPL-3.0-or-later
#include "tiles/tile_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace watertight::tiles {
namespace {

std::array<double, 2> middle_of(const TileBox& box) {
  return {(box.min[0] + box.max[0]) / 2, (box.min[1] + box.max[1]) / 2};
}

/// The square around a box, whose upper bounds the box does not reach.
TileBounds bounds_around(const TileBox& box) {
  const double side = std::max(box.max[0] - box.min[0], box.max[1] - box.min[1]);
  TileBounds bounds;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    bounds.min[axis] = box.min[axis];
    bounds.max[axis] =
        std::nextafter(std::max(box.min[axis] + side, box.max[axis]), TileBox::kEndless);
  }
  return bounds;
}

class TreeBuilder {
 public:
  TreeBuilder(std::span<const TileItem> items, const TileLimits& limits)
      : items_(items), limits_(limits) {}

  std::vector<Tile> build() {
    Tile root;
    TileBox all;
    for (const TileItem& item : items_) all.include(item.box);
    root.bounds = bounds_around(all);
    std::vector<std::size_t> order(items_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return items_[b].rank < items_[a].rank; });
    add(std::move(root), order);
    return std::move(tiles_);
  }

 private:
  using Order = std::span<const std::size_t>;

  /// Adds the tile with `order`, the items of its square by rank, and the tiles below; returns its
  /// number.
  std::size_t add(Tile tile, Order order) {
    const std::size_t own = own_items(order);
    for (const std::size_t item : order) tile.box.include(items_[item].box);
    const std::size_t number = add_alone(tile, order.first(own));
    const Order rest = order.subspan(own);
    if (rest.empty()) return number;
    tiles_[number].largest_below = items_[rest.front()].rank.size;
    if (tile.level >= limits_.levels) {
      add_parts(number, tile, rest);
    } else {
      add_quarters(number, tile, rest);
    }
    return number;
  }

  std::size_t add_alone(Tile tile, Order own) {
    tile.items.assign(own.begin(), own.end());
    tiles_.push_back(std::move(tile));
    return tiles_.size() - 1;
  }

  void add_quarters(std::size_t number, const Tile& tile, Order rest) {
    const std::array<double, 2> middle{(tile.bounds.min[0] + tile.bounds.max[0]) / 2,
                                       (tile.bounds.min[1] + tile.bounds.max[1]) / 2};
    std::array<std::vector<std::size_t>, 4> quarters;
    for (const std::size_t item : rest) {
      const auto place = middle_of(items_[item].box);
      quarters[(place[0] < middle[0] ? 0U : 1U) + (place[1] < middle[1] ? 0U : 2U)].push_back(item);
    }
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
      if (quarters[quarter].empty()) continue;
      const std::array<std::uint32_t, 2> side{quarter % 2, quarter / 2};
      Tile child;
      child.level = tile.level + 1;
      child.x = tile.x * 2 + side[0];
      child.y = tile.y * 2 + side[1];
      child.bounds = tile.bounds;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        (side[axis] == 0 ? child.bounds.max : child.bounds.min)[axis] = middle[axis];
      }
      const std::size_t below = add(std::move(child), quarters[quarter]);
      tiles_[number].children.push_back(below);
    }
  }

  /// Adds the rest of a square that is not divided further, as tiles beside each other.
  void add_parts(std::size_t number, const Tile& tile, Order rest) {
    for (std::size_t part = 1; !rest.empty(); ++part) {
      Tile child = tile;
      child.part = part;
      child.box = TileBox();
      const Order own = rest.first(own_items(rest));
      for (const std::size_t item : own) child.box.include(items_[item].box);
      const std::size_t below = add_alone(std::move(child), own);
      tiles_[number].children.push_back(below);
      rest = rest.subspan(own.size());
    }
  }

  std::size_t own_items(Order order) const {
    std::size_t count = 0;
    std::uint64_t weight = 0;
    for (const std::size_t item : order) {
      weight += items_[item].weight;
      if (count > 0 && (count >= limits_.items || weight > limits_.weight)) break;
      ++count;
    }
    return count;
  }

  std::span<const TileItem> items_;
  const TileLimits& limits_;
  std::vector<Tile> tiles_;
};

}  // namespace

void TileBox::include(const TileBox& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    min[axis] = std::min(min[axis], box.min[axis]);
    max[axis] = std::max(max[axis], box.max[axis]);
  }
}

double TileBox::diagonal() const {
  if (is_empty()) return 0;
  return std::hypot(max[0] - min[0], max[1] - min[1], max[2] - min[2]);
}

bool TileBounds::contains(const TileBox& box) const {
  const auto place = middle_of(box);
  return min[0] <= place[0] && place[0] < max[0] && min[1] <= place[1] && place[1] < max[1];
}

std::vector<Tile> tile_tree(std::span<const TileItem> items, const TileLimits& limits) {
  if (items.empty()) return {};
  return TreeBuilder(items, limits).build();
}

}  // namespace watertight::tiles
