// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/dense/quantized_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace watertight {
namespace {

/// The facets as fans of triangles: the peers take triangles only, and all get the same ones.
std::vector<Triangle> fans_of(const Solid& solid) {
  std::vector<Triangle> triangles;
  for (Index facet = 0; facet < solid.facet_count(); ++facet) {
    if (solid.rings_of(facet).size() != 1) return {};
    const auto ring = solid.ring(solid.rings_of(facet).begin);
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      triangles.push_back({ring[0], ring[i], ring[i + 1]});
    }
  }
  return triangles;
}

bool is_closed(const std::vector<Triangle>& triangles) {
  std::map<std::pair<Index, Index>, int> balance;
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = t[k];
      const Index to = t[(k + 1) % 3];
      balance[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
    }
  }
  return !triangles.empty() &&
         std::all_of(balance.begin(), balance.end(), [](const auto& b) { return b.second == 0; });
}

}  // namespace

std::optional<codec::IntegerSolid> quantize(const Solid& solid, std::optional<int> bits) {
  const std::vector<Triangle> fans = fans_of(solid);
  const Box box = solid.box();
  const double extent =
      std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
  const double scale = bits ? (std::ldexp(1.0, *bits) - 1) / extent : 1;
  std::vector<codec::GridPoint> points;
  for (const Point& p : solid.vertices()) {
    codec::GridPoint q{};
    for (int k = 0; k < 3; ++k) {
      const double value = bits ? std::floor((p[k] - box.min[k]) * scale + 0.5) : p[k];
      if (std::abs(value) >= 0x1p53 || value != std::floor(value)) return std::nullopt;
      q[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(value);
    }
    points.push_back(q);
  }
  std::set<Triangle> kept;
  std::map<codec::GridPoint, Index> numbers;
  for (const codec::GridPoint& p : points) numbers.emplace(p, Index{0});
  for (const Triangle& fan : fans) {
    std::array<codec::GridPoint, 3> corner{points[fan[0]], points[fan[1]], points[fan[2]]};
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    for (const codec::GridPoint& p : corner) numbers[p] = 1;
  }
  codec::IntegerSolid mesh;
  for (auto& [point, number] : numbers) {
    if (number == 0) continue;
    number = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back(point);
  }
  for (const Triangle& fan : fans) {
    std::array<codec::GridPoint, 3> corner{points[fan[0]], points[fan[1]], points[fan[2]]};
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    Triangle t{numbers[corner[0]], numbers[corner[1]], numbers[corner[2]]};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    kept.insert(t);
  }
  // Triangles that quantization folded onto others, turned the other way, are left out.
  std::vector<Triangle> triangles;
  for (const Triangle& t : kept) {
    if (kept.count({t[0], t[2], t[1]}) == 0) triangles.push_back(t);
  }
  if (!is_closed(triangles)) return std::nullopt;
  std::vector<Index> used(mesh.vertices.size(), 0);
  for (const Triangle& t : triangles) {
    for (const Index v : t) used[v] = 1;
  }
  std::vector<codec::GridPoint> vertices;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    used[v] = static_cast<Index>(vertices.size());
    vertices.push_back(mesh.vertices[v]);
  }
  mesh.vertices = vertices;
  for (const Triangle& t : triangles) {
    for (const Index v : t) mesh.ring_vertices.push_back(used[v]);
    mesh.ring_offsets.push_back(static_cast<Index>(mesh.ring_vertices.size()));
    mesh.facet_offsets.push_back(mesh.ring_count());
  }
  mesh.shell_offsets.push_back(mesh.facet_count());
  return mesh;
}

}  // namespace watertight
