// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/paths/xml_path.h"

#include <algorithm>

namespace watertight::columns {
namespace {

constexpr std::size_t kMostLevels = 256;
constexpr Hash kRoot = 5;
constexpr Hash kContent = 6;

bool ends_name(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '>' || c == '/' || c == '=' ||
         c == '"' || c == '\'' || c == '<';
}

/// Takes a name off a text from `at` on, which moves to the end of the name.
Hash take_name(std::string_view text, std::size_t& at) {
  Hash hash = 0;
  while (at < text.size() && !ends_name(text[at])) {
    hash = hash_of(hash, static_cast<unsigned char>(text[at++]));
  }
  return hash;
}

}  // namespace

void XmlPath::restart() {
  levels_.assign(1, Level{kRoot});
  beyond_ = 0;
  is_in_tag_ = false;
  is_in_quotes_ = false;
  is_element_ = false;
  attribute_ = 0;
}

void XmlPath::open(Hash name) {
  if (levels_.size() == kMostLevels) {
    ++beyond_;
    return;
  }
  levels_.back().child = name;
  levels_.push_back({hash_of(levels_.back().path, name)});
}

void XmlPath::close() {
  if (beyond_ > 0) {
    --beyond_;
    return;
  }
  if (levels_.size() == 1) return;
  const Level& level = levels_.back();
  if (level.index > 0) last_length_[level.path] = level.index;
  levels_.pop_back();
}

void XmlPath::follow(std::string_view mark) {
  std::size_t i = 0;
  if (is_in_quotes_) {
    is_in_quotes_ = false;
    ++i;
  } else if (!is_in_tag_ && levels_.size() > 1) {
    ++levels_.back().index;
  }
  while (i < mark.size()) {
    const char c = mark[i++];
    if (!is_in_tag_) {
      if (c != '<') continue;
      is_in_tag_ = true;
      attribute_ = 0;
      const char next = i < mark.size() ? mark[i] : '\0';
      is_element_ = next != '/' && next != '?' && next != '!';
      if (next == '/') close();
      if (is_element_) open(take_name(mark, i));
      continue;
    }
    if (c == '>') {
      is_in_tag_ = false;
    } else if (c == '/') {
      if (is_element_ && i < mark.size() && mark[i] == '>') close();
    } else if (c == '"' || c == '\'') {
      is_in_quotes_ = true;
      return;
    } else if (!ends_name(c)) {
      --i;
      attribute_ = take_name(mark, i);
    }
  }
}

Place XmlPath::place() const {
  constexpr std::uint32_t kFew = 4;
  constexpr std::uint32_t kAxes = 3;
  const Level& level = levels_.back();
  Place place;
  place.path = level.path;
  if (is_in_tag_) {
    place.key = attribute_;
    place.column = hash_of(level.path, attribute_);
    return place;
  }
  const std::uint32_t* const known = last_length_.find(level.path);
  place.last_length = known == nullptr ? 0 : *known;
  place.index = level.index;
  place.is_in_array = level.index > 0 || place.last_length > 1;
  place.key = level.child;
  place.column = hash_of(level.path, kContent);
  if (place.last_length > kFew) {
    place.column = hash_of(place.column, level.index % kAxes);
  } else if (place.last_length > 1) {
    place.column = hash_of(place.column, std::min(level.index, kFew));
  }
  return place;
}

}  // namespace watertight::columns
