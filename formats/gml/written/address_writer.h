// SPDX-License-Identifier: GPL-3.0-or-later
//
// Addresses of city objects as CityGML 2.0 with xAL 2. Internal to formats/.
#pragma once

#include <string_view>

#include "formats/gml/written/attribute_writer.h"
#include "formats/gml/written/object_geometry.h"
#include "formats/gml/written/xml_text.h"

namespace watertight::formats {

class AddressWriter {
 public:
  /// All must outlive this object.
  AddressWriter(const VertexTexts& vertices, XmlIds& ids, XmlText& xml, GmlLeftOut& left_out)
      : vertices_(vertices), ids_(ids), xml_(xml), left_out_(left_out) {}

  /// Writes the addresses of a city object; leaves them out without a `prefix` of a module.
  void write(const Json& object, std::string_view prefix);

 private:
  void write_location(const Json& points);
  void write_xal_address(const Json& address);

  const VertexTexts& vertices_;
  XmlIds& ids_;
  XmlText& xml_;
  GmlLeftOut& left_out_;
};

}  // namespace watertight::formats
