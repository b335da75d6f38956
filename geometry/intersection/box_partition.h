// SPDX-License-Identifier: GPL-3.0-or-later
//
// All pairs of triangles of a boundary that meet otherwise than in a common vertex or edge: the
// self-intersection test of Verbree and Si 2008, section 3.2. For the validator and the
// certificate.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "geometry/intersection/triangle_triangle.h"
#include "geometry/point.h"

namespace watertight::geometry {

/// Two triangles that intersect, first < second.
struct IntersectingPair {
  Index first = 0;
  Index second = 0;
  ContactClass contact = ContactClass::crossing;
  friend bool operator==(const IntersectingPair&, const IntersectingPair&) = default;
};

struct IntersectionOptions {
  /// The search ends when this many pairs are found; 1 answers whether there is any.
  std::uint64_t limit = 10'000;
  /// The caller's thread calls this function about every 2^16 box comparisons. If it returns true,
  /// the search ends with ErrorCode::cancelled.
  CancelPoll cancel = {};
  /// The number of threads that share the search, the caller's among them. The result does not
  /// depend on the number.
  unsigned threads = 1;
  /// If not empty, a number for each triangle: triangles with equal numbers are known not to
  /// intersect and are not compared.
  std::span<const Index> group_of = {};
};

/// All pairs whose contact is an intersection (is_intersection), sorted by first, then second. If
/// the result has `limit` pairs, there may be more; which of them are found depends on nothing but
/// the input. Degenerate triangles (a repeated index, or points on one line) belong to no pair:
/// callers report them by themselves. contact_witness() gives a witness of a pair.
/// Requires indices in range; equal indices mean equal vertices.
/// Errors: cancelled. Cost: O(n log n) for surfaces whose triangles are small beside the whole, for
/// fans around common vertices and for long, thin triangles of about one direction; at worst O(n^2)
/// box comparisons and classifications (docs/robustness.md). Memory: linear, beside the pairs.
/// Source: Verbree and Si 2008, section 3.2. Departures: boxes are cut into slabs along the axis
/// that separates them best; a pair is reported only in the part that owns the low corner of the
/// overlap of its boxes; triangles that no cut separates are compared by direction from a common
/// vertex, or along axes that follow the triangles.
Result<std::vector<IntersectingPair>> intersecting_pairs(std::span<const Point> points,
                                                         std::span<const Triangle> triangles,
                                                         const IntersectionOptions& options = {});

}  // namespace watertight::geometry
