// SPDX-License-Identifier: GPL-3.0-or-later
//
// The part of PositionCoder that codes a vertex step by step, and its column.
// position_coder_heights.cpp codes its height.
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
  has_copies_ = models_.code<kHasCopies>(stream_, {kNothingKnown}, has_copies_);
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
  if (!models_.code<kIsCopy>(stream_, {kNothingKnown}, same_as_[vertex] != vertex)) return false;
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
  in_first_facet_ = Context<2>(surface_.facet_of[ring] == 0);
  neighbors_.clear();
  facets_.clear();
  Index corner = half;
  do {
    const Index facet = surface_.facet_of[surface_.ring_of[corner]];
    facets_.push_back(facet);
    const Index twin = surface_.twin[corner];
    const Index other = surface_.vertex[twin];
    if (is_known(other)) {
      const Context<3> relation(other == before_ ? 0U : other == after_ ? 1U : 2U);
      neighbors_.push_back({other, facet, surface_.facet_of[surface_.ring_of[twin]], relation});
    }
    corner = surface_.twin[surface_.previous(corner)];
  } while (corner != half && facets_.size() < kFanLimit);
}

/// Codes whether the vertex is above or below a known neighbour.
bool PositionCoder::code_upright(Index vertex) {
  std::uint32_t number = 0;
  for (const Neighbor& neighbor : neighbors_) {
    const GridPoint& other = points_[neighbor.vertex];
    const bool is_upright =
        !truth_.empty() && truth_[vertex][0] == other[0] && truth_[vertex][1] == other[1];
    const Context<kPlaneKinds> kind(planes_[neighbor.facet].kind);
    const Context<kPlaneKinds> other_kind(planes_[neighbor.other_facet].kind);
    const auto uprights =
        combine(Context<3>(uprights_[neighbor.facet]), Context<3>(uprights_[neighbor.other_facet]));
    const Context<3> own(has_upright_[neighbor.vertex]);
    const Context<2> first = in_first_facet_;
    if (models_.code<kUpright>(
            stream_, neighbor.relation,
            {combine(kind, other_kind, own), combine(uprights, own, first),
             combine(capped<6>(ring_size_ - 3), neighbor.relation, uprights),
             combine(capped<3>(number), capped<4>(neighbors_.size()), own, first)},
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
/// point where two lines cross, else on the one line. Returns false if no wall is known.
bool PositionCoder::predict_on_walls(Prediction& prediction) const {
  const FacetPlane* first = nullptr;
  for (const Index facet : facets_) {
    const FacetPlane& plane = planes_[facet];
    if (plane.kind != Kind::wall) continue;
    const Flat normal{plane.normal[0], plane.normal[1]};
    if (first == nullptr) {
      first = &plane;
      prediction.frame = PredictionFrame::wall;
      prediction.direction = {-normal.y, normal.x};
      continue;
    }
    const Flat one{first->normal[0], first->normal[1]};
    const double det = cross(one, normal);
    if (det * det < kCrossing * dot(one, one) * dot(normal, normal)) continue;
    // `meet` runs from the first wall's origin to the point where both lines meet.
    const Flat offset{static_cast<double>(plane.origin[0] - first->origin[0]),
                      static_cast<double>(plane.origin[1] - first->origin[1])};
    const double distance = dot(normal, offset);
    const Flat meet{-one.y * distance / det, one.x * distance / det};
    prediction.frame = PredictionFrame::walls;
    prediction.base = {first->origin[0] + to_whole(meet.x), first->origin[1] + to_whole(meet.y)};
    return true;
  }
  if (first == nullptr) return false;
  // The base is the point of the only wall next to the vertex before, or next to the middle between
  // the vertices before and after if both are known.
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
    prediction.frame = PredictionFrame::closing;
    prediction.direction = a - p;
    prediction.base = column_of(points_[before_]);
    if (ring_size_ == 4) {
      for (std::size_t i = 0; i < 2; ++i) {
        prediction.base[i] += points_[after_][i] - points_[before_two_][i];
      }
      return prediction;
    }
    // The base is the point where the perpendiculars at the vertices before and after meet.
    const Flat one = a - p;
    const Flat two = b - q;
    const double det = cross(one, two);
    if (det * det > kPerpendicular * dot(one, one) * dot(two, two)) {
      const double part = dot(two, b - a) / det;
      prediction.base[0] += to_whole(-one.y * part);
      prediction.base[1] += to_whole(one.x * part);
      return prediction;
    }
    prediction.frame = PredictionFrame::corner;
    return prediction;
  }
  if (before_ != kNone) {
    prediction.base = column_of(points_[before_]);
    prediction.frame = before_two_ != kNone ? PredictionFrame::corner : PredictionFrame::edge;
    if (before_two_ != kNone) prediction.direction = flat(before_) - flat(before_two_);
    prediction.is_steady = follow_direction(prediction.direction);
    return prediction;
  }
  prediction.frame = PredictionFrame::bare;
  prediction.base = column_of(points_[neighbors_.empty() ? vertex - 1 : neighbors_.front().vertex]);
  return prediction;
}

/// Codes whether the vertex stands in a column of an earlier solid, and in which one.
bool PositionCoder::code_known_column(const Prediction& prediction) {
  if (memory_.columns.empty()) return false;
  const bool is_start = prediction.frame == PredictionFrame::start;
  ColumnScore score;
  score.base = prediction.base;
  score.turn = Turn(prediction.direction);
  score.across_weight = prediction.frame == PredictionFrame::corner ? kAcrossWeight : 1;
  const NearColumns near(memory_.columns, score, is_start ? kFirstWindow : kWindow);
  const std::size_t offered = std::min(near.size(), is_start ? kFirstOffered : kOffered);
  const std::size_t rank = truth_.empty() ? 0 : near.rank_of({truth_at(0), truth_at(1)});
  const Context<kFrames> frame(prediction.frame);
  const Context<3> before(before_ == kNone ? 0U : 1U + in_known_column_[before_]);
  const NearColumns::Scored nearest = near.nearest();
  const auto distance = capped<12>(std::bit_width(nearest.first) / 2);
  if (!models_.code<kKnownColumn>(stream_,
                                  {combine(frame, before, capped<3>(known_columns_)),
                                   combine(distance, before), combine(capped<8>(current_), before)},
                                  !truth_.empty() && rank < offered)) {
    return false;
  }
  const std::uint64_t coded = models_.code_number<kColumnRank>(
      stream_, {combine(frame, before), distance}, truth_.empty() ? 0 : rank, kRankBits);
  if (coded >= offered) {
    stream_.fail();
    return true;
  }
  const GridColumn column = coded == 0 ? nearest.second : near.at(coded).second;
  point()[0] = column[0];
  point()[1] = column[1];
  in_known_column_[current_] = 1;
  ++known_columns_;
  return true;
}

void PositionCoder::code_column(Index vertex) {
  Prediction prediction = predicted_column(vertex);
  for (const std::int64_t coordinate : prediction.base) {
    if (coordinate < kCoordinateLimit && coordinate > -kCoordinateLimit) continue;
    prediction.base = column_of(points_[0]);  // the prediction is out of range
  }
  if (prediction.frame == PredictionFrame::start)
    prediction.base = column_of(memory_.last_position);
  if (!code_known_column(prediction)) code_offset(prediction);
}

/// Codes a coordinate of the first vertex, as a difference from the last position of the page.
void PositionCoder::code_first(std::uint32_t axis) {
  const std::int64_t base = memory_.last_position[axis];
  const std::int64_t truth = truth_at(axis) - base;
  const Context<3> context(axis);
  point()[axis] =
      base + (memory_.is_first()
                  ? models_.code_signed<kFirstPosition>(stream_, {context}, truth, kCoordinateBits)
                  : models_.code_signed<kFirstOffset>(stream_, {context}, truth, kCoordinateBits));
}

void PositionCoder::code_offset(const Prediction& prediction) {
  if (prediction.frame == PredictionFrame::start) {
    code_first(0);
    code_first(1);
    return;
  }
  const Turn turn(prediction.direction);
  GridColumn turned{};
  if (!truth_.empty()) {
    turned = turn.forward({truth_at(0) - prediction.base[0], truth_at(1) - prediction.base[1]});
  }
  const bool is_line = prediction.frame == PredictionFrame::wall;
  if (is_line) std::swap(turned[0], turned[1]);
  turned = code_residual(prediction, turned);
  const auto [across, along] = turned;
  turns_[current_] = bits_of(along) + 2 < bits_of(across) ? 3 : along < 0 ? 2 : 1;
  if (is_line) std::swap(turned[0], turned[1]);
  const GridColumn offset = turn.back(turned);
  for (std::size_t axis = 0; axis < 2; ++axis) point()[axis] = prediction.base[axis] + offset[axis];
}

/// Codes the turned offset from a prediction: the part across, then the part along.
GridColumn PositionCoder::code_residual(const Prediction& prediction, const GridColumn& truth) {
  const Context<kFrames> frame(prediction.frame);
  const Context<2> steady(prediction.is_steady);
  const Context<2> first = in_first_facet_;
  const auto degree = before_ == kNone ? Context<4>(0U) : capped<4>(surface_.degree[before_] - 1);
  const Context<4> turned(before_ == kNone ? std::uint8_t{0} : turns_[before_]);
  const auto size = capped<4>(ring_size_ - 3);
  const auto length = halved(capped<24>(length_bits(prediction.direction)));
  const auto magnitude = [](std::int64_t value) {
    return static_cast<std::uint64_t>(value < 0 ? -value : value);
  };
  auto across = static_cast<std::int64_t>(models_.code_number<kAcross>(
      stream_, frame, {combine(size, frame, steady), length, combine(turned, degree, first)},
      magnitude(truth[0]), kCoordinateBits));
  const auto across_bits = capped<16>(bits_of(across));
  if (across > 0 &&
      models_.code<kAcrossSign>(
          stream_, {combine(across_bits, frame), combine(across_bits, turned)}, truth[0] < 0)) {
    across = -across;
  }
  auto along = static_cast<std::int64_t>(
      models_.code_number<kAlong>(stream_, frame,
                                  {combine(frame, capped<6>(bits_of(across))),
                                   combine(size, first, turned), combine(across_bits, steady)},
                                  magnitude(truth[1]), kCoordinateBits));
  if (along > 0 && models_.code<kAlongSign>(stream_,
                                            {combine(capped<16>(bits_of(along)), frame),
                                             combine(across_bits, turned, first),
                                             combine(capped<8>(ring_size_ - 3), frame, turned)},
                                            truth[1] < 0)) {
    along = -along;
  }
  return {across, along};
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
