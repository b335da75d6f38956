// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/overlap/near_vertices.h"

#include <algorithm>
#include <cmath>

#include "validate/overlap/box_tree.h"

namespace watertight::validate {
namespace {

double squared_distance(const Point& a, const Point& b) {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  const double z = a.z - b.z;
  return x * x + y * y + z * z;
}

/// A lower bound of the squared distance between points of two boxes. Rounding is monotone, so the
/// bound never exceeds the squared distance that is computed for two points.
double squared_distance(const Box& a, const Box& b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap = std::max({0.0, a.min[axis] - b.max[axis], b.min[axis] - a.max[axis]});
    sum += gap * gap;
  }
  return sum;
}

struct Nearest {
  double squared = 0;
  Index point = kNone;
};

}  // namespace

NearPoints near_points(std::span<const Point> points, double reach, const CancelPoll& cancel) {
  std::vector<Box> boxes;
  boxes.reserve(points.size());
  for (const Point& p : points) boxes.push_back({p, p});
  const BoxTree tree(boxes);
  std::vector<Nearest> nearest(points.size(), Nearest{reach * reach, kNone});
  const auto compare = [&](Index a, Index b) {
    if (a == b) return;
    const double squared = squared_distance(points[a], points[b]);
    Nearest& best = nearest[a];
    if (squared > best.squared) return;
    if (squared == best.squared && best.point != kNone && best.point < b) return;
    best = {squared, b};
  };
  bool is_cancelled = false;
  tree.visit_leaves([&](std::span<const Index> leaf, const Box& box) {
    is_cancelled = is_cancelled || (cancel && cancel());
    if (is_cancelled) return;
    for (const Index a : leaf) {
      for (const Index b : leaf) compare(a, b);
    }
    double farthest = 0;
    for (const Index a : leaf) farthest = std::max(farthest, nearest[a].squared);
    tree.visit([&](const Box& other) { return squared_distance(box, other) <= farthest; },
               [&](Index b) {
                 for (const Index a : leaf) compare(a, b);
               });
  });
  NearPoints result;
  double closest = 0;
  for (Index a = 0; a < points.size(); ++a) {
    if (nearest[a].point == kNone) continue;
    result.points.push_back(a);
    if (result.first != kNone && nearest[a].squared >= closest) continue;
    closest = nearest[a].squared;
    result.first = std::min(a, nearest[a].point);
    result.second = std::max(a, nearest[a].point);
  }
  result.distance = std::sqrt(closest);
  return result;
}

}  // namespace watertight::validate
