// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_parallelogram/front.h"

#include <algorithm>

namespace watertight::codec::parallelogram {
namespace {

/// A corner that changes enters the queue anew, and its older entry becomes stale. Stale
/// entries are dropped when the queue holds more than this many and two for each open gate.
constexpr std::size_t kMostStale = 4096;

}  // namespace

double SurfaceFront::angle(Index at, Index from, Index to) const {
  return angle_between(centres_[from] - centres_[at], centres_[to] - centres_[at]);
}

Index SurfaceFront::add_gate(Index side, Index half_edge) {
  Gate gate;
  gate.start = geometry::start_of(triangles_, side);
  gate.end = geometry::end_of(triangles_, side);
  gate.apex = geometry::corner_of(triangles_, side);
  gate.side = side;
  gate.half_edge = half_edge;
  gates_.push_back(gate);
  ++open_count_;
  return static_cast<Index>(gates_.size() - 1);
}

void SurfaceFront::pair(Index side, Index other) {
  twin_[side] = other;
  twin_[other] = side;
}

void SurfaceFront::link(Index gate, Index next) {
  gates_[gate].next = next;
  gates_[next].previous = gate;
}

void SurfaceFront::set_room(Index gate, double room) {
  Gate& changed = gates_[gate];
  changed.room = room;
  changed.is_refused = false;
  waiting_.push_back({room, turns_++, gate, ++changed.version});
  std::push_heap(waiting_.begin(), waiting_.end(), is_later);
  if (waiting_.size() > kMostStale + 2 * std::size_t{open_count_}) forget_stale();
}

/// Drops stale entries. The next corner stays the same: no two entries are equal in the order of
/// the queue.
void SurfaceFront::forget_stale() {
  std::erase_if(waiting_, [&](const Waiting& corner) { return is_stale(corner); });
  std::make_heap(waiting_.begin(), waiting_.end(), is_later);
}

bool SurfaceFront::is_stale(const Waiting& corner) const {
  const Gate& gate = gates_[corner.gate];
  return !gate.is_open || gate.version != corner.version;
}

Index SurfaceFront::add_triangle(const Triangle& triangle) {
  triangles_.push_back(triangle);
  for (const Index vertex : triangle) {
    if (vertex >= degrees_.size()) degrees_.resize(std::size_t{vertex} + 1, 0);
    ++degrees_[vertex];
  }
  twin_.insert(twin_.end(), 3, kNone);
  return static_cast<Index>(twin_.size() - 3);
}

void SurfaceFront::drop(Index gate) {
  gates_[gate].is_open = false;
  --open_count_;
}

void SurfaceFront::add_seed(const Triangle& t, const std::array<Index, 3>& half_edges) {
  const Index side = add_triangle(t);
  const Index first = add_gate(side, half_edges[0]);
  const Index second = add_gate(side + 1, half_edges[1]);
  const Index third = add_gate(side + 2, half_edges[2]);
  link(first, second);
  link(second, third);
  link(third, first);
  set_room(first, 2 * kHalfTurn - angle(t[1], t[0], t[2]));
  set_room(second, 2 * kHalfTurn - angle(t[2], t[0], t[1]));
  set_room(third, 2 * kHalfTurn - angle(t[0], t[1], t[2]));
}

/// Puts the triangle beyond `gate` that ends at `tip`, and its two gates, in place of the gate. The
/// new gates are linked with the loop outside of them, but not with each other.
SurfaceFront::NewGates SurfaceFront::replace_gate(Index gate, Index tip,
                                                  const std::array<Index, 2>& half_edges) {
  const Gate& old = gates_[gate];
  const Index side = add_triangle({old.end, old.start, tip});
  pair(old.side, side);
  drop(gate);
  const Index rise = add_gate(side + 1, half_edges[0]);
  const Index fall = add_gate(side + 2, half_edges[1]);
  link(old.previous, rise);
  link(fall, old.next);
  set_room(old.previous, gates_[old.previous].room - angle(old.start, old.end, tip));
  return {rise, fall};
}

void SurfaceFront::add_vertex(Index gate, Index w, const std::array<Index, 2>& half_edges) {
  const Gate old = gates_[gate];
  const auto [rise, fall] = replace_gate(gate, w, half_edges);
  link(rise, fall);
  set_room(rise, 2 * kHalfTurn - angle(w, old.start, old.end));
  set_room(fall, old.room - angle(old.end, old.start, w));
}

void SurfaceFront::close_corner(Index gate, Index half_edge) {
  const Gate old = gates_[gate];
  const Gate beside = gates_[old.next];
  const Index u = old.start;
  const Index v = old.end;
  const Index w = beside.end;
  const Index side = add_triangle({v, u, w});
  pair(old.side, side);
  pair(beside.side, side + 2);
  drop(gate);
  drop(old.next);
  if (beside.next == old.previous) {
    pair(gates_[beside.next].side, side + 1);
    drop(beside.next);
    return;
  }
  const Index across = add_gate(side + 1, half_edge);
  link(old.previous, across);
  link(across, beside.next);
  set_room(old.previous, gates_[old.previous].room - angle(u, v, w));
  set_room(across, beside.room - angle(w, u, v));
}

void SurfaceFront::join_corner(Index gate, Index other, const std::array<Index, 2>& half_edges) {
  const Gate old = gates_[gate];
  const Index w = gates_[other].end;
  const Index after = gates_[other].next;
  const auto [rise, fall] = replace_gate(gate, w, half_edges);
  link(rise, after);
  link(other, fall);
  set_room(rise, angle(w, old.start, gates_[after].end));
  set_room(other, angle(w, old.end, gates_[other].start));
  set_room(fall, old.room - angle(old.end, old.start, w));
}

Index SurfaceFront::next_corner() {
  while (!waiting_.empty()) {
    if (!is_stale(waiting_.front())) return waiting_.front().gate;
    std::pop_heap(waiting_.begin(), waiting_.end(), is_later);
    waiting_.pop_back();
  }
  return kNone;
}

}  // namespace watertight::codec::parallelogram
