// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <utility>
#include <vector>

#include "codec/blob_header.h"
#include "codec/coordinates.h"
#include "codec/decompose.h"
#include "codec/encode_boundary.h"
#include "codec/facet_listing.h"
#include "codec/order_section.h"

namespace watertight {
namespace {

void append_section(ByteWriter& writer, const Bytes& section) {
  writer.varint(section.size());
  writer.append(section);
}

/// Everything that a blob is made from, whatever its mode.
struct Source {
  const OrientedBoundary& boundary;
  const Acceptance& acceptance;
  const EncodeOptions& options;
  CanonicalSolid canonical;
  bool has_order = false;  // else canonical order is returned
  Bytes order;
};

BlobHeader header_of(const Source& source, Mode mode) {
  BlobHeader header;
  header.mode = mode;
  header.acceptance = source.acceptance;
  header.srid = source.boundary.solid().srid();
  header.lattice = source.boundary.solid().lattice();
  unsigned flags = source.has_order ? static_cast<unsigned>(kHasOrder) : 0U;
  if (source.acceptance.tolerances != kImpliedTolerances) flags |= kHasTolerances;
  header.flags = static_cast<std::uint8_t>(flags);
  return header;
}

Bytes finish(const Source& source, const BlobHeader& header, const std::vector<Bytes>& sections) {
  ByteWriter writer;
  write_header(writer, header);
  for (const Bytes& section : sections) append_section(writer, section);
  if (header.has(kHasOrder)) append_section(writer, source.order);
  const SourceOrder none;
  writer.u32(checksum_of(header, source.canonical.boundary.solid(),
                         header.has(kHasOrder) ? source.canonical.order : none));
  return std::move(writer).bytes();
}

Bytes encode_raw(const Source& source) {
  const Solid& solid = source.canonical.boundary.solid();
  return finish(source, header_of(source, Mode::raw),
                {write_vertices(solid.vertices()), write_facet_listing(solid.arrays())});
}

Result<Bytes> encode_bitmap(const Source& source, const Certificate* certificate) {
  auto parts = decompose(source.canonical, certificate);
  if (!parts) return parts.error();
  BlobHeader header = header_of(source, Mode::bitmap);
  unsigned flags = header.flags;
  std::vector<Bytes> sections{std::move(parts->vertices)};
  if (!parts->steiner.empty()) {
    flags |= kHasSteiner;
    sections.push_back(std::move(parts->steiner));
  }
  if (parts->bitmap_coding == BitCoding::arithmetic) flags |= kCodedBitmap;
  sections.push_back(std::move(parts->bitmap));
  if (!parts->unrecovered.empty()) {
    flags |= kHasUnrecovered;
    sections.push_back(std::move(parts->unrecovered));
  }
  if (!parts->facets) {
    flags |= kExplicitFacets;
    sections.push_back(write_facet_listing(source.canonical.boundary.solid().arrays()));
  } else {
    if (parts->facets->coding == BitCoding::arithmetic) flags |= kCodedFacets;
    sections.push_back(std::move(parts->facets->bytes));
  }
  header.flags = static_cast<std::uint8_t>(flags);
  return finish(source, header, sections);
}

/// Verify-after-write.
Status verify(const Source& source, ByteView blob) {
  const Limits none{.bytes = ~std::uint64_t{0},
                    .vertices = kNone,
                    .facets = kNone,
                    .rings = kNone,
                    .shells = kNone};
  const auto decoded = decode(blob, none);
  if (!decoded) {
    return Error{ErrorCode::not_encodable, "the blob does not decode: " + decoded.error().message};
  }
  const bool in_source_order = source.options.keep_order;
  const Solid& wanted =
      in_source_order ? source.boundary.solid() : source.canonical.boundary.solid();
  if (decoded->solid != wanted || decoded->info.acceptance != source.acceptance) {
    return Error{ErrorCode::not_encodable, "the blob decodes to another solid"};
  }
  return Done{};
}

Result<Bytes> verified(const Source& source, Result<Bytes> blob) {
  if (!blob) return blob;
  if (auto status = verify(source, *blob); !status) return status.error();
  return blob;
}

Result<Bytes> encode_smallest(const Source& source) {
  Bytes raw = encode_raw(source);
  auto bitmap = encode_bitmap(source, nullptr);
  if (bitmap && bitmap->size() < raw.size() && verify(source, *bitmap)) return bitmap;
  return verified(source, std::move(raw));
}

}  // namespace

std::string_view to_string(Mode mode) {
  switch (mode) {
    case Mode::raw:
      return "raw";
    case Mode::bitmap:
      return "bitmap";
    case Mode::automatic:
      return "automatic";
  }
  return "unknown";
}

Result<Bytes> encode_boundary(const OrientedBoundary& boundary, const Acceptance& acceptance,
                              const EncodeOptions& options) {
  Source source{boundary, acceptance, options, canonical_form(boundary), false, {}};
  source.has_order = options.keep_order && !source.canonical.order.is_identity();
  if (source.has_order) {
    source.order = write_order(source.canonical.boundary.solid(), source.canonical.order);
  }
  switch (options.mode) {
    case Mode::raw:
      return verified(source, encode_raw(source));
    case Mode::bitmap:
      return verified(source, encode_bitmap(source, options.certificate));
    case Mode::automatic:
      return encode_smallest(source);
  }
  return Error{ErrorCode::invalid_argument, "unknown mode"};
}

Result<Bytes> encode(const ValidSolid& solid, const EncodeOptions& options) {
  return encode_boundary(solid.boundary(), solid.acceptance(), options);
}

}  // namespace watertight
