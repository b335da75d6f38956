// SPDX-License-Identifier: GPL-3.0-or-later
#include "spline/plane/proper_triangulation.h"

#include <cmath>
#include <string>

#include "geometry/predicates/turn.h"

namespace watertight::spline {
namespace {

struct Corners {
  std::array<Point, 3> points;
  Triangle vertices;

  bool has(Index vertex) const {
    return vertices[0] == vertex || vertices[1] == vertex || vertices[2] == vertex;
  }
};

/// Whether an edge of one triangle has all of the other on its right side or on itself.
bool is_separated_by_edge(const Corners& one, const Corners& other) {
  for (std::size_t j = 0; j < 3; ++j) {
    bool is_apart = true;
    for (const Point& point : other.points) {
      is_apart = is_apart && geometry::turn(one.points[j], one.points[(j + 1) % 3], point) <= 0;
    }
    if (is_apart) return true;
  }
  return false;
}

/// Whether a corner of one triangle, which is not the other's, lies in the other or on its border.
bool has_foreign_corner(const Corners& one, const Corners& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (other.has(one.vertices[i])) continue;
    bool is_in = true;
    for (std::size_t j = 0; j < 3; ++j) {
      is_in =
          is_in && geometry::turn(other.points[j], other.points[(j + 1) % 3], one.points[i]) >= 0;
    }
    if (is_in) return true;
  }
  return false;
}

bool meet_properly(const Corners& one, const Corners& other) {
  return (is_separated_by_edge(one, other) || is_separated_by_edge(other, one)) &&
         !has_foreign_corner(one, other) && !has_foreign_corner(other, one);
}

Error error_at(std::size_t triangle, const std::string& what) {
  return Error{ErrorCode::malformed, "triangle " + std::to_string(triangle) + " " + what};
}

}  // namespace

Status check_triangulation(std::span<const Point> vertices, std::span<const Triangle> triangles) {
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (!std::isfinite(vertices[v].x) || !std::isfinite(vertices[v].y)) {
      return Error{ErrorCode::malformed, "vertex " + std::to_string(v) + " is not finite"};
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const Index corner : triangles[t]) {
      if (corner >= vertices.size()) return error_at(t, "has a corner that is no vertex");
    }
    const auto& [a, b, c] = triangles[t];
    if (geometry::turn(vertices[a], vertices[b], vertices[c]) <= 0)
      return error_at(t, "does not turn left");
  }
  const TriangleGrid grid(vertices, triangles);
  const auto corners_of = [&](Index t) {
    const auto& [a, b, c] = triangles[t];
    return Corners{{vertices[a], vertices[b], vertices[c]}, triangles[t]};
  };
  for (Index t = 0; t < triangles.size(); ++t) {
    const Corners own = corners_of(t);
    for (const Index other : grid.near(Rectangle::around(own.points))) {
      if (other >= t) break;
      if (!meet_properly(own, corners_of(other))) {
        return error_at(
            t, "and triangle " + std::to_string(other) + " meet in more than an edge or a vertex");
      }
    }
  }
  return Done{};
}

}  // namespace watertight::spline
