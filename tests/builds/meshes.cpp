// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints the size of 200 meshes in mode parallelogram, whose predictions depend on every rounding,
// and a checksum of the decoded meshes.
#include <array>
#include <cstdio>

#include "base/checksum.h"
#include "codec/blob.h"
#include "codec/encode_boundary.h"
#include "tests/builds/fingerprint.h"
#include "tests/generated/generated_solids.h"
#include "tests/random.h"

namespace watertight::builds {
namespace {

/// A closed block of triangles: random heights over a grid of n x n squares above, a flat grid
/// below.
OrientedBoundary block(test::Random& random) {
  const auto n = static_cast<Index>(4 + random.below(12));
  const auto step = static_cast<double>(1 + random.below(5));
  const std::uint64_t heights = 1 + random.below(8);
  SolidArrays arrays;
  for (const bool is_top : {true, false}) {
    for (Index i = 0; i <= n; ++i) {
      for (Index j = 0; j <= n; ++j) {
        const double height = is_top ? 10 + static_cast<double>(random.below(heights)) : 0;
        arrays.vertices.push_back({i * step, j * step, height});
      }
    }
  }
  const auto top = [&](Index i, Index j) { return i * (n + 1) + j; };
  const auto low = [&](Index i, Index j) { return (n + 1) * (n + 1) + top(i, j); };
  const auto add = [&](Index a, Index b, Index c) { generated::add_facet(arrays, {{a, b, c}}); };
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      add(top(i, j), top(i + 1, j), top(i + 1, j + 1));
      add(top(i, j), top(i + 1, j + 1), top(i, j + 1));
      add(low(i, j), low(i + 1, j + 1), low(i + 1, j));
      add(low(i, j), low(i, j + 1), low(i + 1, j + 1));
    }
  }
  const auto wall = [&](Index i, Index j, Index to_i, Index to_j) {
    add(low(i, j), low(to_i, to_j), top(to_i, to_j));
    add(low(i, j), top(to_i, to_j), top(i, j));
  };
  for (Index k = 0; k < n; ++k) {
    wall(k, 0, k + 1, 0);
    wall(k + 1, n, k, n);
    wall(0, k + 1, 0, k);
    wall(n, k, n, k + 1);
  }
  arrays.end_shell();
  return generated::boundary_of(arrays);
}

}  // namespace

bool print_meshes() {
  constexpr std::uint64_t kMeshes = 200;
  for (std::uint64_t seed = 1; seed <= kMeshes; ++seed) {
    test::Random random(seed);
    const auto blob = codec::encode_boundary(block(random), {}, {.mode = Mode::parallelogram});
    const bool is_decoded = blob && decode(*blob);
    std::printf("mesh %u %zu %08x\n", static_cast<unsigned>(seed), blob ? blob->size() : 0,
                blob ? crc32c(*blob) : 0);
    if (!is_decoded) return false;
  }
  return true;
}

}  // namespace watertight::builds
