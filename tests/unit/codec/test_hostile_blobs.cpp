// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the decoder with bytes that no encoder wrote. Every blob that decodes must give a
// well-formed boundary that can be encoded again.
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <string>

#include "codec/blob.h"
#include "codec/encode_boundary.h"
#include "codec/mode_walk/columns.h"
#include "codec/page.h"
#include "codec/page/modes.h"
#include "codec/page_file.h"
#include "geometry/canonical_form.h"
#include "tests/files.h"
#include "tests/generated/mutated_blobs.h"

using namespace watertight;

namespace {

/// Two plates of n x n squares of two triangles each, closed at the sides: a very regular surface.
OrientedBoundary plate(Index n) {
  SolidArrays arrays;
  const auto at = [n](Index x, Index y, Index z) { return (z * (n + 1) + x) * (n + 1) + y; };
  for (Index z = 0; z < 2; ++z) {
    for (Index x = 0; x <= n; ++x) {
      for (Index y = 0; y <= n; ++y) {
        arrays.vertices.push_back(
            {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
      }
    }
  }
  const auto square = [&](Index a, Index b, Index c, Index d) {
    generated::add_facet(arrays, {{a, b, c}});
    generated::add_facet(arrays, {{a, c, d}});
  };
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      square(at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0));
      square(at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1));
    }
    square(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1));
    square(at(i + 1, n, 0), at(i, n, 0), at(i, n, 1), at(i + 1, n, 1));
    square(at(0, i + 1, 0), at(0, i, 0), at(0, i, 1), at(0, i + 1, 1));
    square(at(n, i, 0), at(n, i + 1, 0), at(n, i + 1, 1), at(n, i, 1));
  }
  arrays.end_shell();
  return generated::boundary_of(std::move(arrays));
}

/// The same with vertices that no rule gives: its blob has bytes for each of them.
OrientedBoundary rough_plate(Index n) {
  generated::Random random(11);
  SolidArrays arrays = plate(n).solid().arrays();
  for (Point& vertex : arrays.vertices) {
    vertex.x = 1000 * vertex.x + static_cast<double>(random.below(300));
    vertex.y = 1000 * vertex.y + static_cast<double>(random.below(300));
    vertex.z = 1000 * vertex.z + static_cast<double>(random.below(300));
  }
  return generated::boundary_of(std::move(arrays));
}

/// A cone over n points of a parabola: its tip has degree n.
OrientedBoundary cone(Index n) {
  SolidArrays arrays;
  std::vector<Index> base;
  for (Index i = 0; i < n; ++i) {
    arrays.vertices.push_back({static_cast<double>(i), static_cast<double>(i) * i, 0});
    base.push_back(n - 1 - i);
  }
  arrays.vertices.push_back({1, 2, 9});
  generated::add_facet(arrays, {base});
  for (Index i = 0; i < n; ++i) generated::add_facet(arrays, {{i, (i + 1) % n, n}});
  arrays.end_shell();
  return generated::boundary_of(std::move(arrays));
}

/// A tetrahedron with n vertices on each of two opposite edges, whose Delaunay tetrahedralization
/// has (n - 1)^2 tetrahedra.
OrientedBoundary opposite_edges(Index n) {
  SolidArrays arrays;
  std::vector<std::vector<Index>> rings(4);
  for (Index i = 0; i < n; ++i) arrays.vertices.push_back({static_cast<double>(i), 0, 0});
  for (Index i = 0; i < n; ++i) arrays.vertices.push_back({0, static_cast<double>(i), 100});
  for (Index i = 0; i < n; ++i) {
    rings[0].push_back(i);
    rings[1].push_back(n - 1 - i);
    rings[2].push_back(2 * n - 1 - i);
    rings[3].push_back(n + i);
  }
  rings[0].push_back(n);
  rings[1].push_back(2 * n - 1);
  rings[2].push_back(n - 1);
  rings[3].push_back(0);
  for (const auto& ring : rings) generated::add_facet(arrays, {ring});
  arrays.end_shell();
  return generated::boundary_of(std::move(arrays));
}

bool read_any(ByteView bytes, const std::string& kind) {
  if (kind == ".blob") return bool{decode(bytes)};
  if (kind == ".page") return bool{codec::decode_page(bytes)};
  return bool{codec::PageFileReader::open(bytes)};
}

void require_automatic_mode_encodes(const OrientedBoundary& boundary, Mode not_in) {
  const auto blob = codec::encode_boundary(boundary, {}, {.keep_order = false});
  REQUIRE(blob);
  const auto decoded = decode(*blob);
  REQUIRE(decoded);
  CHECK(decoded->solid == geometry::canonical_form(boundary).boundary.solid());
  CHECK(decoded->info.mode != not_in);
  CHECK(decoded->info.mode != Mode::raw);
}

}  // namespace

TEST_CASE("a mode declines a solid whose few bytes a decoder would take for a bomb") {
  const OrientedBoundary small = plate(50);
  CHECK(codec::encode_boundary(small, {}, {.mode = Mode::parallelogram, .keep_order = false}));
  const OrientedBoundary large = plate(90);  // its blob has about 100 bytes
  const auto blob =
      codec::encode_boundary(large, {}, {.mode = Mode::parallelogram, .keep_order = false});
  REQUIRE_FALSE(blob);
  CHECK(blob.error().code == ErrorCode::not_encodable);
  require_automatic_mode_encodes(large, Mode::parallelogram);
}

TEST_CASE("mode walk declines a vertex of so many edges that the walk would take too long") {
  const OrientedBoundary large = cone(2000);
  CHECK(codec::encode_boundary(cone(300), {}, {.mode = Mode::walk}));
  const auto blob = codec::encode_boundary(large, {}, {.mode = Mode::walk});
  REQUIRE_FALSE(blob);
  CHECK(blob.error().code == ErrorCode::not_encodable);
  require_automatic_mode_encodes(large, Mode::walk);
}

TEST_CASE("mode walk declines vertices that have too many Delaunay tetrahedra") {
  CHECK(codec::encode_boundary(opposite_edges(90), {}, {.mode = Mode::walk}));
  const OrientedBoundary large = opposite_edges(150);
  const auto blob = codec::encode_boundary(large, {}, {.mode = Mode::walk});
  REQUIRE_FALSE(blob);
  CHECK(blob.error().code == ErrorCode::not_encodable);
  require_automatic_mode_encodes(large, Mode::walk);
}

TEST_CASE("limits hold for all solids of a page together") {
  const OrientedBoundary box = generated::box();
  const std::vector<const OrientedBoundary*> boxes(10, &box);
  for (const Mode mode : {Mode::raw, Mode::bitmap, Mode::walk, Mode::polygon}) {
    const auto page = codec::encode_boundaries(boxes, {}, {.mode = mode});
    REQUIRE(page);
    CHECK(
        codec::decode_page(*page, Limits{.vertices = 80, .facets = 60, .rings = 60, .shells = 10}));
    for (const Limits& limits :
         {Limits{.vertices = 79}, Limits{.facets = 59}, Limits{.rings = 59}, Limits{.shells = 9}}) {
      const auto decoded = codec::decode_page(*page, limits);
      REQUIRE_FALSE(decoded);
      CHECK(decoded.error().code == ErrorCode::limit_exceeded);
    }
  }
}

TEST_CASE("decode rejects truncated blobs") {
  for (const Bytes& blob : generated::seed_blobs(1)) {
    const std::size_t step = blob.size() < 200 ? 1 : blob.size() / 100;
    for (std::size_t size = 0; size < blob.size(); size += step) {
      const auto decoded = decode(ByteView(blob).first(size));
      REQUIRE_FALSE(decoded);
    }
  }
}

TEST_CASE("every prefix of every golden blob, page and page file is refused") {
  int files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(test::source_path("tests/golden/blobs"))) {
    const std::string kind = entry.path().extension();
    if (kind != ".blob" && kind != ".page" && kind != ".wtpf") continue;
    ++files;
    const Bytes bytes = test::read_bytes(entry.path());
    REQUIRE(read_any(bytes, kind));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const ByteView prefix = ByteView(bytes).first(size);
      if (read_any(prefix, kind)) FAIL(entry.path() << " cut off after " << size);
      if (kind != ".wtpf") (void)generated::decode_unchecked(prefix);
    }
  }
  CHECK(files > 40);
}

TEST_CASE("decode rejects bytes after the blob") {
  for (Bytes blob : generated::seed_blobs(1)) {
    blob.push_back(0);
    CHECK_FALSE(decode(blob));
  }
}

TEST_CASE("a mutated blob is rejected or still a boundary that encodes again") {
  generated::Random random(20261121);
  const auto blobs = generated::seed_blobs(2);
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    const Bytes blob = generated::mutated(blobs, random);
    const auto decoded = decode(blob);
    if (!decoded) continue;
    ++accepted;
    const auto boundary = OrientedBoundary::make(decoded->solid);
    REQUIRE(boundary);
    REQUIRE(codec::encode_boundary(*boundary, decoded->info.acceptance, {.mode = Mode::raw}));
  }
  // A mutated blob is accepted only if its mutations cancel out: all others fail the checksum.
  CHECK(accepted < 2000);
}

TEST_CASE("limits are checked before anything is decoded") {
  const auto blob = codec::encode_boundary(generated::pierced_block(1), {}, {.mode = Mode::raw});
  REQUIRE(blob);
  for (const Limits& limits : {Limits{.bytes = 100}, Limits{.vertices = 15}, Limits{.facets = 9},
                               Limits{.rings = 11}, Limits{.shells = 0}}) {
    const auto decoded = decode(*blob, limits);
    REQUIRE_FALSE(decoded);
    CHECK(decoded.error().code == ErrorCode::limit_exceeded);
  }
  CHECK(decode(
      *blob,
      Limits{.bytes = blob->size(), .vertices = 16, .facets = 10, .rings = 12, .shells = 1}));
}

TEST_CASE("other versions, models and modes are unsupported") {
  const auto blob = codec::encode_boundary(generated::box(), {}, {.mode = Mode::raw});
  REQUIRE(blob);
  const auto code_with = [&](std::size_t place, std::uint8_t value) {
    Bytes changed = *blob;
    changed[place] = value;
    const auto decoded = decode(changed);
    return decoded ? std::string("decoded") : std::string(to_string(decoded.error().code));
  };
  CHECK(code_with(0, 'X') == "malformed");
  CHECK(code_with(2, 0) == "unsupported");
  CHECK(code_with(2, 2) == "unsupported");
  CHECK(code_with(2, 0x81) == "malformed");  // 0x81 is a page, not a blob
  CHECK(code_with(3, 0xFF) == "unsupported");
}

TEST_CASE("a changed acceptance, lattice or order does not pass the checksum") {
  const auto blob = codec::encode_boundary(generated::box(), {}, {.mode = Mode::raw});
  REQUIRE(blob);
  const auto info = codec::describe(*blob);
  REQUIRE(info);
  std::size_t decoded_changed = 0;
  for (std::size_t i = 0; i < blob->size(); ++i) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      Bytes changed = *blob;
      changed[i] = static_cast<std::uint8_t>(changed[i] ^ (1U << bit));
      if (decode(changed)) ++decoded_changed;
    }
  }
  CHECK(decoded_changed == 0);
}

TEST_CASE("a blob whose models come to expect one answer does not decode without end") {
  for (const Mode mode :
       {Mode::raw, Mode::bitmap, Mode::walk, Mode::polygon, Mode::parallelogram}) {
    const auto blob = codec::encode_boundary(generated::torus(8, 4), {}, {.mode = mode});
    REQUIRE(blob);
    for (const unsigned byte : {0x00U, 0x55U, 0xFFU}) {
      for (const std::size_t kept : {std::size_t{10}, blob->size() / 2, blob->size() - 5}) {
        Bytes bomb(blob->begin(), blob->begin() + static_cast<std::ptrdiff_t>(kept));
        bomb.resize(20000, static_cast<std::uint8_t>(byte));
        CHECK_FALSE(decode(bomb, Limits{.vertices = 100'000}));
      }
    }
  }
}

TEST_CASE("only nearby columns of a page are considered for each column of a solid") {
  // All columns of the page are in the solid's range of x, and none is in its range of y: without a
  // bound, the search for each column of the solid would take minutes.
  codec::PageMemory memory;
  for (std::int64_t i = 0; i < 2'000'000; ++i) memory.columns.push_back({i / 4, 1'000'000 + i % 4});
  std::vector<codec::GridPoint> points;
  for (std::int64_t i = 0; i < 20'000; ++i) points.push_back({i * 25, i % 7, 0});
  const codec::ModelLayout& layout = codec::walk::model_layout();
  codec::ModelBank writing(layout);
  codec::EntropyStream writer = codec::EntropyStream::writer();
  REQUIRE(codec::walk::code_columns(writer, writing, memory, points, {}));
  const Bytes bytes = std::move(writer).finish();
  codec::ModelBank reading(layout);
  codec::EntropyStream reader = codec::EntropyStream::reader(bytes);
  std::vector<codec::GridPoint> read;
  REQUIRE(codec::walk::code_columns(reader, reading, memory, read, {}));
  CHECK(read == points);
}

TEST_CASE("encoding and decoding end soon after nobody wants the result") {
  const OrientedBoundary boundary = rough_plate(30);
  for (const Mode mode :
       {Mode::bitmap, Mode::walk, Mode::polygon, Mode::parallelogram, Mode::automatic}) {
    INFO(codec::to_string(mode));
    const auto blob = codec::encode_boundary(boundary, {}, {.mode = mode});
    REQUIRE(blob);
    int asked = 0;
    int patience = 1'000'000;
    const CancelPoll poll = [&] { return ++asked > patience; };
    Limits limits;
    limits.cancel = &poll;
    const auto again = codec::encode_boundary(boundary, {}, {.mode = mode, .cancel = &poll});
    REQUIRE(again);
    CHECK(*again == *blob);
    REQUIRE(decode(*blob, limits));
    for (const int wanted : {0, 2}) {
      patience = asked + wanted;
      const auto ended = codec::encode_boundary(boundary, {}, {.mode = mode, .cancel = &poll});
      REQUIRE_FALSE(ended);
      CHECK(ended.error().code == ErrorCode::cancelled);
      patience = asked + wanted;
      const auto decoded = decode(*blob, limits);
      REQUIRE_FALSE(decoded);
      CHECK(decoded.error().code == ErrorCode::cancelled);
    }
  }
}
