// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "gml_samples.h"

namespace watertight::test_gml_errors {
namespace {

using namespace test;

std::string sample(const std::string& members) {
  return model(building(solid_of(members, " g:id=\"s\""), "b7"));
}

/// Why a solid of these members cannot be read.
std::string solid_error(const std::string& members) { return unreadable(sample(members)); }

TEST_CASE("GML: two-dimensional positions are refused with their place") {
  const std::string list = solid_error("\n\n" + member(polygon("0 0 0 1 1 0 0 0", " g:id=\"p\"")));
  CHECK(
      says(list, "line 3: a posList of 8 numbers, which is not a multiple of 3: two-dimensional"));
  CHECK(says(list, "in Polygon 'p', in Solid 's', of object 'b7'"));

  const std::string stated = solid_error(
      member("<g:Polygon srsDimension=\"2\"><g:exterior><g:LinearRing><g:posList>0 0 0 1 1 1"
             "</g:posList></g:LinearRing></g:exterior></g:Polygon>"));
  CHECK(says(stated, "srsDimension 2"));
  CHECK(says(solid_error(member("<g:Polygon><g:exterior><g:LinearRing><g:pos>0 1</g:pos>"
                                "</g:LinearRing></g:exterior></g:Polygon>")),
             "a position of 2 numbers"));
  CHECK(says(solid_error(member("<g:Polygon><g:exterior><g:LinearRing><g:coordinates>0,0 0,1 1,1"
                                "</g:coordinates></g:LinearRing></g:exterior></g:Polygon>")),
             "a position of 2 numbers"));

  // Six positions of two numbers are four of three; the Envelope and the closing point of the ring
  // decide.
  const std::string envelope = "<g:boundedBy><g:Envelope srsDimension=\"2\"/></g:boundedBy>";
  const std::string flat = building(solid_of(member(polygon("0 0 4 0 4 4 2 5 0 4 0 0"))));
  CHECK(says(unreadable(model(envelope + flat)), "srsDimension 2 of the Envelope"));
  CHECK(gml_of(model(envelope + building(kTetrahedron))).features.size() == 1);
  CHECK(says(solid_error(member("<g:Polygon><g:exterior><g:LinearRing srsDimension=\"x\">"
                                "<g:posList>0 0 0</g:posList></g:LinearRing></g:exterior>"
                                "</g:Polygon>")),
             "srsDimension must be 3"));
}

TEST_CASE("GML: a solid that cannot be read leaves all others as they are") {
  const std::string flat = solid_of(member(polygon("0 0 5 1 1 0 0 0")) + kSides, " g:id=\"flat\"");
  const std::string half =
      solid_of(member(polygon("9 9 9 8 8 8 7 7 7 9 9 9")) + member(polygon("1 2 x")),
               " srsName=\"EPSG:4979\"");
  const std::string loop = solid_of(
      member("<g:CompositeSurface g:id=\"loop\">" + member_of("loop") + "</g:CompositeSurface>"));
  const Document whole = gml_of(model(building(kTetrahedron, "a")));
  for (const std::string& bad : {flat, half, loop}) {
    const Document document = gml_of(model(
        building("<g:MultiSolid>\n<g:solidMember>" + bad + "</g:solidMember>\n<g:solidMember>" +
                     kTetrahedron + "</g:solidMember></g:MultiSolid>",
                 "a") +
        building(kTetrahedron, "b")));
    REQUIRE(document.features.size() == 2);
    REQUIRE(document.features[0].solids.size() == 2);
    const SubmittedSolid& unread = document.features[0].solids[0];
    CHECK(unread.unreadable.starts_with("line 2: "));
    CHECK(says(unread.unreadable, ", of object 'a'"));
    CHECK(unread.source.line == 2);
    CHECK(unread.source.geometry_type == "MultiSolid");
    CHECK(unread.solid.shell_count() == 0);
    const SubmittedSolid& good = document.features[0].solids[1];
    CHECK(good.unreadable.empty());
    CHECK(good.source.line == 3);
    CHECK(good.source.ordinal == 1);
    CHECK(good.solid == whole.features[0].solids[0].solid);
    CHECK(document.features[1].solids[0].solid == good.solid);
    for (const Format format : {Format::wkt, Format::city_json}) {
      CHECK(formats::write_document(document, format).error().code == ErrorCode::malformed);
    }
  }
}

TEST_CASE("GML: facets and rings have the ids and lines of their elements") {
  const std::string ring =
      "\n<g:LinearRing g:id=\"r\"><g:posList>0 0 0 0 9 0 9 0 0 0 0 0"
      "</g:posList></g:LinearRing>";
  const std::string hole = "<g:interior>\n<g:LinearRing/></g:interior></g:Polygon>";
  std::string named = "\n<g:Polygon g:id=\"p\"><g:exterior>";
  named.append(ring).append("</g:exterior>").append(hole);
  std::string solid = "\n";
  solid += solid_of(member(named) + member("<g:Polygon>" + hole));
  const Document document = gml_of(model(building(solid)));
  const SubmittedSolid& read = document.features.at(0).solids.at(0);
  CHECK(read.source.line == 2);
  CHECK(read.facet_ids == std::vector<std::string>{"p", ""});
  CHECK(read.facet_lines == std::vector<std::uint64_t>{3, 5});
  CHECK(read.ring_ids == std::vector<std::string>{"r", "", "", ""});
  CHECK(read.ring_lines == std::vector<std::uint64_t>{4, 5, 0, 6});
  CHECK(gml_of(model(building(kTetrahedron))).features[0].solids[0].ring_ids.empty());
}

TEST_CASE("GML: coordinates are finite numbers") {
  for (const char* word : {"nan", "NaN", "INF", "-inf", "1e400", "0x10", "1,5", "--1", "1e"}) {
    const std::string error = solid_error(member(polygon(std::string("0 0 0 1 0 0 0 1 ") + word)));
    CHECK(says(error, "a coordinate of the ring"));
  }
  CHECK(says(solid_error(member("<g:Polygon><g:exterior><g:LinearRing><g:posList>0 0 <b/>0"
                                "</g:posList></g:LinearRing></g:exterior></g:Polygon>")),
             "an element inside of coordinates"));
  for (const char* tuples : {"0,0,0,0", "0,,0,0", "0,0,0 ,1", "0,0,", "0,,0 0,,0 0,,0"}) {
    const std::string error =
        solid_error(member(std::string("<g:Polygon><g:exterior><g:LinearRing><g:coordinates>") +
                           tuples + "</g:coordinates></g:LinearRing></g:exterior></g:Polygon>"));
    CHECK(says(error, "a position of"));
  }
  CHECK(says(solid_error(member("<g:Polygon><g:exterior><g:LinearRing><g:coordinates cs=\"ab\">"
                                "</g:coordinates></g:LinearRing></g:exterior></g:Polygon>")),
             "'cs' of coordinates must be one character"));
}

TEST_CASE("GML: a reference must lead to one geometry of the document") {
  CHECK(says(solid_error(member_of("away")),
             "xlink:href '#away': no geometry of this document has this gml:id, in Solid 's', of "
             "object 'b7'"));
  const std::string elsewhere = solid_error("<g:surfaceMember x:href=\"roof.gml#r1\"/>");
  CHECK(says(elsewhere, "xlink:href 'roof.gml#r1' is not the gml:id of this document"));
  CHECK(says(solid_error(member(polygon("", " g:id=\"p\"")) + member(polygon("", " g:id=\"p\"")) +
                         member_of("p")),
             "several geometries have this gml:id"));
  CHECK(says(solid_error(member_of("s")), "Solid 's' where a surface is expected"));
  CHECK(says(solid_error("<g:surfaceMember x:href=\"#p\">" + polygon("", " g:id=\"p\"") +
                         "</g:surfaceMember>"),
             "both an xlink:href and a value"));
  CHECK(says(unreadable(model("<cityObjectMember><Building g:id=\"b\"><lod1Solid x:href=\"#no\"/>"
                              "</Building></cityObjectMember>")),
             "of object 'b'"));
}

TEST_CASE("GML: a reference by way of other references keeps every turn") {
  // r1 turns p and r2 turns r1, so r2 is p as written. A ring can be referred to as well.
  const Document document = gml_of(model(
      building(
          solid_of(member("<g:OrientableSurface orientation=\"-\"><g:baseSurface x:href=\"#r1\"/>"
                          "</g:OrientableSurface>") +
                   kSides)) +
      "<cityObjectMember><Wall><lod2MultiSurface><g:MultiSurface>" +
      member("<g:OrientableSurface g:id=\"r1\" orientation=\"-\"><g:baseSurface x:href=\"#c\"/>"
             "</g:OrientableSurface>") +
      member("<g:CompositeSurface g:id=\"c\">" +
             member("<g:Polygon><g:exterior x:href=\"#ring\"/></g:Polygon>") +
             "</g:CompositeSurface>") +
      member("<g:Polygon><g:exterior><g:LinearRing g:id=\"ring\"><g:posList>"
             "0 0 0 0 1 0 1 0 0 0 0 0</g:posList></g:LinearRing></g:exterior></g:Polygon>") +
      "</g:MultiSurface></lod2MultiSurface></Wall></cityObjectMember>"));
  CHECK(is_closed(document.features.at(0).solids.at(0).solid));
}

TEST_CASE("GML: an orientation is + or -") {
  CHECK(says(solid_error(member("<g:OrientableSurface orientation=\"minus\"><g:baseSurface>" +
                                kBase + "</g:baseSurface></g:OrientableSurface>")),
             "orientation must be + or -"));
}

TEST_CASE("GML: geometry that contains itself by reference is refused") {
  CHECK(says(solid_error(member("<g:CompositeSurface g:id=\"a\">" + member_of("a") +
                                "</g:CompositeSurface>")),
             "CompositeSurface 'a' contains itself by xlink"));
  CHECK(says(solid_error(member("<g:CompositeSurface g:id=\"a\">" + member_of("b") +
                                "</g:CompositeSurface>") +
                         member("<g:Shell g:id=\"b\">" + member_of("a") + "</g:Shell>")),
             "contains itself by xlink"));
  CHECK(says(unreadable(model(building("<g:MultiSolid g:id=\"m\"><g:solidMember x:href=\"#m\"/>"
                                       "</g:MultiSolid>"))),
             "MultiSolid 'm' contains itself by xlink"));
  CHECK(says(unreadable(model(building("<g:MultiSolid g:id=\"m\"><g:solidMember>"
                                       "<g:CompositeSolid><g:solidMember x:href=\"#m\"/>"
                                       "</g:CompositeSolid></g:solidMember></g:MultiSolid>"))),
             "contains itself by xlink"));
}

TEST_CASE("GML: references cannot multiply geometry without bound") {
  // Every surface holds the next one twice: together they would be 2^40 polygons.
  std::string members = member(polygon("0 0 0 1 0 0 0 1 0 0 0 0", " g:id=\"c0\""));
  const auto numbered = [](int i) { return std::string("c").append(std::to_string(i)); };
  for (int i = 1; i <= 40; ++i) {
    std::string surface = "<g:CompositeSurface g:id=\"";
    surface.append(numbered(i)).append("\">");
    for (int twice = 0; twice < 2; ++twice) surface += member_of(numbered(i - 1));
    members += member(surface.append("</g:CompositeSurface>"));
  }
  const Error error = gml_error(sample(members));
  CHECK(error.code == ErrorCode::limit_exceeded);
  CHECK(says(error, "xlinks repeat more geometry than a document of this size could hold"));
}

TEST_CASE("GML: elements of which a solid cannot be made are named") {
  const std::string ring = solid_error(
      member("<g:Polygon><g:exterior><g:Ring><g:curveMember/></g:Ring></g:exterior></g:Polygon>"));
  CHECK(says(ring, "Ring is not read as part of a solid"));
  CHECK(says(solid_error(member("<g:Surface><g:patches><g:Sphere/></g:patches></g:Surface>")),
             "Sphere is not read"));
  CHECK(says(solid_error("<g:edgeMember/>"), "'edgeMember' is not read in Shell"));
  CHECK(says(solid_error(member("<g:Polygon><g:exterior><g:LinearRing><g:coord/></g:LinearRing>"
                                "</g:exterior></g:Polygon>")),
             "'coord' is not read in a LinearRing"));
  CHECK(says(solid_error(member("<g:Polygon><g:exterior><g:LinearRing><g:pointRep x:href=\"#p\"/>"
                                "</g:LinearRing></g:exterior></g:Polygon>")),
             "'pointRep' by reference is not read"));
  CHECK(says(solid_error(member("<g:Polygon><g:exterior/><g:exterior><g:LinearRing/></g:exterior>"
                                "<g:exterior><g:LinearRing/></g:exterior></g:Polygon>")),
             "has a second exterior ring"));
  CHECK(says(unreadable(model(building("<g:MultiSolid><g:solidMember>" + kBase +
                                       "</g:solidMember></g:MultiSolid>"))),
             "Polygon where a solid is expected"));
}

TEST_CASE("GML: XML that is broken is refused where it breaks") {
  const std::string whole = model(building(kTetrahedron));
  for (std::size_t size = 0; size + 1 < whole.size(); size += 7) {
    CHECK(gml_error(whole.substr(0, size)).code == ErrorCode::malformed);
  }
  CHECK(says(gml_error("<a>\n<b>\n</a>"), "line 3: not well-formed XML: mismatched tag"));
  CHECK(says(gml_error("<g:Solid/>"), "unbound prefix"));
  CHECK(says(gml_error(whole + "x"), "junk after document element"));
  CHECK(says(gml_error("<a b='1' b='2'/>"), "duplicate attribute"));
  CHECK(says(gml_error("<a>\xC3(</a>"), "invalid token"));
}

TEST_CASE("GML: XML of another format is refused, and its root named") {
  const Error page = gml_error("<?xml version=\"1.0\"?>\n<html><body>Not found</body></html>");
  CHECK(page.code == ErrorCode::malformed);
  CHECK(says(page, "line 2: not GML: the root element is 'html'"));
  CHECK(says(gml_error("<svg xmlns=\"http://www.w3.org/2000/svg\"/>"), "'svg'"));
  CHECK(gml_of("<CityModel xmlns=\"http://www.opengis.net/citygml/2.0\"/>").features.empty());
  CHECK(gml_of("<data><m xmlns:g=\"http://www.opengis.net/gml\"><g:name/></m></data>")
            .features.empty());
}

TEST_CASE("GML: nothing but the five entities of XML is known, and no other file is opened") {
  for (const char* start :
       {"<!DOCTYPE a SYSTEM \"file:///etc/passwd\">",
        "<!DOCTYPE a [<!ENTITY e SYSTEM \"file:///etc/passwd\">]>",
        "<!DOCTYPE a [<!ENTITY % p SYSTEM \"http://localhost/x\"> %p;]>",
        "<!DOCTYPE a [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>",
        "<!DOCTYPE a>"}) {
    const Error error = gml_error(std::string(start) + "<a>&e;</a>");
    CHECK(error.code == ErrorCode::unsupported);
    CHECK(says(error, "DOCTYPE"));
  }
  CHECK(says(gml_error("<a>&nbsp;</a>"), "undefined entity"));
  CHECK(gml_of(model(building(solid_of(member(polygon("&#48; 0 0 &#x31; 0 0 0 1 0 0 0 0"))))))
            .features.size() == 1);
}

TEST_CASE("GML: encodings are UTF-8, UTF-16 and ISO-8859-1") {
  std::string utf16 = "\xFF\xFE";
  for (const char c : "<?xml version='1.0' encoding='UTF-16'?>" + model(building(kTetrahedron))) {
    utf16 += c;
    utf16 += '\0';
  }
  CHECK(gml_of(utf16).features.size() == 1);
  CHECK(*formats::detect_format("-", as_bytes(utf16)) == Format::gml);
  const std::string latin =
      "<?xml version='1.0' encoding='ISO-8859-1'?>" + model(building(kTetrahedron,
                                                                     "Stra\xDF"
                                                                     "e"));
  CHECK(gml_of(latin).features.at(0).id ==
        "Stra\xC3\x9F"
        "e");
  const Error error = gml_error("<?xml version='1.0' encoding='EBCDIC-CP-US'?><a/>");
  CHECK(error.code == ErrorCode::unsupported);
  CHECK(says(error, "encoding is not read"));
}

TEST_CASE("GML: limits hold before memory is taken") {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  const Error nested = gml_error(deep);
  CHECK(nested.code == ErrorCode::limit_exceeded);
  CHECK(says(nested, "nested deeper than 64"));

  formats::ReadOptions options;
  options.limits.facets = 3;
  const std::string text = model(building(kTetrahedron));
  const auto facets = formats::read_document(as_bytes(text), Format::gml, options);
  REQUIRE_FALSE(facets);
  CHECK(facets.error().code == ErrorCode::limit_exceeded);
  options = {};
  options.limits.vertices = 1;
  const auto vertices = formats::read_document(as_bytes(text), Format::gml, options);
  REQUIRE_FALSE(vertices);
  CHECK(vertices.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("GML: a gml:id that every solid would repeat at length is refused") {
  const std::string longest(1024, 'i');
  CHECK(gml_of(model(building(kTetrahedron, longest))).features.at(0).id == longest);
  const Error object = gml_error(model(building(kTetrahedron, longest + "i")));
  CHECK(object.code == ErrorCode::limit_exceeded);
  CHECK(says(object, "a gml:id of more than 1024 bytes"));
  const std::string id = " g:id=\"" + longest + "i\"";
  CHECK(gml_error(sample(member(polygon("", id)))).code == ErrorCode::limit_exceeded);
}

TEST_CASE(
    "GML: a million members, attributes and texts that the reader skips take no more than their "
    "size") {
  std::string many = "<g:MultiSurface g:id=\"m\">";
  for (int i = 0; i < 100'000; ++i) many += "<g:surfaceMember/>";
  many += "</g:MultiSurface>";
  std::string attributes;
  for (int i = 0; i < 20'000; ++i) attributes.append(" a").append(std::to_string(i)).append("=''");
  const std::string text = "<?pi data?><!-- comment -->" + std::string(1'000'000, ' ');
  const Document document =
      gml_of(model(building(kTetrahedron) + building(many, "c") + "<x" + attributes + "/>" + text +
                   "<app><ring y='" + std::string(1'000'000, 'y') + "'/></app>"));
  CHECK(document.features.size() == 1);
}

}  // namespace
}  // namespace watertight::test_gml_errors
