// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cstdint>
#include <map>
#include <utility>

#include "tiles/pin.h"

namespace watertight {
namespace {

using tiles::FeatureMesh;
using tiles::GridPosition;

const auto& pin_triangles(const FeatureMesh& mesh) {
  return mesh.triangles[static_cast<std::size_t>(tiles::Look::finding)];
}

TEST_CASE("the tip of a pin is at its place") {
  FeatureMesh mesh;
  tiles::add_pin(mesh, {1024, -2048, 512});
  CHECK(mesh.vertices.front() == GridPosition{1024, -2048, 512});
  const tiles::TileBox box = mesh.box();
  CHECK(box.min == std::array<double, 3>{1 - tiles::kPinRadius, -2 - tiles::kPinRadius, 0.5});
  CHECK(box.max == std::array<double, 3>{1 + tiles::kPinRadius, -2 + tiles::kPinRadius,
                                         0.5 + tiles::kPinHeight});
}

TEST_CASE("a pin is closed, and its volume is positive") {
  FeatureMesh mesh;
  tiles::add_pin(mesh, {});
  tiles::add_pin(mesh, {5000, 0, 0});
  CHECK(pin_triangles(mesh).size() == 16);
  std::map<std::pair<Index, Index>, int> edges;
  std::int64_t volume = 0;  // six times
  for (const Triangle& triangle : pin_triangles(mesh)) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
    const auto at = [&](std::size_t corner, std::size_t axis) {
      return std::int64_t{mesh.vertices[triangle[corner]][axis]};
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const std::size_t k = (i + 2) % 3;
      volume += at(0, i) * (at(1, j) * at(2, k) - at(1, k) * at(2, j));
    }
  }
  for (const auto& [edge, count] : edges) {
    CHECK(count == 1);
    CHECK(edges.contains({edge.second, edge.first}));
  }
  CHECK(volume > 0);
}

TEST_CASE("a pin at the end of the grid is cut off there") {
  FeatureMesh mesh;
  tiles::add_pin(mesh, {INT32_MAX, 0, INT32_MAX});
  CHECK(mesh.vertices.back() == GridPosition{INT32_MAX, 0, INT32_MAX});
}

}  // namespace
}  // namespace watertight
