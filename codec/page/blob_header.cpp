// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/page/blob_header.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/checksum.h"

namespace watertight::codec {
namespace {

constexpr std::uint8_t kMagic[2] = {'W', 'T'};
constexpr int kKindShift = 4;     // bits 4-5 of the mode byte
constexpr int kProofShift = 6;    // bit 6
constexpr int kOneStepShift = 7;  // bit 7
constexpr std::uint8_t kKnownFlags = 0x7F;
constexpr std::uint8_t kRawFlags = kHasOrder | kHasTolerances;

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
    return Error{ErrorCode::malformed,
                 "the lattice has a step that is not positive or a number out of range",
                 reader.position()};
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
    return Error{ErrorCode::malformed,
                 "the acceptance has tolerances that are not finite, or that the format leaves out",
                 reader.position()};
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
    return Error{ErrorCode::malformed, "this is not a blob: it does not start with WT", 0};
  }
  if (version != 0) return Error{ErrorCode::unsupported, "not of format version 0", 2};
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

void append_acceptance(ByteWriter& writer, const Acceptance& acceptance) {
  const Tolerances& tolerances = acceptance.tolerances;
  writer.f64(tolerances.planarity_metres);
  writer.f64(tolerances.planarity_degrees);
  writer.f64(tolerances.snap_metres);
  writer.u8(static_cast<std::uint8_t>(acceptance.proof));
  writer.u16(acceptance.rule_set);
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

std::uint32_t checksum_of(const Acceptance& acceptance, const Solid& canonical,
                          const geometry::SourceOrder& order) {
  const SolidArrays& arrays = canonical.arrays();
  ByteWriter writer;
  append_acceptance(writer, acceptance);
  writer.u32(canonical.srid());
  append_lattice(writer, canonical.lattice());
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

}  // namespace watertight::codec
