// SPDX-License-Identifier: GPL-3.0-or-later
#include "validate/snap.h"

#include <cmath>
#include <map>

#include "geometry/crs.h"
#include "validate/near_vertices.h"

namespace watertight {
namespace {

using Cell = std::array<std::int64_t, 3>;
/// Cells beyond this number per axis could not be told apart in double precision.
constexpr double kMostCells = 1e15;

class Snapper {
 public:
  Snapper(const Solid& solid, double metres) : vertices_(solid.vertices()), metres_(metres) {
    const Box box = solid.box();
    const Lattice& lattice = solid.lattice();
    std::array<double, 3> centre{};
    for (int axis = 0; axis < 3; ++axis) {
      centre[static_cast<std::size_t>(axis)] =
          lattice.world(box.min[axis], axis) / 2 + lattice.world(box.max[axis], axis) / 2;
    }
    const AxisUnits units = axis_units(solid.srid(), centre);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      scale_[a] = lattice.scale(axis) * units.metres_per_unit[a];
      origin_[a] = box.min[axis];
      is_possible_ =
          is_possible_ && (box.max[axis] - box.min[axis]) * scale_[a] / metres < kMostCells;
    }
  }

  bool is_possible() const { return is_possible_; }

  /// In metres from the corner of the box.
  std::vector<Point> places() const {
    std::vector<Point> result;
    result.reserve(vertices_.size());
    for (const Point& p : vertices_) {
      Point place;
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        place[axis] = (p[axis] - origin_[a]) * scale_[a];
      }
      result.push_back(place);
    }
    return result;
  }

  /// The vertex that this one becomes: itself or an earlier one.
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
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double place = (vertices_[vertex][axis] - origin_[a]) * scale_[a] / metres_;
      cell[a] = static_cast<std::int64_t>(std::floor(place));
    }
    return cell;
  }

  bool is_near(Index a, Index b) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d =
          (vertices_[a][axis] - vertices_[b][axis]) * scale_[static_cast<std::size_t>(axis)];
      sum += d * d;
    }
    return sum <= metres_ * metres_;
  }

  std::span<const Point> vertices_;
  double metres_;
  std::array<double, 3> scale_{};
  std::array<double, 3> origin_{};
  bool is_possible_ = true;
  std::map<Cell, std::vector<Index>> kept_;
};

}  // namespace

Result<SnappedSolid> snap_vertices(const Solid& solid, double metres,
                                   const std::function<bool()>& cancel) {
  if (solid.vertex_count() == 0) return SnappedSolid{solid, 0};
  Snapper snapper(solid, metres);
  if (!snapper.is_possible()) {
    return Error{ErrorCode::limit_exceeded,
                 "the snap tolerance is too small for the size of the solid"};
  }
  // The others neither move nor draw another; a little more reach than needed is_near() decides.
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
  Limits limits;  // the submitted solid has been admitted already
  limits.vertices = limits.facets = limits.rings = limits.shells = kNone;
  auto snapped = Solid::make(std::move(arrays), solid.lattice(), solid.srid(), limits);
  if (!snapped) return snapped.error();
  return SnappedSolid{*std::move(snapped), moved};
}

}  // namespace watertight
