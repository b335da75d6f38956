// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <string>
#include <utility>

#include "codec/encode_boundary.h"
#include "codec/page.h"
#include "codec/page/container.h"

namespace watertight::codec {
namespace {

/// The mode of the solids of a page. The levels of detail of one building: as small in this mode
/// alone as in the best of all (bench/results/rows.md), which takes four times as long.
constexpr Mode kMode = Mode::polygon;

/// The blob of a solid that was read, by the default options of encode(), but without decoding it
/// again.
Result<Bytes> unverified_blob(const Frame& frame, PageSolid read, const CancelPoll* cancel) {
  PageContents alone;
  alone.frame = frame;
  alone.solids.push_back(page_solid(*std::move(read.canonical), read.keeps_order));
  std::vector<Plan> plans(1);
  return write_page_bytes(alone, plans, PageKind::blob, nullptr, cancel);
}

/// The boundaries of blobs, all with one frame, each the very blob that unverified_blob() makes;
/// empty unless all are.
Result<std::vector<OrientedBoundary>> boundaries_of(std::span<const ByteView> blobs,
                                                    Acceptance& acceptance) {
  std::vector<OrientedBoundary> boundaries;
  std::optional<Frame> frame;
  for (const ByteView blob : blobs) {
    auto read = read_page_bytes(blob, PageKind::blob, {});
    if (!read) return std::move(read).error();
    auto decoded = decoded_of(*read, 0);
    if (!decoded) return std::move(decoded).error();
    acceptance = decoded->info.acceptance;
    const Frame own = frame_of(decoded->solid, acceptance);
    if (frame && *frame != own) return std::vector<OrientedBoundary>();
    frame = own;
    const auto again = unverified_blob(own, std::move(read->contents.solids.front()), nullptr);
    const bool is_same = again && std::ranges::equal(blob, *again);
    if (!is_same) return std::vector<OrientedBoundary>();
    auto boundary = OrientedBoundary::make(std::move(decoded->solid));
    if (!boundary) return std::move(boundary).error();
    boundaries.push_back(*std::move(boundary));
  }
  return boundaries;
}

}  // namespace

Result<std::optional<Bytes>> page_of_blobs(std::span<const ByteView> blobs) {
  if (blobs.size() < 2 || blobs.size() > kMaxPageSolids) return std::optional<Bytes>();
  Acceptance acceptance;
  const auto boundaries = boundaries_of(blobs, acceptance);
  if (!boundaries) return boundaries.error();
  if (boundaries->empty()) return std::optional<Bytes>();
  std::vector<const OrientedBoundary*> solids;
  for (const OrientedBoundary& boundary : *boundaries) solids.push_back(&boundary);
  EncodeOptions options;
  options.mode = kMode;
  auto page = encode_boundaries(solids, acceptance, options);
  std::size_t bytes = 0;
  for (const ByteView blob : blobs) bytes += blob.size();
  if (!page || page->size() >= bytes || !decode_page(*page)) return std::optional<Bytes>();
  return std::optional<Bytes>(*std::move(page));
}

Result<Bytes> blob_in_page(ByteView page, std::size_t number, const Limits& limits) {
  auto read = read_page_bytes(page, PageKind::page, limits);
  if (!read) return std::move(read).error();
  PageContents& contents = read->contents;
  if (number >= contents.solids.size()) {
    return Error{ErrorCode::invalid_argument, "the page has no solid " + std::to_string(number)};
  }
  return unverified_blob(contents.frame, std::move(contents.solids[number]), limits.cancel);
}

Result<Bytes> blob_of(const Decoded& decoded) {
  const auto boundary = OrientedBoundary::make(decoded.solid);
  if (!boundary) return boundary.error();
  return encode_boundary(*boundary, decoded.info.acceptance);
}

}  // namespace watertight::codec
