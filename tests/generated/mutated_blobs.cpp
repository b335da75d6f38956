// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/generated/mutated_blobs.h"

#include <algorithm>
#include <array>
#include <utility>

#include "codec/encode_boundary.h"
#include "codec/page.h"
#include "codec/page/container.h"
#include "tests/generated/generated_variety.h"

namespace watertight::generated {
namespace {

using Offset = std::ptrdiff_t;

constexpr std::array kModes{Mode::raw, Mode::bitmap, Mode::walk, Mode::polygon,
                            Mode::parallelogram};

/// Replaces the end of a blob by many equal or random bytes. Adaptive models come to expect one
/// answer, so that a decoder reads cheap decisions without end.
void replace_tail(Bytes& blob, Random& random) {
  blob.resize(random.below(blob.size()) + 1);
  const std::uint64_t size = 1 + random.below(std::uint64_t{16} << random.below(10));
  const auto byte = static_cast<std::uint8_t>(random.below(256));
  const std::uint64_t kind = random.below(4);
  for (std::uint64_t i = 0; i < size; ++i) {
    blob.push_back(kind == 0   ? std::uint8_t{0}
                   : kind == 1 ? std::uint8_t{0xFF}
                   : kind == 2 ? byte
                               : static_cast<std::uint8_t>(random.below(256)));
  }
}

void change(Bytes& blob, const std::vector<Bytes>& blobs, Random& random) {
  if (blob.empty()) {
    blob.push_back(static_cast<std::uint8_t>(random.below(256)));
    return;
  }
  const auto at = static_cast<Offset>(random.below(blob.size()));
  const auto length = static_cast<Offset>(
      std::min<std::uint64_t>(1 + random.below(16), blob.size() - static_cast<std::uint64_t>(at)));
  std::uint8_t& byte = blob[static_cast<std::size_t>(at)];
  switch (random.below(8)) {
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
      // Copies the bytes at the same offsets of another blob.
      const Bytes& other = blobs[random.below(blobs.size())];
      for (Offset i = at; i < at + length && i < static_cast<Offset>(other.size()); ++i) {
        blob[static_cast<std::size_t>(i)] = other[static_cast<std::size_t>(i)];
      }
      break;
    }
    case 5:
      byte = random.below(2) == 0 ? 0xFF : 0x80;
      break;
    case 6:
      if (random.below(8) == 0) replace_tail(blob, random);
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
    for (const Mode mode : kModes) {
      for (const bool keep_order : {true, false}) {
        auto blob = codec::encode_boundary(boundary, {}, {.mode = mode, .keep_order = keep_order});
        if (blob) blobs.push_back(std::move(blob).value());
      }
    }
  }
  const delaunay::Certificate certificate = schoenhardt_certificate();
  auto blob = codec::encode_boundary(schoenhardt(), {},
                                     {.mode = Mode::bitmap, .certificate = &certificate});
  if (blob) blobs.push_back(std::move(blob).value());
  return blobs;
}

std::vector<Bytes> seed_pages(std::uint64_t seed) {
  std::vector<Bytes> pages;
  Random random(seed);
  for (int i = 0; i < 24; ++i) {
    const auto solids = random_page(random, static_cast<Index>(1 + random.below(6)), 40);
    std::vector<const OrientedBoundary*> boundaries;
    for (const NamedBoundary& solid : solids) boundaries.push_back(&solid.boundary);
    for (const Mode mode : kModes) {
      auto page =
          codec::encode_boundaries(boundaries, {}, {.mode = mode, .keep_order = i % 2 == 0});
      if (page) pages.push_back(std::move(page).value());
    }
    auto page = codec::encode_boundaries(boundaries, {}, {});
    if (page) pages.push_back(std::move(page).value());
  }
  return pages;
}

Bytes mutated(const std::vector<Bytes>& blobs, Random& random) {
  Bytes blob = blobs[random.below(blobs.size())];
  for (std::uint64_t i = random.below(8) / 3; i < 3; ++i) change(blob, blobs, random);
  return blob;
}

Result<std::vector<Decoded>> decode_unchecked(ByteView bytes, const Limits& limits) {
  constexpr std::size_t kHeader = 4;
  const Error malformed{ErrorCode::malformed, "no header"};
  if (bytes.size() < kHeader) return malformed;
  codec::StoredPage page;
  page.kind = (bytes[2] & 0x80U) != 0 ? codec::PageKind::page : codec::PageKind::blob;
  page.contents.models = bytes[3];
  auto models = codec::ModelSet::make(page.contents.models);
  if (!models) return models.error();
  const ByteView rest = bytes.subspan(kHeader);
  codec::EntropyStream stream = codec::EntropyStream::reader(rest);
  const std::uint64_t count =
      page.kind == codec::PageKind::page ? stream.code_uniform(0, codec::kMaxPageSolids) + 1 : 1;
  if (auto status =
          codec::code_frame(stream, (*models)[codec::ModelPart::frame], page.contents.frame);
      !status) {
    return status.error();
  }
  codec::SolidCoder coder(stream, *models, page.contents.frame,
                          codec::limits_of_stream(rest.size(), limits));
  std::vector<Decoded> solids;
  for (std::uint64_t i = 0; i < count; ++i) {
    codec::PageSolid solid;
    if (auto status = coder.code(solid); !status) break;
    page.contents.solids.push_back(std::move(solid));
    page.costs.emplace_back();
    auto decoded = codec::decoded_of(page, page.contents.solids.size() - 1);
    if (!decoded) return decoded.error();
    solids.push_back(std::move(decoded).value());
  }
  if (solids.empty()) return malformed;
  return solids;
}

}  // namespace watertight::generated
