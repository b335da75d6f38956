// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the coordinates of lists of positions in XML: those of surfaces and lines that belong to no
// solid, and of textures. Internal to columns/.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "columns/flat_map.h"
#include "columns/models/context_mixer.h"
#include "columns/models/number_coder.h"
#include "columns/place.h"
#include "columns/rings/line_guesses.h"

namespace watertight::columns {

class PositionCoder {
 public:
  /// Codes a coordinate. Requires place.axes of 2 or 3. None when its text is no decimal; that is
  /// coded then, and the text is to be coded elsewhere.
  std::optional<std::string> code(EntropyStream& stream, ContextMixer& mixer, const Place& place,
                                  std::string_view text);

 private:
  static constexpr std::size_t kMostAxes = 3;
  static constexpr std::size_t kPredictions = 4;
  using Position = std::array<std::int64_t, kMostAxes>;
  /// The different coordinates of an axis, while they are few.
  struct Known {
    std::vector<std::int64_t> numbers;
    FlatMap<std::int64_t, std::uint32_t> index_of;
    std::uint32_t last_index = 0;
    void add(std::int64_t number);
  };
  /// A position of three axes with those that were before or after it.
  struct Seen {
    Position position{};
    std::vector<Position> neighbours;  // the different ones, at most kMostNeighbours
  };
  /// The lists at a path.
  struct List {
    FlatMap<Hash, Seen> seen;                  // by a hash of x and y
    FlatMap<std::int64_t, std::int64_t> y_of;  // the last y after an x
    std::array<Known, kMostAxes> known;
    std::array<NumberColumn, kMostAxes> forms;
    std::array<int, kMostAxes> decimals{};
    Position first{};
    std::array<Position, 3> last{};  // the last one comes first
    std::uint32_t count = 0;         // of positions since the list began
    std::uint32_t next_axis = 0;
    Position position{};
    std::array<Guess::Kind, kMostAxes> kinds{};
    Guess::Kind last_kind = Guess::Kind::none;
    std::array<std::uint32_t, kMostAxes> last_size{};
    std::array<std::array<std::int32_t, kPredictions>, kMostAxes> misses{};
    LineGuesses line;
  };
  static void begin(List& list, const Place& place);
  static void rescale(List& list, std::uint32_t axis, int decimals);
  static void guess(const List& list, std::uint32_t axis, std::uint32_t axes,
                    std::vector<Guess>& guesses);
  static std::array<std::int64_t, kPredictions> predictions(const List& list, std::uint32_t axis);
  static std::optional<std::int64_t> code_known(EntropyStream& stream, ContextMixer& mixer,
                                                List& list, Hash column, Hash others,
                                                std::int64_t number, std::int64_t residual);
  std::int64_t code_number(EntropyStream& stream, ContextMixer& mixer, List& list,
                           const Place& place, std::int64_t number);
  static Hash place_of(const Position& position);
  static const Seen* find_seen(const List& list, const Position& position);
  static void guess_again(const List& list, std::uint32_t axis, std::vector<Guess>& guesses);
  static void remember(List& list);
  static void take(List& list, std::uint32_t axes);

  List& list_at(Hash path);

  FlatMap<Hash, std::uint32_t> list_of_;  // the number of a list, by path
  std::vector<List> lists_;               // by number
  std::vector<Guess> guesses_;
};

}  // namespace watertight::columns
