// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/rings/position_coder.h"

#include <algorithm>
#include <bit>

namespace watertight::columns {
namespace {

constexpr int kPositionResidualBits = 4;
constexpr int kPositionMemory = 4;
constexpr int kPositionIndexBits = 12;
constexpr std::uint32_t kFewPositions = 6;
constexpr std::size_t kMostKnown = 4096;
constexpr std::size_t kMostSeen = 65'536;
constexpr std::size_t kMostNeighbours = 4;
constexpr int kMostUnits = 4;  // decimals of x and y of lines
constexpr std::array<std::int64_t, kMostUnits + 1> kUnits{1, 10, 100, 1000, 10'000};

}  // namespace

void PositionCoder::Known::add(std::int64_t number) {
  if (numbers.size() == kMostKnown) return;
  std::uint32_t& index = index_of[number];
  if (index_of.size() == numbers.size()) return;
  index = static_cast<std::uint32_t>(numbers.size());
  numbers.push_back(number);
}

Hash PositionCoder::place_of(const Position& position) {
  Hash hash = 0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto bits = static_cast<std::uint64_t>(position[axis]);
    hash = hash_of(hash, static_cast<Hash>(bits), static_cast<Hash>(bits >> 32U));
  }
  return hash;
}

/// What is known of a place with x and y of a position; null if it is new.
const PositionCoder::Seen* PositionCoder::find_seen(const List& list, const Position& position) {
  const Seen* const found = list.seen.find(place_of(position));
  const bool is_there =
      found != nullptr && found->position[0] == position[0] && found->position[1] == position[1];
  return is_there ? found : nullptr;
}

/// Walls that two buildings share have two lines with the same positions.
void PositionCoder::guess_again(const List& list, std::uint32_t axis, std::vector<Guess>& guesses) {
  if (axis == 2) {
    const Seen* seen = find_seen(list, list.position);
    if (seen != nullptr) guesses.push_back({Guess::Kind::again, seen->position[2]});
    return;
  }
  const bool is_started = axis == 0 || list.kinds[0] == Guess::Kind::again;
  const Seen* last = is_started && list.count > 0 ? find_seen(list, list.last[0]) : nullptr;
  for (std::size_t i = 0; last != nullptr && i < last->neighbours.size(); ++i) {
    const Position& neighbour = last->neighbours[i];
    if (list.count > 1 && neighbour == list.last[1]) continue;
    if (axis == 1 && neighbour[0] != list.position[0]) continue;
    guesses.push_back({Guess::Kind::again, neighbour[axis]});
  }
  if (axis == 0) return;
  const std::int64_t* const y = list.y_of.find(list.position[0]);
  if (y != nullptr) guesses.push_back({Guess::Kind::again, *y});
}

/// Takes the position, and the one before it as its neighbour.
void PositionCoder::remember(List& list) {
  if (std::max(list.seen.size(), list.y_of.size()) >= kMostSeen) return;
  const auto add = [&](const Position& position, const Position& neighbour) {
    const std::size_t before = list.seen.size();
    Seen& seen = list.seen[place_of(position)];
    if (list.seen.size() > before) seen.position = position;
    if (seen.position != position || seen.neighbours.size() == kMostNeighbours) return;
    auto& known = seen.neighbours;
    if (std::find(known.begin(), known.end(), neighbour) == known.end()) known.push_back(neighbour);
  };
  list.y_of[list.position[0]] = list.position[1];
  if (list.count == 0) return;
  add(list.last[0], list.position);
  add(list.position, list.last[0]);
}

void PositionCoder::begin(List& list, const Place& place) {
  // A list of one position goes on with the positions of the element before it.
  if (place.index == 0 && place.last_length != place.axes) {
    list.count = 0;
    list.line.restart();
  }
}

void PositionCoder::rescale(List& list, std::uint32_t axis, int decimals) {
  const int before = list.decimals[axis];
  if (before == decimals) return;
  list.decimals[axis] = decimals;
  for (Position* position : {&list.first, &list.last[0], &list.last[1], &list.last[2]}) {
    (*position)[axis] = with_decimals((*position)[axis], before, decimals);
  }
  list.known[axis] = {};
  list.seen.clear();
  list.y_of.clear();
}

void PositionCoder::guess(const List& list, std::uint32_t axis, std::uint32_t axes,
                          std::vector<Guess>& guesses) {
  guesses.clear();
  if (list.count == 0) {
    if (axis > 0) guess_again(list, axis, guesses);
    return;
  }
  const bool is_first = axis > 0 && list.kinds[0] == Guess::Kind::first;
  if (list.count > 2 && (axis == 0 || is_first)) {
    guesses.push_back({Guess::Kind::first, list.first[axis]});
  }
  guess_again(list, axis, guesses);
  if (axes == 3 && axis == 0) list.line.add_for_x(guesses);
  if (axes == 3 && axis == 1 && !is_first && list.kinds[0] != Guess::Kind::again) {
    list.line.add_for_y(guesses, list.position[0], list.kinds[0]);
  }
  guesses.push_back({Guess::Kind::last, list.last[0][axis]});
  if (list.count > 2) {
    guesses.push_back({Guess::Kind::parallelogram,
                       sum(list.last[0][axis], difference(list.last[2][axis], list.last[1][axis])),
                       false});
  }
}

std::array<std::int64_t, PositionCoder::kPredictions> PositionCoder::predictions(
    const List& list, std::uint32_t axis) {
  const std::int64_t last = list.last[0][axis];
  return {last, list.last[1][axis], sum(last, difference(last, list.last[1][axis])),
          sum(last, difference(list.last[2][axis], list.last[1][axis]))};
}

/// Codes a number as one that the axis had before; none if it had not, or if that takes more than
/// its residual.
std::optional<std::int64_t> PositionCoder::code_known(EntropyStream& stream, ContextMixer& mixer,
                                                      List& list, Hash column, Hash others,
                                                      std::int64_t number, std::int64_t residual) {
  Known& known = list.known[list.next_axis];
  if (known.numbers.empty()) return std::nullopt;
  std::optional<std::uint32_t> index;
  if (!stream.is_reading()) {
    const std::uint32_t* const found = known.index_of.find(number);
    if (found != nullptr && std::bit_width(*found) < std::bit_width(magnitude(residual))) {
      index = *found;
    }
  }
  if (!mixer.flag(stream, Question::is_known_coordinate,
                  {hash_of(column, others), hash_of(column, known.last_index), column},
                  index.has_value())) {
    known.last_index = 0;
    return std::nullopt;
  }
  const std::uint64_t coded =
      mixer.number(stream, Question::known_coordinate,
                   {column, hash_of(column, others), hash_of(column, known.last_index)},
                   index.value_or(0), kPositionIndexBits);
  if (coded >= known.numbers.size()) {
    stream.fail();
    return 0;
  }
  known.last_index = static_cast<std::uint32_t>(coded) + 1;
  return known.numbers[static_cast<std::size_t>(coded)];
}

std::int64_t PositionCoder::code_number(EntropyStream& stream, ContextMixer& mixer, List& list,
                                        const Place& place, std::int64_t number) {
  const std::uint32_t axis = list.next_axis;
  const Hash column = hash_of(place.column, axis);
  guess(list, axis, place.axes, guesses_);
  const Hash others =
      axis == 0 ? static_cast<Hash>(list.last_kind) + 16 : static_cast<Hash>(list.kinds[axis - 1]);
  const Hash where = std::min(list.count, kFewPositions);
  const bool is_last = place.index + place.axes >= place.last_length + axis;
  Hash denied = 0;
  for (std::size_t i = 0; i < guesses_.size(); ++i) {
    const Guess& made = guesses_[i];
    const bool was_denied =
        std::any_of(guesses_.begin(), guesses_.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const Guess& other) { return other.number == made.number; });
    if (was_denied) continue;
    const auto kind = static_cast<Hash>(made.kind);
    const std::int64_t off = difference(number, made.number);
    const std::int64_t most = made.is_exact ? 0 : Guess::kMostOff;
    const bool is_near = mixer.flag(
        stream, Question::is_near_guess,
        {hash_of(column, kind, denied, others), hash_of(column, kind, where, is_last ? 1 : 0),
         hash_of(kind, others, axis), hash_of(kind, denied, where)},
        off >= -most && off <= most);
    if (!is_near) {
      denied = denied * 8 + kind + 1;
      continue;
    }
    list.kinds[axis] = made.kind;
    if (made.is_exact) return made.number;
    const auto symbol = mixer.symbol(stream, Question::guess_residual,
                                     {hash_of(column, kind), hash_of(kind, list.last_size[axis])},
                                     3, static_cast<std::uint32_t>(off + most));
    return sum(made.number, static_cast<std::int64_t>(symbol) - most);
  }
  list.kinds[axis] = Guess::Kind::none;
  const auto predicted = predictions(list, axis);
  const std::size_t best = best_of(list.misses[axis]);
  const auto which = static_cast<Hash>(best);
  const std::int64_t residual = difference(number, predicted[best]);
  if (const auto known = code_known(stream, mixer, list, column, others, number, residual)) {
    return *known;
  }
  const std::uint64_t size =
      mixer.number(stream, Question::coordinate_x,
                   {hash_of(column, which, where), hash_of(column, list.last_size[axis], others),
                    hash_of(which, list.last_size[axis], axis),
                    hash_of(column, denied, axis > 0 ? list.last_size[0] : 0)},
                   magnitude(residual), kPositionResidualBits);
  const auto length = static_cast<std::uint32_t>(std::bit_width(size));
  const bool is_negative =
      size > 0 && mixer.flag(stream, Question::coordinate_sign,
                             {hash_of(column, list.last_size[axis]), hash_of(column, which, others),
                              hash_of(column, length)},
                             residual < 0);
  list.last_size[axis] = length * 2 + (is_negative ? 1 : 0);
  return sum(predicted[best], static_cast<std::int64_t>(is_negative ? 0 - size : size));
}

void PositionCoder::take(List& list, std::uint32_t axes) {
  if (list.count == 0) list.first = list.position;
  remember(list);
  if (axes == 3) {
    const bool is_planar = list.decimals[0] == list.decimals[1] && list.decimals[0] <= kMostUnits;
    list.line.set_unit(is_planar ? kUnits[static_cast<std::size_t>(list.decimals[0])] : 0);
    const Guess::Kind kind = list.kinds[0] == Guess::Kind::none ? list.kinds[1] : list.kinds[0];
    list.line.take({list.position[0], list.position[1]}, kind);
  }
  list.last = {list.position, list.last[0], list.last[1]};
  list.last_kind = list.kinds[0] == Guess::Kind::none ? list.kinds[1] : list.kinds[0];
  ++list.count;
  list.kinds.fill(Guess::Kind::none);
}

PositionCoder::List& PositionCoder::list_at(Hash path) {
  const std::uint32_t* const known = list_of_.find(path);
  if (known != nullptr) return lists_[*known];
  list_of_[path] = static_cast<std::uint32_t>(lists_.size());
  return lists_.emplace_back();
}

std::optional<std::string> PositionCoder::code(EntropyStream& stream, ContextMixer& mixer,
                                               const Place& place, std::string_view text) {
  List& list = list_at(place.path);
  const std::uint32_t axis = place.index % place.axes;
  if (axis == 0) begin(list, place);
  list.next_axis = axis;
  NumberColumn& column = list.forms[axis];
  std::optional<FormedNumber> chosen;
  if (!stream.is_reading()) chosen = choose_form(text, column.form());
  if (chosen && !chosen->form.is_decimal()) chosen.reset();
  if (!mixer.flag(stream, Question::text_kind, {hash_of(place.column, 1)}, chosen.has_value())) {
    list.count = 0;
    return std::nullopt;
  }
  const FormedNumber given = chosen.value_or(FormedNumber{});
  const auto coded_form = column.code_form(stream, mixer, hash_of(place.column, 2), given.form);
  if (!coded_form || !coded_form->is_decimal()) {
    stream.fail();
    return std::nullopt;
  }
  const NumberForm form = *coded_form;
  rescale(list, axis, form.decimals);
  const std::int64_t number = code_number(stream, mixer, list, place, given.number);
  std::string printed = print(form, number);
  if (printed.empty()) {
    stream.fail();
    return printed;
  }
  if (list.count > 0) judge(list.misses[axis], predictions(list, axis), number, kPositionMemory);
  list.position[axis] = number;
  list.known[axis].add(number);
  if (axis + 1 == place.axes) take(list, place.axes);
  return printed;
}

}  // namespace watertight::columns
