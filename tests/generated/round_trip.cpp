// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/generated/round_trip.h"

#include <algorithm>
#include <array>
#include <utility>

#include "codec/encode_boundary.h"
#include "codec/page.h"
#include "geometry/canonical_form.h"
#include "tests/generated/generated_variety.h"

namespace watertight::generated {
namespace {

constexpr std::array kTriedModes{Mode::raw,     Mode::bitmap,        Mode::walk,
                                 Mode::polygon, Mode::parallelogram, Mode::automatic};

std::string without_numbers(std::string message) {
  message.erase(
      std::remove_if(message.begin(), message.end(), [](char c) { return c >= '0' && c <= '9'; }),
      message.end());
  return message;
}

Solid wanted(const OrientedBoundary& boundary, bool keep_order) {
  return keep_order ? boundary.solid() : geometry::canonical_form(boundary).boundary.solid();
}

}  // namespace

void RoundTrips::fail(const std::string& name, Mode mode, const std::string& what) {
  std::string failure = name;
  failure.append(" in mode ").append(codec::to_string(mode)).append(": ").append(what);
  failures_.push_back(std::move(failure));
}

/// Counts a result, and returns true if it has bytes. A mode may decline a solid, but must not
/// write one that it cannot read; encode() finds such a solid and reports it as not encodable too.
bool RoundTrips::note(const std::string& name, const Result<Bytes>& bytes,
                      const EncodeOptions& options) {
  std::string what(codec::to_string(options.mode));
  what += ": ";
  what += bytes ? std::string("encoded") : without_numbers(bytes.error().message);
  const bool is_lost = !bytes && (options.mode == Mode::automatic || options.mode == Mode::raw ||
                                  bytes.error().message.find("decode") != std::string::npos);
  if (is_lost) fail(name, options.mode, bytes.error().message);
  ++counts_[what];
  return bool{bytes};
}

void RoundTrips::check(const std::string& name, const OrientedBoundary& boundary,
                       const Acceptance& acceptance, const EncodeOptions& options) {
  const auto blob = codec::encode_boundary(boundary, acceptance, options);
  if (!note(name, blob, options)) return;
  const auto decoded = decode(*blob);
  if (!decoded) return fail(name, options.mode, to_string(decoded.error()));
  if (!(decoded->solid == wanted(boundary, options.keep_order))) {
    return fail(name, options.mode, "another solid");
  }
  if (!(decoded->info.acceptance == acceptance)) fail(name, options.mode, "another acceptance");
}

void RoundTrips::check_page(const std::string& name, std::span<const NamedBoundary> solids,
                            const Acceptance& acceptance, const EncodeOptions& options) {
  std::vector<const OrientedBoundary*> boundaries;
  boundaries.reserve(solids.size());
  for (const NamedBoundary& solid : solids) boundaries.push_back(&solid.boundary);
  const auto page = codec::encode_boundaries(boundaries, acceptance, options);
  if (!page && page.error().code == ErrorCode::invalid_argument) {
    ++counts_["page: " + page.error().message];
    return;
  }
  if (!note(name, page, options)) return;
  const auto decoded = codec::decode_page(*page);
  if (!decoded) return fail(name, options.mode, to_string(decoded.error()));
  bool is_same = decoded->size() == solids.size();
  for (std::size_t i = 0; is_same && i < solids.size(); ++i) {
    is_same = (*decoded)[i].solid == wanted(solids[i].boundary, options.keep_order);
  }
  if (!is_same) fail(name, options.mode, "another solid");
}

void RoundTrips::check_all_modes(const std::string& name, const OrientedBoundary& boundary,
                                 const Acceptance& acceptance) {
  Random random(boundary.solid().vertex_count());
  const OrientedBoundary other = shuffled(boundary, random);
  for (const Mode mode : kTriedModes) {
    EncodeOptions options{.mode = mode};
    check(name, boundary, acceptance, options);
    options.keep_order = false;
    check(name, boundary, acceptance, options);
    const auto one = codec::encode_boundary(boundary, acceptance, options);
    const auto two = codec::encode_boundary(other, acceptance, options);
    if (bool{one} != bool{two} || (one && *one != *two)) {
      fail(name, mode, "the source order is not without a trace");
    }
  }
}

std::uint64_t RoundTrips::check_generated(std::uint64_t seed, Index largest) {
  Random random(seed);
  const Acceptance acceptance = random_acceptance(random);
  EncodeOptions options{.keep_order = random.below(2) == 0};
  std::string name = "seed " + std::to_string(seed);
  if (random.below(16) == 0) {
    const auto count = static_cast<Index>(1 + random.below(random.below(32) == 0 ? 256 : 24));
    const auto solids = random_page(random, count, std::min<Index>(largest, 2000));
    if (random.below(2) == 0) options.mode = kTriedModes[random.below(kTriedModes.size())];
    check_page(name + " page", solids, acceptance, options);
    return count;
  }
  const NamedBoundary solid = random_solid(random, random_size(random, largest));
  name += " " + solid.name;
  if (random.below(8) == 0) {
    check_all_modes(name, solid.boundary, acceptance);
    return 1;
  }
  options.mode = kTriedModes[random.below(2 * kTriedModes.size()) % (kTriedModes.size() + 3) %
                             kTriedModes.size()];
  check(name, solid.boundary, acceptance, options);
  return 1;
}

}  // namespace watertight::generated
