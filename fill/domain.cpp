// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/domain.h"

namespace watertight::fill {
namespace {

bool has_repeated_edge(const Domain& domain) {
  for (std::size_t i = 0; i < domain.size; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (domain.spans[i].edge == domain.spans[j].edge) return true;
    }
  }
  return false;
}

}  // namespace

std::uint32_t segment_length(const Borders& borders, const Domain& domain, std::size_t i) {
  const Span& span = domain.spans[i];
  if (span.sense == Sense::none) return 0;
  const Vertex end = domain.after(i).tail;
  if (end == span.head) return borders.lengths[borders.loop[end]];
  return steps_along(borders, span.sense, span.head, end);
}

DomainKind kind_of(const Borders& borders, const Domain& domain) {
  const bool is_closing = domain.size == 1 && segment_length(borders, domain, 0) == 1;
  const bool is_gluing = domain.size == 2 && domain.spans[0].sense == Sense::none &&
                         domain.spans[1].sense == Sense::none;
  if (is_closing || is_gluing) {
    if (domain.untouched != 0) return DomainKind::dead;
    if (is_closing) return DomainKind::closing;
    const bool is_border = borders.is_border(domain.spans[0].tail, domain.spans[0].head);
    return is_border ? DomainKind::dead : DomainKind::gluing;
  }
  for (std::size_t i = 0; i < domain.size; ++i) {
    const Span& span = domain.spans[i];
    if (borders.is_border(span.tail, span.head)) return DomainKind::dead;
  }
  return has_repeated_edge(domain) ? DomainKind::dead : DomainKind::open;
}

void Splitter::append(const Domain& domain, Vertex third, std::vector<Split>& splits) const {
  const Span& access = domain.spans[0];
  Sides sides;
  sides.first = {access.tail, third, access.head, Sense::none,
                 candidates_.edge(access.tail, third)};
  sides.second = {third, access.head, access.tail, Sense::none,
                  candidates_.edge(third, access.head)};
  if (!options_.has_angles) sides.first.behind = sides.second.behind = kNoVertex;
  if ((domain.untouched >> borders_.loop[third] & 1U) != 0) {
    reach_loop(domain, sides, splits);
  } else {
    reach_boundary(domain, sides, splits);
  }
}

// Case I of the paper: the whole loop becomes a segment of the boundary.
void Splitter::reach_loop(const Domain& domain, const Sides& sides,
                          std::vector<Split>& splits) const {
  for (const Sense sense : {Sense::forward, Sense::backward}) {
    if (sense == Sense::backward && !options_.has_both_senses) break;
    Split split;
    split.third = sides.second.tail;
    split.count = 1;
    Domain& part = split.parts[0].domain;
    part.untouched =
        static_cast<std::uint8_t>(domain.untouched & ~(1U << borders_.loop[split.third]));
    part.size = static_cast<std::uint8_t>(domain.size + 1);
    part.spans[0] = sides.first;
    part.spans[0].sense = sense;
    part.spans[1] = sides.second;
    part.spans[1].sense = domain.spans[0].sense;
    for (std::size_t i = 1; i < domain.size; ++i) part.spans[i + 1] = domain.spans[i];
    append_living(split, splits);
  }
}

// Case II of the paper: the boundary is cut in two at each place of the vertex.
void Splitter::reach_boundary(const Domain& domain, const Sides& sides,
                              std::vector<Split>& splits) const {
  const Vertex third = sides.second.tail;
  for (std::size_t i = 0; i < domain.size; ++i) {
    const Span& span = domain.spans[i];
    if (borders_.loop[span.head] != borders_.loop[third]) continue;
    const Vertex end = domain.after(i).tail;
    if (span.sense == Sense::none) {
      if (third == span.head) divide(domain, sides, i, true, true, splits);
      return;
    }
    const std::uint32_t steps = steps_along(borders_, span.sense, span.head, third);
    if (steps > segment_length(borders_, domain, i)) return;
    const bool is_doubled = third == end && end == span.head;
    divide(domain, sides, i, third == span.head, third == end && !is_doubled, splits);
    if (is_doubled) divide(domain, sides, i, false, true, splits);
    return;
  }
}

void Splitter::divide(const Domain& domain, const Sides& sides, std::size_t segment,
                      bool is_at_start, bool is_at_end, std::vector<Split>& splits) const {
  Split split;
  split.third = sides.second.tail;
  split.count = 2;
  const Sense sense = domain.spans[segment].sense;
  Domain& first = split.parts[0].domain;
  first.spans[0] = sides.first;
  first.spans[0].sense = is_at_end ? Sense::none : sense;
  first.size = 1;
  for (std::size_t i = segment + 1; i < domain.size; ++i)
    first.spans[first.size++] = domain.spans[i];
  Domain& second = split.parts[1].domain;
  second.spans[0] = sides.second;
  second.spans[0].sense = domain.spans[0].sense;
  second.size = 1;
  for (std::size_t i = 1; i <= segment; ++i) second.spans[second.size++] = domain.spans[i];
  second.spans[second.size - 1U].sense = is_at_start ? Sense::none : sense;
  // All ways to deal out the untouched loops.
  const std::uint8_t all = domain.untouched;
  std::uint8_t dealt = all;
  while (true) {
    first.untouched = dealt;
    second.untouched = static_cast<std::uint8_t>(all & ~dealt);
    append_living(split, splits);
    if (dealt == 0) break;
    dealt = static_cast<std::uint8_t>((dealt - 1U) & all);
  }
}

void Splitter::append_living(Split split, std::vector<Split>& splits) const {
  for (std::size_t i = 0; i < split.count; ++i) {
    split.parts[i].kind = kind_of(borders_, split.parts[i].domain);
    if (split.parts[i].kind == DomainKind::dead) return;
  }
  splits.push_back(split);
}

}  // namespace watertight::fill
