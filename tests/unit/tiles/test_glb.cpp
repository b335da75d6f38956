// SPDX-License-Identifier: GPL-3.0-or-later
#include <meshoptimizer.h>

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tiles/glb.h"

namespace watertight {
namespace {

using Json = nlohmann::json;
using tiles::Compression;
using tiles::FeatureMesh;
using tiles::GridPosition;
using tiles::Look;

/// A square of two triangles, a metre wide, at `x` metres.
FeatureMesh square(const std::string& id, std::int32_t x) {
  FeatureMesh mesh;
  mesh.id = id;
  mesh.type = "Building";
  const std::int32_t west = x * 1024;
  mesh.vertices = {{west, 0, 0}, {west + 1024, 0, 0}, {west + 1024, 1024, 512}, {west, 1024, 512}};
  mesh.triangles[static_cast<std::size_t>(Look::roof)] = {{0, 1, 2}};
  mesh.triangles[static_cast<std::size_t>(Look::wall)] = {{0, 2, 3}};
  return mesh;
}

struct Parsed {
  Json json;
  Bytes binary;

  ByteView view(std::size_t number) const {
    const Json& view = json["bufferViews"][number];
    const Json& place =
        view.contains("extensions") ? view["extensions"]["EXT_meshopt_compression"] : view;
    return ByteView(binary).subspan(place["byteOffset"].get<std::size_t>(),
                                    place["byteLength"].get<std::size_t>());
  }
  std::string text(std::size_t view_number) const {
    return std::string(as_text(view(view_number)));
  }
};

std::uint32_t word(ByteView bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

Parsed parse(const Bytes& glb) {
  REQUIRE(glb.size() > 28);
  CHECK(as_text(ByteView(glb).first(4)) == "glTF");
  CHECK(word(glb, 4) == 2);
  CHECK(word(glb, 8) == glb.size());
  const std::size_t length = word(glb, 12);
  CHECK(as_text(ByteView(glb).subspan(16, 4)) == "JSON");
  Parsed parsed;
  parsed.json = Json::parse(as_text(ByteView(glb).subspan(20, length)));
  const std::size_t start = 20 + length;
  CHECK(start + 8 + word(glb, start) == glb.size());
  CHECK(word(glb, start + 4) == 0x004E4942);
  parsed.binary.assign(glb.begin() + static_cast<std::ptrdiff_t>(start + 8), glb.end());
  CHECK(parsed.json["buffers"][0]["byteLength"] == parsed.binary.size());
  return parsed;
}

Bytes written(const std::vector<FeatureMesh>& meshes, Compression compression,
              const GridPosition& origin = {}) {
  std::vector<const FeatureMesh*> features;
  for (const FeatureMesh& mesh : meshes) features.push_back(&mesh);
  return tiles::write_glb(features, origin, compression);
}

/// The three positions of each triangle, smallest first, in any order.
using Positions = std::multiset<std::array<std::array<float, 3>, 3>>;

Positions triangles_of(const Parsed& glb, bool is_compressed) {
  const Json& accessors = glb.json["accessors"];
  const Json& positions = accessors[0];
  const std::size_t count = positions["count"];
  std::vector<std::array<float, 3>> vertices(count);
  const ByteView stored = glb.view(positions["bufferView"]);
  if (is_compressed) {
    REQUIRE(meshopt_decodeVertexBuffer(vertices.data(), count, 12, stored.data(), stored.size()) ==
            0);
  } else {
    std::memcpy(vertices.data(), stored.data(), stored.size());
  }
  Positions triangles;
  for (const Json& primitive : glb.json["meshes"][0]["primitives"]) {
    const Json& indices = accessors[primitive["indices"].get<std::size_t>()];
    std::vector<std::uint16_t> corners(indices["count"].get<std::size_t>());
    const ByteView bytes = glb.view(indices["bufferView"]);
    if (is_compressed) {
      REQUIRE(meshopt_decodeIndexBuffer(corners.data(), corners.size(), 2, bytes.data(),
                                        bytes.size()) == 0);
    } else {
      std::memcpy(corners.data(), bytes.data(), bytes.size());
    }
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      std::array<std::array<float, 3>, 3> triangle{vertices[corners[i]], vertices[corners[i + 1]],
                                                   vertices[corners[i + 2]]};
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                  triangle.end());
      triangles.insert(triangle);
    }
  }
  return triangles;
}

TEST_CASE("a glb has y up, metres from its origin, and the bounds of its positions") {
  const Parsed glb = parse(written({square("a", 5)}, Compression::none, {4 * 1024, 0, 0}));
  const Positions expected{{{{1, 0, 0}, {2, 0, 0}, {2, 0.5, -1}}},
                           {{{1, 0, 0}, {2, 0.5, -1}, {1, 0.5, -1}}}};
  CHECK(triangles_of(glb, false) == expected);
  CHECK(glb.json["accessors"][0]["min"] == Json::array({1, 0, -1}));
  CHECK(glb.json["accessors"][0]["max"] == Json::array({2, 0.5, 0}));
  CHECK(glb.json["materials"][0]["name"] == "roof");
  CHECK(glb.json["materials"][1]["name"] == "wall");
}

TEST_CASE("a compressed glb has the triangles of an uncompressed one, and the same bytes again") {
  std::vector<FeatureMesh> meshes;
  for (std::int32_t i = 0; i < 100; ++i) meshes.push_back(square(std::to_string(i), 2 * i));
  const Bytes compressed = written(meshes, Compression::meshopt);
  CHECK(compressed == written(meshes, Compression::meshopt));
  const Positions triangles = triangles_of(parse(compressed), true);
  CHECK(triangles.size() == 200);
  CHECK(triangles == triangles_of(parse(written(meshes, Compression::none)), false));
}

TEST_CASE("properties are numbers where all values are, else texts, and can be absent") {
  std::vector<FeatureMesh> meshes{square("a", 0), square("b", 2)};
  meshes[0].properties = {
      {"height", "12.5"}, {"a b", R"("x\"y")"}, {"floors", "3"}, {"none", "null"}};
  meshes[1].properties = {{"a-b", "true"}, {"floors", R"("many")"}};
  const Parsed glb = parse(written(meshes, Compression::meshopt));
  const Json& metadata = glb.json["extensions"]["EXT_structural_metadata"];
  const Json& schema = metadata["schema"]["classes"]["feature"]["properties"];
  const Json& table = metadata["propertyTables"][0];
  CHECK(table["count"] == 2);
  CHECK(schema["height"]["componentType"] == "FLOAT64");
  CHECK(schema["floors"]["type"] == "STRING");
  CHECK(schema["a_b"]["name"] == "a b");
  CHECK(schema["a_b_2"]["name"] == "a-b");
  CHECK_FALSE(schema.contains("none"));
  const auto text = [&](const char* id) { return glb.text(table["properties"][id]["values"]); };
  CHECK(text("id") == "ab");
  CHECK(text("type") == "BuildingBuilding");
  CHECK(text("floors") == "3many");
  CHECK(text("a_b") == "x\"y");
  std::array<double, 2> heights{};
  std::memcpy(heights.data(), glb.view(table["properties"]["height"]["values"]).data(), 16);
  CHECK(heights[0] == 12.5);
  CHECK(heights[1] == schema["height"]["noData"].get<double>());
}

TEST_CASE("each vertex has the number of its feature") {
  const Parsed glb = parse(written({square("a", 0), square("b", 2)}, Compression::none));
  const Json& primitive = glb.json["meshes"][0]["primitives"][0];
  CHECK(primitive["extensions"]["EXT_mesh_features"]["featureIds"][0]["featureCount"] == 2);
  const std::size_t accessor = primitive["attributes"]["_FEATURE_ID_0"];
  const ByteView ids = glb.view(glb.json["accessors"][accessor]["bufferView"]);
  const ByteView positions = glb.view(glb.json["accessors"][0]["bufferView"]);
  REQUIRE(ids.size() == 8 * 4);
  for (std::size_t i = 0; i < 8; ++i) {
    float x = 0;
    std::memcpy(&x, positions.data() + i * 12, sizeof x);
    CHECK(word(ids, i * 4) == (x < 1.5F ? 0U : 1U));
  }
}

TEST_CASE("lines and points have primitives of their own") {
  FeatureMesh mesh = square("a", 0);
  mesh.lines = {{0, 1}};
  mesh.points = {2};
  for (const auto compression : {Compression::none, Compression::meshopt}) {
    const Parsed glb = parse(written({mesh}, compression));
    const Json& primitives = glb.json["meshes"][0]["primitives"];
    REQUIRE(primitives.size() == 4);
    CHECK(primitives[2]["mode"] == 1);
    CHECK(primitives[3]["mode"] == 0);
  }
}

}  // namespace
}  // namespace watertight
