// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "codec/blob.h"
#include "codec/encode_boundary.h"
#include "delaunay/certificate.h"
#include "geometry/canonical_form.h"
#include "tests/generated/generated_solids.h"

using namespace watertight;

namespace {

const std::vector<generated::NamedBoundary>& solids() {
  static const auto all = generated::all(20261121);
  return all;
}

Bytes encoded(const OrientedBoundary& boundary, const EncodeOptions& options) {
  auto blob = codec::encode_boundary(boundary, Acceptance{}, options);
  if (!blob) FAIL(to_string(blob.error()));
  return *blob;
}

constexpr std::array kModes{Mode::raw,     Mode::bitmap,        Mode::walk,
                            Mode::polygon, Mode::parallelogram, Mode::automatic};

/// The blob, or nothing if the mode cannot hold the solid; raw, bitmap and automatic hold all of
/// solids().
std::optional<Bytes> blob_if_held(const OrientedBoundary& boundary, const EncodeOptions& options) {
  auto blob = codec::encode_boundary(boundary, Acceptance{}, options);
  if (blob) return *std::move(blob);
  const Mode mode = options.mode;
  CHECK(blob.error().code == ErrorCode::not_encodable);
  CHECK((mode == Mode::walk || mode == Mode::polygon || mode == Mode::parallelogram));
  return std::nullopt;
}

}  // namespace

TEST_CASE("every mode that holds a solid brings it back in source order") {
  for (const auto& [name, boundary] : solids()) {
    for (const Mode mode : kModes) {
      INFO(name << ", " << codec::to_string(mode));
      const auto blob = blob_if_held(boundary, {.mode = mode});
      if (!blob) continue;
      const auto decoded = decode(*blob);
      REQUIRE(decoded);
      CHECK(decoded->solid == boundary.solid());
      CHECK(decoded->info.facets == boundary.solid().facet_count());
    }
  }
}

TEST_CASE("without source order a blob is the same for every arrangement of the source") {
  generated::Random random(7);
  for (const auto& [name, boundary] : solids()) {
    for (const Mode mode : kModes) {
      INFO(name << ", " << codec::to_string(mode));
      const auto blob = blob_if_held(boundary, {.mode = mode, .keep_order = false});
      if (!blob) continue;
      const OrientedBoundary other = generated::shuffled(boundary, random);
      CHECK(encoded(other, {.mode = mode, .keep_order = false}) == *blob);
      const auto decoded = decode(*blob);
      REQUIRE(decoded);
      CHECK_FALSE(decoded->info.has_order);
      CHECK(decoded->solid == geometry::canonical_form(boundary).boundary.solid());
    }
  }
}

TEST_CASE("automatic takes the smallest blob") {
  for (const auto& [name, boundary] : solids()) {
    INFO(name);
    const std::size_t automatic = encoded(boundary, {.mode = Mode::automatic}).size();
    for (const Mode mode : kModes) {
      const auto blob = blob_if_held(boundary, {.mode = mode});
      // The encoder estimates costs to the bit, but sizes are whole bytes.
      if (blob) CHECK(automatic <= blob->size() + 1);
    }
  }
}

TEST_CASE("acceptance, SRID and lattice come back in every mode for polygons") {
  const OrientedBoundary boundary = generated::box();
  Acceptance acceptance;
  acceptance.tolerances = {0.25, 7.5, 0.001};
  acceptance.proof = Proof::boundary;
  acceptance.rule_set = 300;
  for (const Mode mode : {Mode::raw, Mode::bitmap, Mode::walk, Mode::polygon}) {
    const auto blob = codec::encode_boundary(boundary, acceptance, {.mode = mode});
    REQUIRE(blob);
    const auto info = codec::describe(*blob);
    REQUIRE(info);
    CHECK(info->acceptance == acceptance);
    CHECK(info->srid == 7415);
    CHECK(info->lattice == boundary.solid().lattice());
    CHECK(info->mode == mode);
  }
}

TEST_CASE("a house 0.0001 degrees wide with one corner 3 cm up comes back") {
  // The roof is not flat: the SRID decides about the projection, and with it whether the roof has
  // triangles.
  SolidArrays arrays;
  generated::add_box(arrays, {0, 0, 0}, {1000, 800, 6000});
  for (Point& p : arrays.vertices) {
    if (p.x == 1000 && p.y == 800) p.z += 30;
  }
  Lattice lattice;
  lattice.step = {GridNumber{1, -7}, GridNumber{1, -7}, GridNumber{1, -3}};
  lattice.origin = {GridNumber{1397, -1}, GridNumber{3568, -2}, GridNumber{3, 0}};
  generated::Random random(3);
  for (const std::uint32_t srid : {4326U, 6697U}) {
    const OrientedBoundary house = generated::boundary_of(arrays, lattice, srid);
    for (const Mode mode : {Mode::raw, Mode::bitmap}) {
      INFO(srid << ", " << codec::to_string(mode));
      const auto decoded = decode(encoded(house, {.mode = mode}));
      REQUIRE(decoded);
      CHECK(decoded->solid == house.solid());
      const Bytes blob = encoded(house, {.mode = mode, .keep_order = false});
      const OrientedBoundary other = generated::shuffled(house, random);
      CHECK(encoded(other, {.mode = mode, .keep_order = false}) == blob);
    }
  }
}

TEST_CASE("the parts of a blob add up to its size") {
  for (const auto& [name, boundary] : solids()) {
    const Bytes blob = encoded(boundary, {.mode = Mode::bitmap});
    const auto info = codec::describe(blob);
    REQUIRE(info);
    double sum = 0;
    for (const auto& part : info->parts) sum += part.bytes;
    // A stream ends on a whole byte, and the sizes of parts are estimated fractions.
    const double rest = static_cast<double>(blob.size()) - sum;
    CHECK(rest > -0.5);
    CHECK(rest < 2);
    CHECK(info->marked_faces > 0);
    CHECK(info->delaunay_faces >= info->marked_faces);
  }
}

TEST_CASE("a certificate's Steiner vertices are stored and leave the polygons alone") {
  generated::Random random(3);
  const delaunay::Certificate certificate = generated::schoenhardt_certificate();
  const OrientedBoundary boundary = generated::schoenhardt();
  const Bytes blob = encoded(boundary, {.mode = Mode::bitmap, .certificate = &certificate});
  const auto decoded = decode(blob);
  REQUIRE(decoded);
  CHECK(decoded->solid == boundary.solid());
  CHECK(decoded->info.steiner_vertices == 1);
}

TEST_CASE("Steiner vertices on edges and in facets are dropped from rings") {
  // The certificate of a box, as an engine would make it: one edge is split at its middle, and one
  // facet has a vertex inside.
  const OrientedBoundary boundary = generated::box();
  const Solid& solid = boundary.solid();
  delaunay::Certificate certificate;
  delaunay::Tetrahedralization& mesh = certificate.tetrahedralization;
  mesh.points.assign(solid.vertices().begin(), solid.vertices().end());
  mesh.input_count = solid.vertex_count();
  const auto ring = solid.ring(0);
  const Point a = solid.vertices()[ring[0]];
  const Point b = solid.vertices()[ring[1]];
  const Index middle = mesh.input_count;
  const Index inside = middle + 1;
  mesh.points.push_back({(a.x + b.x) / 2, (a.y + b.y) / 2 + 0.0, (a.z + b.z) / 2});
  mesh.points.push_back({6000.25, 4000.5, 0});
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    std::vector<Index> outline;
    const auto vertices = solid.ring(facet);
    for (std::size_t i = 0; i < 4; ++i) {
      const Index from = vertices[i];
      const Index to = vertices[(i + 1) % 4];
      outline.push_back(from);
      const bool is_split =
          (from == ring[0] && to == ring[1]) || (from == ring[1] && to == ring[0]);
      if (is_split) outline.push_back(middle);
    }
    if (facet == 0) {
      for (std::size_t i = 0; i < outline.size(); ++i) {
        mesh.constrained.push_back(
            {{outline[i], outline[(i + 1) % outline.size()], inside}, facet});
      }
      continue;
    }
    // The fan starts at the split vertex, or at the first one, so that no triangle is flat.
    const auto split = std::find(outline.begin(), outline.end(), middle);
    if (split != outline.end()) std::rotate(outline.begin(), split, outline.end());
    for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
      mesh.constrained.push_back({{outline[0], outline[i], outline[i + 1]}, facet});
    }
  }
  const auto blob =
      codec::encode_boundary(boundary, {}, {.mode = Mode::bitmap, .certificate = &certificate});
  REQUIRE(blob);
  const auto decoded = decode(*blob);
  REQUIRE(decoded);
  CHECK(decoded->info.steiner_vertices == 2);
  CHECK(decoded->solid == solid);
}

TEST_CASE("a certificate of another solid is refused") {
  const delaunay::Certificate certificate = generated::schoenhardt_certificate();
  const auto blob = codec::encode_boundary(generated::box(), {},
                                           {.mode = Mode::bitmap, .certificate = &certificate});
  REQUIRE_FALSE(blob);
  CHECK(blob.error().code == ErrorCode::not_encodable);
}

TEST_CASE("modes raw and bitmap hold integers of more than 30 bits") {
  for (const double size : {0x1p30, 0x1p53}) {
    SolidArrays arrays;
    generated::add_box(arrays, {0, 0, 0}, {size, 1, 5});
    const OrientedBoundary boundary = generated::boundary_of(std::move(arrays));
    for (const Mode mode : {Mode::raw, Mode::bitmap}) {
      const auto decoded = decode(encoded(boundary, {.mode = mode}));
      REQUIRE(decoded);
      CHECK(decoded->solid == boundary.solid());
    }
  }
}

TEST_CASE("coordinates beyond a safe Delaunay tetrahedralization fall back to raw") {
  Lattice doubles;
  doubles.kind = LatticeKind::float64;
  for (const double size : {0x1p101, 0x1p1000, 0x1p-101, 0x1p-1074}) {
    SolidArrays arrays;
    generated::add_box(arrays, {0, 0, 0}, {size, 1, 5});
    const OrientedBoundary boundary = generated::boundary_of(std::move(arrays), doubles, 0);
    const auto bitmap = codec::encode_boundary(boundary, {}, {.mode = Mode::bitmap});
    REQUIRE_FALSE(bitmap);
    CHECK(bitmap.error().code == ErrorCode::not_encodable);
    const auto decoded = decode(encoded(boundary, {.mode = Mode::automatic}));
    REQUIRE(decoded);
    CHECK(decoded->info.mode == Mode::raw);
    CHECK(decoded->solid == boundary.solid());
  }
}

TEST_CASE("a flat boundary is encoded raw") {
  // Two triangles back to back: they are closed and oriented, but have no volume.
  SolidArrays arrays;
  arrays.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}};
  generated::add_facet(arrays, {{0, 1, 2}});
  generated::add_facet(arrays, {{0, 2, 1}});
  arrays.end_shell();
  const OrientedBoundary boundary = generated::boundary_of(std::move(arrays));
  CHECK_FALSE(codec::encode_boundary(boundary, {}, {.mode = Mode::bitmap}));
  const auto decoded = decode(encoded(boundary, {.mode = Mode::automatic}));
  REQUIRE(decoded);
  CHECK(decoded->solid == boundary.solid());
}
