// SPDX-License-Identifier: GPL-3.0-or-later
//
// Follows the structure of a JSON text as it is taken apart into marks and values: a mark is all
// text between two values, with keys, brackets and white space. Internal to columns/.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "columns/flat_map.h"
#include "columns/place.h"

namespace watertight::columns {

class JsonPath {
 public:
  JsonPath() { restart(); }
  /// Goes to the start of another text. What is known about lengths of arrays stays.
  void restart();
  /// Follows the text of a mark. Takes any bytes; a text that is not JSON gives arbitrary places.
  void follow(std::string_view mark);
  /// Where the next value or mark is.
  Place place() const;
  /// Whether a key at this place is an id, and so a value, not part of a mark.
  bool has_ids_for_keys() const { return levels_.back().names == Names::ids; }
  bool is_in_object() const { return levels_.back().is_object; }

 private:
  /// The levels above the geometry that have a meaning in a city model.
  enum class Names : std::uint8_t { other, root, ids, vertices, geometry };
  struct Level {
    bool is_object = false;
    Hash path = 0;
    Hash key = 0;
    Names names = Names::other;
    Role role = Role::none;       // of the numbers in this array and those below
    Role of_member = Role::none;  // of the value or array of the last key
    Names of_key = Names::other;  // of an object or array at the last key
    std::uint32_t index = 0;
  };
  void open(bool is_object);
  void close();
  void take_key(std::string_view key);

  std::vector<Level> levels_;
  std::size_t beyond_ = 0;  // levels that are deeper than kMostLevels
  bool is_in_string_ = false;
  FlatMap<Hash, std::uint32_t> last_length_;  // of arrays, by path
};

}  // namespace watertight::columns
