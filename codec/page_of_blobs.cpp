// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "codec/encode_boundary.h"
#include "codec/page.h"
#include "codec/page/container.h"

namespace watertight::codec {
namespace {

/// The mode of the solids of a page. The levels of detail of one building: as small in this mode
/// alone as in the best of all (bench/results/rows.md), which takes four times as long.
constexpr Mode kMode = Mode::polygon;

/// The boundaries of blobs, all with one frame, each the very blob that blob_of() makes; empty
/// unless all are.
Result<std::vector<OrientedBoundary>> boundaries_of(std::span<const ByteView> blobs,
                                                    Acceptance& acceptance) {
  std::vector<OrientedBoundary> boundaries;
  std::optional<Frame> frame;
  for (const ByteView blob : blobs) {
    auto decoded = decode(blob);
    if (!decoded) return std::move(decoded).error();
    acceptance = decoded->info.acceptance;
    const Frame own = frame_of(decoded->solid, acceptance);
    if (frame && *frame != own) return std::vector<OrientedBoundary>();
    frame = own;
    const auto again = blob_of(*decoded);
    const bool is_same = again && ByteView(*again).size() == blob.size() &&
                         std::equal(blob.begin(), blob.end(), again->begin());
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

Result<Bytes> blob_of(const Decoded& decoded) {
  const auto boundary = OrientedBoundary::make(decoded.solid);
  if (!boundary) return boundary.error();
  return encode_boundary(*boundary, decoded.info.acceptance);
}

}  // namespace watertight::codec
