// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests solids whose facets have rings that touch inside edges, through the whole path: verdict,
// certificate, every mode of the codec, every format.
#include <catch2/catch_test_macros.hpp>
#include <map>

#include "codec/blob.h"
#include "codec/encode_boundary.h"
#include "codec/page.h"
#include "formats/document.h"
#include "pipeline/pipeline.h"
#include "tests/solids/builders.h"
#include "tests/solids/suite.h"
#include "tests/solids/touching_rings.h"
#include "validate/certify.h"

using namespace watertight;
using namespace watertight::solids;

namespace {

delaunay::EngineWorkers& ring_engines() {
  static delaunay::EngineWorkers workers;
  return workers;
}

Inspection inspect(const Solid& solid, Proof proof = Proof::boundary) {
  CertifyOptions options;
  options.proof = proof;
  return certify(solid, proof == Proof::boundary ? nullptr : &ring_engines(), options);
}

/// The valid solids of touching_rings() and some random ones.
std::vector<TouchingRings> valid_solids() {
  std::vector<TouchingRings> list = touching_rings();
  Random random(77);
  for (int i = 0; i < 40; ++i) list.push_back(random_touching_rings(random));
  std::erase_if(list, [](const TouchingRings& touching) { return !touching.errors.empty(); });
  return list;
}

bool has_split_edges(const Solid& solid) { return !geometry::ring_touches(solid).empty(); }

Document document_of(const Solid& solid, Format format) {
  auto document = formats::read_document(as_bytes(city_json_text(solid)), Format::city_json);
  REQUIRE(document);
  document->format = Format::city_json;
  if (format == Format::city_json) return *std::move(document);
  const auto bytes = pipeline::convert_document(*document, format);
  REQUIRE(bytes);
  auto converted = formats::read_document(*bytes, format);
  REQUIRE(converted);
  return *std::move(converted);
}

}  // namespace

TEST_CASE("rings that touch inside edges get their codes, however they are written or mirrored") {
  Random random(71);
  std::set<std::set<int>> seen;
  for (int round = 0; round < 200; ++round) {
    const TouchingRings touching = random_touching_rings(random);
    seen.insert(touching.errors);
    const Solid solid = solid_of(touching.shape, millimetres());
    for (const Solid& image :
         {solid, rewritten(solid, random).solid, mapped(solid, axis_permutation(random, true)),
          mapped(solid, axis_permutation(random, false)), mapped(solid, unimodular_map(random, 9)),
          mapped(rewritten(solid, random).solid, general_map(random, 9))}) {
      const Report report = inspect(image).report;
      CHECK(codes_of(report, Severity::error) == touching.errors);
      CHECK((report.verdict == Verdict::valid) == touching.errors.empty());
    }
  }
  CHECK(seen.size() == 4);  // the sets {}, {302}, {205} and {302, 205}
}

TEST_CASE("rings may touch inside edges of facets that are planar within the tolerance only") {
  Random random(72);
  for (int round = 0; round < 100; ++round) {
    const TouchingRings touching = uneven_touching_rings(random);
    const Solid solid = solid_of(touching.shape, millimetres());
    for (const Solid& image :
         {solid, rewritten(solid, random).solid, mapped(solid, axis_permutation(random, true)),
          mapped(solid, axis_permutation(random, false))}) {
      CHECK(codes_of(inspect(image).report, Severity::error) == touching.errors);
    }
  }
}

TEST_CASE("a vertex beside an edge by one step in space still meets it in the plane: 201") {
  const Shape shape = touching_rings()[1].shape;
  Shell shell = shape[0];
  for (Facet& facet : shell) {
    for (Ring& ring : facet) {
      for (Point& p : ring) {
        if (p == Point{0, 0, 6000}) p.z += 1;
      }
    }
  }
  // The vertex is a corner of the front wall; the edge of the upper facet passes above the vertex.
  CHECK(codes_of(inspect(solid_of({shell}, millimetres())).report, Severity::error).contains(201));
}

TEST_CASE("the engines prove solids whose rings touch inside edges") {
  Random random(73);
  int proven = 0;
  for (int round = 0; round < 60; ++round) {
    const TouchingRings touching =
        round % 3 == 0 ? uneven_touching_rings(random) : random_touching_rings(random);
    if (!touching.errors.empty()) continue;
    const Solid solid = rewritten(solid_of(touching.shape, millimetres()), random).solid;
    const Inspection inspection = inspect(solid, Proof::tetrahedralization);
    CHECK(inspection.report.verdict == Verdict::valid);
    ++proven;
  }
  CHECK(proven > 20);
}

TEST_CASE(
    "a T-junction at a touch is reported with the facet, the vertex and the rings as submitted") {
  const TouchingRings touching = touching_rings()[0];
  REQUIRE(touching.name == "pit-at-edge-plain-across");
  const Solid solid = solid_of(touching.shape, millimetres());
  const Report report = inspect(solid).report;
  REQUIRE(report.findings.size() == 1);
  const Finding& finding = report.findings[0];
  CHECK(finding.code == 302);
  CHECK(finding.place.facet == 2);
  CHECK(solid.vertices()[finding.place.vertex] == Point{2000, 0, 6000});
  REQUIRE(finding.other);
  CHECK(finding.other->facet == 1);
  CHECK(finding.other->ring == 0);
  // The edge that the vertex splits starts in a corner of the submitted ring.
  CHECK(solid.vertices()[finding.other->vertex] == Point{0, 0, 6000});
  CHECK(finding.detail.find("T-junction") != std::string::npos);
}

TEST_CASE("a facet that is cut by two touches names a vertex of the touch") {
  for (const TouchingRings& touching : touching_rings()) {
    if (touching.name != "pit-at-edge-twice") continue;
    const Solid solid = solid_of(touching.shape, millimetres());
    const Report report = inspect(solid).report;
    REQUIRE(report.findings.size() == 1);
    CHECK(report.findings[0].place.facet == 1);
    CHECK(solid.vertices()[report.findings[0].place.vertex].y == 0);
    CHECK(report.findings[0].measured == 2.0);
  }
}

TEST_CASE("modes give back rings that touch inside edges as submitted, or decline them") {
  std::map<Mode, int> held;
  for (const TouchingRings& touching : valid_solids()) {
    INFO(touching.name);
    const Solid solid = solid_of(touching.shape, millimetres());
    const Inspection inspection = inspect(solid, Proof::tetrahedralization);
    REQUIRE(inspection.certified);
    const ValidSolid& valid = inspection.certified->solid;
    CHECK(valid.solid() == solid);
    for (const Mode mode : {Mode::raw, Mode::bitmap, Mode::walk, Mode::polygon, Mode::parallelogram,
                            Mode::automatic}) {
      const auto blob = encode(valid, {.mode = mode});
      const bool must_hold = mode == Mode::raw || mode == Mode::bitmap || mode == Mode::automatic;
      CHECK((blob || !must_hold));
      if (!blob) {
        CHECK(blob.error().code == ErrorCode::not_encodable);
        CHECK(blob.error().message.find("decode") == std::string::npos);
        continue;
      }
      const auto decoded = decode(*blob);
      REQUIRE(decoded);
      CHECK(decoded->solid == solid);
      if (has_split_edges(solid)) ++held[mode];
    }
    const auto steiner =
        encode(valid, {.mode = Mode::bitmap, .certificate = &*inspection.certified->certificate});
    REQUIRE(steiner);
    CHECK(decode(*steiner)->solid == solid);
  }
  CHECK(held[Mode::automatic] == held[Mode::raw]);
  CHECK(held[Mode::walk] == 0);
  // Solids in which both facets of an edge have the vertex of the touch.
  CHECK(held[Mode::polygon] > 0);
}

TEST_CASE("solids whose rings touch inside edges share pages with others") {
  std::vector<validate::Certified> certified;
  for (const TouchingRings& touching : valid_solids()) {
    Inspection inspection = inspect(solid_of(touching.shape, millimetres()));
    REQUIRE(inspection.certified);
    certified.push_back(*std::move(inspection.certified));
  }
  std::vector<const OrientedBoundary*> page;
  for (const validate::Certified& one : certified) page.push_back(&one.solid.boundary());
  const auto bytes = codec::encode_boundaries(page, {});
  REQUIRE(bytes);
  const auto decoded = codec::decode_page(*bytes);
  REQUIRE(decoded);
  REQUIRE(decoded->size() == page.size());
  for (std::size_t i = 0; i < page.size(); ++i) CHECK((*decoded)[i].solid == page[i]->solid());
}

TEST_CASE("formats keep rings that touch inside edges; those without holes get triangles") {
  for (const TouchingRings& touching : touching_rings()) {
    INFO(touching.name);
    const Solid solid = solid_of(touching.shape, millimetres());
    const bool can_be_triangulated = !touching.errors.contains(201);
    for (const Format format : {Format::city_json, Format::wkt, Format::ewkb, Format::obj}) {
      if (format == Format::obj && !can_be_triangulated) continue;
      const Document document = document_of(solid, format);
      REQUIRE(document.features.size() == 1);
      const Solid& read = document.features[0].solids[0].solid;
      const std::set<int> codes = codes_of(inspect(read).report, Severity::error);
      if (format != Format::obj) {
        CHECK(read.ring_count() == solid.ring_count());
        CHECK(read.arrays().ring_vertices.size() == solid.arrays().ring_vertices.size());
        CHECK(codes == touching.errors);
      } else if (touching.errors.empty()) {
        CHECK(codes.empty());
      }
    }
  }
}
