// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/page/solid_checksum.h"

#include <vector>

#include "base/bytes.h"
#include "base/checksum.h"

namespace watertight::codec {
namespace {

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
