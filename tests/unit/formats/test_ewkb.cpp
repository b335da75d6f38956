// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>
#include <catch2/catch_test_macros.hpp>
#include <limits>
#include <string>

#include "formats/ewkb.h"
#include "samples.h"

namespace watertight::test_ewkb {
namespace {

const std::string kHoled =
    "SRID=7415;POLYHEDRALSURFACE Z (((84616.468 447000.1 0,4 0 0.5,0 4 0,84616.468 447000.1 0),"
    "(1 1 0,1 2 0,2 1 0,1 1 0)),((0 4 0,4 0 0.5,1 1 0,0 4 0)))";
const std::string kHollow =
    "SOLID Z ((((0 0 0,9 0 0,0 9 0,0 0 0)),((0 0 0,0 0 9,9 0 0,0 0 0))),"
    "(((1 1 1,2 1 1,1 2 1,1 1 1))))";

// Writes EWKB in big-endian order, which write_ewkb never makes.
class BigEndian {
 public:
  void u8(std::uint8_t value) { bytes.push_back(value); }
  void u32(std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) {
      bytes.push_back(static_cast<std::uint8_t>(value >> shift));
    }
  }
  void f64(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    u32(static_cast<std::uint32_t>(bits >> 32));
    u32(static_cast<std::uint32_t>(bits));
  }
  Bytes bytes;
};

Bytes one_triangle(std::uint32_t surface, std::uint32_t polygon, double z_of_last) {
  BigEndian out;
  out.u8(0);
  out.u32(surface);
  out.u32(1);
  out.u8(0);
  out.u32(polygon);
  out.u32(1);
  out.u32(4);
  for (const double value : {0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, z_of_last}) {
    out.f64(value);
  }
  return out.bytes;
}

TEST_CASE("WKT comes back digit by digit") {
  for (const std::string& text : {kHoled, kHollow}) {
    const auto solid = formats::read_wkt(text);
    REQUIRE(solid);
    CHECK(formats::write_wkt(solid->solid) == text);
  }
}

TEST_CASE("WKT merges equal points and drops the closing point") {
  const auto solid = formats::read_wkt(kHoled);
  REQUIRE(solid);
  CHECK(solid->solid.srid() == 7415);
  CHECK(solid->solid.vertex_count() == 6);
  CHECK(solid->solid.facet_count() == 2);
  CHECK(solid->solid.ring_count() == 3);
  CHECK(solid->solid.ring(2)[2] == 3);
  CHECK(solid->source.geometry_type == "POLYHEDRALSURFACE Z");
}

TEST_CASE("WKT is read in every spelling") {
  const auto solid = formats::read_wkt("POLYHEDRALSURFACE Z (((0 0 0,1 0 0,0 1 0,0 0 0)))");
  REQUIRE(solid);
  for (const char* text : {"polyhedralsurface(((0 0 0,1 0 0,0 1 0,0 0 0)))",
                           " PolyhedralSurfaceZ ( ( ( 0 0 0 , 1.0 0 0 ,\n 0 +1e0 -0,0 0 0 ) ) ) ; ",
                           "TIN Z (((0 0 0,1 0 0,0 1 0,0 0 0)))"}) {
    const auto other = formats::read_wkt(text);
    REQUIRE(other);
    CHECK(other->solid == solid->solid);
  }
  const auto empty = formats::read_wkt("SRID=4979;POLYHEDRALSURFACE Z EMPTY");
  REQUIRE(empty);
  CHECK(empty->solid.facet_count() == 0);
  CHECK(formats::write_wkt(empty->solid) == "SRID=4979;POLYHEDRALSURFACE Z EMPTY");
}

TEST_CASE("WKT errors name the byte") {
  const auto error_of = [](std::string_view text) {
    const auto solid = formats::read_wkt(text);
    REQUIRE_FALSE(solid);
    REQUIRE(solid.error().byte_offset);
    return solid.error();
  };
  CHECK(error_of("").code == ErrorCode::unsupported);
  CHECK(error_of("POINT Z (0 0 0)").code == ErrorCode::unsupported);
  CHECK(error_of("POLYHEDRALSURFACE ZM (((0 0 0 0)))").code == ErrorCode::unsupported);
  CHECK(error_of("POLYHEDRALSURFACE Z (((0 0 0,1 0 0,0 1 0)))").message.find("not closed") !=
        std::string::npos);
  CHECK(error_of("POLYHEDRALSURFACE Z (((0 0,1 0,0 1,0 0)))").byte_offset == 26);
  CHECK(error_of("POLYHEDRALSURFACE Z (((0 0 nan,1 0 0,0 1 0,0 0 0)))").byte_offset == 27);
  CHECK(error_of("POLYHEDRALSURFACE Z (((0 0 0,1 0 0,0 1 0,0 0 0))").byte_offset == 48);
  CHECK(error_of("POLYHEDRALSURFACE Z (((0 0 0,1 0 0,0 1 0,0 0 0))) x").byte_offset == 50);
  CHECK(error_of("SRID=x;POLYHEDRALSURFACE Z EMPTY").byte_offset == 5);
  CHECK(error_of("SRID=4294967296;POLYHEDRALSURFACE Z EMPTY").byte_offset == 5);
  for (std::size_t size = 0; size < kHollow.size(); ++size) {
    CHECK_FALSE(formats::read_wkt(std::string_view(kHollow).substr(0, size)));
  }
}

TEST_CASE("EWKB comes back as the same solid") {
  for (const std::string& text : {kHoled, kHollow}) {
    const auto solid = formats::read_wkt(text);
    REQUIRE(solid);
    const Bytes bytes = formats::write_ewkb(solid->solid);
    const auto again = formats::read_ewkb(bytes);
    REQUIRE(again);
    CHECK(again->solid == solid->solid);
    CHECK(formats::write_ewkb(again->solid) == bytes);
  }
}

TEST_CASE("EWKB has the bytes that PostGIS gives") {
  const auto solid =
      formats::read_wkt("SRID=7415;POLYHEDRALSURFACE Z (((0 0 0,1 0 0,0 1 0,0 0 0)))");
  REQUIRE(solid);
  const Bytes bytes = formats::write_ewkb(solid->solid);
  std::string hex;
  for (std::size_t i = 0; i < 27; ++i) {
    hex += "0123456789abcdef"[bytes[i] >> 4];
    hex += "0123456789abcdef"[bytes[i] & 15];
  }
  // Byte order 1, type 15 with Z and SRID, SRID 7415, 1 polygon: byte order 1, type 3 with Z, 1
  // ring, ...
  CHECK(hex == "010f0000a0f71c0000010000000103000080010000000400000000");
}

TEST_CASE("EWKB is read in both byte orders and with ISO type numbers") {
  const auto solid = formats::read_wkt("POLYHEDRALSURFACE Z (((0 0 0.5,1 0 0,0 1 0,0 0 0.5)))");
  REQUIRE(solid);
  for (const std::uint32_t surface : {0x8000000Fu, 1015u}) {
    for (const std::uint32_t polygon : {0x80000003u, 1003u}) {
      const auto other = formats::read_ewkb(one_triangle(surface, polygon, 0.5));
      REQUIRE(other);
      CHECK(other->solid == solid->solid);
    }
  }
  CHECK(formats::read_ewkb(one_triangle(1016, 1017, 0.5)));
}

TEST_CASE("EWKB that is not a closed solid of finite points is an error") {
  CHECK_FALSE(formats::read_ewkb(one_triangle(1015, 1003, 0.25)));
  CHECK_FALSE(
      formats::read_ewkb(one_triangle(1015, 1003, std::numeric_limits<double>::quiet_NaN())));
  CHECK_FALSE(formats::read_ewkb(one_triangle(15, 3, 0.5)));       // positions without z
  CHECK_FALSE(formats::read_ewkb(one_triangle(3015, 3003, 0.5)));  // positions with z and m
  CHECK_FALSE(formats::read_ewkb(one_triangle(1015, 1015, 0.5)));
  CHECK_FALSE(formats::read_ewkb(one_triangle(1006, 1003, 0.5)));
  Bytes longer = one_triangle(1015, 1003, 0.5);
  longer.push_back(0);
  CHECK_FALSE(formats::read_ewkb(longer));
}

// A fuzzer found: a solid of zero shells was written as an empty surface, which has one shell.
TEST_CASE("a solid without shells has an empty exterior shell and comes back as the same solid") {
  const Bytes none{1, 0x65, 0, 0, 0x80, 0, 0, 0, 0};
  const auto solid = formats::read_ewkb(none);
  REQUIRE(solid);
  CHECK(solid->solid.shell_count() == 1);
  CHECK(solid->solid.facet_count() == 0);
  const auto again = formats::read_ewkb(formats::write_ewkb(solid->solid));
  REQUIRE(again);
  CHECK(again->solid == solid->solid);
  const auto text = formats::read_wkt("SOLID Z EMPTY");
  REQUIRE(text);
  CHECK(text->solid.shell_count() == 1);
}

// A fuzzer found: a ring of no points was written, and then refused when read.
TEST_CASE("EWKB with an empty ring comes back as the same solid") {
  SolidArrays arrays;
  arrays.end_ring();
  arrays.end_facet();
  arrays.end_shell();
  const auto solid = Solid::make(arrays, Lattice{}, 0);
  REQUIRE(solid);
  const auto again = formats::read_ewkb(formats::write_ewkb(*solid));
  REQUIRE(again);
  CHECK(again->solid.ring_count() == 1);
  CHECK(again->solid.ring(0).empty());
}

TEST_CASE("EWKB rejects every truncated prefix and counts beyond the bytes") {
  const auto solid = formats::read_wkt(kHollow);
  REQUIRE(solid);
  const Bytes bytes = formats::write_ewkb(solid->solid);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CHECK_FALSE(formats::read_ewkb(ByteView(bytes).first(size)));
  }
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    Bytes broken = bytes;
    broken[at] = 0xFF;
    const auto result = formats::read_ewkb(broken);
    if (!result) CHECK_FALSE(result.error().message.empty());
  }
}

TEST_CASE("documents hold several geometries one after the other") {
  const auto document = test::read(kHoled + "\n" + kHollow + ";\n", Format::wkt);
  REQUIRE(document);
  REQUIRE(document->features.size() == 2);
  CHECK(document->features[0].srid == 7415);
  CHECK(document->features[1].srid == 0);
  const auto bytes = formats::write_document(*document, Format::ewkb);
  REQUIRE(bytes);
  const auto again = formats::read_document(*bytes, Format::ewkb);
  REQUIRE(again);
  REQUIRE(again->features.size() == 2);
  const auto text = formats::write_document(*again, Format::wkt);
  REQUIRE(text);
  CHECK(as_text(*text) == kHoled + "\n" + kHollow + "\n");
}

}  // namespace
}  // namespace watertight::test_ewkb
