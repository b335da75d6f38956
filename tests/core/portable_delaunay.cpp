// SPDX-License-Identifier: GPL-3.0-or-later
//
// Replaces delaunay/canonical_delaunay.cpp where CGAL is not to be linked: takes whole coordinates
// in a box below 2^30 only, as our own Delaunay tetrahedralization does. Only mode bitmap meets
// other coordinates. A linker that finds these definitions first leaves cgal_delaunay.cpp out.
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "delaunay/canonical/growing_delaunay.h"
#include "delaunay/canonical/small_delaunay.h"
#include "delaunay/canonical_delaunay.h"

namespace watertight::delaunay {

Result<CanonicalDelaunay> canonical_delaunay(std::span<const Point> points,
                                             std::uint64_t max_tetrahedra,
                                             const CancelPoll& is_cancelled) {
  if (is_small_grid(points)) return small_delaunay(points, max_tetrahedra, is_cancelled);
  return Error{ErrorCode::unsupported, "coordinates that only CGAL takes"};
}

/// Made anew each time, on a grid of 2^kGridBits steps to each whole number.
struct GrowingDelaunay::State {
  static constexpr int kGridBits = 12;
  std::vector<Point> points;
  CanonicalDelaunay delaunay;
};

GrowingDelaunay::GrowingDelaunay() : state_(std::make_unique<State>()) {}

GrowingDelaunay::~GrowingDelaunay() = default;

Status GrowingDelaunay::insert(std::span<const Point> points, std::uint64_t max_tetrahedra,
                               const CancelPoll& is_cancelled) {
  constexpr double kSteps = 1 << State::kGridBits;
  for (const Point& p : points) {
    state_->points.push_back({p.x * kSteps, p.y * kSteps, p.z * kSteps});
  }
  auto made = canonical_delaunay(state_->points, max_tetrahedra, is_cancelled);
  if (!made) return made.error();
  state_->delaunay = *std::move(made);
  return Done{};
}

bool GrowingDelaunay::has_edge(Index a, Index b) const {
  return std::ranges::any_of(state_->delaunay.faces, [&](const Triangle& face) {
    return std::ranges::count(face, a) > 0 && std::ranges::count(face, b) > 0;
  });
}

std::vector<bool> GrowingDelaunay::changed() {
  return std::vector<bool>(state_->points.size(), true);
}

CanonicalDelaunay GrowingDelaunay::listed() const { return state_->delaunay; }

}  // namespace watertight::delaunay
