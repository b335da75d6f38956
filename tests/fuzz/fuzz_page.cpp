// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the page decoder, with and without its check of checksum and end. Solids
// that decode, or would decode with a right checksum and a right end, must be boundaries that come
// back in the same mode.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "codec/encode_boundary.h"
#include "codec/page.h"
#include "tests/generated/mutated_blobs.h"

namespace {

using namespace watertight;

void check(const Decoded& decoded) {
  const auto boundary = OrientedBoundary::make(decoded.solid);
  if (!boundary) std::abort();
  const Acceptance& acceptance = decoded.info.acceptance;
  if (!codec::encode_boundary(*boundary, acceptance, {.mode = Mode::raw})) std::abort();
  const auto again = codec::encode_boundary(*boundary, acceptance, {.mode = decoded.info.mode});
  if (again) return;
  // A mode may decline a solid that it has read; it must not write a blob that it cannot read.
  if (again.error().message.find("decode") != std::string::npos) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Limits limits{
      .bytes = 1U << 20U, .vertices = 5000, .facets = 5000, .rings = 5000, .shells = 1000};
  const ByteView bytes(data, size);
  if (const auto page = codec::decode_page(bytes, limits)) {
    for (const Decoded& decoded : *page) check(decoded);
  }
  if (const auto unchecked = generated::decode_unchecked(bytes, limits)) {
    for (const Decoded& decoded : *unchecked) check(decoded);
  }
  return 0;
}
