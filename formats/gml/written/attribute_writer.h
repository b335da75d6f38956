// SPDX-License-Identifier: GPL-3.0-or-later
//
// The attributes of CityJSON as properties and generic attributes of CityGML 2.0. Internal to
// formats/.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>

#include "formats/gml/written/xml_text.h"
#include "formats/text/json.h"

namespace watertight::formats {

/// The parts of a city model for which CityGML has no place, with the number of times: "materials".
using GmlLeftOut = std::map<std::string, std::uint64_t, std::less<>>;

/// A string as it is, another value as JSON.
std::string text_of_value(const Json& value);

class AttributeWriter {
 public:
  /// Both must outlive this object.
  AttributeWriter(XmlText& xml, GmlLeftOut& left_out) : xml_(xml), left_out_(left_out) {}

  /// Writes the members of an object in the order of the schemas: those of GML, those of each city
  /// object, generic attributes, and those of its module with `prefix`: class, function, usage and
  /// `properties` (GmlObjectKind). Recursive; the reader's nesting limit bounds the depth.
  void write(const Json& attributes, std::string_view prefix, std::string_view properties);

 private:
  const Json* attribute(std::string_view key) const;
  bool is_property(std::string_view key) const;
  bool is_beside(std::string_view key) const;
  bool can_be_property(std::string_view key, const Json& value) const;
  std::string beside(std::string_view key, std::string_view end, std::size_t number) const;
  void property(std::string_view prefix, std::string_view key);
  void external_references();
  void generic(std::string_view key, const Json& value, std::string_view type,
               std::string_view code_space);

  XmlText& xml_;
  GmlLeftOut& left_out_;
  std::unordered_map<std::string_view, const Json*> attributes_;  // in work
  std::string_view properties_;
};

}  // namespace watertight::formats
