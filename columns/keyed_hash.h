// SPDX-License-Identifier: GPL-3.0-or-later
//
// Hashes for tables that hold what a stranger sent: nobody can choose keys that share a slot,
// since the factors are drawn anew in each process. They decide where an entry lies in memory,
// never a byte that is written. Internal to columns/.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string_view>

namespace watertight::columns {

inline const std::array<std::uint64_t, 2> kHashFactors = [] {
  std::random_device device;
  std::array<std::uint64_t, 2> factors{};
  for (std::uint64_t& factor : factors) {
    factor = (static_cast<std::uint64_t>(device()) << 32U) | device() | 1U;
  }
  return factors;
}();

/// The hash of a number. Cost: one multiplication.
inline std::uint64_t keyed_hash(std::uint64_t number) {
  __extension__ using Wide = unsigned __int128;
  const Wide product = static_cast<Wide>(number ^ kHashFactors[0]) * kHashFactors[1];
  return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64U);
}

/// The hash of a text. Cost: one multiplication for eight bytes.
inline std::uint64_t keyed_hash(std::string_view text) {
  std::uint64_t hash = keyed_hash(text.size());
  for (std::size_t at = 0; at < text.size(); at += sizeof hash) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data() + at, std::min(sizeof word, text.size() - at));
    hash = keyed_hash(hash ^ word);
  }
  return hash;
}

}  // namespace watertight::columns
