// SPDX-License-Identifier: GPL-3.0-or-later
//
// Based on: E. Verbree and H. Si, Validation and Storage of Polyhedra through Constrained Delaunay
// Tetrahedralization, 2008, section 3.2.
#include "geometry/box_partition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/contact_classifier.h"
#include "geometry/inline_predicates.h"

namespace watertight {
namespace {

constexpr std::size_t kLeafSize = 8;
constexpr std::uint64_t kCancelInterval = std::uint64_t{1} << 16U;
/// A split is worth its copies if it saves at least this share of the pairs of its box. It also
/// bounds the work: the sum of squared leaf sizes never exceeds the square of the root's.
constexpr double kLargestShareOfPairs = 0.8;

/// Bounds of a triangle in single precision relative to the corner of all, rounded outward. The
/// rounding is monotone, so boxes that overlap in doubles overlap here.
struct FloatBox {
  std::array<float, 3> low;
  std::array<float, 3> high;
};

constexpr float kLargestFloat = std::numeric_limits<float>::max();

float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  const float infinity = std::numeric_limits<float>::infinity();
  const float down =
      static_cast<double>(nearest) > value ? std::nextafter(nearest, -infinity) : nearest;
  return std::clamp(down, -kLargestFloat, kLargestFloat);
}

float rounded_up(double value) {
  const auto nearest = static_cast<float>(value);
  const float infinity = std::numeric_limits<float>::infinity();
  const float up =
      static_cast<double>(nearest) < value ? std::nextafter(nearest, infinity) : nearest;
  return std::clamp(up, -kLargestFloat, kLargestFloat);
}

bool overlap(const FloatBox& a, const FloatBox& b) {
  return a.low[0] <= b.high[0] && b.low[0] <= a.high[0] && a.low[1] <= b.high[1] &&
         b.low[1] <= a.high[1] && a.low[2] <= b.high[2] && b.low[2] <= a.high[2];
}

/// A part of space, half open, and the triangles whose boxes reach into it: the members
/// [begin, end) of the stack.
struct Part {
  std::array<float, 3> low;
  std::array<float, 3> high;
  std::size_t begin = 0;
  std::size_t end = 0;
};

struct Member {
  FloatBox box;
  Index triangle = 0;
};

class Search {
 public:
  Search(std::span<const Point> points, std::span<const Triangle> triangles,
         const IntersectionOptions& options)
      : points_(points), triangles_(triangles), options_(options), classifier_(points) {}

  Result<std::vector<IntersectingPair>> run() {
    collect_members();
    const float infinity = std::numeric_limits<float>::infinity();
    parts_.push_back(
        {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}, 0, members_.size()});
    while (!parts_.empty() && !is_cancelled_ && pairs_.size() < options_.limit) {
      const Part part = parts_.back();
      parts_.pop_back();
      if (!split(part)) {
        compare_all(part);
        members_.resize(part.begin);
      }
    }
    if (is_cancelled_)
      return Error{ErrorCode::cancelled, "the search for intersections was stopped"};
    std::sort(pairs_.begin(), pairs_.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : a.second < b.second;
    });
    return std::move(pairs_);
  }

 private:
  struct Spread {
    std::array<float, 3> low{kLargestFloat, kLargestFloat, kLargestFloat};
    std::array<float, 3> high{-kLargestFloat, -kLargestFloat, -kLargestFloat};
    std::array<float, 3> first_centre = low;
    std::array<float, 3> last_centre = high;
  };

  void collect_members();
  bool is_degenerate(const Triangle& triangle) const;
  bool split(const Part& part);
  Spread spread(const Part& part) const;
  bool is_worthwhile(const Part& part, std::size_t axis, float plane) const;
  void divide(const Part& part, std::size_t axis, float plane);
  void compare_all(const Part& part);
  void compare(const Member& a, const Member& b, const Part& part);

  std::span<const Point> points_;
  std::span<const Triangle> triangles_;
  const IntersectionOptions& options_;
  ContactClassifier<InlinePredicates> classifier_;
  std::vector<Member> members_;  // of all parts on the stack, each after those below it
  std::vector<Member> lower_;    // of the part being divided
  std::vector<Part> parts_;
  std::vector<IntersectingPair> pairs_;
  std::uint64_t comparisons_ = 0;
  bool is_cancelled_ = false;
};

bool Search::is_degenerate(const Triangle& triangle) const {
  const auto [a, b, c] = triangle;
  if (a == b || b == c || c == a) return true;
  for (int axis = 2; axis >= 0; --axis) {
    if (InlinePredicates::orient2d(points_[a], points_[b], points_[c], axis) != 0) return false;
  }
  return true;
}

void Search::collect_members() {
  Box all;
  for (const Triangle& triangle : triangles_) {
    for (const Index vertex : triangle) all.include(points_[vertex]);
  }
  members_.reserve(triangles_.size() + triangles_.size() / 2);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (is_degenerate(triangles_[i])) continue;
    Box box;
    for (const Index vertex : triangles_[i]) box.include(points_[vertex]);
    Member member;
    member.triangle = static_cast<Index>(i);
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      member.box.low[at] = rounded_down(box.min[axis] - all.min[axis]);
      member.box.high[at] = rounded_up(box.max[axis] - all.min[axis]);
    }
    members_.push_back(member);
  }
}

/// Where the members' boxes and their centres lie, as far as they are inside the part.
Search::Spread Search::spread(const Part& part) const {
  Spread spread;
  for (std::size_t i = part.begin; i < part.end; ++i) {
    const FloatBox& box = members_[i].box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float low = std::max(box.low[axis], part.low[axis]);
      const float high = std::min(box.high[axis], part.high[axis]);
      const float centre = 0.5F * low + 0.5F * high;
      spread.low[axis] = std::min(spread.low[axis], low);
      spread.high[axis] = std::max(spread.high[axis], high);
      spread.first_centre[axis] = std::min(spread.first_centre[axis], centre);
      spread.last_centre[axis] = std::max(spread.last_centre[axis], centre);
    }
  }
  return spread;
}

bool Search::is_worthwhile(const Part& part, std::size_t axis, float plane) const {
  std::size_t lower = 0;
  std::size_t upper = 0;
  for (std::size_t i = part.begin; i < part.end; ++i) {
    if (members_[i].box.low[axis] < plane) ++lower;
    if (members_[i].box.high[axis] >= plane) ++upper;
  }
  const auto square = [](std::size_t n) { return static_cast<double>(n) * static_cast<double>(n); };
  return square(lower) + square(upper) <= kLargestShareOfPairs * square(part.end - part.begin);
}

/// Replaces the part by its two halves, cut midway between the outermost centres, if that saves
/// work. The longest axis is tried first.
bool Search::split(const Part& part) {
  if (part.end - part.begin <= kLeafSize) return false;
  const Spread extent = spread(part);
  const auto length = [&](std::size_t axis) { return extent.high[axis] - extent.low[axis]; };
  std::array<std::size_t, 3> axes{0, 1, 2};
  if (length(axes[0]) < length(axes[1])) std::swap(axes[0], axes[1]);
  if (length(axes[1]) < length(axes[2])) std::swap(axes[1], axes[2]);
  if (length(axes[0]) < length(axes[1])) std::swap(axes[0], axes[1]);
  for (const std::size_t axis : axes) {
    const float plane = 0.5F * extent.first_centre[axis] + 0.5F * extent.last_centre[axis];
    const bool is_inside = plane > part.low[axis] && plane < part.high[axis];
    if (!is_inside || !is_worthwhile(part, axis, plane)) continue;
    divide(part, axis, plane);
    return true;
  }
  return false;
}

void Search::divide(const Part& part, std::size_t axis, float plane) {
  lower_.clear();
  std::size_t kept = part.begin;
  for (std::size_t i = part.begin; i < part.end; ++i) {
    const Member member = members_[i];
    if (member.box.low[axis] < plane) lower_.push_back(member);
    if (member.box.high[axis] >= plane) members_[kept++] = member;
  }
  members_.resize(kept);
  members_.insert(members_.end(), lower_.begin(), lower_.end());
  Part upper = part;
  upper.low[axis] = plane;
  upper.end = kept;
  Part lower = part;
  lower.high[axis] = plane;
  lower.begin = kept;
  lower.end = members_.size();
  parts_.push_back(upper);
  parts_.push_back(lower);
}

void Search::compare_all(const Part& part) {
  for (std::size_t i = part.begin; i < part.end; ++i) {
    for (std::size_t j = i + 1; j < part.end; ++j) {
      if (overlap(members_[i].box, members_[j].box)) compare(members_[i], members_[j], part);
    }
    comparisons_ += part.end - i;
    if (comparisons_ >= kCancelInterval) {
      comparisons_ = 0;
      is_cancelled_ = options_.cancel && options_.cancel();
    }
    if (is_cancelled_ || pairs_.size() >= options_.limit) break;
  }
  if (pairs_.size() > options_.limit) pairs_.resize(options_.limit);
}

void Search::compare(const Member& a, const Member& b, const Part& part) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float corner = std::max(a.box.low[axis], b.box.low[axis]);
    if (corner < part.low[axis] || corner >= part.high[axis]) return;
  }
  const auto [first, second] = std::minmax(a.triangle, b.triangle);
  const ContactClass contact = classifier_.classify(triangles_[first], triangles_[second]);
  if (is_intersection(contact)) pairs_.push_back({first, second, contact});
}

}  // namespace

Result<std::vector<IntersectingPair>> intersecting_pairs(std::span<const Point> points,
                                                         std::span<const Triangle> triangles,
                                                         const IntersectionOptions& options) {
  return Search(points, triangles, options).run();
}

}  // namespace watertight
