// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/plane/triangle_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace watertight::spline {
namespace {

constexpr std::size_t kMostPlaces = 4096;  // along one axis

Rectangle rectangle_of(std::span<const Point> vertices, const Triangle& triangle) {
  const std::array<Point, 3> corners{vertices[triangle[0]], vertices[triangle[1]],
                                     vertices[triangle[2]]};
  return Rectangle::around(corners);
}

std::size_t places_for(double length, double step) {
  const double places = std::ceil(length / step);
  return std::clamp<std::size_t>(
      places < kMostPlaces ? static_cast<std::size_t>(places) : kMostPlaces, 1, kMostPlaces);
}

}  // namespace

Rectangle Rectangle::around(std::span<const Point> points) {
  Rectangle rectangle{points[0], points[0]};
  for (const Point& point : points) {
    rectangle.low.x = std::min(rectangle.low.x, point.x);
    rectangle.low.y = std::min(rectangle.low.y, point.y);
    rectangle.high.x = std::max(rectangle.high.x, point.x);
    rectangle.high.y = std::max(rectangle.high.y, point.y);
  }
  return rectangle;
}

TriangleGrid::TriangleGrid(std::span<const Point> vertices, std::span<const Triangle> triangles) {
  if (triangles.empty()) return;
  all_ = rectangle_of(vertices, triangles[0]);
  for (const Triangle& triangle : triangles) {
    const Rectangle own = rectangle_of(vertices, triangle);
    const std::array<Point, 4> ends{all_.low, all_.high, own.low, own.high};
    all_ = Rectangle::around(ends);
  }
  const double width = all_.high.x - all_.low.x;
  const double height = all_.high.y - all_.low.y;
  const auto count = static_cast<double>(triangles.size());
  step_ = std::max({std::sqrt(width / count * height), width / kMostPlaces, height / kMostPlaces});
  columns_ = places_for(width, step_);
  rows_ = places_for(height, step_);

  starts_.assign(columns_ * rows_ + 1, 0);
  for (const bool is_counting : {true, false}) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const Cells cells = cells_of(rectangle_of(vertices, triangles[t]));
      for (std::size_t row = cells.first_row; row <= cells.last_row; ++row) {
        for (std::size_t column = cells.first_column; column <= cells.last_column; ++column) {
          std::size_t& start = starts_[row * columns_ + column];
          if (!is_counting) triangles_[start] = static_cast<Index>(t);
          ++start;
        }
      }
    }
    // Counts become starts; when the triangles are written, each start has moved to the next one's.
    if (is_counting) {
      std::size_t sum = 0;
      for (std::size_t& start : starts_) sum += std::exchange(start, sum);
      triangles_.resize(sum);
    } else {
      std::rotate(starts_.rbegin(), starts_.rbegin() + 1, starts_.rend());
      starts_[0] = 0;
    }
  }
}

std::size_t TriangleGrid::place(double offset, std::size_t count) const {
  const double places = offset / step_;
  if (!(places > 0)) return 0;
  return places < static_cast<double>(count - 1) ? static_cast<std::size_t>(places) : count - 1;
}

TriangleGrid::Cells TriangleGrid::cells_of(const Rectangle& rectangle) const {
  return {place(rectangle.low.x - all_.low.x, columns_),
          place(rectangle.high.x - all_.low.x, columns_),
          place(rectangle.low.y - all_.low.y, rows_), place(rectangle.high.y - all_.low.y, rows_)};
}

std::span<const Index> TriangleGrid::cell(std::size_t column, std::size_t row) const {
  const std::size_t number = row * columns_ + column;
  return std::span(triangles_).subspan(starts_[number], starts_[number + 1] - starts_[number]);
}

std::span<const Index> TriangleGrid::at(const Point& u) const {
  if (columns_ == 0 || !all_.has(u)) return {};
  return cell(place(u.x - all_.low.x, columns_), place(u.y - all_.low.y, rows_));
}

std::vector<Index> TriangleGrid::near(const Rectangle& rectangle) const {
  std::vector<Index> found;
  if (columns_ == 0 || !all_.meets(rectangle)) return found;
  const Cells cells = cells_of(rectangle);
  for (std::size_t row = cells.first_row; row <= cells.last_row; ++row) {
    for (std::size_t column = cells.first_column; column <= cells.last_column; ++column) {
      const auto own = cell(column, row);
      found.insert(found.end(), own.begin(), own.end());
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace watertight::spline
