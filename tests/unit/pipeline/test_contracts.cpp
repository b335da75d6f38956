// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests that documents come back as their contract says, through Watertight files and a store.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/text/packed_text.h"
#include "packing/text_dictionary.h"
#include "pipeline/container.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_contracts {
namespace {

using Json = nlohmann::ordered_json;

/// A box with semantics, a texture and a surface of its own, written with white space; the facet
/// whose surface type is "top" is the one with all z = 2500.
const std::string kBox =
    "\xEF\xBB\xBF{ \"type\": \"CityJSON\", \"version\": \"2.0\",\r\n"
    R"( "transform": {"scale":[0.0010,1e-3,0.001],"translate":[100.0,200.0,0.0]},
  "metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/7415","title":"caf\u00e9"},
  "CityObjects": {"b": {"type":"Building","children":["p"],"attributes":{"h":2.50}},
    "p": {"type":"BuildingPart","parents":["b"],"attributes":{"a\/b":1},
      "address":[{"location":{"type":"MultiPoint","lod":"0","boundaries":[8]}}],
      "geometry":[{"type":"MultiSurface","lod":"0","boundaries":[[[9,8,0]]]},
       {"type":"Solid","lod":"2.2",
        "semantics":{"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},{"type":"WallSurface"}],
          "values":[[2,1,2,0,2,2]]},
        "texture":{"t":{"values":[[[[0,2,3,0,1]],[[0,0,1,2,3]],[[null]],[[null]],[[null]],[[null]]]]}},
        "boundaries":[[[[5,4,0,1]],[[7,4,5,6]],[[1,2,6,5]],[[3,2,1,0]],[[2,3,7,6]],[[3,0,4,7]]]]}]}},
  "appearance":{"textures":[{"type":"PNG","image":"a.png"}],"vertices-texture":[[0.0,0.0],[1.0,0.0],[1.0,1.0],[0.0,1.0]]},
  "vertices": [[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,2500],[1000,0,2500],
    [1000,1000,2500],[0,1000,2500],[5,5,5],[6,6,6]]}
)";

/// A solid with a cavity that touches a facet of the exterior shell from within, on a grid of US
/// survey feet in metres: the exact position of its least corner has more than 18 digits.
const std::string kSurveyFeet =
    R"({"type":"CityJSON","version":"2.0","transform":{"scale":[0.00030480060960121926,)"
    R"(0.00030480060960121926,0.00030480060960121926],"translate":[84616.468,447422.3,0]},)"
    R"("CityObjects":{"b":{"type":"Building","geometry":[{"type":"Solid","lod":"2",)"
    R"("boundaries":[[[[0,2,1]],[[0,1,3]],[[1,2,3]],[[2,0,3]]],)"
    R"([[[5,6,7]],[[5,4,6]],[[6,4,7]],[[7,4,5]]]]}]}},)"
    R"("vertices":[[-618218,293707,877197],[-609218,293707,877197],[-618218,302707,877197],)"
    R"([-618218,293707,886197],[-615218,296707,880197],[-617218,294707,878197],)"
    R"([-616218,294707,878197],[-617218,295707,878197]]})";

Document read_kept(const std::string& text, Format format) {
  formats::ReadOptions options;
  options.split_features = false;
  options.keep_text = true;
  auto document = formats::read_document(as_bytes(text), format, options);
  REQUIRE(document);
  return *std::move(document);
}

std::string through_container(const std::string& text, Format format, formats::Contract contract) {
  pipeline::IngestOptions options;
  options.contract = contract;
  auto encoded = pipeline::encode_document(read_kept(text, format), nullptr, options);
  REQUIRE(encoded);
  REQUIRE(encoded->outcome.verdict == Verdict::valid);
  const auto container = pipeline::write_container(encoded->document);
  REQUIRE(container);
  const auto documents = pipeline::decode_container(*container);
  REQUIRE(documents);
  REQUIRE(documents->size() == 1);
  const auto written = formats::write_document(documents->front(), format);
  if (!written) return to_string(written.error());
  return std::string(as_text(*written));
}

/// For each facet of the box, its positions from the smallest on and its surface type.
std::vector<std::string> typed_facets(const Json& model, const Json& geometry) {
  std::vector<std::string> facets;
  const Json& shell = geometry["boundaries"][0];
  for (std::size_t i = 0; i < shell.size(); ++i) {
    Json ring = Json::array();
    for (const Json& vertex : shell[i][0])
      ring.push_back(model["vertices"][vertex.get<std::size_t>()]);
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    const Json& type = geometry["semantics"]["values"][0][i];
    facets.push_back(ring.dump() +
                     geometry["semantics"]["surfaces"][type.get<std::size_t>()].dump());
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

/// The position and the texture vertex of each corner that has one.
std::vector<std::string> textured_corners(const Json& model, const Json& geometry) {
  std::vector<std::string> corners;
  const Json& shell = geometry["boundaries"][0];
  for (std::size_t i = 0; i < shell.size(); ++i) {
    const Json& texture = geometry["texture"]["t"]["values"][0][i][0];
    if (texture.size() == 1) continue;
    for (std::size_t j = 0; j < shell[i][0].size(); ++j) {
      corners.push_back(model["vertices"][shell[i][0][j].get<std::size_t>()].dump() +
                        texture[j + 1].dump());
    }
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

TEST_CASE("contract exact gives the very bytes of a document back") {
  CHECK(through_container(kBox, Format::city_json, formats::Contract::exact) == kBox);
}

TEST_CASE("integers under a long scale are valid and come back under every contract") {
  CHECK(through_container(kSurveyFeet, Format::city_json, formats::Contract::exact) == kSurveyFeet);
  const auto sorted_vertices = [](const std::string& text) {
    auto vertices = Json::parse(text)["vertices"].get<std::vector<Json>>();
    std::sort(vertices.begin(), vertices.end());
    return vertices;
  };
  for (const formats::Contract contract :
       {formats::Contract::lattice, formats::Contract::boundary}) {
    CHECK(sorted_vertices(through_container(kSurveyFeet, Format::city_json, contract)) ==
          sorted_vertices(kSurveyFeet));
  }
  const Document document = read_kept(kSurveyFeet, Format::city_json);
  const pipeline::InspectedFeature inspected =
      pipeline::inspect(document.features.at(0), nullptr, {});
  REQUIRE(inspected.solids.size() == 1);
  const Report& report = inspected.solids[0].inspection.report;
  CHECK(report.verdict == Verdict::valid);
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].code == 805);
  CHECK(report.findings[0].detail.find("the shape is exact") != std::string::npos);
}

TEST_CASE("contract exact gives the very bytes of a sequence back") {
  std::string text = "\x1E" + std::string(samples::kHeader) + " \r\n\n" + samples::feature("a") +
                     "\r\n" + samples::feature("b") + " ";
  text.insert(text.find("\"version\""), "  ");
  CHECK(through_container(text, Format::city_json_seq, formats::Contract::exact) == text);
}

TEST_CASE("a sequence without features comes back") {
  const std::string text = std::string(samples::kHeader) + "\n";
  CHECK(through_container(text, Format::city_json_seq, formats::Contract::exact) == text);
}

TEST_CASE("a store gives a line of a sequence back byte for byte, and keeps it compressed") {
  std::string line = samples::feature("a");
  line.insert(1, "   ");
  samples::MemoryStore store;
  pipeline::IngestOptions options;
  options.collection = "town";
  const std::string text = std::string(samples::kHeader) + "\n" + line + "\n";
  REQUIRE(pipeline::ingest(read_kept(text, Format::city_json_seq), store, nullptr, options));
  const auto stored = store.get("town", "a");
  REQUIRE(stored);
  CHECK(stored->skeleton.bytes.size() < line.size());
  const auto document = pipeline::from_stored(*stored);
  REQUIRE(document);
  const auto written = formats::write_feature(*document, document->features[0]);
  REQUIRE(written);
  CHECK(*written == line);
}

/// A building with two boxes and a solid without a top: the boxes share their lower corners.
const std::string kLevels =
    R"({"type":"CityJSONFeature","id":"a","CityObjects":{"a":{"type":"Building","geometry":[)"
    R"({"type":"Solid","lod":"1.2","boundaries":[)" +
    std::string(samples::kBoxFacets) + R"(]},{"type":"Solid","lod":"1.3","boundaries":[)" +
    std::string(samples::kOpenFacets) +
    R"(]},{"type":"Solid","lod":"2.2","boundaries":[)"
    "[[[0,3,2,1]],[[8,9,10,11]],[[0,1,9,8]],[[1,2,10,9]],[[2,3,11,10]],[[3,0,8,11]]]"
    R"(]}]}},"vertices":)"
    "[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,2500],[1000,0,2500],[1000,1000,2500],"
    "[0,1000,2500],[0,0,2600],[1000,0,2600],[1000,1000,2600],[0,1000,2600]]}";

TEST_CASE("the solids of a feature are stored as one page, and come back as they were") {
  const std::string text = samples::sequence({kLevels});
  auto document = formats::read_document(as_bytes(text), Format::city_json_seq);
  REQUIRE(document);
  pipeline::IngestOptions options;
  options.policy = pipeline::Policy::keep;
  const auto encoded = pipeline::encode_document(*document, nullptr, options);
  REQUIRE(encoded);
  const pipeline::EncodedFeature& before = encoded->document.features.at(0);
  const auto stored = pipeline::pack(before, nullptr);
  REQUIRE(stored);
  REQUIRE_FALSE(stored->page.empty());
  CHECK(stored->page.size() < before.solids[0].blob.size() + before.solids[2].blob.size());
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(stored->solids[i].blob.empty());
    if (i != 1) CHECK(*pipeline::blob_of(*stored, i) == before.solids[i].blob);
  }
  const auto after = pipeline::unpack(*stored);
  REQUIRE(after);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(after->solids[i].measures == before.solids[i].measures);
    CHECK(after->solids[i].report == before.solids[i].report);
  }
  const auto back = pipeline::from_stored(*stored);
  REQUIRE(back);
  const auto written = formats::write_document(*back, Format::city_json_seq);
  REQUIRE(written);
  CHECK(as_text(*written) == text);
  // Files take the page as it is, or encode its solids together with others.
  for (const pipeline::SolidLayout layout :
       {pipeline::SolidLayout::blobs, pipeline::SolidLayout::pages}) {
    pipeline::EncodedDocument file{after->format, after->header, {}, {*after}};
    const auto container = pipeline::write_container(file, {.layout = layout});
    REQUIRE(container);
    const auto documents = pipeline::decode_container(*container);
    REQUIRE(documents);
    CHECK(as_text(*formats::write_document(documents->at(0), Format::city_json_seq)) == text);
  }
  // A page of other solids than the feature's is refused.
  StoredFeature other = *stored;
  other.solids[1].is_proven = true;
  CHECK(pipeline::from_stored(other).error().code == ErrorCode::malformed);
  other = *stored;
  other.page.pop_back();
  CHECK(pipeline::from_stored(other).error().code == ErrorCode::malformed);
}

TEST_CASE("a skeleton that was changed to plain text in the database is refused") {
  auto encoded = pipeline::encode_document(read_kept(kBox, Format::city_json), nullptr, {});
  REQUIRE(encoded);
  const pipeline::EncodedFeature& feature = encoded->document.features.at(0);
  auto stored = pipeline::pack(feature, nullptr);
  REQUIRE(stored);
  const ByteView plain = as_bytes(feature.skeleton);
  stored->skeleton.bytes.assign(plain.begin(), plain.end());
  const auto unpacked = pipeline::unpack(*stored);
  REQUIRE_FALSE(unpacked);
  CHECK(unpacked.error().code == ErrorCode::malformed);
}

TEST_CASE("contract lattice keeps values, and semantics and textures with their facets") {
  const Json before = Json::parse(kBox.substr(3));
  const std::string text = through_container(kBox, Format::city_json, formats::Contract::lattice);
  const Json after = Json::parse(text);
  const Json& part = after["CityObjects"]["p"];
  const Json& old_part = before["CityObjects"]["p"];
  CHECK(typed_facets(after, part["geometry"][1]) == typed_facets(before, old_part["geometry"][1]));
  CHECK(textured_corners(after, part["geometry"][1]) ==
        textured_corners(before, old_part["geometry"][1]));
  CHECK(textured_corners(after, part["geometry"][1]).size() == 8);
  CHECK(after["CityObjects"]["b"] == before["CityObjects"]["b"]);
  CHECK(part["attributes"] == old_part["attributes"]);
  CHECK(after["metadata"] == before["metadata"]);
  const auto vertex = part["address"][0]["location"]["boundaries"][0].get<std::size_t>();
  CHECK(after["vertices"][vertex] == Json({5, 5, 5}));
  const auto corner = part["geometry"][0]["boundaries"][0][0][0].get<std::size_t>();
  CHECK(after["vertices"][corner] == Json({6, 6, 6}));
  CHECK(text.find(": ") == std::string::npos);
  CHECK(text != kBox);
}

TEST_CASE("contract lattice gives one text for solids that differ in order only") {
  const std::string a = samples::sequence({samples::feature("a")});
  const std::string b = samples::sequence({samples::feature(
      "a", "[[[5,6,7,4]],[[3,2,1,0]],[[1,2,6,5]],[[3,0,4,7]],[[2,3,7,6]],[[0,1,5,4]]]")});
  CHECK(through_container(a, Format::city_json_seq, formats::Contract::lattice) ==
        through_container(b, Format::city_json_seq, formats::Contract::lattice));
}

TEST_CASE("contract boundary keeps solids, types and families only") {
  const Json after =
      Json::parse(through_container(kBox, Format::city_json, formats::Contract::boundary));
  CHECK(after["CityObjects"]["b"] == Json({{"type", "Building"}, {"children", {"p"}}}));
  const Json& part = after["CityObjects"]["p"];
  CHECK_FALSE(part.contains("attributes"));
  CHECK(part["geometry"].size() == 1);
  CHECK_FALSE(part["geometry"][0].contains("semantics"));
  CHECK(part["geometry"][0]["boundaries"][0].size() == 6);
  CHECK(after["vertices"].size() == 8);
  CHECK_FALSE(after.contains("appearance"));
  CHECK(after["metadata"].size() == 1);
}

TEST_CASE("a stored document with another hash is an error") {
  auto encoded = pipeline::encode_document(read_kept(kBox, Format::city_json), nullptr, {});
  REQUIRE(encoded);
  pipeline::EncodedFeature& feature = encoded->document.features.at(0);
  const std::size_t place = feature.skeleton.find("BuildingPart");
  REQUIRE(place != std::string::npos);
  feature.skeleton[place] = 'X';
  const auto container = pipeline::write_container(encoded->document);
  REQUIRE(container);
  const auto documents = pipeline::decode_container(*container);
  REQUIRE(documents);
  const auto written = formats::write_document(documents->at(0), Format::city_json);
  REQUIRE_FALSE(written);
  CHECK(written.error().message.find("hash") != std::string::npos);
}

TEST_CASE("a compressed text cannot make more than the limit") {
  const auto bomb = formats::pack_text(std::string(50'000'000, 'a'));
  REQUIRE(bomb);
  CHECK(bomb->bytes.size() < 10'000);
  CHECK(formats::unpack_text(bomb->bytes, 1'000'000).error().code == ErrorCode::limit_exceeded);
  StoredFeature feature;
  feature.format = "city-json";
  const auto stored = packing::pack(std::string(5'000'000, 'a'), nullptr);
  REQUIRE(stored);
  feature.skeleton.bytes = *stored;
  Limits limits;
  limits.bytes = 1'000'000;
  const auto document = pipeline::from_stored(feature, limits);
  REQUIRE_FALSE(document);
  CHECK(document.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE(
    "a compressed text that is cut, changed or followed by more is an error or another text") {
  const std::string text = kBox;
  const auto frame = formats::pack_text(text);
  REQUIRE(frame);
  const Bytes& packed = frame->bytes;
  REQUIRE(formats::unpack_text(packed, 1U << 20U));
  for (std::size_t size = 0; size < packed.size(); ++size) {
    CHECK_FALSE(formats::unpack_text(ByteView(packed).first(size), 1U << 20U));
  }
  Bytes longer = packed;
  longer.push_back(0);
  CHECK_FALSE(formats::unpack_text(longer, 1U << 20U));
  for (std::size_t i = 0; i < packed.size(); ++i) {
    Bytes changed = packed;
    changed[i] ^= 0x55U;
    const auto result = formats::unpack_text(changed, 1U << 20U);
    if (!result) CHECK_FALSE(result.error().message.empty());
  }
}

}  // namespace
}  // namespace watertight::test_contracts
