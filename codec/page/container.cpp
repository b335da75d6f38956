// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/page/container.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "base/checksum.h"
#include "codec/mode_bitmap/decompose.h"
#include "codec/page.h"
#include "codec/page/solid_checksum.h"
#include "codec/sections/coordinates.h"
#include "codec/sections/facet_listing.h"

namespace watertight::codec {
namespace {

/// A stream that is cancelled ends as a malformed one does, or as no mode that holds the solid;
/// this is the error then.
Error cancelled() { return {ErrorCode::cancelled, "the blob is not wanted any more"}; }

constexpr std::uint8_t kSolidMagic[2] = {'W', 'T'};
constexpr std::uint8_t kPageFlag = 0x80;  // this bit of the version byte marks a page
constexpr std::size_t kHeaderBytes = 4;

// A stream of n bytes may decode to at most kFreeVertices + n * kVerticesPerByte vertices
// (docs/format.md, "Limits").
constexpr std::uint64_t kFreeVertices = 4096;
constexpr std::uint64_t kVerticesPerByte = 64;

std::size_t checksum_bytes(PageKind kind) { return kind == PageKind::blob ? 3 : 4; }

std::size_t size_of(const PlainSections& plain) {
  return std::accumulate(plain.sections.begin(), plain.sections.end(), std::size_t{0},
                         [](std::size_t sum, const Bytes& part) { return sum + part.size(); });
}

/// The checksum of a page is the CRC-32C of the checksums of its solids; that of a blob is the
/// lower three bytes of the checksum of its solid.
std::uint32_t page_checksum(const PageContents& page, PageKind kind) {
  ByteWriter writer;
  std::uint32_t sum = 0;
  for (const PageSolid& solid : page.solids) {
    sum = checksum_of(page.frame.acceptance, solid.canonical->boundary.solid(),
                      solid.keeps_order ? solid.canonical->order : geometry::SourceOrder{});
    writer.u32(sum);
  }
  return kind == PageKind::blob ? sum & 0xFFFFFFU : crc32c(writer.bytes());
}

Result<PlainSections> plain_sections(const geometry::CanonicalSolid& canonical, Mode mode,
                                     const delaunay::Certificate* certificate,
                                     const CancelPoll& is_cancelled = {}) {
  const Solid& solid = canonical.boundary.solid();
  PlainSections plain;
  if (mode == Mode::raw) {
    plain.sections = {write_vertices(solid.vertices()), write_facet_listing(solid.arrays())};
    return plain;
  }
  auto parts = bitmap::decompose(canonical, certificate, is_cancelled);
  if (!parts) return parts.error();
  plain.counts = parts->counts;
  unsigned flags = 0;
  plain.sections.push_back(std::move(parts->vertices));
  if (!parts->steiner.empty()) {
    flags |= kHasSteiner;
    plain.sections.push_back(std::move(parts->steiner));
  }
  if (parts->bitmap_coding == bitmap::BitCoding::arithmetic) flags |= kCodedBitmap;
  plain.sections.push_back(std::move(parts->bitmap));
  if (!parts->unrecovered.empty()) {
    flags |= kHasUnrecovered;
    plain.sections.push_back(std::move(parts->unrecovered));
  }
  if (!parts->facets) {
    flags |= kExplicitFacets;
    plain.sections.push_back(write_facet_listing(solid.arrays()));
  } else {
    if (parts->facets->coding == bitmap::BitCoding::arithmetic) flags |= kCodedFacets;
    plain.sections.push_back(std::move(parts->facets->bytes));
  }
  plain.flags = static_cast<std::uint8_t>(flags);
  return plain;
}

/// Chooses the shorter of modes raw and bitmap and makes the sections of that mode.
Result<Mode> choose_plain(PageSolid& solid, const Plan& plan, const CancelPoll& is_cancelled) {
  auto raw = plain_sections(*solid.canonical, Mode::raw, nullptr);
  if (!raw) return raw.error();
  solid.plain = std::move(raw).value();
  if ((plan.declined >> static_cast<unsigned>(Mode::bitmap) & 1U) != 0) return Mode::raw;
  auto bitmap = plain_sections(*solid.canonical, Mode::bitmap, nullptr, is_cancelled);
  if (!bitmap || size_of(*bitmap) >= size_of(solid.plain)) return Mode::raw;
  solid.plain = std::move(bitmap).value();
  return Mode::bitmap;
}

/// Gives `plan` the mode that costs least if its mode is automatic, and returns the draft in that
/// mode, if it is a mode for integers. Makes the sections of modes raw and bitmap, unless `solid`
/// has them.
Result<std::unique_ptr<Draft>> complete(const SolidCoder& coder, PageSolid& solid, Plan& plan,
                                        const delaunay::Certificate* certificate) {
  if (plan.mode == Mode::automatic) {
    if (auto draft = coder.cheapest(solid, plan)) {
      plan.mode = draft->mode;
      plan.choice = draft->choice;
      if (!draft->decisions.is_recorder()) draft.reset();
      return draft;
    }
    const CancelPoll is_cancelled = coder.poll();
    if (is_cancelled && is_cancelled()) return cancelled();
    const auto mode = choose_plain(solid, plan, is_cancelled);
    if (!mode) return mode.error();
    plan.mode = *mode;
  }
  const bool is_plain = plan.mode == Mode::raw || plan.mode == Mode::bitmap;
  if (is_plain && solid.plain.sections.empty()) {
    auto plain = plain_sections(*solid.canonical, plan.mode, certificate, coder.poll());
    if (!plain) return plain.error();
    solid.plain = std::move(plain).value();
  }
  return std::unique_ptr<Draft>();
}

/// The sizes of the parts of the solid at index `number`. If the page has no other solid, they
/// include the header, the frame and the checksum.
std::vector<BlobInfo::Part> parts_of(const StoredPage& page, std::size_t number) {
  constexpr const char* kNames[kStreamParts] = {"frame",  "position",    "connectivity",
                                                "facets", "coordinates", "order"};
  std::vector<BlobInfo::Part> parts;
  const bool is_alone = page.contents.solids.size() == 1;
  if (is_alone) parts.push_back({"header", static_cast<double>(kHeaderBytes)});
  for (std::size_t i = 0; i < kStreamParts; ++i) {
    const std::uint64_t cost = page.costs[number][i] + (is_alone && i == 0 ? page.frame_cost : 0);
    if (cost == 0) continue;
    const double bytes = static_cast<double>(cost) / (8.0 * (1 << kCostBits));
    parts.push_back({kNames[i], std::round(bytes * 100) / 100});
  }
  if (is_alone) parts.push_back({"checksum", static_cast<double>(checksum_bytes(page.kind))});
  return parts;
}

StreamCosts costs_since(const StreamCosts& before, const EntropyStream& stream) {
  StreamCosts costs = stream.costs();
  for (std::size_t i = 0; i < kStreamParts; ++i) costs[i] -= before[i];
  return costs;
}

Result<std::uint8_t> read_layout(ByteReader& reader, PageKind kind) {
  const std::uint8_t first = reader.u8();
  const std::uint8_t second = reader.u8();
  const std::uint8_t version = reader.u8();
  if (reader.failed()) return reader.error("header");
  if (first != kSolidMagic[0] || second != kSolidMagic[1]) {
    return Error{ErrorCode::malformed, "this is not a blob: it does not start with WT", 0};
  }
  if ((version & 0x7FU) != kFormatVersion) {
    return Error{ErrorCode::unsupported,
                 "format version " + std::to_string(version & 0x7FU) +
                     "; this program reads version " + std::to_string(kFormatVersion),
                 2};
  }
  if (((version & kPageFlag) != 0) != (kind == PageKind::page)) {
    return Error{ErrorCode::malformed,
                 kind == PageKind::page ? "a blob, not a page" : "a page, not a blob", 2};
  }
  const std::uint8_t models = reader.u8();
  if (reader.failed()) return reader.error("header");
  return models;
}

}  // namespace

PageSolid page_solid(geometry::CanonicalSolid canonical, bool keeps_order) {
  PageSolid solid;
  solid.canonical = std::move(canonical);
  solid.keeps_order = keeps_order && !solid.canonical->order.is_identity();
  if (auto gridded = grid_solid(solid.canonical->boundary.solid())) {
    solid.integers = std::move(gridded->solid);
    solid.origin = gridded->origin;
  }
  return solid;
}

PageSolid page_solid(const OrientedBoundary& boundary, bool keeps_order) {
  return page_solid(geometry::canonical_form(boundary), keeps_order);
}

Frame frame_of(const Solid& solid, const Acceptance& acceptance) {
  PageGrid grid{solid.lattice().kind, solid.lattice().step, solid.lattice().origin};
  if (const auto gridded = grid_solid(solid)) grid = gridded->grid;
  return {acceptance, solid.srid(), grid};
}

Result<Bytes> write_page_bytes(PageContents& page, std::vector<Plan>& plans, PageKind kind,
                               const delaunay::Certificate* certificate, const CancelPoll* cancel) {
  auto models = ModelSet::make(page.models);
  if (!models) return models.error();
  const Limits none{.bytes = ~std::uint64_t{0},
                    .vertices = kNone,
                    .facets = kNone,
                    .rings = kNone,
                    .shells = kNone,
                    .claimed = ~std::uint64_t{0},
                    .cancel = cancel};
  EntropyStream stream = EntropyStream::writer();
  stream.heed(none);
  if (kind == PageKind::page) stream.code_uniform(page.solids.size() - 1, kMaxPageSolids);
  if (auto status = code_frame(stream, (*models)[ModelPart::frame], page.frame); !status) {
    return status.error();
  }
  SolidCoder coder(stream, *models, page.frame, none);
  for (std::size_t i = 0; i < page.solids.size(); ++i) {
    PageSolid& solid = page.solids[i];
    const auto draft = complete(coder, solid, plans[i], certificate);
    if (!draft) return draft.error();
    solid.mode = plans[i].mode;
    if (auto status = coder.code(solid, plans[i].choice, draft->get()); !status) {
      return status.error();
    }
  }
  ByteWriter writer;
  writer.append(kSolidMagic);
  writer.u8(static_cast<std::uint8_t>(kFormatVersion | (kind == PageKind::page ? kPageFlag : 0U)));
  writer.u8(page.models);
  writer.append(std::move(stream).finish());
  const std::uint32_t checksum = page_checksum(page, kind);
  for (std::size_t i = 0; i < checksum_bytes(kind); ++i) {
    writer.u8(static_cast<std::uint8_t>(checksum >> (8 * i)));
  }
  return std::move(writer).bytes();
}

Limits limits_of_stream(std::size_t bytes, const Limits& limits) {
  Limits result = limits;
  const std::uint64_t most =
      std::min(kFreeVertices + kVerticesPerByte * bytes, limits.claimed_by(bytes));
  result.vertices = std::min(limits.vertices, most);
  result.facets = std::min(limits.facets, 2 * most);
  result.rings = std::min(limits.rings, 2 * most);
  result.shells = std::min(limits.shells, most);
  return result;
}

Result<StoredPage> read_page_bytes(ByteView bytes, PageKind kind, const Limits& limits) {
  if (bytes.size() > limits.bytes) {
    return Error{ErrorCode::limit_exceeded, "a blob of " + std::to_string(bytes.size()) +
                                                " bytes; the limit is " +
                                                std::to_string(limits.bytes)};
  }
  ByteReader reader(bytes);
  const auto number = read_layout(reader, kind);
  if (!number) return number.error();
  if (bytes.size() < kHeaderBytes + checksum_bytes(kind)) {
    return Error{ErrorCode::malformed, "the blob ends before its checksum", bytes.size()};
  }
  const std::size_t size = bytes.size() - kHeaderBytes - checksum_bytes(kind);
  StoredPage page;
  page.kind = kind;
  page.contents.models = *number;
  auto models = ModelSet::make(*number);
  if (!models) return models.error();
  EntropyStream stream = EntropyStream::reader(reader.take(size));
  stream.heed(limits);
  for (std::size_t i = 0; i < checksum_bytes(kind); ++i) {
    page.checksum |= static_cast<std::uint32_t>(reader.u8()) << (8 * i);
  }
  const std::uint64_t count =
      kind == PageKind::page ? stream.code_uniform(0, kMaxPageSolids) + 1 : 1;
  if (auto status = code_frame(stream, (*models)[ModelPart::frame], page.contents.frame); !status) {
    return limits.is_cancelled() ? cancelled() : status.error();
  }
  page.frame_cost = stream.cost();
  SolidCoder coder(stream, *models, page.contents.frame, limits_of_stream(size, limits));
  for (std::uint64_t i = 0; i < count; ++i) {
    PageSolid solid;
    const StreamCosts before = stream.costs();
    if (auto status = coder.code(solid); !status) {
      if (limits.is_cancelled()) return cancelled();
      Error error = std::move(status).error();
      if (kind == PageKind::page) error.message += "; solid " + std::to_string(i);
      if (!error.byte_offset) error.byte_offset = kHeaderBytes + stream.position();
      return error;
    }
    page.contents.solids.push_back(std::move(solid));
    page.costs.push_back(costs_since(before, stream));
  }
  if (!stream.is_finished()) {
    return Error{ErrorCode::malformed, "the blob does not end where its solid ends",
                 bytes.size() - checksum_bytes(kind)};
  }
  if (page_checksum(page.contents, kind) != page.checksum) {
    return Error{ErrorCode::malformed, "the checksum does not match the solid",
                 bytes.size() - checksum_bytes(kind)};
  }
  return page;
}

Result<Decoded> decoded_of(const StoredPage& page, std::size_t number) {
  const PageSolid& stored = page.contents.solids[number];
  const Solid& canonical = stored.canonical->boundary.solid();
  BlobInfo info;
  info.version = kFormatVersion;
  info.models = page.contents.models;
  info.mode = stored.mode;
  info.acceptance = page.contents.frame.acceptance;
  info.srid = page.contents.frame.srid;
  info.lattice = canonical.lattice();
  info.vertices = canonical.vertex_count();
  info.facets = canonical.facet_count();
  info.rings = canonical.ring_count();
  info.shells = canonical.shell_count();
  info.steiner_vertices = stored.plain.counts.steiner_vertices;
  info.delaunay_faces = stored.plain.counts.delaunay_faces;
  info.marked_faces = stored.plain.counts.marked_faces;
  info.unrecovered_faces = stored.plain.counts.unrecovered_faces;
  info.has_order = stored.keeps_order;
  info.checksum = page.checksum;
  info.parts = parts_of(page, number);
  if (!stored.keeps_order) return Decoded{canonical, std::move(info)};
  auto restored = geometry::restore_order(canonical, stored.canonical->order);
  if (!restored) return restored.error();
  return Decoded{std::move(restored).value(), std::move(info)};
}

}  // namespace watertight::codec
