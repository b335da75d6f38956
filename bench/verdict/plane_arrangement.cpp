// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/verdict/plane_arrangement.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace watertight::verdict {
namespace {

// The relative widening of boxes: doubles of rationals are off by one unit in the last place, which
// is much less.
constexpr double kWidening = 1e-12;

double low(double a, double b) {
  return std::min(a, b) - kWidening * std::max(std::abs(a), std::abs(b));
}
double high(double a, double b) {
  return std::max(a, b) + kWidening * std::max(std::abs(a), std::abs(b));
}

}  // namespace

std::size_t PointTable::number_of(const Vector& p) {
  const auto [place, is_new] = numbers_.emplace(p, points_.size());
  if (is_new) {
    points_.push_back(p);
    near_.push_back({p[0].get_d(), p[1].get_d(), p[2].get_d()});
  }
  return place->second;
}

PlaneArrangement::PlaneArrangement(PointTable& table, int axis, const std::set<Segment>& segments,
                                   const std::set<std::size_t>& points)
    : table_(table), u_((axis + 1) % 3), v_((axis + 2) % 3) {
  split(segments, points);
  link();
  find_regions();
  place_lone_points(region_of_, points);
}

Number PlaneArrangement::turn(const Vector& a, const Vector& b, const Vector& c) const {
  const auto u = static_cast<std::size_t>(u_);
  const auto v = static_cast<std::size_t>(v_);
  return (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
}

bool PlaneArrangement::is_before(const Vector& a, const Vector& b) const {
  const auto u = static_cast<std::size_t>(u_);
  const auto v = static_cast<std::size_t>(v_);
  return a[u] != b[u] ? a[u] < b[u] : a[v] < b[v];
}

/// True if p, a point on the line through a and b, is on the closed segment from a to b.
bool PlaneArrangement::is_between(const Vector& p, const Vector& a, const Vector& b) const {
  return is_before(a, b) ? !is_before(p, a) && !is_before(b, p)
                         : !is_before(p, b) && !is_before(a, p);
}

bool PlaneArrangement::may_meet(const Segment& a, const Segment& b) const {
  for (const int axis : {u_, v_}) {
    const double a0 = table_.near(a[0])[axis];
    const double a1 = table_.near(a[1])[axis];
    const double b0 = table_.near(b[0])[axis];
    const double b1 = table_.near(b[1])[axis];
    if (high(a0, a1) < low(b0, b1) || high(b0, b1) < low(a0, a1)) return false;
  }
  return true;
}

/// Adds the points in which two different segments meet, and the end points of overlaps.
void PlaneArrangement::note_meeting(const Segment& a, const Segment& b, std::set<std::size_t>& on_a,
                                    std::set<std::size_t>& on_b) {
  const std::array<const Vector*, 4> p{&table_[a[0]], &table_[a[1]], &table_[b[0]], &table_[b[1]]};
  const Number b0 = turn(*p[0], *p[1], *p[2]);
  const Number b1 = turn(*p[0], *p[1], *p[3]);
  const Number a0 = turn(*p[2], *p[3], *p[0]);
  const Number a1 = turn(*p[2], *p[3], *p[1]);
  if (sgn(b0) == 0 && is_between(*p[2], *p[0], *p[1])) on_a.insert(b[0]);
  if (sgn(b1) == 0 && is_between(*p[3], *p[0], *p[1])) on_a.insert(b[1]);
  if (sgn(a0) == 0 && is_between(*p[0], *p[2], *p[3])) on_b.insert(a[0]);
  if (sgn(a1) == 0 && is_between(*p[1], *p[2], *p[3])) on_b.insert(a[1]);
  if (sgn(b0) * sgn(b1) < 0 && sgn(a0) * sgn(a1) < 0) {
    const std::size_t point = table_.number_of(verdict::between(*p[2], *p[3], b0 / (b0 - b1)));
    on_a.insert(point);
    on_b.insert(point);
  }
}

void PlaneArrangement::split(const std::set<Segment>& segments,
                             const std::set<std::size_t>& points) {
  const std::vector<Segment> all(segments.begin(), segments.end());
  std::vector<std::set<std::size_t>> on(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    on[i] = {all[i][0], all[i][1]};
    for (std::size_t j = 0; j < i; ++j) {
      if (may_meet(all[i], all[j])) note_meeting(all[i], all[j], on[i], on[j]);
    }
  }
  std::set<Segment> edges;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const std::size_t point : points) {
      if (!may_meet(all[i], {point, point})) continue;
      if (is_on_segment(table_[point], table_[all[i][0]], table_[all[i][1]])) on[i].insert(point);
    }
    std::vector<std::size_t> along(on[i].begin(), on[i].end());
    std::sort(along.begin(), along.end(),
              [&](std::size_t a, std::size_t b) { return is_before(table_[a], table_[b]); });
    for (std::size_t k = 0; k + 1 < along.size(); ++k) {
      edges.insert({std::min(along[k], along[k + 1]), std::max(along[k], along[k + 1])});
    }
  }
  for (const Segment& edge : edges) {
    half_edges_.push_back({edge[0], edge[1], 0, 0});
    half_edges_.push_back({edge[1], edge[0], 0, 0});
  }
}

/// True if the direction of a half-edge comes before another around their point, counter-clockwise
/// from the direction of growing u.
bool PlaneArrangement::is_angle_before(std::size_t half_edge, std::size_t other) const {
  const HalfEdge& a = half_edges_[half_edge];
  const HalfEdge& b = half_edges_[other];
  const Vector& origin = table_[a.from];
  const auto is_lower = [&](const Vector& p) { return is_before(p, origin); };
  const bool a_lower = is_lower(table_[a.to]);
  const bool b_lower = is_lower(table_[b.to]);
  if (a_lower != b_lower) return b_lower;
  return sgn(turn(origin, table_[a.to], table_[b.to])) > 0;
}

void PlaneArrangement::link() {
  std::map<std::size_t, std::vector<std::size_t>> leaving;
  for (std::size_t i = 0; i < half_edges_.size(); ++i) leaving[half_edges_[i].from].push_back(i);
  for (auto& [point, around] : leaving) {
    std::sort(around.begin(), around.end(),
              [&](std::size_t a, std::size_t b) { return is_angle_before(a, b); });
    for (std::size_t k = 0; k < around.size(); ++k) {
      const std::size_t arriving = around[k] ^ 1U;
      half_edges_[arriving].next = around[(k + around.size() - 1) % around.size()];
    }
  }
}

std::vector<std::size_t> PlaneArrangement::find_cycles() {
  std::vector<std::size_t> first;
  cycle_of_.assign(half_edges_.size(), kUnbounded);
  for (std::size_t i = 0; i < half_edges_.size(); ++i) {
    if (cycle_of_[i] != kUnbounded) continue;
    for (std::size_t k = i; cycle_of_[k] == kUnbounded; k = half_edges_[k].next) {
      cycle_of_[k] = first.size();
    }
    first.push_back(i);
  }
  return first;
}

/// Twice the signed area that a cycle turns around.
Number PlaneArrangement::area(std::size_t half_edge) const {
  const Vector& origin = table_[half_edges_[half_edge].from];
  Number sum = 0;
  for (std::size_t k = half_edges_[half_edge].next; k != half_edge; k = half_edges_[k].next) {
    sum += turn(origin, table_[half_edges_[k].from], table_[half_edges_[k].to]);
  }
  return sum;
}

/// The cycle of the region just left (towards smaller u) of a point that is the first of its
/// component: the cycle above the highest edge below the point. kUnbounded if there is no such
/// edge.
std::size_t PlaneArrangement::cycle_left_of(std::size_t point) const {
  const auto u = static_cast<std::size_t>(u_);
  const Vector& p = table_[point];
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < half_edges_.size(); ++i) {
    const Vector& a = table_[half_edges_[i].from];
    const Vector& b = table_[half_edges_[i].to];
    if (!(a[u] < p[u] && p[u] <= b[u])) continue;
    if (sgn(turn(a, b, p)) <= 0) continue;
    if (best) {  // whether this edge is above the best one just left of the point
      const Vector& c = table_[half_edges_[*best].from];
      const Vector& d = table_[half_edges_[*best].to];
      const bool starts_later = a[u] > c[u];
      const int side = starts_later ? sgn(turn(c, d, a)) : -sgn(turn(a, b, c));
      const int end_side = b[u] < d[u] ? sgn(turn(c, d, b)) : -sgn(turn(a, b, d));
      if ((side != 0 ? side : end_side) <= 0) continue;
    }
    best = i;
  }
  return best ? cycle_of_[*best] : kUnbounded;
}

void PlaneArrangement::find_regions() {
  const std::vector<std::size_t> first = find_cycles();
  region_of_.assign(first.size(), kUnbounded);
  std::vector<std::size_t> outer(first.size(), kUnbounded);  // for each cycle, the cycle around it
  std::vector<bool> is_hole(first.size());
  for (std::size_t cycle = 0; cycle < first.size(); ++cycle) {
    is_hole[cycle] = sgn(area(first[cycle])) <= 0;
    if (!is_hole[cycle]) {
      region_of_[cycle] = region_count_++;
      first_of_.push_back(first[cycle]);
      continue;
    }
    std::size_t leftmost = half_edges_[first[cycle]].from;
    for (std::size_t k = half_edges_[first[cycle]].next; k != first[cycle];
         k = half_edges_[k].next) {
      if (is_before(table_[half_edges_[k].from], table_[leftmost])) leftmost = half_edges_[k].from;
    }
    outer[cycle] = cycle_left_of(leftmost);
  }
  for (std::size_t cycle = 0; cycle < first.size(); ++cycle) {
    std::size_t around = cycle;
    while (around != kUnbounded && is_hole[around]) around = outer[around];
    if (around != kUnbounded) region_of_[cycle] = region_of_[around];
  }
  for (std::size_t i = 0; i < half_edges_.size(); ++i) {
    half_edges_[i].region = region_of_[cycle_of_[i]];
  }
}

void PlaneArrangement::place_lone_points(const std::vector<std::size_t>& region_of,
                                         const std::set<std::size_t>& points) {
  std::set<std::size_t> with_edges;
  for (const HalfEdge& half_edge : half_edges_) with_edges.insert(half_edge.from);
  for (const std::size_t point : points) {
    if (with_edges.count(point) != 0) continue;
    const std::size_t cycle = cycle_left_of(point);
    if (cycle != kUnbounded && region_of[cycle] != kUnbounded) {
      lone_points_.push_back({point, region_of[cycle]});
    }
  }
}

Vector PlaneArrangement::sample(std::size_t region) const {
  const auto u = static_cast<std::size_t>(u_);
  const auto v = static_cast<std::size_t>(v_);
  const HalfEdge& edge = half_edges_[first_of_[region]];
  Vector middle = verdict::between(table_[edge.from], table_[edge.to], Number(1, 2));
  Vector ahead = middle;  // a point to the left of the edge
  ahead[u] -= table_[edge.to][v] - table_[edge.from][v];
  ahead[v] += table_[edge.to][u] - table_[edge.from][u];
  std::optional<Number> nearest;
  const auto note = [&](const Number& t) {
    if (sgn(t) > 0 && (!nearest || t < *nearest)) nearest = t;
  };
  const Number length = dot(difference(ahead, middle), difference(ahead, middle));
  for (std::size_t i = 0; i < half_edges_.size(); i += 2) {
    const Vector& a = table_[half_edges_[i].from];
    const Vector& b = table_[half_edges_[i].to];
    const Number side_a = turn(middle, ahead, a);
    const Number side_b = turn(middle, ahead, b);
    if (sgn(side_a) * sgn(side_b) > 0) continue;
    const auto along = [&](const Vector& p) -> Number {
      return ((p[u] - middle[u]) * (ahead[u] - middle[u]) +
              (p[v] - middle[v]) * (ahead[v] - middle[v])) /
             length;
    };
    if (side_a == side_b) {
      note(along(a));
      note(along(b));
    } else {
      note(along(verdict::between(a, b, side_a / (side_a - side_b))));
    }
  }
  // A region is bounded, so the ray meets its boundary. Points without an edge do not belong to the
  // region.
  Vector result;
  bool is_lone = true;
  for (long part = 2; is_lone; ++part) {
    result = verdict::between(middle, ahead, *nearest / part);
    is_lone = std::any_of(lone_points_.begin(), lone_points_.end(), [&](const auto& lone) {
      return table_[lone[0]][u] == result[u] && table_[lone[0]][v] == result[v];
    });
  }
  result[3 - u - v] = 0;
  return result;
}

}  // namespace watertight::verdict
