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
  std::uint32_t checksum = 0;
  PageKind kind = PageKind::blob;  // when read
  std::uint64_t frame_cost = 0;    // in 1/65536 bit, when read
};

/// The mode of a solid that is Mode::automatic becomes the one that costs least. `certificate` may
/// be null. Errors: not_encodable; unsupported (the models).
Result<Bytes> write_page_bytes(PageContents& page, PageKind kind,
                               const delaunay::Certificate* certificate);

/// What a stream of so many bytes may bring forth, whatever its caller allows (docs/format.md,
/// "Limits").
Limits limits_of_stream(std::size_t bytes, const Limits& limits);

/// The limits hold for all solids together. Errors: malformed; unsupported; limit_exceeded.
Result<PageContents> read_page_bytes(ByteView bytes, PageKind kind, const Limits& limits);

/// The stored form of a solid but for its mode's own data: its canonical form and its grid.
PageSolid page_solid(const OrientedBoundary& boundary, const EncodeOptions& options);
/// What a page must share with this solid. Cost: linear.
Frame frame_of(const Solid& solid, const Acceptance& acceptance);

/// What decode() answers for one solid of a page.
Result<Decoded> decoded_of(const PageContents& page, std::size_t number);

}  // namespace watertight::codec
