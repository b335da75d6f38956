// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests that GML, mesh and geometry documents read with ReadOptions::keep_text are written byte for
// byte as they were, and that the coordinates of solids are not stored a second time.
#include <catch2/catch_test_macros.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "formats/text/kept_text.h"
#include "gml_samples.h"

namespace watertight::test_kept_documents {
namespace {

using namespace test;

Document kept(std::string_view text, Format format) {
  formats::ReadOptions options;
  options.split_features = false;
  options.keep_text = true;
  auto document = formats::read_document(as_bytes(text), format, options);
  if (!document) FAIL(to_string(document.error()));
  return std::move(*document);
}

std::string written(const Document& document) {
  const auto bytes = formats::write_document(document, document.format);
  return bytes ? std::string(as_text(*bytes)) : to_string(bytes.error());
}

/// True if a document that was kept comes back, with solids that are read from elsewhere: the
/// framing alone does not hold them.
bool comes_back(const std::string& text, Format format = Format::gml) {
  const Document document = kept(text, format);
  Document other = kept(text, format);
  for (Feature& feature : other.features) {
    for (SubmittedSolid& solid : feature.solids) solid = SubmittedSolid{solid.solid, {}, {}};
  }
  other.notes.clear();
  return !document.framing.empty() && written(other) == text;
}

bool framing_has(const Document& document, std::string_view words) {
  return as_text(document.framing).find(words) != std::string_view::npos;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// The text in UTF-16 with the low byte first.
std::string in_utf_16(std::string_view text) {
  std::string out = "\xFF\xFE";
  for (const char c : text) {
    out += c;
    out += '\0';
  }
  return out;
}

/// The faces of a tetrahedron with corners O, A, B and C.
const std::vector<std::string> kFaces{"O B A O", "O A C O", "A B C A", "B O C B"};

/// A tetrahedron with `height` as the text of the z of its top and `gap` between numbers.
std::string tetrahedron(const std::string& height, const std::string& gap = " ",
                        const std::string& face = "") {
  std::string members;
  for (std::string positions : kFaces) {
    positions = replaced(positions, "O", "0 0 0");
    positions = replaced(positions, "A", "2.5 0 0");
    positions = replaced(positions, "B", "0 7.5 0");
    positions = replaced(positions, "C", "0 0 " + height);
    const std::string surface = polygon(replaced(positions, " ", gap));
    members += members.empty() && !face.empty() ? member(face) : member(surface);
  }
  return model(building(solid_of(members)));
}

TEST_CASE("kept GML: every sample file comes back") {
  for (const char* name : {"citygml_2_xlinks.gml", "citygml_3.gml", "csol5.gml", "defects.gml",
                           "igml_703_1.gml", "ogc_Building_LOD1-EPSG25832.gml",
                           "ogc_Building_LOD2-EPSG25832.gml", "ogc_Building_LOD3-EPSG25832.gml",
                           "small_sig3d-genericattributes-citygml2.xml", "solid_3_2.gml"}) {
    INFO(name);
    const std::string text = file_text(std::string("gml/") + name);
    CHECK(comes_back(text));
    CHECK(comes_back(replaced(text, "\n", "\r\n")));
    CHECK(comes_back(replaced(text, " ", "  ")));
  }
}

TEST_CASE("kept GML: spellings of numbers and gaps come back") {
  for (const std::string height :
       {"1", "1.0", "1.000", "1e0", "+1", "01", "1.", "0.1E1", "10E-1", "0.9999999999999999",
        "0.30000000000000004", "1.0000000000000000001", "123456789.123456789012345678", "5E-7"}) {
    INFO(height);
    CHECK(comes_back(tetrahedron(height)));
  }
  for (const std::string gap : {"  ", "\n", "\r\n\t", " <!-- 1 2 3 --> ", "&#32;", " &#x20; "}) {
    INFO(gap);
    CHECK(comes_back(tetrahedron("1", gap)));
  }
  CHECK(comes_back(replaced(tetrahedron("1"), "0 0 1", "<![CDATA[0 0 1]]>")));
  CHECK(comes_back(replaced(tetrahedron("1"), "0 7.5 0", "-0 7.5 0.")));
}

TEST_CASE("kept GML: encodings, a byte order mark and text around the root come back") {
  const std::string text = tetrahedron("1.25");
  CHECK(comes_back("\xEF\xBB\xBF" + text));
  CHECK(comes_back("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\r\n<!-- a -->\n" + text + "\n \n"));
  CHECK(comes_back("<?xml version='1.0' encoding='ISO-8859-1'?>\n" + replaced(text, "<Building",
                                                                              "<n>Stra\xDF"
                                                                              "e</n><Building")));
  CHECK(comes_back(in_utf_16("<?xml version='1.0' encoding='UTF-16'?>" + text)));
  // The letter U+0101 has two bytes of the value that stands for a ring.
  std::string letters = in_utf_16("<?xml version='1.0' encoding='UTF-16'?><!--aaaa-->" + text);
  for (std::size_t at = letters.find("a"); letters[at] == 'a'; at += 2) {
    letters[at] = letters[at + 1] = 1;
  }
  CHECK(comes_back(letters));
}

TEST_CASE("kept GML: the coordinates of solids are not in the kept text") {
  const std::string text = tetrahedron("1234.50");
  CHECK(comes_back(text));
  CHECK_FALSE(framing_has(kept(text, Format::gml), "7.5"));
  std::string positions = text;
  for (const std::string point : {"0 0 1234.50", "2.5 0 0", "0 7.5 0", "0 0 0"}) {
    positions = replaced(positions, point + " ", point + "</g:pos>\n<g:pos>");
  }
  positions = replaced(positions, "g:posList>", "g:pos>");
  REQUIRE(comes_back(positions));
  CHECK_FALSE(framing_has(kept(positions, Format::gml), "7.5"));
}

TEST_CASE("kept GML: rings of reversed surfaces are referred to") {
  const std::string base = "<g:OrientableSurface orientation=\"-\"><g:baseSurface>" +
                           polygon("0 0 0 2.5 0 0 0 7.5 0 0 0 0") +
                           "</g:baseSurface></g:OrientableSurface>";
  const std::string text = tetrahedron("1", " ", base);
  CHECK(is_closed(kept(text, Format::gml).features[0].solids[0].solid));
  CHECK(comes_back(text));
  CHECK_FALSE(framing_has(kept(text, Format::gml), "7.5"));
}

TEST_CASE("kept GML: latitude before longitude is referred to") {
  const std::string text =
      replaced(tetrahedron("1"), "<g:Solid", "<g:Solid srsName=\"urn:ogc:def:crs:EPSG::4979\"");
  const Document document = kept(text, Format::gml);
  REQUIRE_FALSE(document.notes.empty());
  CHECK(written(document) == text);
  CHECK_FALSE(framing_has(document, "7.5"));
}

TEST_CASE("kept GML: documents without solids, and geometry that no solid uses") {
  CHECK(comes_back(model("<Building g:id=\"b\"/>")));
  const std::string ring = polygon("5 5 5 6 6 6 7 7 7 5 5 5");
  const std::string text = model(building(kTetrahedron) + ring + building(kTetrahedron, "c"));
  CHECK(comes_back(text));
  CHECK(framing_has(kept(text, Format::gml), "5 5 5 6 6 6"));
}

TEST_CASE("kept GML: a footprint is referred to as the ring of the solid that it is") {
  const std::string same = "0 0 0 0 7.5 0 2.5 0 0 0 0 0";
  const std::string opposite = "0 0 0 2.5 0 0 0 7.5 0 0 0 0";
  const std::string solid =
      replaced(replaced(kTetrahedron, "1 0 0", "2.5 0 0"), "0 1 0", "0 7.5 0");
  const auto with_footprint = [&](const std::string& positions) {
    const std::string footprint = "<lod0FootPrint><g:MultiSurface>" + member(polygon(positions)) +
                                  "</g:MultiSurface></lod0FootPrint>";
    return model(replaced(building(solid), "<lod2Solid>", footprint + "<lod2Solid>"));
  };
  for (const std::string& positions : {same, opposite}) {
    CHECK(comes_back(with_footprint(positions)));
    CHECK_FALSE(framing_has(kept(with_footprint(positions), Format::gml), "7.5"));
  }
  const std::string other = with_footprint("0 0 0 2.5 0 1 0 7.5 0 0 0 0");
  CHECK(comes_back(other));
  CHECK(framing_has(kept(other, Format::gml), "7.5"));
}

TEST_CASE("kept documents: a GML that was not kept is written anew, with the same solid") {
  const Document document = gml_of(tetrahedron("1"));
  CHECK(document.framing.empty());
  const auto written = formats::write_document(document, Format::gml);
  REQUIRE(written);
  const Document again = gml_of(std::string(as_text(*written)));
  CHECK(again.features.front().solids.front().solid ==
        document.features.front().solids.front().solid);
}

TEST_CASE("kept documents: other solids, truncated and changed bytes are errors") {
  const std::string text = tetrahedron("12.5");
  Document document = kept(text, Format::gml);
  const Bytes framing = document.framing;
  test::check_damaged_framing(document, text);
  document.framing = framing;
  document.features.clear();
  CHECK_FALSE(formats::write_document(document, Format::gml));
  document = kept(tetrahedron("12.75"), Format::gml);
  document.framing = framing;
  CHECK_FALSE(formats::write_document(document, Format::gml));
}

TEST_CASE("kept documents: references cannot make more bytes than the stated size") {
  const Document document = kept(tetrahedron("1"), Format::gml);
  ByteWriter framing;
  framing.u8(1);  // with references
  framing.u64(0);
  framing.varint(1000);
  for (int list = 0; list < 3; ++list) framing.varint(0);
  framing.append(Bytes(1U << 20U, 3));  // the next position, which is that of no ring
  const auto solids = formats::solids_of(document);
  CHECK_FALSE(formats::restored_bytes(framing.bytes(), solids, {}, 1U << 20U));
  Bytes rings = framing.bytes();
  rings[14] = 2;  // begins with the first position of a ring
  const auto result = formats::restored_bytes(rings, solids, {}, 1U << 20U);
  REQUIRE_FALSE(result);
  CHECK(result.error().code == ErrorCode::malformed);
  CHECK(formats::restored_bytes(rings, solids, {}, 999).error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("kept documents: every mesh file comes back") {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_path("tests/data/meshes"))) {
    const std::string name = entry.path().filename().string();
    if (name == "index0.obj" || name == "index901.obj") continue;  // refused
    const std::string text = file_text("meshes/" + name);
    const auto format = formats::detect_format(name, as_bytes(text));
    REQUIRE(format);
    INFO(name);
    CHECK(comes_back(text, *format));
    if (name != "stl_box_binary.stl") CHECK(comes_back(text + "\n", *format));
    ++count;
  }
  CHECK(count >= 15);
}

TEST_CASE("kept documents: WKT, JSON-FG and STL refer to the rings of their solids") {
  const std::string wkt =
      "polyhedralsurface z(((0 0 0,0 1.50 0,1.50 0 0,0 0 0)),\n((0 0 0, 1.50 0 0, 0 0 1.50, 0 0 0)"
      "),((1.50 0 0,0 1.50 0,0 0 1.50,1.50 0 0)),((0 1.50 0,0 0 0,0 0 1.50,0 1.50 0)))";
  CHECK(comes_back(wkt, Format::wkt));
  CHECK(comes_back("\xEF\xBB\xBF" + wkt, Format::wkt));
  CHECK_FALSE(framing_has(kept(wkt, Format::wkt), "0 1.50 0"));
  const std::string json_fg =
      R"({"type": "Feature", "conformsTo": ["http://www.opengis.net/spec/json-fg-1/0.3/conf/core"],
      "id": "f", "geometry": null, "properties": {"a": 1.50}, "time": null, "place":
      {"type": "Polyhedron", "coordinates": [[ [[[0,0,0],[0,1.50,0],[1.50,0,0],[0,0,0]]],
      [[[0,0,0],[1.50,0,0],[0,0,1.50],[0,0,0]]], [[[1.50,0,0],[0,1.50,0],[0,0,1.50],[1.50,0,0]]],
      [[[0,1.50,0],[0,0,0],[0,0,1.50],[0,1.50,0]]] ]]}})";
  CHECK(comes_back(json_fg, Format::json_fg));
  CHECK_FALSE(framing_has(kept(json_fg, Format::json_fg), "[0,1.50,0]"));
  for (const std::string exponent : {"0e+00", "0E+00"}) {
    const std::string text = replaced(wkt, "1.50", "1.5" + exponent);
    CHECK(comes_back(text, Format::wkt));
    CHECK(kept(text, Format::wkt).framing.size() < text.size());
  }
  const std::string stl = file_text("meshes/stl_box_ascii.stl");
  CHECK(kept(stl, Format::stl).framing.size() < stl.size() * 3 / 4);
}

TEST_CASE("kept documents: a binary STL refers to its triangles, whatever other bytes it has") {
  std::string stl = file_text("meshes/stl_box_binary.stl");
  const std::size_t triangles = (stl.size() - 84) / 50;
  CHECK(kept(stl, Format::stl).framing.size() < stl.size() - 30 * triangles);
  for (std::size_t triangle = 0; triangle < triangles; ++triangle) {
    for (std::size_t i = 0; i < 12; ++i) stl[84 + 50 * triangle + i] = static_cast<char>(i);
    stl[84 + 50 * triangle + 48] = static_cast<char>(triangle);
  }
  CHECK(comes_back(stl, Format::stl));
  stl[84 + 12 + 3] = '\x80';  // -0 where the solid has 0
  CHECK(comes_back(stl, Format::stl));
}

TEST_CASE("kept documents: bytes that the writer would write take a few bytes") {
  for (const Format format : {Format::obj, Format::off, Format::wkt, Format::ewkb}) {
    INFO(formats::to_string(format));
    const auto bytes = formats::write_document(gml_of(tetrahedron("1.5")), format);
    REQUIRE(bytes);
    const std::string text(as_text(*bytes));
    CHECK(comes_back(text, format));
    CHECK(kept(text, format).framing.size() < 12);
    if (format != Format::ewkb) CHECK(comes_back(text + "\n", format));
  }
}

}  // namespace
}  // namespace watertight::test_kept_documents
