// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "formats/document.h"
#include "samples.h"

namespace watertight::test_meshes {
namespace {

using test::read;

const std::string kTetrahedron =
    "v 0.5 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1e1\n"
    "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

Error mesh_error(const std::string& text, Format format) {
  const auto document = read(text, format);
  REQUIRE_FALSE(document);
  return document.error();
}

std::string written(const Document& document, Format format) {
  const auto bytes = formats::write_document(document, format);
  REQUIRE(bytes);
  return std::string(as_text(*bytes));
}

TEST_CASE("OBJ faces take every form of index") {
  const auto plain = read(kTetrahedron, Format::obj);
  const auto forms = read(
      "# comment\nmtllib x.mtl\no \nvt 0 0\nvn 0 0 1\nv 0.5 0 0 1.0\nv 1 0 0 0.1 0.2 0.3\n"
      "v 0 1 0\nv 0 0 1e1\r\ng part\ns off\nf 1/1 3/1 2/1\nf 1/1/1 2/1/1 4/1/1 # comment\n"
      "f 2//1 \\\n 3//1 4//1\nf -2 -4 -1",
      Format::obj);
  REQUIRE(plain);
  REQUIRE(forms);
  REQUIRE(forms->features.size() == 1);
  CHECK(forms->features[0].solids[0].solid == plain->features[0].solids[0].solid);
}

TEST_CASE("OBJ objects are features that share the vertices of the file") {
  const auto document = read(
      "o first\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\no nothing\n"
      "o second one\nf 2 3 4\nf 3 1 4\n",
      Format::obj);
  REQUIRE(document);
  REQUIRE(document->features.size() == 2);
  CHECK(document->features[0].id == "first");
  CHECK(document->features[1].id == "second one");
  CHECK(document->features[1].solids[0].solid.vertex_count() == 4);
  CHECK(document->features[1].solids[0].solid.world(0) == std::array<double, 3>{1, 0, 0});
  CHECK(document->notes.size() == 1);
}

TEST_CASE("OBJ errors name line and byte") {
  const Error nan = mesh_error("v 0 0 0\nv 0 nan 1\n", Format::obj);
  CHECK(nan.byte_offset == 12);
  CHECK(nan.message.starts_with("line 2: "));
  CHECK(mesh_error("v 0 0\n", Format::obj).code == ErrorCode::malformed);
  CHECK(mesh_error("v 0 0 inf\n", Format::obj).byte_offset == 6);
  CHECK(mesh_error("v 0 0 1e999\n", Format::obj).byte_offset == 6);
  CHECK(mesh_error("v 0 0 0 2\n", Format::obj).byte_offset == 8);
  CHECK(mesh_error("v 0 0 0\nf 0 1 1\n", Format::obj).byte_offset == 10);
  CHECK(mesh_error("v 0 0 0\nf -2 1 1\n", Format::obj).byte_offset == 10);
  CHECK(mesh_error("v 0 0 0\nf 1 1 2\n", Format::obj).byte_offset == 14);
  CHECK(mesh_error("v 0 0 0\nf 1 1 99999999999999999999\n", Format::obj).byte_offset == 14);
  CHECK(mesh_error("v 0 0 0\nf 1 1 1/x\n", Format::obj).byte_offset == 14);
  CHECK(mesh_error("v 0 0 0\nf\n", Format::obj).byte_offset == 8);
  CHECK(mesh_error("v 0 0 0\nface 1\n", Format::obj).byte_offset == 8);
  CHECK(mesh_error(std::string("v 0 0 0\n\0\0", 10), Format::obj).byte_offset == 8);
  CHECK(mesh_error("v 0 0 0\nf 1 1 \\\n 7", Format::obj).byte_offset == 17);
}

TEST_CASE("what follows the coordinates of an OBJ vertex is a weight or a colour") {
  CHECK(formats::read_document(as_bytes("v 0 0 0 1\nv 0 0 1 0.5 0.25 1\nv 1 0 0\nf 1 2 3\n"),
                               Format::obj));
  for (const std::string vertex : {"v 0 0 0 rubbish", "v 0 0 0 0.5 0.5", "v 0 0 0 0.5 0.5 nan",
                                   "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3"}) {
    CHECK(mesh_error(vertex + "\n", Format::obj).code == ErrorCode::malformed);
  }
}

TEST_CASE("vertices of a file that no face uses are left out and reported") {
  const auto off = formats::read_document(
      as_bytes("OFF\n5 1 0\n9 9 9\n0 0 0\n1 0 0\n0 1 0\n2.5 0 0\n3 1 2 3\n"), Format::off);
  REQUIRE(off);
  const SubmittedSolid& solid = off->features[0].solids[0];
  CHECK(solid.solid.vertex_count() == 3);
  CHECK(solid.unused.count == 2);
  CHECK(solid.unused.first == 0);
  CHECK(solid.unused.place == std::array<double, 3>{9, 9, 9});
  const auto objects = formats::read_document(
      as_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\no a\nf 1 2 3\no b\nf 3 2 1\n"), Format::obj);
  REQUIRE(objects);
  CHECK(objects->features[0].solids[0].unused.count == 0);
}

TEST_CASE("OBJ faces may come before the vertices that they use") {
  CHECK(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n", Format::obj));
}

TEST_CASE("an OBJ without faces is one empty solid") {
  for (const std::string& text : {std::string(), test::file_text("meshes/empty_primitive.obj")}) {
    const auto document = read(text, Format::obj);
    REQUIRE(document);
    REQUIRE(document->features.size() == 1);
    CHECK(document->features[0].solids[0].solid.facet_count() == 0);
  }
}

TEST_CASE("OBJ and OFF print the digits of the source") {
  const auto document = read(kTetrahedron, Format::obj);
  REQUIRE(document);
  CHECK(written(*document, Format::obj) ==
        "v 0.5 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 10\nf 1 2 3\nf 1 3 4\nf 3 2 4\nf 2 1 4\n");
  const std::string off = written(*document, Format::off);
  CHECK(off ==
        "OFF\n4 4 0\n0.5 0 0\n0 1 0\n1 0 0\n0 0 10\n"
        "3 0 1 2\n3 0 2 3\n3 2 1 3\n3 1 0 3\n");
  const auto again = read(off, Format::off);
  REQUIRE(again);
  CHECK(again->features[0].solids[0].solid == document->features[0].solids[0].solid);
}

// A fuzzer found: objects without a name were written without their line, and became one object.
TEST_CASE("OBJ keeps objects without a name apart") {
  const auto document = read("v 0 0 0\nf 1 1 1\no\nf 1 1 1\n", Format::obj);
  REQUIRE(document);
  REQUIRE(document->features.size() == 2);
  const auto again = read(written(*document, Format::obj), Format::obj);
  REQUIRE(again);
  CHECK(again->features.size() == 2);
}

TEST_CASE("OFF reads comments, colours and normals") {
  const auto plain = read("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n", Format::off);
  REQUIRE(plain);
  for (const char* text :
       {"# c\nOFF 4 1 6 # c\n0 0 0\n\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 0.5 0.5 0.5\n",
        "COFF\r\n4 1\r\n0 0 0 255 0 0\r\n1 0 0 1 1 1 1\r\n1 1 0\r\n0 1 0\r\n4 0 1 2 3\r\n",
        "NOFF\n4 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n"}) {
    const auto document = read(text, Format::off);
    REQUIRE(document);
    CHECK(document->features[0].solids[0].solid == plain->features[0].solids[0].solid);
  }
}

TEST_CASE("OFF errors name the byte") {
  CHECK(mesh_error("", Format::off).code == ErrorCode::malformed);
  CHECK(mesh_error("OF\n", Format::off).byte_offset == 0);
  CHECK(mesh_error("4OFF\n", Format::off).code == ErrorCode::unsupported);
  CHECK(mesh_error("OFF BINARY\n", Format::off).code == ErrorCode::unsupported);
  CHECK(mesh_error("OFF\n3\n", Format::off).byte_offset == 4);
  CHECK(mesh_error("OFF\n-3 1 0\n", Format::off).byte_offset == 4);
  CHECK(mesh_error("OFF\n99999999 1 0\n", Format::off).byte_offset == 4);
  CHECK(mesh_error("OFF\n1 1 0\n0 0\n", Format::off).byte_offset == 10);
  CHECK(mesh_error("OFF\n1 1 0\n0 0 x\n", Format::off).byte_offset == 14);
  CHECK(mesh_error("OFF\n1 1 0\n0 0 0\n3 0 0 1\n", Format::off).byte_offset == 22);
  CHECK(mesh_error("OFF\n1 1 0\n0 0 0\n4 0 0 0\n", Format::off).byte_offset == 16);
  CHECK(mesh_error("OFF\n1 1 0\n0 0 0\n3 0 0 -1\n", Format::off).byte_offset == 22);
  CHECK(mesh_error("OFF\n1 2 0\n0 0 0\n3 0 0 0\n", Format::off).byte_offset == 24);
}

TEST_CASE("a byte order mark before a text is skipped, noted and counted in places") {
  const std::string mark = "\xEF\xBB\xBF";
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n";
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
  const std::string stl =
      "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
      "endloop\nendfacet\nendsolid t\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n";
  const std::string poly = "3 3\n1 0 0 0\n2 1 0 0\n3 1 1 0\n1\n1\n3 1 2 3\n0\n0\n";
  const std::string wkt = "POLYHEDRALSURFACE Z(((0 0 0,1 0 0,1 1 0,0 0 0)))";
  for (const auto& [text, format] :
       {std::pair{off, Format::off}, std::pair{obj, Format::obj}, std::pair{stl, Format::stl},
        std::pair{ply, Format::ply}, std::pair{poly, Format::poly}, std::pair{wkt, Format::wkt}}) {
    INFO(text);
    const auto plain = read(text, format);
    const auto marked = read(mark + text, format);
    REQUIRE(plain);
    REQUIRE(marked);
    CHECK(marked->features[0].solids[0].solid == plain->features[0].solids[0].solid);
    REQUIRE_FALSE(marked->notes.empty());
    CHECK(marked->notes.back() == "byte order mark skipped");
    CHECK_FALSE(read(mark + mark + text, format));
  }
  CHECK(mesh_error(mark + "OFF\n3\n", Format::off).byte_offset == 7);
}

TEST_CASE("real mesh files read as documented") {
  const auto facets = [](const std::string& name, Format format) {
    const auto document = read(test::file_text("meshes/" + name), format);
    REQUIRE(document);
    std::size_t count = 0;
    for (const Feature& feature : document->features) {
      count += feature.solids[0].solid.facet_count();
    }
    return count;
  };
  CHECK(facets("two_objects_1.obj", Format::obj) == 12);
  CHECK(facets("self_fold.obj", Format::obj) > 0);
  CHECK(facets("cube5.off", Format::off) > 0);
  CHECK(facets("v405.off", Format::off) > 0);
  CHECK(facets("empty_primitive.off", Format::off) == 0);
  CHECK_FALSE(read(test::file_text("meshes/index0.obj"), Format::obj));
  CHECK_FALSE(read(test::file_text("meshes/index901.obj"), Format::obj));
}

TEST_CASE("meshes become generic city objects") {
  const auto mesh = read("o a\n" + kTetrahedron + "o b\nv 0.125 7 7\nf 9 1 2\n", Format::obj);
  REQUIRE_FALSE(mesh);  // index 9 of 5 vertices
  const auto document = read("o a\n" + kTetrahedron + "o b\nv 0.125 7 7\nf 5 1 2\n", Format::obj);
  REQUIRE(document);
  const std::string text = written(*document, Format::city_json);
  const auto model = read(text, Format::city_json);
  REQUIRE(model);
  REQUIRE(model->features.size() == 2);
  CHECK(model->features[0].id == "a");
  CHECK(model->features[1].id == "b");
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(model->features[i].solids[0].solid == document->features[i].solids[0].solid);
  }
}

TEST_CASE("holes and cavities are not written where a format has none") {
  const auto holed = read(
      "POLYHEDRALSURFACE Z (((0 0 0,4 0 0,0 4 0,0 0 0),(1 1 0,1 2 0,2 1 0,1 1 0)))", Format::wkt);
  REQUIRE(holed);
  const auto hollow =
      read("SOLID Z ((((0 0 0,4 0 0,0 4 0,0 0 0))),(((0 0 0,4 0 0,0 4 0,0 0 0))))", Format::wkt);
  REQUIRE(hollow);
  for (const Format format : {Format::obj, Format::off}) {
    for (const auto* document : {&holed, &hollow}) {
      const auto bytes = formats::write_document(**document, format);
      REQUIRE_FALSE(bytes);
      CHECK(bytes.error().code == ErrorCode::unsupported);
    }
  }
}

TEST_CASE("formats are detected by name, else by content") {
  const auto detected = [](std::string_view name, std::string_view text) {
    const auto format = formats::detect_format(name, as_bytes(text));
    return format ? std::string(formats::to_string(*format)) : std::string("unknown");
  };
  CHECK(detected("a.city.json", "") == "city-json");
  CHECK(detected("a.CITY.JSONL", "") == "city-json-seq");
  CHECK(detected("dir/a.obj", "") == "obj");
  CHECK(detected("a.off", "") == "off");
  CHECK(detected("a.wkt", "") == "wkt");
  CHECK(detected("a.ewkb", "") == "ewkb");
  CHECK(detected("", test::kTwoBuildings) == "city-json");
  CHECK(detected("", "{\n \"type\": 1}\n") == "city-json");
  CHECK(detected("", "{\"a\":1}\n{\"b\":1}\n") == "city-json-seq");
  CHECK(detected("", "# c\n\nv 0 0 0\n") == "obj");
  CHECK(detected("", "OFF\n") == "off");
  CHECK(detected("", " srid=1;Solid Z") == "wkt");
  CHECK(detected("", std::string_view("\x01\x0F\x00\x00\x80\x00\x00\x00\x00", 9)) == "ewkb");
  CHECK(detected("", "") == "unknown");
  CHECK(detected("x.txt", "hello") == "unknown");
}

}  // namespace
}  // namespace watertight::test_meshes
