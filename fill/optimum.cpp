// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/optimum.h"

#include <utility>

namespace watertight::fill {

Optimum::Optimum(const Borders& borders, const Candidates& candidates, const SplitOptions& options,
                 bool keeps_all_sets)
    : borders_(borders),
      candidates_(candidates),
      has_angles_(options.has_angles),
      splitter_(borders, candidates, options),
      table_(borders.size(), options.has_angles, keeps_all_sets) {}

/// The direction of what is behind a spanning edge: a triangle of the filling, or for an edge of a
/// loop the shell's facet.
std::optional<Turn> Optimum::turn_behind(const Span& span) const {
  if (!has_angles_) return std::nullopt;
  if (span.behind != kNoVertex)
    return candidates_.turn(span.edge, span.tail, span.head, span.behind);
  const Vertex start = borders_.next[span.tail] == span.head ? span.tail : span.head;
  const geometry::Vector3& direction = borders_.behind[start];
  if (direction == geometry::Vector3{}) return std::nullopt;
  return candidates_.turn_of(span.edge, direction);
}

Weight Optimum::angle(const std::optional<Turn>& first, const std::optional<Turn>& second) const {
  if (!first || !second) return {};
  return {turn_between(*first + kHalfTurn, *second), 0};
}

Weight Optimum::own_weight(const Domain& domain, Vertex third) const {
  const std::uint64_t area = candidates_.area(domain.spans[0].tail, domain.spans[0].head, third);
  return has_angles_ ? Weight{0, area} : Weight{area, 0};
}

/// The answers for a part of a divided domain.
void Optimum::answer(const Part& part, std::vector<Answer>& answers) const {
  answers.clear();
  const Span& first = part.domain.spans[0];
  if (part.kind == DomainKind::open) {
    table_.answer(part.number, turn_behind(first), answers);
    return;
  }
  const Weight weight = part.kind == DomainKind::closing
                            ? closing_weight(first)
                            : angle(turn_behind(first), turn_behind(part.domain.spans[1]));
  answers.push_back({0, weight, weight, kNoVertex});
}

/// The weight of a domain whose only edge is an edge of a loop: that to the shell's facet.
Weight Optimum::closing_weight(const Span& side) const {
  Span facet = side;
  facet.behind = kNoVertex;
  return angle(turn_behind(side), turn_behind(facet));
}

/// Calls visit(weak edges, weight, first answer, second answer or null) for each pair of answers of
/// the parts that can be joined. Requires parts that were looked up.
template <class Visit>
void Optimum::join_parts(const Domain& domain, std::span<const EdgeNumber> weak, const Split& split,
                         Visit visit) {
  std::array<PartEdges, 2> edges;
  for (std::size_t i = 0; i < split.count; ++i) {
    answer(split.parts[i], answers_[i]);
    if (answers_[i].empty()) return;
    edges[i].domain = &split.parts[i].domain;
    if (split.parts[i].kind == DomainKind::open)
      edges[i].weak = table_.weak_edges(split.parts[i].number);
  }
  const Joiner joiner(domain.spans[0].edge, weak, edges[0], edges[1]);
  if (!joiner.can_join()) return;
  const Weight own = own_weight(domain, split.third);
  for (const Answer& one : answers_[0]) {
    if (split.count == 1) {
      if (const auto set = joiner.join(one.weak, 0)) visit(*set, own + one.weight, one, nullptr);
      continue;
    }
    for (const Answer& other : answers_[1]) {
      const auto set = joiner.join(one.weak, other.weak);
      if (set) visit(*set, own + one.weight + other.weight, one, &other);
    }
  }
}

/// Looks up the parts of the current splits. False if one was not weighed yet; it is unknown_ then.
bool Optimum::find_parts() {
  for (Split& split : splits_) {
    for (std::size_t i = 0; i < split.count; ++i) {
      Part& part = split.parts[i];
      if (part.kind != DomainKind::open) continue;
      part.number = table_.find(part.domain);
      if (part.number != DomainTable::kUnknown) continue;
      unknown_ = part.domain;
      return false;
    }
  }
  return true;
}

/// Weighs the triangles on the access edge, from the frame's next one on. False if a part has to be
/// weighed first.
bool Optimum::weigh_triangles(Frame& frame) {
  const EdgeNumber access = frame.domain.spans[0].edge;
  const std::span<const Vertex> thirds = candidates_.thirds(access);
  const std::span<const Turn> turns = candidates_.turns(access);
  for (; frame.next < thirds.size(); ++frame.next) {
    const Vertex third = thirds[frame.next];
    splits_.clear();
    splitter_.append(frame.domain, third, splits_);
    if (!find_parts()) return false;
    const Turn turn = turns[frame.next] + kHalfTurn;
    for (const Split& split : splits_) {
      join_parts(frame.domain, frame.weak, split,
                 [&](WeakSet weak, const Weight& weight, const Answer&, const Answer*) {
                   frame.found.push_back({weak, weight, turn, third});
                 });
    }
  }
  return true;
}

/// Looks up the part of a segment on one side of a triangle; `length` is that of its own segment.
/// False if it was not weighed yet; it is unknown_ then.
bool Optimum::find_segment(const Span& side, std::uint32_t length, DomainTable::Number& number) {
  number = DomainTable::kUnknown;
  if (length == 1) return true;
  if (side.sense == Sense::forward) number = table_.find_segment(side.tail, side.head);
  if (number != DomainTable::kUnknown) return true;
  unknown_ = {};
  unknown_.size = 1;
  unknown_.spans[0] = side;
  number = table_.find(unknown_);
  return number != DomainTable::kUnknown;
}

/// The least weight of a part that find_segment() has found; nothing if it has no triangulation.
std::optional<Weight> Optimum::weight_of(const Span& side, DomainTable::Number number) const {
  if (number == DomainTable::kUnknown) return closing_weight(side);
  return table_.least_weight(number, turn_behind(side));
}

/// weigh_triangles() for a segment, most domains by far: the two parts are segments too, and have
/// no weak edges.
bool Optimum::weigh_segment(Frame& frame) {
  const Span access = frame.domain.spans[0];
  const std::uint32_t length = segment_length(borders_, frame.domain, 0);
  const std::span<const Vertex> thirds = candidates_.thirds(access.edge);
  const std::span<const Turn> turns = candidates_.turns(access.edge);
  for (; frame.next < thirds.size(); ++frame.next) {
    const Vertex third = thirds[frame.next];
    if (borders_.loop[third] != borders_.loop[access.head]) continue;
    const std::uint32_t steps = steps_along(borders_, access.sense, access.head, third);
    if (steps >= length) continue;
    const bool is_dead = (steps > 1 && borders_.is_border(third, access.head)) ||
                         (length - steps > 1 && borders_.is_border(access.tail, third));
    if (is_dead) continue;
    Span first{access.tail, third, access.head, access.sense, candidates_.edge(access.tail, third)};
    Span second{third, access.head, access.tail, access.sense,
                candidates_.edge(third, access.head)};
    if (!has_angles_) first.behind = second.behind = kNoVertex;
    DomainTable::Number one = 0;
    DomainTable::Number other = 0;
    if (!find_segment(first, length - steps, one) || !find_segment(second, steps, other)) {
      return false;
    }
    const std::optional<Weight> weight = weight_of(first, one);
    const std::optional<Weight> rest = weight_of(second, other);
    if (!weight || !rest) continue;
    frame.found.push_back({0, own_weight(frame.domain, third) + *weight + *rest,
                           turns[frame.next] + kHalfTurn, third});
  }
  return true;
}

void Optimum::start_frame(const Domain& domain) {
  if (frame_count_ == frames_.size()) frames_.emplace_back();
  Frame& frame = frames_[frame_count_++];
  frame.domain = domain;
  frame.weak = weak_edges(borders_, candidates_, domain);
  frame.found.clear();
  frame.next = 0;
}

/// Weighs a domain after all parts that it can have.
Status Optimum::weigh(const Domain& start, const Budget& budget) {
  start_frame(start);
  while (frame_count_ > 0) {
    if (budget.is_cancelled && table_.domain_count() % 256 == 0 && budget.is_cancelled()) {
      return Error{ErrorCode::cancelled, "the filling of a hole was cancelled"};
    }
    if (table_.domain_count() > budget.max_domains || table_.bytes() > budget.max_bytes) {
      return Error{ErrorCode::limit_exceeded, "the hole is too large for an optimal filling"};
    }
    Frame& frame = frames_[frame_count_ - 1];
    if (!(is_segment(frame.domain) ? weigh_segment(frame) : weigh_triangles(frame))) {
      start_frame(unknown_);
      continue;
    }
    table_.add(frame.domain, frame.weak, frame.found);
    --frame_count_;
  }
  return Done{};
}

Result<std::vector<std::array<Vertex, 3>>> Optimum::triangulate(const Domain& start,
                                                                const Budget& budget) {
  if (const Status status = weigh(start, budget); !status) return status.error();
  std::vector<Answer> answers;
  table_.answer(table_.find(start), turn_behind(start.spans[0]), answers);
  if (answers.empty()) {
    return Error{ErrorCode::not_found, "the candidate triangles cannot close the hole"};
  }
  std::vector<std::array<Vertex, 3>> triangles;
  std::vector<std::pair<Domain, Answer>> open{{start, answers.front()}};
  while (!open.empty()) {
    const Domain domain = open.back().first;
    const Answer wanted = open.back().second;
    open.pop_back();
    if (wanted.third == kNoVertex) continue;
    triangles.push_back({domain.spans[0].tail, domain.spans[0].head, wanted.third});
    splits_.clear();
    splitter_.append(domain, wanted.third, splits_);
    const bool are_known = find_parts();
    WATERTIGHT_ASSERT(are_known);
    bool is_found = false;
    const std::vector<EdgeNumber> weak = weak_edges(borders_, candidates_, domain);
    for (const Split& split : splits_) {
      if (is_found) break;
      join_parts(domain, weak, split,
                 [&](WeakSet set, const Weight& weight, const Answer& one, const Answer* other) {
                   if (is_found || set != wanted.weak || weight != wanted.beyond) return;
                   is_found = true;
                   open.emplace_back(split.parts[0].domain, one);
                   if (other != nullptr) open.emplace_back(split.parts[1].domain, *other);
                 });
    }
    WATERTIGHT_ASSERT(is_found);
  }
  return triangles;
}

}  // namespace watertight::fill
