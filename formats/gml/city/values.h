// SPDX-License-Identifier: GPL-3.0-or-later
//
// Properties of GML objects as JSON. A property without children is a string, or a number or truth
// value where CityGML says so; numbers keep their digits. XML attributes (uom, codeSpace, ...)
// stand beside it as "NAME_uom". Properties that repeat become a list, structured ones an object.
// Internal to formats/.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gml/city/tree.h"
#include "formats/text/json.h"

namespace watertight::formats {

/// The members of a JSON object, in order, found in logarithmic time.
class ObjectBuilder {
 public:
  bool is_empty() const { return keys_.empty(); }
  bool has(const std::string& key) const { return numbers_.contains(key); }
  /// Adds a member; a key that is taken gets the value under `prefix` + key, with more prefixes
  /// where that is taken too.
  void add(std::string key, Json value, std::string_view prefix);
  Json take();

 private:
  std::map<std::string, std::size_t> numbers_;
  std::vector<std::string> keys_;
  std::vector<Json> values_;
};

class ValueReader {
 public:
  /// Both must outlive this object. Elements that become JSON are marked.
  ValueReader(const GmlTree& tree, TreeMarks& marks) : tree_(tree), marks_(marks) {}

  /// Adds the values of these properties, grouped by name. Cost: n log n.
  void add_properties(const std::vector<Index>& properties, ObjectBuilder& object);

  /// Adds generic attributes: stringAttribute, genericAttributeSet, genericAttribute, ... A name
  /// that a property has already gets the prefix "generic:".
  void add_generics(const std::vector<Index>& generics, ObjectBuilder& object);

  /// The text of an element as a number if it is one in JSON's spelling, else as a string.
  static Json number_of(std::string_view text);

 private:
  struct Generic {
    std::string name;
    std::string type;   // of the value, where JSON cannot say it: "date", "uri"
    std::string space;  // codeSpace
    Json value;
  };
  Json value_of(Index element);
  Json scalar(Index element) const;
  Json structure(Index element);
  Generic generic(Index element);

  const GmlTree& tree_;
  TreeMarks& marks_;
};

/// True for a generic attribute of CityGML 1 to 3, in its property or alone.
bool is_generic_attribute(std::string_view element);

}  // namespace watertight::formats
