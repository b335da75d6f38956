// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/text/ring_search.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>

namespace watertight::formats {
namespace {

/// How many comparisons the search may make for each number of the text.
constexpr std::uint64_t kComparisons = 8;

struct Number {
  std::uint64_t at = 0;
  std::uint64_t end = 0;
  double value = 0;
};

std::vector<Number> numbers_in(std::string_view text) {
  std::vector<Number> numbers;
  for (std::size_t at = 0;;) {
    at = text.find_first_of("+-.0123456789", at);
    if (at == std::string_view::npos) return numbers;
    const std::size_t end = std::min(text.find_first_not_of("+-.0123456789eE", at), text.size());
    Number number{at, end, 0};
    const char* const first = text.data() + at + (text[at] == '+' ? 1 : 0);
    const auto [rest, error] = std::from_chars(first, text.data() + end, number.value);
    if (error == std::errc{} && rest == text.data() + end) numbers.push_back(number);
    at = end;
  }
}

/// The coordinates of a ring as they are written.
std::vector<double> coordinates_of(const Solid& solid, Index ring, RingEnd end) {
  std::vector<double> values;
  const auto add = [&](Index vertex) {
    for (const double value : solid.world(vertex)) values.push_back(value);
  };
  for (const Index vertex : solid.ring(ring)) add(vertex);
  if (end == RingEnd::closed && !solid.ring(ring).empty()) add(solid.ring(ring).front());
  return values;
}

class Search {
 public:
  explicit Search(std::string_view text)
      : numbers_(numbers_in(text)), comparisons_left_(kComparisons * numbers_.size()) {}

  /// The first occurrence of the values from the cursor on, which moves behind it.
  std::optional<RingText> find(const std::vector<double>& values) {
    if (values.empty()) return std::nullopt;
    for (std::size_t start = cursor_; start + values.size() <= numbers_.size(); ++start) {
      if (!is_at(start, values)) continue;
      RingText ring;
      ring.at = numbers_[start].at;
      cursor_ = start + values.size();
      ring.size = numbers_[cursor_ - 1].end - ring.at;
      return ring;
    }
    return std::nullopt;
  }
  bool is_exhausted() const { return comparisons_left_ == 0; }

 private:
  bool is_at(std::size_t start, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (comparisons_left_ == 0) return false;
      --comparisons_left_;
      if (numbers_[start + i].value != values[i]) return false;
    }
    return true;
  }

  std::vector<Number> numbers_;
  std::uint64_t comparisons_left_;
  std::size_t cursor_ = 0;
};

}  // namespace

std::vector<RingText> find_rings(std::string_view text, DocumentSolids solids, RingEnd end) {
  std::vector<RingText> rings;
  Search search(text);
  for (Index solid = 0; solid < solids.size(); ++solid) {
    for (Index ring = 0; ring < solids[solid]->ring_count(); ++ring) {
      if (search.is_exhausted()) return rings;
      auto found = search.find(coordinates_of(*solids[solid], ring, end));
      if (!found) continue;
      found->solid = solid;
      found->ring = ring;
      rings.push_back(*found);
    }
  }
  return rings;
}

}  // namespace watertight::formats
