// SPDX-License-Identifier: GPL-3.0-or-later
//
// Whether PostgreSQL can keep a feature as it is.
#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>

#include "store/rows/feature_rows.h"
#include "store/rows/packed_solids.h"

namespace watertight::store {

bool is_plain_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t offset) -> unsigned {
      return i + offset < text.size() ? static_cast<unsigned char>(text[i + offset]) : 0U;
    };
    const unsigned lead = byte(0);
    std::size_t length = 0;
    unsigned low = 0x80;
    unsigned high = 0xBF;
    if (lead >= 0x01 && lead <= 0x7F) length = 1;
    if (lead >= 0xC2 && lead <= 0xDF) length = 2;
    if (lead >= 0xE0 && lead <= 0xEF) length = 3;
    if (lead >= 0xF0 && lead <= 0xF4) length = 4;
    if (length == 0) return false;
    if (lead == 0xE0) low = 0xA0;
    if (lead == 0xED) high = 0x9F;
    if (lead == 0xF0) low = 0x90;
    if (lead == 0xF4) high = 0x8F;
    for (std::size_t k = 1; k < length; ++k) {
      if (byte(k) < low || byte(k) > high) return false;
      low = 0x80;
      high = 0xBF;
    }
    i += length;
  }
  return true;
}

namespace {

Error bad(const std::string& what) { return {ErrorCode::invalid_argument, what}; }

Status check_id(std::string_view id, const char* what) {
  if (id.size() > kLongestId) {
    return bad(std::string(what) + " is longer than " + std::to_string(kLongestId) + " bytes");
  }
  if (!is_plain_utf8(id)) return bad(std::string(what) + " is not UTF-8 text without NUL");
  return Done{};
}

Status check_solids(const StoredFeature& feature) {
  std::set<std::tuple<std::string_view, std::uint32_t, std::uint32_t>> keys;
  for (const StoredSolid& solid : feature.solids) {
    if (Status checked = check_id(solid.object_id, "an object id"); !checked) return checked;
    if (!is_plain_utf8(solid.lod)) return bad("a level of detail is not UTF-8 text without NUL");
    if (!solid.measures.empty() || !solid.report.empty()) {
      return bad("measures and reports of feature '" + feature.id + "' are not part of its text");
    }
    if (!keys.emplace(solid.object_id, solid.geometry, solid.ordinal).second) {
      return bad("feature '" + feature.id + "' has one solid twice (object '" + solid.object_id +
                 "', geometry " + std::to_string(solid.geometry) + ", solid " +
                 std::to_string(solid.ordinal) + ")");
    }
  }
  return Done{};
}

Status check_feature(const StoredFeature& feature) {
  if (Status checked = check_collection_id(feature.collection); !checked) return checked;
  if (Status checked = check_feature_id(feature.id); !checked) return checked;
  if (!is_plain_utf8(feature.type) || !is_plain_utf8(feature.format)) {
    return bad("the type or format of feature '" + feature.id + "' is not UTF-8 text without NUL");
  }
  if (!feature.findings.empty()) {
    return bad("the findings of feature '" + feature.id + "' are not part of its text");
  }
  if (feature.box) {
    if (Status checked = check_box(*feature.box); !checked) return checked;
  }
  return check_solids(feature);
}

}  // namespace

Status check_collection_id(const std::string& id) {
  const auto allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
  };
  const bool is_possible = !id.empty() && id.size() <= 64 && id != "." && id != ".." &&
                           std::all_of(id.begin(), id.end(), allowed);
  if (!is_possible) {
    return bad("a collection id is 1 to 64 of A-Z a-z 0-9 _ . -, and neither . nor ..");
  }
  return Done{};
}

Status check_feature_id(const std::string& id) {
  if (id.empty()) return bad("a feature has no id");
  if (id == "." || id == "..") {
    return bad("a feature cannot have the id '" + id + "', which no URL can name");
  }
  return check_id(id, "a feature id");
}

bool is_possible_id(const std::string& id) { return !id.empty() && check_id(id, "").has_value(); }

Status check_box(const StoredBox& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool ordered = box.min[axis] <= box.max[axis];  // false for NaN
    if (!ordered || !std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis])) {
      return bad("a box needs finite numbers with minimum <= maximum");
    }
  }
  return Done{};
}

Status check_features(std::span<const StoredFeature> features) {
  std::set<std::pair<std::string_view, std::string_view>> keys;
  for (const StoredFeature& feature : features) {
    if (Status checked = check_feature(feature); !checked) return checked;
    if (!keys.emplace(feature.collection, feature.id).second) {
      return Error{ErrorCode::conflict, "feature '" + feature.id + "' is there twice"};
    }
  }
  return Done{};
}

}  // namespace watertight::store
