// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_parallelogram/vertex_coder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "codec/mode_parallelogram/families.h"

namespace watertight::codec::parallelogram {

using namespace parallelogram;

namespace {

constexpr int kMostBits = 54;  // of the difference of two coordinates

Error malformed() { return {ErrorCode::malformed, "a coordinate is out of range"}; }

bool is_sane(const GridPoint& cell) {
  return std::all_of(cell.begin(), cell.end(), [](std::int64_t c) {
    return c < (std::int64_t{1} << kMostBits) && c > -(std::int64_t{1} << kMostBits);
  });
}

}  // namespace

void VertexCoder::code_options(const VertexOptions& options) {
  stream_.enter(StreamPart::connectivity);
  has_repeats_ = models_.code(stream_, kHasRepeats, 0, {0}, options.has_repeats);
  has_guesses_ = models_.code(stream_, kHasGuesses, 0, {0}, options.has_guesses);
  naming_weight_ = options.naming_weight;
  chosen_places_ = options.places;
}

GridPoint VertexCoder::relative(const GridPoint* position) const {
  GridPoint cell{};
  for (std::size_t k = 0; k < 3 && position != nullptr; ++k) cell[k] = (*position)[k] - origin_[k];
  return cell;
}

Status VertexCoder::add_vertex(const GridPoint& cell, double error) {
  if (cells_.size() >= limits_.vertices) {
    return Error{ErrorCode::limit_exceeded, "the solid has too many vertices"};
  }
  cells_.push_back(cell);
  centres_.push_back(
      {static_cast<double>(cell[0]), static_cast<double>(cell[1]), static_cast<double>(cell[2])});
  errors_.push_back(error);
  repeats_.push_back(0);
  guesses_.push_back(0);
  return Done{};
}

GridPoint VertexCoder::code_cell(const GridPoint& near, const GridPoint& truth,
                                 std::uint32_t number, std::uint32_t context) {
  std::uint32_t before = 0;
  GridPoint cell = near;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t place = places_[k].place_of(near[k]);
    const std::int64_t offset = models_.code_signed(
        stream_, number, 0, {context, before}, places_[k].place_of(truth[k]) - place, kMostBits);
    if (!places_[k].find_value(place + offset, cell[k])) stream_.fail();
    before =
        static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint64_t>(std::abs(offset))));
  }
  return cell;
}

Status VertexCoder::code_seed(std::uint32_t number, const GridPoint* position) {
  GridPoint cell{};
  if (cells_.empty()) {
    stream_.enter(StreamPart::position);
    origin_ = code_cell(memory_.last_position, position ? *position : GridPoint{}, kOrigin,
                        memory_.is_first() ? 0 : 1);
    AxisPlaces::Kind before = AxisPlaces::Kind::every;
    for (std::size_t k = 0; k < 3; ++k) {
      Result<AxisPlaces> coded =
          AxisPlaces::code(stream_, models_, kPlaces, kPlace, before, chosen_places_[k], limits_);
      if (!coded) return coded.error();
      places_[k] = std::move(coded).value();
      before = places_[k].kind();
    }
  } else {
    stream_.enter(StreamPart::coordinates);
    cell = code_cell(cells_.back(), relative(position), kSeed, number);
  }
  if (!is_sane(cell) || stream_.failed()) return malformed();
  if (Status added = add_vertex(cell, 0); !added) return added;
  if (number < 2) return Done{};
  const std::size_t first = cells_.size() - 3;
  const double error = 0.5 * length(centres_[first + 1] - centres_[first]);
  std::fill(errors_.end() - 3, errors_.end(), error);
  return Done{};
}

Status VertexCoder::code_tip(const SurfaceFront& front, Index corner, const GridPoint* position) {
  stream_.enter(StreamPart::coordinates);
  const Gate& gate = front[corner];
  const Vector& normal = prediction_.tip().normal;
  const double size = prediction_.tip().size;
  const std::uint32_t spans = prediction_.tip().spans;
  const GridPoint truth = relative(position);
  std::array<std::size_t, 3> axes{0, 1, 2};
  const auto is_flatter = [&](std::size_t a, std::size_t b) {
    return std::abs(normal[a]) < std::abs(normal[b]);
  };
  if (is_flatter(axes[1], axes[0])) std::swap(axes[0], axes[1]);
  if (is_flatter(axes[2], axes[1])) std::swap(axes[1], axes[2]);
  if (is_flatter(axes[1], axes[0])) std::swap(axes[0], axes[1]);

  const double expected = 0.5 * (errors_[gate.start] + errors_[gate.end]);
  const std::uint32_t scale = log_bucket(expected, 4, kErrors);
  const std::uint32_t guess =
      has_guesses_ ? code_guess(front, gate, position ? &truth : nullptr, scale) : 0;
  const Vector& predicted = prediction_.tip().guesses[guess];
  const std::uint32_t spread = log_bucket(
      length(prediction_.tip().guesses[0] - prediction_.tip().guesses[1]) / (0.3 * expected + 1), 3,
      kSpreads);
  const std::uint32_t least_error =
      log_bucket(std::min(errors_[gate.start], errors_[gate.end]), 4, kErrors);
  const std::uint32_t apex_error =
      log_bucket(errors_[gate.apex] + errors_[front[gate.next].end], 2, kErrors);
  GridPoint cell{};
  Vector centre{};
  double slope = 0;
  std::uint32_t missed = 0;
  for (std::uint32_t rank = 0; rank < 3; ++rank) {
    const std::size_t k = axes[rank];
    double expectation = predicted[k];
    if (rank == 2) expectation = tamed(expectation + prediction_.shift_along(k, slope));
    if (has_repeats_ && code_repeat(front, gate, rank, k, truth[k], cell[k])) {
      centre[k] = static_cast<double>(cell[k]);
      slope += normal[k] * (centre[k] - predicted[k]);
      continue;
    }
    const AxisPlaces& places = places_[k];
    const double where = places.position_of(expectation);
    const double nearest = std::floor(where + 0.5);
    const double part = where - nearest;  // -0.5 to 0.5
    const std::int64_t side = part < 0 ? -1 : 1;
    const std::uint32_t miss = log_bucket(places.spread_of(expectation, expected), 4, kErrors);
    const std::uint32_t parts = bucket(std::abs(part) * 2 * kParts, kParts);
    const auto base = static_cast<std::int64_t>(nearest);
    const std::int64_t offset =
        side * models_.code_signed(
                   stream_, kResidual, has_guesses_ ? 3 + rank : rank,
                   {(miss * kParts + parts) * 3 + rank,
                    (log_bucket(size, 1, kErrors) * kMisses + missed) * 3 + rank,
                    ((has_guesses_ ? kSpans + guess : spans) * kMisses + missed) * kParts + parts,
                    (miss * kSpreads + spread) * kMisses + missed,
                    (least_error * kErrors + apex_error) * 3 + rank, miss},
                   side * (places.place_of(truth[k]) - base), kMostBits);
    if (!places.find_value(base + offset, cell[k])) stream_.fail();
    centre[k] = static_cast<double>(cell[k]);
    slope += normal[k] * (centre[k] - predicted[k]);
    if (rank == 2) prediction_.learn_shift(centre[k] - predicted[k], expected);
    missed = std::max(
        missed, std::min(log_bucket(std::abs(centre[k] - predicted[k]), 2, kMisses), kMisses - 1));
  }
  if (!is_sane(cell) || stream_.failed()) return malformed();
  prediction_.learn(centre, expected);
  if (Status added = add_vertex(cell, length(centre - predicted)); !added) return added;
  guesses_.back() = static_cast<std::uint8_t>(guess);
  for (std::size_t rank = 0; has_repeats_ && rank < 3; ++rank) {
    repeats_.back() |= static_cast<std::uint8_t>(((now_repeats_ >> (2 - rank)) & 1U) << axes[rank]);
  }
  return Done{};
}

std::uint32_t VertexCoder::code_guess(const SurfaceFront& front, const Gate& gate,
                                      const GridPoint* truth, std::uint32_t scale) {
  const TipPrediction::Tip& tip = prediction_.tip();
  const Index x = front[gate.next].end;
  const Index p = front[gate.previous].start;
  const std::array<std::uint32_t, 3> before{
      last_guesses_, guesses_[gate.start] * kGuesses + guesses_[gate.end],
      guesses_[gate.apex] * kGuesses + std::max(guesses_[x], guesses_[p])};
  using Contexts = std::array<std::uint32_t, 6>;
  std::array<Contexts, kGuesses - 1> contexts{};
  const double unit = 0.1 * (errors_[gate.start] + errors_[gate.end]) + 1;
  const auto far = [&](std::uint32_t a, std::uint32_t b) {
    return log_bucket(length(tip.guesses[a] - tip.guesses[b]) / unit, 1, 2 * kDistances) / 2;
  };
  for (std::uint32_t i = 0; i + 1 < kGuesses; ++i) {
    contexts[i] =
        Contexts{before[0] * kGuesses + i,
                 before[1] * kGuesses + i,
                 before[2] * kGuesses + i,
                 tip.spans * kGuesses + i,
                 scale * kGuesses + i,
                 (far(i, 1 - std::min(i, 1U)) * kDistances + far(i, i + 1)) * kGuesses + i};
  }
  std::uint32_t best = 0;
  if (truth != nullptr) {
    double least = 0;
    double passed = 0;  // weighted bits of the answers "no" to all earlier guesses
    for (std::uint32_t i = 0; i < kGuesses; ++i) {
      double bits = passed;
      if (i + 1 < kGuesses) {
        const double ones = models_.probability(kGuess, i, contexts[i]) / 65536.0;
        bits -= naming_weight_ * rough_log2(ones);
        passed -= naming_weight_ * rough_log2(1 - ones);
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const double missed = std::abs(static_cast<double>((*truth)[k]) - tip.guesses[i][k]);
        bits += rough_log2(1 + 2 * std::floor(missed + 0.5));
      }
      if (i == 0 || bits < least) {
        best = i;
        least = bits;
      }
    }
  }
  std::uint32_t guess = 0;
  while (guess + 1 < kGuesses &&
         !models_.code(stream_, kGuess, guess, contexts[guess], guess == best)) {
    ++guess;
  }
  last_guesses_ = last_guesses_ % kGuesses * kGuesses + guess;
  return guess;
}

bool VertexCoder::code_repeat(const SurfaceFront& front, const Gate& gate, std::uint32_t rank,
                              std::size_t k, std::int64_t truth, std::int64_t& value) {
  if (rank == 0) now_repeats_ = 0;
  const Index x = front[gate.next].end;
  const Index p = front[gate.previous].start;
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
  const bool repeats = models_.code(
      stream_, kRepeat, rank,
      {(pattern * 3 + rank) * 4 + mask, (history_[k] * 3 + rank) * 4 + mask,
       pattern * 24 + bucket(std::abs(prediction_.tip().normal[k]) * 7.999, 8) * 3 + rank,
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

}  // namespace watertight::codec::parallelogram
