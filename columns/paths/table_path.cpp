// SPDX-License-Identifier: GPL-3.0-or-later
#include "columns/paths/table_path.h"

#include <algorithm>

namespace watertight::columns {
namespace {

constexpr std::string_view kSeparators = "\t\n";

}  // namespace

void TablePath::restart() {
  table_ = 0;
  column_ = 0;
}

void TablePath::follow(std::string_view mark) {
  if (table_ == 0) {
    table_ = hash_of(8, static_cast<Hash>(mark.size()));
    for (const char c : mark) table_ = hash_of(table_, static_cast<unsigned char>(c));
    return;
  }
  column_ = mark.ends_with('\n') ? 0 : column_ + 1;
}

Place TablePath::place() const {
  Place place;
  place.path = hash_of(table_, column_);
  place.column = place.path;
  return place;
}

Mark TableTokens::next_mark() {
  const std::size_t name_end = is_first_ ? rest_.find('\n') : 0;
  const std::size_t size =
      name_end == std::string_view::npos ? rest_.size() : std::min(name_end + 1, rest_.size());
  is_first_ = false;
  const Mark mark{rest_.substr(0, size), size == rest_.size()};
  rest_.remove_prefix(size);
  return mark;
}

std::string_view TableTokens::next_value() {
  const std::string_view value = rest_.substr(0, rest_.find_first_of(kSeparators));
  rest_.remove_prefix(value.size());
  return value;
}

}  // namespace watertight::columns
