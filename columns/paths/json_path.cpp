// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/paths/json_path.h"

#include <algorithm>

namespace watertight::columns {
namespace {

constexpr std::size_t kMostLevels = 256;
constexpr Hash kRoot = 1;
constexpr Hash kArray = 2;
constexpr Hash kId = 3;  // for all ids that are keys

Hash hash_of_text(std::string_view text) {
  Hash hash = static_cast<Hash>(text.size());
  for (const char c : text) hash = hash_of(hash, static_cast<unsigned char>(c));
  return hash;
}

/// The end of the string whose first character is at `start`, that is the position of its closing
/// quote; npos if it has none.
std::size_t end_of_string(std::string_view text, std::size_t start) {
  for (std::size_t i = start; i < text.size(); ++i) {
    if (text[i] == '"') return i;
    if (text[i] == '\\') ++i;
  }
  return std::string_view::npos;
}

}  // namespace

void JsonPath::restart() {
  levels_.assign(1, Level{});
  levels_.back().path = kRoot;
  levels_.back().of_key = Names::root;
  beyond_ = 0;
  is_in_string_ = false;
}

void JsonPath::open(bool is_object) {
  if (levels_.size() == kMostLevels) {
    ++beyond_;
    return;
  }
  const Level& above = levels_.back();
  Level level;
  level.is_object = is_object;
  level.path = hash_of(above.path, above.is_object ? above.key : kArray);
  level.names = above.is_object || levels_.size() == 1 ? above.of_key : above.names;
  level.role = above.is_object ? above.of_member : above.role;
  if (level.names == Names::ids) level.key = kId;
  levels_.push_back(level);
}

void JsonPath::close() {
  if (beyond_ > 0) {
    --beyond_;
    return;
  }
  if (levels_.size() == 1) return;
  const Level& level = levels_.back();
  if (!level.is_object) last_length_[level.path] = level.index + 1;
  levels_.pop_back();
}

void JsonPath::take_key(std::string_view key) {
  Level& level = levels_.back();
  level.key = hash_of_text(key);
  level.of_member = Role::none;
  level.of_key = Names::other;
  switch (level.names) {
    case Names::root:
      if (key == "CityObjects") level.of_key = Names::ids;
      if (key == "vertices") level.of_key = Names::vertices;
      if (key == "boundaries") level.of_member = Role::vertex_index;
      break;
    case Names::vertices:
      if (key == "count") level.of_member = Role::vertex_count;
      if (key == "solids") level.of_member = Role::vertex_run;
      if (key == "others") level.of_member = Role::coordinate;
      break;
    case Names::geometry:
      if (key == "boundaries") level.of_member = Role::vertex_index;
      break;
    case Names::other:
      if (key == "geometry") level.of_key = Names::geometry;
      break;
    case Names::ids:
      break;
  }
}

void JsonPath::follow(std::string_view mark) {
  std::size_t i = 0;
  if (is_in_string_) {
    is_in_string_ = false;
    if (!mark.empty() && mark[0] == '"') ++i;
  }
  for (; i < mark.size(); ++i) {
    switch (mark[i]) {
      case '{':
      case '[':
        open(mark[i] == '{');
        break;
      case '}':
      case ']':
        close();
        break;
      case ',':
        ++levels_.back().index;
        break;
      case '"': {
        const std::size_t end = end_of_string(mark, i + 1);
        if (end == std::string_view::npos) {
          is_in_string_ = true;
          return;
        }
        if (levels_.back().is_object) take_key(mark.substr(i + 1, end - i - 1));
        i = end;
        break;
      }
      default:
        break;
    }
  }
}

Place JsonPath::place() const {
  constexpr std::uint32_t kFew = 4;
  constexpr std::uint32_t kAxes = 3;
  const Level& level = levels_.back();
  Place place;
  place.path = level.path;
  place.is_in_array = !level.is_object;
  place.index = level.index;
  if (level.is_object) {
    place.key = level.key;
    place.column = hash_of(level.path, level.key);
    place.role = level.of_member;
    return place;
  }
  const std::uint32_t* const known = last_length_.find(level.path);
  place.last_length = known == nullptr ? 0 : *known;
  place.role = level.role;
  place.column = hash_of(level.path, kArray);
  if (place.role == Role::coordinate) {
    place.column = hash_of(place.column, level.index % kAxes);
  } else if (place.last_length > 1 && place.last_length <= kFew) {
    place.column = hash_of(place.column, std::min(level.index, kFew) + 1);
  }
  return place;
}

}  // namespace watertight::columns
