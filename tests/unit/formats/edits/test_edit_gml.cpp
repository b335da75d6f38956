// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <functional>
#include <string>
#include <vector>

#include "formats/gml/edits/edit_gml.h"
#include "formats/gml/edits/xml_spans.h"
#include "tests/unit/formats/gml_samples.h"

namespace watertight::test_edit_gml {
namespace {

using namespace test;
using formats::EditedGml;
using formats::ReadOptions;
using formats::SolidEdit;

using RingList = std::vector<std::vector<Index>>;

/// A facet of an edited solid, and the facet of the solid before from which it comes.
struct Facet {
  RingList rings;
  Index source = kNone;
};

std::vector<Facet> facets_of(const Solid& solid) {
  std::vector<Facet> facets;
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    Facet& its = facets.emplace_back();
    its.source = facet;
    const IndexRange rings = solid.rings_of(facet);
    for (Index ring = rings.begin; ring < rings.end; ++ring) {
      its.rings.emplace_back(solid.ring(ring).begin(), solid.ring(ring).end());
    }
  }
  return facets;
}

/// The edit that gives a solid other facets; `change` gets those of a shell.
SolidEdit edit_of(const Solid& solid, std::size_t number,
                  const std::function<void(std::vector<Facet>&)>& change) {
  SolidArrays arrays;
  arrays.vertices.assign(solid.vertices().begin(), solid.vertices().end());
  SolidEdit edit{number, solid, {}};
  const std::vector<Facet> all = facets_of(solid);
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    const IndexRange range = solid.facets_of(shell);
    std::vector<Facet> facets(all.begin() + range.begin, all.begin() + range.end);
    change(facets);
    for (const Facet& facet : facets) {
      for (const auto& ring : facet.rings) {
        arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.begin(), ring.end());
        arrays.end_ring();
      }
      arrays.end_facet();
      edit.facet_source.push_back(facet.source);
    }
    arrays.end_shell();
  }
  auto changed = Solid::make(std::move(arrays), solid.lattice(), solid.srid());
  REQUIRE(changed);
  edit.solid = *std::move(changed);
  return edit;
}

/// All solids of a document changed in the same way.
EditedGml edited(const std::string& text, const std::function<void(std::vector<Facet>&)>& change) {
  const Document document = gml_of(text);
  std::vector<SolidEdit> edits;
  std::size_t number = 0;
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& submitted : feature.solids) {
      if (submitted.solid.facet_count() > 0) {
        edits.push_back(edit_of(submitted.solid, number, change));
      }
      ++number;
    }
  }
  auto result = formats::edit_gml(as_bytes(text), ReadOptions{}, edits);
  if (!result) FAIL(to_string(result.error()));
  return *std::move(result);
}

void turn(std::vector<Facet>& facets) {
  for (Facet& facet : facets) {
    for (auto& ring : facet.rings) std::reverse(ring.begin(), ring.end());
  }
}

/// Divides facets without holes along a diagonal.
void divide(std::vector<Facet>& facets) {
  const std::vector<Facet> before = facets;
  facets.clear();
  for (const Facet& facet : before) {
    const auto& ring = facet.rings[0];
    if (facet.rings.size() > 1 || ring.size() < 4) {
      facets.push_back(facet);
      continue;
    }
    facets.push_back({{{ring[0], ring[1], ring[2]}}, facet.source});
    std::vector<Index> rest(ring.begin() + 2, ring.end());
    rest.push_back(ring[0]);
    facets.push_back({{rest}, facet.source});
  }
}

/// Takes the first facet away, and adds it again as a new one.
void replace_first(std::vector<Facet>& facets) {
  Facet first = facets.front();
  first.source = kNone;
  facets.erase(facets.begin());
  facets.push_back(first);
}

std::string text_of(const EditedGml& gml) { return std::string(as_text(gml.text)); }

TEST_CASE("a GML document gets turned, divided and replaced facets, in every way to write them") {
  for (const char* name :
       {"citygml_3.gml", "solid_3_2.gml", "city_2.gml",
        "small_sig3d-genericattributes-citygml2.xml", "ogc_Building_LOD1-EPSG25832.gml",
        "ogc_Building_LOD2-EPSG25832.gml", "ogc_Building_LOD3-EPSG25832.gml", "indoor_valid.gml"}) {
    INFO(name);
    const std::string text = file_text(std::string("gml/") + name);
    for (const auto& change : {turn, divide, replace_first}) {
      const EditedGml gml = edited(text, change);  // reads the text again and compares the solids
      for (const auto& [solid, error] : gml.refused) UNSCOPED_INFO(to_string(error));
      CHECK(gml.refused.empty());
    }
  }
}

TEST_CASE("a polygon that is changed keeps its element and its ids, and all else its bytes") {
  const std::string text = file_text("gml/citygml_2_xlinks.gml");
  const std::string changed = text_of(edited(text, turn));
  CHECK(changed != text);
  for (const char* id : {"\"ground\"", "\"west\"", "\"west-ring\"", "\"east\"", "\"south\""}) {
    CHECK(changed.find(id) != std::string::npos);
  }
  CHECK(changed.find("<!-- written from inside -->") != std::string::npos);
  CHECK(changed.find("10 0 0 10 10 0 0 10 0 0 0 0 10 0 0") != std::string::npos);
  const std::string same = text_of(edited(text, [](std::vector<Facet>&) {}));
  CHECK(same == text);
}

TEST_CASE("a divided polygon of a thematic surface gets its parts there and in the shell") {
  const std::string changed = text_of(edited(file_text("gml/citygml_2_xlinks.gml"), divide));
  CHECK(changed.find("<g:surfaceMember x:href=\"#ground\"/>\n"
                     "        <g:surfaceMember x:href=\"#watertight-1\"/>") != std::string::npos);
  const std::size_t surface = changed.find("<bldg:GroundSurface");
  const std::size_t part = changed.find("<g:Polygon g:id=\"watertight-1\">");
  CHECK(surface < part);
  CHECK(part < changed.find("</bldg:GroundSurface>"));
  CHECK(gml_of(changed).features[0].solids[0].solid.facet_count() == 6);
}

TEST_CASE("an id that the document has is not given again") {
  std::string text = file_text("gml/citygml_2_xlinks.gml");
  text.replace(text.find("\"house-solid\""), 13, "\"watertight-1\"");
  text.replace(text.find("#house-solid"), 12, "#watertight-1");
  text.replace(text.find("#house-solid"), 12, "#watertight-1");
  const std::string changed = text_of(edited(text, divide));
  CHECK(changed.find("<g:Polygon g:id=\"watertight-2\">") != std::string::npos);
}

/// A tetrahedron with a texture for its first polygon.
std::string textured(const std::string& shell) {
  return model("<g:Solid g:id=\"s\"><g:exterior><g:Shell>" + shell +
               "</g:Shell></g:exterior></g:Solid>"
               "<app:target xmlns:app=\"a\" uri=\"#p0\"><app:TexCoordList/></app:target>"
               "<app:target xmlns:app=\"a\" uri=\"#other\"><app:TexCoordList/></app:target>");
}

const std::string kTetrahedron =
    "<g:surfaceMember><g:Polygon g:id=\"p0\"><g:exterior><g:LinearRing><g:posList>0 0 0 0 4 0 4 0 "
    "0 "
    "0 0 0</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>"
    "<g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList>0 0 0 4 0 0 0 0 4 0 0 0"
    "</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>"
    "<g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList>4 0 0 0 4 0 0 0 4 4 0 0"
    "</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>"
    "<g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList>0 4 0 0 0 0 0 0 4 0 4 0"
    "</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>";

TEST_CASE("the texture of a polygon that is changed is taken out") {
  const std::string changed = text_of(edited(textured(kTetrahedron), turn));
  CHECK(changed.find("uri=\"#p0\"") == std::string::npos);
  CHECK(changed.find("uri=\"#other\"") != std::string::npos);
}

TEST_CASE("holes come and go with the properties that hold them") {
  const std::string ring = "0 0 0 4 0 0 0 0 4 0 0 0";
  const std::string hole =
      "<g:interior><g:LinearRing><g:posList>1 0 1 1 0 2 2 0 1 1 0 1</g:posList></g:LinearRing>"
      "</g:interior>";
  std::string shell = kTetrahedron;
  const std::size_t at = shell.find("</g:exterior>", shell.find(ring)) + 13;
  shell.insert(at, hole);
  const auto move_hole = [](std::vector<Facet>& facets) {
    facets[0].rings.push_back(facets[1].rings[1]);
    facets[1].rings.pop_back();
  };
  const std::string changed = text_of(edited(textured(shell), move_hole));
  CHECK(changed.find("<g:interior>") < changed.find(ring));
  CHECK(changed.find("<g:interior>", changed.find(ring)) == std::string::npos);
}

TEST_CASE("a solid that the text cannot have is refused, and the others are written") {
  const std::string triangles =
      "<g:Solid g:id=\"a\"><g:exterior><g:TriangulatedSurface><g:trianglePatches>"
      "<g:Triangle><g:exterior><g:LinearRing><g:posList>0 0 0 0 4 0 4 0 0 0 0 0</g:posList>"
      "</g:LinearRing></g:exterior></g:Triangle>"
      "<g:Triangle><g:exterior><g:LinearRing><g:posList>0 0 0 4 0 0 0 0 4 0 0 0</g:posList>"
      "</g:LinearRing></g:exterior></g:Triangle>"
      "</g:trianglePatches></g:TriangulatedSurface></g:exterior></g:Solid>";
  const auto merge = [](std::vector<Facet>& facets) {
    if (facets.size() != 2) return turn(facets);
    facets[0].rings[0] = {0, 1, 2, 3};
    facets.pop_back();
  };
  const std::string text = textured(kTetrahedron);
  const std::size_t at = text.find("<g:Solid");
  const EditedGml gml = edited(text.substr(0, at) + triangles + text.substr(at), merge);
  REQUIRE(gml.refused.size() == 1);
  CHECK(gml.refused[0].first == 0);
  CHECK(gml.refused[0].second.message.find("a Triangle cannot hold the repaired facet") !=
        std::string::npos);
  CHECK(text_of(gml).find(triangles) != std::string::npos);
  CHECK(text_of(gml).find("uri=\"#p0\"") == std::string::npos);
}

TEST_CASE("a solid whose shells change is refused") {
  std::string text = file_text("gml/solid_3_2.gml");
  const std::size_t begin = text.find("<gml:surfaceMember>");
  text.erase(begin, text.find("</gml:Shell>") - begin);
  const Document document = gml_of(text);
  const Solid& solid = document.features[0].solids[0].solid;
  REQUIRE(solid.facets_of(0).size() == 0);
  SolidArrays arrays;
  arrays.vertices.assign(solid.vertices().begin(), solid.vertices().end());
  SolidEdit edit{0, solid, {}};
  for (const Facet& facet : facets_of(solid)) {
    const auto& ring = facet.rings[0];
    arrays.ring_vertices.insert(arrays.ring_vertices.end(), ring.rbegin(), ring.rend());
    arrays.end_ring();
    arrays.end_facet();
    edit.facet_source.push_back(facet.source);
  }
  arrays.end_shell();
  auto one_shell = Solid::make(std::move(arrays), solid.lattice(), solid.srid());
  REQUIRE(one_shell);
  edit.solid = *std::move(one_shell);
  const auto gml = formats::edit_gml(as_bytes(text), ReadOptions{}, {{edit}});
  REQUIRE(gml);
  CHECK(gml->refused.size() == 1);
  CHECK(text_of(*gml) == text);
}

TEST_CASE("a polygon of two solids that one of them changes stays in the other") {
  const std::string one = "<g:Solid g:id=\"a\"><g:exterior><g:Shell>" + kTetrahedron +
                          "</g:Shell></g:exterior></g:Solid>";
  const std::string two =
      "<g:Solid g:id=\"b\"><g:exterior><g:Shell><g:surfaceMember x:href=\"#p0\"/>"
      "<g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList>0 0 0 4 0 0 0 0 -4 0 0 0"
      "</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>"
      "</g:Shell></g:exterior></g:Solid>";
  const std::string text = model(one + two);
  const Document document = gml_of(text);
  REQUIRE(document.features.size() == 2);
  const auto turn_first = [](std::vector<Facet>& facets) {
    std::reverse(facets[0].rings[0].begin(), facets[0].rings[0].end());
  };
  const SolidEdit edit = edit_of(document.features[1].solids[0].solid, 1, turn_first);
  const auto gml = formats::edit_gml(as_bytes(text), ReadOptions{}, {{edit}});
  REQUIRE(gml);
  CHECK(gml->refused.empty());
  CHECK(text_of(*gml).find(one) != std::string::npos);
  CHECK(text_of(*gml).find("#p0") == std::string::npos);
}

TEST_CASE("GML in UTF-16 is not changed") {
  std::string text("\xFF\xFE", 2);
  for (const char c : std::string("<g/>")) text.append({c, '\0'});
  const Solid nothing = Solid::make(SolidArrays{}, Lattice{}, 0).value();
  const SolidEdit edit{0, nothing, {}};
  const auto gml = formats::edit_gml(as_bytes(text), ReadOptions{}, {&edit, 1});
  REQUIRE_FALSE(gml);
  CHECK(gml.error().code == ErrorCode::unsupported);
  const auto same = formats::edit_gml(as_bytes(text), ReadOptions{}, {});
  REQUIRE(same);
  CHECK(std::ranges::equal(same->text, as_bytes(text)));
}

TEST_CASE("the end of an element is found behind comments, CDATA sections and quoted signs") {
  const std::string text =
      "<a><b x='>'><!-- </b> --><b/><![CDATA[</b>]]><?p </b>?><c>1</c></b><d/></a>";
  const formats::XmlSpan span = formats::xml_span(text, 3);
  CHECK(span.name == "b");
  CHECK(text.substr(span.content, 4) == "<!--");
  CHECK(text.substr(span.content_end, 4) == "</b>");
  CHECK(text.substr(span.end) == "<d/></a>");
  CHECK(formats::xml_span(text, span.end).is_empty());
}

}  // namespace
}  // namespace watertight::test_edit_gml
