// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bytes of blobs and pages: magic, version, model number, the stream, the checksum
// (docs/format.md, "Container"). Between the public functions and SolidCoder.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/page/solid_coder.h"

namespace watertight::codec {

enum class PageKind : std::uint8_t {
  blob,  // one solid, three bytes of checksum
  page   // a count, four bytes of checksum
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
  std::uint64_t frame_cost = 0;    // in 1/65536 bit
  std::vector<StreamCosts> costs;  // the costs of each solid, in 1/65536 bit
};

/// Writes the solids as planned, one plan for each; `certificate` may be null. Afterwards the plans
/// in automatic mode have the mode that costs least, and the solids are as they stand in the page.
/// Errors: not_encodable; unsupported (the models).
Result<Bytes> write_page_bytes(PageContents& page, std::vector<Plan>& plans, PageKind kind,
                               const delaunay::Certificate* certificate);

/// The most that a stream of so many bytes may decode to, whatever its caller allows
/// (docs/format.md, "Limits").
Limits limits_of_stream(std::size_t bytes, const Limits& limits);

/// The limits hold for all solids together. Errors: malformed; unsupported; limit_exceeded.
Result<StoredPage> read_page_bytes(ByteView bytes, PageKind kind, const Limits& limits);

/// The stored form of a solid but for its mode: its canonical form, on its grid.
PageSolid page_solid(const OrientedBoundary& boundary, bool keeps_order);
/// The frame of a page that may hold this solid. Cost: linear.
Frame frame_of(const Solid& solid, const Acceptance& acceptance);

/// The answer of decode() for one solid of a page.
Result<Decoded> decoded_of(const StoredPage& page, std::size_t number);

}  // namespace watertight::codec
