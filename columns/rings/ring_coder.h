// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the vertices of rings of surfaces. Along a ring of an oriented surface, the next vertex is
// likely the one that an earlier ring has before this vertex: the two share an edge, in opposite
// directions. Else it is a new vertex, or one that was used lately. Internal to columns/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "columns/flat_map.h"
#include "columns/models/context_mixer.h"

namespace watertight::columns {

using VertexNumber = std::int64_t;

/// Rings in order, in one array.
class RingList {
 public:
  std::size_t size() const { return ends_.size(); }
  std::span<const VertexNumber> operator[](std::size_t ring) const {
    const std::size_t begin = ring == 0 ? 0 : ends_[ring - 1];
    return std::span(vertices_).subspan(begin, ends_[ring] - begin);
  }
  void add(std::span<const VertexNumber> ring) {
    vertices_.insert(vertices_.end(), ring.begin(), ring.end());
    ends_.push_back(vertices_.size());
  }
  void clear() {
    vertices_.clear();
    ends_.clear();
  }

 private:
  std::vector<VertexNumber> vertices_;
  std::vector<std::size_t> ends_;
};

class RingCoder {
 public:
  /// Starts another feature.
  void restart();
  /// Codes the vertex at this position of a ring, or that no vertex is there; position 0 begins a
  /// ring. Requires 0 <= vertex < kMostVertexNumbers; a reader fails beyond that.
  std::optional<VertexNumber> code(EntropyStream& stream, ContextMixer& mixer,
                                   std::uint32_t position, std::optional<VertexNumber> vertex);
  /// All rings so far, of which the last one is complete then.
  const RingList& finish();

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
  /// The end of the vertices in `recent_` that may be named by a rank. Those of the ring come
  /// later.
  std::size_t end_of_ranked() const;
  std::optional<std::uint64_t> rank_of(const Guess& guess, VertexNumber vertex) const;
  std::optional<VertexNumber> of_rank(const Guess& guess, std::uint64_t rank) const;
  void end_ring();
  void take(VertexNumber vertex, Kind kind);

  struct Neighbours {
    VertexNumber before = 0;
    VertexNumber after = 0;
  };
  FlatMap<VertexNumber, Neighbours> neighbours_;  // of a vertex in the ring that used it last
  std::vector<VertexNumber> recent_;              // the vertex used last is at the end
  RingList rings_;
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
