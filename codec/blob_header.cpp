// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/blob_header.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/checksum.h"

namespace watertight {
namespace {

constexpr std::uint8_t kMagic[2] = {'W', 'T'};
constexpr int kKindShift = 4;     // bits 4-5 of the mode byte
constexpr int kProofShift = 6;    // bit 6
constexpr int kOneStepShift = 7;  // bit 7
constexpr std::uint8_t kKnownFlags = 0x7F;
constexpr std::uint8_t kRawFlags = kHasOrder | kHasTolerances;

void write_grid_number(ByteWriter& writer, const GridNumber& number) {
  writer.zigzag(number.mantissa);
  writer.zigzag(number.exponent);
}

GridNumber read_grid_number(ByteReader& reader, bool& fits) {
  const std::int64_t mantissa = reader.zigzag();
  const std::int64_t exponent = reader.zigzag();
  constexpr std::int64_t kLimit = std::numeric_limits<std::int32_t>::max();
  if (exponent > kLimit || exponent < -kLimit) fits = false;
  return {mantissa, fits ? static_cast<std::int32_t>(exponent) : 0};
}

bool has_one_step(const Lattice& lattice) {
  return lattice.step[0] == lattice.step[1] && lattice.step[1] == lattice.step[2];
}

Result<Lattice> read_lattice(ByteReader& reader, LatticeKind kind, bool one_step) {
  Lattice lattice;
  lattice.kind = kind;
  bool fits = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_repeated = one_step && axis > 0;
    lattice.step[axis] = is_repeated ? lattice.step[0] : read_grid_number(reader, fits);
  }
  for (GridNumber& origin : lattice.origin) origin = read_grid_number(reader, fits);
  if (reader.failed()) return reader.error("lattice");
  if (!fits || !lattice.is_sane() || one_step != has_one_step(lattice)) {
    return Error{ErrorCode::malformed, "the lattice makes no sense", reader.position()};
  }
  return lattice;
}

Status read_acceptance(ByteReader& reader, BlobHeader& header) {
  const std::uint64_t rule_set = reader.varint();
  Tolerances tolerances = kImpliedTolerances;
  if (header.has(kHasTolerances)) {
    tolerances.planarity_metres = reader.f64();
    tolerances.planarity_degrees = reader.f64();
    tolerances.snap_metres = reader.f64();
  }
  if (reader.failed()) return reader.error("acceptance");
  const bool is_number = std::isfinite(tolerances.planarity_metres) &&
                         std::isfinite(tolerances.planarity_degrees) &&
                         std::isfinite(tolerances.snap_metres);
  const bool is_implied = header.has(kHasTolerances) && tolerances == kImpliedTolerances;
  if (!is_number || is_implied || rule_set > 0xFFFF) {
    return Error{ErrorCode::malformed, "the acceptance makes no sense", reader.position()};
  }
  header.acceptance.tolerances = tolerances;
  header.acceptance.rule_set = static_cast<std::uint16_t>(rule_set);
  return Done{};
}

Status read_mode(ByteReader& reader, BlobHeader& header, std::uint8_t& mode_byte) {
  const std::uint8_t first = reader.u8();
  const std::uint8_t second = reader.u8();
  const std::uint8_t version = reader.u8();
  mode_byte = reader.u8();
  header.flags = reader.u8();
  if (reader.failed()) return reader.error("header");
  if (first != kMagic[0] || second != kMagic[1]) {
    return Error{ErrorCode::malformed, "this is no blob: it does not start with WT", 0};
  }
  if (version != kFormatVersion) {
    return Error{ErrorCode::unsupported,
                 "format version " + std::to_string(version) + "; this program reads version 0", 2};
  }
  const std::uint8_t mode = mode_byte & 0x0F;
  if (mode > static_cast<std::uint8_t>(Mode::bitmap)) {
    return Error{ErrorCode::unsupported, "mode " + std::to_string(mode) + " is unknown", 3};
  }
  header.mode = static_cast<Mode>(mode);
  const std::uint8_t known = header.mode == Mode::raw ? kRawFlags : kKnownFlags;
  if ((header.flags & ~known) != 0) {
    return Error{ErrorCode::unsupported, "a flag of the blob is unknown", 4};
  }
  return Done{};
}

void append_indices(ByteWriter& writer, const std::vector<Index>& indices) {
  writer.u32(static_cast<std::uint32_t>(indices.size()));
  for (const Index index : indices) writer.u32(index);
}

void append_acceptance(ByteWriter& writer, const BlobHeader& header) {
  const Tolerances& tolerances = header.acceptance.tolerances;
  writer.f64(tolerances.planarity_metres);
  writer.f64(tolerances.planarity_degrees);
  writer.f64(tolerances.snap_metres);
  writer.u8(static_cast<std::uint8_t>(header.acceptance.proof));
  writer.u16(header.acceptance.rule_set);
}

void append_lattice(ByteWriter& writer, const Lattice& lattice) {
  writer.u8(static_cast<std::uint8_t>(lattice.kind));
  for (const auto* numbers : {&lattice.step, &lattice.origin}) {
    for (const GridNumber& number : *numbers) {
      writer.u64(static_cast<std::uint64_t>(number.mantissa));
      writer.u32(static_cast<std::uint32_t>(number.exponent));
    }
  }
}

}  // namespace

void write_header(ByteWriter& writer, const BlobHeader& header) {
  const bool one_step = has_one_step(header.lattice);
  writer.u8(kMagic[0]);
  writer.u8(kMagic[1]);
  writer.u8(kFormatVersion);
  writer.u8(
      static_cast<std::uint8_t>(static_cast<unsigned>(header.mode) |
                                static_cast<unsigned>(header.lattice.kind) << kKindShift |
                                static_cast<unsigned>(header.acceptance.proof) << kProofShift |
                                static_cast<unsigned>(one_step) << kOneStepShift));
  writer.u8(header.flags);
  writer.varint(header.acceptance.rule_set);
  if (header.has(kHasTolerances)) {
    writer.f64(header.acceptance.tolerances.planarity_metres);
    writer.f64(header.acceptance.tolerances.planarity_degrees);
    writer.f64(header.acceptance.tolerances.snap_metres);
  }
  writer.varint(header.srid);
  for (std::size_t axis = 0; axis < (one_step ? 1U : 3U); ++axis) {
    write_grid_number(writer, header.lattice.step[axis]);
  }
  for (const GridNumber& origin : header.lattice.origin) write_grid_number(writer, origin);
}

Result<BlobHeader> read_header(ByteReader& reader) {
  BlobHeader header;
  std::uint8_t mode_byte = 0;
  if (auto status = read_mode(reader, header, mode_byte); !status) return status.error();
  const unsigned kind = (mode_byte >> kKindShift) & 3U;
  if (kind > static_cast<unsigned>(LatticeKind::float64)) {
    return Error{ErrorCode::unsupported, "lattice kind 3 is unknown", 3};
  }
  header.acceptance.proof = static_cast<Proof>((mode_byte >> kProofShift) & 1U);
  if (auto status = read_acceptance(reader, header); !status) return status.error();
  const std::uint64_t srid = reader.varint();
  if (reader.failed() || srid > std::numeric_limits<std::uint32_t>::max()) {
    return reader.error("SRID");
  }
  header.srid = static_cast<std::uint32_t>(srid);
  const bool one_step = ((mode_byte >> kOneStepShift) & 1U) != 0;
  auto lattice = read_lattice(reader, static_cast<LatticeKind>(kind), one_step);
  if (!lattice) return lattice.error();
  header.lattice = *lattice;
  return header;
}

std::uint32_t checksum_of(const BlobHeader& header, const Solid& canonical,
                          const SourceOrder& order) {
  const SolidArrays& arrays = canonical.arrays();
  ByteWriter writer;
  append_acceptance(writer, header);
  writer.u32(header.srid);
  append_lattice(writer, header.lattice);
  writer.u32(canonical.vertex_count());
  for (const Point& p : arrays.vertices) {
    for (int axis = 0; axis < 3; ++axis) writer.f64(p[axis]);
  }
  for (const auto* indices : {&arrays.ring_vertices, &arrays.ring_offsets, &arrays.facet_offsets,
                              &arrays.shell_offsets}) {
    append_indices(writer, *indices);
  }
  if (!order.is_identity()) {
    for (const auto* indices :
         {&order.vertex, &order.shell, &order.facet, &order.ring, &order.ring_start}) {
      append_indices(writer, *indices);
    }
  }
  return crc32c(writer.bytes());
}

}  // namespace watertight
