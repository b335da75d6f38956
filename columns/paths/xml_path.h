// SPDX-License-Identifier: GPL-3.0-or-later
//
// Follows the structure of an XML text as it is taken apart into marks and values: values are those
// of attributes, and the contents of elements, number by number. Internal to columns/.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "columns/flat_map.h"
#include "columns/place.h"

namespace watertight::columns {

class XmlPath {
 public:
  XmlPath() { restart(); }
  /// Goes to the start of another text. What is known about lengths of lists stays.
  void restart();
  /// Follows the text of a mark. Takes any bytes; a text that is not XML gives arbitrary places.
  void follow(std::string_view mark);
  /// Follows a value. That of an attribute `name`, and the content of an element gen:name, tell
  /// values of different meaning at one path apart: their element's contents have columns of
  /// their own.
  void follow_value(std::string_view value);
  /// Where the next value or mark is.
  Place place() const;
  bool is_in_tag() const { return is_in_tag_; }

 private:
  struct Level {
    Hash path = 0;
    Hash name = 0;            // the name of the element
    Hash child = 0;           // the name of the last element in it
    Hash title = 0;           // of its attribute `name`, or of gen:name in it
    std::uint32_t index = 0;  // the number of values in its content
  };
  void open(Hash name);
  void close();

  std::vector<Level> levels_;
  std::size_t beyond_ = 0;  // levels that are deeper than kMostLevels
  bool is_in_tag_ = false;
  bool is_in_quotes_ = false;
  bool is_element_ = false;  // the tag is of an element, not a comment or an instruction
  Hash attribute_ = 0;
  /// What is known about the lists at a path.
  struct Lists {
    std::uint32_t last_length = 0;
    // Of those of more than one value: whether there are some, and what their lengths are.
    bool are_long = false;
    bool are_triples = true;
    bool are_pairs = true;
  };
  FlatMap<Hash, Lists> lists_;  // by path
};

}  // namespace watertight::columns
