// SPDX-License-Identifier: GPL-3.0-or-later
//
// A canonical Delaunay tetrahedralization to which points are added. Defined in cgal_delaunay.cpp.
// Private to delaunay/.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/cancel.h"
#include "base/result.h"
#include "delaunay/canonical_delaunay.h"

namespace watertight::delaunay {

/// A canonical Delaunay tetrahedralization that takes points one after the other.
class GrowingDelaunay {
 public:
  GrowingDelaunay();
  ~GrowingDelaunay();
  GrowingDelaunay(const GrowingDelaunay&) = delete;
  GrowingDelaunay& operator=(const GrowingDelaunay&) = delete;

  /// Inserts points, which get the next numbers. Errors: those of canonical_delaunay().
  Status insert(std::span<const Point> points, std::uint64_t max_tetrahedra,
                const CancelPoll& is_cancelled);
  /// Requires points that span a volume. Cost: that of the tetrahedra at a vertex.
  bool has_edge(Index a, Index b) const;
  /// The vertices that have new neighbours since the last call. An edge is lost only between two of
  /// them.
  std::vector<bool> changed();
  /// All of it, as canonical_delaunay() returns it. Requires fewer tetrahedra than the limit.
  CanonicalDelaunay listed() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace watertight::delaunay
