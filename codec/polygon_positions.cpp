// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/polygon_positions.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "codec/polygon_frame.h"
#include "codec/polygon_models.h"

namespace watertight {
namespace {

constexpr std::int64_t kCoordinateLimit = std::int64_t{1} << 53;
constexpr int kCoordinateBits = 55;
constexpr std::size_t kFanLimit = 12;    // corners of a vertex that are looked at
constexpr std::size_t kLevelLimit = 12;  // heights that are remembered
constexpr std::size_t kHeightLimit = 6;  // of them those that are offered

using Kind = FacetPlane::Kind;

/// What a column is predicted from: one model selector each.
enum class Frame : std::uint8_t { start, bare, edge, corner, closing, wall, walls };
constexpr std::uint32_t kFrames = 7;

struct Neighbor {
  Index vertex = kNone;
  Index facet = kNone;         // left of the edge to it
  Index other_facet = kNone;   // right of it
  std::uint32_t relation = 2;  // 0: the one before in the ring, 1: the one after, 2: another
};

/// A known plane around a vertex.
struct Support {
  Index facet = kNone;
};

struct Prediction {
  Frame frame = Frame::start;
  GridColumn base{};
  Flat direction{};
};

std::uint32_t bits_of(std::int64_t value) {
  return static_cast<std::uint32_t>(
      std::bit_width(static_cast<std::uint64_t>(value < 0 ? -value : value)));
}

GridColumn column_of(const GridPoint& point) { return {point[0], point[1]}; }

class PositionCoder {
 public:
  PositionCoder(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                const PolygonSurface& surface, std::span<const GridPoint> truth)
      : stream_(stream), models_(models), memory_(memory), surface_(surface), truth_(truth) {
    planes_.resize(surface.facet_count());
    uprights_.assign(surface.facet_count(), 0);
    has_upright_.assign(surface.vertex_count(), 0);
  }

  Result<CodedPositions> run();

 private:
  void find_copies();
  bool code_copy(Index vertex);
  void code_vertex(Index vertex);
  void look_around(Index vertex);
  bool code_upright(Index vertex);
  void code_column(Index vertex);
  Prediction predicted_column(Index vertex) const;
  bool predict_on_walls(Prediction& prediction) const;
  void code_height(Index vertex);
  bool code_height_on_planes(Index vertex);
  void code_other_height(Index vertex);
  void remember_height(std::int64_t height);
  void learn(Index vertex);

  bool is_known(Index vertex) const { return vertex < current_; }
  Flat flat(Index vertex) const {
    const GridPoint& point = points_[vertex];
    return {static_cast<double>(point[0] - points_[0][0]),
            static_cast<double>(point[1] - points_[0][1])};
  }
  GridPoint& point() { return points_[current_]; }
  std::int64_t truth_at(std::size_t axis) const {
    return truth_.empty() ? 0 : truth_[current_][axis];
  }

  EntropyStream& stream_;
  ModelBank& models_;
  const PageMemory& memory_;
  const PolygonSurface& surface_;
  std::span<const GridPoint> truth_;

  std::vector<GridPoint> points_;
  std::vector<Index> same_as_;
  bool has_copies_ = false;
  std::vector<FacetPlane> planes_;
  std::vector<std::uint8_t> uprights_;     // facet -> vertical edges known, at most 2
  std::vector<std::uint8_t> has_upright_;  // vertex -> vertical edges known, at most 2
  std::vector<std::int64_t> levels_;       // heights, the latest first

  // Of the vertex being coded.
  Index current_ = 0;
  Index before_ = kNone;  // neighbours in the ring that it was met in, where known
  Index after_ = kNone;
  Index before_two_ = kNone;
  Index after_two_ = kNone;
  std::uint32_t ring_size_ = 0;
  bool in_first_facet_ = false;
  std::vector<Neighbor> neighbors_;
  std::vector<Index> facets_;  // around it
  Index below_ = kNone;        // the neighbour in the same column
};

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
  if (stream_.failed()) return Error{ErrorCode::malformed, "a position is out of range"};
  return CodedPositions{std::move(points_), std::move(same_as_)};
}

bool PositionCoder::code_copy(Index vertex) {
  const bool is_copy = models_.code(stream_, kIsCopy, 0, {0}, same_as_[vertex] != vertex);
  if (!is_copy) return false;
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

/// The lines in which the known walls around the vertex cut the xy plane.
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
    return prediction;
  }
  prediction.frame = Frame::bare;
  prediction.base = column_of(points_[neighbors_.empty() ? vertex - 1 : neighbors_.front().vertex]);
  return prediction;
}

void PositionCoder::code_column(Index vertex) {
  const Prediction prediction = predicted_column(vertex);
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
  const std::uint32_t length =
      bits_of(to_whole(prediction.direction.x)) > bits_of(to_whole(prediction.direction.y))
          ? bits_of(to_whole(prediction.direction.x))
          : bits_of(to_whole(prediction.direction.y));
  GridColumn residual{};
  if (!truth_.empty()) {
    residual = turn.forward({truth_at(0) - prediction.base[0], truth_at(1) - prediction.base[1]});
  }
  const bool is_line = prediction.frame == Frame::wall;
  const std::size_t small = is_line ? 1 : 0;
  const std::size_t large = 1 - small;
  residual[small] =
      models_.code_signed(stream_, kAcross, frame,
                          {frame, capped(ring_size_ - 3, 8) * kFrames + frame, capped(length, 24)},
                          residual[small], kCoordinateBits);
  const std::uint32_t across = capped(bits_of(residual[small]), 6);
  residual[large] = models_.code_signed(
      stream_, kAlong, frame,
      {frame * 6 + across, capped(ring_size_ - 3, 8) * 2 + in_first_facet_, capped(length, 24)},
      residual[large], kCoordinateBits);
  const GridColumn offset = turn.back(residual);
  for (std::size_t axis = 0; axis < 2; ++axis) point()[axis] = prediction.base[axis] + offset[axis];
}

void PositionCoder::code_height(Index vertex) {
  if (vertex == 0) {
    const auto number = memory_.is_first() ? kFirstPosition : kFirstOffset;
    const std::int64_t base = memory_.last_position[2];
    point()[2] =
        base + models_.code_signed(stream_, number, 0, {2}, truth_at(2) - base, kCoordinateBits);
  } else if (!code_height_on_planes(vertex)) {
    code_other_height(vertex);
  }
}

bool PositionCoder::code_height_on_planes(Index /*vertex*/) {
  const FacetPlane* best = nullptr;
  std::uint32_t count = 0;
  std::int64_t height = 0;
  bool agree = true;
  for (const Index facet : facets_) {
    const FacetPlane& plane = planes_[facet];
    if (plane.kind != Kind::level && plane.kind != Kind::steep) continue;
    const std::int64_t own = plane.height(column_of(point()));
    if (best == nullptr || plane.area > best->area) {
      if (best != nullptr && own != height) agree = false;
      best = &plane;
      height = own;
    } else if (own != height) {
      agree = false;
    }
    ++count;
  }
  if (best == nullptr) return false;
  const std::uint32_t context =
      ((best->kind == Kind::level ? 1U : 0U) * 3 + capped(count - 1, 3)) * 2 + (agree ? 1U : 0U);
  const std::uint32_t upright = below_ == kNone ? 0 : 1;
  const std::int64_t residual = models_.code_signed(
      stream_, kPlaneResidual, best->kind == Kind::level ? 1U : 0U,
      {context, upright * 2 + (in_first_facet_ ? 1U : 0U)}, truth_at(2) - height, kCoordinateBits);
  point()[2] = height + residual;
  return true;
}

void PositionCoder::code_other_height(Index /*vertex*/) {
  // Heights of the neighbours in the ring, then those seen last.
  std::array<std::int64_t, kHeightLimit> offered{};
  std::array<std::uint32_t, kHeightLimit> source{};
  std::size_t count = 0;
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
  const std::uint32_t upright = below_ == kNone ? 0 : 1;
  const std::uint32_t first = in_first_facet_ ? 1 : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t context = (static_cast<std::uint32_t>(i) * 4 + source[i]) * 2 + upright;
    if (models_.code(stream_, kKnownHeight, upright,
                     {context, ((source[i] * 2 + upright) * 2 + first) * 8 + capped(ring_size_, 8),
                      capped(count - i, 6) * 6 + capped(levels_.size(), 6)},
                     truth_at(2) == offered[i])) {
      point()[2] = offered[i];
      return;
    }
  }
  const Index near = below_ != kNone ? below_ : before_ != kNone ? before_ : current_ - 1;
  point()[2] =
      points_[near][2] + models_.code_signed(stream_, kHeightResidual, upright,
                                             {upright * 4 + capped(levels_.size(), 4), first},
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

/// What the position of a vertex tells about its facets and neighbours.
void PositionCoder::learn(Index vertex) {
  const GridPoint& own = points_[vertex];
  remember_height(own[2]);
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

}  // namespace

Result<CodedPositions> code_positions(EntropyStream& stream, ModelBank& models,
                                      const PageMemory& memory, const PolygonSurface& surface,
                                      std::span<const GridPoint> truth) {
  return PositionCoder(stream, models, memory, surface, truth).run();
}

}  // namespace watertight
