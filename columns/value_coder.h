// SPDX-License-Identifier: GPL-3.0-or-later
//
// Codes the values of a text: a value that came before is named by what it follows, by its number
// in its column or by its number among all values; a new one is a number, an identifier or a
// string. Internal to columns/.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "columns/flat_map.h"
#include "columns/models/candidates.h"
#include "columns/models/context_mixer.h"
#include "columns/models/number_coder.h"
#include "columns/models/string_coder.h"
#include "columns/models/uuid.h"
#include "columns/noted_array.h"
#include "columns/place.h"
#include "columns/value_table.h"

namespace watertight::columns {

class ValueCoder {
 public:
  explicit ValueCoder(int slot_bits) : candidates_(slot_bits) { add({}); }
  /// Makes this copy of a coder that has not changed since equal to it again.
  void revert(const ValueCoder& original);
  /// Starts another text.
  void restart();
  /// Codes a value; returns its text, which stays where it is until the next one. The stream fails
  /// when the text that is read is longer than `most_bytes`.
  std::string_view code(EntropyStream& stream, ContextMixer& mixer, StringCoder& strings,
                        const Place& place, std::string_view text, std::size_t most_bytes);
  /// Makes what a writer needs and a reader leaves out, so that a coder that has read can write.
  void make_indexes();
  /// Takes note of a value that was coded elsewhere.
  void pass(std::optional<std::int64_t> number);
  /// Stands for the last value.
  Hash last() const { return last_; }

 private:
  enum class Kind : std::uint8_t {
    after_both,    // the value that followed the last one of this column and the last one at all
    after_others,  // the value that followed the last two at all
    after_own,     // the value that followed the last two of this column
    listed,        // a value that the column had before
    known,         // a value that another column had before
    number,
    uuid,
    string,
    counter  // the last value of the column with another number in it
  };
  struct Column {
    std::uint32_t last = 0;
    std::uint32_t before_last = 0;
    Kind last_kind = Kind::after_both;
    std::uint32_t news = 0;             // of the last values, which were new: a bit each
    std::vector<std::uint32_t> values;  // those that it lists
    std::uint32_t last_distance = 0;    // of `known`: its length in bits
    std::uint32_t affixes = 0;          // of the last uuid
    std::uint32_t last_step = 0;        // of `counter`: its size and sign
    NumberColumn numbers;
  };
  static constexpr std::uint32_t kNotListed = ~std::uint32_t{0};
  /// Where a value came first.
  struct Origin {
    std::uint32_t column = 0;
    std::uint32_t index = kNotListed;  // among the values of the column
  };
  /// What is known before a value.
  struct Context {
    const Place& place;
    std::uint32_t number;  // of the column
    Column& column;
    std::array<Hash, 3> facts{};
    std::array<std::optional<Candidate>, 3> candidates{};
    std::size_t most_bytes = 0;
  };

  /// The number of the column at a place.
  std::uint32_t column_at(const Place& place);
  Context context_of(const Place& place, std::uint32_t column);
  Kind choose_kind(const Context& context, std::string_view text) const;
  Kind code_kind(EntropyStream& stream, ContextMixer& mixer, const Context& context, Kind kind);
  std::uint32_t code_listed(EntropyStream& stream, ContextMixer& mixer, const Context& context,
                            std::string_view text);
  std::optional<std::uint32_t> next_known(std::uint32_t value) const;
  std::uint32_t code_known(EntropyStream& stream, ContextMixer& mixer, const Context& context,
                           std::string_view text);
  std::uint32_t code_number(EntropyStream& stream, ContextMixer& mixer, const Context& context,
                            std::string_view text);
  std::uint32_t code_uuid(EntropyStream& stream, ContextMixer& mixer, StringCoder& strings,
                          const Context& context, std::string_view text);
  std::uint32_t code_counter(EntropyStream& stream, ContextMixer& mixer, const Context& context,
                             std::string_view text);
  std::uint32_t code_of_kind(EntropyStream& stream, ContextMixer& mixer, StringCoder& strings,
                             const Context& context, Kind kind, std::string_view text);
  std::uint32_t add(std::string_view text,
                    const std::optional<FormedNumber>& number = std::nullopt);
  void learn(EntropyStream& stream, const Context& context, Kind kind, std::uint32_t value);

  ValueTable values_;
  ValueTable affixes_;
  Candidates candidates_;
  FlatMap<Hash, std::uint32_t> column_of_;            // the number of a column
  std::vector<Column> columns_;                       // by number
  std::vector<std::optional<FormedNumber>> numbers_;  // of values that are numbers
  NotedArray<Origin> origins_;                        // of values
  UuidCoder uuids_;
  /// Where a column lists a value, by column and value. Empty for a reader.
  FlatMap<std::uint64_t, std::uint32_t> index_of_;
  std::uint32_t last_ = 0;         // the last value at all
  std::uint32_t before_last_ = 0;  // the one before it
  std::uint32_t last_known_ = 0;   // the last value of kind `known`
  std::optional<std::int64_t> last_number_;
};

}  // namespace watertight::columns
