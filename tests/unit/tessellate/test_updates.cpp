// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "tessellate/trimmed/grid.h"
#include "tessellate/trimmed/trimmed_mesh.h"

namespace watertight {
namespace {

using tessellate::PlaneGrid;
using tessellate::Region;
using tessellate::TrimmedMesh;

// Triangles by their coordinates, in an order that does not depend on numbers.
using Places = std::vector<std::array<std::array<double, 2>, 3>>;
Places places_of(std::span<const Point> points, std::span<const Triangle> triangles) {
  Places places;
  for (const Triangle& triangle : triangles) {
    std::array<std::array<double, 2>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = {points[triangle[k]].x, points[triangle[k]].y};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    places.push_back(corners);
  }
  std::sort(places.begin(), places.end());
  return places;
}

// A region with a hole whose points may lie on grid lines and on grid points.
struct Drawing {
  std::vector<std::vector<Point>> loops;
  PlaneGrid grid;

  Region region() const {
    Region region;
    for (const std::vector<Point>& loop : loops) {
      const auto first = static_cast<Index>(region.points.size());
      const auto count = static_cast<Index>(loop.size());
      for (Index i = 0; i < count; ++i) {
        region.edges.push_back({first + i, first + (i + 1) % count});
      }
      region.points.insert(region.points.end(), loop.begin(), loop.end());
    }
    return region;
  }
};

Point random_point(std::mt19937& random) {
  return {static_cast<double>(random() % 80) / 4, static_cast<double>(random() % 80) / 4, 0};
}

Drawing drawing(std::mt19937& random) {
  Drawing result;
  for (const bool is_hole : {false, true}) {
    std::vector<Point> loop;
    const std::size_t count = 4 + random() % 12;
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(count);
      const double radius =
          is_hole ? 1 + static_cast<double>(random() % 2) : 5 + static_cast<double>(random() % 5);
      loop.push_back({std::round(4 * (10 + radius * std::cos(angle))) / 4,
                      std::round(4 * (10 + radius * std::sin(angle))) / 4, 0});
    }
    if (is_hole) std::reverse(loop.begin(), loop.end());
    result.loops.push_back(std::move(loop));
  }
  for (std::size_t i = random() % 12; i > 0; --i) {
    result.grid.us.push_back(20.0 / static_cast<double>(i) - 1);
    result.grid.vs.push_back(18.0 / static_cast<double>(i));
  }
  return result;
}

// The number of a loop point in a mesh.
Index number_at(const TrimmedMesh& mesh, const Point& place) {
  for (Index i = 0; i < mesh.points().size(); ++i) {
    if (mesh.next(i) == kNone) continue;
    if (mesh.points()[i].x == place.x && mesh.points()[i].y == place.y) return i;
  }
  return kNone;
}

void change_line(std::mt19937& random, Drawing& drawn, TrimmedMesh& mesh) {
  const std::size_t axis = random() % 2;
  std::vector<double>& lines = axis == 0 ? drawn.grid.us : drawn.grid.vs;
  if (!lines.empty() && random() % 2 == 0) {
    const std::size_t line = random() % lines.size();
    REQUIRE(mesh.remove_grid_line(axis, lines[line]));
    CHECK_FALSE(mesh.remove_grid_line(axis, lines[line]));
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(line));
    return;
  }
  const double at = random_point(random).x;
  const auto place = std::lower_bound(lines.begin(), lines.end(), at);
  const bool is_new = place == lines.end() || *place != at;
  REQUIRE(mesh.add_grid_line(axis, at) == is_new);
  if (is_new) lines.insert(place, at);
}

// Changes one of the loops; true if both the mesh and a fresh run take the change.
bool change_sample(std::mt19937& random, Drawing& drawn, TrimmedMesh& mesh) {
  std::vector<Point>& loop = drawn.loops[random() % drawn.loops.size()];
  const std::size_t at = random() % loop.size();
  const Index number = number_at(mesh, loop[at]);
  REQUIRE(number != kNone);
  const std::vector<Point> before = loop;
  std::optional<tessellate::RegionConflict> conflict;
  if (random() % 2 == 0) {
    if (loop.size() == 3) {
      CHECK(mesh.remove_sample(number)->kind == tessellate::RegionConflict::Kind::not_closed);
      return false;
    }
    loop.erase(loop.begin() + static_cast<std::ptrdiff_t>(at));
    conflict = mesh.remove_sample(number);
  } else {
    Point place = random_point(random);
    if (random() % 4 == 0) {  // on the edge, or nearly
      const Point& a = loop[at];
      const Point& b = loop[(at + 1) % loop.size()];
      place = {(a.x + b.x) / 2, (a.y + b.y) / 2, 0};
    }
    loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(at) + 1, place);
    conflict = mesh.insert_sample(number, place);
  }
  const auto fresh = tessellate::sweep_region(drawn.region());
  REQUIRE(conflict.has_value() == fresh.conflict.has_value());
  if (conflict) loop = before;
  return !conflict;
}

}  // namespace

TEST_CASE("a mesh that is changed has the triangles of a fresh run") {
  std::mt19937 random(7);
  std::size_t changes = 0;
  std::size_t refused = 0;
  while (changes < 10'000) {
    Drawing drawn = drawing(random);
    TrimmedMesh mesh(drawn.region(), drawn.grid);
    if (mesh.conflict()) continue;
    for (int step = 0; step < 60; ++step) {
      CAPTURE(changes, step);
      if (random() % 3 == 0) {
        change_line(random, drawn, mesh);
      } else if (!change_sample(random, drawn, mesh)) {
        ++refused;
      }
      const auto fresh = tessellate::triangulate_trimmed(drawn.region(), drawn.grid);
      REQUIRE_FALSE(fresh.conflict);
      REQUIRE(places_of(mesh.points(), mesh.triangles()) ==
              places_of(fresh.points, fresh.triangles));
      ++changes;
    }
  }
  CHECK(refused > 1'000);
  CHECK(refused < 7'000);
}

TEST_CASE("a sample that makes loops cross is refused, and the mesh stays as it is") {
  Drawing drawn{
      {{{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}}, {{2, 2, 0}, {2, 4, 0}, {4, 4, 0}, {4, 2, 0}}},
      {{1, 3, 5, 7}, {1, 3, 5, 7}}};
  TrimmedMesh mesh(drawn.region(), drawn.grid);
  REQUIRE_FALSE(mesh.conflict());
  const Places before = places_of(mesh.points(), mesh.triangles());
  const auto conflict = mesh.insert_sample(0, {3, 3, 0});
  REQUIRE(conflict);
  CHECK(conflict->kind == tessellate::RegionConflict::Kind::crossing);
  CHECK(places_of(mesh.points(), mesh.triangles()) == before);
  CHECK(mesh.insert_sample(0, {8, 8, 0})->kind == tessellate::RegionConflict::Kind::equal);
  CHECK(places_of(mesh.points(), mesh.triangles()) == before);
}

}  // namespace watertight
