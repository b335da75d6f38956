// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/gml/written/address_writer.h"

#include "formats/gml/written/kinds.h"

namespace watertight::formats {

void AddressWriter::write(const Json& object, std::string_view prefix) {
  const Json* addresses = find_member(object, "address");
  if (addresses == nullptr) return;
  if (prefix.empty() || !addresses->is_array()) {
    ++left_out_["addresses"];
    return;
  }
  for (const Json& address : *addresses) {
    xml_.open(std::string(prefix) + ":address");
    const std::string id = string_member(address, "id");
    xml_.open("core:Address", {{"gml:id", id.empty() ? std::string() : ids_.take(id)}});
    write_xal_address(address);
    const Json* location = find_member(address, "location");
    const Json* points = location == nullptr ? nullptr : find_member(*location, "boundaries");
    if (points != nullptr && points->is_array() && !points->empty()) write_location(*points);
    xml_.close();
    xml_.close();
  }
}

void AddressWriter::write_location(const Json& points) {
  xml_.open("core:multiPoint");
  xml_.open("gml:MultiPoint");
  for (const Json& point : points) {
    const bool is_vertex = point.is_number_unsigned() &&
                           point.get<std::uint64_t>() < vertices_.texts.size() &&
                           !vertices_.texts[point.get<std::size_t>()].empty();
    if (is_vertex) write_point(xml_, vertices_.texts[point.get<std::size_t>()]);
  }
  xml_.close();
  xml_.close();
}

/// Writes the members of an address that the reader makes of xAL 2.
void AddressWriter::write_xal_address(const Json& address) {
  const auto leaf = [&](std::string_view element, std::string_view member) {
    const Json* value = find_member(address, member);
    if (value == nullptr) return;
    if (!value->is_array()) return xml_.leaf(element, text_of_value(*value));
    for (const Json& one : *value) xml_.leaf(element, text_of_value(one));
  };
  const auto has = [&](std::string_view member) { return address.contains(member); };
  xml_.open("core:xalAddress");
  xml_.open("xAL:AddressDetails");
  xml_.open("xAL:Country");
  leaf("xAL:CountryName", "Country");
  xml_.open("xAL:Locality", {{"Type", string_member(address, "Locality_Type")}});
  leaf("xAL:LocalityName", "Locality");
  if (has("ThoroughfareName") || has("ThoroughfareNumber")) {
    xml_.open("xAL:Thoroughfare", {{"Type", string_member(address, "Thoroughfare_Type")}});
    leaf("xAL:ThoroughfareNumber", "ThoroughfareNumber");
    leaf("xAL:ThoroughfareNumberSuffix", "ThoroughfareNumberSuffix");
    leaf("xAL:ThoroughfareName", "ThoroughfareName");
    xml_.close();
  }
  if (has("Postcode")) {
    xml_.open("xAL:PostalCode");
    leaf("xAL:PostalCodeNumber", "Postcode");
    xml_.close();
  }
  for (int i = 0; i < 4; ++i) xml_.close();
  for (const auto& [key, value] : address.items()) {
    if (!has_word("id Country Locality Locality_Type ThoroughfareName ThoroughfareNumber "
                  "ThoroughfareNumberSuffix Thoroughfare_Type Postcode location",
                  key)) {
      ++left_out_["the member " + key + " of addresses"];
    }
  }
}

}  // namespace watertight::formats
