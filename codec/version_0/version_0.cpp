// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/version_0/version_0.h"

#include <string>
#include <utility>

#include "codec/mode_bitmap/compose.h"
#include "codec/page/blob_header.h"
#include "codec/page/coordinates.h"
#include "codec/page/facet_listing.h"
#include "codec/version_0/order_section.h"

namespace watertight::codec {
namespace {

/// The sections of a blob, found but not read.
struct Sections {
  bitmap::BitmapSections parts;
  ByteView order;
  std::uint32_t checksum = 0;
  std::vector<BlobInfo::Part> sizes;
};

class SectionReader {
 public:
  explicit SectionReader(ByteReader& reader, Sections& sections)
      : reader_(reader), sections_(sections) {}

  /// A section of at least one byte: present sections are never empty but for arithmetic ones,
  /// whose all-likely bits can vanish.
  ByteView take(const char* name) {
    const std::size_t before = reader_.position();
    const std::uint64_t size = reader_.varint();
    const ByteView view =
        size <= reader_.remaining() ? reader_.take(size) : reader_.take(~std::size_t{0});
    sections_.sizes.push_back({name, static_cast<double>(reader_.position() - before)});
    return view;
  }

 private:
  ByteReader& reader_;
  Sections& sections_;
};

Result<Sections> find_sections(ByteReader& reader, const BlobHeader& header) {
  Sections sections;
  sections.sizes.push_back({"header", static_cast<double>(reader.position())});
  SectionReader section(reader, sections);
  bitmap::BitmapSections& parts = sections.parts;
  parts.vertices = section.take("vertices");
  if (header.mode == Mode::bitmap) {
    if (header.has(kHasSteiner)) parts.steiner = section.take("steiner");
    parts.bitmap = section.take("bitmap");
    if (header.has(kHasUnrecovered)) parts.unrecovered = section.take("unrecovered");
  }
  parts.facets = section.take("facets");
  if (header.has(kHasOrder)) sections.order = section.take("order");
  sections.checksum = reader.u32();
  sections.sizes.push_back({"checksum", 4});
  if (reader.failed()) return reader.error("blob");
  if (reader.remaining() != 0) {
    return Error{ErrorCode::malformed, "bytes follow the blob", reader.position()};
  }
  if ((header.has(kHasSteiner) && parts.steiner.empty()) ||
      (header.has(kHasUnrecovered) && parts.unrecovered.empty())) {
    return Error{ErrorCode::malformed, "a section is empty"};
  }
  if (header.has(kExplicitFacets) && header.has(kCodedFacets)) {
    return Error{ErrorCode::malformed, "the facet section has two codings"};
  }
  parts.bitmap_coding =
      header.has(kCodedBitmap) ? bitmap::BitCoding::arithmetic : bitmap::BitCoding::plain;
  parts.facet_coding =
      header.has(kCodedFacets) ? bitmap::BitCoding::arithmetic : bitmap::BitCoding::plain;
  parts.lists_facets = header.has(kExplicitFacets);
  return sections;
}

Result<bitmap::Composition> read_raw(const bitmap::BitmapSections& sections, const Limits& limits) {
  auto vertices = read_vertices(sections.vertices, limits);
  if (!vertices) return vertices.error();
  auto arrays = read_facet_listing(sections.facets, static_cast<Index>(vertices->size()), limits);
  if (!arrays) return arrays.error();
  bitmap::Composition result;
  result.arrays = std::move(arrays).value();
  result.arrays.vertices = std::move(vertices).value();
  return result;
}

/// The canonical solid of what was read; listed facets must be canonical already.
Result<geometry::CanonicalSolid> canonical_solid(SolidArrays arrays, const BlobHeader& header,
                                                 bool must_be_canonical, const Limits& limits) {
  auto solid = Solid::make(std::move(arrays), header.lattice, header.srid, limits);
  if (!solid) return solid.error();
  auto boundary = OrientedBoundary::make(std::move(solid).value());
  if (!boundary) {
    return Error{ErrorCode::malformed, "no closed boundary: " + boundary.error().message};
  }
  geometry::CanonicalSolid canonical = geometry::canonical_form(*boundary);
  if (must_be_canonical && !canonical.order.is_identity()) {
    return Error{ErrorCode::malformed, "the listed facets are not in canonical order"};
  }
  return canonical;
}

BlobInfo info_of(const BlobHeader& header, const bitmap::Composition& composition,
                 const Solid& solid, Sections sections) {
  BlobInfo info;
  info.version = 0;
  info.mode = header.mode;
  info.acceptance = header.acceptance;
  info.srid = header.srid;
  info.lattice = header.lattice;
  info.vertices = solid.vertex_count();
  info.steiner_vertices = composition.steiner_vertices;
  info.facets = solid.facet_count();
  info.rings = solid.ring_count();
  info.shells = solid.shell_count();
  info.delaunay_faces = composition.delaunay_faces;
  info.marked_faces = composition.marked_faces;
  info.unrecovered_faces = composition.unrecovered_faces;
  info.has_order = header.has(kHasOrder);
  info.parts = std::move(sections.sizes);
  info.checksum = sections.checksum;
  return info;
}

Result<geometry::SourceOrder> order_of(const BlobHeader& header, ByteView section,
                                       const Solid& canonical) {
  if (!header.has(kHasOrder)) return geometry::SourceOrder{};
  auto order = read_order(section, canonical);
  if (order && order->is_identity()) {
    return Error{ErrorCode::malformed, "an order section that orders nothing"};
  }
  return order;
}

}  // namespace

Result<Decoded> decode_version_0(ByteView blob, const Limits& limits) {
  ByteReader reader(blob);
  const auto header = read_header(reader);
  if (!header) return header.error();
  auto sections = find_sections(reader, *header);
  if (!sections) return sections.error();
  const bool is_raw = header->mode == Mode::raw;
  auto composition =
      is_raw ? read_raw(sections->parts, limits) : bitmap::compose(sections->parts, limits);
  if (!composition) return composition.error();
  auto canonical = canonical_solid(std::move(composition->arrays), *header,
                                   is_raw || sections->parts.lists_facets, limits);
  if (!canonical) return canonical.error();
  const Solid& solid = canonical->boundary.solid();
  const auto order = order_of(*header, sections->order, solid);
  if (!order) return order.error();
  if (checksum_of(header->acceptance, solid, *order) != sections->checksum) {
    return Error{ErrorCode::malformed, "the checksum does not match the solid", blob.size() - 4};
  }
  BlobInfo info = info_of(*header, *composition, solid, std::move(sections).value());
  if (!header->has(kHasOrder)) return Decoded{solid, std::move(info)};
  auto restored = geometry::restore_order(solid, *order);
  if (!restored) return restored.error();
  return Decoded{std::move(restored).value(), std::move(info)};
}

}  // namespace watertight::codec
