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

Hash hash_of_text(std::string_view text) {
  Hash hash = 0;
  for (const char c : text) hash = hash_of(hash, static_cast<unsigned char>(c));
  return hash;
}

/// Takes a name off a text from `at` on, which moves to the end of the name.
Hash take_name(std::string_view text, std::size_t& at) {
  const std::size_t begin = at;
  while (at < text.size() && !ends_name(text[at])) ++at;
  return hash_of_text(text.substr(begin, at - begin));
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
  levels_.push_back({hash_of(levels_.back().path, name), name});
}

void XmlPath::close() {
  if (beyond_ > 0) {
    --beyond_;
    return;
  }
  if (levels_.size() == 1) return;
  const Level& level = levels_.back();
  if (level.index > 0) {
    Lists& lists = lists_[level.path];
    lists.last_length = level.index;
    if (level.index > 1) {
      lists.are_long = true;
      lists.are_triples = lists.are_triples && level.index % 3 == 0;
      lists.are_pairs = lists.are_pairs && level.index % 2 == 0;
    }
  }
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

void XmlPath::follow_value(std::string_view value) {
  static const Hash kAttribute = hash_of_text("name");
  static const Hash kElement = hash_of_text("gen:name");
  if (is_in_tag_) {
    if (attribute_ == kAttribute) levels_.back().title = hash_of_text(value);
  } else if (levels_.size() > 1 && levels_.back().name == kElement) {
    levels_[levels_.size() - 2].title = hash_of_text(value);
  }
}

Place XmlPath::place() const {
  constexpr std::uint32_t kFew = 4;
  const Level& level = levels_.back();
  Place place;
  place.path = level.path;
  if (is_in_tag_) {
    place.key = attribute_;
    place.column = hash_of(level.path, attribute_);
    return place;
  }
  const Lists* const known = lists_.find(level.path);
  const Lists lists = known == nullptr ? Lists{} : *known;
  place.last_length = lists.last_length;
  place.index = level.index;
  place.is_in_array = level.index > 0 || place.last_length > 1;
  place.key = level.child;
  place.column = hash_of(level.path, kContent);
  if (levels_.size() > 1 && levels_[levels_.size() - 2].title != 0) {
    place.column = hash_of(place.column, levels_[levels_.size() - 2].title);
  }
  if (lists.are_long) place.axes = lists.are_triples ? 3 : lists.are_pairs ? 2 : 0;
  if (place.axes > 0) {
    place.role = Role::position;
    place.column = hash_of(place.column, level.index % place.axes);
  } else if (place.last_length > kFew) {
    place.column = hash_of(place.column, kFew);
  } else if (place.last_length > 1) {
    place.column = hash_of(place.column, std::min(level.index, kFew));
  }
  return place;
}

}  // namespace watertight::columns
