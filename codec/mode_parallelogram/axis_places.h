// SPDX-License-Identifier: GPL-3.0-or-later
//
// The values that the coordinates of a solid take on one axis, numbered in ascending order; the
// number of a value is its place. Where a solid uses few of the grid's steps (parts of machines;
// grids finer than their source), a residual in places is smaller than one in grid steps. For mode
// parallelogram.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/limits.h"
#include "base/result.h"
#include "codec/entropy/entropy_stream.h"
#include "codec/entropy/model_bank.h"

namespace watertight::codec::parallelogram {

class AxisPlaces {
 public:
  enum class Kind : std::uint8_t { every, stepped, listed };

  /// Makes places of Kind::every: the value of each place is the number of the place.
  AxisPlaces() = default;

  Kind kind() const { return kind_; }
  /// The value of a place, below 2^54 in magnitude; nothing if the place has no value.
  std::optional<std::int64_t> value_of(std::int64_t place) const;
  /// The place of a value that has one. Cost: logarithmic in the list.
  std::int64_t place_of(std::int64_t value) const;
  /// The place of any coordinate, as a fraction between the places of the values beside it; 0 to
  /// the last place if listed. Cost: logarithmic in the list.
  double position_of(double coordinate) const;
  /// The length of `distance` around `coordinate`, counted in places.
  double spread_of(double coordinate, double distance) const;

  /// Codes the places of an axis; `before` is the kind of the axis before. The first vertex of the
  /// solid has the value 0. Errors: malformed; limit_exceeded.
  static Result<AxisPlaces> code(EntropyStream& stream, ModelBank& models, Kind before,
                                 const AxisPlaces& places, const Limits& limits);

  /// Estimates the kind that gives the smallest residuals for these coordinates, which are relative
  /// to the first vertex. Returns Kind::every if no other kind is likely to save bytes.
  /// Cost: O(n log n).
  static AxisPlaces suggest(std::vector<std::int64_t> values);

 private:
  bool code_steps(EntropyStream& stream, ModelBank& models);
  bool code_list(EntropyStream& stream, ModelBank& models, const Limits& limits);
  static AxisPlaces stepped(const std::vector<std::int64_t>& values);

  Kind kind_ = Kind::every;
  std::int64_t step_ = 0;  // the distance between two values, in units of 2^-shift_
  std::int64_t offset_ = 0;
  int shift_ = 0;
  std::vector<std::int64_t> list_;
};

}  // namespace watertight::codec::parallelogram
