// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the vertices of rings of surfaces. Along a ring of an oriented surface, the next vertex is
// likely the one that an earlier ring has before this vertex: the two share an edge, in opposite
// directions. Else it is a new vertex, or one that was used lately. Internal to columns/.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "columns/models/context_mixer.h"

namespace watertight::columns {

using VertexNumber = std::int64_t;

class RingCoder {
 public:
  /// Starts another feature.
  void restart();
  /// Codes the vertex at this position of a ring; position 0 begins a ring. Requires 0 <= vertex <
  /// kMostVertexNumbers; a reader fails beyond that.
  VertexNumber code(EntropyStream& stream, ContextMixer& mixer, std::uint32_t position,
                    VertexNumber vertex);
  /// All rings so far, of which the last one is complete then.
  const std::vector<std::vector<VertexNumber>>& finish();

 private:
  enum class Kind : std::uint8_t { none, fresh, before, after, recent, far };
  struct Guess {
    std::optional<VertexNumber> before;  // precedes the last vertex in the ring that used it last
    std::optional<VertexNumber> after;   // follows the first vertex in the ring that used it last
    bool agree = false;
  };
  Guess guess(std::uint32_t position) const;
  /// Whether the vertex is one of the last 16 of the ring, and so is not the next one.
  bool is_in_ring(VertexNumber vertex) const;
  std::optional<std::uint64_t> rank_of(const Guess& guess, VertexNumber vertex) const;
  std::optional<VertexNumber> of_rank(const Guess& guess, std::uint64_t rank) const;
  void end_ring();
  void take(VertexNumber vertex, Kind kind);

  std::unordered_map<VertexNumber, VertexNumber> before_;  // the neighbours of a vertex in the
  std::unordered_map<VertexNumber, VertexNumber> after_;   // ring that used it last
  std::vector<VertexNumber> recent_;                       // the vertex used last is at the end
  std::vector<std::vector<VertexNumber>> rings_;
  std::vector<VertexNumber> ring_;
  VertexNumber largest_ = -1;
  VertexNumber last_found_ = 0;  // the last vertex that was not recent
  Kind last_kind_ = Kind::none;
  Kind before_last_kind_ = Kind::none;
  std::uint32_t last_rank_ = 0;  // its length in bits
};

/// Vertex numbers are below this.
inline constexpr VertexNumber kMostVertexNumbers = VertexNumber{1} << 32U;

}  // namespace watertight::columns
