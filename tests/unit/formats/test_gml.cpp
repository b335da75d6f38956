// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <string>
#include <vector>

#include "formats/gml/gml.h"
#include "gml_samples.h"

namespace watertight::test_gml {
namespace {

using namespace test;

Document file(const std::string& name) { return gml_of(file_text("gml/" + name)); }

TEST_CASE("GML: a lone Solid has shells of triangles, patches and polygons") {
  const Document document = file("solid_3_2.gml");
  REQUIRE(document.features.size() == 1);
  const Feature& feature = document.features[0];
  CHECK(feature.id == "nested");
  CHECK(feature.srid == 7415);
  REQUIRE(feature.solids.size() == 1);
  const SubmittedSolid& submitted = feature.solids[0];
  CHECK(submitted.source.object_id == "nested");
  CHECK(submitted.source.geometry_type == "Solid");
  CHECK(submitted.solid.shell_count() == 2);
  CHECK(submitted.solid.facets_of(1).size() == 4);
  CHECK(submitted.solid.srid() == 7415);
  CHECK(submitted.solid.vertex_count() == 8);
  CHECK(is_closed(submitted.solid));
  REQUIRE(submitted.facet_ids.size() == 8);
  CHECK(submitted.facet_ids[7] == "last");
  CHECK(submitted.facet_ids[0].empty());
}

TEST_CASE(
    "GML: a CityGML 2 building takes its facets by reference, turned where the reference says so") {
  const Document document = file("citygml_2_xlinks.gml");
  REQUIRE(document.features.size() == 1);
  const Feature& feature = document.features[0];
  CHECK(feature.id == "house");
  CHECK(feature.type == "Building");
  CHECK(feature.srid == 25832);
  REQUIRE(feature.solids.size() == 3);
  const SubmittedSolid& house = feature.solids[0];
  CHECK(house.source.object_id == "house");
  CHECK(house.source.lod == "2");
  CHECK(house.solid.facet_count() == 5);
  CHECK(house.solid.vertex_count() == 5);
  CHECK(is_closed(house.solid));
  CHECK(house.facet_ids == std::vector<std::string>{"ground", "west", "east-inside", "south", ""});
  const SubmittedSolid& part = feature.solids[2];
  CHECK(part.source.object_id == "part");
  CHECK(part.source.lod == "3");
  CHECK(part.solid == house.solid);
}

TEST_CASE("GML: CityGML 3 spaces, exact numbers, comments and CDATA in coordinates are read") {
  const Document document = file("citygml_3.gml");
  REQUIRE(document.features.size() == 1);
  const Feature& tower = document.features[0];
  CHECK(tower.srid == 25833);
  REQUIRE(tower.solids.size() == 2);
  CHECK(is_closed(tower.solids[0].solid));
  CHECK(tower.solids[0].solid.vertex_count() == 4);
  CHECK(tower.solids[0].source.lod == "2");
  CHECK(tower.solids[1].source.object_id == "tower-part");
  CHECK(tower.solids[1].source.geometry_type == "MultiSolid");
  CHECK(tower.solids[1].source.lod == "1");
  REQUIRE(document.templates.size() == 1);
  CHECK(document.templates[0].source.object_id == "bench");
  CHECK(document.templates[0].source.lod == "3");
  CHECK(is_closed(document.templates[0].solid));
}

TEST_CASE("GML: real files have the number of solids that other programs count") {
  CHECK(file("ogc_Building_LOD1-EPSG25832.gml").features.at(0).srid == 25832);
  const Document lod2 = file("ogc_Building_LOD2-EPSG25832.gml");
  REQUIRE(lod2.features.size() == 1);
  REQUIRE(lod2.features[0].solids.size() == 1);
  CHECK(lod2.features[0].solids[0].solid.facet_count() == 7);
  CHECK(is_closed(lod2.features[0].solids[0].solid));
  const Document lod3 = file("ogc_Building_LOD3-EPSG25832.gml");
  CHECK(lod3.features.at(0).solids.at(0).solid.facet_count() == 22);
  CHECK_FALSE(is_closed(lod3.features[0].solids[0].solid));

  const Document swiss = file("small_sig3d-genericattributes-citygml2.xml");
  CHECK(swiss.features.at(0).srid == 0);
  CHECK(swiss.notes ==
        std::vector<std::string>{"reference system 'CH1903' has no known EPSG code"});
}

TEST_CASE("GML: members of a CompositeSolid are solids of one geometry") {
  const Document document = file("csol5.gml");
  REQUIRE(document.features.size() == 1);
  const auto& solids = document.features[0].solids;
  REQUIRE(solids.size() == 3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    CHECK(solids[i].source.geometry_type == "CompositeSolid");
    CHECK(solids[i].source.geometry == 0);
    CHECK(solids[i].source.ordinal == i);
    CHECK(solids[i].solid.lattice() == solids[0].solid.lattice());
  }
}

TEST_CASE("GML: cells of IndoorGML are features of their own") {
  const Document document = file("igml_703_1.gml");
  REQUIRE(document.features.size() == 2);
  CHECK(document.features[0].id == "C1");
  CHECK(document.features[1].id == "C2");
  CHECK(document.features[1].type == "CellSpace");
  CHECK(document.features[1].solids.at(0).solid.facet_count() == 6);
}

TEST_CASE("GML: a CompositeSolid in a MultiSolid is a geometry of its own") {
  const auto solid = [](const std::string& s) {
    return "<g:solidMember>" + s + "</g:solidMember>";
  };
  const Document document =
      gml_of(model(building("<g:MultiSolid>" + solid(kTetrahedron) +
                            solid("<g:CompositeSolid>" + solid(kTetrahedron) + solid(kTetrahedron) +
                                  "</g:CompositeSolid>") +
                            solid(kTetrahedron) + "</g:MultiSolid>")));
  const auto& solids = document.features.at(0).solids;
  REQUIRE(solids.size() == 4);
  CHECK(solids[1].source.geometry_type == "MultiSolid");
  CHECK(solids[1].source.ordinal == 1);
  CHECK(solids[2].source.geometry_type == "CompositeSolid");
  CHECK(solids[2].source.geometry == 1);
  CHECK(solids[2].source.ordinal == 0);
  CHECK(solids[3].source.ordinal == 1);
}

TEST_CASE("GML: object id and geometry number name one geometry, also of objects without gml:id") {
  const std::string part =
      "<part><BuildingPart><lod1Solid>" + kTetrahedron + "</lod1Solid></BuildingPart></part>";
  const Document document = gml_of(model("<member><Building g:id=\"b\">" + part + part +
                                         "</Building></member>" + building(kTetrahedron)));
  REQUIRE(document.features.size() == 2);
  const auto& solids = document.features[0].solids;
  REQUIRE(solids.size() == 2);
  CHECK(solids[0].source.object_id.empty());
  CHECK(solids[0].source.geometry == 0);
  CHECK(solids[1].source.geometry == 1);
  CHECK(document.features[1].solids.at(0).source.geometry == 0);
}

TEST_CASE("GML: features come in any collection and need no gml:id") {
  const std::string features =
      R"(<w:FeatureCollection xmlns:w="http://www.opengis.net/wfs/2.0" )"
      R"(xmlns:g="http://www.opengis.net/gml/3.2" xmlns:a="urn:own">)"
      "<w:member><w:FeatureCollection><w:member><a:Tank g:id=\"t1\"><a:shape>" +
      kTetrahedron +
      "</a:shape></a:Tank></w:member></w:FeatureCollection></w:member>"
      "<w:member><a:Tank><a:shape><g:MultiGeometry><g:geometryMembers>" +
      kBase + kTetrahedron +
      "</g:geometryMembers></g:MultiGeometry></a:shape></a:Tank></w:member>"
      "<w:member>" +
      kTetrahedron + "</w:member></w:FeatureCollection>";
  const Document document = gml_of(features);
  REQUIRE(document.features.size() == 3);
  CHECK(document.features[0].id == "t1");
  CHECK(document.features[0].type == "Tank");
  CHECK(document.features[1].id.empty());
  CHECK(document.features[1].solids.at(0).source.geometry_type == "MultiGeometry");
  CHECK(document.features[2].type.empty());
}

TEST_CASE("GML: a ring that does not end where it starts is kept and listed") {
  const Document document =
      gml_of(model(building(solid_of(member(kBase) + member(polygon("0 0 0 1 0 0 0 0 1")) +
                                     member(polygon("")) + member(polygon("5 5 5"))))));
  const SubmittedSolid& submitted = document.features.at(0).solids.at(0);
  CHECK(submitted.unclosed_rings == std::vector<Index>{1});
  CHECK(submitted.solid.ring(1).size() == 3);
  CHECK(submitted.solid.ring(2).empty());
  CHECK(submitted.solid.ring(3).size() == 1);
}

TEST_CASE("GML: a solid or polygon without exterior has an empty one") {
  const std::string interior =
      "<g:interior><g:LinearRing><g:posList>0 0 0 1 0 0 0 1 0 0 0 0"
      "</g:posList></g:LinearRing></g:interior>";
  const Document document = gml_of(model(building(
      "<g:Solid><g:interior><g:Shell>" + member("<g:Polygon>" + interior + "</g:Polygon>") +
      "</g:Shell></g:interior></g:Solid>")));
  const Solid& solid = document.features.at(0).solids.at(0).solid;
  REQUIRE(solid.shell_count() == 2);
  CHECK(solid.facets_of(0).size() == 0);
  REQUIRE(solid.rings_of(0).size() == 2);
  CHECK(solid.ring(0).empty());
  CHECK(solid.ring(1).size() == 3);
}

TEST_CASE("GML: geometry that no solid uses is not judged") {
  const Document document =
      gml_of(model("<cityObjectMember><Road g:id=\"r\"><lod1MultiSurface><g:MultiSurface>" +
                   member(polygon("not numbers")) + member_of("nothing") +
                   "</g:MultiSurface></lod1MultiSurface></Road></cityObjectMember>"));
  CHECK(document.features.empty());
  REQUIRE(document.notes.size() == 1);
  CHECK(document.notes[0] == "the document has no solids; 1 other geometry is passed over");
}

TEST_CASE("GML: positions are read from pos, from Points and from coordinates with three numbers") {
  const std::string ring =
      "<g:pointProperty><g:Point><g:pos>0 0 0</g:pos></g:Point></g:pointProperty>"
      "<g:pos>0 1 0</g:pos><g:pointRep><g:Point><g:coordinates>1,0,0</g:coordinates></g:Point>"
      "</g:pointRep><g:pos>0 0 0</g:pos>";
  const Document document =
      gml_of(model(building(solid_of(member("<g:Polygon><g:exterior><g:LinearRing>" + ring +
                                            "</g:LinearRing></g:exterior></g:Polygon>") +
                                     kSides))));
  CHECK(document.features.at(0).solids.at(0).solid ==
        gml_of(model(building(kTetrahedron))).features.at(0).solids.at(0).solid);
}

TEST_CASE("GML: digits beyond the exact ones are rounded and reported") {
  const Document document = gml_of(model(
      building(solid_of(member(polygon("0 0 0 0 1 0.12345678901234567890123 1 0 0 0 0 0"))))));
  CHECK(document.features.at(0).solids.at(0).rounded == std::vector<Index>{1});
}

TEST_CASE("GML: an srsName gives its EPSG code") {
  CHECK(formats::srid_of_srs_name("EPSG:25832") == 25832);
  CHECK(formats::srid_of_srs_name("epsg:4979") == 4979);
  CHECK(formats::srid_of_srs_name("urn:ogc:def:crs:EPSG::6697") == 6697);
  CHECK(formats::srid_of_srs_name("urn:ogc:def:crs:EPSG:6.12:3068") == 3068);
  CHECK(formats::srid_of_srs_name("urn:ogc:def:crs,crs:EPSG:6.12:3068,crs:EPSG:6.12:5783") == 3068);
  CHECK(formats::srid_of_srs_name("urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783") == 25832);
  CHECK(formats::srid_of_srs_name("http://www.opengis.net/def/crs/EPSG/0/6697") == 6697);
  CHECK(formats::srid_of_srs_name("https://www.opengis.net/def/crs/EPSG/9.9.1/7415") == 7415);
  CHECK(formats::srid_of_srs_name("http://www.opengis.net/gml/srs/epsg.xml#4326") == 4326);
  CHECK(formats::srid_of_srs_name(
            "http://www.opengis.net/def/crs-compound?1=http://www.opengis.net/def/"
            "crs/EPSG/0/25832&2=http://www.opengis.net/def/crs/EPSG/0/5783") == 25832);
  CHECK(formats::srid_of_srs_name("urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH*GCG2016") == 25832);
  CHECK(formats::srid_of_srs_name("urn:adv:crs:DE_DHDN_3GK4") == 31468);
  CHECK(formats::srid_of_srs_name("urn:adv:crs:elsewhere") == 0);
  CHECK(formats::srid_of_srs_name("CH1903") == 0);
  CHECK(formats::srid_of_srs_name("EPSG") == 0);
  CHECK(formats::srid_of_srs_name("EPSG:99999999999") == 0);
  CHECK(formats::srid_of_srs_name("") == 0);
}

TEST_CASE("GML: features can have reference systems of their own, a solid only one") {
  const auto in = [](const std::string& system) {
    return solid_of(member(kBase) + kSides, " srsName=\"" + system + "\"");
  };
  const Document document =
      gml_of(model(building(in("EPSG:25832"), "a") + building(in("EPSG:25833"), "b")));
  CHECK(document.features.at(0).srid == 25832);
  CHECK(document.features.at(1).srid == 25833);

  const std::string two = unreadable(
      model(building(solid_of(member(polygon("0 0 0 0 1 0 1 0 0 0 0 0", " srsName=\"EPSG:7415\"")),
                              " srsName=\"EPSG:25832\""))));
  CHECK(says(two, "is in 'EPSG:7415', its solid in 'EPSG:25832'"));
  CHECK(gml_of(model(building(solid_of(member(polygon("0 0 0 0 1 0 1 0 0 0 0 0",
                                                      " srsName=\"urn:ogc:def:crs:EPSG::25832\"")),
                                       " srsName=\"EPSG:25832\""))))
            .features.size() == 1);
}

TEST_CASE("GML: latitude first is read as longitude first where the srsName means so") {
  // The facets face outward in the axes latitude, longitude, height.
  const std::string tetrahedron = member(polygon("35 139 0 36 139 0 35 140 0 35 139 0")) +
                                  member(polygon("36 139 0 35 139 0 35 139 1 36 139 0")) +
                                  member(polygon("35 140 0 36 139 0 35 139 1 35 140 0")) +
                                  member(polygon("35 139 0 35 140 0 35 139 1 35 139 0"));
  const auto first_position = [](const Document& document) {
    const Solid& solid = document.features.at(0).solids.at(0).solid;
    return solid.lattice().world(solid.vertices()[solid.ring(1)[0]]);
  };
  const auto in = [&](const std::string& system, const std::string& members) {
    return gml_of(model(building(solid_of(members, " srsName=\"" + system + "\""))));
  };
  using Position = std::array<double, 3>;
  for (const std::string system : {"urn:ogc:def:crs:EPSG::6697", "URN:OGC:DEF:CRS:EPSG::6697",
                                   "http://www.opengis.net/def/crs/EPSG/0/6697",
                                   "urn:ogc:def:crs,crs:EPSG::6668,crs:EPSG::6695",
                                   "urn:adv:crs:ETRS89_Lat-Lon", "urn:x-ogc:def:crs:EPSG:4326"}) {
    INFO(system);
    const Document document = in(system, tetrahedron);
    CHECK(first_position(document) == Position{139, 36, 0});
    CHECK(is_closed(document.features[0].solids[0].solid));
    REQUIRE(document.notes.size() == 1);
    CHECK(document.notes[0] ==
          "positions in '" + system + "' are latitude, longitude; read as longitude, latitude");
  }
  for (const std::string system :
       {"EPSG:6697", "http://www.opengis.net/gml/srs/epsg.xml#4326", "urn:ogc:def:crs:EPSG::31467",
        "urn:ogc:def:crs:EPSG::7084", "urn:ogc:def:crs:EPSG::4978"}) {
    INFO(system);
    const Document document = in(system, tetrahedron);
    CHECK(first_position(document) == Position{36, 139, 0});
    CHECK(document.notes.empty());
  }
}

TEST_CASE(
    "GML: first positions beyond the poles are no latitudes; templates have no reference system") {
  const Document far =
      gml_of(model(building(solid_of(member(polygon("139 35 0 140 35 0 139 36 0 139 35 0")),
                                     " srsName=\"urn:ogc:def:crs:EPSG::6697\""))));
  const Solid& solid = far.features.at(0).solids.at(0).solid;
  CHECK(solid.lattice().world(solid.vertices()[1]) == std::array<double, 3>{140, 35, 0});
  REQUIRE(far.notes.size() == 1);
  CHECK(far.notes[0].find("in the order written") != std::string::npos);

  const std::string content =
      "<g:boundedBy><g:Envelope srsName=\"urn:ogc:def:crs:EPSG::6697\"/></g:boundedBy>"
      "<cityObjectMember><Tree g:id=\"t\"><lod1ImplicitRepresentation><ImplicitGeometry>"
      "<relativeGMLGeometry>" +
      kTetrahedron +
      "</relativeGMLGeometry></ImplicitGeometry></lod1ImplicitRepresentation></Tree>"
      "</cityObjectMember>";
  const Document trees = gml_of(model(content));
  REQUIRE(trees.templates.size() == 1);
  CHECK(trees.templates[0].solid.srid() == 0);
  CHECK(trees.templates[0].solid.vertices()[1] == Point{0, 1, 0});
  CHECK(trees.notes.empty());
}

TEST_CASE("GML: implicit geometries are instances of the templates that they hold or refer to") {
  const auto tree = [](const std::string& id, const std::string& matrix, const std::string& rest) {
    return "<cityObjectMember><Tree g:id=\"" + id +
           "\"><lod1ImplicitRepresentation><ImplicitGeometry><transformationMatrix>" + matrix +
           "</transformationMatrix><relativeGMLGeometry" + rest +
           "</ImplicitGeometry></lod1ImplicitRepresentation></Tree></cityObjectMember>";
  };
  std::string solid = kTetrahedron;
  solid.insert(solid.find("Solid") + 5, " g:id=\"shape\"");
  const std::string inside = ">" + solid + "</relativeGMLGeometry>";
  const std::string outside = " x:href=\"#shape\"/>";
  const Document document =
      gml_of(model(tree("a", "-1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1", outside) +
                   tree("b", "\n0.5 0 0 0  0 1 0 0\t0 0 1 0 0 0 0 1.0 ", inside) +
                   tree("c", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", " x:href=\"#none\"/>")));
  CHECK(document.features.empty());
  CHECK(document.templates.size() == 1);
  REQUIRE(document.instances.size() == 2);
  CHECK(document.instances[0].source.object_id == "a");
  CHECK(document.instances[0].template_number == 0);
  CHECK(geometry::determinant_sign(document.instances[0].placement) == -1);
  CHECK(geometry::shift_of(document.instances[0].placement) == std::array<double, 3>{5, 6, 7});
  CHECK(document.instances[1].placement.linear[0][0] == GridNumber{5, -1});
  for (const std::string wrong :
       {"1 0 0", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2", "a b c", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0"}) {
    const Error error = gml_error(model(tree("a", wrong, inside)));
    CHECK(error.code == ErrorCode::malformed);
    CHECK(error.message.find("'a'") != std::string::npos);
  }
}

TEST_CASE("GML: one solid cannot have latitude first and second") {
  const std::string error = unreadable(
      model(building(solid_of(member(polygon("0 0 0 0 1 0 1 0 0 0 0 0", " srsName=\"EPSG:4326\"")),
                              " srsName=\"urn:ogc:def:crs:EPSG::4326\""))));
  CHECK(says(error, "is in 'EPSG:4326', its solid in 'urn:ogc:def:crs:EPSG::4326'"));
}

TEST_CASE("GML: parts of a building, and parts of parts, name the building") {
  const auto part = [](const std::string& id, const std::string& more) {
    return "<consistsOfBuildingPart><BuildingPart g:id=\"" + id + "\"><lod1Solid>" + kTetrahedron +
           "</lod1Solid>" + more + "</BuildingPart></consistsOfBuildingPart>";
  };
  const std::string room =
      "<room><Room g:id=\"r\"><lod4Solid>" + kTetrahedron + "</lod4Solid></Room></room>";
  const Document document = gml_of(
      model("<m><Building g:id=\"b\"><lod1Solid>" + kTetrahedron + "</lod1Solid>" +
            part("p", part("q", room)) + "</Building></m><m><Tunnel g:id=\"t\"><lod1Solid>" +
            kTetrahedron + "</lod1Solid></Tunnel></m><m><BuildingPart g:id=\"lone\"><lod1Solid>" +
            kTetrahedron + "</lod1Solid></BuildingPart></m>"));
  std::vector<std::string> buildings;
  for (const Feature& feature : document.features) {
    for (const SubmittedSolid& solid : feature.solids) {
      buildings.push_back(solid.source.object_id + ":" + solid.source.building_id);
    }
  }
  CHECK(buildings == std::vector<std::string>{"b:b", "p:b", "q:b", "r:", "t:", "lone:"});
}

TEST_CASE("GML: the format is detected by name and by the first bytes") {
  for (const char* name : {"x.gml", "x.XML", "x.citygml"}) {
    CHECK(*formats::detect_format(name, {}) == Format::gml);
  }
  CHECK(*formats::detect_format("-", as_bytes("\xEF\xBB\xBF <?xml version='1.0'?><a/>")) ==
        Format::gml);
}

TEST_CASE("GML: solids are written as CityJSON, OBJ and WKT; GML is not written") {
  const Document document = file("citygml_2_xlinks.gml");
  for (const Format format :
       {Format::city_json, Format::city_json_seq, Format::gml, Format::wkt, Format::obj}) {
    const auto bytes = formats::write_document(document, format);
    REQUIRE(bytes);
    const auto again = formats::read_document(*bytes, format);
    REQUIRE(again);
    std::size_t solids = 0;
    for (const Feature& feature : again->features) solids += feature.solids.size();
    CHECK(solids == 3);
  }
}

// A fuzzer found: writing the document as CityJSON reported that it was malformed.
TEST_CASE("GML whose decimals span too many digits for one grid is not written as CityJSON") {
  const std::string text =
      R"(<g:Solid xmlns:g="http://www.opengis.net/gml/3.2"><g:exterior><g:Polygon><g:exterior>)"
      R"(<g:LinearRing><g:coordinates>0.5,0,0 1,0,0 0,1,1e-30 0.5,0,0</g:coordinates>)"
      R"(</g:LinearRing></g:exterior></g:Polygon></g:exterior></g:Solid>)";
  const auto document = formats::read_document(as_bytes(text), Format::gml);
  REQUIRE(document);
  const auto written = formats::write_document(*document, Format::city_json);
  REQUIRE_FALSE(written);
  CHECK(written.error().code == ErrorCode::unsupported);
  CHECK(formats::write_document(*document, Format::ewkb));
}

}  // namespace
}  // namespace watertight::test_gml
