// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/domain_table.h"

#include <algorithm>
#include <bit>
#include <tuple>

#include "base/assert.h"

namespace watertight::fill {
namespace {

// The fields of a word of a key, by their first bit.
constexpr unsigned kHeadBit = 16;
constexpr unsigned kBehindBit = 32;
constexpr unsigned kSenseBit = 48;
constexpr unsigned kUntouchedBit = 50;
constexpr unsigned kSizeBit = 56;

/// The most vertices for which segments have a list of their own: 4 MB.
constexpr std::size_t kMostListed = 1024;

/// Small sets first: each is compared with its subsets.
void sort_by_set(std::vector<WeighedTriangle>& triangles) {
  const auto is_other = [&](const WeighedTriangle& triangle) {
    return triangle.weak != triangles.front().weak;
  };
  if (std::ranges::none_of(triangles, is_other)) return;
  std::ranges::sort(triangles, {}, [](const WeighedTriangle& triangle) {
    return std::tuple(std::popcount(triangle.weak), triangle.weak);
  });
}

}  // namespace

DomainTable::DomainTable(std::size_t vertex_count, bool has_angles, bool keeps_all_sets)
    : vertex_count_(vertex_count), has_angles_(has_angles), keeps_all_sets_(keeps_all_sets) {
  if (vertex_count <= kMostListed) segments_.assign(vertex_count * vertex_count, kUnknown);
}

DomainTable::Key DomainTable::key_of(const Domain& domain) {
  Key key{};
  for (std::size_t i = 0; i < domain.size; ++i) {
    const Span& span = domain.spans[i];
    const std::uint64_t behind = i == 0 ? kNoVertex : span.behind;
    key[i] = std::uint64_t{span.tail} | std::uint64_t{span.head} << kHeadBit |
             behind << kBehindBit | static_cast<std::uint64_t>(span.sense) << kSenseBit;
  }
  key[0] |= std::uint64_t{domain.untouched} << kUntouchedBit | std::uint64_t{domain.size}
                                                                   << kSizeBit;
  return key;
}

std::size_t DomainTable::hash_of(const Key& key, std::size_t size) {
  constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15;
  std::uint64_t hash = 0;
  for (std::size_t i = 0; i < size; ++i) {
    hash = (hash ^ key[i]) * kFactor;
    hash ^= hash >> 32U;
  }
  return static_cast<std::size_t>(hash * kFactor >> 20U);
}

bool DomainTable::has_key(Number number, const Key& key, std::size_t size) const {
  const auto own = keys_.begin() + domains_[number].key;
  for (std::size_t i = 0; i < size; ++i) {
    if (own[static_cast<std::ptrdiff_t>(i)] != key[i]) return false;
  }
  return true;
}

DomainTable::Number DomainTable::find(const Domain& domain) const {
  if (slots_.empty()) return kUnknown;
  const Key key = key_of(domain);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t slot = hash_of(key, domain.size) & mask;; slot = (slot + 1) & mask) {
    const Number number = slots_[slot];
    if (number == kUnknown || has_key(number, key, domain.size)) return number;
  }
}

void DomainTable::grow() {
  constexpr std::size_t kFirst = 1024;
  slots_.assign(std::max(kFirst, 2 * slots_.size()), kUnknown);
  const std::size_t mask = slots_.size() - 1;
  for (Number number = 0; number < domains_.size(); ++number) {
    Key key{};
    const std::uint64_t* own = &keys_[domains_[number].key];
    const std::size_t size = own[0] >> kSizeBit;
    std::copy(own, own + size, key.begin());
    std::size_t slot = hash_of(key, size) & mask;
    while (slots_[slot] != kUnknown) slot = (slot + 1) & mask;
    slots_[slot] = number;
  }
}

void DomainTable::add(const Domain& domain, std::span<const EdgeNumber> weak,
                      std::vector<WeighedTriangle>& triangles) {
  WATERTIGHT_ASSERT(find(domain) == kUnknown);
  if (2 * (domains_.size() + 1) > slots_.size()) grow();
  const Key key = key_of(domain);
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(key, domain.size) & mask;
  while (slots_[slot] != kUnknown) slot = (slot + 1) & mask;
  slots_[slot] = static_cast<Number>(domains_.size());
  const Span& first = domain.spans[0];
  if (!segments_.empty() && is_segment(domain) && first.sense == Sense::forward) {
    segments_[first.tail * vertex_count_ + first.head] = slots_[slot];
  }
  domains_.push_back({static_cast<std::uint32_t>(keys_.size()),
                      static_cast<std::uint32_t>(weak_.size()),
                      static_cast<std::uint32_t>(sets_.size())});
  keys_.insert(keys_.end(), key.begin(), key.begin() + domain.size);
  weak_.insert(weak_.end(), weak.begin(), weak.end());
  sort_by_set(triangles);
  const std::size_t first_set = sets_.size();
  for (std::size_t begin = 0; begin < triangles.size();) {
    const WeakSet set = triangles[begin].weak;
    list_.clear();
    for (; begin < triangles.size() && triangles[begin].weak == set; ++begin) {
      const WeighedTriangle& triangle = triangles[begin];
      list_.push_back({triangle.weight, triangle.turn, triangle.third});
    }
    keep_best_by_turn(list_);
    if (!keeps_all_sets_) drop_heavier(first_set, set, list_);
    if (list_.empty()) continue;
    sets_.push_back({set, static_cast<std::uint32_t>(triangles_.size())});
    triangles_.insert(triangles_.end(), list_.begin(), list_.end());
  }
}

std::span<const DomainTable::Kept> DomainTable::kept(std::size_t set) const {
  const std::size_t end = set + 1 < sets_.size() ? sets_[set + 1].triangle : triangles_.size();
  return std::span(triangles_).subspan(sets_[set].triangle, end - sets_[set].triangle);
}

Weight DomainTable::at_turn(const Kept& kept, Turn turn) const {
  if (!has_angles_) return kept.weight;
  return {kept.weight.sum + turn_between(kept.turn, turn), kept.weight.tie};
}

// A triangle is not needed where another one, with the angle between the two added, weighs no more.
// The lightest of all stays; from there on in both senses each is compared with the last that
// stays.
void DomainTable::keep_best_by_turn(std::vector<Kept>& list) const {
  std::ranges::sort(list, [](const Kept& a, const Kept& b) {
    if (a.turn != b.turn) return a.turn < b.turn;
    return std::tie(a.weight, a.third) < std::tie(b.weight, b.third);
  });
  const auto lightest = std::ranges::min_element(list, {}, &Kept::weight);
  std::rotate(list.begin(), lightest, list.end());
  for (int pass = 0; pass < 2; ++pass) {
    std::size_t count = 1;
    for (std::size_t i = 1; i < list.size(); ++i) {
      if (at_turn(list[count - 1], list[i].turn) <= list[i].weight) continue;
      list[count++] = list[i];
    }
    list.resize(count);
    std::reverse(list.begin() + 1, list.end());
  }
  std::ranges::sort(list, {}, &Kept::turn);
}

void DomainTable::drop_heavier(std::size_t first_set, WeakSet weak, std::vector<Kept>& list) const {
  for (std::size_t set = first_set; set < sets_.size() && !list.empty(); ++set) {
    if ((sets_[set].weak & ~weak) != 0) continue;
    const std::span<const Kept> subset = kept(set);
    std::erase_if(list, [&](const Kept& triangle) {
      return at_turn(nearest(subset, triangle.turn), triangle.turn) <= triangle.weight;
    });
  }
}

/// The best triangle for a direction behind: one of its two neighbours on the circle.
const DomainTable::Kept& DomainTable::nearest(std::span<const Kept> kept, Turn turn) const {
  const auto after = std::ranges::lower_bound(kept, turn, {}, &Kept::turn);
  const Kept& above = after == kept.end() ? kept.front() : *after;
  const Kept& below = after == kept.begin() ? kept.back() : *(after - 1);
  return at_turn(below, turn) <= at_turn(above, turn) ? below : above;
}

const DomainTable::Kept& DomainTable::best_of(std::span<const Kept> kept,
                                              std::optional<Turn> behind) const {
  return behind ? nearest(kept, *behind) : *std::ranges::min_element(kept, {}, &Kept::weight);
}

std::optional<Weight> DomainTable::least_weight(Number number, std::optional<Turn> behind) const {
  const std::size_t end = number + 1 < domains_.size() ? domains_[number + 1].set : sets_.size();
  const std::size_t set = domains_[number].set;
  WATERTIGHT_ASSERT(end <= set + 1);
  if (set == end) return std::nullopt;
  const Kept& best = best_of(kept(set), behind);
  return behind ? at_turn(best, *behind) : best.weight;
}

std::span<const EdgeNumber> DomainTable::weak_edges(Number number) const {
  const std::size_t end = number + 1 < domains_.size() ? domains_[number + 1].weak : weak_.size();
  return std::span(weak_).subspan(domains_[number].weak, end - domains_[number].weak);
}

void DomainTable::answer(Number number, std::optional<Turn> behind,
                         std::vector<Answer>& answers) const {
  const std::size_t end = number + 1 < domains_.size() ? domains_[number + 1].set : sets_.size();
  const std::size_t begin_of_answers = answers.size();
  for (std::size_t set = domains_[number].set; set < end; ++set) {
    const std::span<const Kept> list = kept(set);
    const Kept& best = best_of(list, behind);
    const Answer answer{sets_[set].weak, behind ? at_turn(best, *behind) : best.weight, best.weight,
                        best.third};
    const auto is_better = [&](const Answer& other) {
      return (other.weak & ~answer.weak) == 0 && other.weight <= answer.weight;
    };
    const bool is_needed =
        keeps_all_sets_ ||
        std::none_of(answers.begin() + static_cast<std::ptrdiff_t>(begin_of_answers), answers.end(),
                     is_better);
    if (is_needed) answers.push_back(answer);
  }
}

std::size_t DomainTable::bytes() const {
  return (segments_.capacity() + slots_.capacity()) * sizeof(Number) +
         keys_.capacity() * sizeof(std::uint64_t) + weak_.capacity() * sizeof(EdgeNumber) +
         domains_.capacity() * sizeof(Record) + sets_.capacity() * sizeof(Set) +
         triangles_.capacity() * sizeof(Kept);
}

}  // namespace watertight::fill
