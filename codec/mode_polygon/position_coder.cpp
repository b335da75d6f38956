// SPDX-License-Identifier: GPL-3.0-or-later
//
// The sequence of steps for a vertex, and its column. position_coder_heights.cpp codes its height.
#include "codec/mode_polygon/position_coder.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "codec/mode_polygon/families.h"
#include "codec/mode_polygon/nearest_columns.h"

namespace watertight::codec::polygon {

void PositionCoder::find_copies() {
  same_as_.resize(surface_.vertex_count());
  for (Index i = 0; i < same_as_.size(); ++i) same_as_[i] = i;
  if (truth_.empty()) return;
  std::vector<Index> order = same_as_;
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return truth_[a] != truth_[b] ? truth_[a] < truth_[b] : a < b;
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (truth_[order[i]] != truth_[order[i - 1]]) continue;
    same_as_[order[i]] = same_as_[order[i - 1]];
    has_copies_ = true;
  }
}

Result<CodedPositions> PositionCoder::run() {
  find_copies();
  has_copies_ = models_.code(stream_, kHasCopies, 0, {0}, has_copies_);
  points_.resize(surface_.vertex_count());
  stream_.enter(StreamPart::position);
  for (current_ = 0; current_ < surface_.vertex_count() && !stream_.failed(); ++current_) {
    if (current_ == 0 || !has_copies_ || !code_copy(current_)) code_vertex(current_);
    stream_.enter(StreamPart::coordinates);
    learn(current_);
  }
  if (stream_.failed()) {
    return Error{truth_.empty() ? ErrorCode::malformed : ErrorCode::not_encodable,
                 "a position is out of range"};
  }
  return CodedPositions{std::move(points_), std::move(same_as_)};
}

bool PositionCoder::code_copy(Index vertex) {
  const bool is_copy = models_.code(stream_, kIsCopy, 0, {0}, same_as_[vertex] != vertex);
  if (!is_copy) return false;
  below_ = kNone;
  same_as_[vertex] =
      static_cast<Index>(stream_.code_uniform(truth_.empty() ? 0 : same_as_[vertex], vertex));
  same_as_[vertex] = same_as_[same_as_[vertex]];
  points_[vertex] = points_[same_as_[vertex]];
  return true;
}

void PositionCoder::code_vertex(Index vertex) {
  look_around(vertex);
  below_ = kNone;
  if (!code_upright(vertex)) code_column(vertex);
  code_height(vertex);
  for (const std::int64_t coordinate : point()) {
    if (coordinate >= kCoordinateLimit || coordinate <= -kCoordinateLimit) stream_.fail();
  }
  if (stream_.failed()) point() = {};
}

void PositionCoder::look_around(Index vertex) {
  const Index half = surface_.out_half[vertex];
  const Index ring = surface_.ring_of[half];
  const auto known = [&](Index other) { return is_known(other) ? other : kNone; };
  const Index back = surface_.previous(half);
  const Index ahead = surface_.next(half);
  before_ = known(surface_.vertex[back]);
  after_ = known(surface_.vertex[ahead]);
  before_two_ = before_ == kNone ? kNone : known(surface_.vertex[surface_.previous(back)]);
  after_two_ = after_ == kNone ? kNone : known(surface_.vertex[surface_.next(ahead)]);
  ring_size_ = surface_.ring_size(ring);
  in_first_facet_ = surface_.facet_of[ring] == 0;
  neighbors_.clear();
  facets_.clear();
  Index corner = half;
  do {
    const Index facet = surface_.facet_of[surface_.ring_of[corner]];
    facets_.push_back(facet);
    const Index twin = surface_.twin[corner];
    const Index other = surface_.vertex[twin];
    if (is_known(other)) {
      const std::uint32_t relation = other == before_ ? 0U : other == after_ ? 1U : 2U;
      neighbors_.push_back({other, facet, surface_.facet_of[surface_.ring_of[twin]], relation});
    }
    corner = surface_.twin[surface_.previous(corner)];
  } while (corner != half && facets_.size() < kFanLimit);
}

/// Whether the vertex is above or below a known neighbour.
bool PositionCoder::code_upright(Index vertex) {
  std::uint32_t number = 0;
  for (const Neighbor& neighbor : neighbors_) {
    const GridPoint& other = points_[neighbor.vertex];
    const bool is_upright =
        !truth_.empty() && truth_[vertex][0] == other[0] && truth_[vertex][1] == other[1];
    const auto kind = static_cast<std::uint32_t>(planes_[neighbor.facet].kind);
    const auto other_kind = static_cast<std::uint32_t>(planes_[neighbor.other_facet].kind);
    const std::uint32_t first = in_first_facet_ ? 1 : 0;
    const std::uint32_t uprights = uprights_[neighbor.facet] * 3U + uprights_[neighbor.other_facet];
    const std::uint32_t own = has_upright_[neighbor.vertex];
    if (models_.code(stream_, kVertical, neighbor.relation,
                     {(kind * 4 + other_kind) * 3 + own, (uprights * 3 + own) * 2 + first,
                      (capped(ring_size_ - 3, 6) * 3 + neighbor.relation) * 9 + uprights,
                      (capped(number, 3) * 4 + capped(neighbors_.size(), 4)) * 6 + own * 2 + first},
                     is_upright)) {
      point()[0] = other[0];
      point()[1] = other[1];
      below_ = neighbor.vertex;
      return true;
    }
    ++number;
  }
  return false;
}

/// Predicts the column from the known walls around the vertex, each a line seen from above: at the
/// point where two lines cross, else on the one line. False if no wall is known.
bool PositionCoder::predict_on_walls(Prediction& prediction) const {
  const FacetPlane* first = nullptr;
  for (const Index facet : facets_) {
    const FacetPlane& plane = planes_[facet];
    if (plane.kind != Kind::wall) continue;
    const Flat normal{plane.normal[0], plane.normal[1]};
    if (first == nullptr) {
      first = &plane;
      prediction.frame = Frame::wall;
      prediction.direction = {-normal.y, normal.x};
      continue;
    }
    const Flat one{first->normal[0], first->normal[1]};
    const double det = cross(one, normal);
    if (det * det < 0.03 * dot(one, one) * dot(normal, normal)) continue;
    // Where both lines meet, from the first wall's origin.
    const Flat offset{static_cast<double>(plane.origin[0] - first->origin[0]),
                      static_cast<double>(plane.origin[1] - first->origin[1])};
    const double distance = dot(normal, offset);
    const Flat meet{-one.y * distance / det, one.x * distance / det};
    prediction.frame = Frame::walls;
    prediction.base = {first->origin[0] + to_whole(meet.x), first->origin[1] + to_whole(meet.y)};
    return true;
  }
  if (first == nullptr) return false;
  // On one wall: between the neighbours if both are known, else beside the one that is.
  const Flat along = prediction.direction;
  GridColumn near = column_of(first->origin);
  if (before_ != kNone) near = column_of(points_[before_]);
  if (before_ != kNone && after_ != kNone) {
    near[0] += (points_[after_][0] - near[0]) / 2;
    near[1] += (points_[after_][1] - near[1]) / 2;
  }
  const Flat offset{static_cast<double>(near[0] - first->origin[0]),
                    static_cast<double>(near[1] - first->origin[1])};
  const double part = dot(offset, along) / dot(along, along);
  prediction.base = {first->origin[0] + to_whole(along.x * part),
                     first->origin[1] + to_whole(along.y * part)};
  return true;
}

Prediction PositionCoder::predicted_column(Index vertex) const {
  Prediction prediction;
  if (vertex == 0) return prediction;
  if (predict_on_walls(prediction)) return prediction;
  if (before_ != kNone && before_two_ != kNone && after_ != kNone && after_two_ != kNone) {
    const Flat p = flat(before_two_);
    const Flat a = flat(before_);
    const Flat b = flat(after_);
    const Flat q = flat(after_two_);
    prediction.frame = Frame::closing;
    prediction.direction = a - p;
    prediction.base = column_of(points_[before_]);
    if (ring_size_ == 4) {
      for (std::size_t i = 0; i < 2; ++i) {
        prediction.base[i] += points_[after_][i] - points_[before_two_][i];
      }
      return prediction;
    }
    // Where the perpendiculars at both neighbours meet.
    const Flat one = a - p;
    const Flat two = b - q;
    const double det = cross(one, two);
    if (det * det > 0.25 * dot(one, one) * dot(two, two)) {
      const double part = dot(two, b - a) / det;
      prediction.base[0] += to_whole(-one.y * part);
      prediction.base[1] += to_whole(one.x * part);
      return prediction;
    }
    prediction.frame = Frame::corner;
    return prediction;
  }
  if (before_ != kNone) {
    prediction.base = column_of(points_[before_]);
    prediction.frame = before_two_ != kNone ? Frame::corner : Frame::edge;
    if (before_two_ != kNone) prediction.direction = flat(before_) - flat(before_two_);
    prediction.is_steady = follow_direction(prediction.direction);
    return prediction;
  }
  prediction.frame = Frame::bare;
  prediction.base = column_of(points_[neighbors_.empty() ? vertex - 1 : neighbors_.front().vertex]);
  return prediction;
}

/// Whether the vertex stands in a column of an earlier solid.
bool PositionCoder::code_known_column(const Prediction& prediction) {
  if (memory_.columns.empty()) return false;
  const bool is_start = prediction.frame == Frame::start;
  ColumnScore score;
  score.base = prediction.base;
  score.turn = Turn(prediction.direction);
  score.across_weight = prediction.frame == Frame::corner ? 4 : 1;
  const std::vector<GridColumn> near =
      nearest_columns(memory_.columns, score, is_start ? 2048 : 64, is_start ? 2048 : 16);
  const GridColumn truth{truth_at(0), truth_at(1)};
  const auto rank = static_cast<std::size_t>(
      truth_.empty() ? 0 : std::find(near.begin(), near.end(), truth) - near.begin());
  const auto frame = static_cast<std::uint32_t>(prediction.frame);
  const std::uint32_t before = before_ == kNone ? 0U : 1U + in_known_column_[before_];
  const std::uint32_t distance =
      near.empty() ? 0U : capped(std::bit_width(score(near.front())) / 2, 12);
  const std::uint32_t context = (frame * 3 + before) * 3 + capped(known_columns_, 3);
  if (!models_.code(stream_, kKnownColumn, 0,
                    {context, distance * 3 + before, capped(current_, 8) * 3 + before},
                    !truth_.empty() && rank < near.size())) {
    return false;
  }
  const std::uint64_t coded = models_.code_number(
      stream_, kColumnRank, 0, {frame * 3 + before, distance}, truth_.empty() ? 0 : rank, 12);
  if (coded >= near.size()) {
    stream_.fail();
    return true;
  }
  point()[0] = near[coded][0];
  point()[1] = near[coded][1];
  in_known_column_[current_] = 1;
  ++known_columns_;
  return true;
}

void PositionCoder::code_column(Index vertex) {
  Prediction prediction = predicted_column(vertex);
  for (const std::int64_t coordinate : prediction.base) {
    if (coordinate < kCoordinateLimit && coordinate > -kCoordinateLimit) continue;
    prediction.base = column_of(points_[0]);  // out of all bounds: no prediction
  }
  if (prediction.frame == Frame::start) prediction.base = column_of(memory_.last_position);
  if (!code_known_column(prediction)) code_offset(prediction);
}

void PositionCoder::code_offset(const Prediction& prediction) {
  if (prediction.frame == Frame::start) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto number = memory_.is_first() ? kFirstPosition : kFirstOffset;
      const std::int64_t base = memory_.last_position[axis];
      point()[axis] =
          base + models_.code_signed(stream_, number, 0, {static_cast<std::uint32_t>(axis)},
                                     truth_at(axis) - base, kCoordinateBits);
    }
    return;
  }
  const Turn turn(prediction.direction);
  const auto frame = static_cast<std::uint32_t>(prediction.frame);
  const std::uint32_t length = length_bits(prediction.direction);
  GridColumn residual{};
  if (!truth_.empty()) {
    residual = turn.forward({truth_at(0) - prediction.base[0], truth_at(1) - prediction.base[1]});
  }
  const bool is_line = prediction.frame == Frame::wall;
  const std::size_t small = is_line ? 1 : 0;
  const std::size_t large = 1 - small;
  const std::uint32_t degree = before_ == kNone ? 0 : capped(surface_.degree[before_] - 1, 4);
  const std::uint32_t turned = before_ == kNone ? 0U : turns_[before_];
  const std::uint32_t steady = prediction.is_steady ? 1 : 0;
  const auto magnitude = [](std::int64_t value) {
    return static_cast<std::uint64_t>(value < 0 ? -value : value);
  };
  std::uint64_t size =
      models_.code_number(stream_, kAcross, frame,
                          {(capped(ring_size_ - 3, 4) * kFrames + frame) * 2 + steady,
                           capped(length, 24) / 2, (turned * 4 + degree) * 2 + in_first_facet_},
                          magnitude(residual[small]), kCoordinateBits);
  const std::uint32_t across_bits = capped(std::bit_width(size), 16);
  if (size > 0) {
    const bool is_negative = models_.code(stream_, kAcrossSign, 0,
                                          {across_bits * kFrames + frame, across_bits * 4 + turned},
                                          residual[small] < 0);
    residual[small] =
        is_negative ? -static_cast<std::int64_t>(size) : static_cast<std::int64_t>(size);
  } else {
    residual[small] = 0;
  }
  const std::uint32_t across = capped(bits_of(residual[small]), 6);
  size = models_.code_number(
      stream_, kAlong, frame,
      {frame * 6 + across, (capped(ring_size_ - 3, 4) * 2 + in_first_facet_) * 4 + turned,
       (capped(bits_of(residual[small]), 16) * 2 + steady)},
      magnitude(residual[large]), kCoordinateBits);
  if (size > 0) {
    const std::uint32_t along_bits = capped(std::bit_width(size), 16);
    const bool is_negative = models_.code(
        stream_, kAlongSign, 0,
        {along_bits * kFrames + frame, (across_bits * 4 + turned) * 2 + in_first_facet_,
         (capped(ring_size_ - 3, 8) * kFrames + frame) * 4 + turned},
        residual[large] < 0);
    residual[large] =
        is_negative ? -static_cast<std::int64_t>(size) : static_cast<std::int64_t>(size);
  } else {
    residual[large] = 0;
  }
  turns_[current_] = bits_of(residual[large]) + 2 < bits_of(residual[small]) ? 3
                     : residual[large] < 0                                   ? 2
                                                                             : 1;
  const GridColumn offset = turn.back(residual);
  for (std::size_t axis = 0; axis < 2; ++axis) point()[axis] = prediction.base[axis] + offset[axis];
}

/// Updates planes, heights, directions and vertical edges by the position of a vertex.
void PositionCoder::learn(Index vertex) {
  const GridPoint& own = points_[vertex];
  remember_height(own[2]);
  if (below_ != kNone) last_top_ = vertex;
  if (vertex > 0 && same_as_[vertex] == vertex) remember_direction(vertex);
  const Index half = surface_.out_half[vertex];
  Index corner = half;
  do {
    const Index facet = surface_.facet_of[surface_.ring_of[corner]];
    planes_[facet].add(vertex, points_);
    const Index twin = surface_.twin[corner];
    const Index other = surface_.vertex[twin];
    if (is_known(other) && points_[other][0] == own[0] && points_[other][1] == own[1]) {
      const Index other_facet = surface_.facet_of[surface_.ring_of[twin]];
      const auto count = [](std::uint8_t& counter) {
        counter = std::min<std::uint8_t>(static_cast<std::uint8_t>(counter + 1), 2);
      };
      count(uprights_[facet]);
      count(uprights_[other_facet]);
      count(has_upright_[vertex]);
      count(has_upright_[other]);
    }
    corner = surface_.twin[surface_.previous(corner)];
  } while (corner != half);
}

}  // namespace watertight::codec::polygon
