// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/rings/line_guesses.h"

#include <algorithm>

#include "columns/models/number_coder.h"

namespace watertight::columns {
namespace {

__extension__ using Wide = __int128;

constexpr std::int32_t kAlways = 4096;
constexpr int kHitMemory = 4;
// Coordinates beyond it have no guesses, so that sums stay in range.
constexpr std::int64_t kLimit = std::int64_t{1} << 60;

std::int64_t floor_to(std::int64_t number, std::int64_t grid) {
  const std::int64_t rest = number % grid;
  return number - (rest < 0 ? rest + grid : rest);
}

/// The next multiple of `grid` from `number` on in the direction of `step`, which is not 0.
std::int64_t next_round(std::int64_t number, std::int64_t step, std::int64_t grid) {
  const std::int64_t low = floor_to(number, grid);
  if (step > 0) return low + grid;
  return low == number ? low - grid : low;
}

bool is_on_grid(const LineGuesses::Place& place, std::int64_t grid) {
  return place[0] % grid == 0 || place[1] % grid == 0 || (place[0] - place[1]) % grid == 0;
}

/// number + step * part / whole, rounded.
std::int64_t along(std::int64_t number, std::int64_t step, std::int64_t part, std::int64_t whole) {
  const Wide moved = Wide{step} * part;
  const Wide half = (whole < 0 ? -Wide{whole} : Wide{whole}) / 2;
  const Wide rounded = (moved < 0) == (whole < 0) ? moved + (whole < 0 ? -half : half)
                                                  : moved - (whole < 0 ? -half : half);
  const Wide result = rounded / whole;
  if (result >= kLimit || result <= -kLimit) return number;
  return number + static_cast<std::int64_t>(result);
}

}  // namespace

void LineGuesses::restart() {
  has_last_ = false;
  has_direction_ = false;
}

void LineGuesses::set_unit(std::int64_t unit) {
  if (unit == unit_) return;
  unit_ = unit;
  restart();
}

std::int64_t LineGuesses::grid() const {
  const std::int32_t most = *std::max_element(hits_.begin(), hits_.end());
  if (unit_ == 0 || most < kAlways / 4) return 0;
  std::int64_t grid = 0;
  for (std::size_t i = 0; i < kSizes.size(); ++i) {
    if (hits_[i] > most - most / 4) grid = kSizes[i] * unit_;
  }
  return grid;
}

void LineGuesses::learn_grid(const Place& place) {
  if (unit_ == 0) return;
  for (std::size_t i = 0; i < kSizes.size(); ++i) {
    const bool is_hit = is_on_grid(place, kSizes[i] * unit_);
    hits_[i] += ((is_hit ? kAlways : 0) - hits_[i]) / (1 << kHitMemory);
  }
}

void LineGuesses::add_for_x(std::vector<Guess>& guesses) const {
  const std::int64_t grid = this->grid();
  if (!has_last_ || grid == 0) return;
  const std::int64_t x = last_[0];
  const std::int64_t y = last_[1];
  if (!has_direction_) {
    const std::int64_t low = floor_to(x, grid);
    guesses.push_back({Guess::Kind::round_x, low == x ? low - grid : low});
    guesses.push_back({Guess::Kind::round_x, low + grid});
    return;
  }
  struct Crossing {
    Guess guess;
    Wide part = 0;  // of the direction, as a fraction with the numerators and denominators below
    Wide whole = 1;
  };
  const std::int64_t dx = x - start_[0];
  const std::int64_t dy = y - start_[1];
  std::vector<Crossing> crossings;
  const auto add = [&](Guess::Kind kind, std::int64_t number, std::int64_t step) {
    if (step == 0) return;
    const std::int64_t part = next_round(number, step, grid) - number;
    const bool is_exact = kind == Guess::Kind::round_x;
    const std::int64_t crossed = is_exact ? x + part : along(x, dx, part, step);
    crossings.push_back({{kind, crossed, is_exact}, std::abs(part), std::abs(step)});
  };
  add(Guess::Kind::round_x, x, dx);
  add(Guess::Kind::round_y, y, dy);
  add(Guess::Kind::diagonal, x - y, dx - dy);
  std::stable_sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.part * b.whole < b.part * a.whole;
  });
  for (const Crossing& crossing : crossings) guesses.push_back(crossing.guess);
}

void LineGuesses::add_for_y(std::vector<Guess>& guesses, std::int64_t x,
                            Guess::Kind kind_of_x) const {
  const std::int64_t grid = this->grid();
  if (!has_last_ || grid == 0) return;
  const auto [last_x, y] = last_;
  const std::int64_t dx = last_x - start_[0];
  const std::int64_t dy = y - start_[1];
  if (has_direction_ && kind_of_x == Guess::Kind::round_y && dy != 0) {
    guesses.push_back({Guess::Kind::round_y, next_round(y, dy, grid)});
  } else if (has_direction_ && kind_of_x == Guess::Kind::diagonal && dx != dy) {
    guesses.push_back({Guess::Kind::diagonal, x - next_round(last_x - y, dx - dy, grid)});
  } else if (has_direction_ && dx != 0) {
    guesses.push_back({Guess::Kind::on_line, along(y, dy, x - last_x, dx), false});
  }
  if (kind_of_x != Guess::Kind::none) return;
  const std::int64_t low = floor_to(y, grid);
  const std::int64_t difference = floor_to(last_x - y, grid);
  for (const std::int64_t more : {std::int64_t{0}, grid}) {
    guesses.push_back({Guess::Kind::round_y, low == y && more == 0 ? low - grid : low + more});
    guesses.push_back({Guess::Kind::diagonal, x - difference - more});
  }
}

void LineGuesses::take(const Place& place, Guess::Kind kind) {
  const bool is_in_range = std::abs(place[0]) < kLimit / 4 && std::abs(place[1]) < kLimit / 4;
  if (is_in_range) learn_grid(place);
  const std::int64_t grid = this->grid();
  const bool is_crossing =
      kind == Guess::Kind::round_x || kind == Guess::Kind::round_y ||
      kind == Guess::Kind::diagonal ||
      (kind == Guess::Kind::again && is_in_range && grid > 0 && is_on_grid(place, grid));
  if (!is_crossing || !has_last_ || !is_in_range) {
    start_ = place;
    has_direction_ = false;
  } else {
    has_direction_ = place != start_;
  }
  has_last_ = is_in_range;
  last_ = place;
}

}  // namespace watertight::columns
