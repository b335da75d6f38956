// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests the formats STL, PLY and POLY.
#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch_test_macros.hpp>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "formats/document.h"
#include "formats/mesh/interior_shells.h"
#include "samples.h"

namespace watertight::test_mesh_files {
namespace {

using test::read;

Error mesh_file_error(const std::string& text, Format format) {
  const auto document = read(text, format);
  REQUIRE_FALSE(document);
  CHECK_FALSE(document.error().message.empty());
  return document.error();
}

Solid only_solid(const std::string& text, Format format) {
  const auto document = read(text, format);
  if (!document) FAIL(to_string(document.error()));
  REQUIRE(document->features.size() == 1);
  REQUIRE(document->features[0].solids.size() == 1);
  return document->features[0].solids[0].solid;
}

const Solid& tetrahedron() {
  static const Solid solid = only_solid(
      "OFF 4 4 0\n0 0 0\n0.1 0 0\n0 0.1 0\n0 0 0.1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n",
      Format::off);
  return solid;
}

template <class Value>
void append(std::string& out, Value value, bool is_big_endian = false) {
  char bytes[sizeof(Value)];
  std::memcpy(bytes, &value, sizeof(Value));
  if (is_big_endian != (std::endian::native == std::endian::big)) {
    std::reverse(bytes, bytes + sizeof(Value));
  }
  out.append(bytes, sizeof(Value));
}

using Corner = std::array<float, 3>;
const std::array<Corner, 4> kCorners{Corner{0, 0, 0}, Corner{0.1F, 0, 0}, Corner{0, 0.1F, 0},
                                     Corner{0, 0, 0.1F}};
const std::array<std::array<int, 3>, 4> kFaces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

std::string binary_stl(std::string header = "made by a test") {
  header.resize(80);
  append(header, std::uint32_t{4});
  for (const auto& face : kFaces) {
    for (int axis = 0; axis < 3; ++axis) append(header, std::nanf(""));
    for (const int corner : face) {
      for (const float value : kCorners[static_cast<std::size_t>(corner)]) {
        append(header, value == 0 && corner == 3 ? -0.0F : value);
      }
    }
    append(header, std::uint16_t{0x8000});
  }
  return header;
}

std::string text_stl(const std::string& name) {
  std::string out = "solid " + name + "\n";
  for (const auto& face : kFaces) {
    out += " facet normal nan 0 1e0\r\n  outer loop\n";
    for (const int corner : face) {
      const Corner& at = kCorners[static_cast<std::size_t>(corner)];
      out += "   vertex";
      for (const float value : at) out += value == 0 ? " 0.0e+00" : " 1.0E-01";
      out += '\n';
    }
    out += "  endloop\n endfacet\n";
  }
  return out + "endsolid " + name + "\n";
}

TEST_CASE("a binary STL is welded and its floats are their shortest decimals") {
  CHECK(only_solid(binary_stl(), Format::stl) == tetrahedron());
  CHECK_FALSE(read(binary_stl(), Format::stl)->notes.empty());
}

TEST_CASE("a float that is a large integer counts as its shortest decimal, in STL as in PLY") {
  const std::array<Corner, 3> corners{Corner{123456792, 0, 0}, Corner{0, 8, 0}, Corner{0, 0, 8}};
  std::string stl(80, ' ');
  append(stl, std::uint32_t{1});
  for (int axis = 0; axis < 3; ++axis) append(stl, 0.0F);
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar uchar vertex_index\nend_header\n";
  for (const Corner& corner : corners) {
    for (const float value : corner) {
      append(stl, value);
      append(ply, value);
    }
  }
  append(stl, std::uint16_t{0});
  for (const int byte : {3, 0, 1, 2}) append(ply, static_cast<std::uint8_t>(byte));
  const Solid solid = only_solid(stl, Format::stl);
  CHECK(solid.world(0) == std::array<double, 3>{123456790, 0, 0});
  CHECK(solid == only_solid(ply, Format::ply));
}

TEST_CASE("a text STL is welded; keywords have any case") {
  CHECK(only_solid(text_stl("part one"), Format::stl) == tetrahedron());
  std::string upper = text_stl("X");
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  CHECK(only_solid(upper, Format::stl) == tetrahedron());
}

TEST_CASE("each solid of a text STL is a feature") {
  const auto document =
      read(text_stl("a") + "solid nothing\nendsolid\n" + text_stl("b c"), Format::stl);
  REQUIRE(document);
  REQUIRE(document->features.size() == 2);
  CHECK(document->features[0].id == "a");
  CHECK(document->features[1].id == "b c");
  CHECK(document->features[1].solids[0].solid == tetrahedron());
  CHECK(document->notes.size() == 2);
  CHECK(only_solid("solid nothing\nendsolid nothing", Format::stl).facet_count() == 0);
}

TEST_CASE("a binary STL may start with the word solid") {
  CHECK(only_solid(binary_stl("solid but binary"), Format::stl) == tetrahedron());
  CHECK(*formats::detect_format("part", as_bytes(binary_stl("solid but binary"))) == Format::stl);
}

TEST_CASE("STL errors name the place") {
  const std::string whole = binary_stl();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CHECK_FALSE(read(whole.substr(0, size), Format::stl));
  }
  CHECK_FALSE(read(whole + "x", Format::stl));
  std::string count = whole;
  count[81] = 1;
  CHECK(mesh_file_error(count, Format::stl).message.find("260 triangles") != std::string::npos);
  std::string nan = whole;
  const float value = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(nan.data() + 84 + 50 + 12, &value, 4);
  CHECK(mesh_file_error(nan, Format::stl).byte_offset == 146);

  const std::string text = text_stl("x");
  for (const std::size_t size :
       {std::size_t{5}, text.size() / 3, text.size() / 2, std::size_t{150}}) {
    CHECK_FALSE(read(text.substr(0, size), Format::stl));
  }
  CHECK(mesh_file_error("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 inf\n", Format::stl)
            .byte_offset == 49);
  CHECK(mesh_file_error("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", Format::stl)
            .message.starts_with("line "));
  CHECK(mesh_file_error("solid x\nfacet normal 0 0\nouter loop\n", Format::stl).code ==
        ErrorCode::malformed);
  CHECK(mesh_file_error("solid x\nvertex 0 0 0\n", Format::stl).message.starts_with("line 2: "));
}

TEST_CASE("STL obeys the limits") {
  formats::ReadOptions options;
  options.limits.facets = 3;
  const std::string binary = binary_stl();
  CHECK(formats::read_document(as_bytes(binary), Format::stl, options).error().code ==
        ErrorCode::limit_exceeded);
  const std::string text = text_stl("x");
  CHECK(formats::read_document(as_bytes(text), Format::stl, options).error().code ==
        ErrorCode::limit_exceeded);
}

std::string text_ply(const std::string& data = "0 7 0 0\n.1 7 0 0\n0 7 .1 0\n0 7 0 0.10\n") {
  return "ply\nformat ascii 1.0\ncomment a test\nobj_info x\nelement vertex 4\nproperty double x\n"
         "property uchar red\nproperty float y\nproperty float z\nelement face 4\n"
         "property list uchar int vertex_indices\nelement other 1\nproperty list int char a\n"
         "end_header\n" +
         data + "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n2 1 1\n";
}

std::string binary_ply(bool is_big) {
  std::string out = std::string("ply\r\nformat binary_") + (is_big ? "big" : "little") +
                    "_endian 1.0\r\nelement none 99999999999\r\nelement face 4\r\n"
                    "property uint16 flags\r\nproperty list uint32 short vertex_index\r\n"
                    "element vertex 4\r\nproperty list uint8 double weights\r\n"
                    "property double z\r\nproperty float32 x\r\nproperty float y\r\n"
                    "end_header\r\n";
  for (const auto& face : kFaces) {
    append(out, std::uint16_t{1}, is_big);
    append(out, std::uint32_t{3}, is_big);
    for (const int corner : face) append(out, static_cast<std::int16_t>(corner), is_big);
  }
  for (const Corner& corner : kCorners) {
    append(out, std::uint8_t{1});
    append(out, 0.5, is_big);
    append(out, corner[2] == 0 ? 0.0 : 0.1, is_big);
    append(out, corner[0], is_big);
    append(out, corner[1], is_big);
  }
  return out;
}

TEST_CASE("PLY is read as text and as binary of both byte orders") {
  CHECK(only_solid(text_ply(), Format::ply) == tetrahedron());
  CHECK(only_solid(binary_ply(false), Format::ply) == tetrahedron());
  CHECK(only_solid(binary_ply(true), Format::ply) == tetrahedron());
}

TEST_CASE("PLY coordinates may have any scalar type") {
  const std::string text =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty char x\nproperty ushort y\n"
      "property int z\nelement face 1\nproperty list char uint vertex_indices\nend_header\n";
  std::string bytes = text;
  for (int i = 0; i < 3; ++i) {
    append(bytes, static_cast<std::int8_t>(-i));
    append(bytes, static_cast<std::uint16_t>(65535 - i), true);
    append(bytes, std::int32_t{-70000}, true);
  }
  append(bytes, std::int8_t{3});
  for (std::uint32_t i = 0; i < 3; ++i) append(bytes, i, true);
  const Solid solid = only_solid(bytes, Format::ply);
  CHECK(solid.world(2) == std::array<double, 3>{-2, 65533, -70000});
  std::string negative = bytes;
  negative[negative.size() - 13] = '\xFF';
  CHECK(mesh_file_error(negative, Format::ply).message.find("negative") != std::string::npos);
}

TEST_CASE("every truncated PLY is refused") {
  for (const std::string& whole : {binary_ply(false), binary_ply(true)}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      CHECK_FALSE(read(whole.substr(0, size), Format::ply));
    }
  }
  const std::string text = text_ply();
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    CHECK_FALSE(read(text.substr(0, size), Format::ply));
  }
}

TEST_CASE("PLY refuses what it cannot hold before it allocates") {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex ";
  const std::string tail =
      "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n";
  CHECK(mesh_file_error(head + "18446744073709551615" + tail, Format::ply)
            .message.find("more elements") != std::string::npos);
  CHECK(mesh_file_error(head + "1" + tail + "4294967295 0 0 0", Format::ply)
            .message.find("a list of") != std::string::npos);
  CHECK(mesh_file_error(head + "1" + tail + "3 0 0 1", Format::ply).message.find("out of range") !=
        std::string::npos);
  CHECK(mesh_file_error(head + "1" + tail + "3 0 0 -1", Format::ply).byte_offset.has_value());
  CHECK_FALSE(read(head + "1" + tail + "3 0 0 0.5", Format::ply));
  CHECK_FALSE(read(head + "-1" + tail, Format::ply));
}

TEST_CASE("PLY headers that say too little or something unknown are refused") {
  for (const std::string text :
       {"", "ply", "plx\n", "ply\nend_header\n",
        "ply\nformat ascii 1.0\nelement face 1\nend_header\n",
        "ply\nformat ascii 2.0\nend_header\n",
        "ply\nformat ascii 1.0\nproperty int x\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty vec3 x\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n",
        "ply\nformat ascii 1.0\nelement a 0\nproperty list float int x\nend_header\n",
        "ply\nformat ascii 1.0\nelement a 0\nelement a 0\nend_header\n",
        "ply\nformat ascii 1.0\nelement tristrips 0\nend_header\n",
        "ply\nformat ascii 1.0\nelement face 0\nproperty list int float "
        "vertex_index\nend_header\n"}) {
    CHECK_FALSE(read(text, Format::ply));
  }
  CHECK(mesh_file_error("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n",
                        Format::ply)
            .byte_offset == 21);
  CHECK(mesh_file_error("ply\nformat ascii 1.0\nelement face 1\nend_header\n", Format::ply)
            .byte_offset == 21);
  CHECK(only_solid("ply\nformat ascii 1.0\nend_header\n", Format::ply).facet_count() == 0);
  CHECK_FALSE(read(text_ply("0 7 nan 0\n.1 7 0 0\n0 7 .1 0\n0 7 0 0.10\n"), Format::ply));
}

const std::string kPolyNodes =
    "4 3 1 1 # nodes\n1 0 0 0 9 1\n2 0.1 0 0 9 1\n3 0 0.1 0 9\n4 0 0 0.1\n";
const std::string kPolyFacets =
    "# facets\n4 1\n1 0 5\n3 1 3 2\n1\n3 1 2\n4\n1\n3 2 3 4\n\n1 0\n3 3 1 4 # last\n";

TEST_CASE("POLY nodes count from 0 or 1; polygons may go on in the next line") {
  CHECK(only_solid(kPolyNodes + kPolyFacets + "0\n0\n", Format::poly) == tetrahedron());
  CHECK(
      only_solid("4 3 0 0\n0 0 0 0\n1 .1 0 0\n2 0 .1 0\n3 0 0 .1\n4 0\n1 0\n3 0 2 1\n1 0\n3 0 1 3\n"
                 "1 0\n3 1 2 3\n1 0\n3 2 0 3\n",
                 Format::poly) == tetrahedron());
}

TEST_CASE("POLY polygons after the first are interior rings, with or without hole points") {
  const std::string nodes =
      "7 3\n1 0 0 0\n2 9 0 0\n3 0 9 0\n4 1 1 0\n5 1 2 0\n6 2 1 0\n7 5 5 5\n1 0\n";
  const Solid plain = only_solid(nodes + "2 0\n3 1 2 3\n3 4 5 6\n", Format::poly);
  const Solid marked =
      only_solid(nodes + "2 1 7\n3 1 2 3\n3 4 5 6\n1 1.2 1.2 0\n0\n1\n1 0 0 0 1 2\n", Format::poly);
  CHECK(plain == marked);
  CHECK(plain.facet_count() == 1);
  CHECK(plain.ring_count() == 2);
  CHECK(plain.vertex_count() == 6);
}

TEST_CASE("every POLY cut between its lines is refused") {
  const std::string whole = kPolyNodes + kPolyFacets;
  for (std::size_t at = whole.find('\n'); at + 1 < whole.size(); at = whole.find('\n', at + 1)) {
    CHECK_FALSE(read(whole.substr(0, at + 1), Format::poly));
  }
  CHECK_FALSE(read(whole + "1\n", Format::poly));
  CHECK_FALSE(read(whole + "0\n3\n1 0 0 0\n", Format::poly));
}

TEST_CASE("POLY errors name line and byte") {
  const Error range = mesh_file_error(kPolyNodes + "1 0\n1 0\n3 1 2 5\n", Format::poly);
  CHECK(range.message.starts_with("line 8: "));
  CHECK(range.byte_offset == kPolyNodes.size() + 14);
  // The nodes count from 1, so there is no node 0.
  CHECK_FALSE(read(kPolyNodes + "1 0\n1 0\n3 1 2 0\n", Format::poly));
  CHECK_FALSE(read(kPolyNodes + "1 0\n1 0\n3 1 2 3 4\n", Format::poly));
  CHECK_FALSE(read(kPolyNodes + "99999999999999 0\n", Format::poly));
  CHECK_FALSE(read(kPolyNodes + "1 0\n1 4000000000\n3 1 2 3\n", Format::poly));
  CHECK_FALSE(read(kPolyNodes + "1 0\n1 0\n4000000000 1 2 3\n", Format::poly));
  CHECK_FALSE(read("1 3\n2 0 0 0\n0\n", Format::poly));
  CHECK_FALSE(read("2 3\n0 0 0 0\n2 0 0 0\n0\n", Format::poly));
  CHECK_FALSE(read("1 2\n0 0 0\n0\n", Format::poly));
  CHECK_FALSE(read("1 3\n0 0 nan 0\n0\n", Format::poly));
  CHECK_FALSE(read("-1 3\n", Format::poly));
  CHECK(mesh_file_error("0 3\n1 0\n", Format::poly).code == ErrorCode::unsupported);
  CHECK(only_solid("1 3\n0 0 0 0\n0\n0\n0\n", Format::poly).facet_count() == 0);
}

TEST_CASE("interior shells are appended on a common grid") {
  const auto outer = read("OFF 4 1 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n4 0 1 2 3\n", Format::off);
  const auto inner = read(kPolyNodes + kPolyFacets, Format::poly);
  REQUIRE(outer);
  REQUIRE(inner);
  const auto& shells = inner->features[0].solids;
  const auto solid = formats::with_interior_shells(outer->features[0].solids[0], shells);
  REQUIRE(solid);
  CHECK(solid->solid.shell_count() == 2);
  CHECK(solid->solid.facet_count() == 5);
  CHECK(solid->solid.vertex_count() == 8);
  CHECK(solid->solid.facets_of(1).begin == 1);
  CHECK(solid->solid.world(1) == std::array<double, 3>{10, 0, 0});
  CHECK(solid->solid.world(solid->solid.ring(1)[1]) == std::array<double, 3>{0, 0.1, 0});
  CHECK(solid->source.geometry_type == "Mesh");
  Limits limits;
  limits.vertices = 7;
  CHECK(formats::with_interior_shells(outer->features[0].solids[0], shells, limits).error().code ==
        ErrorCode::limit_exceeded);
}

TEST_CASE("mesh files are detected by their names and by their contents") {
  CHECK(*formats::detect_format("a.STL", {}) == Format::stl);
  CHECK(*formats::detect_format("a.ply", {}) == Format::ply);
  CHECK(*formats::detect_format("a.poly", {}) == Format::poly);
  CHECK(*formats::detect_format("", as_bytes(text_stl("x"))) == Format::stl);
  CHECK(*formats::detect_format("", as_bytes(binary_stl())) == Format::stl);
  CHECK(*formats::detect_format("", as_bytes(text_ply())) == Format::ply);
  CHECK(*formats::detect_format("", as_bytes(std::string("SOLID Z (((0 0 0)))\n"))) == Format::wkt);
}

}  // namespace
}  // namespace watertight::test_mesh_files
