// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sorts the many faces and tetrahedra of a complex, few of which share their first vertex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/point.h"

namespace watertight::delaunay {

/// A triangle with its vertices in increasing order.
inline Triangle sorted(const Triangle& t) {
  const Index low = std::min(t[0], t[1]);
  const Index high = std::max(t[0], t[1]);
  return {std::min(low, t[2]), std::max(low, std::min(high, t[2])), std::max(high, t[2])};
}

/// Sorts records by key_of(record), a Triangle: first by its first vertex, by counting, then the
/// few records that share this vertex. Requires first vertices below `vertex_count`. Records of
/// equal keys come in any order.
template <class Record, class KeyOf>
void sort_by_vertices(std::vector<Record>& records, std::size_t vertex_count, const KeyOf& key_of) {
  std::vector<std::size_t> ends(vertex_count + 1);
  for (const Record& record : records) ++ends[key_of(record)[0] + 1];
  for (std::size_t v = 0; v < vertex_count; ++v) ends[v + 1] += ends[v];
  std::vector<Record> sorted(records.size());
  for (const Record& record : records) sorted[ends[key_of(record)[0]]++] = record;
  const auto rest = [&](const Record& record) {
    return std::uint64_t{key_of(record)[1]} << 32 | key_of(record)[2];
  };
  std::size_t begin = 0;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
              sorted.begin() + static_cast<std::ptrdiff_t>(ends[v]),
              [&](const Record& a, const Record& b) { return rest(a) < rest(b); });
    begin = ends[v];
  }
  records.swap(sorted);
}

}  // namespace watertight::delaunay
