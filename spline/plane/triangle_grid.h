// SPDX-License-Identifier: GPL-3.0-or-later
//
// Triangles of the plane by the squares of a grid that they can meet. Internal to spline/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "spline/simplex_spline.h"

namespace watertight::spline {

/// A closed rectangle.
struct Rectangle {
  Point low;
  Point high;

  static Rectangle around(std::span<const Point> points);
  bool has(const Point& u) const {
    return low.x <= u.x && u.x <= high.x && low.y <= u.y && u.y <= high.y;
  }
  bool meets(const Rectangle& other) const {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
           other.low.y <= high.y;
  }
};

class TriangleGrid {
 public:
  TriangleGrid() = default;
  /// About as many squares as triangles. Requires finite points.
  TriangleGrid(std::span<const Point> vertices, std::span<const Triangle> triangles);

  /// The triangles whose rectangle can contain u, in ascending order; none outside of the grid.
  std::span<const Index> at(const Point& u) const;

  /// The triangles whose rectangle can meet another one, in ascending order, each once.
  std::vector<Index> near(const Rectangle& rectangle) const;

 private:
  struct Cells {
    std::size_t first_column;
    std::size_t last_column;
    std::size_t first_row;
    std::size_t last_row;
  };
  std::size_t place(double offset, std::size_t count) const;
  Cells cells_of(const Rectangle& rectangle) const;
  std::span<const Index> cell(std::size_t column, std::size_t row) const;

  Rectangle all_;
  double step_ = 1;
  std::size_t columns_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::size_t> starts_;  // of the triangles of each square, row by row, and an end
  std::vector<Index> triangles_;
};

}  // namespace watertight::spline
