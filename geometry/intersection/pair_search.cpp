// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/intersection/pair_search.h"

#include <algorithm>
#include <utility>

#include "geometry/intersection/oblique_boxes.h"

namespace watertight::geometry {
namespace {

/// The number of pairs of 256 triangles. Parts with more pairs are divided along other directions.
constexpr double kManyPairs = 0.5 * 256 * 256;
/// A vertex of at least one in kHubShare triangles of a part is a hub: its triangles are compared
/// by their directions from the vertex.
constexpr std::size_t kHubShare = 8;
constexpr std::uint64_t kAskInterval = std::uint64_t{1} << 16U;

bool is_before(const IntersectingPair& a, const IntersectingPair& b) {
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

/// The vertex that most of the triangles have (the lowest of several), and how many have it.
std::pair<Index, std::size_t> busiest_vertex(std::span<const Triangle> triangles,
                                             std::span<const Index> members) {
  std::vector<Index> vertices;
  vertices.reserve(3 * members.size());
  for (const Index member : members) {
    vertices.insert(vertices.end(), triangles[member].begin(), triangles[member].end());
  }
  std::sort(vertices.begin(), vertices.end());
  std::pair<Index, std::size_t> result{0, 0};
  for (std::size_t begin = 0; begin < vertices.size();) {
    std::size_t end = begin;
    while (end < vertices.size() && vertices[end] == vertices[begin]) ++end;
    if (end - begin > result.second) result = {vertices[begin], end - begin};
    begin = end;
  }
  return result;
}

}  // namespace

std::vector<IntersectingPair> PairSearch::run(std::span<const BoxMember<3>> members,
                                              const PartBounds<3>& bounds) {
  pairs_.clear();
  most_pairs_ = context_.limit;
  divide_space(members, bounds);
  while (!stalled_.empty() && goes_on(0)) {
    Stalled next = std::move(stalled_.back());
    stalled_.pop_back();
    resolve(std::move(next));
  }
  stalled_.clear();
  std::sort(pairs_.begin(), pairs_.end(), is_before);
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  return std::move(pairs_);
}

void PairSearch::divide_space(std::span<const BoxMember<3>> members, const PartBounds<3>& bounds) {
  const auto visit = [&](const PartMembers<3>& part, const PartBounds<3>& part_bounds) {
    if (part.pairs() <= kManyPairs) return compare(part, part_bounds, part_bounds);
    stalled_.push_back(stalled_part(part));
    stalled_.back().bounds = part_bounds;
    return true;
  };
  SlabPartition<3, decltype(visit)>(visit).run({members, {}, true}, bounds);
}

template <std::size_t D>
PairSearch::Stalled PairSearch::stalled_part(const PartMembers<D>& members) {
  Stalled result;
  result.is_within = members.is_within;
  for (const auto& member : members.first) result.first.push_back(member.triangle);
  for (const auto& member : members.second) result.second.push_back(member.triangle);
  return result;
}

void PairSearch::resolve(Stalled stalled) {
  if (stalled.is_within && stalled.may_have_hub && resolve_hub(stalled)) return;
  resolve_along_axes(stalled);
}

/// If many of the triangles have one vertex, finds the pairs of these triangles by the directions
/// from that vertex, then the pairs of the other triangles. Else returns false.
bool PairSearch::resolve_hub(Stalled& stalled) {
  const auto [hub, count] = busiest_vertex(context_.triangles, stalled.first);
  if (count * kHubShare < stalled.first.size()) return false;
  std::vector<BoxMember<6>> fan;
  std::vector<BoxMember<6>> others;
  std::vector<BoxMember<3>> rest;
  for (const Index member : stalled.first) {
    const Triangle& triangle = context_.triangles[member];
    const bool is_in_fan = std::find(triangle.begin(), triangle.end(), hub) != triangle.end();
    const BoxMember<3>& box = context_.boxes[member];
    (is_in_fan ? fan : others).push_back(seen_from(hub, context_.points, triangle, box));
    if (!is_in_fan) rest.push_back(box);
  }
  Stalled within;
  within.bounds = stalled.bounds;
  divide_directions(fan, {}, within);
  Stalled across = within;
  across.is_within = false;
  divide_directions(fan, others, across);
  divide_space(rest, stalled.bounds);
  return true;
}

/// Finds the pairs of a part by a division along axes that follow its triangles.
void PairSearch::resolve_along_axes(const Stalled& stalled) {
  std::vector<Index> all = stalled.first;
  all.insert(all.end(), stalled.second.begin(), stalled.second.end());
  const ObliqueAxes axes(context_.points, context_.triangles, all);
  const auto boxes = [&](const std::vector<Index>& members) {
    std::vector<BoxMember<6>> result;
    for (const Index member : members) {
      result.push_back(
          axes.box(context_.points, context_.triangles[member], context_.boxes[member]));
    }
    return result;
  };
  divide_directions(boxes(stalled.first), boxes(stalled.second), stalled);
}

/// Divides the members along all six directions of their boxes and compares the pairs of each part.
/// A part that still has many pairs, but at most half of the pairs of the whole, is put off: it is
/// divided later along axes of its own.
void PairSearch::divide_directions(const std::vector<BoxMember<6>>& first,
                                   const std::vector<BoxMember<6>>& second,
                                   const Stalled& stalled) {
  const PartMembers<6> whole{first, second, stalled.is_within};
  const auto visit = [&](const PartMembers<6>& part, const PartBounds<6>& part_bounds) {
    if (part.pairs() <= kManyPairs || part.pairs() > whole.pairs() / 2) {
      return compare(part, part_bounds, stalled.bounds);
    }
    stalled_.push_back(stalled_part(part));
    stalled_.back().may_have_hub = false;
    stalled_.back().bounds = stalled.bounds;
    return true;
  };
  SlabPartition<6, decltype(visit)>(visit).run(whole, PartBounds<6>::everything());
}

/// Compares all pairs of a part. False if the search is to end.
template <std::size_t D>
bool PairSearch::compare(const PartMembers<D>& members, const PartBounds<D>& bounds,
                         const PartBounds<3>& outer) {
  BoxColumns<D> columns;
  const auto partners = members.is_within ? members.first : members.second;
  columns.fill(partners);
  if (members.first.empty()) return true;
  const Point& origin = context_.tester.origin(members.first.front().triangle);
  const auto fill = [&](std::vector<PlaneTriangle>& planes, std::span<const BoxMember<D>> side) {
    planes.clear();
    for (const auto& member : side) {
      planes.push_back(context_.tester.plane_triangle(member.triangle, origin));
    }
  };
  fill(first_planes_, members.first);
  fill(second_planes_, members.second);
  const auto& partner_planes = members.is_within ? first_planes_ : second_planes_;
  for (std::size_t i = 0; i < members.first.size(); ++i) {
    const BoxMember<D>& member = members.first[i];
    const std::size_t begin = members.is_within ? i + 1 : 0;
    columns.for_overlapping(member, begin, [&](std::size_t j) {
      const BoxMember<D>& partner = partners[j];
      // If D is 3, `bounds` and `outer` are equal.
      if (!bounds.owns(member, partner) || (D > 3 && !outer.owns(member, partner))) return;
      if (context_.are_of_one_group(member.triangle, partner.triangle)) return;
      const ContactClass contact = context_.tester.contact(first_planes_[i], partner_planes[j]);
      if (!is_intersection(contact)) return;
      const auto [a, b] = std::minmax(member.triangle, partner.triangle);
      pairs_.push_back({a, b, contact});
    });
    if (!goes_on(partners.size() - begin + 1)) return false;
  }
  return true;
}

bool PairSearch::goes_on(std::size_t comparisons) {
  comparisons_ += comparisons;
  if (comparisons_ >= kAskInterval) {
    comparisons_ = 0;
    if (is_caller_) context_.ask();
    if (context_.is_ended) return false;
  }
  if (pairs_.size() < most_pairs_) return true;
  std::sort(pairs_.begin(), pairs_.end(), is_before);
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  most_pairs_ = std::max<std::uint64_t>(context_.limit, 2 * pairs_.size());
  return pairs_.size() < context_.limit;
}

}  // namespace watertight::geometry
