// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/generated/generated_variety.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace watertight::generated {
namespace {

using Ring = std::vector<Index>;

struct Shape {
  std::string name;
  SolidArrays arrays;
};

Index add_vertex(SolidArrays& arrays, std::int64_t x, std::int64_t y, std::int64_t z) {
  arrays.vertices.push_back(
      {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  return static_cast<Index>(arrays.vertices.size() - 1);
}

std::int64_t between(Random& random, std::int64_t low, std::int64_t high) {
  return low + static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(high - low + 1)));
}

Ring backward(Ring ring) {
  std::reverse(ring.begin(), ring.end());
  return ring;
}

void add_walls(SolidArrays& arrays, const Ring& low, const Ring& high) {
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t j = (i + 1) % low.size();
    add_facet(arrays, {{low[i], low[j], high[j], high[i]}});
  }
}

/// Appends the corners of a convex polygon around a point: the sides of a square, bent outward.
Ring add_polygon(SolidArrays& arrays, std::int64_t x, std::int64_t y, std::int64_t z, Index sides,
                 std::int64_t radius) {
  Ring ring;
  for (Index i = 0; i < sides; ++i) {
    // The corner lies on a side of a square, bent outward so that no three corners are on one line.
    const std::int64_t place = std::int64_t{4} * radius * i / sides;
    const std::int64_t side = place / radius;
    const std::int64_t along = 2 * (place % radius) - radius;
    const std::int64_t out = radius + (radius * radius - along * along) / (4 * radius);
    constexpr std::array<std::array<int, 2>, 4> kOut{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
    const auto& o = kOut[static_cast<std::size_t>(side)];
    ring.push_back(
        add_vertex(arrays, x + o[0] * out - o[1] * along, y + o[1] * out + o[0] * along, z));
  }
  return ring;
}

/// Houses in a row: one stepped polygon for all fronts, with vertices on its edges.
Shape row_of_houses(Random& random, Index size) {
  SolidArrays arrays;
  const Index houses = std::max<Index>(size / 4, 1);
  std::array<Ring, 2> skyline;
  const std::int64_t depth = between(random, 2000, 12000);
  std::array<Ring, 2> foot;
  const bool has_all_feet = random.below(2) == 0;
  std::int64_t x = 0;
  std::int64_t height = 0;
  for (Index i = 0; i < houses; ++i) {
    const std::int64_t width = between(random, 500, 9000);
    const std::int64_t next = height + 1 + between(random, 1, 7000);
    height = next > 20000 ? next % 1000 + 3 : next;
    for (std::size_t side = 0; side < 2; ++side) {
      const std::int64_t y = side == 0 ? 0 : depth;
      if (i == 0 || has_all_feet) foot[side].push_back(add_vertex(arrays, x, y, 0));
      skyline[side].push_back(add_vertex(arrays, x, y, height));
      skyline[side].push_back(add_vertex(arrays, x + width, y, height));
    }
    x += width;
  }
  for (std::size_t side = 0; side < 2; ++side) {
    foot[side].push_back(add_vertex(arrays, x, side == 0 ? 0 : depth, 0));
  }
  Ring front = foot[0];
  front.insert(front.end(), skyline[0].rbegin(), skyline[0].rend());
  Ring back = backward(foot[1]);
  back.insert(back.end(), skyline[1].begin(), skyline[1].end());
  Ring bottom = backward(foot[0]);
  bottom.insert(bottom.end(), foot[1].begin(), foot[1].end());
  add_facet(arrays, {front});
  add_facet(arrays, {back});
  add_facet(arrays, {bottom});
  Ring low{foot[0].front()};
  Ring high{foot[1].front()};
  low.insert(low.end(), skyline[0].begin(), skyline[0].end());
  high.insert(high.end(), skyline[1].begin(), skyline[1].end());
  low.push_back(foot[0].back());
  high.push_back(foot[1].back());
  for (std::size_t i = 0; i + 1 < low.size(); ++i) {
    add_facet(arrays, {{low[i], low[i + 1], high[i + 1], high[i]}});
  }
  arrays.end_shell();
  return {"row-of-houses", std::move(arrays)};
}

/// The surface of random cells of a grid: with handles, cavities, and edges and vertices that
/// shells share; many of its vertices are cospherical.
Shape voxels(Random& random, Index size) {
  const auto side = static_cast<Index>(2 + std::sqrt(static_cast<double>(size)) / 3);
  const Index nx = 1 + static_cast<Index>(random.below(side));
  const Index ny = 1 + static_cast<Index>(random.below(side));
  const Index nz = std::clamp<Index>(size / (nx * ny), 1, side);
  const std::uint64_t fill = 30 + random.below(65);
  std::vector<bool> is_full(std::size_t{nx} * ny * nz);
  for (std::size_t i = 0; i < is_full.size(); ++i) is_full[i] = random.below(100) < fill;
  is_full[0] = true;
  SolidArrays arrays;
  std::map<std::array<Index, 3>, Index> number;
  const auto vertex = [&](std::array<Index, 3> place) {
    const auto [found, is_new] = number.try_emplace(place, 0);
    if (is_new) found->second = add_vertex(arrays, place[0], place[1], place[2]);
    return found->second;
  };
  const auto has = [&](std::array<Index, 3> c) {
    // An Index below 0 wraps around to a large one.
    if (c[0] >= nx || c[1] >= ny || c[2] >= nz) return false;
    return bool{is_full[(std::size_t{c[0]} * ny + c[1]) * nz + c[2]]};
  };
  for (Index cell = 0; cell < is_full.size(); ++cell) {
    const std::array<Index, 3> c{cell / (ny * nz), cell / nz % ny, cell % nz};
    if (!has(c)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const Index up : {0U, 1U}) {
        std::array<Index, 3> other = c;
        other[axis] += up == 1 ? 1U : ~Index{0};
        if (has(other)) continue;
        std::array<Index, 3> corner = c;
        corner[axis] += up;
        Ring ring;
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        for (const auto& [du, dv] : {std::pair{0U, 0U}, {1U, 0U}, {1U, 1U}, {0U, 1U}}) {
          std::array<Index, 3> p = corner;
          p[u] += du;
          p[v] += dv;
          ring.push_back(vertex(p));
        }
        add_facet(arrays, {up == 1 ? ring : backward(ring)});
      }
    }
  }
  arrays.end_shell();
  return {"voxels", std::move(arrays)};
}

/// A plate with polygons cut out of it, some through it and some as pits, and with boxes as
/// cavities.
Shape plate(Random& random, Index size) {
  SolidArrays arrays;
  const Index cells = std::max<Index>(size / 12, 1);
  const auto columns = static_cast<Index>(std::sqrt(static_cast<double>(cells))) + 1;
  const std::int64_t pitch = 3000;
  const std::int64_t width = columns * pitch;
  const std::int64_t height = between(random, 100, 9000);
  const auto square = [&](std::int64_t z) {
    return Ring{add_vertex(arrays, 0, 0, z), add_vertex(arrays, width, 0, z),
                add_vertex(arrays, width, width, z), add_vertex(arrays, 0, width, z)};
  };
  const Ring low = square(0);
  const Ring high = square(height);
  std::vector<Ring> bottom{backward(low)};
  std::vector<Ring> top{high};
  add_walls(arrays, low, high);
  for (Index i = 0; i < cells; ++i) {
    const std::int64_t x = (i % columns) * pitch + pitch / 2;
    const std::int64_t y = (i / columns) * pitch + pitch / 2;
    const auto sides = static_cast<Index>(3 + random.below(6));
    const std::int64_t radius = between(random, 200, 1000);
    const std::uint64_t kind = random.below(4);
    if (kind == 0) continue;
    const std::int64_t floor = kind == 1 ? 0 : height / 3;
    const Ring from = add_polygon(arrays, x, y, floor, sides, radius);
    const Ring to = add_polygon(arrays, x, y, height, sides, radius);
    add_walls(arrays, backward(from), backward(to));
    top.push_back(backward(to));
    if (kind == 1) {
      bottom.push_back(from);
    } else {
      add_facet(arrays, {from});
    }
  }
  add_facet(arrays, top);
  add_facet(arrays, bottom);
  arrays.end_shell();
  const std::uint64_t cavities = random.below(3);
  for (std::uint64_t i = 0; i < cavities && height > 600; ++i) {
    const auto x = static_cast<double>(20 + 40 * i);
    add_box(arrays, {x, 20, 20}, {x + 20, 40, 60}, Turn::inward);
  }
  return {"plate", std::move(arrays)};
}

/// A cone over a polygon, or two cones: a tip has as many edges as the polygon has sides.
Shape fan(Random& random, Index size) {
  SolidArrays arrays;
  const Index sides = std::max<Index>(size, 4) - 1;
  const Ring base = add_polygon(arrays, 0, 0, 0, sides, std::max<std::int64_t>(sides, 64));
  const Index top = add_vertex(arrays, 0, 0, between(random, 1, 100000));
  const bool is_double = random.below(2) == 0;
  const Index below = is_double ? add_vertex(arrays, 3, 1, -between(random, 1, 100000)) : 0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    const Index next = base[(i + 1) % base.size()];
    add_facet(arrays, {{base[i], next, top}});
    if (is_double) add_facet(arrays, {{next, base[i], below}});
  }
  if (!is_double) add_facet(arrays, {backward(base)});
  arrays.end_shell();
  return {"fan", std::move(arrays)};
}

/// Two polygons on the same vertices, one seen from each side, with nothing between them.
Shape two_sided(Random& random, Index size) {
  SolidArrays arrays;
  const Ring ring = add_polygon(arrays, 7, 9, between(random, -5, 5), std::max<Index>(size, 3),
                                std::max<std::int64_t>(size, 50));
  add_facet(arrays, {ring});
  add_facet(arrays, {backward(ring)});
  arrays.end_shell();
  return {"two-sided", std::move(arrays)};
}

/// Boxes each of which touches the one before: at an edge, at a vertex or along a part of a facet.
/// Either each box is a shell, or all of them form one shell.
Shape chain_of_boxes(Random& random, Index size) {
  SolidArrays arrays;
  std::map<std::array<std::int64_t, 3>, Index> number;
  std::array<std::int64_t, 3> at{};
  const bool is_one_shell = random.below(2) == 0;
  for (Index i = 0; i < std::max<Index>(size / 7, 1); ++i) {
    std::array<std::int64_t, 3> to{};
    for (std::size_t axis = 0; axis < 3; ++axis) to[axis] = at[axis] + between(random, 1, 3) * 500;
    SolidArrays box;
    const auto point = [](const std::array<std::int64_t, 3>& p) {
      return Point{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
    };
    add_box(box, point(at), point(to));
    for (Index facet = 0; facet < 6; ++facet) {
      Ring ring;
      for (Index k = 4 * facet; k < 4 * facet + 4; ++k) {
        const Point p = box.vertices[box.ring_vertices[k]];
        const std::array<std::int64_t, 3> key{static_cast<std::int64_t>(p.x),
                                              static_cast<std::int64_t>(p.y),
                                              static_cast<std::int64_t>(p.z)};
        const auto [found, is_new] = number.try_emplace(key, 0);
        if (is_new) found->second = add_vertex(arrays, key[0], key[1], key[2]);
        ring.push_back(found->second);
      }
      add_facet(arrays, {ring});
    }
    if (!is_one_shell) arrays.end_shell();
    const std::uint64_t kind = random.below(3);
    at = {to[0], kind > 0 ? to[1] : at[1], kind > 1 ? to[2] : at[2]};
  }
  if (is_one_shell) arrays.end_shell();
  return {"chain-of-boxes", std::move(arrays)};
}

/// A tube of rings of points around a closed path on the grid: genus 1, any size.
Shape tube(Random& random, Index size) {
  SolidArrays arrays;
  const auto around = static_cast<Index>(3 + random.below(6));
  const Index along = std::max<Index>(size / around, 3);
  std::vector<Ring> rings;
  for (Index i = 0; i < along; ++i) {
    const std::int64_t radius = between(random, 100, 400);
    rings.push_back(add_polygon(arrays, 0, 0, i * 100 + between(random, 0, 40), around, radius));
  }
  const bool is_closed = random.below(2) == 0;
  for (Index i = 0; i + (is_closed ? 0 : 1) < along; ++i) {
    add_walls(arrays, rings[i], rings[(i + 1) % along]);
  }
  if (!is_closed) {
    add_facet(arrays, {backward(rings.front())});
    add_facet(arrays, {rings.back()});
  }
  arrays.end_shell();
  return {"tube", std::move(arrays)};
}

Shape known(Random& random, Index size) {
  const auto side = static_cast<Index>(1 + std::sqrt(static_cast<double>(size)) / 2);
  switch (random.below(9)) {
    case 0:
      return {"terrain", random_terrain(random, side).solid().arrays()};
    case 1:
      return {"prism", random_prism(random, std::max<Index>(size / 2, 3)).solid().arrays()};
    case 2:
      return {"grid-cube", grid_cube(std::min<Index>(1 + side / 2, 40)).solid().arrays()};
    case 3:
      return {"torus", torus(static_cast<Index>(3 + random.below(14)),
                             static_cast<Index>(3 + random.below(14)))
                           .solid()
                           .arrays()};
    case 4:
      return {"touching-hole", block_with_touching_hole().solid().arrays()};
    case 5:
      return {"cavities", box_with_cavities(std::max<Index>(size / 8, 1)).solid().arrays()};
    case 6:
      return {"pierced", pierced_block(std::max<Index>(side / 3, 1)).solid().arrays()};
    case 7:
      return {"schoenhardt", schoenhardt().solid().arrays()};
    default:
      return {"box", box().solid().arrays()};
  }
}

Shape random_shape(Random& random, Index size) {
  switch (random.below(10)) {
    case 0:
    case 1:
      return row_of_houses(random, size);
    case 2:
      return voxels(random, size);
    case 3:
      return plate(random, size);
    case 4:
      return fan(random, size);
    case 5:
      return chain_of_boxes(random, size);
    case 6:
      return tube(random, size);
    case 7:
      if (random.below(4) == 0) return two_sided(random, size);
      [[fallthrough]];
    default:
      return known(random, size);
  }
}

/// Copies arrays facet by facet; `make` appends the replacement of each facet.
template <class Make>
SolidArrays with_facets(const SolidArrays& old, SolidArrays arrays, const Make& make) {
  for (std::size_t shell = 0; shell + 1 < old.shell_offsets.size(); ++shell) {
    for (Index facet = old.shell_offsets[shell]; facet < old.shell_offsets[shell + 1]; ++facet) {
      std::vector<Ring> rings;
      for (Index ring = old.facet_offsets[facet]; ring < old.facet_offsets[facet + 1]; ++ring) {
        rings.emplace_back(old.ring_vertices.begin() + old.ring_offsets[ring],
                           old.ring_vertices.begin() + old.ring_offsets[ring + 1]);
      }
      make(arrays, std::move(rings));
    }
    arrays.end_shell();
  }
  return arrays;
}

/// Cuts some facets into triangles at their first vertex or at a new vertex above their middle.
void cut_facets(Random& random, Shape& shape) {
  const std::uint64_t share = 20 + random.below(81);
  const bool is_raised = random.below(2) == 0;
  SolidArrays start;
  start.vertices = shape.arrays.vertices;
  shape.arrays = with_facets(
      shape.arrays, std::move(start), [&](SolidArrays& arrays, const std::vector<Ring>& rings) {
        if (rings.size() > 1 || random.below(100) >= share) return add_facet(arrays, rings);
        const Ring& ring = rings[0];
        if (!is_raised) {
          for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
            add_facet(arrays, {{ring[0], ring[i], ring[i + 1]}});
          }
          return;
        }
        std::array<std::int64_t, 3> sum{};
        for (const Index v : ring) {
          for (int axis = 0; axis < 3; ++axis) {
            sum[static_cast<std::size_t>(axis)] +=
                static_cast<std::int64_t>(arrays.vertices[v][axis]);
          }
        }
        const auto count = static_cast<std::int64_t>(ring.size());
        const Index top = add_vertex(arrays, sum[0] / count, sum[1] / count,
                                     sum[2] / count + between(random, 0, 40));
        for (std::size_t i = 0; i < ring.size(); ++i) {
          add_facet(arrays, {{ring[i], ring[(i + 1) % ring.size()], top}});
        }
      });
  shape.name += is_raised ? "-raised" : "-cut";
}

/// Splits some edges at new vertices in their middle. Doubles all coordinates, so that they stay
/// whole.
void split_edges(Random& random, Shape& shape) {
  const std::uint64_t share = 5 + random.below(96);
  std::map<std::pair<Index, Index>, Index> middle;
  SolidArrays start;
  start.vertices = shape.arrays.vertices;
  for (Point& p : start.vertices) p = {2 * p.x, 2 * p.y, 2 * p.z};
  shape.arrays = with_facets(
      shape.arrays, std::move(start), [&](SolidArrays& arrays, std::vector<Ring> rings) {
        for (Ring& ring : rings) {
          Ring longer;
          for (std::size_t i = 0; i < ring.size(); ++i) {
            const Index a = ring[i];
            const Index b = ring[(i + 1) % ring.size()];
            longer.push_back(a);
            const auto key = a < b ? std::pair{a, b} : std::pair{b, a};
            const auto [found, is_new] = middle.try_emplace(key, kNone);
            if (is_new && random.below(100) < share) {
              const Point& p = arrays.vertices[a];
              const Point& q = arrays.vertices[b];
              arrays.vertices.push_back({(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2});
              found->second = static_cast<Index>(arrays.vertices.size() - 1);
            }
            if (found->second != kNone) longer.push_back(found->second);
          }
          ring = longer;
        }
        add_facet(arrays, rings);
      });
  shape.name += "-split";
}

/// Moves vertices to random points, without regard to the surface.
void scramble(Random& random, Shape& shape) {
  const std::int64_t reach = std::int64_t{4} << random.below(40);
  const std::uint64_t flat_axis = random.below(6);
  for (Point& p : shape.arrays.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      if (flat_axis == static_cast<std::uint64_t>(axis)) continue;
      p[axis] = static_cast<double>(between(random, -reach, reach));
    }
  }
  shape.name += "-scrambled";
}

/// Scales, turns and moves the points, to magnitudes below 2^52 at most.
void place(Random& random, std::vector<Point>& points) {
  double largest = 1;
  for (const Point& p : points) {
    largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }
  const auto room = static_cast<std::uint64_t>(std::ilogb(0x1p51 / largest));
  const auto scale = static_cast<double>(
      random.below(3) == 0 ? 1 + random.below(std::uint64_t{1} << random.below(room)) : 1);
  constexpr std::array<int, 6> kReach{0, 12, 24, 30, 40, 51};
  const int reach = kReach[random.below(kReach.size())];
  const std::int64_t span = std::int64_t{1} << reach;
  const auto first = static_cast<int>(random.below(3));
  std::array<double, 3> offset{};
  std::array<double, 3> sign{1, 1, 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    offset[axis] = reach == 0 ? 0 : static_cast<double>(between(random, -span, span));
    if (random.below(8) == 0) sign[axis] = -1;
  }
  for (Point& p : points) {
    const std::array<double, 3> old{p.x, p.y, p.z};
    for (int axis = 0; axis < 3; ++axis) {
      const auto from = static_cast<std::size_t>((axis + first) % 3);
      p[axis] = old[from] * scale * sign[from] + offset[from];
    }
  }
}

GridNumber random_number(Random& random, std::int64_t radix, int bits) {
  GridNumber number{static_cast<std::int64_t>(random.below(std::uint64_t{1} << bits)), 0};
  if (number.mantissa == 0) return number;
  number.exponent = static_cast<std::int32_t>(between(random, -9, 3));
  while (number.mantissa % radix == 0) number.mantissa /= radix;
  return number;
}

Lattice random_lattice(Random& random) {
  Lattice lattice;
  const std::uint64_t kind = random.below(8);
  lattice.kind = kind == 0   ? LatticeKind::float64
                 : kind == 1 ? LatticeKind::binary
                             : LatticeKind::decimal;
  if (kind == 0) return lattice;
  const std::int64_t radix = kind == 1 ? 2 : 10;
  const bool is_odd = random.below(3) == 0;
  const auto exponent = static_cast<std::int32_t>(between(random, -6, 0));
  for (GridNumber& step : lattice.step) {
    step = {1, exponent};
    if (is_odd) step = random_number(random, radix, static_cast<int>(random.below(20)));
    if (step.mantissa == 0) step = {1, exponent};
  }
  for (GridNumber& origin : lattice.origin) {
    const auto bits = static_cast<int>(random.below(random.below(8) == 0 ? 63 : 40));
    origin = random_number(random, radix, bits);
    if (!is_odd && origin.mantissa != 0 && random.below(4) != 0) origin.exponent = exponent;
    if (random.below(4) == 0) origin.mantissa = -origin.mantissa;
  }
  return lattice;
}

std::optional<OrientedBoundary> boundary_if_sound(SolidArrays arrays, const Lattice& lattice,
                                                  std::uint32_t srid) {
  auto solid = Solid::make(std::move(arrays), lattice, srid);
  if (!solid) return std::nullopt;
  auto boundary = OrientedBoundary::make(std::move(solid).value());
  if (!boundary) return std::nullopt;
  return std::move(boundary).value();
}

/// A random boundary on the lattice. A shape in which two vertices have come to one position is
/// replaced by another random one.
NamedBoundary on_lattice(Random& random, Index size, const Lattice& lattice, std::uint32_t srid) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    Shape shape = random_shape(random, size);
    if (random.below(4) == 0) cut_facets(random, shape);
    if (random.below(5) == 0) split_edges(random, shape);
    if (random.below(12) == 0) scramble(random, shape);
    if (random.below(2) == 0) place(random, shape.arrays.vertices);
    if (lattice.kind == LatticeKind::float64 && random.below(2) == 0) {
      for (Point& p : shape.arrays.vertices) p = {p.x / 3, p.y * 1e-9, p.z * 0.1};
    }
    auto boundary = boundary_if_sound(std::move(shape.arrays), lattice, srid);
    if (!boundary) continue;
    if (random.below(2) == 0) return {shape.name, std::move(*boundary)};
    return {shape.name + "-shuffled", shuffled(*boundary, random)};
  }
  return {"box", boundary_of(box().solid().arrays(), lattice, srid)};
}

}  // namespace

NamedBoundary random_solid(Random& random, Index size) {
  const Lattice lattice = random_lattice(random);
  const auto srid = static_cast<std::uint32_t>(random.below(3) == 0 ? random.next() : 7415);
  return on_lattice(random, size, lattice, srid);
}

std::vector<NamedBoundary> random_page(Random& random, Index count, Index size) {
  const Lattice lattice = random_lattice(random);
  std::vector<NamedBoundary> solids;
  for (Index i = 0; i < count; ++i) {
    if (i > 0 && random.below(3) == 0) {
      // A neighbour: an earlier solid moved beside itself, so that the two share columns.
      NamedBoundary copy = solids[random.below(solids.size())];
      const Solid& solid = copy.boundary.solid();
      SolidArrays arrays = solid.arrays();
      const double by = random.below(4) == 0 ? 0 : static_cast<double>(random.below(9000));
      for (Point& p : arrays.vertices) p.x += by;
      if (auto moved = boundary_if_sound(std::move(arrays), lattice, solid.srid())) {
        solids.push_back({copy.name + "-again", std::move(*moved)});
        continue;
      }
    }
    solids.push_back(on_lattice(random, random_size(random, size), lattice, 28992));
  }
  return solids;
}

Acceptance random_acceptance(Random& random) {
  Acceptance acceptance;
  if (random.below(8) == 0) {
    acceptance.tolerances.planarity_metres = static_cast<double>(random.below(1000)) / 7;
    acceptance.tolerances.planarity_degrees = static_cast<double>(random.below(90));
    acceptance.tolerances.snap_metres = static_cast<double>(random.below(3)) / 1000;
  }
  if (random.below(4) == 0) acceptance.proof = Proof::boundary;
  if (random.below(8) == 0) acceptance.rule_set = static_cast<std::uint16_t>(random.below(65536));
  return acceptance;
}

Index random_size(Random& random, Index largest) {
  const std::uint64_t kind = random.below(10000);
  const std::uint64_t most = kind < 7000   ? 24
                             : kind < 9500 ? 80
                             : kind < 9970 ? 600
                             : kind < 9997 ? 5000
                                           : 100000;
  return static_cast<Index>(4 + random.below(std::min<std::uint64_t>(most, largest)));
}

}  // namespace watertight::generated
