// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <utility>
#include <vector>

#include "codec/encode_boundary.h"
#include "codec/page.h"
#include "codec/page/container.h"

namespace watertight::codec {
namespace {

/// A boundary to be encoded, and its acceptance.
struct Source {
  const OrientedBoundary* boundary;
  Acceptance acceptance;
};

constexpr std::size_t kModes = 5;

constexpr Limits kNoLimits{.bytes = ~std::uint64_t{0},
                           .vertices = kNone,
                           .facets = kNone,
                           .rings = kNone,
                           .shells = kNone};

/// Decodes `bytes`. Returns the index of the first solid that does not equal its source, or the
/// number of solids if all do.
Result<std::size_t> first_difference(ByteView bytes, PageKind kind,
                                     const std::vector<Source>& sources,
                                     const std::vector<PageSolid>& stored,
                                     const EncodeOptions& options, const Limits& limits) {
  const auto page = read_page_bytes(bytes, kind, limits);
  if (!page) return page.error();
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const auto decoded = decoded_of(*page, i);
    const Solid& wanted =
        options.keep_order ? sources[i].boundary->solid() : stored[i].canonical->boundary.solid();
    const bool is_equal =
        decoded && decoded->solid == wanted && decoded->info.acceptance == sources[i].acceptance;
    if (!is_equal) return i;
  }
  return sources.size();
}

/// Makes automatic mode take another mode than the one that it has taken.
void decline_mode(Plan& plan) {
  if (plan.mode == Mode::raw) return;
  plan.declined |= 1U << static_cast<unsigned>(plan.mode);
  plan.mode = Mode::automatic;
}

/// Encodes solids in the mode of the options. In automatic mode each solid takes the mode that
/// codes it in the fewest bytes after the solids before it. A solid that does not decode to itself
/// is stored raw. If the bytes are so few that decoders refuse them as a decompression bomb
/// (docs/format.md, "Limits"), all solids take their next best mode.
Result<Bytes> encode_modes(const std::vector<Source>& sources, PageKind kind,
                           const EncodeOptions& options) {
  PageContents page;
  page.models = options.models;
  for (const Source& source : sources) {
    page.solids.push_back(page_solid(*source.boundary, options.keep_order));
  }
  std::vector<Plan> plans(sources.size(), Plan{.mode = options.mode});
  page.frame = frame_of(sources.front().boundary->solid(), sources.front().acceptance);
  const bool may_fall_back = options.mode == Mode::automatic;
  Limits limits = kNoLimits;
  limits.cancel = options.cancel;
  for (std::size_t attempt = 0; attempt <= sources.size() + kModes; ++attempt) {
    auto bytes = write_page_bytes(page, plans, kind, options.certificate, options.cancel);
    const Error cancelled{ErrorCode::cancelled, "the blob is not wanted any more"};
    if (!bytes && limits.is_cancelled()) return cancelled;
    if (!bytes) return bytes;
    const auto difference = first_difference(*bytes, kind, sources, page.solids, options, limits);
    if (limits.is_cancelled()) return cancelled;
    if (difference && *difference == sources.size()) return bytes;
    const bool is_too_short = !difference && difference.error().code == ErrorCode::limit_exceeded;
    if (!may_fall_back) {
      std::string reason = "the blob decodes to another solid";
      if (!difference) reason = "the blob does not decode: " + difference.error().message;
      if (is_too_short) reason = "decoders refuse blobs with so many vertices for their bytes";
      return Error{ErrorCode::not_encodable, std::move(reason)};
    }
    for (std::size_t i = 0; i < page.solids.size(); ++i) {
      if (!is_too_short && difference && *difference != i) continue;
      if (is_too_short) {
        decline_mode(plans[i]);
      } else {
        plans[i].mode = Mode::raw;
      }
      page.solids[i].plain = {};
    }
  }
  return Error{ErrorCode::not_encodable, "the solid does not come back from a blob in any mode"};
}

/// Automatic mode chooses for one solid at a time, but models learn from the solids before. A small
/// page can therefore be smaller in one mode for all its solids: pages up to this size are tried in
/// each mode too. On larger pages the trials would take a third of the encoder's time and win
/// next to nothing (The Hague: 2 bytes of 20,717).
constexpr std::size_t kFewBytes = 2048;

Result<Bytes> encode_contents(const std::vector<Source>& sources, PageKind kind,
                              const EncodeOptions& options) {
  auto best = encode_modes(sources, kind, options);
  if (!best || options.mode != Mode::automatic) return best;
  if (kind == PageKind::blob || best->size() > kFewBytes) return best;
  for (const Mode mode : {Mode::walk, Mode::polygon, Mode::parallelogram}) {
    EncodeOptions one = options;
    one.mode = mode;
    auto bytes = encode_modes(sources, kind, one);
    if (bytes && bytes->size() < best->size()) best = std::move(bytes);
  }
  return best;
}

}  // namespace

std::string_view to_string(Mode mode) {
  switch (mode) {
    case Mode::raw:
      return "raw";
    case Mode::bitmap:
      return "bitmap";
    case Mode::walk:
      return "walk";
    case Mode::polygon:
      return "polygon";
    case Mode::parallelogram:
      return "parallelogram";
    case Mode::automatic:
      return "automatic";
  }
  return "unknown";
}

Result<Bytes> encode_boundary(const OrientedBoundary& boundary, const Acceptance& acceptance,
                              const EncodeOptions& options) {
  return encode_contents({{&boundary, acceptance}}, PageKind::blob, options);
}

Result<Bytes> encode(const ValidSolid& solid, const EncodeOptions& options) {
  return encode_boundary(solid.boundary(), solid.acceptance(), options);
}

Result<Bytes> encode_boundaries(std::span<const OrientedBoundary* const> boundaries,
                                const Acceptance& acceptance, const EncodeOptions& options) {
  if (boundaries.empty() || boundaries.size() > kMaxPageSolids) {
    return Error{ErrorCode::invalid_argument, "a page has 1 to 256 solids"};
  }
  const Frame frame = frame_of(boundaries.front()->solid(), acceptance);
  std::vector<Source> sources;
  for (const OrientedBoundary* boundary : boundaries) {
    if (frame_of(boundary->solid(), acceptance) != frame) {
      return Error{ErrorCode::invalid_argument,
                   "the solids of a page share their grid, reference system and acceptance"};
    }
    sources.push_back({boundary, acceptance});
  }
  return encode_contents(sources, PageKind::page, options);
}

}  // namespace watertight::codec
