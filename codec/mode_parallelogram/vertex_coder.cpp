// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_parallelogram/vertex_coder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "codec/mode_parallelogram/families.h"
#include "codec/mode_parallelogram/vectors.h"

namespace watertight::codec::parallelogram {

namespace {

constexpr int kDifferenceBits = 54;  // the most bits of a difference of two coordinates

// Contexts (docs/format-parallelogram.md, "The stream" and "A tip"). The classes of misses and
// lengths are logarithmic: each constant that ends in Zero is the class of 1.
constexpr std::uint32_t kDifferenceLengths = 64;  // classes of the number of bits of a difference
constexpr int kGuessMissZero = 4;
constexpr int kSizeZero = 1;
constexpr int kTwoMissesZero = 2;
constexpr int kSpreadZero = 3;
constexpr double kSpreadPart = 0.3;  // the unit of spread is this part of the expected miss, plus 1
constexpr int kAxisMissZero = 2;
constexpr std::uint32_t kDistances = 8;  // classes of the distance of two guesses
constexpr int kDistanceZero = 1;
constexpr double kDistancePart = 0.1;  // the unit of distance is this part of two misses, plus 1
constexpr Scale<4> kParts{.per_unit = 2 * 4};    // classes of the distance to the nearest place
constexpr Scale<8> kNormals{.per_unit = 7.999};  // classes of the size of a unit vector's component
constexpr std::uint32_t kVerticesAround = 5;     // vertices whose coordinate a tip may repeat

Error out_of_range() { return {ErrorCode::malformed, "a coordinate is out of range"}; }

/// The axes in ascending order of the magnitudes of a normal's components.
std::array<std::size_t, 3> axes_by_slope(const Vector& normal) {
  std::array<std::size_t, 3> axes{0, 1, 2};
  const auto is_flatter = [&](std::size_t a, std::size_t b) {
    return std::abs(normal[a]) < std::abs(normal[b]);
  };
  if (is_flatter(axes[1], axes[0])) std::swap(axes[0], axes[1]);
  if (is_flatter(axes[2], axes[1])) std::swap(axes[1], axes[2]);
  if (is_flatter(axes[1], axes[0])) std::swap(axes[0], axes[1]);
  return axes;
}

bool is_sane(const GridPoint& vertex) {
  return std::all_of(vertex.begin(), vertex.end(), [](std::int64_t c) {
    return c < (std::int64_t{1} << kDifferenceBits) && c > -(std::int64_t{1} << kDifferenceBits);
  });
}

}  // namespace

void VertexCoder::code_options(const VertexOptions& options) {
  stream_.enter(StreamPart::connectivity);
  has_repeats_ = models_.code<kHasRepeats>(stream_, {kNothingKnown}, options.has_repeats);
  has_guesses_ = models_.code<kHasGuesses>(stream_, {kNothingKnown}, options.has_guesses);
  naming_weight_ = options.naming_weight;
  chosen_places_ = options.places;
}

GridPoint VertexCoder::relative(const GridPoint* position) const {
  GridPoint vertex{};
  for (std::size_t k = 0; k < 3 && position != nullptr; ++k) {
    vertex[k] = (*position)[k] - origin_[k];
  }
  return vertex;
}

Status VertexCoder::add_vertex(const GridPoint& vertex, double miss) {
  if (positions_.size() >= limits_.vertices) {
    return Error{ErrorCode::limit_exceeded, "the solid has too many vertices"};
  }
  positions_.push_back(vertex);
  centres_.push_back({static_cast<double>(vertex[0]), static_cast<double>(vertex[1]),
                      static_cast<double>(vertex[2])});
  misses_.push_back(miss);
  repeats_.push_back(0);
  guesses_.push_back(0);
  return Done{};
}

template <Number number, std::uint32_t size>
GridPoint VertexCoder::code_vertex(const GridPoint& near, const GridPoint& truth,
                                   Context<size> context) {
  Context<kDifferenceLengths> before(0U);
  GridPoint vertex = near;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t place = places_[k].place_of(near[k]);
    const std::int64_t offset = models_.code_signed<number>(
        stream_, {context, before}, places_[k].place_of(truth[k]) - place, kDifferenceBits);
    const auto value = places_[k].value_of(place + offset);
    if (!value) stream_.fail();
    vertex[k] = value.value_or(near[k]);
    before =
        capped<kDifferenceLengths>(std::bit_width(static_cast<std::uint64_t>(std::abs(offset))));
  }
  return vertex;
}

Status VertexCoder::code_seed(std::uint32_t number, const GridPoint* position) {
  GridPoint vertex{};
  if (positions_.empty()) {
    stream_.enter(StreamPart::position);
    origin_ = code_vertex<kOrigin>(memory_.last_position, position ? *position : GridPoint{},
                                   Context<2>(!memory_.is_first()));
    AxisPlaces::Kind before = AxisPlaces::Kind::every;
    for (std::size_t k = 0; k < 3; ++k) {
      Result<AxisPlaces> coded =
          AxisPlaces::code(stream_, models_, before, chosen_places_[k], limits_);
      if (!coded) return coded.error();
      places_[k] = std::move(coded).value();
      before = places_[k].kind();
    }
  } else {
    stream_.enter(StreamPart::coordinates);
    vertex = code_vertex<kSeed>(positions_.back(), relative(position), Context<3>(number));
  }
  if (!is_sane(vertex) || stream_.failed()) return out_of_range();
  if (Status added = add_vertex(vertex, 0); !added) return added;
  if (number < 2) return Done{};
  const std::size_t first = positions_.size() - 3;
  const double miss = 0.5 * length(centres_[first + 1] - centres_[first]);
  std::fill(misses_.end() - 3, misses_.end(), miss);
  return Done{};
}

VertexCoder::TipContexts VertexCoder::contexts_of_tip(const SurfaceFront& front, const Gate& gate,
                                                      const GridPoint* truth) {
  const TipPrediction::Tip& tip = prediction_.tip();
  const double expected = 0.5 * (misses_[gate.start] + misses_[gate.end]);
  Guess guess(0U);
  if (has_guesses_) {
    guess = code_guess(front, gate, truth, log_bucket<kMisses>(expected, kGuessMissZero));
  }
  const double apart = length(tip.guesses[0] - tip.guesses[1]);
  const double both = misses_[gate.apex] + misses_[front[gate.next].end];
  return {.expected = expected,
          .guess = guess,
          .source = has_guesses_ ? trailing<kSpans>(guess) : leading<kGuesses>(tip.spans),
          .size = log_bucket<kMisses>(tip.size, kSizeZero),
          .spread = log_bucket<kSpreads>(apart / (kSpreadPart * expected + 1), kSpreadZero),
          .least_miss =
              log_bucket<kMisses>(std::min(misses_[gate.start], misses_[gate.end]), kGuessMissZero),
          .apex_miss = log_bucket<kMisses>(both, kTwoMissesZero)};
}

/// Codes a coordinate of a tip by its difference from the place where it is expected.
std::int64_t VertexCoder::code_coordinate(const TipContexts& tip, const Axis& axis,
                                          double expectation, std::int64_t truth) {
  const AxisPlaces& places = places_[axis.number];
  const double where = places.position_of(expectation);
  const double nearest = std::floor(where + 0.5);
  const double part = where - nearest;  // -0.5 to 0.5
  const std::int64_t side = part < 0 ? -1 : 1;
  const auto base = static_cast<std::int64_t>(nearest);
  const auto miss =
      log_bucket<kMisses>(places.spread_of(expectation, tip.expected), kGuessMissZero);
  const auto parts = kParts(std::abs(part));
  const std::int64_t offset =
      side * models_.code_signed<kResidual>(
                 stream_, combine(Context<2>(has_guesses_), axis.rank),
                 {combine(miss, parts, axis.rank), combine(tip.size, tip.missed, axis.rank),
                  combine(tip.source, tip.missed, parts), combine(miss, tip.spread, tip.missed),
                  combine(tip.least_miss, tip.apex_miss, axis.rank), miss},
                 side * (places.place_of(truth) - base), kDifferenceBits);
  const auto value = places.value_of(base + offset);
  if (!value) stream_.fail();
  return value.value_or(0);
}

Status VertexCoder::code_tip(const SurfaceFront& front, Index corner, const GridPoint* position) {
  stream_.enter(StreamPart::coordinates);
  const Gate& gate = front[corner];
  const Vector& normal = prediction_.tip().normal;
  const GridPoint truth = relative(position);
  const std::array<std::size_t, 3> axes = axes_by_slope(normal);
  TipContexts tip = contexts_of_tip(front, gate, position ? &truth : nullptr);
  const Vector& predicted = prediction_.tip().guesses[tip.guess.value];
  GridPoint vertex{};
  Vector centre{};
  double slope = 0;
  now_repeats_ = 0;
  for (std::uint32_t rank = 0; rank < 3; ++rank) {
    const std::size_t k = axes[rank];
    const Axis axis{k, Context<3>(rank)};
    double expectation = predicted[k];
    if (rank == 2) expectation = tamed(expectation + prediction_.shift_along(k, slope));
    const auto repeated = has_repeats_ ? code_repeat(front, gate, axis, truth[k]) : std::nullopt;
    vertex[k] = repeated ? *repeated : code_coordinate(tip, axis, expectation, truth[k]);
    centre[k] = static_cast<double>(vertex[k]);
    const double miss = centre[k] - predicted[k];
    slope += normal[k] * miss;
    if (repeated) continue;
    if (rank == 2) prediction_.learn_shift(miss, tip.expected);
    const auto missed = log_bucket<kAxisMisses>(std::abs(miss), kAxisMissZero);
    if (missed.value > tip.missed.value) tip.missed = missed;
  }
  if (!is_sane(vertex) || stream_.failed()) return out_of_range();
  prediction_.learn(centre, tip.expected);
  if (Status added = add_vertex(vertex, length(centre - predicted)); !added) return added;
  guesses_.back() = static_cast<std::uint8_t>(tip.guess.value);
  for (std::size_t rank = 0; has_repeats_ && rank < 3; ++rank) {
    repeats_.back() |= static_cast<std::uint8_t>(((now_repeats_ >> (2 - rank)) & 1U) << axes[rank]);
  }
  return Done{};
}

VertexCoder::Guess VertexCoder::code_guess(const SurfaceFront& front, const Gate& gate,
                                           const GridPoint* truth, Context<kMisses> scale) {
  const TipPrediction::Tip& tip = prediction_.tip();
  const auto guess_of = [&](Index vertex) { return Guess(guesses_[vertex]); };
  const Index x = front[gate.next].end;
  const Index p = front[gate.previous].start;
  const auto ends = combine(guess_of(gate.start), guess_of(gate.end));
  const auto others = combine(guess_of(gate.apex), guess_of(guesses_[x] > guesses_[p] ? x : p));
  const double unit = kDistancePart * (misses_[gate.start] + misses_[gate.end]) + 1;
  const auto far = [&](std::uint32_t a, std::uint32_t b) {
    const double distance = length(tip.guesses[a] - tip.guesses[b]);
    return halved(log_bucket<2 * kDistances>(distance / unit, kDistanceZero));
  };
  std::array<ContextsOf<kGuess>, kGuesses - 1> contexts;
  for (std::uint32_t i = 0; i + 1 < kGuesses; ++i) {
    const Guess guess(i);
    contexts[i] = {
        combine(last_guesses_, guess), combine(ends, guess),
        combine(others, guess),        combine(tip.spans, guess),
        combine(scale, guess),         combine(far(i, i == 0 ? 1 : 0), far(i, i + 1), guess)};
  }
  std::uint32_t best = 0;
  if (truth != nullptr) {
    double least = 0;
    double passed = 0;  // weighted bits of the answers "no" to all earlier guesses
    for (std::uint32_t i = 0; i < kGuesses; ++i) {
      double bits = passed;
      if (i + 1 < kGuesses) {
        const double ones =
            models_.probability<kGuess>(SelectorOf<kGuess>(i), contexts[i]) / 65536.0;
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
  while (guess + 1 < kGuesses && !models_.code<kGuess>(stream_, SelectorOf<kGuess>(guess),
                                                       contexts[guess], guess == best)) {
    ++guess;
  }
  const Guess result(guess);
  last_guesses_ = combine(Guess(last_guesses_.value % kGuesses), result);
  return result;
}

std::optional<std::int64_t> VertexCoder::code_repeat(const SurfaceFront& front, const Gate& gate,
                                                     const Axis& axis, std::int64_t truth) {
  const std::size_t k = axis.number;
  const Index x = front[gate.next].end;
  const Index p = front[gate.previous].start;
  const std::array<std::int64_t, kVerticesAround> around{
      positions_[gate.start][k], positions_[gate.end][k], positions_[gate.apex][k],
      positions_[x][k], positions_[p][k]};
  const auto bit = [](bool is_set, unsigned index) { return is_set ? 1U << index : 0U; };
  const auto repeats_at = [&](Index vertex) { return ((repeats_[vertex] >> k) & 1U) != 0; };
  const Context<4> mask(bit(repeats_at(gate.start), 0) + bit(repeats_at(gate.end), 1));
  const Context<16> pattern(bit(around[0] == around[1], 0) + bit(around[1] == around[2], 1) +
                            bit(around[0] == around[2], 2) +
                            bit(around[0] == around[4] || around[1] == around[3], 3));
  // The context of the answers for the axes before: none, one or two answers.
  const Context<7> now((1U << axis.rank.value) - 1 + now_repeats_);
  const auto flatness = kNormals(std::abs(prediction_.tip().normal[k]));
  std::size_t found = 0;
  while (found < around.size() && around[found] != truth) ++found;
  const bool repeats = models_.code<kRepeat>(
      stream_, axis.rank,
      {combine(pattern, axis.rank, mask), combine(history_[k].last(), axis.rank, mask),
       combine(pattern, flatness, axis.rank), combine(pattern, now)},
      found < around.size());
  history_[k].add(repeats);
  now_repeats_ = now_repeats_ * 2 + (repeats ? 1U : 0U);
  if (!repeats) return std::nullopt;
  std::int64_t value = 0;
  for (std::uint32_t i = 0; i < kVerticesAround; ++i) {
    if (std::find(around.begin(), around.begin() + i, around[i]) != around.begin() + i) continue;
    value = around[i];
    const Context<kVerticesAround> index(i);
    if (models_.code<kWhich>(
            stream_, index,
            {combine(index, pattern), combine(index, axis.rank, history_[k].last())}, i == found)) {
      break;
    }
  }
  return value;
}

}  // namespace watertight::codec::parallelogram
