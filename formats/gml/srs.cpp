// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

#include "formats/gml/gml.h"

namespace watertight::formats {
namespace {

struct AdvCode {
  std::string_view name;
  std::uint32_t srid;
};
// Horizontal systems of the German survey (AdV) that EPSG lists.
constexpr std::array kAdvCodes{
    AdvCode{"ETRS89_UTM31", 25831},  AdvCode{"ETRS89_UTM32", 25832}, AdvCode{"ETRS89_UTM33", 25833},
    AdvCode{"ETRS89_Lat-Lon", 4258}, AdvCode{"DE_DHDN_3GK2", 31466}, AdvCode{"DE_DHDN_3GK3", 31467},
    AdvCode{"DE_DHDN_3GK4", 31468},  AdvCode{"DE_DHDN_3GK5", 31469},
};

bool is_srs_digit(char c) { return c >= '0' && c <= '9'; }

// The last number of the leading run of digits, dots, colons, slashes and hashes; numbers before it
// are the version of the data set.
std::uint32_t last_number(std::string_view text) {
  text = text.substr(0, text.find_first_not_of("0123456789.:/#"));
  while (!text.empty() && !is_srs_digit(text.back())) text.remove_suffix(1);
  const std::size_t before = text.find_last_of(":/#");
  if (before != std::string_view::npos) text.remove_prefix(before + 1);
  std::uint32_t code = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), code);
  const bool is_code = status == std::errc() && end == text.data() + text.size();
  return is_code && code <= 999'999'999 ? code : 0;
}

}  // namespace

std::uint32_t srid_of_srs_name(std::string_view name) {
  constexpr std::string_view kAdv = "urn:adv:crs:";
  if (name.starts_with(kAdv)) {
    name.remove_prefix(kAdv.size());
    name = name.substr(0, name.find('*'));
    for (const AdvCode& code : kAdvCodes) {
      if (name == code.name) return code.srid;
    }
    return 0;
  }
  std::size_t at = name.find("EPSG");
  if (at == std::string_view::npos) at = name.find("epsg");
  if (at == std::string_view::npos) return 0;
  name.remove_prefix(at + 4);
  if (name.starts_with(".xml")) name.remove_prefix(4);
  return last_number(name);
}

bool is_in_order_of_authority(std::string_view name) {
  for (const std::string_view form :
       {"urn:ogc:def:crs", "urn:x-ogc:def:crs", "urn:adv:crs:", "http://www.opengis.net/def/crs",
        "https://www.opengis.net/def/crs"}) {
    const bool is_form =
        name.size() > form.size() &&
        std::equal(form.begin(), form.end(), name.begin(), [](char a, char b) {
          return a == (b >= 'A' && b <= 'Z' ? static_cast<char>(b - 'A' + 'a') : b);
        });
    if (is_form) return true;
  }
  return false;
}

}  // namespace watertight::formats
