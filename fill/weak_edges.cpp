// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/weak_edges.h"

#include <algorithm>
#include <bit>

namespace watertight::fill {
namespace {

bool spans(const Domain* domain, EdgeNumber edge) {
  if (domain == nullptr) return false;
  const auto end = domain->spans.begin() + domain->size;
  return std::any_of(domain->spans.begin(), end,
                     [&](const Span& span) { return span.edge == edge; });
}

}  // namespace

std::vector<EdgeNumber> weak_edges(const Borders& borders, const Candidates& candidates,
                                   const Domain& domain) {
  std::vector<EdgeNumber> weak;
  if (domain.size < 2) return weak;
  std::vector<Vertex> ends;
  for (std::size_t i = 0; i < domain.size; ++i) {
    ends.push_back(domain.spans[i].tail);
    ends.push_back(domain.spans[i].head);
  }
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (borders.is_border(ends[i], ends[j])) continue;
      const EdgeNumber edge = candidates.edge(ends[i], ends[j]);
      if (edge != kNoEdge && !spans(&domain, edge)) weak.push_back(edge);
    }
  }
  std::ranges::sort(weak);
  return weak;
}

Joiner::Joiner(EdgeNumber access, std::span<const EdgeNumber> weak, const PartEdges& first,
               const PartEdges& second) {
  can_join_ = !spans(first.domain, access) && !spans(second.domain, access);
  for (std::size_t i = 0; i < first.domain->size; ++i) {
    if (spans(second.domain, first.domain->spans[i].edge)) can_join_ = false;
  }
  if (!can_join_) return;
  is_trivial_ = weak.empty() && first.weak.empty() && second.weak.empty();
  if (is_trivial_) return;
  first_ = part_of(access, weak, first, second.domain);
  second_ = part_of(access, weak, second, first.domain);
  for (const EdgeNumber edge : second.weak) {
    const auto found = std::ranges::lower_bound(first.weak, edge);
    const bool is_shared = found != first.weak.end() && *found == edge;
    second_in_first_.push_back(is_shared ? static_cast<std::uint8_t>(found - first.weak.begin())
                                         : kNowhere);
  }
  for (std::size_t i = 0; i < weak.size(); ++i) {
    if (spans(first.domain, weak[i]) || spans(second.domain, weak[i])) always_ |= WeakSet{1} << i;
  }
}

Joiner::Part Joiner::part_of(EdgeNumber access, std::span<const EdgeNumber> weak,
                             const PartEdges& part, const Domain* other) {
  Part result;
  for (std::size_t i = 0; i < part.weak.size(); ++i) {
    const EdgeNumber edge = part.weak[i];
    if (edge == access || spans(other, edge)) result.forbidden |= WeakSet{1} << i;
    const auto found = std::ranges::lower_bound(weak, edge);
    const bool is_kept = found != weak.end() && *found == edge;
    result.place.push_back(is_kept ? static_cast<std::uint8_t>(found - weak.begin()) : kNowhere);
  }
  return result;
}

WeakSet Joiner::moved(WeakSet set, const std::vector<std::uint8_t>& place) {
  WeakSet result = 0;
  for (; set != 0; set &= set - 1) {
    const std::uint8_t to = place[static_cast<std::size_t>(std::countr_zero(set))];
    if (to != kNowhere) result |= WeakSet{1} << to;
  }
  return result;
}

std::optional<WeakSet> Joiner::join(WeakSet first, WeakSet second) const {
  if (is_trivial_) return WeakSet{0};
  if ((first & first_.forbidden) != 0 || (second & second_.forbidden) != 0) return std::nullopt;
  if ((first & moved(second, second_in_first_)) != 0) return std::nullopt;
  return always_ | moved(first, first_.place) | moved(second, second_.place);
}

}  // namespace watertight::fill
