// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests that meshes read with ReadOptions::keep_text come back byte for byte from their solids, and
// that neither coordinates nor numbers of corners are stored a second time.
#include <algorithm>
#include <bit>
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "formats/document.h"
#include "formats/text/kept_text.h"
#include "tests/random.h"
#include "tests/unit/formats/samples.h"

namespace watertight::test_indexed_text {
namespace {

Document mesh_of(std::string_view text, Format format) {
  formats::ReadOptions options;
  options.split_features = false;
  options.keep_text = true;
  auto document = formats::read_document(as_bytes(text), format, options);
  if (!document) FAIL(to_string(document.error()));
  return std::move(*document);
}

/// The kind of a kept form.
int kind_of(const Document& document) { return document.framing.at(0); }
constexpr int kWithIndices = 4;

/// The solid with its vertices in another order, and equal ones merged.
Solid stored_elsewhere(const Solid& solid) {
  SolidArrays arrays;
  std::vector<Index> number(solid.vertex_count());
  for (Index vertex = solid.vertex_count(); vertex-- > 0;) {
    const auto same = std::ranges::find(arrays.vertices, solid.vertices()[vertex]);
    number[vertex] = static_cast<Index>(same - arrays.vertices.begin());
    if (same == arrays.vertices.end()) arrays.vertices.push_back(solid.vertices()[vertex]);
  }
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    for (Index ring = solid.rings_of(facet).begin; ring < solid.rings_of(facet).end; ++ring) {
      for (const Index vertex : solid.ring(ring)) arrays.ring_vertices.push_back(number[vertex]);
      arrays.end_ring();
    }
    arrays.end_facet();
  }
  arrays.end_shell();
  auto made = Solid::make(std::move(arrays), solid.lattice(), solid.srid(), {});
  REQUIRE(made);
  return *std::move(made);
}

/// Whether the text comes back, also from solids that are stored in another way.
bool comes_back(const std::string& text, Format format) {
  Document document = mesh_of(text, format);
  const auto is_same = [&] {
    const auto written = formats::write_document(document, format);
    return written && as_text(*written) == text;
  };
  if (!is_same()) return false;
  for (Feature& feature : document.features) {
    for (SubmittedSolid& submitted : feature.solids)
      submitted = SubmittedSolid{stored_elsewhere(submitted.solid), {}, {}};
  }
  return is_same();
}

/// Vertices on a bumpy ball and its triangles, as the lines of a mesh in any order.
struct BallText {
  std::vector<std::array<std::string, 3>> vertices;
  std::vector<std::array<std::size_t, 3>> triangles;
};

BallText ball_text(test::Random& random, std::size_t rounds) {
  BallText ball;
  const std::size_t around = 4 * rounds;
  const auto decimal = [&] {
    std::string digits = std::to_string(100'000 + random.below(899'999));
    return (random.below(2) == 0 ? "-" : "") + std::to_string(random.below(9)) + '.' + digits;
  };
  for (std::size_t i = 0; i < 2 + rounds * around; ++i)
    ball.vertices.push_back({decimal(), decimal(), decimal()});
  const auto at = [&](std::size_t circle, std::size_t i) {
    return 2 + circle * around + i % around;
  };
  for (std::size_t i = 0; i < around; ++i) {
    ball.triangles.push_back({0, at(0, i), at(0, i + 1)});
    ball.triangles.push_back({1, at(rounds - 1, i + 1), at(rounds - 1, i)});
    for (std::size_t circle = 0; circle + 1 < rounds; ++circle) {
      ball.triangles.push_back({at(circle, i), at(circle + 1, i), at(circle + 1, i + 1)});
      ball.triangles.push_back({at(circle, i), at(circle + 1, i + 1), at(circle, i + 1)});
    }
  }
  for (std::size_t i = ball.triangles.size(); i > 1; --i)
    std::swap(ball.triangles[i - 1], ball.triangles[random.below(i)]);
  return ball;
}

std::string obj_of(const BallText& ball, const std::string& gap, const std::string& suffix) {
  std::string text = "# a ball\nmtllib ball.mtl\no ball\n";
  for (const auto& [x, y, z] : ball.vertices) text += "v " + x + gap + y + gap + z + "\n";
  text += "vt 0 0\nvn 0 0 1\ns off\nusemtl none\n";
  for (const auto& corners : ball.triangles) {
    text += 'f';
    for (const std::size_t corner : corners) text += ' ' + std::to_string(corner + 1) + suffix;
    text += '\n';
  }
  return text;
}

std::string off_of(const BallText& ball, const std::string& zeros) {
  std::string text = "OFF # of a program\n" + std::to_string(ball.vertices.size()) + ' ' +
                     std::to_string(ball.triangles.size()) + " 0\n\n";
  for (const auto& [x, y, z] : ball.vertices)
    text += x + zeros + "  " + y + zeros + "  " + z + zeros + "\r\n";
  for (const auto& [a, b, c] : ball.triangles)
    text += "3  " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + " \r\n";
  return text;
}

std::string ply_of(const BallText& ball, bool is_binary) {
  std::string text = std::string("ply\nformat ") + (is_binary ? "binary_little_endian" : "ascii") +
                     " 1.0\nelement vertex " + std::to_string(ball.vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                     "element face " +
                     std::to_string(ball.triangles.size()) +
                     "\nproperty list uchar int vertex_indices\nend_header\n";
  ByteWriter bytes;
  for (const auto& vertex : ball.vertices) {
    for (const std::string& number : vertex) {
      bytes.u32(std::bit_cast<std::uint32_t>(std::stof(number)));
      text += is_binary ? "" : number + ' ';
    }
    bytes.u8(3);  // as red
    text += is_binary ? "" : "3\n";
  }
  for (const auto& corners : ball.triangles) {
    bytes.u8(3);
    text += is_binary ? "" : "3";
    for (const std::size_t corner : corners) {
      bytes.u32(static_cast<std::uint32_t>(corner));
      text += is_binary ? "" : ' ' + std::to_string(corner);
    }
    text += is_binary ? "" : "\n";
  }
  return is_binary ? text + std::string(as_text(bytes.bytes())) : text;
}

/// Requires that a mesh comes back, and that its kept form has a byte or two for each number.
void check_small(const std::string& text, Format format, std::size_t most) {
  CHECK(comes_back(text, format));
  const Document document = mesh_of(text, format);
  CHECK(kind_of(document) == kWithIndices);
  CHECK(document.framing.size() < most);
}

}  // namespace

TEST_CASE("indexed texts: OBJ, OFF and PLY keep neither coordinates nor numbers of corners") {
  test::Random random(11);
  const BallText ball = ball_text(random, 8);
  // Marks and what is not a number; two bytes for the order of the vertices.
  const std::size_t lines = ball.vertices.size() + ball.triangles.size();
  const std::size_t corners = 3 * ball.triangles.size();
  check_small(obj_of(ball, " ", ""), Format::obj, 6 * lines + 2 * corners + 200);
  check_small(obj_of(ball, "  ", "//1"), Format::obj, 6 * lines + 5 * corners + 200);
  check_small(obj_of(ball, " ", "/1/1"), Format::obj, 6 * lines + 6 * corners + 200);
  check_small(off_of(ball, ""), Format::off, 8 * lines + 2 * corners + 200);
  check_small(off_of(ball, "0000"), Format::off, 8 * lines + 2 * corners + 200);
  check_small(ply_of(ball, false), Format::ply, 6 * lines + 2 * corners + 400);
  check_small(ply_of(ball, true), Format::ply, 6 * lines + corners + 400);
}

TEST_CASE("indexed texts: unused and equal vertices, relative numbers and several objects") {
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const std::string corners = "v 0 0 0\nv 9 0.50 0\nv 0 9 0\nv 0 0 9\n";
  CHECK(comes_back(corners + "v 7 7 7\n" + faces + "#\x01\x02\x03\x04\x05\n", Format::obj));
  CHECK(
      comes_back("v 0 0 0\nv 0 0 0 1\nv 9 0 0\nv 0 9 0\nv 0 0 9\n"
                 "f 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 1 5\n",
                 Format::obj));
  CHECK(comes_back(corners + "f -4 -2 -3\nf 1 2 4\nf 2 03 4\nf 3/ 1// 4\n", Format::obj));
  CHECK(comes_back(corners + "o a\n" + faces + "o b\n" + faces + "o none\n", Format::obj));
  CHECK(comes_back(faces + corners, Format::obj));
  CHECK(comes_back(corners + "f 1 3 \\\n2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", Format::obj));
  CHECK(comes_back(corners, Format::obj));
  CHECK(
      comes_back("OFF 4 4 6\n0 0 0\n9 0 0 # far\n0 9 0\n1e-3 0 9E0\n3 0 2 1\n3 0 1 3 255 0 0\n"
                 "3 1 2 3\n3 2 0 3\nmore\n",
                 Format::off));
}

TEST_CASE("indexed texts: truncated and changed forms are errors, never another text") {
  test::Random random(12);
  const std::string text = obj_of(ball_text(random, 2), " ", "/1");
  Document document = mesh_of(text, Format::obj);
  REQUIRE(kind_of(document) == kWithIndices);
  const Bytes framing = document.framing;
  test::check_damaged_framing(document, text);
  document.framing = framing;
  document.features.clear();
  CHECK_FALSE(formats::write_document(document, Format::obj));
}

}  // namespace watertight::test_indexed_text
