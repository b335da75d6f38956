// SPDX-License-Identifier: GPL-3.0-or-later
#include "fill/candidates.h"

#include <algorithm>
#include <cmath>

#include "base/assert.h"

namespace watertight::fill {
namespace {

using geometry::Vector3;
using geometry::operator-;
using geometry::operator*;

/// A power of two with 2^32 times it at least twice the area of the largest triangle.
double area_unit_of(std::span<const Vector3> places) {
  Vector3 low = places[0];
  Vector3 high = places[0];
  for (const Vector3& place : places) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], place[axis]);
      high[axis] = std::max(high[axis], place[axis]);
    }
  }
  const Vector3 size = high - low;
  int exponent = 0;
  std::frexp(geometry::dot(size, size), &exponent);
  constexpr int kBits = 32;
  return std::ldexp(1.0, exponent - kBits);
}

void sort_unique(std::vector<Vertex>& list) {
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

Candidates::Candidates(const Borders& borders, std::span<const std::array<Vertex, 3>> triangles)
    : borders_(borders), area_unit_(area_unit_of(borders.places)) {
  list_edges(triangles);
  list_thirds(triangles);
}

void Candidates::list_edges(std::span<const std::array<Vertex, 3>> triangles) {
  const std::size_t n = borders_.size();
  std::vector<std::vector<Vertex>> uppers(n);  // vertex -> larger vertices joined to it
  const auto is_complete = [&](std::size_t lower) { return uppers[lower].size() + lower + 1 == n; };
  const auto add = [&](Vertex lower, Vertex upper) {
    std::vector<Vertex>& list = uppers[lower];
    if (is_complete(lower) || (!list.empty() && list.back() == upper)) return;
    list.push_back(upper);
    if (list.size() + lower + 1 == n || list.size() >= 4 * n) sort_unique(list);
  };
  for (const auto& [a, b, c] : triangles) {
    add(a, b);
    add(a, c);
    add(b, c);
  }
  lowers_.assign(n + 1, 0);
  for (std::size_t lower = 0; lower < n; ++lower) {
    if (!is_complete(lower)) sort_unique(uppers[lower]);
    uppers_.insert(uppers_.end(), uppers[lower].begin(), uppers[lower].end());
    lowers_[lower + 1] = static_cast<std::uint32_t>(uppers_.size());
  }
}

void Candidates::list_thirds(std::span<const std::array<Vertex, 3>> triangles) {
  begins_.assign(uppers_.size() + 1, 0);
  const auto visit = [&](auto&& place) {
    for (const auto& [a, b, c] : triangles) {
      place(edge(a, b), c);
      place(edge(a, c), b);
      place(edge(b, c), a);
    }
  };
  visit([&](EdgeNumber edge, Vertex) { ++begins_[edge + 1]; });
  for (std::size_t edge = 0; edge < uppers_.size(); ++edge) begins_[edge + 1] += begins_[edge];
  thirds_.resize(begins_.back());
  turns_.resize(begins_.back());
  // The order of the triangles makes each list ascending.
  std::vector<std::uint32_t> ends(begins_.begin(), begins_.end() - 1);
  visit([&](EdgeNumber edge, Vertex third) { thirds_[ends[edge]++] = third; });
  for (std::size_t lower = 0; lower + 1 < lowers_.size(); ++lower) {
    for (std::uint32_t edge = lowers_[lower]; edge < lowers_[lower + 1]; ++edge) {
      const Frame frame = frame_of(static_cast<Vertex>(lower), uppers_[edge]);
      for (std::uint32_t at = begins_[edge]; at < begins_[edge + 1]; ++at) {
        const Vector3 to = borders_.places[thirds_[at]] - borders_.places[lower];
        turns_[at] = turn_to(geometry::dot(to, frame.right), geometry::dot(to, frame.up));
      }
    }
  }
}

Candidates::Frame Candidates::frame_of(Vertex from, Vertex to) const {
  const Vector3 along = borders_.places[to] - borders_.places[from];
  // The axis that is the least along the edge.
  std::size_t axis = 0;
  for (const std::size_t other : {std::size_t{1}, std::size_t{2}}) {
    if (std::abs(along[other]) < std::abs(along[axis])) axis = other;
  }
  Vector3 unit{};
  unit[axis] = 1;
  const Vector3 right = geometry::cross(along, unit);
  const Vector3 up = geometry::cross(along, right);
  return {right * (1 / geometry::length(right)), up * (1 / geometry::length(up))};
}

EdgeNumber Candidates::found_edge(Vertex lower, Vertex upper) const {
  const std::uint32_t begin = lowers_[lower];
  const std::uint32_t end = lowers_[lower + 1U];
  const auto found = std::lower_bound(uppers_.begin() + begin, uppers_.begin() + end, upper);
  const auto at = static_cast<std::uint32_t>(found - uppers_.begin());
  return at < end && *found == upper ? at : kNoEdge;
}

Turn Candidates::turn(EdgeNumber edge, Vertex a, Vertex b, Vertex third) const {
  const std::size_t count = begins_[edge + 1] - begins_[edge];
  // Where every other vertex is on a triangle with this edge its number gives the place.
  if (count + 2 == borders_.size()) {
    return turns_[begins_[edge] + third - (third > a ? 1U : 0U) - (third > b ? 1U : 0U)];
  }
  const std::span<const Vertex> list = thirds(edge);
  const auto found = std::lower_bound(list.begin(), list.end(), third);
  WATERTIGHT_ASSERT(found != list.end() && *found == third);
  return turns(edge)[static_cast<std::size_t>(found - list.begin())];
}

Turn Candidates::turn_of(EdgeNumber edge, const Vector3& direction) const {
  const auto after = std::upper_bound(lowers_.begin(), lowers_.end(), edge);
  const auto lower = static_cast<Vertex>(after - lowers_.begin() - 1);
  const Frame frame = frame_of(lower, uppers_[edge]);
  return turn_to(geometry::dot(direction, frame.right), geometry::dot(direction, frame.up));
}

std::uint64_t Candidates::area(Vertex a, Vertex b, Vertex c) const {
  const auto& places = borders_.places;
  const double twice =
      geometry::length(geometry::cross(places[b] - places[a], places[c] - places[a]));
  return static_cast<std::uint64_t>(twice / (2 * area_unit_) + 0.5);
}

std::size_t Candidates::bytes() const {
  return thirds_.size() * (sizeof(Vertex) + sizeof(Turn)) +
         uppers_.size() * (sizeof(Vertex) + sizeof(std::uint32_t));
}

}  // namespace watertight::fill
