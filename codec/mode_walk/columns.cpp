// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_walk/columns.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>

namespace watertight::codec::walk {
namespace {

using Place = std::array<std::int64_t, 2>;

constexpr int kMaxLength = 30;  // bits of a side of the box
constexpr std::int64_t kMaxMagnitude = std::int64_t{1} << 53;

// Families.
constexpr std::uint32_t kChoice = 0;  // is the place a known one, or that of a parallelogram?
constexpr std::uint32_t kHeight = 1;  // is it this height, of those seen?
constexpr std::uint32_t kTopBits = 2;
constexpr std::uint32_t kTopNodes = 8;
// Numbers.
constexpr std::uint32_t kPosition = 0;
constexpr std::uint32_t kSize = 1;
constexpr std::uint32_t kGap = 2;
constexpr std::uint32_t kResidual = 3;
constexpr std::uint32_t kRank = 4;
constexpr std::uint32_t kFloors = 5;
// Kinds of kSize.
constexpr std::uint32_t kSizeKinds = 6;

constexpr std::size_t kHeights = 16;       // remembered
constexpr std::size_t kReach = 5;          // columns back that parallelograms are made of
constexpr std::size_t kKnownReach = 4096;  // of the page's columns that are looked at for one

int length_of(std::int64_t value) {
  return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(value)));
}

class Columns {
 public:
  Columns(EntropyStream& stream, const ColumnModels& models, const PageMemory& memory,
          std::vector<GridPoint>& points, const Limits& limits)
      : stream_(stream), models_(models), memory_(memory), points_(points), limits_(limits) {}

  Status run();

 private:
  struct Height {
    std::int64_t z;
    std::uint32_t uses;
  };

  bool is_reading() const { return stream_.is_reading(); }
  std::int64_t size(std::uint32_t kind, std::int64_t value, int before, int max_length) {
    const auto context = static_cast<std::uint32_t>(before);
    return static_cast<std::int64_t>(models_.bank.code_number(
        stream_, models_.first_number + kSize, 0, {kind, kind * (kMaxLength + 1) + context},
        static_cast<std::uint64_t>(value), max_length));
  }
  std::int64_t top_bits(std::uint32_t kind, std::int64_t value, int length);
  Status measure();
  Status code_frame();
  bool code_place(std::size_t number, Place truth);
  bool code_known_place(Place truth, Place& place);
  bool code_corner(std::size_t number, Place truth, Place& place);
  void code_free_place(std::size_t number, Place truth, Place& place);
  bool code_floors(std::size_t number, std::span<const GridPoint> truth);
  std::int64_t code_height(std::int64_t truth, bool has_below, std::int64_t below,
                           std::uint32_t floor, std::uint32_t floors);

  EntropyStream& stream_;
  const ColumnModels& models_;
  const PageMemory& memory_;
  std::vector<GridPoint>& points_;
  const Limits& limits_;

  std::vector<Place> places_;
  std::vector<std::size_t> first_;  // writing: place -> first point; one more entry
  std::vector<GridPoint> decoded_;
  std::size_t place_count_ = 0;
  std::array<int, 3> length_{};        // of the sides of the box
  std::array<std::int64_t, 3> min_{};  // of the box
  std::array<std::int64_t, 3> start_{};
  std::vector<Height> heights_;  // the last used first
  std::vector<std::int64_t> floors_before_;
  std::size_t known_ = 0;  // place in memory_.columns behind the last column
  bool was_known_ = false;
  bool is_over_limit_ = false;
};

/// A number of `length` bits: the first three under models, the others plain.
std::int64_t Columns::top_bits(std::uint32_t kind, std::int64_t value, int length) {
  std::uint32_t node = 1;
  std::int64_t result = 0;
  const int modelled = std::min(length, 3);
  for (int bit = 0; bit < modelled; ++bit) {
    const bool one =
        models_.bank.code(stream_, models_.first_family + kTopBits, 0,
                          {kind * kTopNodes + node,
                           (kind * 31 + static_cast<std::uint32_t>(length)) * kTopNodes + node},
                          ((value >> (length - 1 - bit)) & 1) != 0);
    node = 2 * node + (one ? 1 : 0);
    result = 2 * result + (one ? 1 : 0);
  }
  const int rest = length - modelled;
  if (rest == 0) return result;
  return (result << rest) |
         static_cast<std::int64_t>(stream_.code_bits(static_cast<std::uint64_t>(value), rest));
}

/// Writing: finds the places and the box.
Status Columns::measure() {
  std::array<std::int64_t, 3> max = points_[0];
  min_ = points_[0];
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const GridPoint& p = points_[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      min_[axis] = std::min(min_[axis], p[axis]);
      max[axis] = std::max(max[axis], p[axis]);
    }
    if (!places_.empty() && places_.back() == Place{p[0], p[1]}) continue;
    places_.push_back({p[0], p[1]});
    first_.push_back(i);
  }
  first_.push_back(points_.size());
  place_count_ = places_.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    length_[axis] = length_of(max[axis] - min_[axis]);
    if (length_[axis] > kMaxLength) {
      return Error{ErrorCode::not_encodable, "the solid is too large for its grid"};
    }
  }
  return Done{};
}

/// The first point, the box and the number of columns.
Status Columns::code_frame() {
  stream_.enter(StreamPart::position);
  const std::uint32_t first = memory_.is_first() ? 1 : 0;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::int64_t truth = is_reading() ? 0 : points_[0][axis] - memory_.last_position[axis];
    start_[axis] = memory_.last_position[axis] +
                   models_.bank.code_signed(stream_, models_.first_number + kPosition, 0,
                                            {2 * axis + first}, truth, 54);
    if (start_[axis] >= kMaxMagnitude || start_[axis] <= -kMaxMagnitude) stream_.fail();
  }
  stream_.enter(StreamPart::coordinates);
  int before = 0;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    length_[axis] = static_cast<int>(size(axis, length_[axis], before, 5));
    if (length_[axis] > kMaxLength) {
      stream_.fail();
      length_[axis] = 0;
    }
    before = length_[axis];
  }
  place_count_ =
      static_cast<std::size_t>(size(3, static_cast<std::int64_t>(place_count_) - 1, 0, 40)) + 1;
  if (place_count_ > limits_.vertices) {
    return Error{ErrorCode::limit_exceeded, "too many vertices"};
  }
  min_[0] = start_[0];
  min_[1] = start_[1] - top_bits(0, is_reading() ? 0 : start_[1] - min_[1], length_[1]);
  min_[2] = start_[2] - size(4, is_reading() ? 0 : start_[2] - min_[2], 0, kMaxLength);
  return Done{};
}

/// A place that the page has, among those behind the last column in the box.
bool Columns::code_known_place(Place truth, Place& place) {
  const auto& known = memory_.columns;
  const std::int64_t end_x = min_[0] + (std::int64_t{1} << length_[0]);
  const std::int64_t end_y = min_[1] + (std::int64_t{1} << length_[1]);
  while (known_ < known.size() && known[known_] <= places_.back()) ++known_;
  std::uint64_t count = 0;
  std::uint64_t rank = 0;
  bool is_known = false;
  constexpr std::uint64_t kMost = 64;
  const std::size_t end = std::min(known.size(), known_ + kKnownReach);
  for (std::size_t i = known_; i < end && known[i][0] < end_x && count < kMost; ++i) {
    if (known[i][1] < min_[1] || known[i][1] >= end_y) continue;
    if (known[i] == truth) {
      is_known = true;
      rank = count;
    }
    ++count;
  }
  if (count == 0) return false;
  const auto amount = static_cast<std::uint32_t>(std::min<std::uint64_t>(count, 7));
  is_known = models_.bank.code(stream_, models_.first_family + kChoice, 0,
                               {amount * 2 + (was_known_ ? 1 : 0)}, is_known);
  was_known_ = is_known;
  if (!is_known) return false;
  rank = models_.bank.code_number(stream_, models_.first_number + kRank, 0, {amount}, rank, 6);
  std::uint64_t place_rank = 0;
  for (std::size_t i = known_; i < end && known[i][0] < end_x; ++i) {
    if (known[i][1] < min_[1] || known[i][1] >= end_y) continue;
    if (place_rank++ < rank) continue;
    place = known[i];
    return true;
  }
  stream_.fail();
  place = places_.back();
  return true;
}

/// A place near the fourth corner of a parallelogram of the last columns.
bool Columns::code_corner(std::size_t number, Place truth, Place& place) {
  std::array<Place, kReach*(kReach - 1) * (kReach - 2) / 2> corners;
  std::size_t count = 0;
  const std::size_t low = number > kReach ? number - kReach : 0;
  const std::int64_t end_y = min_[1] + (std::int64_t{1} << length_[1]);
  const std::int64_t end_x = min_[0] + (std::int64_t{1} << length_[0]);
  const std::int64_t last_x = places_.back()[0];
  for (std::size_t c = low; c < number; ++c) {
    for (std::size_t a = low; a < number; ++a) {
      for (std::size_t b = a + 1; b < number; ++b) {
        if (a == c || b == c) continue;
        const Place corner{places_[a][0] + places_[b][0] - places_[c][0],
                           places_[a][1] + places_[b][1] - places_[c][1]};
        const bool is_possible = corner[0] >= last_x - 32 && corner[0] < end_x + 32 &&
                                 corner[1] >= min_[1] - 32 && corner[1] < end_y + 32;
        if (is_possible) corners[count++] = corner;
      }
    }
  }
  if (count == 0) return false;
  std::size_t best = 0;
  std::int64_t best_off = kMaxMagnitude;
  for (std::size_t i = 0; i < count && !is_reading(); ++i) {
    const std::int64_t off =
        std::max(std::abs(corners[i][0] - truth[0]), std::abs(corners[i][1] - truth[1]));
    if (off >= best_off) continue;
    best_off = off;
    best = i;
  }
  const int bits =
      2 * length_of(is_reading() ? 0 : best_off) + length_of(static_cast<std::int64_t>(count)) + 3;
  const int free_bits =
      length_[0] + length_[1] - length_of(static_cast<std::int64_t>(place_count_ - number));
  const auto amount = static_cast<std::uint32_t>(std::min<std::size_t>(count, 7));
  const bool is_corner = models_.bank.code(
      stream_, models_.first_family + kChoice, 0,
      {16 + amount * 8 + static_cast<std::uint32_t>(std::min<std::size_t>(number, 7))},
      bits < free_bits);
  if (!is_corner) return false;
  const std::uint64_t rank =
      models_.bank.code_number(stream_, models_.first_number + kRank, 0, {8 + amount}, best,
                               length_of(static_cast<std::int64_t>(count)));
  if (rank >= count) {
    stream_.fail();
    place = places_.back();
    return true;
  }
  std::uint32_t before = 0;
  for (std::uint32_t axis = 0; axis < 2; ++axis) {
    const std::int64_t off = models_.bank.code_signed(
        stream_, models_.first_number + kResidual, axis, {axis * 8 + before},
        is_reading() ? 0 : truth[axis] - corners[rank][axis], kMaxLength);
    place[axis] = corners[rank][axis] + off;
    before = static_cast<std::uint32_t>(std::min(length_of(std::abs(off)), 7));
  }
  return true;
}

/// Any place: x by its distance from the last, y in the box.
void Columns::code_free_place(std::size_t number, Place truth, Place& place) {
  const std::int64_t last_x = places_.back()[0];
  const std::int64_t left =
      std::max<std::int64_t>(min_[0] + (std::int64_t{1} << length_[0]) - last_x, 1);
  const auto gap = static_cast<std::uint32_t>(
      std::min(length_of(left / static_cast<std::int64_t>(place_count_ - number)), kMaxLength));
  place[0] =
      last_x + static_cast<std::int64_t>(models_.bank.code_number(
                   stream_, models_.first_number + kGap, 0, {gap},
                   is_reading() ? 0 : static_cast<std::uint64_t>(truth[0] - last_x), kMaxLength));
  place[1] = min_[1] + top_bits(1, is_reading() ? 0 : truth[1] - min_[1], length_[1]);
}

bool Columns::code_place(std::size_t number, Place truth) {
  Place place{start_[0], start_[1]};
  if (number > 0 && !code_known_place(truth, place) && !code_corner(number, truth, place)) {
    code_free_place(number, truth, place);
  }
  if (stream_.failed()) return false;
  if (is_reading()) {
    const bool is_next = number == 0 || places_[number - 1] < place;
    if (!is_next || std::abs(place[0]) >= kMaxMagnitude || std::abs(place[1]) >= kMaxMagnitude) {
      return false;
    }
  }
  places_.push_back(place);
  return true;
}

/// One of the heights seen, or a new one.
std::int64_t Columns::code_height(std::int64_t truth, bool has_below, std::int64_t below,
                                  std::uint32_t floor, std::uint32_t floors) {
  std::uint32_t rank = 0;
  const std::uint32_t at = std::min(floor, 2U);
  const std::uint32_t of = std::min(floors, 4U) - 1;
  for (std::size_t i = 0; i < heights_.size(); ++i) {
    const Height height = heights_[i];
    if (has_below && height.z <= below) continue;
    const bool is_same = floor < floors_before_.size() && floors_before_[floor] == height.z;
    const std::uint32_t uses = std::min(height.uses, 4U) - 1;
    const bool is_this =
        models_.bank.code(stream_, models_.first_family + kHeight, 0,
                          {(rank * 3 + at) * 4 + of, ((is_same ? 1U : 0U) * 8 + rank) * 3 + at,
                           (uses * 8 + rank) * 4 + of},
                          height.z == truth);
    if (is_this) {
      std::rotate(heights_.begin(), heights_.begin() + static_cast<std::ptrdiff_t>(i),
                  heights_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      ++heights_[0].uses;
      return height.z;
    }
    rank = std::min(rank + 1, 7U);
  }
  const std::int64_t z = min_[2] + top_bits(2, truth - min_[2], length_[2]);
  if (heights_.size() == kHeights) heights_.pop_back();
  heights_.insert(heights_.begin(), {z, 1});
  return z;
}

bool Columns::code_floors(std::size_t number, std::span<const GridPoint> truth) {
  const auto before = static_cast<std::uint32_t>(std::min<std::size_t>(floors_before_.size(), 5));
  const std::uint64_t count =
      models_.bank.code_number(stream_, models_.first_number + kFloors, 0, {before},
                               is_reading() ? 0 : truth.size() - 1, 40) +
      1;
  if (count > limits_.vertices - decoded_.size()) {
    is_over_limit_ = true;
    return false;
  }
  std::vector<std::int64_t> floors;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (stream_.failed()) return false;
    const bool has_below = i > 0;
    const std::int64_t below = has_below ? floors.back() : 0;
    std::int64_t z = start_[2];
    if (number > 0 || i > 0) {
      z = code_height(is_reading() ? 0 : truth[i][2], has_below, below,
                      static_cast<std::uint32_t>(std::min<std::uint64_t>(i, 255)),
                      static_cast<std::uint32_t>(std::min<std::uint64_t>(count, 255)));
    } else {
      heights_.push_back({z, 1});
    }
    if (has_below && z <= below) return false;
    if (std::abs(z) >= kMaxMagnitude) return false;
    floors.push_back(z);
    decoded_.push_back({places_[number][0], places_[number][1], z});
  }
  floors_before_ = std::move(floors);
  return true;
}

Status Columns::run() {
  if (!is_reading()) {
    if (Status status = measure(); !status) return status;
  }
  const std::vector<Place> truth = std::move(places_);
  places_.clear();
  if (Status status = code_frame(); !status) return status;
  const Error malformed{ErrorCode::malformed, "the columns of the vertices"};
  for (std::size_t i = 0; i < place_count_; ++i) {
    if (!code_place(i, is_reading() ? Place{} : truth[i])) return malformed;
  }
  for (std::size_t i = 0; i < place_count_; ++i) {
    std::span<const GridPoint> floors;
    if (!is_reading()) floors = std::span(points_).subspan(first_[i], first_[i + 1] - first_[i]);
    if (code_floors(i, floors)) continue;
    return is_over_limit_ ? Error{ErrorCode::limit_exceeded, "too many vertices"} : malformed;
  }
  if (is_reading()) points_ = std::move(decoded_);
  return Done{};
}

}  // namespace

const std::array<FamilyShape, kColumnFamilyCount> kColumnFamilies{
    FamilyShape{1, {80}}, FamilyShape{1, {8 * 3 * 4, 2 * 8 * 3, 4 * 8 * 4}},
    FamilyShape{1, {3 * kTopNodes, 3 * 31 * kTopNodes}}};
const std::array<NumberShape, kColumnNumberCount> kColumnNumbers{
    NumberShape{1, {6}},  NumberShape{1, {kSizeKinds, kSizeKinds*(kMaxLength + 1)}},
    NumberShape{1, {31}}, NumberShape{2, {16}},
    NumberShape{1, {16}}, NumberShape{1, {6}}};

Status code_columns(EntropyStream& stream, const ColumnModels& models, const PageMemory& memory,
                    std::vector<GridPoint>& points, const Limits& limits) {
  return Columns(stream, models, memory, points, limits).run();
}

}  // namespace watertight::codec::walk
