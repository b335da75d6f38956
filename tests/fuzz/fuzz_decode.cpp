// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the blob decoder. A blob that decodes must give a boundary that can be
// encoded again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "codec/encode_boundary.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace watertight;
  const Limits limits{
      .bytes = 1U << 20U, .vertices = 10'000, .facets = 10'000, .rings = 10'000, .shells = 1000};
  const auto decoded = decode(ByteView(data, size), limits);
  if (!decoded) return 0;
  const auto boundary = OrientedBoundary::make(decoded->solid);
  if (!boundary) std::abort();
  if (!codec::encode_boundary(*boundary, decoded->info.acceptance, {.mode = Mode::raw}))
    std::abort();
  return 0;
}
