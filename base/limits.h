// SPDX-License-Identifier: GPL-3.0-or-later
//
// Limits on the cost of one input. Every reader, decoder and validator takes them and answers
// ErrorCode::limit_exceeded beyond them, before it allocates.
#pragma once

#include <cstdint>

namespace watertight {

struct Limits {
  std::uint64_t bytes = 1ULL << 30;     // of one document or blob
  std::uint64_t vertices = 10'000'000;  // of one solid (and of one feature)
  std::uint64_t facets = 10'000'000;    // of one solid
  std::uint64_t rings = 10'000'000;     // of one solid
  std::uint64_t shells = 1'000'000;     // of one solid
  std::uint32_t nesting = 64;           // depth of nested arrays and objects in a document
  std::uint64_t findings = 10'000;      // kept per report; more are counted only
};

}  // namespace watertight
