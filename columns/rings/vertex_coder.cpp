// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/rings/vertex_coder.h"

#include <algorithm>
#include <bit>

namespace watertight::columns {
namespace {

constexpr int kVertexResidualBits = 4;
constexpr int kVertexMemory = 4;       // a length of a residual counts for 1/16 in the usual length
constexpr std::size_t kMostEqual = 4;  // coordinates of neighbours that are asked about
constexpr std::size_t kMostCorners = 64;  // of a vertex that are looked at
constexpr std::array<Question, 3> kAxes{Question::coordinate_x, Question::coordinate_y,
                                        Question::coordinate_z};

}  // namespace

void VertexCoder::restart(std::uint64_t vertices) {
  rings_ = nullptr;
  corners_.clear();
  corners_of_.clear();
  vertices_.clear();
  place_of_.clear();
  of_solids_.clear();
  run_.reset();
  count_ = vertices;
  next_ = 0;
  next_run_ = 0;
  is_started_ = false;
  axis_ = 0;
}

void VertexCoder::take_run(std::int64_t number) {
  if (!run_) {
    run_ = number;
    return;
  }
  const std::int64_t first = *run_;
  run_.reset();
  if (first < 0 || number <= 0 || first >= kMostVertexNumbers || number >= kMostVertexNumbers)
    return;
  of_solids_.emplace_back(first, first + number);
}

bool VertexCoder::is_ready() const { return is_started_ || count_ > 0; }

std::uint32_t VertexCoder::place_of(VertexNumber vertex) const {
  const std::uint32_t* const place = place_of_.find(vertex);
  return place == nullptr ? kNone : *place;
}

void VertexCoder::list_corners() {
  for (std::uint32_t ring = 0; ring < rings_->size(); ++ring) {
    const auto vertices = (*rings_)[ring];
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
      const auto corner = static_cast<std::uint32_t>(corners_.size());
      CornerList& list = corners_of_[vertices[i]];
      (list.first == kNone ? list.first : corners_[list.last].next) = corner;
      list.last = corner;
      corners_.push_back({ring, i});
    }
  }
}

void VertexCoder::find_parallelogram(std::span<const VertexNumber> ring, const Corner& corner) {
  const std::size_t size = ring.size();
  const auto at = [&](std::size_t after) { return ring[(corner.position + after) % size]; };
  if (size == 3) {
    const VertexNumber a = at(1);
    const VertexNumber b = at(2);
    const std::uint32_t first = place_of(a);
    const std::uint32_t second = place_of(b);
    if (first == kNone || second == kNone) return;
    std::uint32_t next_corner = corners_of_.find(a)->first;
    for (std::size_t i = 0; i < kMostCorners && next_corner != kNone; ++i) {
      const Corner& other = corners_[next_corner];
      next_corner = other.next;
      const auto across = (*rings_)[other.ring];
      if (across.size() != 3 || other.ring == corner.ring) continue;
      const VertexNumber next = across[(other.position + 1) % 3];
      const VertexNumber last = across[(other.position + 2) % 3];
      const VertexNumber opposite = next == b ? last : last == b ? next : -1;
      if (opposite < 0 || opposite == static_cast<VertexNumber>(next_)) continue;
      const std::uint32_t third = place_of(opposite);
      if (third != kNone) around_.parallelogram = {first, second, third};
    }
  } else if (size > 3 && around_.parallelogram[0] == kNone) {
    const std::uint32_t last = place_of(at(size - 1));
    const std::uint32_t before = place_of(at(size - 2));
    const std::uint32_t first = place_of(at(size - 3));
    if (last != kNone && before != kNone && first != kNone) {
      around_.parallelogram = {last, first, before};
    }
  }
}

void VertexCoder::look_around() {
  around_.nearest = kNone;
  around_.neighbours.clear();
  around_.parallelogram.fill(kNone);
  equal_.clear();
  const CornerList* const corners = corners_of_.find(static_cast<VertexNumber>(next_));
  if (corners == nullptr) return;
  std::uint32_t next_corner = corners->first;
  for (std::size_t i = 0; i < kMostCorners && next_corner != kNone; ++i) {
    const Corner& corner = corners_[next_corner];
    next_corner = corner.next;
    const auto ring = (*rings_)[corner.ring];
    for (const std::size_t step : {ring.size() - 1, std::size_t{1}}) {
      const std::uint32_t neighbour = place_of(ring[(corner.position + step) % ring.size()]);
      if (neighbour == kNone) continue;
      around_.neighbours.push_back(neighbour);
      if (around_.nearest == kNone || neighbour > around_.nearest) around_.nearest = neighbour;
    }
    find_parallelogram(ring, corner);
  }
  equal_ = around_.neighbours;
}

std::int64_t VertexCoder::value(std::uint32_t place, std::size_t axis, int decimals) const {
  const Coordinate& known = vertices_[place][axis];
  return with_decimals(known.number, known.decimals, decimals);
}

std::array<std::int64_t, VertexCoder::kPredictions> VertexCoder::predictions(std::size_t axis,
                                                                             int decimals) const {
  const std::int64_t last =
      with_decimals(last_vertex_[axis].number, last_vertex_[axis].decimals, decimals);
  const std::int64_t nearest =
      around_.nearest == kNone ? last : value(around_.nearest, axis, decimals);
  std::int64_t middle = nearest;
  if (!around_.neighbours.empty()) {
    std::int64_t total = 0;
    for (const std::uint32_t neighbour : around_.neighbours) {
      total = sum(total, difference(value(neighbour, axis, decimals), nearest));
    }
    middle = sum(nearest, total / static_cast<std::int64_t>(around_.neighbours.size()));
  }
  if (around_.parallelogram[0] == kNone) return {last, nearest, middle, middle, middle};
  const auto& [first, second, third] = around_.parallelogram;
  const std::int64_t corner =
      sum(value(first, axis, decimals),
          difference(value(second, axis, decimals), value(third, axis, decimals)));
  return {last, nearest, middle, corner, sum(middle, difference(corner, middle) / 2)};
}

std::optional<std::int64_t> VertexCoder::code_equal(EntropyStream& stream, ContextMixer& mixer,
                                                    std::int64_t number, int decimals) {
  // Those that had the coordinates before come first.
  std::vector<std::uint32_t> candidates = equal_;
  const std::size_t preferred = axis_ == 0 ? 0 : candidates.size();
  for (const std::uint32_t neighbour : around_.neighbours) {
    if (axis_ > 0 && std::find(equal_.begin(), equal_.end(), neighbour) == equal_.end()) {
      candidates.push_back(neighbour);
    }
  }
  const auto axis = static_cast<Hash>(axis_);
  const auto before = hash_of(axis, axis_ > 0 ? last_equal_[0] : 0, axis_ > 1 ? last_equal_[1] : 0);
  std::vector<std::int64_t> denied;
  std::optional<std::int64_t> coded;
  for (std::size_t i = 0; i < candidates.size() && denied.size() < kMostEqual && !coded; ++i) {
    const std::int64_t guess = value(candidates[i], axis_, decimals);
    if (std::find(denied.begin(), denied.end(), guess) != denied.end()) continue;
    const Hash is_preferred = i < preferred ? 1 : 0;
    const auto tried = static_cast<Hash>(denied.size());
    if (mixer.flag(stream, Question::is_equal_coordinate,
                   {hash_of(before, tried, is_preferred), hash_of(axis, tried, last_equal_[axis_]),
                    hash_of(axis, is_preferred, around_.parallelogram[0] != kNone ? 1 : 0),
                    hash_of(before, static_cast<Hash>(candidates.size()))},
                   number == guess)) {
      coded = guess;
    } else {
      denied.push_back(guess);
    }
  }
  last_equal_[axis_] = coded ? 1 + static_cast<std::uint32_t>(denied.size()) : 0;
  if (!coded) {
    if (axis_ < 2) equal_.clear();
    return std::nullopt;
  }
  std::erase_if(
      equal_, [&](std::uint32_t neighbour) { return value(neighbour, axis_, decimals) != *coded; });
  return coded;
}

std::optional<std::string> VertexCoder::code(EntropyStream& stream, ContextMixer& mixer,
                                             RingCoder& rings, std::string_view text) {
  if (!is_started_) {
    is_started_ = true;
    rings_ = &rings.finish();
    list_corners();
    std::sort(of_solids_.begin(), of_solids_.end());
  }
  NumberColumn& column = forms_[axis_];
  const auto axis = static_cast<Hash>(axis_);
  const auto chosen = stream.is_reading() ? std::nullopt : choose_form(text, column.form());
  if (axis_ == 0) {
    while (next_run_ < of_solids_.size() && of_solids_[next_run_].first <= next_) {
      next_ = std::max(next_, of_solids_[next_run_++].second);
    }
    look_around();
  }
  const auto coded_form = column.code_form(stream, mixer, hash_of(20, axis),
                                           chosen ? std::optional(chosen->form) : std::nullopt);
  if (!coded_form) return std::nullopt;
  const FormedNumber given = chosen.value_or(FormedNumber{});
  const NumberForm form = *coded_form;
  if (!form.is_decimal()) {
    const std::int64_t number =
        column.code_number(stream, mixer, hash_of(21, axis), 0, std::nullopt, given.number);
    equal_.clear();
    return take(stream, form, number, {});
  }
  const auto predicted = predictions(axis_, form.decimals);
  const std::size_t best = best_of(misses_[axis_]);
  const auto which = static_cast<Hash>(best);
  const Hash known =
      (around_.nearest != kNone ? 1U : 0U) + (around_.parallelogram[0] != kNone ? 2U : 0U);
  const Hash others = hash_of(axis_ > 0 ? last_residual_[0] : 0, axis_ > 1 ? last_residual_[1] : 0);
  const auto equal = code_equal(stream, mixer, given.number, form.decimals);
  std::int64_t number = equal.value_or(0);
  if (!equal) {
    const std::int64_t residual = difference(given.number, predicted[best]);
    const std::uint64_t size =
        mixer.number(stream, kAxes[axis_],
                     {hash_of(which, known), hash_of(others, known), last_residual_[axis_], 0},
                     magnitude(residual), kVertexResidualBits);
    const auto length = static_cast<std::uint32_t>(std::bit_width(size));
    const bool is_negative =
        size > 0 && mixer.flag(stream, Question::coordinate_sign,
                               {hash_of(axis, others), hash_of(axis, which), hash_of(axis, length)},
                               residual < 0);
    number = sum(predicted[best], static_cast<std::int64_t>(is_negative ? 0 - size : size));
    judge(misses_[axis_], predicted, number, kVertexMemory);
    last_residual_[axis_] = length * 2 + (is_negative ? 1 : 0);
  }
  return take(stream, form, number, {number, form.decimals});
}

std::string VertexCoder::take(EntropyStream& stream, const NumberForm& form, std::int64_t number,
                              const Coordinate& coordinate) {
  vertex_[axis_] = coordinate;
  if (++axis_ == 3) {
    axis_ = 0;
    place_of_[static_cast<VertexNumber>(next_++)] = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(vertex_);
    last_vertex_ = vertex_;
  }
  std::string printed = print(form, number);
  if (printed.empty()) stream.fail();
  return printed;
}

}  // namespace watertight::columns
