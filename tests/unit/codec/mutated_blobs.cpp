// SPDX-License-Identifier: GPL-3.0-or-later
#include "mutated_blobs.h"

#include <algorithm>

#include "codec/encode_boundary.h"

namespace watertight::generated {
namespace {

using Offset = std::ptrdiff_t;

void change(Bytes& blob, const std::vector<Bytes>& blobs, Random& random) {
  if (blob.empty()) {
    blob.push_back(static_cast<std::uint8_t>(random.below(256)));
    return;
  }
  const auto at = static_cast<Offset>(random.below(blob.size()));
  const auto length = static_cast<Offset>(
      std::min<std::uint64_t>(1 + random.below(16), blob.size() - static_cast<std::uint64_t>(at)));
  std::uint8_t& byte = blob[static_cast<std::size_t>(at)];
  switch (random.below(7)) {
    case 0:
      byte = static_cast<std::uint8_t>(byte ^ (1U << random.below(8)));
      break;
    case 1:
      byte = static_cast<std::uint8_t>(random.below(256));
      break;
    case 2:
      blob.erase(blob.begin() + at, blob.begin() + at + length);
      break;
    case 3: {
      const Bytes copy(blob.begin() + at, blob.begin() + at + length);
      blob.insert(blob.begin() + at, copy.begin(), copy.end());
      break;
    }
    case 4: {
      // The same stretch of another blob.
      const Bytes& other = blobs[random.below(blobs.size())];
      for (Offset i = at; i < at + length && i < static_cast<Offset>(other.size()); ++i) {
        blob[static_cast<std::size_t>(i)] = other[static_cast<std::size_t>(i)];
      }
      break;
    }
    case 5:
      byte = random.below(2) == 0 ? 0xFF : 0x80;
      break;
    default:
      byte = static_cast<std::uint8_t>(byte + 1 - 2 * random.below(2));
      break;
  }
}

}  // namespace

std::vector<Bytes> seed_blobs(std::uint64_t seed) {
  std::vector<Bytes> blobs;
  for (const auto& [name, boundary] : all(seed)) {
    for (const Mode mode :
         {Mode::raw, Mode::bitmap, Mode::walk, Mode::polygon, Mode::parallelogram}) {
      for (const bool keep_order : {true, false}) {
        auto blob = encode_boundary(boundary, {}, {.mode = mode, .keep_order = keep_order});
        if (blob) blobs.push_back(std::move(blob).value());
      }
    }
  }
  const Certificate certificate = schoenhardt_certificate();
  auto blob =
      encode_boundary(schoenhardt(), {}, {.mode = Mode::bitmap, .certificate = &certificate});
  if (blob) blobs.push_back(std::move(blob).value());
  return blobs;
}

Bytes mutated(const std::vector<Bytes>& blobs, Random& random) {
  Bytes blob = blobs[random.below(blobs.size())];
  for (std::uint64_t i = random.below(8) / 3; i < 3; ++i) change(blob, blobs, random);
  return blob;
}

}  // namespace watertight::generated
