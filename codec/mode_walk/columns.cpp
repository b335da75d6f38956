// SPDX-License-Identifier: GPL-3.0-or-later
#include "codec/mode_walk/columns.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <span>

#include "codec/mode_walk/families.h"

namespace watertight::codec::walk {
namespace {

using Place = std::array<std::int64_t, 2>;

constexpr int kMaxLength = 30;  // the most bits of a side of the box
constexpr std::int64_t kMaxMagnitude = std::int64_t{1} << 53;

constexpr int kPositionBits = 54;  // the most bits of a coordinate of the first point
constexpr int kLengthBits = 5;     // the most bits of a length
constexpr int kCountBits = 40;     // the most bits of a number of columns or vertices
constexpr int kRankBits = 6;       // the most bits of a rank among known places

// Fixed by the format (docs/format-walk.md, "Columns").
constexpr std::size_t kHeights = 16;        // the most heights that are remembered
constexpr std::size_t kReach = 5;           // the number of last columns that make parallelograms
constexpr std::size_t kKnownReach = 4096;   // the most columns of the page that are looked at
constexpr std::uint64_t kMostKnown = 64;    // the most known places that are listed
constexpr std::int64_t kCornerMargin = 32;  // the most steps from the box to a corner

/// The length in bits of a number, or of a side of the box.
using Length = Context<kMaxLength + 1>;

// The contexts of number Size: the values that it codes. The first three are the sides of the box
// on each axis.
using SizeKind = Context<6>;
constexpr SizeKind kColumnCount{3U};
constexpr SizeKind kFirstHeight{4U};

// The contexts of family TopBits: the values that it codes.
using TopKind = Context<3>;
constexpr TopKind kFirstY{0U};
constexpr TopKind kPlaceY{1U};
constexpr TopKind kNewHeight{2U};

// The contexts of number Rank: the rank of a known place, or of a corner.
constexpr Context<2> kOfKnownPlace{0U};
constexpr Context<2> kOfCorner{1U};
// Family Place has the contexts of known places, then those of corners.
constexpr std::uint32_t kKnownPlaceContexts = 16;
constexpr std::uint32_t kCornerContexts = 64;

int length_of(std::int64_t value) {
  return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(value)));
}

class Columns {
 public:
  Columns(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
          std::vector<GridPoint>& points, const Limits& limits)
      : stream_(stream), models_(models), memory_(memory), points_(points), limits_(limits) {}

  Status run();

 private:
  struct Height {
    std::int64_t z;
    std::uint32_t uses;
  };

  bool is_reading() const { return stream_.is_reading(); }
  std::int64_t code_size(SizeKind kind, std::int64_t value, Length before, int max_length) {
    return static_cast<std::int64_t>(models_.code_number<kSize>(
        stream_, {kind, combine(kind, before)}, static_cast<std::uint64_t>(value), max_length));
  }
  std::int64_t code_top_bits(TopKind kind, std::int64_t value, int length);
  Status measure();
  Status code_box();
  bool code_place(std::size_t number, Place truth);
  bool code_known_place(Place truth, Place& place);
  bool code_corner(std::size_t number, Place truth, Place& place);
  void code_free_place(std::size_t number, Place truth, Place& place);
  bool code_floors(std::size_t number, std::span<const GridPoint> truth);
  std::int64_t code_height(std::int64_t truth, bool has_below, std::int64_t below,
                           std::uint64_t floor, std::uint64_t floors);

  EntropyStream& stream_;
  ModelBank& models_;
  const PageMemory& memory_;
  std::vector<GridPoint>& points_;
  const Limits& limits_;

  std::vector<Place> places_;
  std::vector<std::size_t> first_;  // when writing: place -> index of its first point; one more
                                    // entry at the end
  std::vector<GridPoint> decoded_;
  std::size_t place_count_ = 0;
  std::array<int, 3> length_{};        // the lengths of the sides of the box, in bits
  std::array<std::int64_t, 3> min_{};  // the smallest corner of the box
  std::array<std::int64_t, 3> start_{};
  std::vector<Height> heights_;  // the heights that were used, the latest first
  std::vector<std::int64_t> floors_before_;
  std::size_t known_ = 0;  // the first of memory_.columns that is greater than the last column
  bool was_known_ = false;
  bool is_over_limit_ = false;
};

/// Codes a number of `length` bits: the first three with models, the others plain.
std::int64_t Columns::code_top_bits(TopKind kind, std::int64_t value, int length) {
  constexpr int kModelled = 3;
  constexpr std::uint32_t kNodes = 1U << kModelled;
  std::uint32_t node = 1;  // the bits so far, after a leading 1
  const int modelled = std::min(length, kModelled);
  for (int bit = 0; bit < modelled; ++bit) {
    const Context<kNodes> known(node);
    const Length size(static_cast<std::uint32_t>(length));
    const bool one =
        models_.code<kTopBits>(stream_, {combine(kind, known), combine(kind, size, known)},
                               ((value >> (length - 1 - bit)) & 1) != 0);
    node = 2 * node + (one ? 1 : 0);
  }
  const std::int64_t result = node - (std::int64_t{1} << modelled);
  const int rest = length - modelled;
  if (rest == 0) return result;
  return (result << rest) |
         static_cast<std::int64_t>(stream_.code_bits(static_cast<std::uint64_t>(value), rest));
}

/// For writing: finds the places and the box of the points.
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

/// Codes the first point, the box and the number of columns.
Status Columns::code_box() {
  stream_.enter(StreamPart::position);
  const Context<2> first(memory_.is_first());
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::int64_t truth = is_reading() ? 0 : points_[0][axis] - memory_.last_position[axis];
    start_[axis] = memory_.last_position[axis] +
                   models_.code_signed<kPosition>(stream_, {combine(Context<3>(axis), first)},
                                                  truth, kPositionBits);
    if (start_[axis] >= kMaxMagnitude || start_[axis] <= -kMaxMagnitude) stream_.fail();
  }
  stream_.enter(StreamPart::coordinates);
  Length before(0U);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    length_[axis] = static_cast<int>(code_size(SizeKind(axis), length_[axis], before, kLengthBits));
    if (length_[axis] > kMaxLength) {
      stream_.fail();
      length_[axis] = 0;
    }
    before = Length(static_cast<std::uint32_t>(length_[axis]));
  }
  const auto columns = static_cast<std::int64_t>(place_count_) - 1;
  place_count_ =
      static_cast<std::size_t>(code_size(kColumnCount, columns, Length(0U), kCountBits)) + 1;
  if (place_count_ > limits_.vertices) {
    return Error{ErrorCode::limit_exceeded, "too many vertices"};
  }
  min_[0] = start_[0];
  min_[1] = start_[1] - code_top_bits(kFirstY, is_reading() ? 0 : start_[1] - min_[1], length_[1]);
  min_[2] = start_[2] -
            code_size(kFirstHeight, is_reading() ? 0 : start_[2] - min_[2], Length(0U), kMaxLength);
  return Done{};
}

/// Codes whether the place is a column of the page that lies in the box after the last column, and
/// if so its rank among these columns. Returns false if it is not.
bool Columns::code_known_place(Place truth, Place& place) {
  const auto& known = memory_.columns;
  const std::int64_t end_x = min_[0] + (std::int64_t{1} << length_[0]);
  const std::int64_t end_y = min_[1] + (std::int64_t{1} << length_[1]);
  while (known_ < known.size() && known[known_] <= places_.back()) ++known_;
  std::uint64_t count = 0;
  std::uint64_t rank = 0;
  bool is_known = false;
  const std::size_t end = std::min(known.size(), known_ + kKnownReach);
  for (std::size_t i = known_; i < end && known[i][0] < end_x && count < kMostKnown; ++i) {
    if (known[i][1] < min_[1] || known[i][1] >= end_y) continue;
    if (known[i] == truth) {
      is_known = true;
      rank = count;
    }
    ++count;
  }
  if (count == 0) return false;
  const auto amount = capped<8>(count);
  is_known = models_.code<kPlace>(
      stream_, {leading<kCornerContexts>(combine(amount, Context<2>(was_known_)))}, is_known);
  was_known_ = is_known;
  if (!is_known) return false;
  rank = models_.code_number<kRank>(stream_, {combine(kOfKnownPlace, amount)}, rank, kRankBits);
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

/// Codes whether the place is near the fourth corner of a parallelogram of three of the last
/// columns, and its offset from there. Returns false if it is not.
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
        const bool is_possible =
            corner[0] >= last_x - kCornerMargin && corner[0] < end_x + kCornerMargin &&
            corner[1] >= min_[1] - kCornerMargin && corner[1] < end_y + kCornerMargin;
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
  const auto amount = capped<8>(count);
  const bool is_corner = models_.code<kPlace>(
      stream_, {trailing<kKnownPlaceContexts>(combine(amount, capped<8>(number)))},
      bits < free_bits);
  if (!is_corner) return false;
  const std::uint64_t rank = models_.code_number<kRank>(
      stream_, {combine(kOfCorner, amount)}, best, length_of(static_cast<std::int64_t>(count)));
  if (rank >= count) {
    stream_.fail();
    place = places_.back();
    return true;
  }
  Context<8> before(0U);
  for (std::uint32_t axis = 0; axis < 2; ++axis) {
    const Context<2> along(axis);
    const std::int64_t off = models_.code_signed<kResidual>(
        stream_, along, {combine(along, before)},
        is_reading() ? 0 : truth[axis] - corners[rank][axis], kMaxLength);
    place[axis] = corners[rank][axis] + off;
    before = capped<8>(length_of(std::abs(off)));
  }
  return true;
}

/// Codes a place without a prediction: x by its distance from the last place, y within the box.
void Columns::code_free_place(std::size_t number, Place truth, Place& place) {
  const std::int64_t last_x = places_.back()[0];
  const std::int64_t left =
      std::max<std::int64_t>(min_[0] + (std::int64_t{1} << length_[0]) - last_x, 1);
  const std::int64_t mean = left / static_cast<std::int64_t>(place_count_ - number);
  const auto gap = capped<kMaxLength + 1>(length_of(mean));
  place[0] =
      last_x + static_cast<std::int64_t>(models_.code_number<kGap>(
                   stream_, {gap}, is_reading() ? 0 : static_cast<std::uint64_t>(truth[0] - last_x),
                   kMaxLength));
  place[1] = min_[1] + code_top_bits(kPlaceY, is_reading() ? 0 : truth[1] - min_[1], length_[1]);
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

/// Codes a height: one of the remembered heights, or a new one.
std::int64_t Columns::code_height(std::int64_t truth, bool has_below, std::int64_t below,
                                  std::uint64_t floor, std::uint64_t floors) {
  auto rank = capped<8>(0);
  const auto at = capped<3>(floor);
  const auto of = capped<4>(floors - 1);
  for (std::size_t i = 0; i < heights_.size(); ++i) {
    const Height height = heights_[i];
    if (has_below && height.z <= below) continue;
    const Context<2> is_same(floor < floors_before_.size() && floors_before_[floor] == height.z);
    const auto uses = capped<4>(height.uses - 1);
    const bool is_this = models_.code<kHeight>(
        stream_, {combine(rank, at, of), combine(is_same, rank, at), combine(uses, rank, of)},
        height.z == truth);
    if (is_this) {
      std::rotate(heights_.begin(), heights_.begin() + static_cast<std::ptrdiff_t>(i),
                  heights_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      ++heights_[0].uses;
      return height.z;
    }
    rank = capped<8>(rank.value + 1);
  }
  const std::int64_t z = min_[2] + code_top_bits(kNewHeight, truth - min_[2], length_[2]);
  if (heights_.size() == kHeights) heights_.pop_back();
  heights_.insert(heights_.begin(), {z, 1});
  return z;
}

bool Columns::code_floors(std::size_t number, std::span<const GridPoint> truth) {
  const std::uint64_t count =
      models_.code_number<kFloors>(stream_, {capped<6>(floors_before_.size())},
                                   is_reading() ? 0 : truth.size() - 1, kCountBits) +
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
      z = code_height(is_reading() ? 0 : truth[i][2], has_below, below, i, count);
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
  if (Status status = code_box(); !status) return status;
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

Status code_columns(EntropyStream& stream, ModelBank& models, const PageMemory& memory,
                    std::vector<GridPoint>& points, const Limits& limits) {
  return Columns(stream, models, memory, points, limits).run();
}

}  // namespace watertight::codec::walk
