// SPDX-License-Identifier: GPL-3.0-or-later
//
// The part of PositionCoder that codes heights and remembers the directions of edges.
#include <algorithm>
#include <bit>

#include "codec/mode_polygon/families.h"
#include "codec/mode_polygon/position_coder.h"

namespace watertight::codec::polygon {

namespace {

/// The number of sources of an offered height: the vertex before in the ring, the vertex after,
/// another neighbour, the heights coded last.
constexpr std::uint32_t kSources = 4;
/// The most vertices before an edge in its ring that make the edge longer because they lie on one
/// line with it.
constexpr int kLineLimit = 8;

}  // namespace

/// Replaces `direction` by the longest of the remembered edges that are parallel or perpendicular
/// to it, turned by quarters of a full turn where needed. Returns false if no such edge is longer
/// than `direction`.
bool PositionCoder::follow_direction(Flat& direction) const {
  double longest = dot(direction, direction);
  if (longest == 0) {
    if (directions_.empty()) return false;
    direction = directions_.front();
    return true;
  }
  Flat best = direction;
  for (Flat line : directions_) {
    const double length = dot(line, line);
    if (!(length > longest)) continue;
    if (!is_along(direction, line)) line = quarter_turned(line);
    if (!is_along(direction, line)) continue;
    longest = length;
    best = dot(direction, line) < 0 ? Flat{-line.x, -line.y} : line;
  }
  const bool found = longest > dot(direction, direction);
  direction = best;
  return found;
}

void PositionCoder::remember_direction(Index vertex) {
  if (below_ != kNone || before_ == kNone) return;
  Flat edge = flat(vertex) - flat(before_);
  // Vertices before the edge in the ring make the edge longer if they lie on one line with it.
  Index half = surface_.previous(surface_.out_half[vertex]);
  const Flat last = flat(before_);
  for (int i = 0; i < kLineLimit; ++i) {
    half = surface_.previous(half);
    const Index other = surface_.vertex[half];
    if (other >= vertex) break;
    const Flat line = flat(vertex) - flat(other);
    const double off = cross(line, last - flat(other));
    if (!(off * off <= 4 * dot(line, line) && dot(line, line) > dot(edge, edge))) break;
    edge = line;
  }
  const double length = dot(edge, edge);
  if (length == 0) return;
  for (Flat& line : directions_) {
    if (!is_along(edge, line) && !is_along(edge, quarter_turned(line))) continue;
    if (length > dot(line, line)) line = edge;
    return;
  }
  if (directions_.size() == kDirectionLimit) directions_.pop_back();
  directions_.push_back(edge);
}

void PositionCoder::code_height(Index vertex) {
  if (vertex == 0) {
    code_first(2);
  } else if (!code_height_on_planes(vertex)) {
    code_other_height();
  }
}

bool PositionCoder::code_height_on_planes(Index /*vertex*/) {
  const FacetPlane* best = nullptr;
  std::uint32_t count = 0;
  std::int64_t height = 0;
  double reach = 0;
  bool agree = true;
  for (const Index facet : facets_) {
    const FacetPlane& plane = planes_[facet];
    if (plane.kind != Kind::level && plane.kind != Kind::steep) continue;
    const std::int64_t own = plane.height(column_of(point()));
    const double own_reach = plane.reach(column_of(point()));
    if (count > 0 && own != height) agree = false;
    if (best == nullptr || own_reach < reach) {
      best = &plane;
      height = own;
      reach = own_reach;
    }
    ++count;
  }
  if (best == nullptr) return false;
  const Context<2> level(best->kind == Kind::level);
  const Context<2> upright(below_ != kNone);
  const auto far = capped<8>(std::bit_width(static_cast<std::uint64_t>(to_whole(reach))) / 2);
  const std::int64_t residual =
      models_.code_signed<kPlaneResidual>(stream_, level,
                                          {combine(level, capped<3>(count - 1), Context<2>(agree)),
                                           combine(upright, in_first_facet_), combine(far, level)},
                                          truth_at(2) - height, kCoordinateBits);
  point()[2] = height + residual;
  return true;
}

void PositionCoder::code_other_height() {
  // The heights of the neighbours are offered first, then the heights that were coded last.
  std::array<std::int64_t, kHeightLimit> offered{};
  std::array<std::uint32_t, kHeightLimit> source{};
  std::uint32_t count = 0;
  const auto offer = [&](std::int64_t height, std::uint32_t kind) {
    if (count == kHeightLimit) return;
    if (below_ != kNone && height == points_[below_][2]) return;
    for (std::size_t i = 0; i < count; ++i) {
      if (offered[i] == height) return;
    }
    offered[count] = height;
    source[count++] = kind;
  };
  if (before_ != kNone) offer(points_[before_][2], 0);
  if (after_ != kNone) offer(points_[after_][2], 1);
  for (const Neighbor& neighbor : neighbors_) offer(points_[neighbor.vertex][2], 2);
  for (const std::int64_t height : levels_) offer(height, 3);
  const Context<2> upright(below_ != kNone);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Context<kSources> from(source[i]);
    if (models_.code<kKnownHeight>(stream_, upright,
                                   {combine(Context<kHeightLimit>(i), from, upright),
                                    combine(from, upright, in_first_facet_, capped<8>(ring_size_)),
                                    combine(capped<6>(count - i), capped<6>(levels_.size()))},
                                   truth_at(2) == offered[i])) {
      point()[2] = offered[i];
      return;
    }
  }
  // No offered height is right: codes the difference from a neighbour in the ring that stands in
  // another column, else from the last upright vertex, else from the neighbour in the same column.
  std::uint32_t from = 3;
  Index near = current_ - 1;
  const auto is_beside = [&](Index other) {
    return other != kNone &&
           (below_ == kNone || points_[other][0] != point()[0] || points_[other][1] != point()[1]);
  };
  if (is_beside(before_)) {
    near = before_;
    from = 0;
  } else if (is_beside(after_)) {
    near = after_;
    from = 1;
  } else if (below_ != kNone && last_top_ != kNone) {
    near = last_top_;
    from = 2;
  } else if (below_ != kNone) {
    near = below_;
  }
  point()[2] = points_[near][2] +
               models_.code_signed<kHeightResidual>(
                   stream_, upright,
                   {combine(upright, Context<4>(from), capped<4>(levels_.size())), in_first_facet_},
                   truth_at(2) - points_[near][2], kCoordinateBits);
}

void PositionCoder::remember_height(std::int64_t height) {
  const auto found = std::find(levels_.begin(), levels_.end(), height);
  if (found != levels_.end()) {
    levels_.erase(found);
  } else if (levels_.size() == kLevelLimit) {
    levels_.pop_back();
  }
  levels_.insert(levels_.begin(), height);
}

}  // namespace watertight::codec::polygon
