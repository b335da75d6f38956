// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the decoder does with bytes that no encoder wrote. Every blob that decodes must be a
// well-formed boundary that encodes again.
#include <catch2/catch_test_macros.hpp>

#include "codec/blob.h"
#include "codec/columns.h"
#include "codec/encode_boundary.h"
#include "mutated_blobs.h"

using namespace watertight;

TEST_CASE("decode rejects truncated blobs") {
  for (const Bytes& blob : generated::seed_blobs(1)) {
    const std::size_t step = blob.size() < 200 ? 1 : blob.size() / 100;
    for (std::size_t size = 0; size < blob.size(); size += step) {
      const auto decoded = decode(ByteView(blob).first(size));
      REQUIRE_FALSE(decoded);
    }
  }
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
    REQUIRE(encode_boundary(*boundary, decoded->info.acceptance, {.mode = Mode::raw}));
  }
  // Mutations that cancel out leave the blob as it was; nothing else passes the checksum.
  CHECK(accepted < 1000);
}

TEST_CASE("limits are checked before anything is decoded") {
  const auto blob = encode_boundary(generated::pierced_block(1), {}, {.mode = Mode::raw});
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
  const auto blob = encode_boundary(generated::box(), {}, {.mode = Mode::raw});
  REQUIRE(blob);
  const auto code_with = [&](std::size_t place, std::uint8_t value) {
    Bytes changed = *blob;
    changed[place] = value;
    const auto decoded = decode(changed);
    return decoded ? std::string("decoded") : std::string(to_string(decoded.error().code));
  };
  CHECK(code_with(0, 'X') == "malformed");
  CHECK(code_with(2, 2) == "unsupported");
  CHECK(code_with(2, 0x81) == "malformed");  // a page
  CHECK(code_with(3, 0xFF) == "unsupported");
}

TEST_CASE("a changed acceptance, lattice or order does not pass the checksum") {
  const auto blob = encode_boundary(generated::box(), {}, {.mode = Mode::raw});
  REQUIRE(blob);
  const auto info = describe(*blob);
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

TEST_CASE("models that come to expect one answer do not make a long blob without end") {
  for (const Mode mode :
       {Mode::raw, Mode::bitmap, Mode::walk, Mode::polygon, Mode::parallelogram}) {
    const auto blob = encode_boundary(generated::torus(8, 4), {}, {.mode = mode});
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

TEST_CASE("of the columns of a page only those nearby are looked at for each of a solid") {
  // All of the page's are in the solid's range of x and none is in its range of y: without a bound
  // each place would look at all of them, which takes minutes.
  PageMemory memory;
  for (std::int64_t i = 0; i < 2'000'000; ++i) memory.columns.push_back({i / 4, 1'000'000 + i % 4});
  std::vector<GridPoint> points;
  for (std::int64_t i = 0; i < 20'000; ++i) points.push_back({i * 25, i % 7, 0});
  const ModelLayout layout{kColumnFamilies, kColumnNumbers};
  ModelBank writing(layout);
  EntropyStream writer = EntropyStream::writer();
  REQUIRE(code_columns(writer, {writing, 0, 0}, memory, points, {}));
  const Bytes bytes = std::move(writer).finish();
  ModelBank reading(layout);
  EntropyStream reader = EntropyStream::reader(bytes);
  std::vector<GridPoint> read;
  REQUIRE(code_columns(reader, {reading, 0, 0}, memory, read, {}));
  CHECK(read == points);
}
