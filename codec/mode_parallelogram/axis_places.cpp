// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_parallelogram/axis_places.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "codec/mode_parallelogram/families.h"
#include "codec/mode_parallelogram/vectors.h"

namespace watertight::codec::parallelogram {
namespace {

__extension__ using Wide = __int128;

constexpr std::int64_t kRange = std::int64_t{1} << 54;  // values are below this in magnitude
constexpr int kShiftBits = 6;
constexpr int kMostShift = 40;
constexpr int kStepBits = 61;
constexpr int kMostBits = 54;
constexpr int kCountBits = 32;
// Contexts of Place (docs/format-parallelogram.md, "Values of an axis"). Its selector: a number
// that stands alone, or the distance of a value from the one before it in a list.
constexpr Context<2> kAlone{0U};
constexpr Context<2> kInList{1U};
constexpr std::uint32_t kLengths = 16;  // classes of the bit length of a distance in a list
// Numbers that stand alone have the contexts before those of the bit lengths.
constexpr Context<2 * kLengths> kOfStep{0U};
constexpr Context<2 * kLengths> kOfCount{1U};
constexpr Context<kLengths * kLengths> kNoneBefore{0U};
/// The writer expects that a residual in places is shorter than one in grid steps by this share of
/// the bits of the distance between two values. Only the choice of the kind depends on it.
constexpr double kShare = 0.7;

/// A line of equal steps: every coordinate value is floor(offset + k * step) for some integer k.
struct Line {
  double least = 0;  // the least and the greatest offset that give all values
  double greatest = 0;
  std::size_t lower = 0;  // the indices of the values that set these bounds
  std::size_t upper = 0;
};

/// The offsets with which values[i] <= offset + places[i] * step < values[i] + 1 for all i.
Line offsets_at(const std::vector<std::int64_t>& values, const std::vector<std::int64_t>& places,
                double step) {
  Line line{-1e300, 1e300, 0, 0};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double low = static_cast<double>(values[i]) - static_cast<double>(places[i]) * step;
    if (low > line.least) {
      line.least = low;
      line.lower = i;
    }
    if (low + 1 < line.greatest) {
      line.greatest = low + 1;
      line.upper = i;
    }
  }
  return line;
}

/// The number of steps from the first value to each value. The step is narrowed down by the
/// distances of values, short ones first. Returns nothing if no step of 1.2 or more fits.
std::optional<std::vector<std::int64_t>> count_steps(const std::vector<std::int64_t>& values,
                                                     double& step) {
  std::int64_t least_gap = kRange;
  for (std::size_t i = 1; i < values.size(); ++i) {
    least_gap = std::min(least_gap, values[i] - values[i - 1]);
  }
  double low = std::max(1.2, static_cast<double>(least_gap) - 1);
  double high = static_cast<double>(least_gap) + 1;
  // `reach` is the distance in the list: first to the next value, then to farther ones.
  for (std::size_t reach = 1; reach < values.size(); reach += 1 + reach / 2) {
    for (std::size_t i = 0; i + reach < values.size(); i += reach) {
      const auto distance = static_cast<double>(values[i + reach] - values[i]);
      const double fewest = std::ceil((distance - 1) / high);
      const double most = std::floor((distance + 1) / low);
      if (most < fewest || most < 1) return std::nullopt;
      if (most != fewest) continue;
      low = std::max(low, (distance - 1) / most);
      high = std::min(high, (distance + 1) / most);
      if (!(low < high)) return std::nullopt;
    }
  }
  step = 0.5 * (low + high);
  std::vector<std::int64_t> places;
  for (const std::int64_t value : values) {
    places.push_back(static_cast<std::int64_t>(
        std::floor(static_cast<double>(value - values.front()) / step + 0.5)));
    if (places.size() > 1 && places.back() <= places[places.size() - 2]) return std::nullopt;
  }
  return places;
}

/// Finds a step for which some offset gives all values, and takes the middle one of these offsets.
/// Returns false if there is no such step near `step`.
bool fit_line(const std::vector<std::int64_t>& values, const std::vector<std::int64_t>& places,
              double& step, double& offset) {
  const double reach = 2 / static_cast<double>(places.back());
  double low = step - reach;
  double high = step + reach;
  for (int turn = 0; turn < 100; ++turn) {
    step = 0.5 * (low + high);
    const Line line = offsets_at(values, places, step);
    if (line.greatest - line.least > 1e-3) {
      offset = 0.5 * (line.least + line.greatest);
      return true;
    }
    // No offset is left between the two values that set the bounds: a longer or a shorter step
    // moves these bounds apart.
    (places[line.lower] > places[line.upper] ? low : high) = step;
  }
  return false;
}

}  // namespace

std::optional<std::int64_t> AxisPlaces::value_of(std::int64_t place) const {
  if (kind_ == Kind::listed) {
    if (place < 0 || place >= static_cast<std::int64_t>(list_.size())) return std::nullopt;
    return list_[static_cast<std::size_t>(place)];
  }
  const Wide wide = kind_ == Kind::every
                        ? Wide{place}
                        : (Wide{place} * step_ + offset_) >> shift_;  // step and place below 2^63
  if (wide <= -kRange || wide >= kRange) return std::nullopt;
  return static_cast<std::int64_t>(wide);
}

std::int64_t AxisPlaces::place_of(std::int64_t value) const {
  if (kind_ == Kind::every) return value;
  if (kind_ == Kind::listed) {
    return std::lower_bound(list_.begin(), list_.end(), value) - list_.begin();
  }
  // The first place whose value is not below `value`, computed exactly.
  const Wide above = (Wide{value} << shift_) - offset_ + step_ - 1;
  return static_cast<std::int64_t>(above / step_ - (above % step_ < 0 ? 1 : 0));
}

double AxisPlaces::position_of(double coordinate) const {
  if (kind_ == Kind::every) return coordinate;
  if (kind_ == Kind::stepped) {
    // Values are rounded down: on average the line is half a unit above the coordinate.
    return ((coordinate + 0.5) * static_cast<double>(std::int64_t{1} << shift_) -
            static_cast<double>(offset_)) /
           static_cast<double>(step_);
  }
  const auto after = std::upper_bound(
      list_.begin(), list_.end(), coordinate,
      [](double wanted, std::int64_t value) { return wanted < static_cast<double>(value); });
  if (after == list_.begin()) return 0;
  const auto place = static_cast<double>(after - list_.begin() - 1);
  if (after == list_.end()) return place;
  const auto below = static_cast<double>(*(after - 1));
  return place + (coordinate - below) / (static_cast<double>(*after) - below);
}

double AxisPlaces::spread_of(double coordinate, double distance) const {
  if (kind_ == Kind::every) return distance;
  if (kind_ == Kind::stepped) {
    return distance * static_cast<double>(std::int64_t{1} << shift_) / static_cast<double>(step_);
  }
  return 0.5 * (position_of(coordinate + distance) - position_of(coordinate - distance));
}

bool AxisPlaces::code_steps(EntropyStream& stream, ModelBank& models) {
  shift_ = static_cast<int>(stream.code_bits(static_cast<std::uint64_t>(shift_), kShiftBits));
  if (shift_ > kMostShift) return false;
  const std::uint64_t whole =
      models.code_number<kPlace>(stream, kAlone, {kOfStep, kNoneBefore},
                                 static_cast<std::uint64_t>(step_ >> shift_), kMostBits);
  if (whole == 0 || (whole >> (kStepBits - shift_)) != 0) return false;
  const std::uint64_t rest = stream.code_bits(static_cast<std::uint64_t>(step_), shift_);
  step_ = static_cast<std::int64_t>((whole << shift_) | rest);
  offset_ =
      static_cast<std::int64_t>(stream.code_bits(static_cast<std::uint64_t>(offset_), shift_));
  return true;
}

/// Codes the values below 0, then those above: how many there are, and the distance of each from
/// the one before it, going away from 0.
bool AxisPlaces::code_list(EntropyStream& stream, ModelBank& models, const Limits& limits) {
  const std::vector<std::int64_t> truth = std::move(list_);
  const auto zero = std::lower_bound(truth.begin(), truth.end(), 0) - truth.begin();
  list_ = {0};
  for (const std::int64_t sign : {-1, 1}) {
    const auto there = static_cast<std::uint64_t>(sign < 0 ? zero : std::ssize(truth) - zero - 1);
    const std::uint64_t count =
        models.code_number<kPlace>(stream, kAlone, {kOfCount, kNoneBefore}, there, kCountBits);
    if (count > limits.vertices) return false;
    std::int64_t value = 0;
    auto before = capped<kLengths>(0);
    auto earlier = capped<kLengths>(0);
    for (std::int64_t i = 1; i <= static_cast<std::int64_t>(count); ++i) {
      const std::int64_t gap =
          stream.is_reading() ? 1
                              : sign * (truth[static_cast<std::size_t>(zero + sign * i)] - value);
      const auto coded = static_cast<std::int64_t>(models.code_number<kPlace>(
          stream, kInList, {trailing<kLengths>(before), combine(before, earlier)},
          static_cast<std::uint64_t>(gap - 1), kMostBits));
      value += sign * (coded + 1);
      if (stream.failed() || value <= -kRange || value >= kRange) return false;
      list_.push_back(value);
      earlier = before;
      before = capped<kLengths>(std::bit_width(static_cast<std::uint64_t>(coded)));
    }
    if (sign < 0) std::reverse(list_.begin(), list_.end());
  }
  return true;
}

Result<AxisPlaces> AxisPlaces::code(EntropyStream& stream, ModelBank& models, Kind before,
                                    const AxisPlaces& places, const Limits& limits) {
  constexpr Context<2> kIsNotEvery{0U};
  constexpr Context<2> kIsListed{1U};
  AxisPlaces result = places;
  const Context<3> kind(before);
  if (!models.code<kPlaces>(stream, {combine(kind, kIsNotEvery)}, places.kind_ != Kind::every)) {
    return AxisPlaces{};
  }
  const bool is_listed =
      models.code<kPlaces>(stream, {combine(kind, kIsListed)}, places.kind_ == Kind::listed);
  result.kind_ = is_listed ? Kind::listed : Kind::stepped;
  const bool is_sound =
      is_listed ? result.code_list(stream, models, limits) : result.code_steps(stream, models);
  if (!is_sound || stream.failed()) {
    return Error{ErrorCode::malformed, "an axis has no list of values"};
  }
  return result;
}

AxisPlaces AxisPlaces::stepped(const std::vector<std::int64_t>& values) {
  double step = 0;
  double offset = 0;
  const auto places = count_steps(values, step);
  if (!places || !fit_line(values, *places, step, offset)) return {};
  // The first vertex has the value 0, and its place must have the number 0.
  const auto zero = std::lower_bound(values.begin(), values.end(), 0) - values.begin();
  offset += static_cast<double>((*places)[static_cast<std::size_t>(zero)]) * step;
  AxisPlaces result;
  result.kind_ = Kind::stepped;
  for (int shift = 0; shift <= kMostShift; shift += 4) {
    const double unit = std::ldexp(1.0, shift);
    if (step * unit >= std::ldexp(1.0, kStepBits)) break;
    result.shift_ = shift;
    result.step_ = static_cast<std::int64_t>(std::floor(step * unit + 0.5));
    result.offset_ = std::clamp<std::int64_t>(static_cast<std::int64_t>(offset * unit), 0,
                                              (std::int64_t{1} << shift) - 1);
    const bool fits = std::all_of(values.begin(), values.end(), [&](std::int64_t value) {
      return result.value_of(result.place_of(value)) == value;
    });
    if (fits) return result;
  }
  return {};
}

AxisPlaces AxisPlaces::suggest(std::vector<std::int64_t> values) {
  const auto count = static_cast<double>(values.size());
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  const auto taken = static_cast<double>(values.size());
  if (values.size() < 2) return {};
  const double mean_gap =
      static_cast<double>(values.back() - values.front()) / static_cast<double>(values.size() - 1);
  if (mean_gap < 1.2) return {};
  const AxisPlaces steps = stepped(values);
  const double list_gain =
      kShare * count * rough_log2(mean_gap) - taken * (rough_log2(mean_gap) + 1.5);
  double step_gain = 0;
  if (steps.kind_ == Kind::stepped) {
    const double step = std::ldexp(static_cast<double>(steps.step_), -steps.shift_);
    step_gain = kShare * count * rough_log2(step) - 2 * steps.shift_ - 20;
  }
  if (step_gain <= 0 && list_gain <= 0) return {};
  if (step_gain >= list_gain) return steps;
  AxisPlaces result;
  result.kind_ = Kind::listed;
  result.list_ = std::move(values);
  return result;
}

}  // namespace watertight::codec::parallelogram
