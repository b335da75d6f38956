// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/snap.h"

#include <cmath>
#include <map>

#include "validate/overlap/metric_map.h"
#include "validate/overlap/near_vertices.h"

namespace watertight::validate {
namespace {

using Cell = std::array<std::int64_t, 3>;
/// The largest number of cells on an axis that doubles distinguish.
constexpr double kMostCells = 1e15;

class Snapper {
 public:
  Snapper(const Solid& solid, double metres, const geometry::Placement* placement)
      : vertices_(solid.vertices()), metres_(metres), map_(solid, placement) {
    const Box box = solid.box();
    origin_ = box.min;
    // The extent of the box along each axis of the world: no two points are further apart.
    std::array<double, 3> extent{};
    for (int axis = 0; axis < 3; ++axis) {
      Point corner = box.min;
      corner[axis] = box.max[axis];
      const std::array<double, 3> along = map_.metres(box.min, corner);
      for (std::size_t a = 0; a < 3; ++a) extent[a] += std::fabs(along[a]);
    }
    for (const double size : extent) is_possible_ = is_possible_ && size / metres < kMostCells;
  }

  bool is_possible() const { return is_possible_; }

  /// The coordinates of the vertices in metres from the low corner of the box.
  std::vector<Point> places() const {
    std::vector<Point> result;
    result.reserve(vertices_.size());
    for (const Point& p : vertices_) {
      const std::array<double, 3> place = map_.metres(origin_, p);
      result.push_back({place[0], place[1], place[2]});
    }
    return result;
  }

  /// The vertex to which a vertex moves: itself or an earlier vertex.
  Index target(Index vertex) {
    const Cell cell = cell_of(vertex);
    Index best = kNone;
    for (std::int64_t x = cell[0] - 1; x <= cell[0] + 1; ++x) {
      for (std::int64_t y = cell[1] - 1; y <= cell[1] + 1; ++y) {
        for (std::int64_t z = cell[2] - 1; z <= cell[2] + 1; ++z) {
          const auto place = kept_.find(Cell{x, y, z});
          if (place == kept_.end()) continue;
          for (const Index other : place->second) {
            if (other < best && is_near(other, vertex)) best = other;
          }
        }
      }
    }
    if (best != kNone) return best;
    kept_[cell].push_back(vertex);
    return vertex;
  }

 private:
  Cell cell_of(Index vertex) const {
    Cell cell{};
    const std::array<double, 3> place = map_.metres(origin_, vertices_[vertex]);
    for (std::size_t a = 0; a < 3; ++a) {
      cell[a] = static_cast<std::int64_t>(std::floor(place[a] / metres_));
    }
    return cell;
  }

  bool is_near(Index a, Index b) const {
    double sum = 0;
    for (const double d : map_.metres(vertices_[a], vertices_[b])) sum += d * d;
    return sum <= metres_ * metres_;
  }

  std::span<const Point> vertices_;
  double metres_;
  MetricMap map_;
  Point origin_;
  bool is_possible_ = true;
  std::map<Cell, std::vector<Index>> kept_;
};

}  // namespace

Result<SnappedSolid> snap_vertices(const Solid& solid, double metres, const CancelPoll& cancel,
                                   const geometry::Placement* placement) {
  if (solid.vertex_count() == 0) return SnappedSolid{solid, 0};
  Snapper snapper(solid, metres, placement);
  if (!snapper.is_possible()) {
    return Error{ErrorCode::limit_exceeded,
                 "the snap tolerance is too small for the size of the solid"};
  }
  // Only vertices near another vertex can move or be moved to. The search reaches a little farther
  // than the tolerance, and Snapper::is_near() decides.
  constexpr double kSlack = 1e-9;
  const NearPoints near = near_points(snapper.places(), metres * (1 + kSlack), cancel);
  if (cancel && cancel()) return Error{ErrorCode::cancelled, "the snapping was cancelled"};
  SolidArrays arrays = solid.arrays();
  Index moved = 0;
  for (const Index vertex : near.points) {
    const Point& to = solid.vertices()[snapper.target(vertex)];
    if (arrays.vertices[vertex] == to) continue;
    arrays.vertices[vertex] = to;
    ++moved;
  }
  Limits limits;  // no limits: the submitted solid has kept them already
  limits.vertices = limits.facets = limits.rings = limits.shells = kNone;
  auto snapped = Solid::make(std::move(arrays), solid.lattice(), solid.srid(), limits);
  if (!snapped) return snapped.error();
  return SnappedSolid{*std::move(snapped), moved};
}

}  // namespace watertight::validate
