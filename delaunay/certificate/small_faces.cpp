// SPDX-License-Identifier: GPL-3.0-or-later
#include "delaunay/certificate/small_faces.h"

#include <algorithm>

namespace watertight::delaunay {
namespace {

/// The vertices of the ring that a triangle lacks, as bits: one for each place in the ring, and one
/// more if the triangle has a vertex that is not in the ring.
unsigned lacking(std::span<const Index> ring, const Triangle& triangle) {
  unsigned bits = (1U << ring.size()) - 1;
  for (const Index vertex : triangle) {
    const auto place = std::find(ring.begin(), ring.end(), vertex) - ring.begin();
    bits ^= 1U << static_cast<unsigned>(place);
  }
  return bits;
}

}  // namespace

SmallFaces small_faces(std::span<const Index> ring, std::span<const Triangle> canonical,
                       std::span<const ConstrainedFace> faces) {
  if (ring.size() < 3 || ring.size() > 4) return {};
  const std::size_t count = ring.size() - 2;
  if (faces.size() != count || canonical.size() != count) return {};
  std::array<unsigned, 2> by_face{};
  std::array<unsigned, 2> by_triangle{};
  for (std::size_t i = 0; i < count; ++i) {
    by_face[i] = lacking(ring, faces[i].vertices);
    by_triangle[i] = lacking(ring, canonical[i]);
  }
  std::array<unsigned, 2> sorted = by_face;
  std::sort(sorted.begin(), sorted.end());
  std::sort(by_triangle.begin(), by_triangle.end());
  const auto [low, high] = sorted;
  const bool are_in_ring =
      count == 1 ? by_face[0] == 0 : high == low << 2U && (low == 1 || low == 2);
  if (!are_in_ring || sorted != by_triangle) return {};
  SmallFaces result;
  result.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t corner = 0;
    for (std::size_t place = 0; place < ring.size(); ++place) {
      if ((by_face[i] >> place & 1U) == 0) result.triangles[i][corner++] = ring[place];
    }
  }
  return result;
}

}  // namespace watertight::delaunay
