// SPDX-License-Identifier: GPL-3.0-or-later
//
// The walk of mode `polygon` over the facets of a surface: it writes, reads or measures them.
// Based on: M. Isenburg, "Compressing polygon mesh connectivity with degree duality prediction"
// (Graphics Interface 2002).
// Departures: facets are reached first in, first out; vertices on the front are coded by their
// steps along it instead of splits; interior rings, several shells and several components.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "codec/entropy/context.h"
#include "codec/mode_polygon/surface.h"

namespace watertight::codec::polygon {

inline constexpr Index kLoopLimit = 64;    // the most steps of a loop along the front
inline constexpr Index kGateLimit = 256;   // the most open half-edges at which an interior ring may
                                           // begin
inline constexpr Index kGateReach = 4096;  // the most half-edges that are searched for open ones
inline constexpr Index kChainLimit = 64;   // the most chains at one vertex
inline constexpr Index kUnaryLimit = 24;   // greater sizes and degrees are coded as a number
inline constexpr int kCountBits = 28;      // the most bits of a ring size or degree
inline constexpr int kGateBits = 9;        // the most bits of the number of a gate
inline constexpr int kLoopBits = 6;        // the most bits of the number of a step

// Contexts (docs/format-polygon.md, "The surface").
inline constexpr std::uint32_t kLevels = 3;      // the number of ring levels
inline constexpr Context<2> kNextShell{0U};      // decision MoreShells: one more shell?
inline constexpr Context<2> kNextComponent{1U};  // decision MoreShells: one more component?
inline constexpr Context<2> kAtNewVertex{0U};    // contexts of RingStart
inline constexpr Context<2> kAtGate{1U};
inline constexpr Context<2> kLongSize{0U};  // contexts of Long
inline constexpr Context<2> kLongDegree{1U};

/// A chain: known facets around a vertex, each beside the next. The half-edge `in` comes to the
/// vertex, `out` leaves it; neither has a twin yet.
struct Chain {
  Index in = kNone;
  Index out = kNone;
  Index next = kNone;
};

/// An edge of the ring in the making, from `vertex` to the vertex of the next edge.
struct Step {
  Index vertex = kNone;
  Index twin = kNone;   // the known half-edge that pairs with this edge, or kNone
  Index truth = kNone;  // this edge in the given surface, or kNone
};

enum class Start : std::uint8_t { fresh, gate, known };

class SurfaceWalk {
 public:
  SurfaceWalk(EntropyStream& stream, ModelBank& models, const SurfaceTruth* truth,
              const Limits& limits)
      : stream_(stream), models_(models), truth_(truth), limits_(limits) {
    reserve();
    if (truth_ == nullptr) return;
    known_as_.assign(truth_->vertex_of.size(), kNone);
    facet_done_.assign(truth_->surface.facet_count(), false);
  }

  Result<WalkedSurface> run();

 private:
  void reserve();
  // Shells and facets.
  void code_shell(Index shell);
  void code_component(Index truth_half);
  Index unvisited_half(Index shell);
  void code_facet(Index gate, Index truth_half);
  void code_exterior(Index rings, Index truth_half);
  // Rings.
  void code_ring(Index gate, Index truth_half, bool is_interior);
  void begin_at_gate(Index gate, Index truth_half);
  void begin_interior(Index truth_half);
  /// One past the last half-edge that may be the gate of an interior ring.
  Index last_gate() const {
    return gate_ + std::min(static_cast<Index>(result_.surface.vertex.size()) - gate_, kGateReach);
  }
  void begin_at_vertex(Index vertex, Index truth_half);
  void extend_forward();
  void extend_backward();
  void code_size(bool is_interior);
  void fill();
  Index chosen_chain(Index vertex, Index own);
  Index coded_target(Index slots);
  Index new_vertex();
  void append_ring();
  void turn_corner(Index in, Index out);
  // The front.
  Index chain_with_in(Index vertex, Index half) const;
  Index chain_with_out(Index vertex, Index half) const;
  void remove_chain(Index vertex, Index chain);
  void list_loop();
  // Truth.
  Index truth_next(Index half) const { return truth_ ? truth_->surface.next(half) : kNone; }
  Index truth_vertex(Index half) const { return truth_->surface.vertex[half]; }
  Index target(Index half) const { return result_.surface.vertex[result_.surface.next(half)]; }

  void fail(ErrorCode code, const char* message) {
    if (!error_) error_ = Error{code, message};
    stream_.fail();
  }
  bool stopped() const { return error_.has_value() || stream_.failed(); }
  Context<kLevels> level() const { return Context<kLevels>(ring_level_); }

  EntropyStream& stream_;
  ModelBank& models_;
  const SurfaceTruth* truth_;
  const Limits& limits_;
  std::optional<Error> error_;
  WalkedSurface result_;

  std::vector<Index> remaining_;    // vertex -> corners to come
  std::vector<Index> chain_count_;  // vertex -> number of its chains
  std::vector<Index> first_chain_;  // vertex -> its first chain
  std::vector<Chain> chains_;
  std::vector<Index> free_chains_;
  std::vector<Index> seen_in_ring_;  // vertex -> the last ring that visited it
  std::vector<std::uint8_t> level_;  // facet -> its ring level
  Index gate_ = 0;                   // the gate; all half-edges before it have twins
  std::vector<Index> half_truth_;    // half-edge -> half-edge of the truth
  std::vector<Index> known_as_;      // fan of the truth -> vertex
  std::vector<bool> facet_done_;     // facet of the truth -> whether it is coded
  Index unvisited_ = 0;              // all facets of the truth before this one are coded

  // The ring in the making: the steps backward from the gate, then the steps forward.
  std::vector<Step> backward_;
  std::vector<Step> forward_;
  Index end_ = kNone;        // the vertex reached last
  Index end_twin_ = kNone;   // the known half-edge that the last edge pairs with
  Index end_truth_ = kNone;  // the half-edge of the truth that leaves end_
  bool is_closed_ = false;
  Index size_ = 0;
  std::uint8_t ring_level_ = 0;
  Index ring_number_ = 0;
  Index last_degree_ = 3;
  std::vector<Index> loop_;  // vertices along the front from the end to the start of the ring
  bool loop_reaches_start_ = false;
};

}  // namespace watertight::codec::polygon
