// SPDX-License-Identifier: GPL-3.0-or-later
//
// Prints checksums of filled holes in surfaces over triangulations and of smooth patches, whose knots, triangles and
// coefficients depend on every rounding.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "base/checksum.h"
#include "repair/remedies.h"
#include "spline/dms_surface.h"
#include "spline/extend_triangulation.h"
#include "spline/knot_clouds.h"
#include "spline/spline_json.h"
#include "spline/thin_plate.h"
#include "tests/builds/fingerprint.h"
#include "tests/random.h"

namespace watertight::builds {
namespace {

/// The border of a square of so many edges a side, a little out of line.
std::vector<Point> square(int edges, double low, double high, test::Random& random) {
  std::vector<Point> polygon;
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < edges; ++i) {
      const double along = low + (high - low) * i / edges;
      const double off = random.within(-100, 100) / 4096;
      const double back = low + high - along;
      const Point corners[] = {{along, low + off, 0}, {high + off, along, 0}, {back, high + off, 0}, {low + off, back, 0}};
      polygon.push_back(corners[side]);
    }
  }
  return polygon;
}

/// The JSON of a surface between two squares whose inside is filled; empty after an error.
std::string filled_surface(std::uint64_t seed) {
  test::Random random(seed);
  constexpr int kEdges = 3;
  const std::vector<Point> outer = square(2 * kEdges, -2, 2, random);
  const std::vector<Point> inner = square(kEdges, -1, 1, random);
  const std::vector<std::vector<Point>> ring{outer, inner};
  auto mesh = spline::extend_triangulation(ring);
  const std::vector<std::vector<Point>> hole{inner};
  const auto inside = spline::extend_triangulation(hole, {.density = 0.8});
  if (!mesh || !inside) return {};
  const auto fixed = spline::make_clouds(mesh->vertices, mesh->triangles);
  if (!fixed) return {};
  std::vector<Index> filled;
  const auto before = static_cast<Index>(mesh->vertices.size());
  const auto border = static_cast<Index>(inner.size());
  for (const Triangle& t : inside->triangles) {
    filled.push_back(static_cast<Index>(mesh->triangles.size()));
    Triangle& own = mesh->triangles.emplace_back();
    for (std::size_t j = 0; j < 3; ++j) own[j] = t[j] < border ? static_cast<Index>(outer.size()) + t[j] : before + t[j] - border;
  }
  mesh->vertices.insert(mesh->vertices.end(), inside->vertices.begin() + border, inside->vertices.end());
  auto vertices = spline::move_off_lines(mesh->vertices, mesh->triangles, *fixed);
  if (!vertices) return {};
  auto clouds = spline::make_clouds(*vertices, mesh->triangles, *fixed);
  if (!clouds) return {};
  const auto domain = spline::DmsDomain::make({2, std::move(*vertices), std::move(*clouds), mesh->triangles});
  if (!domain) return {};
  std::vector<Point> coefficients;
  for (std::size_t f = 0; f < domain->function_count(); ++f) {
    const double x = random.within(-1000, 1000);
    coefficients.push_back({x, random.within(-1000, 1000), random.within(-1000, 1000)});
  }
  auto plate = spline::least_thin_plate(*domain, filled, coefficients);
  if (!plate) return {};
  const auto surface = spline::DmsSurface::make(*domain, std::move(plate->coefficients));
  return surface ? spline::to_json(*surface) : std::string();
}

/// A block whose upper side is triangles of random heights, with a hole in the middle.
repair::EditedSolid open_block(test::Random& random) {
  constexpr Index kSize = 10;
  constexpr Index kRow = kSize + 1;
  repair::EditedSolid solid{{}, {{}}, {}, 0};
  for (const bool is_upper : {false, true}) {
    for (Index y = 0; y < kRow; ++y) {
      for (Index x = 0; x < kRow; ++x) solid.vertices.push_back({1000.0 * x, 1000.0 * y, is_upper ? random.within(5000, 5900) : 0});
    }
  }
  const auto add = [&](repair::Ring ring) { solid.shells[0].push_back({{std::move(ring)}, kNone}); };
  constexpr Index kUp = kRow * kRow;
  for (Index y = 0; y < kSize; ++y) {
    for (Index x = 0; x < kSize; ++x) {
      const Index at = y * kRow + x;
      add({at, at + kRow, at + kRow + 1, at + 1});
      if (x >= 4 && x < 6 && y >= 4 && y < 7) continue;
      add({kUp + at, kUp + at + 1, kUp + at + kRow + 1});
      add({kUp + at, kUp + at + kRow + 1, kUp + at + kRow});
    }
  }
  for (Index i = 0; i < kSize; ++i) {
    const Index sides[][2] = {{i, i + 1}, {i * kRow + kSize, (i + 1) * kRow + kSize}, {kSize * kRow + i + 1, kSize * kRow + i}, {(i + 1) * kRow, i * kRow}};
    for (const auto& [from, to] : sides) add({from, to, kUp + to, kUp + from});
  }
  return solid;
}

/// Prints checksums of the patches over the holes of a block; false if there is none.
bool print_patches(std::uint64_t seed) {
  test::Random random(seed);
  repair::EditedSolid solid = open_block(random);
  repair::FillHolesOptions options;
  options.smooth.emplace().keeps_surface = true;
  bool has_patch = false;
  for (const repair::HoleFill& hole : repair::fill_holes(solid, options)) {
    has_patch = has_patch || hole.smooth.has_value();
    std::printf("patch %llu: %zu facets %08x %s %.17g %.17g\n", static_cast<unsigned long long>(seed), hole.facets, crc32c(as_bytes(hole.spline)),
                hole.smooth_refusal.c_str(), hole.smooth ? hole.smooth->energy : 0, hole.smooth ? hole.smooth->largest_turn : 0);
  }
  std::string places;
  for (const Point& p : solid.vertices) {
    for (int axis = 0; axis < 3; ++axis) places.append(solid.lattice.world_text(p[axis], axis)).append(" ");
  }
  std::printf("vertices %08x\n", crc32c(as_bytes(places)));
  return has_patch;
}

}  // namespace

bool print_splines() {
  bool has_patch = false;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) has_patch = print_patches(seed) || has_patch;
  if (!has_patch) return false;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::string json = filled_surface(seed);
    if (json.empty()) return false;
    std::printf("spline %u %08x\n", static_cast<unsigned>(seed),
                crc32c({reinterpret_cast<const std::uint8_t*>(json.data()), json.size()}));
  }
  return true;
}

}  // namespace watertight::builds
