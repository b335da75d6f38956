// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests Watertight files: documents come back, solids stand in pages, damaged files are refused.
#include <catch2/catch_test_macros.hpp>
#include <string>

#include "base/checksum.h"
#include "codec/encode_boundary.h"
#include "codec/page_file.h"
#include "columns/columns.h"
#include "delaunay/certificate.h"
#include "pipeline/container.h"
#include "pipeline/export.h"
#include "tests/generated/generated_solids.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_container {
namespace {

pipeline::EncodedDocument encoded(const std::string& text,
                                  const pipeline::IngestOptions& options = {}) {
  formats::ReadOptions read;
  read.keep_text = true;
  auto document = formats::read_document(as_bytes(text), Format::city_json_seq, read);
  REQUIRE(document);
  auto result = pipeline::encode_document(*std::move(document), nullptr, options);
  REQUIRE(result);
  REQUIRE(result->outcome.verdict == Verdict::valid);
  return std::move(result->document);
}

Bytes container_of(const std::string& text) {
  auto container = pipeline::write_container(encoded(text));
  REQUIRE(container);
  return *std::move(container);
}

std::string text_of(const Document& document) {
  const auto text = formats::write_document(document, document.format);
  REQUIRE(text);
  return std::string(as_text(*text));
}

/// A sequence of `count` boxes, each wider than the one before; their ids sort in the order of
/// their numbers.
std::string row_of_boxes(int count) {
  std::vector<std::string> lines;
  for (int i = 0; i < count; ++i) {
    std::string vertices(samples::kBoxVertices);
    const std::string x = std::to_string(1000000 + 2000 * i).substr(0, 7);
    for (std::size_t at = vertices.find("[1000,"); at != std::string::npos;
         at = vertices.find("[1000,", at + 1)) {
      vertices.replace(at + 1, 4, x);
    }
    lines.push_back(
        samples::feature("b" + std::to_string(10000 + i), samples::kBoxFacets, vertices));
  }
  return samples::sequence(lines);
}

/// Puts the features of a document into a store.
void put(samples::MemoryStore& store, const std::string& text) {
  pipeline::IngestOptions options;
  options.collection = "town";
  pipeline::EncodedDocument document = encoded(text, options);
  std::vector<StoredFeature> features;
  for (pipeline::EncodedFeature& feature : document.features) {
    auto packed = pipeline::pack(std::move(feature), nullptr);
    REQUIRE(packed);
    features.push_back(*std::move(packed));
  }
  REQUIRE(store.put(features));
}

/// All bytes of an export, or its first error.
Result<Bytes> export_all(SolidStore& store, pipeline::ExportFormat format,
                         pipeline::Exported* exported = nullptr) {
  auto exporting = pipeline::CollectionExport::start(store, "town", format);
  if (!exporting) return std::move(exporting).error();
  Bytes all;
  for (;;) {
    const auto bytes = exporting->next();
    if (!bytes) return bytes.error();
    if (bytes->empty()) break;
    all.insert(all.end(), bytes->begin(), bytes->end());
  }
  if (exported != nullptr) *exported = exporting->exported();
  return all;
}

/// A file of one record with a payload.
Bytes file_around(pipeline::RecordKind kind, ByteView payload) {
  ByteWriter writer;
  writer.append(pipeline::file_head());
  writer.append(pipeline::write_record(kind, payload));
  writer.append(pipeline::write_record(pipeline::RecordKind::commit, {}));
  return std::move(writer).bytes();
}

/// A file of one block with the given texts, page file and blobs.
/// A file of one block with these tables, pages and blobs. The texts of documents and features, for
/// which the rows ask, are empty.
Bytes file_of(const std::array<std::string, 3>& tables, std::size_t empty_texts, ByteView page_file,
              ByteView blobs) {
  std::vector<columns::Text> texts(empty_texts, {columns::TextKind::json, {}});
  for (const std::string& table : tables) texts.push_back({columns::TextKind::table, table});
  const Bytes packed = columns::pack_texts(texts);
  ByteWriter writer;
  writer.varint(packed.size());
  writer.append(packed);
  writer.varint(page_file.size());
  writer.append(page_file);
  writer.append(blobs);
  return file_around(pipeline::RecordKind::block, writer.bytes());
}

/// The tables of one OFF document with one feature of one solid.
std::array<std::string, 3> tables_of_one(std::uint64_t document, std::uint64_t blob_size) {
  return {"documents\n1\t0\noff\n",
          "features\n" + std::to_string(document) + "\t\t\t0\t0\t0\t0\t1\n",
          "solids\n\t\t0\t0\t" + std::to_string(blob_size) + "\t\n"};
}

/// A file of one OFF document with one feature, whose header, framing and skeleton are empty.
Bytes file_of_one(std::uint64_t document, std::uint64_t blob_size, ByteView page_file,
                  ByteView blobs) {
  return file_of(tables_of_one(document, blob_size), 3, page_file, blobs);
}

}  // namespace

TEST_CASE("a document that becomes too small to be read is refused when it is written") {
  constexpr std::size_t kMany = std::size_t{65} << 20U;
  pipeline::EncodedDocument document{"off", {}, {}, {}};
  pipeline::EncodedFeature& feature = document.features.emplace_back();
  feature.format = "off";
  feature.skeleton.assign(kMany, ' ');
  const auto file = pipeline::write_container(document);
  REQUIRE_FALSE(file);
  CHECK(file.error().code == ErrorCode::limit_exceeded);
  const Limits limits;
  pipeline::WriteBudget budget;
  CHECK(budget.take(1000, limits.expanded + 100'000, 65'536 + 4000));
  CHECK(budget.take(1'000'000, 1000, 1000));
  pipeline::WriteBudget other = budget;
  CHECK_FALSE(budget.take(1000, 100'001, 0));
  CHECK_FALSE(other.take(1000, 0, 4001));
}

TEST_CASE("a file of blobs keeps the bytes of each blob, and returns the same document") {
  const std::string text = row_of_boxes(20);
  const pipeline::EncodedDocument document = encoded(text);
  const auto file = pipeline::write_container(document, {.layout = pipeline::SolidLayout::blobs});
  REQUIRE(file);
  for (const pipeline::EncodedFeature& feature : document.features) {
    const Bytes& blob = feature.solids[0].blob;
    CHECK(std::search(file->begin(), file->end(), blob.begin(), blob.end()) != file->end());
  }
  const auto decoded = pipeline::decode_container(*file);
  REQUIRE(decoded);
  CHECK(text_of(decoded->at(0)) == text);
  CHECK(pipeline::describe_container(*file)->pages == 0);
}

TEST_CASE("a Watertight file returns its document") {
  const std::string text = samples::sequence({samples::feature("a"), samples::feature("b")});
  const Bytes container = container_of(text);
  CHECK(pipeline::is_container(container));
  const auto documents = pipeline::decode_container(container);
  REQUIRE(documents);
  REQUIRE(documents->size() == 1);
  CHECK(text_of(documents->front()) == text);
}

TEST_CASE("a Watertight file has its solids in pages when that is smaller") {
  const std::string text = row_of_boxes(300);
  const pipeline::EncodedDocument document = encoded(text);
  std::size_t blob_bytes = 0;
  for (const pipeline::EncodedFeature& feature : document.features) {
    for (const StoredSolid& solid : feature.solids) blob_bytes += solid.blob.size();
  }
  const Bytes container = container_of(text);
  const auto info = pipeline::describe_container(container);
  REQUIRE(info);
  CHECK(info->features == 300);
  CHECK(info->solids == 300);
  CHECK(info->pages == 2);
  CHECK(2 * info->solid_bytes < blob_bytes);
  const auto documents = pipeline::decode_container(container);
  REQUIRE(documents);
  CHECK(text_of(documents->front()) == text);
  const auto one =
      pipeline::describe_container(container_of(samples::sequence({samples::feature("a")})));
  REQUIRE(one);
  CHECK(one->pages == 0);
  CHECK(one->solids == 1);
}

TEST_CASE("a file of several blocks has its features in order") {
  const auto blob = codec::encode_boundary(generated::box(), {});
  REQUIRE(blob);
  pipeline::EncodedDocument document;
  document.format = "off";
  for (int i = 0; i < 9000; ++i) {
    pipeline::EncodedFeature& feature = document.features.emplace_back();
    feature.format = "off";
    feature.id = std::to_string(i);
    if (i % 100 == 0) feature.solids.emplace_back().blob = *blob;
  }
  const auto file = pipeline::write_container(document);
  REQUIRE(file);
  const auto opened = pipeline::ContainerFile::open(*file, {});
  REQUIRE(opened);
  CHECK(opened->block_count() == 3);
  CHECK(opened->commit().features == 9000);
  CHECK(opened->commit().solids == 90);
  const auto documents = pipeline::decode_container(*file);
  REQUIRE(documents);
  REQUIRE(documents->size() == 1);
  const std::vector<Feature>& features = documents->front().features;
  REQUIRE(features.size() == 9000);
  for (std::size_t i = 0; i < features.size(); ++i) {
    CHECK(features[i].id == std::to_string(i));
    CHECK(features[i].solids.size() == (i % 100 == 0 ? 1 : 0));
  }
}

TEST_CASE(
    "solids in pages have the mode that is asked for, and those with Steiner vertices stay blobs") {
  const auto box = codec::encode_boundary(generated::box(), {}, {.mode = Mode::raw});
  const delaunay::Certificate certificate = generated::schoenhardt_certificate();
  const auto proven = codec::encode_boundary(generated::schoenhardt(), {},
                                             {.mode = Mode::bitmap, .certificate = &certificate});
  REQUIRE(box);
  REQUIRE(proven);
  pipeline::EncodedFeature feature;
  feature.format = "off";
  for (int i = 0; i < 40; ++i) feature.solids.emplace_back().blob = i == 7 ? *proven : *box;
  const auto file =
      pipeline::write_container({"off", {}, {}, {feature}}, {.pages = {.mode = Mode::raw}});
  REQUIRE(file);
  auto opened = pipeline::ContainerFile::open(*file, {});
  REQUIRE(opened);
  REQUIRE(opened->block_count() == 1);
  const auto block = opened->block(0);
  REQUIRE(block);
  CHECK(block->pages == 1);
  const std::vector<Decoded>& solids = block->features.at(0).solids;
  REQUIRE(solids.size() == 40);
  CHECK(solids[0].info.mode == Mode::raw);
  CHECK(solids[0].solid == generated::box().solid());
  CHECK(solids[7].info.steiner_vertices == 1);
  CHECK(solids[7].solid == generated::schoenhardt().solid());
}

TEST_CASE("a file of several documents gives back each") {
  const std::string first = samples::sequence({samples::feature("a"), samples::feature("c")});
  std::string second = samples::sequence({samples::feature("b"), samples::feature("d")});
  second.replace(second.find("100.0"), 5, "900.0");
  const pipeline::EncodedDocument documents[2] = {encoded(first), encoded(second)};
  pipeline::ContainerWriter writer;
  for (std::size_t i = 0; i < 2; ++i) {
    for (const pipeline::EncodedDocument& document : documents)
      REQUIRE(writer.add(document.features[i]));
  }
  const auto file = std::move(writer).finish();
  REQUIRE(file);
  const auto decoded = pipeline::decode_container(*file);
  REQUIRE(decoded);
  REQUIRE(decoded->size() == 2);
  CHECK(text_of((*decoded)[0]) == first);
  CHECK(text_of((*decoded)[1]) == second);
}

TEST_CASE("the features of a document hold one copy of its header") {
  const pipeline::EncodedDocument document =
      encoded(samples::sequence({samples::feature("a"), samples::feature("b")}));
  REQUIRE(document.features.size() == 2);
  CHECK(&document.features[0].header.str() == &document.features[1].header.str());
}

TEST_CASE("documents that differ in their line ends only count as one") {
  const std::string plain = samples::sequence({samples::feature("a"), samples::feature("b")});
  std::string other;
  for (const char c : plain) other += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const pipeline::EncodedDocument one = encoded(plain);
  const pipeline::EncodedDocument two = encoded(other);
  CHECK(one.header == two.header);
  const auto decoded = pipeline::decode_container(container_of(other));
  REQUIRE(decoded);
  CHECK(text_of(decoded->front()) == other);
}

TEST_CASE("features of several documents are no document") {
  pipeline::EncodedDocument document = encoded(samples::sequence({samples::feature("a")}));
  document.header = document.header.str() + " ";
  CHECK(pipeline::write_container(document).error().code == ErrorCode::invalid_argument);
}

TEST_CASE("the Watertight file reader rejects every prefix and every changed byte") {
  const Bytes container = container_of(row_of_boxes(4));
  for (std::size_t size = 0; size < container.size(); ++size) {
    CHECK_FALSE(pipeline::decode_container(ByteView(container).first(size)));
  }
  for (std::size_t i = 0; i < container.size(); ++i) {
    Bytes changed = container;
    changed[i] ^= 0x41U;
    CHECK_FALSE(pipeline::decode_container(changed));
  }
}

TEST_CASE("changed bytes under the right checksum are read or refused") {
  const Bytes container = container_of(row_of_boxes(40));
  const auto block = pipeline::read_record(ByteView(container).subspan(9), 9);
  REQUIRE(block);
  for (std::size_t i = 0; i < block->payload.size(); ++i) {
    Bytes changed(block->payload.begin(), block->payload.end());
    changed[i] ^= 0x41U;
    const auto documents =
        pipeline::decode_container(file_around(pipeline::RecordKind::block, changed));
    if (!documents) CHECK_FALSE(documents.error().message.empty());
  }
}

TEST_CASE("texts, pages and blobs that do not fit each other are malformed") {
  const pipeline::EncodedDocument document = encoded(samples::sequence({samples::feature("a")}));
  const Bytes& blob = document.features[0].solids[0].blob;
  codec::PageFileWriter writer;
  REQUIRE(writer.add_blob(blob));
  const auto pages = std::move(writer).finish();
  REQUIRE(pages);
  REQUIRE(pipeline::decode_container(file_of_one(0, blob.size(), {}, blob)));
  REQUIRE(pipeline::decode_container(file_of_one(0, 0, *pages, {})));
  REQUIRE(pipeline::decode_container(file_of_one(0, 2, *pages, {})));
  const Bytes wrong[] = {
      file_of_one(1, blob.size(), {}, blob),      // a feature of no document
      file_of_one(0, blob.size() + 1, {}, blob),  // a blob beyond the file
      file_of_one(0, blob.size() - 1, {}, blob),  // a cut blob
      file_of_one(0, ~std::uint64_t{0}, {}, blob),
      file_of_one(0, 0, {}, {}),  // a solid in a page that is not there
      file_of_one(0, 2, {}, {}),
      // A solid of the page file in no feature.
      file_of_one(0, blob.size(), *pages, blob),
      file_of_one(0, 0, blob, {}),  // a blob in the place of the page file
  };
  for (const Bytes& bytes : wrong) {
    const auto documents = pipeline::decode_container(bytes);
    REQUIRE_FALSE(documents);
    CHECK(documents.error().code == ErrorCode::malformed);
  }
}

TEST_CASE("tables that do not fit their texts are malformed") {
  const auto tables = tables_of_one(0, 1);
  REQUIRE(pipeline::decode_container(
      file_of({tables[0], "features\n0\t\t\t0\t0\t0\t0\t0\n", "solids\n"}, 3, {}, {})));
  const std::array<std::string, 3> wrong[] = {
      {tables[0], "features\n", "solids\n"},                        // a text of no feature
      {tables[0], "features\n0\t\t\t0\t0\t1\t0\t0\n", "solids\n"},  // a text that is missing
      {tables[0], "features\n0\t\t\t0\t0\t0\t0\t0\n", "solids\n0"},
      {tables[0], "features\n0\t\t\t0\t0\t0\t0\t1\n", "solids\n"},
      {tables[0], "features\n0\t\t\tx\t0\t0\t0\t0\n", "solids\n"},
      {tables[0], "features\n0\t\t\t4294967296\t0\t0\t0\t0\n", "solids\n"},
      {tables[0], "features\n0\t\t\t0\t0\t0\t0\n", "solids\n"},
      {tables[0], "feature\n0\t\t\t0\t0\t0\t0\t0\n", "solids\n"},
      {"documents\n2\t0\noff\n", "features\n", "solids\n"},
      {"documents\n1\t0\n", "features\n", "solids\n"},
  };
  for (const auto& changed : wrong) {
    CAPTURE(changed);
    const auto documents = pipeline::decode_container(file_of(changed, 3, {}, {}));
    REQUIRE_FALSE(documents);
    CHECK(documents.error().code == ErrorCode::malformed);
  }
}

TEST_CASE("texts that name more features than their file has bytes for are refused") {
  std::array<std::string, 3> tables = tables_of_one(0, 1);
  tables[1] = "features\n";
  tables[2] = "solids\n";
  for (int i = 0; i < 200'000; ++i) tables[1] += "0\t\t\t0\t0\t0\t0\t0\n";
  const Bytes bomb = file_of(tables, 200'002, {}, {});
  CHECK(bomb.size() < 3000);
  const auto documents = pipeline::decode_container(bomb);
  REQUIRE_FALSE(documents);
  CHECK(documents.error().code == ErrorCode::malformed);
}

TEST_CASE("texts expand to a hundred times the bytes of their file, and a constant besides") {
  const std::string long_text(2'000'000, 'a');
  std::string line = samples::feature("b");
  line.replace(line.find("\"height\":2.50"), 13, "\"note\":\"" + long_text + '"');
  const Bytes container = container_of(samples::sequence({line}));
  REQUIRE(container.size() < 5000);
  CHECK(pipeline::decode_container(container));
  Limits limits;
  limits.expanded = 1'000'000;
  const auto documents = pipeline::decode_container(container, limits);
  REQUIRE_FALSE(documents);
  CHECK(documents.error().code == ErrorCode::limit_exceeded);
  limits.expanded = 2'500'000;
  CHECK(pipeline::decode_container(container, limits));
  limits.feature_bytes = 1'000'000;
  const auto feature = pipeline::decode_container(container, limits);
  REQUIRE_FALSE(feature);
  CHECK(feature.error().code == ErrorCode::limit_exceeded);
  CHECK(feature.error().message.find("'b'") != std::string::npos);
}

TEST_CASE(
    "the solids of a file have eight vertices for each of its bytes, and a constant besides") {
  const Bytes container = container_of(row_of_boxes(1000));
  REQUIRE(container.size() < 20'000);
  Limits limits;
  limits.claimed = 0;
  CHECK(pipeline::decode_container(container, limits));
  limits.vertices = 7;
  const auto documents = pipeline::decode_container(container, limits);
  REQUIRE_FALSE(documents);
  CHECK(documents.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("an export of a collection is a Watertight file of its documents") {
  samples::MemoryStore store;
  const std::string row = row_of_boxes(600);
  put(store, row);
  std::string other = samples::sequence({samples::feature("zz")});
  other.replace(other.find("100.0"), 5, "900.0");
  put(store, other);
  pipeline::Exported exported;
  const auto bytes = export_all(store, pipeline::ExportFormat::container, &exported);
  REQUIRE(bytes);
  CHECK(exported.features == 601);
  CHECK(exported.solids == 601);
  const auto documents = pipeline::decode_container(*bytes);
  REQUIRE(documents);
  REQUIRE(documents->size() == 2);
  CHECK(text_of((*documents)[0]) == row);
  CHECK(text_of((*documents)[1]) == other);
}

TEST_CASE("an export as a sequence has the header and each feature's line") {
  samples::MemoryStore store;
  const std::string row = row_of_boxes(510);
  put(store, row);
  const auto bytes = export_all(store, pipeline::ExportFormat::sequence);
  REQUIRE(bytes);
  CHECK(as_text(*bytes) == row);
  auto begun = pipeline::CollectionExport::start(store, "town", pipeline::ExportFormat::sequence);
  REQUIRE(begun);
  std::string other = samples::sequence({samples::feature("zz")});
  other.replace(other.find("100.0"), 5, "0.12345678901");
  put(store, other);
  const auto mixed = export_all(store, pipeline::ExportFormat::sequence);
  REQUIRE_FALSE(mixed);
  CHECK(mixed.error().code == ErrorCode::unsupported);
  CHECK(mixed.error().message.find("different headers") != std::string::npos);
  // A feature that came after the start is refused when the export reaches it.
  Result<Bytes> late = begun->next();
  while (late && !begun->is_at_end()) late = begun->next();
  REQUIRE_FALSE(late);
  CHECK(late.error().code == ErrorCode::unsupported);
  CHECK(late.error().message.find("'zz'") != std::string::npos);
}

TEST_CASE("an export ends with the first error, of the store or of a blob") {
  samples::MemoryStore store;
  CHECK(export_all(store, pipeline::ExportFormat::container).error().code == ErrorCode::not_found);
  put(store, row_of_boxes(3));
  auto feature = store.get("town", "b10001");
  REQUIRE(feature);
  REQUIRE(store.remove("town", "b10000"));
  feature->solids[0].blob.back() ^= 1U;
  REQUIRE(store.put({&*feature, 1}));
  CHECK(export_all(store, pipeline::ExportFormat::container).error().code == ErrorCode::malformed);
  const auto sequence = export_all(store, pipeline::ExportFormat::sequence);
  REQUIRE_FALSE(sequence);
  CHECK(sequence.error().message.find("'b10001'") != std::string::npos);
  for (const char* id : {"b10001", "b10002"}) REQUIRE(store.remove("town", id));
  for (const pipeline::ExportFormat format :
       {pipeline::ExportFormat::container, pipeline::ExportFormat::sequence}) {
    const auto empty = export_all(store, format);
    REQUIRE_FALSE(empty);
    CHECK(empty.error().code == ErrorCode::not_found);
    CHECK(empty.error().message == "collection 'town' has no features");
  }
  store.is_away = true;
  CHECK(export_all(store, pipeline::ExportFormat::container).error().code ==
        ErrorCode::unavailable);
}

/// A document of GML with the boxes from the origins to the corners given.
std::string boxes_of(const std::vector<std::array<std::string, 6>>& boxes) {
  std::string text = "<CityModel xmlns:g='http://www.opengis.net/gml'>";
  for (const auto& [x, y, z, u, v, w] : boxes) {
    text += "<cityObjectMember><Building><lod1Solid><g:Solid><g:exterior><g:CompositeSurface>";
    const std::array<std::array<std::string, 3>, 8> corners{
        {{x, y, z}, {u, y, z}, {u, v, z}, {x, v, z}, {x, y, w}, {u, y, w}, {u, v, w}, {x, v, w}}};
    constexpr std::array<std::array<std::size_t, 4>, 6> kFacets{
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
    for (const auto& facet : kFacets) {
      text += "<g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList>";
      for (const std::size_t i : {facet[0], facet[1], facet[2], facet[3], facet[0]}) {
        for (const std::string& number : corners[i]) text.append(number).append(" ");
      }
      text += "</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>";
    }
    text +=
        "</g:CompositeSurface></g:exterior></g:Solid></lod1Solid></Building></cityObjectMember>";
  }
  return text + "</CityModel>\n";
}

TEST_CASE("solids with a lattice of their own each share a page, and come back on their lattices") {
  // Decimals of as many digits as their doubles need, and decimals of metres and centimetres.
  const std::vector<std::array<std::string, 6>> boxes[] = {
      {{"35.75599827822895", "139.55416272190755", "55.03099822998047", "35.75609736082363",
        "139.55424111138112", "58.659998178482056"},
       {"35.756001110627984", "139.55076174985976", "53.80099868774414", "35.756077221991816",
        "139.55081508339526", "59.839998722076416"},
       {"35.7583164615552", "139.5529939890944", "52.25", "35.758330697791", "139.55303528672877",
        "55.5"}},
      {{"1000", "2000", "0", "1010", "2010", "10"},
       {"1020.5", "2000.25", "0.5", "1030", "2010", "10"},
       {"1040.125", "2000.001", "0", "1050", "2010", "10.5"}}};
  for (const auto& given : boxes) {
    const std::string text = boxes_of(given);
    formats::ReadOptions read;
    read.keep_text = true;
    read.split_features = false;
    const auto document = formats::read_document(as_bytes(text), Format::gml, read);
    REQUIRE(document);
    const auto result = pipeline::encode_document(*document, nullptr, {});
    REQUIRE(result);
    REQUIRE(result->outcome.verdict == Verdict::valid);
    const auto container = pipeline::write_container(result->document);
    REQUIRE(container);
    const auto info = pipeline::describe_container(*container);
    REQUIRE(info);
    CHECK(info->pages == 1);
    const auto documents = pipeline::decode_container(*container);
    REQUIRE(documents);
    CHECK(text_of(documents->front()) == text);
    for (std::size_t i = 0; i < given.size(); ++i) {
      const Solid& before = document->features[i].solids[0].solid;
      const Solid& after = documents->front().features[i].solids[0].solid;
      CHECK(after.lattice() == before.lattice());
      CHECK(after.arrays() == before.arrays());
    }
  }
}

TEST_CASE("a GML document of several features comes back from its file byte for byte") {
  const auto polygon = [](const std::string& positions) {
    return "<g:surfaceMember><g:Polygon><g:exterior><g:LinearRing><g:posList>" + positions +
           "</g:posList></g:LinearRing></g:exterior></g:Polygon></g:surfaceMember>";
  };
  std::string text = "<!-- two -->\r\n<CityModel xmlns:g='http://www.opengis.net/gml'>";
  for (const std::string x : {"1.50", "2.5e0"}) {
    text +=
        "<cityObjectMember><Building>\n<lod1Solid><g:Solid><g:exterior><g:CompositeSurface>" +
        polygon("0 0 0 0 3 0 " + x + " 0 0 0 0 0") + polygon("0 0 0 " + x + " 0 0 0 0 9.25 0 0 0") +
        polygon(x + " 0 0 0 3 0 0 0 9.25 " + x + " 0 0") + polygon("0 3 0 0 0 0 0 0 9.25 0 3 0") +
        "</g:CompositeSurface></g:exterior></g:Solid></lod1Solid></Building></cityObjectMember>";
  }
  text += "</CityModel>\n";
  formats::ReadOptions read;
  read.keep_text = true;
  read.split_features = false;
  auto document = formats::read_document(as_bytes(text), Format::gml, read);
  REQUIRE(document);
  REQUIRE(document->features.size() == 2);
  auto result = pipeline::encode_document(*std::move(document), nullptr, {});
  REQUIRE(result);
  REQUIRE(result->outcome.verdict == Verdict::valid);
  const auto container = pipeline::write_container(result->document);
  REQUIRE(container);
  const auto documents = pipeline::decode_container(*container);
  REQUIRE(documents);
  CHECK(text_of(documents->front()) == text);
  CHECK(as_text(documents->front().framing).find("0 9.25") == std::string_view::npos);
}

}  // namespace watertight::test_container
