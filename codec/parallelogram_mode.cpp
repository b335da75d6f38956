// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/parallelogram_mode.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "codec/least_squares.h"
#include "codec/modes.h"
#include "codec/surface_front.h"
#include "codec/vectors.h"

namespace watertight {
namespace {

constexpr std::uint32_t kRooms = 32;
constexpr std::uint32_t kDegrees = 10;
constexpr std::uint32_t kAngles = 16;
constexpr std::uint32_t kRatios = 12;
constexpr std::uint32_t kCosines = 8;
constexpr std::uint32_t kSpans = 16;
constexpr std::uint32_t kErrors = 16;
constexpr std::uint32_t kSpreads = 8;
constexpr std::uint32_t kPatterns = 16;
constexpr std::uint32_t kParts = 4;
constexpr std::uint32_t kMisses = 6;
constexpr int kMostBits = 54;  // of the difference of two coordinates
constexpr int kCandidateSteps = 256;
constexpr double kMemory = 0.995;  // of the predictions' coefficients, by vertex

enum Family : std::uint32_t {
  kHasRepeats,
  kMore,
  kNewShell,
  kClose,
  kNew,
  kRepeat,
  kWhich,
  kFamilyCount
};
enum Number : std::uint32_t { kOrigin, kSeed, kResidual, kRank, kNumberCount };

Error malformed() { return {ErrorCode::malformed, "these triangles make no closed surface"}; }

/// The surface in the order of the stream, written or read.
class SurfaceCoder {
 public:
  SurfaceCoder(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
               const Limits& limits)
      : stream_(stream), models_(models), memory_(memory), limits_(limits) {}

  Status code(const CutSurface* surface, IntegerSolid& solid, bool has_repeats) {
    surface_ = surface;
    stream_.enter(StreamPart::connectivity);
    has_repeats_ = models_.code(stream_, kHasRepeats, 0, {0}, has_repeats);
    if (surface_) {
      code_of_.assign(surface_->positions.size(), kNone);
      gate_of_.assign(surface_->twin.size(), kNone);
    }
    bool has_more = true;
    for (Index component = 0; has_more; ++component) {
      if (component > 0) {
        shells_.push_back(models_.code(stream_, kNewShell, 0, {0},
                                       surface_ && surface_->is_new_shell[component]));
      }
      starts_.push_back(static_cast<Index>(front_.triangles().size()));
      if (Status coded = code_component(component); !coded) return coded;
      has_more = models_.code(stream_, kMore, 0, {component > 0 ? 1U : 0U},
                              surface_ && component + 1 < surface_->component_first.size());
    }
    return is_writing() ? Status(Done{}) : finish(solid);
  }

 private:
  static constexpr std::size_t kOffsets = 9;
  using Predictor = LeastSquares<kOffsets>;

  bool is_writing() const { return surface_ != nullptr; }
  Index true_vertex(Index half_edge) const {
    return surface_->triangles[half_edge / 3][half_edge % 3];
  }
  static Index next_of(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index previous_of(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  GridPoint true_cell(Index true_index) const {
    GridPoint cell = surface_->positions[true_index];
    for (std::size_t k = 0; k < 3; ++k) cell[k] -= origin_[k];
    return cell;
  }

  /// Appends a vertex. Errors: limit_exceeded.
  Status add_vertex(const GridPoint& cell, Index true_index, double error) {
    if (cells_.size() >= limits_.vertices) {
      return Error{ErrorCode::limit_exceeded, "the solid has too many vertices"};
    }
    if (is_writing()) code_of_[true_index] = static_cast<Index>(cells_.size());
    cells_.push_back(cell);
    centres_.push_back(
        {static_cast<double>(cell[0]), static_cast<double>(cell[1]), static_cast<double>(cell[2])});
    errors_.push_back(error);
    repeats_.push_back(0);
    stream_.enter(StreamPart::connectivity);
    return Done{};
  }

  GridPoint code_cell(const GridPoint& near, std::uint32_t number, std::uint32_t context,
                      Index true_index) {
    stream_.enter(number == kOrigin ? StreamPart::position : StreamPart::coordinates);
    std::uint32_t before = 0;
    const GridPoint truth = is_writing() ? true_cell(true_index) : GridPoint{};
    GridPoint cell = near;
    for (std::size_t k = 0; k < 3; ++k) {
      cell[k] +=
          models_.code_signed(stream_, number, 0, {context, before}, truth[k] - near[k], kMostBits);
      before = static_cast<std::uint32_t>(
          std::bit_width(static_cast<std::uint64_t>(std::abs(cell[k] - near[k]))));
    }
    return cell;
  }

  Status code_component(Index component) {
    std::array<Index, 3> half_edges{kNone, kNone, kNone};
    std::array<Index, 3> truth{};
    if (is_writing()) {
      const Index first = 3 * surface_->component_first[component];
      half_edges = {first, first + 1, first + 2};
      for (std::size_t k = 0; k < 3; ++k) truth[k] = true_vertex(half_edges[k]);
    }
    Triangle seed{};
    for (std::size_t k = 0; k < 3; ++k) {
      GridPoint cell{};
      if (k == 0 && component == 0) {
        origin_ = code_cell(memory_.last_position, kOrigin, memory_.is_first() ? 0 : 1, truth[0]);
      } else {
        cell = code_cell(k == 0 ? cells_.back() : cells_[seed[k - 1]], kSeed,
                         static_cast<std::uint32_t>(k), truth[k]);
      }
      if (!is_sane(cell) || stream_.failed()) return malformed();
      seed[k] = static_cast<Index>(cells_.size());
      if (Status added = add_vertex(cell, truth[k], 0); !added) return added;
    }
    for (const Index v : seed) errors_[v] = 0.5 * length(centres_[seed[1]] - centres_[seed[0]]);
    front_.add_seed(seed, half_edges);
    note_gates(3);
    return walk();
  }

  static Status stuck() {
    return Error{ErrorCode::not_encodable, "two triangles meet along two edges"};
  }

  /// Within the range of coordinates, also if it is no number.
  static double tamed(double x) { return x > -9e15 ? std::min(x, 9e15) : -9e15; }

  static bool is_sane(const GridPoint& cell) {
    return std::all_of(cell.begin(), cell.end(), [](std::int64_t c) {
      return c < (std::int64_t{1} << kMostBits) && c > -(std::int64_t{1} << kMostBits);
    });
  }

  /// Where the new gates of the front are, by half-edges.
  void note_gates(Index count) {
    if (!is_writing()) return;
    for (Index gate = front_.gate_count() - count; gate < front_.gate_count(); ++gate) {
      gate_of_[front_[gate].half_edge] = gate;
    }
  }

  /// Until the component is closed.
  Status walk() {
    for (Index corner = front_.next_corner(); corner != kNone; corner = front_.next_corner()) {
      if (is_stuck_) return stuck();
      if (stream_.failed()) return malformed();
      if (front_.triangles().size() >= limits_.facets) {
        return Error{ErrorCode::limit_exceeded, "the solid has too many facets"};
      }
      if (!front_[corner].is_refused && code_close(corner)) continue;
      const Index before = front_[corner].previous;
      if (!front_[before].is_refused && code_close(before)) continue;
      if (Status extended = extend(corner); !extended) return extended;
    }
    if (is_stuck_) return stuck();
    return front_.open_count() == 0 ? Status(Done{}) : Status(malformed());
  }

  /// Whether a triangle fills the corner; adds it or refuses.
  bool code_close(Index corner) {
    const Gate& gate = front_[corner];
    const Gate& after = front_[gate.next];
    const Gate& before = front_[gate.previous];
    const Vector& u = centres_[gate.start];
    const Vector& v = centres_[gate.end];
    const Vector& w = centres_[after.end];
    const Vector to_u = u - v;
    const Vector to_w = w - v;
    const Vector across = w - u;
    const double angle = angle_between(to_u, to_w);
    const double room_u = before.room - angle_between(v - u, across);
    const double room_w = after.room - angle_between(u - w, v - w);
    const double span = length(across);
    const double sides = 0.5 * (length(to_u) + length(to_w));
    const Vector normal = cross(to_w, to_u);
    const std::uint32_t bend = cosine_bucket(normal, cross(centres_[gate.apex] - u, v - u) * -1.0);
    const std::uint32_t other_bend =
        cosine_bucket(normal, cross(centres_[after.apex] - v, w - v) * -1.0);
    const bool ends = after.next == gate.previous;
    const std::uint32_t room = bucket(gate.room * 8, kRooms);
    const std::uint32_t degree = std::min(front_.degree(gate.end), kDegrees - 1);
    const std::uint32_t degree_u = std::min(front_.degree(gate.start), kDegrees - 1);
    const std::uint32_t degree_w = std::min(front_.degree(after.end), kDegrees - 1);
    const std::uint32_t ratio = log_bucket(span / (sides + 1e-3), 6, kRatios);
    const std::uint32_t least = bucket(std::min(room_u, room_w) * 4 + 2, 14);
    const std::uint32_t most = bucket(std::max(room_u, room_w) * 3 + 1, 14);

    Index half_edge = kNone;
    bool truth = false;
    if (is_writing()) {
      const Index beyond = surface_->twin[gate.half_edge];
      truth = surface_->twin[previous_of(beyond)] == after.half_edge;
      half_edge = next_of(beyond);
      if (ends && truth) {
        // In a loop of three a triangle ends all or none.
        is_stuck_ = surface_->twin[half_edge] != front_[gate.previous].half_edge;
      }
    }
    const bool closes =
        models_.code(stream_, kClose,
                     ends                               ? 3U
                     : front_[gate.previous].is_refused ? 1U
                                                        : 0U,
                     {room * kDegrees + degree, bucket(angle * 5, kAngles) * kRatios + ratio,
                      least * 14 + most, (bend * kCosines + other_bend) * kAngles + room / 2,
                      (degree * kDegrees + std::min(degree_u, degree_w)) * kDegrees +
                          std::max(degree_u, degree_w),
                      (room / 2 * 14 + least) * kCosines + std::min(bend, other_bend),
                      room * kRatios + log_bucket(span / (mean_edge_ + 1e-3), 6, kRatios), room},
                     truth);
    if (closes) {
      front_.close_corner(corner, half_edge);
      if (!ends) note_gates(1);
    } else {
      front_.refuse(corner);
    }
    return closes;
  }

  /// The triangle beyond the gate has a new vertex or joins the front elsewhere.
  Status extend(Index corner) {
    const Gate gate = front_[corner];
    std::array<Index, 2> half_edges{kNone, kNone};
    Index tip = kNone;
    if (is_writing()) {
      const Index beyond = surface_->twin[gate.half_edge];
      half_edges = {next_of(beyond), previous_of(beyond)};
      tip = true_vertex(half_edges[1]);
    }
    const bool is_new = models_.code(
        stream_, kNew, 0, {bucket(gate.room * 4, 32), bucket(front_[gate.previous].room * 4, 32)},
        is_writing() && code_of_[tip] == kNone);
    const Vector predicted = predict(corner);
    if (!is_new) return join(corner, half_edges, predicted);
    if (Status coded = code_tip(corner, tip, predicted); !coded) return coded;
    const auto vertex = static_cast<Index>(cells_.size() - 1);
    const double size = length(centres_[vertex] - centres_[gate.start]);
    mean_edge_ += (size - mean_edge_) / (1.0 + std::min<double>(vertex, 1000));
    front_.add_vertex(corner, vertex, half_edges);
    note_gates(2);
    return Done{};
  }

  /// Fills features_ for the triangle beyond the gate.
  Vector predict(Index corner) {
    const Gate& gate = front_[corner];
    const Vector& u = centres_[gate.start];
    const Vector& v = centres_[gate.end];
    const Vector& apex = centres_[gate.apex];
    const Vector middle = (u + v) * 0.5;
    const Vector along = v - u;
    const double size = length(along);
    normal_ = unit(cross(along, apex - u));
    const Vector outward = unit(cross(along, normal_));
    const Gate& after = front_[gate.next];
    const Gate& before = front_[gate.previous];
    const Index right = front_.beyond(gate.side % 3 == 2 ? gate.side - 2 : gate.side + 1);
    const Index left = front_.beyond(gate.side % 3 == 0 ? gate.side + 2 : gate.side - 1);
    const std::array<Vector, kOffsets> offsets{
        u + v - apex - middle,
        u + centres_[front_[gate.next].end] - v - middle,
        v + centres_[front_[gate.previous].start] - u - middle,
        outward * size,
        normal_ * size,
        v + centres_[after.end] - centres_[after.apex] - middle,
        u + centres_[before.start] - centres_[before.apex] - middle,
        left == kNone ? Vector{} : centres_[left] - u - apex + v,
        right == kNone ? Vector{} : centres_[right] - v - apex + u};
    const auto span = [](double room) {
      return room < 1.7 ? 0U : room < 2.7 ? 1U : room < 3.8 ? 2U : 3U;
    };
    parallelogram_ = offsets[0] + middle;
    class_ = span(gate.room) * 4 + span(front_[gate.previous].room);
    middle_ = middle;
    Vector predicted = middle;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t f = 0; f < kOffsets; ++f) features_[k][f] = offsets[f][k];
      predicted[k] += predictors_[class_].predict(features_[k]);
    }
    for (double& coordinate : predicted) coordinate = tamed(coordinate);
    return predicted;
  }

  Status code_tip(Index corner, Index true_index, const Vector& predicted) {
    stream_.enter(StreamPart::coordinates);
    const Gate& gate = front_[corner];
    const GridPoint truth = is_writing() ? true_cell(true_index) : GridPoint{};
    std::array<std::size_t, 3> axes{0, 1, 2};
    const auto is_flatter = [&](std::size_t a, std::size_t b) {
      return std::abs(normal_[a]) < std::abs(normal_[b]);
    };
    if (is_flatter(axes[1], axes[0])) std::swap(axes[0], axes[1]);
    if (is_flatter(axes[2], axes[1])) std::swap(axes[1], axes[2]);
    if (is_flatter(axes[1], axes[0])) std::swap(axes[0], axes[1]);

    const double expected = 0.5 * (errors_[gate.start] + errors_[gate.end]);
    const std::uint32_t scale = log_bucket(expected, 4, kErrors);
    const double size = length(centres_[gate.end] - centres_[gate.start]);
    const std::uint32_t spread =
        log_bucket(length(predicted - parallelogram_) / (0.3 * expected + 1), 3, kSpreads);
    const std::uint32_t least_error =
        log_bucket(std::min(errors_[gate.start], errors_[gate.end]), 4, kErrors);
    const std::uint32_t apex_error =
        log_bucket(errors_[gate.apex] + errors_[front_[gate.next].end], 2, kErrors);
    GridPoint cell{};
    Vector centre{};
    double slope = 0;
    std::uint32_t missed = 0;
    for (std::uint32_t rank = 0; rank < 3; ++rank) {
      const std::size_t k = axes[rank];
      double expectation = predicted[k];
      double shift = 0;
      if (rank == 2 && normal_[k] != 0) {
        shift = std::clamp(-slope / normal_[k], -size - 1, size + 1);
        expectation = tamed(expectation + shift_predictor_.predict({shift}));
      }
      if (has_repeats_ && code_repeat(gate, rank, k, truth[k], cell[k])) {
        centre[k] = static_cast<double>(cell[k]);
        slope += normal_[k] * (centre[k] - predicted[k]);
        continue;
      }
      const double nearest = std::floor(expectation + 0.5);
      const double part = expectation - nearest;  // -0.5 to 0.5
      const std::int64_t side = part < 0 ? -1 : 1;
      const std::uint32_t parts = bucket(std::abs(part) * 2 * kParts, kParts);
      const auto base = static_cast<std::int64_t>(nearest);
      const std::int64_t offset =
          side * models_.code_signed(stream_, kResidual, rank,
                                     {(scale * kParts + parts) * 3 + rank,
                                      (log_bucket(size, 1, kErrors) * kMisses + missed) * 3 + rank,
                                      (class_ * kMisses + missed) * kParts + parts,
                                      (scale * kSpreads + spread) * kMisses + missed,
                                      (least_error * kErrors + apex_error) * 3 + rank, scale},
                                     side * (truth[k] - base), kMostBits);
      cell[k] = base + offset;
      centre[k] = static_cast<double>(cell[k]);
      slope += normal_[k] * (centre[k] - predicted[k]);
      if (rank == 2) {
        shift_predictor_.learn({shift}, centre[k] - predicted[k], 1 / (expected * expected + 1));
      }
      missed = std::max(missed, std::min(log_bucket(std::abs(centre[k] - predicted[k]), 2, kMisses),
                                         kMisses - 1));
    }
    if (!is_sane(cell) || stream_.failed()) return malformed();
    const double missed_by = length(centre - predicted);
    const double weight = 1 / (missed_by * missed_by + expected * expected + 1);
    for (std::size_t k = 0; k < 3; ++k) {
      predictors_[class_].learn(features_[k], centre[k] - middle_[k], weight);
    }
    predictors_[class_].solve(kMemory);
    shift_predictor_.solve(kMemory);
    if (Status added = add_vertex(cell, true_index, missed_by); !added) return added;
    for (std::size_t rank = 0; has_repeats_ && rank < 3; ++rank) {
      repeats_.back() |=
          static_cast<std::uint8_t>(((now_repeats_ >> (2 - rank)) & 1U) << axes[rank]);
    }
    return Done{};
  }

  /// Whether the coordinate is that of a vertex beside the gate, and which one.
  bool code_repeat(const Gate& gate, std::uint32_t rank, std::size_t k, std::int64_t truth,
                   std::int64_t& value) {
    if (rank == 0) now_repeats_ = 0;
    const Index x = front_[gate.next].end;
    const Index p = front_[gate.previous].start;
    const std::array<std::int64_t, 5> around{cells_[gate.start][k], cells_[gate.end][k],
                                             cells_[gate.apex][k], cells_[x][k], cells_[p][k]};
    std::uint32_t mask = static_cast<std::uint32_t>((repeats_[gate.start] >> k) & 1U) +
                         static_cast<std::uint32_t>((repeats_[gate.end] >> k) & 1U) * 2;
    const std::uint32_t pattern = (around[0] == around[1] ? 1U : 0U) +
                                  (around[1] == around[2] ? 2U : 0U) +
                                  (around[0] == around[2] ? 4U : 0U) +
                                  (around[0] == around[4] || around[1] == around[3] ? 8U : 0U);
    std::size_t found = 0;
    while (found < 5 && around[found] != truth) ++found;
    const bool repeats =
        models_.code(stream_, kRepeat, rank,
                     {(pattern * 3 + rank) * 4 + mask, (history_[k] * 3 + rank) * 4 + mask,
                      pattern * 24 + bucket(std::abs(normal_[k]) * 7.999, 8) * 3 + rank,
                      pattern * 7 + (1U << rank) - 1 + now_repeats_},
                     found < 5);
    history_[k] = (history_[k] * 2 + (repeats ? 1U : 0U)) & 7U;
    now_repeats_ = now_repeats_ * 2 + (repeats ? 1U : 0U);
    if (!repeats) return false;
    for (std::uint32_t i = 0; i < 5; ++i) {
      bool is_double = false;
      for (std::uint32_t j = 0; j < i; ++j) is_double = is_double || around[j] == around[i];
      if (is_double) continue;
      value = around[i];
      if (models_.code(stream_, kWhich, i,
                       {i * kPatterns + pattern, (i * 3 + rank) * 8 + history_[k]}, i == found))
        return true;
    }
    return true;
  }

  /// Which corner of the front: by its distance from the prediction among those near on the loop.
  Status join(Index corner, const std::array<Index, 2>& half_edges, const Vector& predicted) {
    const Gate& gate = front_[corner];
    Index truth = kNone;
    if (is_writing()) {
      // The known triangle that is met first on turning around the vertex.
      Index incoming = surface_->twin[half_edges[1]];
      const Index first = incoming;
      while (gate_of_[incoming] == kNone || !front_[gate_of_[incoming]].is_open) {
        incoming = surface_->twin[next_of(incoming)];
        if (incoming == first) return stuck();
      }
      truth = gate_of_[incoming];
    }
    candidates_.clear();
    const Index last = front_[front_[gate.previous].previous].previous;
    Index ahead = front_[gate.next].next;
    for (int steps = 0; steps < kCandidateSteps && ahead != last && ahead != corner; ++steps) {
      add_candidate(ahead, predicted);
      ahead = front_[ahead].next;
    }
    Index behind = last;
    for (int steps = 0; steps < kCandidateSteps && ahead != corner && behind != ahead; ++steps) {
      add_candidate(behind, predicted);
      behind = front_[behind].previous;
    }
    if (ahead == last && ahead != corner) add_candidate(ahead, predicted);
    std::sort(candidates_.begin(), candidates_.end(), [](const auto& a, const auto& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.corner < b.corner;
    });
    candidates_.erase(
        std::unique(candidates_.begin(), candidates_.end(),
                    [](const auto& a, const auto& b) { return a.corner == b.corner; }),
        candidates_.end());
    const auto found = std::find_if(candidates_.begin(), candidates_.end(),
                                    [&](const auto& c) { return c.corner == truth; });
    const auto place = static_cast<std::uint64_t>(found - candidates_.begin());
    const std::uint64_t rank =
        models_.code_number(stream_, kRank, 0, {0}, found == candidates_.end() ? 0 : place + 1, 32);
    if (rank > candidates_.size() || stream_.failed()) return malformed();
    const auto other = rank > 0
                           ? candidates_[rank - 1].corner
                           : static_cast<Index>(stream_.code_uniform(truth, front_.gate_count()));
    const Gate& target = front_[other];
    const bool is_neighbour = other == corner || other == gate.previous || other == gate.next ||
                              other == front_[gate.previous].previous;
    if (!target.is_open || is_neighbour) {
      return is_writing() ? stuck() : Status(malformed());
    }
    front_.join_corner(corner, other, half_edges);
    note_gates(2);
    return Done{};
  }

  void add_candidate(Index corner, const Vector& predicted) {
    const Vector offset = centres_[front_[corner].end] - predicted;
    candidates_.push_back({dot(offset, offset), corner});
  }

  /// Glues what was cut apart, by position.
  Status finish(IntegerSolid& solid) const {
    std::vector<Index> order(cells_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      return cells_[a] != cells_[b] ? cells_[a] < cells_[b] : a < b;
    });
    std::vector<Index> glued(cells_.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const GridPoint& position = cells_[order[i]];
      if (i == 0 || position != cells_[order[i - 1]]) {
        GridPoint absolute{};
        for (std::size_t k = 0; k < 3; ++k) {
          absolute[k] = position[k] + origin_[k];
          if (absolute[k] <= -(std::int64_t{1} << 53) || absolute[k] >= (std::int64_t{1} << 53)) {
            return malformed();
          }
        }
        solid.vertices.push_back(absolute);
      }
      glued[order[i]] = static_cast<Index>(solid.vertices.size() - 1);
    }
    const auto& triangles = front_.triangles();
    for (std::size_t t = 0, component = 1; t < triangles.size(); ++t) {
      if (component < starts_.size() && starts_[component] == t) {
        if (shells_[component - 1]) solid.shell_offsets.push_back(solid.facet_count());
        ++component;
      }
      for (const Index vertex : triangles[t]) solid.ring_vertices.push_back(glued[vertex]);
      solid.ring_offsets.push_back(static_cast<Index>(solid.ring_vertices.size()));
      solid.facet_offsets.push_back(solid.ring_count());
    }
    solid.shell_offsets.push_back(solid.facet_count());
    if (solid.shell_count() > limits_.shells) {
      return Error{ErrorCode::limit_exceeded, "the solid has too many shells"};
    }
    return Done{};
  }

  struct Candidate {
    double distance = 0;
    Index corner = 0;
  };

  EntropyStream& stream_;
  ModelBank& models_;
  const PageMemory& memory_;
  Limits limits_;
  const CutSurface* surface_ = nullptr;  // nothing when reading
  GridPoint origin_{};                   // the first vertex's cell
  std::vector<GridPoint> cells_;
  std::vector<Vector> centres_;  // the same as doubles
  std::vector<double> errors_;
  SurfaceFront front_{centres_};
  std::vector<Index> starts_;   // component -> first triangle
  std::vector<bool> shells_;    // component but the first -> whether it begins a shell
  std::vector<Index> code_of_;  // writing: vertex of the surface -> its number in the stream
  std::vector<Index> gate_of_;  // writing: half-edge of the surface -> gate
  std::vector<Candidate> candidates_;
  std::vector<Predictor> predictors_{kSpans, Predictor{{1, 0, 0, 0, 0, 0, 0, 0, 0}, 3}};
  LeastSquares<1> shift_predictor_{{0.5}, 4};
  std::array<Predictor::Features, 3> features_{};
  Vector normal_{};
  Vector middle_{};
  Vector parallelogram_{};
  std::uint32_t class_ = 0;
  double mean_edge_ = 1;
  bool has_repeats_ = false;
  bool is_stuck_ = false;  // writing: the surface has edges between the same two vertices
  std::array<std::uint32_t, 3> history_{};  // of each axis, whether the last three repeated
  std::uint32_t now_repeats_ = 0;
  std::vector<std::uint8_t> repeats_;  // of each vertex, by axis
};

}  // namespace

const ModelLayout& parallelogram_layout() {
  static constexpr std::array<FamilyShape, kFamilyCount> kFamilies{
      FamilyShape{1, {1}},
      FamilyShape{1, {2}},
      FamilyShape{1, {1}},
      FamilyShape{
          4,
          {kRooms * kDegrees, kAngles * kRatios, 14 * 14, kCosines * kCosines * kAngles,
           kDegrees * kDegrees * kDegrees, kRooms / 2 * 14 * kCosines, kRooms * kRatios, kRooms}},
      FamilyShape{1, {32, 32}},
      FamilyShape{3, {kPatterns * 12, 8 * 12, kPatterns * 24, kPatterns * 7}},
      FamilyShape{5, {5 * kPatterns, 15 * 8}}};
  static constexpr std::array<NumberShape, kNumberCount> kNumbers{
      NumberShape{1, {2, 64}}, NumberShape{1, {3, 64}},
      NumberShape{3,
                  {kErrors * kParts * 3, kErrors * kMisses * 3, kSpans * kMisses * kParts,
                   kErrors * kSpreads * kMisses, kErrors * kErrors * 3, kErrors}},
      NumberShape{1, {1}}};
  static const ModelLayout kLayout{kFamilies, kNumbers};
  return kLayout;
}

Status code_parallelogram(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                          IntegerSolid& solid, const Limits& limits) {
  if (stream.is_reading()) {
    return SurfaceCoder(stream, models, memory, limits).code(nullptr, solid, false);
  }
  const Result<CutSurface> surface = cut_surface(solid);
  if (!surface) return surface.error();
  std::array<std::uint64_t, 2> costs{};
  for (const bool has_repeats : {false, true}) {
    EntropyStream meter = EntropyStream::meter();
    ModelBank trial = models;
    const Status measured =
        SurfaceCoder(meter, trial, memory, limits).code(&*surface, solid, has_repeats);
    if (!measured) return measured;
    costs[has_repeats ? 1 : 0] = meter.cost();
  }
  return SurfaceCoder(stream, models, memory, limits).code(&*surface, solid, costs[1] < costs[0]);
}

}  // namespace watertight
