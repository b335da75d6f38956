// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests Watertight files that are read in ranges, added to and torn.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <set>
#include <string>

#include "pipeline/container.h"
#include "pipeline/file/selection.h"
#include "tests/unit/pipeline/samples.h"

namespace watertight::test_container_ranges {
namespace {

using pipeline::ContainerFile;
using pipeline::ContainerWriter;
using pipeline::Extent;
using pipeline::FilePurpose;
using pipeline::RecordKind;
using pipeline::TornTail;

constexpr int kSide = 40;
constexpr pipeline::ContainerOptions kRanges{.purpose = FilePurpose::ranges};

std::string id_of(int number) { return "house-" + std::to_string(number); }

/// A feature whose box is a metre wide and stands at a place of a grid of 10 m, with a text that
/// does not compress well, so that few features fill a block.
std::string house(int number) {
  std::string vertices = "[";
  const int x = 10000 * (number % kSide);
  const int y = 10000 * (number / kSide);
  for (int corner = 0; corner < 8; ++corner) {
    const int right = corner % 4 == 1 || corner % 4 == 2 ? 1000 : 0;
    const int back = corner % 4 >= 2 ? 1000 : 0;
    if (corner > 0) vertices += ',';
    vertices.append("[").append(std::to_string(x + right)).append(",");
    vertices.append(std::to_string(y + back)).append(",").append(corner < 4 ? "0" : "2500");
    vertices += ']';
  }
  std::string line = samples::feature(id_of(number), samples::kBoxFacets, vertices + "]");
  std::string noise;
  std::uint32_t state = static_cast<std::uint32_t>(number) + 1;
  for (int i = 0; i < 400; ++i) {
    state = state * 1664525U + 1013904223U;
    noise += static_cast<char>('a' + (state >> 24U) % 26U);
  }
  return line.replace(line.find("\"height\":2.50"), 13, "\"noise\":\"" + noise + "\"");
}

pipeline::EncodedDocument encoded(const std::vector<std::string>& lines) {
  formats::ReadOptions read;
  read.keep_text = true;
  auto document =
      formats::read_document(as_bytes(samples::sequence(lines)), Format::city_json_seq, read);
  REQUIRE(document);
  auto result = pipeline::encode_document(*std::move(document), nullptr, {});
  REQUIRE(result);
  REQUIRE(result->outcome.verdict == Verdict::valid);
  return std::move(result->document);
}

/// Houses in another order than that of their places.
std::vector<std::string> town() {
  constexpr int kCount = kSide * kSide;
  constexpr int kStep = 7;  // no divisor of the count
  std::vector<std::string> lines;
  for (int i = 0; i < kCount; ++i) lines.push_back(house(i * kStep % kCount));
  return lines;
}

const Bytes& town_file() {
  static const Bytes file = [] {
    auto written = pipeline::write_container(encoded(town()), kRanges);
    REQUIRE(written);
    return *std::move(written);
  }();
  return file;
}

/// A file that counts what is read of it.
struct Served {
  ByteView bytes;
  std::vector<Extent> requests;
  pipeline::FileBytes file() {
    return {bytes.size(), [this](std::uint64_t offset, std::uint64_t size) -> Result<Bytes> {
              requests.push_back({offset, size});
              const ByteView part = bytes.subspan(offset, size);
              return Bytes(part.begin(), part.end());
            }};
  }
  std::uint64_t total() const {
    std::uint64_t sum = 0;
    for (const Extent& request : requests) sum += request.size;
    return sum;
  }
};

std::vector<std::string> ids_in(const pipeline::Selected& selected) {
  std::vector<std::string> ids;
  for (const Document& document : selected.documents) {
    for (const Feature& feature : document.features) ids.push_back(feature.id);
  }
  return ids;
}

std::string written_text(const Document& document) {
  const auto text = formats::write_document(document, Format::city_json_seq);
  REQUIRE(text);
  return std::string(as_text(*text));
}

/// The file with the features of documents added, and those of some ids deleted.
Bytes changed(const Bytes& file, const std::vector<std::string>& lines,
              const std::vector<std::string>& deleted = {}) {
  auto opened = ContainerFile::open(file, {});
  REQUIRE(opened);
  auto writer = ContainerWriter::append(*opened, kRanges);
  REQUIRE(writer);
  if (!deleted.empty()) {
    const auto blocks = opened->blocks_of(deleted);
    REQUIRE(blocks);
    for (const std::uint64_t number : *blocks) {
      const auto block = opened->block(number);
      REQUIRE(block);
      for (const pipeline::ReadFeature& feature : block->features) {
        if (std::find(deleted.begin(), deleted.end(), feature.encoded.id) == deleted.end())
          continue;
        CHECK(writer->remove({number, feature.ordinal}, feature.encoded.solids.size()));
      }
    }
  }
  if (!lines.empty()) {
    for (const pipeline::EncodedFeature& feature : encoded(lines).features) {
      REQUIRE(writer->add(feature));
    }
  }
  const auto added = std::move(*writer).finish();
  REQUIRE(added);
  Bytes longer = file;
  longer.insert(longer.end(), added->begin(), added->end());
  return longer;
}

}  // namespace

TEST_CASE("a file of one block adds 22 bytes to it, a larger one at most 24") {
  const auto file = pipeline::write_container(encoded({house(1)}));
  REQUIRE(file);
  const auto block = pipeline::read_record(ByteView(*file).subspan(9), 9);
  REQUIRE(block);
  CHECK(block->kind == RecordKind::block);
  CHECK(file->size() - block->payload.size() <= 24);
}

TEST_CASE("a file for ranges gives back its document byte for byte") {
  const auto documents = pipeline::decode_container(town_file());
  REQUIRE(documents);
  REQUIRE(documents->size() == 1);
  CHECK(written_text(documents->front()) == samples::sequence(town()));
}

TEST_CASE("a feature is found by its id in four requests, with its line as it was") {
  Served served{town_file(), {}};
  auto file = ContainerFile::open(served.file(), {});
  REQUIRE(file);
  CHECK(file->has_index());
  CHECK(file->block_count() > 10);
  CHECK(file->commit().features == kSide * kSide);
  CHECK(file->commit().solids == kSide * kSide);
  const auto selected = pipeline::select_ids(*file, {id_of(777)});
  REQUIRE(selected);
  CHECK(selected->missing.empty());
  REQUIRE(selected->documents.size() == 1);
  CHECK(written_text(selected->documents.front()) == samples::sequence({house(777)}));
  CHECK(served.requests.size() <= 4);
  CHECK(served.total() < 64U << 10U);
}

TEST_CASE("an open file is read as often as one likes") {
  Limits limits;
  limits.expanded = 100'000;  // so that few reads claim more than all bytes of the file may
  limits.claimed = 1000;
  const Bytes file = changed(*pipeline::write_container(encoded({house(1), house(2)})), {house(3)});
  Served served{file, {}};
  auto opened = ContainerFile::open(served.file(), limits);
  REQUIRE(opened);
  const store::StoredBox box{{0, 0, -10}, {1000, 1000, 10}};
  for (int i = 0; i < 1000; ++i) {
    REQUIRE(pipeline::select_ids(*opened, {id_of(1 + i % 3)}, limits));
    REQUIRE(pipeline::select_box(*opened, box, limits));
  }
  CHECK(served.total() < 2 * file.size());
}

TEST_CASE("every id is found, and no other") {
  Served served{town_file(), {}};
  auto file = ContainerFile::open(served.file(), {});
  REQUIRE(file);
  std::vector<std::string> ids;
  for (int i = 0; i < kSide * kSide; ++i) ids.push_back(id_of(i));
  ids.emplace_back("palace");
  const auto selected = pipeline::select_ids(*file, ids);
  REQUIRE(selected);
  CHECK(ids_in(*selected).size() == ids.size() - 1);
  CHECK(selected->missing == std::vector<std::string>{"palace"});
}

TEST_CASE("features in a box are found in few requests, by their exact boxes") {
  Served served{town_file(), {}};
  auto file = ContainerFile::open(served.file(), {});
  REQUIRE(file);
  // The world is 100, 200 from the vertices; the box ends where houses 5 and 45 begin.
  const store::StoredBox box{{100, 200, -10}, {150, 215, 10}};
  const auto selected = pipeline::select_box(*file, box);
  REQUIRE(selected);
  std::vector<std::string> expected;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column <= 5; ++column) expected.push_back(id_of(kSide * row + column));
  }
  std::vector<std::string> found = ids_in(*selected);
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  CHECK(found == expected);
  CHECK(served.requests.size() <= 6);
  const store::StoredBox above{{100, 200, 3}, {150, 215, 10}};
  CHECK(pipeline::select_box(*file, above)->documents.empty());
  const store::StoredBox away{{-1000, 200, 0}, {99, 215, 10}};
  CHECK(pipeline::select_box(*file, away)->documents.empty());
}

TEST_CASE("what is added follows the bytes of the file, replaces ids, and is found") {
  const Bytes old = town_file();
  std::string moved = house(3);
  moved.replace(moved.find("noise"), 5, "other");
  const Bytes file = changed(old, {moved, house(2000)}, {id_of(3), id_of(4)});
  CHECK(std::equal(old.begin(), old.end(), file.begin()));
  Served served{file, {}};
  auto opened = ContainerFile::open(served.file(), {});
  REQUIRE(opened);
  CHECK(opened->commit().features == kSide * kSide);
  const auto selected = pipeline::select_ids(*opened, {id_of(3), id_of(4), id_of(2000)});
  REQUIRE(selected);
  CHECK(selected->missing == std::vector<std::string>{id_of(4)});
  REQUIRE(selected->documents.size() == 1);
  CHECK(written_text(selected->documents.front()) == samples::sequence({moved, house(2000)}));
  const auto documents = pipeline::decode_container(file);
  REQUIRE(documents);
  REQUIRE(documents->size() == 1);
  CHECK(documents->front().features.size() == kSide * kSide);
  CHECK(documents->front().features.back().id == id_of(2000));
  // Who opened the file before reads on.
  auto before = ContainerFile::open(ByteView(file).first(old.size()), {});
  REQUIRE(before);
  CHECK(pipeline::select_ids(*before, {id_of(4)})->missing.empty());
}

TEST_CASE("a file without an index gets one when it is added to") {
  const auto one = pipeline::write_container(encoded({house(1), house(2)}));
  REQUIRE(one);
  CHECK_FALSE(ContainerFile::open(*one, {})->has_index());
  Bytes file = *one;
  for (int i = 3; i < 40; ++i) file = changed(file, {house(i)});
  auto opened = ContainerFile::open(file, {});
  REQUIRE(opened);
  CHECK(opened->has_index());
  CHECK(opened->commit().features == 39);
  for (int i = 1; i < 40; ++i) CHECK(pipeline::select_ids(*opened, {id_of(i)})->missing.empty());
  const Bytes less = changed(file, {}, {id_of(1), id_of(39)});
  const auto documents = pipeline::decode_container(less);
  REQUIRE(documents);
  CHECK(documents->front().features.size() == 37);
}

TEST_CASE("an index that has grown much is made anew, without what is deleted") {
  Bytes file =
      changed(*pipeline::write_container(encoded({house(1), house(2)})), {house(3)}, {id_of(1)});
  const std::uint8_t first_bits = ContainerFile::open(file, {})->commit().ids.bits;
  for (int i = 4; i < 80; ++i) file = changed(file, {house(i)});
  auto opened = ContainerFile::open(file, {});
  REQUIRE(opened);
  CHECK(opened->commit().ids.bits > first_bits);
  CHECK(opened->commit().features == 78);
  CHECK(pipeline::select_ids(*opened, {id_of(1)})->missing.size() == 1);
  for (int i = 2; i < 80; ++i) CHECK(pipeline::select_ids(*opened, {id_of(i)})->missing.empty());
  const auto documents = pipeline::decode_container(file);
  REQUIRE(documents);
  CHECK(documents->front().features.size() == 78);
}

TEST_CASE("a whole CityJSON gives its features, and what is added to it is another document") {
  const auto sequence = formats::read_document(as_bytes(samples::sequence({house(1), house(2)})),
                                               Format::city_json_seq, {});
  REQUIRE(sequence);
  const auto model = formats::write_document(*sequence, Format::city_json);
  REQUIRE(model);
  formats::ReadOptions whole;
  whole.split_features = false;
  whole.keep_text = true;
  auto document = formats::read_document(*model, Format::city_json, whole);
  REQUIRE(document);
  auto result = pipeline::encode_document(*std::move(document), nullptr, {});
  REQUIRE(result);
  const auto file = pipeline::write_container(result->document);
  REQUIRE(file);
  auto opened = ContainerFile::open(*file, {});
  REQUIRE(opened);
  const auto selected = pipeline::select_ids(*opened, {id_of(2), "palace"});
  REQUIRE(selected);
  CHECK(ids_in(*selected) == std::vector<std::string>{id_of(2)});
  CHECK(selected->missing == std::vector<std::string>{"palace"});
  const auto documents = pipeline::decode_container(changed(*file, {house(7)}));
  REQUIRE(documents);
  REQUIRE(documents->size() == 2);
  const auto back = formats::write_document(documents->front(), Format::city_json);
  REQUIRE(back);
  CHECK(*back == *model);
}

TEST_CASE("a torn end loses nothing that was committed, and is refused unless asked for") {
  const Bytes old = *pipeline::write_container(encoded({house(1), house(2)}));
  const Bytes file = changed(old, {house(3)});
  for (std::size_t size = old.size(); size <= file.size(); ++size) {
    const ByteView part = ByteView(file).first(size);
    const bool is_whole = size == old.size() || size == file.size();
    CHECK(ContainerFile::open(part, {}).has_value() == is_whole);
    Served served{part, {}};
    auto opened = ContainerFile::open(served.file(), {}, TornTail::leave_out);
    REQUIRE(opened);
    CHECK(opened->torn().has_value() != is_whole);
    CHECK(opened->committed() == (size == file.size() ? file.size() : old.size()));
    const auto documents = pipeline::decode_container(*opened);
    REQUIRE(documents);
    CHECK(documents->front().features.size() == (size == file.size() ? 3 : 2));
  }
  for (std::size_t size = 0; size < old.size(); ++size) {
    CHECK_FALSE(ContainerFile::open(ByteView(old).first(size), {}, TornTail::leave_out));
  }
}

TEST_CASE("a changed byte anywhere in a file with an index is noticed") {
  const Bytes file =
      changed(*pipeline::write_container(encoded({house(1)})), {house(2)}, {id_of(1)});
  for (std::size_t i = 0; i < file.size(); ++i) {
    Bytes damaged = file;
    damaged[i] ^= 0x10U;
    CHECK_FALSE(pipeline::decode_container(damaged));
  }
}

TEST_CASE("an index that lies gives an error with its place") {
  const Bytes& file = town_file();
  auto opened = ContainerFile::open(file, {});
  REQUIRE(opened);
  const pipeline::Commit commit = opened->commit();
  const auto rebuilt = [&](const pipeline::Commit& other, std::vector<Bytes> records = {}) {
    Bytes lying(file.begin(),
                file.begin() + static_cast<std::ptrdiff_t>(opened->commit().documents.end()));
    for (const Bytes& record : records) lying.insert(lying.end(), record.begin(), record.end());
    const Bytes end = pipeline::write_record(RecordKind::commit, pipeline::write_commit(other));
    lying.insert(lying.end(), end.begin(), end.end());
    return lying;
  };
  const auto is_refused = [](const Bytes& bytes, const std::string& id) {
    Served served{bytes, {}};
    auto lying = ContainerFile::open(served.file(), {});
    if (!lying) return lying.error().code == ErrorCode::malformed;
    const auto selected = pipeline::select_ids(*lying, {id});
    return !selected && selected.error().code == ErrorCode::malformed &&
           selected.error().byte_offset.has_value();
  };
  REQUIRE_FALSE(is_refused(rebuilt(commit), id_of(5)));
  pipeline::Commit other = commit;
  std::swap(other.documents, other.block_pages[0].extent);  // records of another kind
  CHECK(is_refused(rebuilt(other), id_of(5)));
  other = commit;
  other.documents.offset = file.size();  // beyond the commit
  CHECK(is_refused(rebuilt(other), id_of(5)));
  other = commit;
  other.block_pages[0].box->max[0] -= 100;  // boxes that are too small
  CHECK(is_refused(rebuilt(other), id_of(kSide - 1)));
  other = commit;
  other.block_pages.push_back(other.block_pages[0]);  // a page twice
  CHECK_FALSE(pipeline::decode_container(rebuilt(other)));
  CHECK(is_refused(rebuilt(other), id_of(5)));  // many such pages would take memory for each
  // Ids that lead to the wrong block.
  const std::uint64_t blocks = opened->block_count();
  auto ids = opened->id_entries();
  REQUIRE(ids);
  for (pipeline::IdEntry& entry : *ids) entry.block = (entry.block + 1) % blocks;
  other = commit;
  other.ids.pages.clear();
  std::vector<Bytes> records;
  std::uint64_t offset = commit.documents.end();
  for (const pipeline::WrittenIdPage& page : pipeline::write_id_pages(*ids)) {
    records.push_back(pipeline::write_record(RecordKind::index, page.payload));
    other.ids.pages.push_back({{offset, records.back().size()}, page.first});
    offset += records.back().size();
  }
  CHECK(is_refused(rebuilt(other, records), id_of(5)));
}

TEST_CASE("changed bytes of index and commit under the right checksum are read or refused") {
  const Bytes file =
      changed(*pipeline::write_container(encoded({house(1)})), {house(2)}, {id_of(1)});
  const pipeline::Walk walk = pipeline::walk_records(file);
  REQUIRE(walk.records.size() > 5);
  for (std::size_t changed_one = 1; changed_one < walk.records.size(); ++changed_one) {
    const std::size_t size = walk.records[changed_one].payload.size();
    for (std::size_t i = 0; i < size; ++i) {
      ByteWriter writer;
      writer.append(pipeline::file_head());
      for (std::size_t record = 0; record < walk.records.size(); ++record) {
        const ByteView payload = walk.records[record].payload;
        Bytes bytes(payload.begin(), payload.end());
        if (record == changed_one) bytes[i] ^= 0x41U;
        writer.append(pipeline::write_record(walk.records[record].kind, bytes));
      }
      Served served{writer.bytes(), {}};
      auto opened = ContainerFile::open(served.file(), {}, TornTail::leave_out);
      if (!opened) continue;
      const auto selected = pipeline::select_ids(*opened, {id_of(2)});
      if (!selected) CHECK_FALSE(selected.error().message.empty());
      const auto documents = pipeline::decode_container(writer.bytes());
      if (!documents) CHECK_FALSE(documents.error().message.empty());
    }
  }
}

TEST_CASE("blocks that are read at once give the document of blocks read in turn") {
  for (const unsigned threads : {2U, 3U, 64U}) {
    auto opened = ContainerFile::open(town_file(), {});
    REQUIRE(opened);
    const auto documents = pipeline::decode_container(*opened, {}, threads);
    REQUIRE(documents);
    CHECK(written_text(documents->front()) == samples::sequence(town()));
  }
}

TEST_CASE("blocks are read at once only from a file that is in memory") {
  // Ranges that are read twice count as more bytes than the file has, but do not stay.
  Served served{town_file(), {}};
  auto file = ContainerFile::open(served.file(), {});
  REQUIRE(file);
  for (int round = 0; round < 3; ++round) {
    for (std::uint64_t i = 0; i < file->block_count(); ++i) REQUIRE(file->block(i));
  }
  REQUIRE(file->bytes_read() > file->size());
  const std::size_t before = served.requests.size();
  file->read_ahead(0, 4);
  CHECK(served.requests.size() == before);
}

TEST_CASE("blocks that are read at once give the first error of blocks read in turn") {
  const pipeline::Walk walk = pipeline::walk_records(town_file());
  for (const std::size_t changed_one : {1U, 4U, 9U}) {
    ByteWriter writer;
    writer.append(pipeline::file_head());
    for (std::size_t record = 0; record < walk.records.size(); ++record) {
      const ByteView payload = walk.records[record].payload;
      Bytes bytes(payload.begin(), payload.end());
      if (record == changed_one || record == changed_one + 2) bytes[bytes.size() / 2] ^= 0x41U;
      writer.append(pipeline::write_record(walk.records[record].kind, bytes));
    }
    const auto error_of = [&writer](unsigned threads) {
      auto opened = ContainerFile::open(writer.bytes(), {});
      if (!opened) return opened.error();
      const auto documents = pipeline::decode_container(*opened, {}, threads);
      return documents ? Error{} : documents.error();
    };
    const Error in_turn = error_of(1);
    CHECK_FALSE(in_turn.message.empty());
    const Error at_once = error_of(4);
    CHECK(at_once.message == in_turn.message);
    CHECK(at_once.byte_offset == in_turn.byte_offset);
  }
}

TEST_CASE("what a copy of a budget took is taken whole or not at all") {
  Limits limits;
  limits.expanded = 1000;
  pipeline::ReadBudget budget(limits);
  REQUIRE(budget.take_text(100));
  const pipeline::ReadBudget start = budget;
  pipeline::ReadBudget first = start;
  pipeline::ReadBudget second = start;
  REQUIRE(first.take_text(500));
  REQUIRE(second.take_text(500));
  CHECK(budget.take_since(start, first));
  CHECK_FALSE(budget.take_since(start, second));
  CHECK(budget.texts_left() == 400);
}

TEST_CASE("ranges that are near each other are read together") {
  using pipeline::joined_ranges;
  CHECK(joined_ranges({}, 4).empty());
  CHECK(joined_ranges({{50'000, 10}, {0, 100}, {100, 50}, {500, 10}}, 4) ==
        std::vector<Extent>{{0, 510}, {50'000, 10}});
  // The smallest gaps are read too, to have few requests, but no more bytes than are wanted.
  CHECK(joined_ranges({{0, 30'000}, {40'000, 30'000}, {100'000, 30'000}}, 2) ==
        std::vector<Extent>{{0, 70'000}, {100'000, 30'000}});
  CHECK(joined_ranges({{0, 10}, {1'000'000, 10}}, 1).size() == 2);
}

TEST_CASE("boxes of blocks are rounded outwards, and an index of blocks is exact else") {
  std::vector<pipeline::BlockEntry> entries;
  std::uint64_t offset = 9;
  for (int i = 0; i < 100; ++i) {
    const double x = 84000.123456789 + i * 17.3;
    const double y = 447000.987654321 - i * i * 0.7;
    pipeline::BlockEntry entry{{offset, 1000U + static_cast<unsigned>(i)}, 5U, {}};
    if (i % 7 != 0) entry.box = pipeline::FlatBox{{x, y}, {x + 0.1 * i, y + 1e-7}};
    entries.push_back(entry);
    offset = entry.extent.end() + (i % 3 == 0 ? 40 : 0);
  }
  pipeline::WrittenBlockPage page = pipeline::write_block_page(entries);
  page.page.extent = {offset, page.payload.size()};
  const auto read = pipeline::read_block_page(page.payload, page.page);
  REQUIRE(read);
  REQUIRE(read->size() == entries.size());
  const double step = (page.page.box->max[0] - page.page.box->min[0]) / 65535;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    CHECK((*read)[i].extent == entries[i].extent);
    CHECK((*read)[i].features == 5);
    REQUIRE((*read)[i].box.has_value() == entries[i].box.has_value());
    if (!entries[i].box) continue;
    CHECK((*read)[i].box->contains(*entries[i].box));
    CHECK(entries[i].box->min[0] - (*read)[i].box->min[0] < 1.01 * step);
  }
  for (std::size_t size = 0; size < page.payload.size(); ++size) {
    CHECK_FALSE(pipeline::read_block_page(ByteView(page.payload).first(size), page.page));
  }
}

TEST_CASE("hashes of ids differ in their first bits when ids differ at their end") {
  std::set<std::uint64_t> hashes;
  for (int i = 0; i < 1000; ++i) hashes.insert(pipeline::cut_hash(pipeline::id_hash(id_of(i)), 24));
  CHECK(hashes.size() > 990);
  CHECK(pipeline::id_hash("") == 0xEFD01F60BA992926U);
  CHECK(pipeline::id_hash("a") == 0x82A2A958A9BECE5BU);
}

}  // namespace watertight::test_container_ranges
