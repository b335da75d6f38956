// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>

#include "tiles/tileset.h"

namespace watertight {
namespace {

using Catch::Approx;
using Json = nlohmann::json;
using tiles::Frame;
using tiles::Tile;

std::vector<Tile> two_tiles() {
  std::vector<Tile> tree(2);
  tree[0].box = {{0, 0, 0}, {2048, 1024, 20}};
  tree[0].items = {0};
  tree[0].children = {1};
  tree[0].largest_below = 17;
  tree[1].level = 1;
  tree[1].x = 1;
  tree[1].box = {{1024, 0, 0}, {2048, 512, 10}};
  tree[1].items = {1};
  return tree;
}

TEST_CASE("the matrices of tiles lead to the origins of their contents") {
  const auto frame = Frame::at(28992, {155000, 463000, 0});
  REQUIRE(frame);
  const std::vector<Tile> tree = two_tiles();
  const Json json = Json::parse(tiles::tileset_json(tree, *frame, tiles::content_name));
  const Json& root = json["root"];
  const Json& child = root["children"][0];
  CHECK(child["content"]["uri"] == "1/1/0.glb");
  const auto matrix = frame->matrix();
  std::array<double, 3> metres{};
  const auto origin = tiles::origin_of(tree[1]);
  for (std::size_t axis = 0; axis < 3; ++axis) metres[axis] = origin[axis] / tiles::kStepsOfAMetre;
  for (std::size_t row = 0; row < 3; ++row) {
    double expected = matrix[12 + row];
    double found = root["transform"][12 + row];
    for (std::size_t k = 0; k < 3; ++k) {
      expected += matrix[k * 4 + row] * metres[k];
      found +=
          root["transform"][k * 4 + row].get<double>() * child["transform"][12 + k].get<double>();
    }
    CHECK(found == Approx(expected).margin(1e-6));
  }
}

TEST_CASE("errors grow less from tile to tile, boxes are around their origins") {
  const std::vector<Tile> tree = two_tiles();
  const auto frame = Frame::at(0, {0, 0, 0});
  REQUIRE(frame);
  const Json json = Json::parse(tiles::tileset_json(tree, *frame, tiles::content_name));
  CHECK(json["asset"]["version"] == "1.1");
  CHECK(json["root"]["refine"] == "ADD");
  CHECK(json["geometricError"].get<double>() > 2000);
  CHECK(json["root"]["geometricError"] == 17);
  CHECK(json["root"]["children"][0]["geometricError"] == 0);
  const Json& box = json["root"]["boundingVolume"]["box"];
  CHECK(box == Json::array({0, 0, 0, 1024, 0, 0, 0, 512, 0, 0, 0, 10}));
}

TEST_CASE("a tileset without features is a tileset") {
  const Json json = Json::parse(tiles::tileset_json({}, Frame(), tiles::content_name));
  CHECK_FALSE(json["root"].contains("content"));
  CHECK(json["geometricError"] == 0);
  CHECK(json["root"]["boundingVolume"]["box"].size() == 12);
}

}  // namespace
}  // namespace watertight
