// SPDX-License-Identifier: GPL-3.0-or-later
//
// The walk of mode `polygon` over the facets of a surface, the same for all three directions.
// Based on: M. Isenburg, "Compressing polygon mesh connectivity with degree duality prediction"
// (Graphics Interface 2002).
// Departures: facets are reached first in, first out; vertices on the front are told by their steps
// along it instead of splits; interior rings, several shells and several components.
#include <algorithm>
#include <array>
#include <utility>

#include "codec/polygon_models.h"
#include "codec/polygon_surface.h"

namespace watertight {
namespace {

constexpr Index kLoopLimit = 64;   // steps along the front that are looked at
constexpr Index kGateLimit = 256;  // open half-edges among which an interior ring begins
constexpr Index kChainLimit = 64;  // unfinished fans of facets at one vertex
constexpr Index kUnaryLimit = 24;  // of ring sizes and degrees
constexpr int kCountBits = 28;     // of ring sizes and degrees
constexpr std::uint32_t kLevels = 3;

/// Facets around a vertex that are known and follow each other: `in` comes to the vertex and
/// `out` leaves it, both without twin.
struct Chain {
  Index in = kNone;
  Index out = kNone;
  Index next = kNone;
};

/// An edge of the ring in the making, from `vertex` to that of the next one.
struct Step {
  Index vertex = kNone;
  Index twin = kNone;   // the known half-edge that it pairs with
  Index truth = kNone;  // the half-edge of the truth
};

enum class Start : std::uint8_t { fresh, gate, known };

class SurfaceWalk {
 public:
  SurfaceWalk(EntropyStream& stream, ModelBank& models, const SurfaceTruth* truth,
              const Limits& limits)
      : stream_(stream), models_(models), truth_(truth), limits_(limits) {
    if (truth_ == nullptr) return;
    known_as_.assign(truth_->vertex_of.size(), kNone);
    facet_done_.assign(truth_->surface.facet_count(), false);
  }

  Result<WalkedSurface> run();

 private:
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
  bool code(std::uint32_t family, std::uint32_t selector,
            std::initializer_list<std::uint32_t> contexts, bool value) {
    return models_.code(stream_, family, selector, contexts, value);
  }

  EntropyStream& stream_;
  ModelBank& models_;
  const SurfaceTruth* truth_;
  const Limits& limits_;
  std::optional<Error> error_;
  WalkedSurface result_;

  std::vector<Index> remaining_;    // vertex -> corners to come
  std::vector<Index> chain_count_;  // vertex
  std::vector<Index> first_chain_;  // vertex
  std::vector<Chain> chains_;
  std::vector<Index> free_chains_;
  std::vector<Index> seen_in_ring_;  // vertex -> ring that visits it
  std::vector<std::uint8_t> level_;  // facet
  Index gate_ = 0;                   // all half-edges before it have twins
  std::vector<Index> half_truth_;    // half-edge -> half-edge of the truth
  std::vector<Index> known_as_;      // fan of the truth -> vertex
  std::vector<bool> facet_done_;     // of the truth
  Index unvisited_ = 0;              // facets of the truth before it are done

  // The ring in the making: the steps backward from the gate, then those forward.
  std::vector<Step> backward_;
  std::vector<Step> forward_;
  Index end_ = kNone;        // the vertex reached last
  Index end_twin_ = kNone;   // the known half-edge that the last edge pairs with
  Index end_truth_ = kNone;  // half-edge of the truth that leaves it
  bool is_closed_ = false;
  Index size_ = 0;
  std::uint8_t ring_level_ = 0;
  Index ring_number_ = 0;
  Index last_degree_ = 3;
  std::vector<Index> loop_;  // vertices along the front from the end to the start of the ring
  bool loop_reaches_start_ = false;
};

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
    if (!code(kMoreShells, 0, {capped(shell, 2)}, more)) break;
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
    if (component > 0 &&
        !code(kMoreShells, 0, {2 + capped(component - 1, 2)}, truth_half != kNone)) {
      return;
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
  ring_level_ = gate == kNone ? std::uint8_t{0}
                              : static_cast<std::uint8_t>(capped(
                                    level_[surface.facet_of[surface.ring_of[gate]]] + 1, kLevels));
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
    if (!code(
            kMoreRings, 0,
            {capped(rings - 1, 3) * 3 + ring_level_, capped(rings - 1, 3) * 16 + capped(size, 16)},
            more)) {
      break;
    }
    code_ring(kNone, more ? interiors[rings - 1] : kNone, true);
  }
  if (stopped()) return;
  code_exterior(rings, truth_half);
  surface.facet_offsets.push_back(static_cast<Index>(surface.ring_offsets.size() - 1));
}

/// Which of the rings of the last facet is the exterior one: most often the first.
void SurfaceWalk::code_exterior(Index rings, Index truth_half) {
  Index exterior = 0;
  if (truth_ != nullptr) {
    // The rings come in the order of the truth, but for the one that was reached first.
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

/// Where all facets but one are known around a vertex, the ring goes on along the known edge.
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
      // The last step was to the end of the ring: its edge closes it.
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
    for (Index half = gate_; half < result_.surface.vertex.size() && steps_here < kGateLimit;
         ++half) {
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
  const bool is_fresh = code(kRingStart, 0, {0}, start == Start::fresh);
  if (is_fresh) return begin_at_vertex(kNone, truth_half);
  if (code(kRingStart, 0, {1}, start == Start::gate)) {
    steps = static_cast<Index>(models_.code_number(stream_, kGateSteps, 0, {0}, steps, 9));
    Index gate = gate_;
    for (; gate < result_.surface.vertex.size(); ++gate) {
      if (result_.surface.twin[gate] == kNone && steps-- == 0) break;
    }
    if (gate >= result_.surface.vertex.size()) {
      return fail(ErrorCode::malformed, "an interior ring begins at no edge");
    }
    return begin_at_gate(gate, truth_ ? truth_->surface.twin[half_truth_[gate]] : kNone);
  }
  const Index vertex = truth_ ? known_as_[truth_vertex(found)] : 0;
  const auto known =
      static_cast<Index>(stream_.code_uniform(vertex, result_.surface.vertex_count()));
  begin_at_vertex(known, found);
}

/// `vertex` is kNone for a new one.
void SurfaceWalk::begin_at_vertex(Index vertex, Index truth_half) {
  end_truth_ = truth_half;
  end_ = vertex;
  if (vertex == kNone) {
    // Its degree is told before the size of the ring.
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
  const std::uint32_t place =
      is_interior ? 3U : static_cast<std::uint32_t>(ring_level_);  // 0: the first ring of all
  // The size that would close the loop of the front.
  const std::int64_t closing =
      loop_reaches_start_ ? std::int64_t{run} + static_cast<std::int64_t>(loop_.size()) : 0;
  const Index gate_size =
      forward_.empty() || forward_.front().twin == kNone
          ? 0
          : result_.surface.ring_size(result_.surface.ring_of[forward_.front().twin]);
  for (size_ = least; size_ < least + kUnaryLimit; ++size_) {
    const std::uint32_t step = capped(size_ - least, 12);
    const std::uint32_t number = capped(size_ - 3, 16);
    const std::uint32_t to_closing = closing == 0 ? 0U : 1 + capped(closing + 1 - size_, 4);
    if (code(kRingSize, place,
             {step * 32 + capped(run - 1, 8) * 4 + place, number * 4 + place,
              (capped(run - 1, 8) * 5 + to_closing) * 4 + capped(step, 4),
              (capped(gate_size, 8) * 4 + place) * 4 + capped(step, 4),
              (number * 4 + capped(last_degree_ - 2, 4)) * 3 + capped(run - 1, 3)},
             size_ == truth_size)) {
      return;
    }
    if (stopped()) return;
  }
  const std::uint64_t rest =
      models_.code_number(stream_, kLongRing, 0, {0}, truth_ ? truth_size - size_ : 0, kCountBits);
  size_ += static_cast<Index>(rest);
}

/// The vertices that follow the end of the ring along the front, those whose facets can grow.
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

/// From the end of the ring to its start, vertex by vertex.
void SurfaceWalk::fill() {
  const Index start = backward_.empty() ? (forward_.empty() ? end_ : forward_.front().vertex)
                                        : backward_.back().vertex;
  auto count = static_cast<Index>(backward_.size() + forward_.size() + 1);
  while (!is_closed_ && !stopped()) {
    const Index own = end_twin_ == kNone ? kNone : chain_with_out(end_, end_twin_);
    const Index followed = chosen_chain(end_, own);
    if (stopped()) return;
    Step step{end_, kNone, end_truth_};
    Index to = kNone;
    if (followed != kNone) {
      step.twin = chains_[followed].in;
      to = result_.surface.vertex[step.twin];
      if ((to == start) != (count == size_)) {
        return fail(ErrorCode::malformed, "a ring does not have its size");
      }
    } else if (count == size_) {
      to = start;
    }
    end_truth_ = end_truth_ == kNone ? kNone : truth_next(end_truth_);
    if (to == kNone) {
      to = coded_target(size_ - count);
      if (stopped()) return;
    }
    forward_.push_back(step);
    end_ = to;
    end_twin_ = step.twin;
    if (to == start) {
      is_closed_ = true;
      return;
    }
    if (seen_in_ring_[to] == ring_number_ || remaining_[to] == 0) {
      return fail(ErrorCode::malformed, "a ring meets itself");
    }
    seen_in_ring_[to] = ring_number_;
    ++count;
  }
}

/// The chain along whose known edge the ring goes on, or kNone if it goes on along a new edge.
/// `own` is the chain along which it came, if it did.
Index SurfaceWalk::chosen_chain(Index vertex, Index own) {
  const Index chains = chain_count_[vertex];
  const Index others = own == kNone ? chains : chains - 1;
  const Index remaining = remaining_[vertex];
  const bool is_start = forward_.empty();
  // A new edge leaves as many chains as there are, or one more; each needs a facet to come.
  const bool can_be_new = is_start || remaining > (own == kNone ? chains + 1 : chains);
  if (others == 0) {
    if (!can_be_new && own != kNone && remaining == 1) return own;
    return kNone;
  }
  Index truth_chain = kNone;
  if (truth_ != nullptr) {
    for (Index chain = first_chain_[vertex]; chain != kNone; chain = chains_[chain].next) {
      if (truth_->surface.twin[half_truth_[chains_[chain].in]] == end_truth_) truth_chain = chain;
    }
  }
  if (can_be_new &&
      !code(kFollow, 0, {capped(size_, 8), capped(remaining - chains, 4)}, truth_chain != kNone)) {
    return kNone;
  }
  std::array<Index, kChainLimit> options{};
  std::size_t count = 0;
  std::size_t chosen = 0;
  for (Index chain = first_chain_[vertex]; chain != kNone && count < kChainLimit;
       chain = chains_[chain].next) {
    if (chain == own) continue;
    if (chain == truth_chain) chosen = count;
    options[count++] = chain;
  }
  return options[count == 1 ? 0 : stream_.code_uniform(chosen, count)];
}

/// The vertex at the other end of a new edge from the end of the ring.
Index SurfaceWalk::coded_target(Index slots) {
  PolygonSurface& surface = result_.surface;
  Index truth_target = kNone;
  if (truth_ != nullptr) truth_target = known_as_[truth_vertex(end_truth_)];
  if (surface.vertex_count() == 0) return new_vertex();
  list_loop();
  const std::uint32_t loop = capped(loop_.size(), 6) * 2 + (loop_reaches_start_ ? 1 : 0);
  const std::uint32_t place = ring_level_;
  const std::uint32_t left = capped(slots - 1, 6);
  if (code(kNewVertex, 0,
           {(loop * 6 + left) * 3 + place, (capped(size_ - 3, 12) * 6 + left) * 3 + place,
            (capped(backward_.size(), 3) * 3 + capped(forward_.size(), 3)) * 12 + loop},
           truth_ != nullptr && truth_target == kNone)) {
    return new_vertex();
  }
  const auto found = std::find(loop_.begin(), loop_.end(), truth_target);
  const auto steps = static_cast<std::size_t>(found - loop_.begin());
  const bool on_loop = truth_ != nullptr && steps < loop_.size();
  if (!loop_.empty() && code(kOnLoop, 0, {loop}, on_loop)) {
    const std::uint64_t coded =
        models_.code_number(stream_, kLoopSteps, 0, {left, loop}, truth_ ? steps : 0, 6);
    if (coded >= loop_.size()) {
      fail(ErrorCode::malformed, "a ring goes beyond the front");
      return kNone;
    }
    return loop_[coded];
  }
  return static_cast<Index>(
      stream_.code_uniform(truth_ ? truth_target : 0, surface.vertex_count()));
}

Index SurfaceWalk::new_vertex() {
  PolygonSurface& surface = result_.surface;
  const Index vertex = surface.vertex_count();
  if (vertex >= limits_.vertices) {
    fail(ErrorCode::limit_exceeded, "a solid has more vertices than allowed");
    return kNone;
  }
  const Index truth_fan = truth_ ? truth_vertex(end_truth_) : kNone;
  const Index truth_degree = truth_ ? truth_->surface.degree[truth_fan] : 0;
  const std::uint32_t place = ring_level_;
  Index degree = 2;
  for (; degree < kUnaryLimit; ++degree) {
    const std::uint32_t step = capped(degree - 2, 8);
    if (code(kDegree, 0,
             {step * 3 + place, (step * 8 + capped(size_, 8)) * 3 + place,
              (step * 6 + capped(last_degree_ - 2, 6)) * 3 + place},
             degree == truth_degree)) {
      break;
    }
    if (stopped()) return kNone;
  }
  if (degree == kUnaryLimit) {
    const std::uint64_t rest = models_.code_number(
        stream_, kLongRing, 0, {1}, truth_ ? truth_degree - kUnaryLimit : 0, kCountBits);
    degree += static_cast<Index>(rest);
  }
  last_degree_ = degree;
  surface.degree.push_back(degree);
  surface.out_half.push_back(kNone);
  remaining_.push_back(degree);
  chain_count_.push_back(0);
  first_chain_.push_back(kNone);
  seen_in_ring_.push_back(kNone);
  if (truth_ != nullptr) {
    known_as_[truth_fan] = vertex;
    result_.truth_vertex.push_back(truth_fan);
  }
  return vertex;
}

void SurfaceWalk::append_ring() {
  PolygonSurface& surface = result_.surface;
  const auto first = static_cast<Index>(surface.vertex.size());
  const auto size = static_cast<Index>(backward_.size() + forward_.size());
  if (size > 0x7FFFFFFFU - first) return fail(ErrorCode::limit_exceeded, "too many edges");
  const auto append = [&](const Step& step) {
    const auto half = static_cast<Index>(surface.vertex.size());
    surface.vertex.push_back(step.vertex);
    surface.twin.push_back(step.twin);
    surface.ring_of.push_back(ring_number_);
    half_truth_.push_back(step.truth);
    if (step.twin != kNone) {
      if (surface.twin[step.twin] != kNone) fail(ErrorCode::malformed, "an edge is used twice");
      surface.twin[step.twin] = half;
    }
    if (surface.out_half[step.vertex] == kNone) surface.out_half[step.vertex] = half;
  };
  for (std::size_t i = backward_.size(); i-- > 0;) append(backward_[i]);
  for (const Step& step : forward_) append(step);
  surface.ring_offsets.push_back(first + size);
  surface.facet_of.push_back(surface.facet_count());
  for (Index i = 0; i < size && !stopped(); ++i) {
    turn_corner(first + (i == 0 ? size - 1 : i - 1), first + i);
  }
}

/// Joins a corner of a ring to the chains at its vertex.
void SurfaceWalk::turn_corner(Index in, Index out) {
  const PolygonSurface& surface = result_.surface;
  const Index vertex = surface.vertex[out];
  const Index in_twin = surface.twin[in];
  const Index out_twin = surface.twin[out];
  const Index before = in_twin == kNone ? kNone : chain_with_out(vertex, in_twin);
  const Index after = out_twin == kNone ? kNone : chain_with_in(vertex, out_twin);
  if ((in_twin != kNone && before == kNone) || (out_twin != kNone && after == kNone)) {
    return fail(ErrorCode::malformed, "an edge is used twice");
  }
  if (before != kNone && after != kNone) {
    if (before != after) chains_[before].out = chains_[after].out;
    remove_chain(vertex, after);
  } else if (before != kNone) {
    chains_[before].out = out;
  } else if (after != kNone) {
    chains_[after].in = in;
  } else {
    if (++chain_count_[vertex] > kChainLimit) {
      return fail(ErrorCode::not_encodable, "too many facets meet in a vertex");
    }
    Index chain = static_cast<Index>(chains_.size());
    if (free_chains_.empty()) {
      chains_.emplace_back();
    } else {
      chain = free_chains_.back();
      free_chains_.pop_back();
    }
    chains_[chain] = {in, out, first_chain_[vertex]};
    first_chain_[vertex] = chain;
  }
  if (remaining_[vertex] == 0) return fail(ErrorCode::malformed, "a vertex has too many facets");
  --remaining_[vertex];
  const Index chains = chain_count_[vertex];
  if (remaining_[vertex] < chains || (chains == 0 && remaining_[vertex] > 0)) {
    fail(ErrorCode::malformed, "a vertex has too few facets");
  }
}

Index SurfaceWalk::chain_with_in(Index vertex, Index half) const {
  Index chain = first_chain_[vertex];
  while (chain != kNone && chains_[chain].in != half) chain = chains_[chain].next;
  return chain;
}

Index SurfaceWalk::chain_with_out(Index vertex, Index half) const {
  Index chain = first_chain_[vertex];
  while (chain != kNone && chains_[chain].out != half) chain = chains_[chain].next;
  return chain;
}

void SurfaceWalk::remove_chain(Index vertex, Index chain) {
  Index* link = &first_chain_[vertex];
  while (*link != chain) link = &chains_[*link].next;
  *link = chains_[chain].next;
  free_chains_.push_back(chain);
  --chain_count_[vertex];
}

}  // namespace

Result<WalkedSurface> code_surface(EntropyStream& stream, ModelBank& models,
                                   const SurfaceTruth* truth, const Limits& limits) {
  return SurfaceWalk(stream, models, truth, limits).run();
}

}  // namespace watertight
