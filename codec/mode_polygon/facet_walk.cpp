// SPDX-License-Identifier: GPL-3.0-or-later
//
// The part of SurfaceWalk that codes shells, facets and the beginnings of rings.
// facet_walk_ring.cpp codes the other vertices of a ring.
#include "codec/mode_polygon/facet_walk.h"

#include <algorithm>
#include <utility>

#include "codec/mode_polygon/families.h"

namespace watertight::codec::polygon {

/// Makes room for a building of the usual size, so that few of the many lists have to grow.
void SurfaceWalk::reserve() {
  constexpr std::size_t kVertices = 24;
  PolygonSurface& surface = result_.surface;
  for (auto* of_vertices : {&surface.degree, &surface.out_half, &remaining_, &chain_count_,
                            &first_chain_, &seen_in_ring_, &result_.truth_vertex}) {
    of_vertices->reserve(kVertices);
  }
  for (auto* of_facets :
       {&surface.facet_of, &surface.ring_offsets, &surface.facet_offsets, &result_.exterior}) {
    of_facets->reserve(kVertices);
  }
  for (auto* of_halves : {&surface.vertex, &surface.twin, &surface.ring_of, &half_truth_}) {
    of_halves->reserve(3 * kVertices);
  }
  chains_.reserve(kVertices);
  level_.reserve(kVertices);
}

Result<WalkedSurface> SurfaceWalk::run() {
  for (Index shell = 0; !stopped(); ++shell) {
    if (shell >= limits_.shells) {
      fail(ErrorCode::limit_exceeded, "a solid has more shells than allowed");
      break;
    }
    code_shell(shell);
    PolygonSurface& surface = result_.surface;
    surface.shell_offsets.push_back(surface.facet_count());
    const bool more = truth_ != nullptr && shell + 1 < truth_->first_half.size();
    const auto shells = combine(kNextShell, capped<2>(shell));
    if (!models_.code<kMoreShells>(stream_, {shells}, more)) break;
  }
  if (error_) return *error_;
  if (stream_.failed()) return Error{ErrorCode::malformed, "the walk over the facets ends early"};
  return std::move(result_);
}

void SurfaceWalk::code_shell(Index shell) {
  for (Index component = 0; !stopped(); ++component) {
    Index truth_half = kNone;
    if (truth_ != nullptr) {
      truth_half = component == 0 ? truth_->first_half[shell] : unvisited_half(shell);
    }
    if (component > 0) {
      const auto components = combine(kNextComponent, capped<2>(component - 1));
      if (!models_.code<kMoreShells>(stream_, {components}, truth_half != kNone)) return;
    }
    code_component(truth_half);
  }
}

Index SurfaceWalk::unvisited_half(Index shell) {
  const PolygonSurface& surface = truth_->surface;
  unvisited_ = std::max(unvisited_, surface.shell_offsets[shell]);
  while (unvisited_ < surface.shell_offsets[shell + 1] && facet_done_[unvisited_]) ++unvisited_;
  if (unvisited_ == surface.shell_offsets[shell + 1]) return kNone;
  return surface.ring_offsets[surface.facet_offsets[unvisited_]];
}

void SurfaceWalk::code_component(Index truth_half) {
  code_facet(kNone, truth_half);
  PolygonSurface& surface = result_.surface;
  for (; gate_ < surface.vertex.size() && !stopped(); ++gate_) {
    if (surface.twin[gate_] != kNone) continue;
    code_facet(gate_, truth_ ? truth_->surface.twin[half_truth_[gate_]] : kNone);
  }
}

void SurfaceWalk::code_facet(Index gate, Index truth_half) {
  PolygonSurface& surface = result_.surface;
  if (surface.facet_count() >= limits_.facets) {
    fail(ErrorCode::limit_exceeded, "a solid has more facets than allowed");
    return;
  }
  ring_level_ = 0;
  if (gate != kNone) {
    const int before = level_[surface.facet_of[surface.ring_of[gate]]];
    ring_level_ = static_cast<std::uint8_t>(capped<kLevels>(before + 1).value);
  }
  level_.push_back(ring_level_);
  code_ring(gate, truth_half, false);
  const Index size = size_;
  std::vector<Index> interiors;  // half-edges of the truth in the other rings of the facet
  if (truth_ != nullptr) {
    const PolygonSurface& truth = truth_->surface;
    const Index own = truth.ring_of[truth_half];
    const Index facet = truth.facet_of[own];
    facet_done_[facet] = true;
    for (Index ring = truth.facet_offsets[facet]; ring < truth.facet_offsets[facet + 1]; ++ring) {
      if (ring != own) interiors.push_back(truth.ring_offsets[ring]);
    }
  }
  Index rings = 1;
  for (; !stopped(); ++rings) {
    const bool more = rings <= interiors.size();
    const auto interior = capped<3>(rings - 1);
    if (!models_.code<kMoreRings>(
            stream_, {combine(interior, level()), combine(interior, capped<16>(size))}, more)) {
      break;
    }
    code_ring(kNone, more ? interiors[rings - 1] : kNone, true);
  }
  if (stopped()) return;
  code_exterior(rings, truth_half);
  surface.facet_offsets.push_back(static_cast<Index>(surface.ring_offsets.size() - 1));
}

/// Codes which ring of the last facet is the exterior one. Most often it is the first.
void SurfaceWalk::code_exterior(Index rings, Index truth_half) {
  Index exterior = 0;
  if (truth_ != nullptr) {
    // Rings are in the order of the truth, except that the ring at the gate is first: the exterior
    // ring, which is first in the truth, is ring 0 or ring 1.
    const PolygonSurface& truth = truth_->surface;
    const Index own = truth.ring_of[truth_half];
    exterior = own == truth.facet_offsets[truth.facet_of[own]] ? 0 : 1;
  }
  if (rings > 1) exterior = static_cast<Index>(stream_.code_uniform(exterior, rings));
  result_.exterior.push_back(result_.surface.facet_offsets.back() + exterior);
}

void SurfaceWalk::code_ring(Index gate, Index truth_half, bool is_interior) {
  const PolygonSurface& surface = result_.surface;
  ring_number_ = static_cast<Index>(surface.ring_offsets.size() - 1);
  if (ring_number_ >= limits_.rings) {
    fail(ErrorCode::limit_exceeded, "a solid has more rings than allowed");
    return;
  }
  backward_.clear();
  forward_.clear();
  is_closed_ = false;
  end_twin_ = kNone;
  size_ = 0;
  if (gate != kNone) {
    begin_at_gate(gate, truth_half);
  } else if (is_interior) {
    begin_interior(truth_half);
  } else {
    begin_at_vertex(kNone, truth_half);
  }
  if (stopped()) return;
  code_size(is_interior);
  fill();
  if (!stopped()) append_ring();
}

void SurfaceWalk::begin_at_gate(Index gate, Index truth_half) {
  const Index from = target(gate);
  const Index to = result_.surface.vertex[gate];
  seen_in_ring_[from] = seen_in_ring_[to] = ring_number_;
  forward_.push_back({from, gate, truth_half});
  end_ = to;
  end_twin_ = gate;
  end_truth_ = truth_next(truth_half);
  extend_forward();
  if (!is_closed_) extend_backward();
}

/// If only one corner of the end's vertex is missing, the ring must go on along the edge of the
/// neighbouring facet there, and nothing is coded. Repeats this at the next vertex.
void SurfaceWalk::extend_forward() {
  while (chain_count_[end_] == 1 && remaining_[end_] == 1 && !stopped()) {
    const Index edge = chains_[first_chain_[end_]].in;
    const Index to = result_.surface.vertex[edge];
    forward_.push_back({end_, edge, end_truth_});
    end_twin_ = edge;
    end_truth_ = end_truth_ == kNone ? kNone : truth_next(end_truth_);
    end_ = to;
    if (to == forward_.front().vertex) {
      is_closed_ = true;
      return;
    }
    if (seen_in_ring_[to] == ring_number_) return fail(ErrorCode::malformed, "a ring meets itself");
    seen_in_ring_[to] = ring_number_;
  }
}

void SurfaceWalk::extend_backward() {
  Index start = forward_.front().vertex;
  Index truth = forward_.front().truth;
  while (chain_count_[start] == 1 && remaining_[start] == 1 && !stopped()) {
    const Index edge = chains_[first_chain_[start]].out;
    start = target(edge);
    truth = truth_ ? truth_->surface.previous(truth) : kNone;
    backward_.push_back({start, edge, truth});
    if (start == end_) {
      // The last step reached the end of the ring: the edge of this step closes the ring.
      forward_.push_back(backward_.back());
      backward_.pop_back();
      is_closed_ = true;
      return;
    }
    if (seen_in_ring_[start] == ring_number_) {
      return fail(ErrorCode::malformed, "a ring meets itself");
    }
    seen_in_ring_[start] = ring_number_;
  }
}

void SurfaceWalk::begin_interior(Index truth_half) {
  Start start = Start::fresh;
  Index steps = 0;
  Index found = kNone;
  if (truth_ != nullptr) {
    const PolygonSurface& truth = truth_->surface;
    const Index ring = truth.ring_of[truth_half];
    Index steps_here = 0;
    for (Index half = gate_; half < last_gate() && steps_here < kGateLimit; ++half) {
      if (result_.surface.twin[half] != kNone) continue;
      if (truth.ring_of[truth.twin[half_truth_[half]]] == ring) {
        start = Start::gate;
        steps = steps_here;
        break;
      }
      ++steps_here;
    }
    Index best = kNone;
    if (start != Start::gate) {
      for (Index i = 0; i < truth.ring_size(ring); ++i) {
        const Index half = truth.ring_offsets[ring] + i;
        if (known_as_[truth_vertex(half)] == kNone) continue;
        if (best == kNone) best = half;
      }
      if (best != kNone) {
        start = Start::known;
        found = best;
      }
    }
  }
  const bool is_fresh = models_.code<kRingStart>(stream_, {kAtNewVertex}, start == Start::fresh);
  if (is_fresh) return begin_at_vertex(kNone, truth_half);
  if (models_.code<kRingStart>(stream_, {kAtGate}, start == Start::gate)) {
    steps = static_cast<Index>(
        models_.code_number<kGateSteps>(stream_, {kNothingKnown}, steps, kGateBits));
    Index gate = gate_;
    for (; gate < last_gate(); ++gate) {
      if (result_.surface.twin[gate] == kNone && steps-- == 0) break;
    }
    if (gate >= last_gate()) {
      return fail(ErrorCode::malformed, "an interior ring begins at no edge");
    }
    return begin_at_gate(gate, truth_ ? truth_->surface.twin[half_truth_[gate]] : kNone);
  }
  const Index vertex = truth_ ? known_as_[truth_vertex(found)] : 0;
  const auto known =
      static_cast<Index>(stream_.code_uniform(vertex, result_.surface.vertex_count()));
  begin_at_vertex(known, found);
}

/// Begins a ring at `vertex`, or at a new vertex if that is kNone.
void SurfaceWalk::begin_at_vertex(Index vertex, Index truth_half) {
  end_truth_ = truth_half;
  end_ = vertex;
  if (vertex == kNone) {
    // The degree of this vertex is coded before the size of the ring.
    end_ = new_vertex();
    if (stopped()) return;
  } else if (remaining_[vertex] == 0) {
    return fail(ErrorCode::malformed, "a ring comes to a vertex that is finished");
  }
  seen_in_ring_[end_] = ring_number_;
}

void SurfaceWalk::code_size(bool is_interior) {
  const auto run = static_cast<Index>(backward_.size() + forward_.size() + (is_closed_ ? 0 : 1));
  if (is_closed_) {
    size_ = run;
    if (run < 3) fail(ErrorCode::malformed, "a ring has fewer than 3 vertices");
    return;
  }
  list_loop();
  const Index least = std::max(run, Index{3});
  const Index truth_size =
      truth_ ? truth_->surface.ring_size(truth_->surface.ring_of[end_truth_]) : least;
  // The ring level, or kLevels for an interior ring.
  const Context<kLevels + 1> kind(is_interior ? kLevels : ring_level_);
  // The ring size that would close the loop of the front, or 0.
  const std::int64_t closing =
      loop_reaches_start_ ? std::int64_t{run} + static_cast<std::int64_t>(loop_.size()) : 0;
  const Index gate_size =
      forward_.empty() || forward_.front().twin == kNone
          ? 0
          : result_.surface.ring_size(result_.surface.ring_of[forward_.front().twin]);
  const auto few_known = capped<3>(run - 1);
  const auto known = capped<8>(run - 1);
  const auto gate_class = capped<8>(gate_size);
  const auto degree = capped<4>(last_degree_ - 2);
  for (size_ = least; size_ < least + kUnaryLimit; ++size_) {
    const auto step = capped<12>(size_ - least);
    const auto few_steps = capped<4>(size_ - least);
    const auto number = capped<16>(size_ - 3);
    const Context<5> to_closing(closing == 0 ? 0U : 1 + capped<4>(closing + 1 - size_).value);
    if (models_.code<kSize>(
            stream_, kind,
            {combine(step, known, kind), combine(number, kind),
             combine(known, to_closing, few_steps), combine(gate_class, kind, few_steps),
             combine(number, degree, few_known)},
            size_ == truth_size)) {
      return;
    }
    if (stopped()) return;
  }
  const std::uint64_t rest =
      models_.code_number<kLong>(stream_, {kLongSize}, truth_ ? truth_size - size_ : 0, kCountBits);
  size_ += static_cast<Index>(rest);
}

/// Goes along the front from the end of the ring and lists the vertices at which a new edge can
/// arrive.
void SurfaceWalk::list_loop() {
  loop_.clear();
  loop_reaches_start_ = false;
  if (chain_count_[end_] == 0) return;
  const Index start = backward_.empty() ? (forward_.empty() ? end_ : forward_.front().vertex)
                                        : backward_.back().vertex;
  const Index own = end_twin_ == kNone ? first_chain_[end_] : chain_with_out(end_, end_twin_);
  Index half = chains_[own].in;
  for (Index step = 0; step < kLoopLimit; ++step) {
    const Index vertex = result_.surface.vertex[half];
    if (vertex == start) {
      loop_reaches_start_ = true;
      return;
    }
    if (vertex == end_) return;
    if (step > 0 && remaining_[vertex] > chain_count_[vertex] &&
        seen_in_ring_[vertex] != ring_number_) {
      loop_.push_back(vertex);
    }
    half = chains_[chain_with_out(vertex, half)].in;
  }
}

Result<WalkedSurface> code_surface(EntropyStream& stream, ModelBank& models,
                                   const SurfaceTruth* truth, const Limits& limits) {
  return SurfaceWalk(stream, models, truth, limits).run();
}

}  // namespace watertight::codec::polygon
