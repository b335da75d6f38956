// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tests pages and page files: every solid comes back, wherever it stands, and bytes that no writer
// wrote are refused.
#include <algorithm>
#include <catch2/catch_test_macros.hpp>

#include "base/checksum.h"
#include "codec/encode_boundary.h"
#include "codec/page/container.h"
#include "codec/page_file.h"
#include "tests/generated/mutated_blobs.h"

namespace watertight {
namespace {

using generated::NamedBoundary;
using Boundaries = std::vector<const OrientedBoundary*>;

/// The solids grouped by their frames, each group in the given order.
std::vector<Boundaries> groups_of(const std::vector<NamedBoundary>& solids) {
  std::vector<Boundaries> groups;
  std::vector<codec::Frame> frames;
  for (const NamedBoundary& solid : solids) {
    const codec::Frame frame = codec::frame_of(solid.boundary.solid(), {});
    const auto known = std::find(frames.begin(), frames.end(), frame);
    if (known == frames.end()) {
      frames.push_back(frame);
      groups.push_back({&solid.boundary});
    } else {
      groups[static_cast<std::size_t>(known - frames.begin())].push_back(&solid.boundary);
    }
  }
  return groups;
}

Bytes blob_of(const OrientedBoundary& boundary, const EncodeOptions& options = {}) {
  auto blob = codec::encode_boundary(boundary, {}, options);
  REQUIRE(blob);
  return *std::move(blob);
}

/// A grid with steps of the given number of millimetres.
Lattice grid_of(std::int64_t millimetres) {
  Lattice lattice;
  lattice.step.fill(GridNumber{millimetres, -3});
  return lattice;
}

OrientedBoundary box_at(double x, const Lattice& lattice) {
  SolidArrays arrays;
  generated::add_box(arrays, {x, 0, 0}, {x + 3, 4, 5});
  return generated::boundary_of(std::move(arrays), lattice, 28992);
}

/// Boxes on two grids in turn; every fifth box has floating point coordinates.
std::vector<OrientedBoundary> interleaved(std::size_t count) {
  generated::Random random(7);
  const Lattice lattices[2] = {grid_of(1), grid_of(3)};
  std::vector<OrientedBoundary> solids;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 5 == 4) {
      solids.push_back(generated::random_doubles(random, 2));
    } else {
      solids.push_back(box_at(static_cast<double>(10 * i), lattices[i % 2]));
    }
  }
  return solids;
}

Bytes page_file_of(const std::vector<OrientedBoundary>& solids, std::size_t page_solids,
                   const EncodeOptions& options = {}) {
  codec::PageFileWriter writer(page_solids, options);
  Bytes file;
  for (const OrientedBoundary& solid : solids) {
    REQUIRE(writer.add_blob(blob_of(solid)));
    const Bytes part = writer.take();
    file.insert(file.end(), part.begin(), part.end());
  }
  const auto rest = std::move(writer).finish();
  REQUIRE(rest);
  file.insert(file.end(), rest->begin(), rest->end());
  return file;
}

codec::PageFileReader opened(ByteView file) {
  auto reader = codec::PageFileReader::open(file);
  REQUIRE(reader);
  return *std::move(reader);
}

/// A page file of any pages with any index and the right checksum.
Bytes forged(const std::vector<Bytes>& pages, const std::vector<std::uint64_t>& index) {
  ByteWriter numbers;
  for (const std::uint64_t number : index) numbers.varint(number);
  ByteWriter writer;
  writer.append(as_bytes("WTPF\x01"));
  for (const Bytes& page : pages) writer.append(page);
  writer.append(numbers.bytes());
  writer.u32(crc32c(numbers.bytes()));
  writer.u32(static_cast<std::uint32_t>(numbers.size()));
  writer.append(as_bytes("WTPF"));
  return std::move(writer).bytes();
}

/// Reads every page and solid that a damaged file gives.
void read_all(ByteView file, const Limits& limits = {}) {
  const auto reader = codec::PageFileReader::open(file, limits);
  if (!reader) {
    REQUIRE_FALSE(reader.error().message.empty());
    return;
  }
  for (std::size_t page = 0; page < reader->page_count(); ++page) {
    const auto solids = reader->page(page);
    if (!solids) REQUIRE_FALSE(solids.error().message.empty());
  }
}

}  // namespace

TEST_CASE("a lattice whose origin takes more than 128 bits in between is refused") {
  codec::PageGrid grid;
  grid.step.fill(GridNumber{(std::int64_t{1} << 62) + 1, 18});
  grid.phase.fill(GridNumber{1, 0});
  REQUIRE(codec::lattice_at(grid, codec::GridPoint{}));
  const auto lattice = codec::lattice_at(grid, codec::GridPoint{0, std::int64_t{1} << 54, 0});
  REQUIRE_FALSE(lattice);
  CHECK(lattice.error().code == ErrorCode::malformed);
}

TEST_CASE("a page gives back each of its solids, in source order or canonical") {
  const auto solids = generated::all(5);
  for (const Boundaries& group : groups_of(solids)) {
    for (const bool keep_order : {true, false}) {
      const auto page = codec::encode_boundaries(group, {}, {.keep_order = keep_order});
      REQUIRE(page);
      const auto decoded = codec::decode_page(*page);
      REQUIRE(decoded);
      REQUIRE(decoded->size() == group.size());
      for (std::size_t i = 0; i < group.size(); ++i) {
        const auto canonical = geometry::canonical_form(*group[i]);
        const Solid& wanted = keep_order ? group[i]->solid() : canonical.boundary.solid();
        CHECK((*decoded)[i].solid == wanted);
      }
    }
  }
}

TEST_CASE("a page holds solids in any one mode") {
  const auto solids = generated::all(6);
  for (const Boundaries& group : groups_of(solids)) {
    for (const Mode mode : {Mode::raw, Mode::bitmap}) {
      const auto page = codec::encode_boundaries(group, {}, {.mode = mode});
      REQUIRE(page);
      const auto decoded = codec::decode_page(*page);
      REQUIRE(decoded);
      for (std::size_t i = 0; i < group.size(); ++i) {
        CHECK((*decoded)[i].solid == group[i]->solid());
        CHECK((*decoded)[i].info.mode == mode);
      }
    }
  }
}

TEST_CASE("a page of similar solids is smaller than their blobs") {
  const Lattice lattice = grid_of(1);
  std::vector<OrientedBoundary> solids;
  Boundaries page;
  std::size_t alone = 0;
  for (int i = 0; i < 64; ++i) solids.push_back(box_at(10.0 * i, lattice));
  for (const OrientedBoundary& solid : solids) {
    page.push_back(&solid);
    alone += blob_of(solid).size();
  }
  const auto bytes = codec::encode_boundaries(page, {});
  REQUIRE(bytes);
  CHECK(2 * bytes->size() < alone);
}

TEST_CASE("a page of few bytes in automatic mode is no larger than in any one mode") {
  const auto solids = generated::all(6);
  for (const Boundaries& group : groups_of(solids)) {
    const auto automatic = codec::encode_boundaries(group, {});
    REQUIRE(automatic);
    if (automatic->size() > 2048) continue;
    for (const Mode mode : {Mode::walk, Mode::polygon, Mode::parallelogram}) {
      const auto page = codec::encode_boundaries(group, {}, {.mode = mode});
      if (page) CHECK(automatic->size() <= page->size());
    }
  }
}

TEST_CASE("an error in a page names the solid and the byte") {
  const OrientedBoundary box = generated::box();
  auto page = codec::encode_boundaries(Boundaries{&box, &box, &box}, {});
  REQUIRE(page);
  // Removes bytes of the stream; the checksum stays.
  page->erase(page->end() - 12, page->end() - 4);
  const auto refused = codec::decode_page(*page);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::malformed);
  CHECK(refused.error().message.find("solid ") != std::string::npos);
  CHECK(refused.error().byte_offset.value_or(0) > 4);
}

TEST_CASE("an error names the solids that cannot share a page") {
  const auto solids = interleaved(5);
  const auto mixed = codec::encode_boundaries(Boundaries{&solids[0], &solids[1]}, {});
  REQUIRE_FALSE(mixed);
  CHECK(mixed.error().code == ErrorCode::invalid_argument);
  CHECK(mixed.error().message.find("grid") != std::string::npos);
  CHECK_FALSE(codec::encode_boundaries(Boundaries{&solids[0], &solids[4]}, {}));
  CHECK_FALSE(codec::encode_boundaries({}, {}));
  CHECK_FALSE(codec::encode_boundaries(Boundaries(codec::kMaxPageSolids + 1, solids.data()), {}));
  CHECK(codec::encode_boundaries(Boundaries(codec::kMaxPageSolids, solids.data()), {}));
}

TEST_CASE("pages and blobs are not taken for each other") {
  const OrientedBoundary box = generated::box();
  const auto page = codec::encode_boundaries(Boundaries{&box}, {});
  REQUIRE(page);
  CHECK_FALSE(decode(*page));
  CHECK_FALSE(codec::decode_page(blob_of(box)));
}

TEST_CASE("every truncated page and every changed byte of one is refused") {
  const auto solids = generated::all(8);
  const auto page =
      codec::encode_boundaries(Boundaries{&solids[0].boundary, &solids[1].boundary}, {});
  REQUIRE(page);
  for (std::size_t size = 0; size < page->size(); ++size) {
    CHECK_FALSE(codec::decode_page(ByteView(*page).first(size)));
  }
  for (std::size_t i = 0; i < page->size(); ++i) {
    Bytes changed = *page;
    changed[i] ^= 0x55U;
    CHECK_FALSE(codec::decode_page(changed));
  }
}

TEST_CASE("the limit of vertices counts for a page as a whole") {
  const auto solids = interleaved(3);
  const auto page = codec::encode_boundaries(Boundaries{&solids[0], &solids[2]}, {});
  REQUIRE(page);
  CHECK(codec::decode_page(*page, Limits{.vertices = 16}));
  CHECK(codec::decode_page(*page, Limits{.vertices = 15}).error().code ==
        ErrorCode::limit_exceeded);
}

TEST_CASE("a page file gives each solid back by its number and by its page") {
  const auto solids = interleaved(23);
  for (const std::size_t page_solids : {1U, 3U, 256U}) {
    const Bytes file = page_file_of(solids, page_solids);
    CHECK(codec::is_page_file(file));
    const codec::PageFileReader reader = opened(file);
    REQUIRE(reader.size() == solids.size());
    CHECK(reader.page_count() == (page_solids == 1 ? 23 : page_solids == 3 ? 9 : 3));
    std::vector<int> seen(solids.size());
    for (std::size_t page = 0; page < reader.page_count(); ++page) {
      const auto members = reader.page(page);
      REQUIRE(members);
      for (const auto& member : *members) {
        ++seen.at(member.number);
        CHECK(member.decoded.solid == solids[member.number].solid());
      }
    }
    CHECK(seen == std::vector<int>(solids.size(), 1));
    for (std::size_t i = 0; i < solids.size(); ++i) {
      const auto decoded = reader.solid(i);
      REQUIRE(decoded);
      CHECK(decoded->solid == solids[i].solid());
    }
    const auto beyond = reader.solid(solids.size());
    REQUIRE_FALSE(beyond);
    CHECK(beyond.error().code == ErrorCode::invalid_argument);
  }
}

TEST_CASE("a page file keeps more grids apart than it has pages open") {
  std::vector<OrientedBoundary> solids;
  for (int i = 0; i < 120; ++i) {
    solids.push_back(box_at(i, grid_of(10 * (i % 40) + 1)));
  }
  const Bytes file = page_file_of(solids, 64);
  const codec::PageFileReader reader = opened(file);
  REQUIRE(reader.size() == solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const auto decoded = reader.solid(i);
    REQUIRE(decoded);
    CHECK(decoded->solid == solids[i].solid());
  }
}

TEST_CASE("a page file keeps the acceptance that a blob states") {
  const OrientedBoundary box = generated::box();
  Acceptance other;
  other.proof = Proof::boundary;
  codec::PageFileWriter writer;
  const auto first = codec::encode_boundary(box, {});
  const auto second = codec::encode_boundary(box, other);
  REQUIRE(first);
  REQUIRE(second);
  REQUIRE(writer.add_blob(*first));
  REQUIRE(writer.add_blob(*second));
  const auto file = std::move(writer).finish();
  REQUIRE(file);
  const codec::PageFileReader reader = opened(*file);
  CHECK(reader.page_count() == 2);
  CHECK(reader.solid(0)->info.acceptance == Acceptance{});
  CHECK(reader.solid(1)->info.acceptance == other);
}

TEST_CASE("page files with no solid and with one solid can be read") {
  const Bytes empty = page_file_of({}, 256);
  const codec::PageFileReader none = opened(empty);
  CHECK(none.size() == 0);
  CHECK(none.page_count() == 0);
  CHECK_FALSE(none.solid(0));
  const auto solids = interleaved(1);
  const Bytes file = page_file_of(solids, 256);
  const codec::PageFileReader one = opened(file);
  REQUIRE(one.size() == 1);
  CHECK(one.solid(0)->solid == solids[0].solid());
}

TEST_CASE("a blob that does not decode is not taken into a page file") {
  codec::PageFileWriter writer;
  Bytes blob = blob_of(generated::box());
  blob.back() ^= 1U;
  CHECK_FALSE(writer.add_blob(blob));
  const auto file = std::move(writer).finish();
  REQUIRE(file);
  CHECK(opened(*file).size() == 0);
}

TEST_CASE("every truncated page file is refused, and no changed byte gives another solid") {
  const auto solids = interleaved(7);
  const Bytes file = page_file_of(solids, 2);
  for (std::size_t size = 0; size < file.size(); ++size) {
    CHECK_FALSE(codec::PageFileReader::open(ByteView(file).first(size)));
  }
  for (std::size_t i = 0; i < file.size(); ++i) {
    Bytes changed = file;
    changed[i] ^= 0x11U;
    const auto reader = codec::PageFileReader::open(changed);
    if (!reader) continue;
    for (std::size_t number = 0; number < solids.size(); ++number) {
      const auto decoded = reader->solid(number);
      if (decoded) CHECK(decoded->solid == solids[number].solid());
    }
  }
  Bytes longer = file;
  longer.push_back(0);
  CHECK_FALSE(codec::PageFileReader::open(longer));
}

TEST_CASE("mutated page files are read or refused") {
  generated::Random random(20261121);
  const std::vector<Bytes> files = {page_file_of(interleaved(7), 2), page_file_of({}, 2),
                                    page_file_of(interleaved(12), 256)};
  for (int i = 0; i < 3000; ++i) read_all(generated::mutated(files, random));
}

TEST_CASE("a page file with a false index is refused before anything is decoded") {
  const OrientedBoundary box = generated::box();
  const auto made = codec::encode_boundaries(Boundaries{&box, &box}, {});
  REQUIRE(made);
  const Bytes page = *made;
  const std::uint64_t size = page.size();
  constexpr std::uint64_t kHuge = ~std::uint64_t{0};
  REQUIRE(codec::PageFileReader::open(forged({page}, {2, 1, size, 2, 0, 0})));
  const std::vector<std::vector<std::uint64_t>> lies = {
      {kHuge, 1, size, 2, 0, 0},                      // more solids than the index has bytes
      {2, kHuge, size, 2, 0, 0},                      // more pages than the index has bytes
      {2, 1, kHuge, 2, 0, 0},                         // a page beyond the file
      {2, 1, size + 1, 2, 0, 0},                      // a page that ends in the index
      {2, 1, size - 1, 2, 0, 0},                      // bytes between the page and the index
      {2, 1, size, kHuge, 0, 0},                      // a page of too many solids
      {2, 1, size, codec::kMaxPageSolids + 1, 0, 0},  // one solid more than a page may have
      {2, 1, size, 2, 0, 1},           // solid number 2, where the numbers are 0 and 1
      {2, 1, size, 2, 0, kHuge},       // a number of a solid that is too large
      {2, 1, size, 2, 0},              // an index that ends early
      {2, 1, size, 2, 0, 0, 0},        // an index that ends late
      {3, 1, size, 2, 0, 0},           // a solid in no page
      {1, 1, size, 2, 0, 0},           // a solid more than the file states
      {2, 2, size, 2, 0, 0, 0, 0},     // a page without solids
      {2, 2, size, 2, 0, 0, 0, 1, 0},  // a solid twice
  };
  for (const auto& lie : lies) {
    const auto reader = codec::PageFileReader::open(forged({page}, lie));
    REQUIRE_FALSE(reader);
    CHECK(reader.error().code == ErrorCode::malformed);
  }
}

TEST_CASE("a page with another number of solids than the index states is refused") {
  const OrientedBoundary box = generated::box();
  const auto page = codec::encode_boundaries(Boundaries{&box, &box}, {});
  REQUIRE(page);
  for (const std::uint64_t count : {1U, 3U}) {
    std::vector<std::uint64_t> index = {count, 1, page->size(), count};
    index.resize(index.size() + count);
    const Bytes file = forged({*page}, index);
    const codec::PageFileReader reader = opened(file);
    const auto solid = reader.solid(0);
    REQUIRE_FALSE(solid);
    CHECK(solid.error().code == ErrorCode::malformed);
    CHECK(solid.error().message.find("index") != std::string::npos);
  }
}

/// The page of the solids of blobs, if they have one.
std::optional<Bytes> page_of(const std::vector<Bytes>& blobs) {
  const std::vector<ByteView> views(blobs.begin(), blobs.end());
  auto page = codec::page_of_blobs(views);
  REQUIRE(page);
  return *std::move(page);
}

TEST_CASE("blobs of one grid share a page, and come back from it") {
  std::vector<Bytes> blobs;
  for (const double x : {0.0, 0.0, 10.0}) blobs.push_back(blob_of(box_at(x, grid_of(1))));
  const auto page = page_of(blobs);
  REQUIRE(page);
  CHECK(page->size() < blobs[0].size() + blobs[1].size() + blobs[2].size());
  const auto decoded = codec::decode_page(*page);
  REQUIRE(decoded);
  REQUIRE(decoded->size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto blob = codec::blob_of((*decoded)[i]);
    REQUIRE(blob);
    CHECK(*blob == blobs[i]);
    const auto in_page = codec::blob_in_page(*page, i);
    REQUIRE(in_page);
    CHECK(*in_page == blobs[i]);
  }
  CHECK(codec::blob_in_page(*page, 3).error().code == ErrorCode::invalid_argument);
  CHECK(codec::blob_in_page(blobs[0], 0).error().code == ErrorCode::malformed);
  // The page goes into a page file as it is, beside others.
  codec::PageFileWriter writer;
  writer.add_page(*page, 3);
  REQUIRE(writer.add_blob(blobs[2]));
  const auto file = std::move(writer).finish();
  REQUIRE(file);
  const auto reader = opened(*file);
  REQUIRE(reader.size() == 4);
  CHECK(reader.solid(1)->solid == (*decoded)[1].solid);
  CHECK(reader.solid(3)->solid == (*decoded)[2].solid);
}

TEST_CASE("blobs that would not come back have no page") {
  const Bytes blob = blob_of(box_at(0, grid_of(1)));
  CHECK_FALSE(page_of({}));
  CHECK_FALSE(page_of({blob}));
  CHECK_FALSE(page_of({blob, blob_of(box_at(0, grid_of(3)))}));
  EncodeOptions raw;
  raw.mode = Mode::raw;
  CHECK_FALSE(page_of({blob, blob_of(box_at(0, grid_of(1)), raw)}));
  CHECK_FALSE(page_of(std::vector<Bytes>(codec::kMaxPageSolids + 1, blob)));
  REQUIRE(page_of(std::vector<Bytes>(codec::kMaxPageSolids, blob)));
  const std::vector<ByteView> damaged{blob, ByteView(blob).first(blob.size() - 1)};
  CHECK_FALSE(codec::page_of_blobs(damaged));
}

TEST_CASE("page files of other versions are unsupported") {
  Bytes file = page_file_of({}, 256);
  file[4] = 2;
  const auto reader = codec::PageFileReader::open(file);
  REQUIRE_FALSE(reader);
  CHECK(reader.error().code == ErrorCode::unsupported);
}

}  // namespace watertight
