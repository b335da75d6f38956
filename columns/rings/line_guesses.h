// SPDX-License-Identifier: GPL-3.0-or-later
//
// Guesses the next position of a line. The line in which a building meets the terrain has a
// position where it crosses an edge of the terrain's triangles, which have their corners on a
// square grid: x is round, or y is, or their difference. In between are the corners of the
// building. Internal to columns/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "columns/models/context_mixer.h"

namespace watertight::columns {

/// What a coordinate may be.
struct Guess {
  enum class Kind : std::uint8_t {
    first,          // that of the first position
    again,          // that of a neighbour which the last position had before
    parallelogram,  // it completes a parallelogram with the last three
    last,           // that of the last position
    round_x,        // x is round
    round_y,        // y is round
    diagonal,       // x - y is round
    on_line,        // on the line through the last positions
    none            // coded as a number
  };
  Kind kind = Kind::none;
  std::int64_t number = 0;
  bool is_exact = true;  // else the coordinate may differ by kMostOff
  static constexpr std::int64_t kMostOff = 3;
};

/// Follows x and y of a line, in units of one decimal.
class LineGuesses {
 public:
  using Place = std::array<std::int64_t, 2>;

  /// Starts another line.
  void restart();
  /// Tells how many units are one unit of the coordinates: the grid has 1, 2, 5 or 10 of them.
  void set_unit(std::int64_t unit);
  /// Adds guesses for x, and for y after x.
  void add_for_x(std::vector<Guess>& guesses) const;
  void add_for_y(std::vector<Guess>& guesses, std::int64_t x, Guess::Kind kind_of_x) const;
  /// Takes the position that was coded; `kind` is that of its guess for x, or for y if x had none.
  void take(const Place& place, Guess::Kind kind);
  /// Whether the direction of the line is known.
  bool has_direction() const { return has_direction_; }

 private:
  static constexpr std::array<std::int64_t, 4> kSizes{1, 2, 5, 10};
  std::int64_t grid() const;
  void learn_grid(const Place& place);

  std::int64_t unit_ = 0;                           // 0: there is no grid
  std::array<std::int32_t, kSizes.size()> hits_{};  // how often positions were on grids, in 1/4096
  bool has_last_ = false;
  bool has_direction_ = false;
  Place start_{};  // of the straight part
  Place last_{};
};

}  // namespace watertight::columns
