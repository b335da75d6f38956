// SPDX-License-Identifier: GPL-3.0-or-later
//
// Limits on the cost of one input. Every reader, decoder and validator takes them and answers
// ErrorCode::limit_exceeded beyond them, before it allocates.
#pragma once

#include <cstdint>

namespace watertight {

struct Limits {
  std::uint64_t bytes = 1ULL << 30;     // the most bytes of a document or blob
  std::uint64_t vertices = 10'000'000;  // the most vertices of a solid (and of a feature)
  std::uint64_t facets = 10'000'000;    // the most facets of a solid
  std::uint64_t rings = 10'000'000;     // the most rings of a solid
  std::uint64_t shells = 1'000'000;     // the most shells of a solid
  std::uint32_t nesting = 64;           // the deepest nesting of arrays and objects in a document
  std::uint64_t findings = 10'000;      // the most findings kept in a report; more are only counted
};

}  // namespace watertight
