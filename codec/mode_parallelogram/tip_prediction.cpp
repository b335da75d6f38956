// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_parallelogram/tip_prediction.h"

#include <algorithm>

#include "codec/mode_parallelogram/vectors.h"
#include "geometry/mesh/half_edges.h"

namespace watertight::codec::parallelogram {
namespace {

/// The class of the room of a corner, in radians: fixed by the format ("A tip").
Context<4> span(double room) {
  return Context<4>(room < 1.7 ? 0U : room < 2.7 ? 1U : room < 3.8 ? 2U : 3U);
}

/// A normal of the known triangle of a gate; its length is not 1.
Vector normal_of(const Gate& gate, const std::vector<Vector>& centres) {
  const Vector& start = centres[gate.start];
  return cross(centres[gate.end] - start, centres[gate.apex] - start);
}

}  // namespace

const TipPrediction::Tip& TipPrediction::predict(const SurfaceFront& front,
                                                 const std::vector<Vector>& centres, Index corner) {
  const Gate& gate = front[corner];
  const Gate& after = front[gate.next];
  const Gate& before = front[gate.previous];
  const Vector& u = centres[gate.start];
  const Vector& v = centres[gate.end];
  const Vector& apex = centres[gate.apex];
  const Vector middle = (u + v) * 0.5;
  const Vector along = v - u;
  tip_.size = length(along);
  tip_.normal = unit_by_reciprocal(cross(along, apex - u));
  tip_.bends = combine(cosine_bucket(tip_.normal, normal_of(after, centres)),
                       cosine_bucket(tip_.normal, normal_of(before, centres)));
  const Vector outward = unit_by_reciprocal(cross(along, tip_.normal));
  const Index right = front.beyond(geometry::next_half_edge(gate.side));
  const Index left = front.beyond(geometry::previous_half_edge(gate.side));
  const std::array<Vector, kOffsets> offsets{
      u + v - apex - middle,
      u + centres[after.end] - v - middle,
      v + centres[before.start] - u - middle,
      outward * tip_.size,
      tip_.normal * tip_.size,
      v + centres[after.end] - centres[after.apex] - middle,
      u + centres[before.start] - centres[before.apex] - middle,
      left == kNone ? Vector{} : centres[left] - u - apex + v,
      right == kNone ? Vector{} : centres[right] - v - apex + u};
  tip_.spans = combine(span(gate.room), span(before.room));
  middle_ = middle;
  Vector position = middle;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t f = 0; f < kOffsets; ++f) features_[k][f] = offsets[f][k];
    position[k] += predictors_[tip_.spans.value].predict(features_[k]);
  }
  const double square = dot(along, along);
  const Vector foot = square > 0 ? u + along * (dot(apex - u, along) / square) : u;
  tip_.guesses = {position,        offsets[0] + middle, offsets[1] + middle,
                  foot * 2 - apex, offsets[5] + middle, u * 2 - centres[before.start]};
  for (Vector& guess : tip_.guesses) {
    for (double& coordinate : guess) coordinate = tamed(coordinate);
  }
  return tip_;
}

double TipPrediction::shift_along(std::size_t axis, double slope) {
  shift_ = 0;
  predicted_shift_ = 0;
  if (tip_.normal[axis] == 0) return 0;
  shift_ = std::clamp(-slope / tip_.normal[axis], -tip_.size - 1, tip_.size + 1);
  predicted_shift_ = shift_predictors_[tip_.bends.value].predict({shift_});
  return predicted_shift_;
}

void TipPrediction::learn_shift(double missed, double expected) {
  const double rest = missed - predicted_shift_;
  shift_predictors_[tip_.bends.value].learn({shift_}, missed,
                                            1 / (rest * rest + expected * expected + 1));
}

void TipPrediction::learn(const Vector& centre, double expected) {
  const double missed = length(centre - tip_.guesses[0]);
  const double weight = 1 / (missed * missed + expected * expected + 1);
  Predictor& predictor = predictors_[tip_.spans.value];
  for (std::size_t k = 0; k < 3; ++k) {
    predictor.learn(features_[k], centre[k] - middle_[k], weight);
  }
  predictor.solve(kMemory);
  shift_predictors_[tip_.bends.value].solve(kMemory);
}

}  // namespace watertight::codec::parallelogram
