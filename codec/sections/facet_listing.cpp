// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/sections/facet_listing.h"

#include <algorithm>
#include <string>

namespace watertight::codec {
namespace {

Error malformed_listing() { return {ErrorCode::malformed, "truncated or malformed facet section"}; }

Error over_limit(const char* what, std::uint64_t limit) {
  return {ErrorCode::limit_exceeded,
          std::string("more ") + what + " in one solid than the limit of " + std::to_string(limit)};
}

std::size_t ring_size(const SolidArrays& arrays, Index ring) {
  return arrays.ring_offsets[ring + 1] - arrays.ring_offsets[ring];
}

/// Writes one facet: the size of the exterior ring with a flag for interior rings, the number and
/// the sizes of the interior rings, then the vertices of all rings.
void write_facet(ByteWriter& writer, const SolidArrays& arrays, Index facet) {
  const Index begin = arrays.facet_offsets[facet];
  const Index end = arrays.facet_offsets[facet + 1];
  const bool has_interior = end - begin > 1;
  writer.varint(std::uint64_t{ring_size(arrays, begin)} * 2 + (has_interior ? 1 : 0));
  if (has_interior) {
    writer.varint(end - begin - 1);
    for (Index ring = begin + 1; ring < end; ++ring) writer.varint(ring_size(arrays, ring));
  }
  for (Index i = arrays.ring_offsets[begin]; i < arrays.ring_offsets[end]; ++i) {
    writer.varint(arrays.ring_vertices[i]);
  }
}

class ListingReader {
 public:
  ListingReader(ByteView section, Index vertex_count, const Limits& limits)
      : reader_(section), vertex_count_(vertex_count), limits_(limits) {}

  Result<SolidArrays> read() {
    const std::uint64_t shells = count();
    if (shells > limits_.shells) return over_limit("shells", limits_.shells);
    for (std::uint64_t shell = 0; shell < shells && is_good(); ++shell) {
      const std::uint64_t facets = count();
      if (facets + arrays_.facet_offsets.size() - 1 > limits_.facets) {
        return over_limit("facets", limits_.facets);
      }
      for (std::uint64_t facet = 0; facet < facets && is_good(); ++facet) read_facet();
      arrays_.end_shell();
    }
    if (arrays_.ring_offsets.size() - 1 > limits_.rings) return over_limit("rings", limits_.rings);
    if (!is_good() || reader_.remaining() != 0) return malformed_listing();
    return std::move(arrays_);
  }

 private:
  bool is_good() const { return is_good_ && !reader_.failed(); }

  /// Reads a number of things, each of which takes at least one byte of the rest.
  std::uint64_t count() {
    const std::uint64_t value = reader_.varint();
    if (value > reader_.remaining()) is_good_ = false;
    return is_good() ? value : 0;
  }

  void read_facet() {
    const std::uint64_t first = reader_.varint();
    sizes_.assign(1, first / 2);
    if (first % 2 != 0) {
      const std::uint64_t interior = count();
      if (interior == 0) is_good_ = false;
      for (std::uint64_t i = 0; i < interior && is_good(); ++i) sizes_.push_back(reader_.varint());
    }
    for (const std::uint64_t size : sizes_) {
      if (size > reader_.remaining()) is_good_ = false;
      if (!is_good()) return;
      for (std::uint64_t i = 0; i < size; ++i) read_vertex();
      arrays_.end_ring();
    }
    arrays_.end_facet();
  }

  void read_vertex() {
    const std::uint64_t vertex = reader_.varint();
    if (vertex >= vertex_count_) is_good_ = false;
    arrays_.ring_vertices.push_back(is_good() ? static_cast<Index>(vertex) : 0);
  }

  ByteReader reader_;
  Index vertex_count_;
  const Limits& limits_;
  SolidArrays arrays_;
  std::vector<std::uint64_t> sizes_;
  bool is_good_ = true;
};

}  // namespace

Bytes write_facet_listing(const SolidArrays& arrays) {
  ByteWriter writer;
  writer.varint(arrays.shell_offsets.size() - 1);
  for (std::size_t shell = 0; shell + 1 < arrays.shell_offsets.size(); ++shell) {
    const Index begin = arrays.shell_offsets[shell];
    const Index end = arrays.shell_offsets[shell + 1];
    writer.varint(end - begin);
    for (Index facet = begin; facet < end; ++facet) write_facet(writer, arrays, facet);
  }
  return std::move(writer).bytes();
}

Result<SolidArrays> read_facet_listing(ByteView section, Index vertex_count, const Limits& limits) {
  return ListingReader(section, vertex_count, limits).read();
}

}  // namespace watertight::codec
