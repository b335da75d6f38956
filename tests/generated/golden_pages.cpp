// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/generated/golden_pages.h"

#include <algorithm>
#include <array>
#include <bit>

#include "base/checksum.h"
#include "codec/encode_boundary.h"
#include "codec/page/container.h"
#include "codec/page_file.h"
#include "codec/sections/coordinates.h"
#include "codec/sections/facet_listing.h"
#include "geometry/canonical_form.h"
#include "tests/generated/generated_solids.h"

namespace watertight::generated {
namespace {

constexpr std::size_t kFilePageSolids = 3;

/// A house of a row: it shares walls with its neighbours, and its ridge runs across the row.
OrientedBoundary house(double x, double eaves, double ridge) {
  constexpr double kWidth = 6000;
  constexpr double kDepth = 9000;
  SolidArrays arrays;
  for (const double z : {0.0, eaves}) {
    arrays.vertices.push_back({x, 0, z});
    arrays.vertices.push_back({x + kWidth, 0, z});
    arrays.vertices.push_back({x + kWidth, kDepth, z});
    arrays.vertices.push_back({x, kDepth, z});
  }
  arrays.vertices.push_back({x, kDepth / 2, ridge});
  arrays.vertices.push_back({x + kWidth, kDepth / 2, ridge});
  for (const std::vector<Index>& ring : std::vector<std::vector<Index>>{{0, 3, 2, 1},
                                                                        {0, 1, 5, 4},
                                                                        {1, 2, 6, 9, 5},
                                                                        {2, 3, 7, 6},
                                                                        {3, 0, 4, 8, 7},
                                                                        {4, 5, 9, 8},
                                                                        {6, 7, 8, 9}}) {
    add_facet(arrays, {ring});
  }
  arrays.end_shell();
  return boundary_of(std::move(arrays));
}

OrientedBoundary box_at(double x, const Lattice& lattice) {
  SolidArrays arrays;
  add_box(arrays, {x, 0, 0}, {x + 3, 4, 5});
  return boundary_of(std::move(arrays), lattice, 28992);
}

std::vector<OrientedBoundary> row() {
  std::vector<OrientedBoundary> houses;
  for (int i = 0; i < 7; ++i) houses.push_back(house(6000 * i, 5400, 8100 + 50 * (i / 3)));
  Random random(3);
  houses[4] = shuffled(houses[4], random);
  houses.push_back(box_with_cavities(2));
  houses.push_back(pierced_block(2));
  return houses;
}

/// Solids on two grids in turn, and solids of floating point numbers.
std::vector<OrientedBoundary> interleaved() {
  Lattice fine;
  fine.step.fill(GridNumber{1, -3});
  Lattice coarse = fine;
  coarse.step = {GridNumber{3, -3}, GridNumber{1, -2}, GridNumber{5, 0}};
  coarse.origin[0] = GridNumber{1, -4};
  Random random(7);
  std::vector<OrientedBoundary> solids;
  for (int i = 0; i < 5; ++i) {
    solids.push_back(box_at(10 * i, fine));
    solids.push_back(box_at(10 * i, coarse));
  }
  solids.push_back(random_doubles(random, 2));
  return solids;
}

Bytes appended(Bytes bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
  return bytes;
}

Result<Bytes> page_file(const GoldenPage& golden) {
  codec::PageFileWriter writer(kFilePageSolids,
                               {.mode = golden.modes.front(), .models = golden.models});
  Bytes file;
  for (const OrientedBoundary& solid : golden.solids) {
    const auto blob = codec::encode_boundary(solid, {});
    if (!blob) return blob.error();
    if (auto status = writer.add_blob(*blob); !status) return status.error();
    file = appended(std::move(file), writer.take());
  }
  auto rest = std::move(writer).finish();
  if (!rest) return rest;
  return appended(std::move(file), *rest);
}

/// Writes streams that no encoder writes; addresses families by their numbers in docs/format.md.
class Forger {
 public:
  Forger() : models_(codec::neutral_priors()) {}

  Forger& frame(LatticeKind kind = LatticeKind::decimal) {
    codec::Frame frame;
    frame.grid.kind = kind;
    frame.grid.step.fill(GridNumber{1, kind == LatticeKind::float64 ? 0 : -3});
    if (!codec::code_frame(stream_, models_[0], frame)) stream_.fail();
    return *this;
  }
  Forger& decide(std::uint32_t family, std::uint32_t context, bool value) {
    models_[0].code(stream_, family, 0, std::array{context}, value);
    return *this;
  }
  Forger& number(std::uint32_t number, std::uint64_t value) {
    models_[0].code_number(stream_, number, 0, std::array{0U}, value);
    return *this;
  }
  Forger& difference(std::uint32_t number, std::uint32_t context, std::int64_t value) {
    models_[0].code_signed(stream_, number, 0, std::array{context}, value, 63);
    return *this;
  }
  Forger& mode(unsigned mode) {
    std::uint32_t node = 1;
    for (const unsigned bit : {2U, 1U, 0U}) {
      const bool one = ((mode >> bit) & 1U) != 0;
      decide(5, 8 * 7 + node, one);
      node = 2 * node + (one ? 1 : 0);
    }
    return *this;
  }
  Forger& section(const Bytes& bytes) {
    number(5, bytes.size());
    for (const std::uint8_t byte : bytes) stream_.code_bits(byte, 8);
    return *this;
  }
  Forger& plain(std::uint64_t value, int bits) {
    stream_.code_bits(value, bits);
    return *this;
  }
  Forger& origin_zero() {
    for (std::uint32_t axis = 0; axis < 3; ++axis) difference(4, axis, 0);
    return *this;
  }
  /// Writes a solid in mode walk up to its number of columns.
  Forger& columns(std::uint64_t count) {
    codec::ModelBank& bank = models_[3];
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      bank.code_signed(stream_, 0, 0, std::array{2 * axis + 1}, 0, 54);
    }
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      bank.code_number(stream_, 1, 0, std::array{axis, 31 * axis}, 0, 5);
    }
    bank.code_number(stream_, 1, 0, std::array{3U, 93U}, count - 1, 40);
    return *this;
  }
  /// The stream as a blob with a checksum of 0.
  Bytes blob() {
    ByteWriter writer;
    writer.append(as_bytes("WT"));
    writer.u8(1);
    writer.u8(0);
    writer.append(std::move(stream_).finish());
    for (int i = 0; i < 3; ++i) writer.u8(0);
    return std::move(writer).bytes();
  }

 private:
  codec::EntropyStream stream_ = codec::EntropyStream::writer();
  std::array<codec::ModelBank, codec::kModelParts> models_;
};

Bytes with(Bytes bytes, std::size_t place, std::uint8_t value) {
  bytes[place] = value;
  return bytes;
}

/// Appends changed copies of the golden box with neutral priors.
void refuse_damaged(std::vector<Refused>& all) {
  const Bytes box =
      codec::encode_boundary(generated::box(), {}, {.mode = Mode::polygon, .models = 0}).value();
  const std::size_t stream_end = box.size() - 3;
  Bytes shorter = box;
  shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(stream_end) - 1);
  Bytes longer = box;
  longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(stream_end), std::uint8_t{0});
  const auto last = static_cast<std::uint8_t>(box.back() ^ 1U);
  const auto bad = ErrorCode::malformed;
  all.push_back({"nothing", "blob", bad, {}});
  all.push_back({"another magic", "blob", bad, with(box, 0, 'w')});
  all.push_back({"version 0", "blob", ErrorCode::unsupported, with(box, 2, 0)});
  all.push_back({"version 2", "blob", ErrorCode::unsupported, with(box, 2, 2)});
  all.push_back({"a page for a blob", "blob", bad, with(box, 2, 0x81)});
  all.push_back({"a blob for a page", "page", bad, box});
  all.push_back({"model set 255", "blob", ErrorCode::unsupported, with(box, 3, 255)});
  all.push_back({"no stream", "blob", bad, {'W', 'T', 1, 0, 0, 0}});
  all.push_back({"a stream without its last byte", "blob", bad, shorter});
  all.push_back({"a stream with a byte more", "blob", bad, longer});
  all.push_back({"another checksum", "blob", bad, with(box, box.size() - 1, last)});
}

void refuse_frames(std::vector<Refused>& all) {
  const auto bad = ErrorCode::malformed;
  const auto add = [&](const char* name, ErrorCode error, Forger&& forger) {
    all.push_back({name, "blob", error, forger.blob()});
  };
  Forger stated;
  stated.decide(0, 0, false);
  for (const double value : {0.01, 20.0, 0.0}) {
    stated.plain(std::bit_cast<std::uint64_t>(value), 64);
  }
  add("the implied tolerances, stated", bad, std::move(stated));
  const auto begun = [] {
    Forger forger;
    forger.decide(0, 0, true).decide(1, 0, false).number(0, 1).number(1, 0);
    return forger;
  };
  add("lattice kind 3", bad, std::move(begun().decide(2, 0, true).decide(2, 2, true)));
  Forger step = begun();
  step.decide(2, 0, false).decide(2, 1, false).decide(3, 0, true).difference(2, 0, -1);
  step.difference(3, 0, -3).decide(4, 0, true).decide(4, 0, true).decide(4, 0, true);
  add("a step below 0", bad, std::move(step.mode(0)));
  add("mode 4", ErrorCode::unsupported, std::move(Forger().frame().mode(4)));
  add("mode 7", ErrorCode::unsupported, std::move(Forger().frame().mode(7)));
  add("mode walk on doubles", bad, std::move(Forger().frame(LatticeKind::float64).mode(2)));
  add("a flag of mode bitmap", bad, std::move(Forger().frame().mode(1).plain(128, 8)));
  add("columns beyond the limit", ErrorCode::limit_exceeded,
      std::move(Forger().frame().mode(2).columns(std::uint64_t{1} << 39)));
}

/// A blob of the box in mode raw with the given section of facets.
Bytes raw_box(const Bytes& facets, bool with_order = false) {
  const geometry::CanonicalSolid box = geometry::canonical_form(generated::box());
  Forger forger;
  forger.frame().mode(0).section(codec::write_vertices(box.boundary.solid().vertices()));
  forger.section(facets).origin_zero().decide(7, 0, with_order);
  return forger.blob();
}

void refuse_solids(std::vector<Refused>& all) {
  const geometry::CanonicalSolid box = geometry::canonical_form(generated::box());
  const SolidArrays& arrays = box.boundary.solid().arrays();
  SolidArrays open = arrays;
  open.ring_vertices.resize(open.ring_vertices.size() - 4);
  open.ring_offsets.pop_back();
  open.facet_offsets.pop_back();
  --open.shell_offsets.back();
  SolidArrays turned = arrays;
  std::rotate(turned.ring_vertices.begin(), turned.ring_vertices.begin() + 1,
              turned.ring_vertices.begin() + 4);
  ByteWriter many;
  many.u8(0);
  many.varint(1U << 30);
  const auto add = [&](const char* name, ErrorCode error, const Bytes& bytes) {
    all.push_back({name, "blob", error, bytes});
  };
  add("an open box", ErrorCode::malformed, raw_box(codec::write_facet_listing(open)));
  add("a ring that starts elsewhere", ErrorCode::malformed,
      raw_box(codec::write_facet_listing(turned)));
  add("a facet section with a byte more", ErrorCode::malformed,
      raw_box(appended(codec::write_facet_listing(arrays), {0})));
  Forger beyond;
  beyond.frame().mode(0).section(many.bytes()).section({}).origin_zero();
  add("raw vertices beyond the limit", ErrorCode::limit_exceeded, beyond.blob());
}

/// A page file with one page and any index; the checksum of the index is right.
Bytes forged_file(const Bytes& page, const std::vector<std::uint64_t>& index) {
  ByteWriter numbers;
  for (const std::uint64_t number : index) numbers.varint(number);
  ByteWriter writer;
  writer.append(as_bytes("WTPF\x01"));
  writer.append(page);
  writer.append(numbers.bytes());
  writer.u32(crc32c(numbers.bytes()));
  writer.u32(static_cast<std::uint32_t>(numbers.size()));
  writer.append(as_bytes("WTPF"));
  return std::move(writer).bytes();
}

void refuse_pages(std::vector<Refused>& all) {
  const std::vector<OrientedBoundary> solids{house(0, 5400, 8100), house(6000, 5400, 8100)};
  const Bytes page = encode_golden_page({"x.page", solids, {Mode::polygon}, 0}).value();
  const auto last = static_cast<std::uint8_t>(page.back() ^ 1U);
  const Bytes file = forged_file(page, {2, 1, page.size(), 2, 0, 0});
  const auto bad = ErrorCode::malformed;
  all.push_back({"another checksum of a page", "page", bad, with(page, page.size() - 1, last)});
  all.push_back({"a page of version 2", "page", ErrorCode::unsupported, with(page, 2, 0x82)});
  all.push_back({"a page file of version 2", "wtpf", ErrorCode::unsupported, with(file, 4, 2)});
  all.push_back({"a page file cut short", "wtpf", bad, Bytes(file.begin(), file.end() - 1)});
  all.push_back({"a damaged index", "wtpf", bad, with(file, file.size() - 13, 1)});
  const auto index = [&](const char* name, const std::vector<std::uint64_t>& numbers) {
    all.push_back({name, "wtpf", bad, forged_file(page, numbers)});
  };
  index("an index of three solids", {3, 1, page.size(), 2, 0, 0});
  index("an index with a number left out", {3, 1, page.size(), 2, 0, 1});
  index("an index of one solid", {1, 1, page.size(), 1, 0});
  index("an index of a longer page", {2, 1, page.size() + 1, 2, 0, 0});
  index("an index with a byte more", {2, 1, page.size(), 2, 0, 0, 0});
}

}  // namespace

std::vector<GoldenPage> golden_pages() {
  const auto any = Mode::automatic;
  std::vector<OrientedBoundary> two{house(0, 5400, 8100), house(6000, 5400, 8100)};
  std::vector<OrientedBoundary> tori{torus(8, 4), torus(5, 3), torus(6, 4)};
  std::vector<OrientedBoundary> saws{saw(2, Back::right), saw(kSawTeeth, Back::left)};
  return {{"houses-neutral.page", two, {any}, 0},
          {"row.page", row(), {any}},
          {"row-polygon.page", row(), {Mode::polygon}},
          {"row-walk.page", row(), {Mode::walk}},
          {"row-mixed.page", row(), {Mode::polygon, Mode::raw, Mode::walk, Mode::bitmap}},
          {"tori-parallelogram.page", tori, {Mode::parallelogram}},
          {"saws-walk.page", saws, {Mode::walk}},
          {"grids.wtpf", interleaved(), {any}}};
}

Result<Bytes> encode_golden_page(const GoldenPage& golden) {
  if (golden.file.ends_with(".wtpf")) return page_file(golden);
  codec::PageContents page;
  page.models = golden.models;
  page.frame = codec::frame_of(golden.solids.front().solid(), {});
  std::vector<codec::Plan> plans;
  for (std::size_t i = 0; i < golden.solids.size(); ++i) {
    page.solids.push_back(codec::page_solid(golden.solids[i], true));
    plans.push_back({.mode = golden.modes[i % golden.modes.size()]});
  }
  return codec::write_page_bytes(page, plans, codec::PageKind::page, nullptr);
}

std::vector<Refused> refused() {
  std::vector<Refused> all;
  refuse_damaged(all);
  refuse_frames(all);
  refuse_solids(all);
  refuse_pages(all);
  return all;
}

std::string refused_csv() {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string csv = "name,kind,error,bytes\n";
  for (const Refused& one : refused()) {
    csv += '"';
    csv += one.name;
    csv += "\",";
    csv += one.kind;
    csv += ',';
    csv += to_string(one.error);
    csv += ',';
    for (const std::uint8_t byte : one.bytes) {
      csv += kDigits[byte >> 4U];
      csv += kDigits[byte & 15U];
    }
    csv += '\n';
  }
  return csv;
}

}  // namespace watertight::generated
