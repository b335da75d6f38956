// SPDX-License-Identifier: GPL-3.0-or-later
#include "tessellate/few_vertices.h"

#include <algorithm>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace watertight::tessellate {
namespace {

using PlanePoint = FewVertices::PlanePoint;
using KernelPoint = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;

KernelPoint exact(const PlanePoint& point) { return {point[0], point[1]}; }

CGAL::Orientation orientation(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return CGAL::orientation(exact(a), exact(b), exact(c));
}

/// Whether the boxes around two segments have a point in common.
bool do_boxes_meet(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c,
                   const PlanePoint& d) {
  const auto do_ranges_meet = [](double p, double q, double r, double s) {
    return std::min(p, q) <= std::max(r, s) && std::min(r, s) <= std::max(p, q);
  };
  return do_ranges_meet(a[0], b[0], c[0], d[0]) && do_ranges_meet(a[1], b[1], c[1], d[1]);
}

/// Whether two points lie strictly on the same side of the line through a and b.
bool are_on_one_side(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c,
                     const PlanePoint& d) {
  const auto side = orientation(a, b, c);
  return side != CGAL::COLLINEAR && side == orientation(a, b, d);
}

}  // namespace

std::span<const FewVertices::Corners> FewVertices::triangulate(std::span<const PlanePoint> ring) {
  points_ = ring;
  triangles_.clear();
  if (!is_simple()) return {};
  turn_counterclockwise();
  for (auto& row : owner_) row.fill(kNoTriangle);
  if (!clip_ears()) return {};
  flip_edges();
  return triangles_;
}

bool FewVertices::is_simple() const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (std::size_t k = i + 1; k < points_.size(); ++k) {
      if (do_edges_meet(i, k)) return false;
    }
  }
  return true;
}

/// Whether two edges, which begin at points i < k, have more in common than an end of both.
bool FewVertices::do_edges_meet(std::size_t i, std::size_t k) const {
  const std::size_t count = points_.size();
  const PlanePoint& a = points_[i];
  const PlanePoint& b = points_[(i + 1) % count];
  const PlanePoint& c = points_[k];
  const PlanePoint& d = points_[(k + 1) % count];
  const bool is_next = k == i + 1;
  if (is_next || (i == 0 && k + 1 == count)) {
    const PlanePoint& from = is_next ? a : c;
    const PlanePoint& middle = is_next ? b : a;
    const PlanePoint& to = is_next ? d : b;
    return orientation(from, middle, to) == CGAL::COLLINEAR &&
           !(from < middle ? middle < to : to < middle && middle < from);
  }
  return do_boxes_meet(a, b, c, d) && !are_on_one_side(a, b, c, d) && !are_on_one_side(c, d, a, b);
}

void FewVertices::turn_counterclockwise() {
  const std::size_t count = points_.size();
  const auto smallest =
      static_cast<std::size_t>(std::min_element(points_.begin(), points_.end()) - points_.begin());
  const auto turn = orientation(points_[(smallest + count - 1) % count], points_[smallest],
                                points_[(smallest + 1) % count]);
  order_.resize(count);
  for (std::size_t i = 0; i < count; ++i) order_[i] = static_cast<std::uint8_t>(i);
  if (turn == CGAL::RIGHT_TURN) std::reverse(order_.begin(), order_.end());
}

void FewVertices::add(const Corners& corners, std::size_t number) {
  const auto [a, b, c] = corners;
  owner_[a][b] = owner_[b][c] = owner_[c][a] = static_cast<std::uint8_t>(number);
}

/// Cuts off one triangle after the other. Every simple polygon has an ear, and what is left of it
/// without one is simple.
bool FewVertices::clip_ears() {
  std::size_t i = 0;
  std::size_t tried = 0;
  while (order_.size() >= 3) {
    const std::size_t count = order_.size();
    const std::uint8_t before = order_[(i + count - 1) % count];
    const std::uint8_t corner = order_[i % count];
    const std::uint8_t after = order_[(i + 1) % count];
    if (!is_ear(before, corner, after)) {
      if (++tried > count) return false;
      i = (i + 1) % count;
      continue;
    }
    add({before, corner, after}, triangles_.size());
    triangles_.push_back({before, corner, after});
    order_.erase(order_.begin() + static_cast<std::ptrdiff_t>(i % count));
    tried = 0;
  }
  return true;
}

/// Whether three points in turn are a triangle in which no other point lies, nor on its border.
bool FewVertices::is_ear(std::uint8_t before, std::uint8_t corner, std::uint8_t after) const {
  const PlanePoint& a = points_[before];
  const PlanePoint& b = points_[corner];
  const PlanePoint& c = points_[after];
  if (orientation(a, b, c) != CGAL::LEFT_TURN) return false;
  return std::none_of(order_.begin(), order_.end(), [&](std::uint8_t other) {
    if (other == before || other == corner || other == after) return false;
    const PlanePoint& p = points_[other];
    return orientation(c, a, p) != CGAL::RIGHT_TURN && orientation(a, b, p) != CGAL::RIGHT_TURN &&
           orientation(b, c, p) != CGAL::RIGHT_TURN;
  });
}

std::uint8_t FewVertices::third(std::size_t triangle, std::uint8_t from, std::uint8_t to) const {
  for (const std::uint8_t corner : triangles_[triangle]) {
    if (corner != from && corner != to) return corner;
  }
  return from;
}

/// Whether the edge gives way to the one between the third corners of the triangles on its left and
/// right.
bool FewVertices::is_flipped(std::uint8_t from, std::uint8_t to, std::uint8_t left,
                             std::uint8_t right) const {
  const auto side = CGAL::side_of_oriented_circle(exact(points_[from]), exact(points_[to]),
                                                  exact(points_[left]), exact(points_[right]));
  if (side != CGAL::ON_ORIENTED_BOUNDARY) return side == CGAL::ON_POSITIVE_SIDE;
  // The largest of four points on a circle counts as outside: no edge between the others ends
  // there.
  const PlanePoint& end = std::max(points_[from], points_[to]);
  return std::max(points_[left], points_[right]) < end;
}

void FewVertices::flip_edges() {
  std::vector<std::pair<std::uint8_t, std::uint8_t>> open;
  const auto open_edge = [&](std::uint8_t from, std::uint8_t to) {
    if (owner_[to][from] != kNoTriangle) open.emplace_back(from, to);
  };
  for (const auto& [a, b, c] : triangles_) {
    if (a < b) open_edge(a, b);
    if (b < c) open_edge(b, c);
    if (c < a) open_edge(c, a);
  }
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    const std::uint8_t on_left = owner_[from][to];
    const std::uint8_t on_right = owner_[to][from];
    if (on_left == kNoTriangle || on_right == kNoTriangle) continue;
    const std::uint8_t left = third(on_left, from, to);
    const std::uint8_t right = third(on_right, from, to);
    if (!is_flipped(from, to, left, right)) continue;
    owner_[from][to] = owner_[to][from] = kNoTriangle;
    triangles_[on_left] = {left, from, right};
    triangles_[on_right] = {right, to, left};
    add(triangles_[on_left], on_left);
    add(triangles_[on_right], on_right);
    for (const auto& [a, b] : {std::pair{left, from}, {from, right}, {right, to}, {to, left}}) {
      open_edge(a, b);
    }
  }
}

}  // namespace watertight::tessellate
