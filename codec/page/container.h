// SPDX-License-Identifier: GPL-3.0-or-later
//
// Writes and reads the bytes of blobs and pages: magic, version, model number, stream, checksum
// (docs/format.md, "Container"). The public functions call this file; it calls SolidCoder.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/page/solid_coder.h"

namespace watertight::codec {

enum class PageKind : std::uint8_t {
  blob,  // a blob: one solid, then three bytes of checksum
  page   // a page: a count, its solids, then four bytes of checksum
};

struct PageContents {
  Frame frame;
  std::uint8_t models = kModelNumber;
  std::vector<PageSolid> solids;
};

/// A page as it was read.
struct StoredPage {
  PageKind kind = PageKind::blob;
  PageContents contents;
  std::uint32_t checksum = 0;
  std::uint64_t frame_cost = 0;    // the cost of the frame, in 1/65536 bit
  std::vector<StreamCosts> costs;  // the costs of each solid, in 1/65536 bit
};

/// Writes each solid of `page` by its element of `plans`; `certificate` and `cancel` may be null.
/// Afterwards
/// each plan in automatic mode names the mode that costs least, and each solid has the mode of its
/// plan and the sections that this mode needs. Errors: not_encodable; unsupported (the models).
/// Once cancelled, errors and bytes mean nothing.
Result<Bytes> write_page_bytes(PageContents& page, std::vector<Plan>& plans, PageKind kind,
                               const delaunay::Certificate* certificate,
                               const CancelPoll* cancel = nullptr);

/// Returns `limits`, lowered to the most that a stream of `bytes` bytes may decode to
/// (docs/format.md, "Limits").
Limits limits_of_stream(std::size_t bytes, const Limits& limits);

/// Reads a blob or a page. The limits hold for all its solids together. Errors: malformed;
/// unsupported; limit_exceeded.
Result<StoredPage> read_page_bytes(ByteView bytes, PageKind kind, const Limits& limits);

/// Returns the canonical form of a boundary, with its integers if its coordinates are on a grid.
/// The mode is not chosen yet. `keeps_order`: the page shall have the source order, unless that is
/// the identity.
PageSolid page_solid(geometry::CanonicalSolid canonical, bool keeps_order);
PageSolid page_solid(const OrientedBoundary& boundary, bool keeps_order);
/// The frame of a page that can hold `solid`. Cost: linear.
Frame frame_of(const Solid& solid, const Acceptance& acceptance);

/// The result of decode() for the solid at index `number` of a page.
Result<Decoded> decoded_of(const StoredPage& page, std::size_t number);

}  // namespace watertight::codec
