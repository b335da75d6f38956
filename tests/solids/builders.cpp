// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solids/builders.h"

#include <algorithm>
#include <map>

#include "tests/generated/generated_solids.h"
#include "tessellate/facets.h"

namespace watertight::solids {
namespace {

Point lifted(const Point& p, double z) { return {p.x, p.y, z}; }

/// Appends walls between the outline at two heights; they face outward if the outline turns
/// counter-clockwise.
void add_walls(Shell& shell, const Ring& outline, double low, double high) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point& a = outline[i];
    const Point& b = outline[(i + 1) % outline.size()];
    shell.push_back({{lifted(a, low), lifted(b, low), lifted(b, high), lifted(a, high)}});
  }
}

Ring raised(const Ring& outline, double z) {
  Ring ring;
  for (const Point& p : outline) ring.push_back(lifted(p, z));
  return ring;
}

Ring rectangle(const Point& low, const Point& high) {
  return {{low.x, low.y, 0}, {high.x, low.y, 0}, {high.x, high.y, 0}, {low.x, high.y, 0}};
}

Shape shape_of(const OrientedBoundary& boundary) { return solids::shape_of(boundary.solid()); }

}  // namespace

Shell prism(const Ring& outline, double low, double high) {
  Shell shell{{reversed(raised(outline, low))}, {raised(outline, high)}};
  add_walls(shell, outline, low, high);
  return shell;
}

Shell box(const Point& low, const Point& high) {
  return prism(rectangle(low, high), low.z, high.z);
}

Shell pyramid(const Ring& base, const Point& apex) {
  Shell shell{{reversed(base)}};
  for (std::size_t i = 0; i < base.size(); ++i) {
    shell.push_back({{base[i], base[(i + 1) % base.size()], apex}});
  }
  return shell;
}

Shell bipyramid(const Ring& middle, const Point& top, const Point& bottom) {
  Shell shell;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    const Point& a = middle[i];
    const Point& b = middle[(i + 1) % middle.size()];
    shell.push_back({{a, b, top}});
    shell.push_back({{b, a, bottom}});
  }
  return shell;
}

Shell tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d) {
  return pyramid({a, b, c}, d);
}

Shell gable_house(double length, double width, double eaves, double ridge) {
  const double middle = width / 2;
  const Point a{0, 0, 0}, b{length, 0, 0}, c{length, width, 0}, d{0, width, 0};
  const Point e = lifted(a, eaves), f = lifted(b, eaves), g = lifted(c, eaves),
              h = lifted(d, eaves);
  const Point r{0, middle, ridge}, s{length, middle, ridge};
  return {{{a, d, c, b}},    {{a, b, f, e}}, {{b, c, g, s, f}}, {{c, d, h, g}},
          {{d, a, e, r, h}}, {{e, f, s, r}}, {{g, h, r, s}}};
}

Shell tunnelled_box(const Point& low, const Point& high, const Point& hole_low,
                    const Point& hole_high) {
  Shell shell = box(low, high);
  const Ring hole = rectangle(hole_low, hole_high);
  shell[0].push_back(raised(hole, low.z));
  shell[1].push_back(reversed(raised(hole, high.z)));
  Shell walls;
  add_walls(walls, hole, low.z, high.z);
  return join(shell, inside_out(walls));
}

Shell pierced_box(std::size_t holes) {
  const Point high{4.0 * static_cast<double>(holes) + 2, 6, 4};
  Shell shell = box({0, 0, 0}, high);
  for (std::size_t i = 0; i < holes; ++i) {
    const double x = 4.0 * static_cast<double>(i) + 2;
    const Ring hole = rectangle({x, 2, 0}, {x + 2, 4, 0});
    shell[0].push_back(raised(hole, 0));
    shell[1].push_back(reversed(raised(hole, 4)));
    Shell walls;
    add_walls(walls, hole, 0, 4);
    shell = join(shell, inside_out(walls));
  }
  return shell;
}

Shell terrain(Random& random, std::size_t size, double step) {
  std::vector<Point> grid;
  for (std::size_t i = 0; i <= size; ++i) {
    for (std::size_t j = 0; j <= size; ++j) {
      grid.push_back({static_cast<double>(i) * step, static_cast<double>(j) * step,
                      10 * step + random.within(0, static_cast<std::int64_t>(4 * step))});
    }
  }
  const auto at = [&](std::size_t i, std::size_t j) { return grid[i * (size + 1) + j]; };
  Shell shell;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      shell.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      shell.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  Ring rim;
  for (std::size_t i = 0; i < size; ++i) rim.push_back(at(i, 0));
  for (std::size_t j = 0; j < size; ++j) rim.push_back(at(size, j));
  for (std::size_t i = size; i > 0; --i) rim.push_back(at(i, size));
  for (std::size_t j = size; j > 0; --j) rim.push_back(at(0, j));
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Point& a = rim[i];
    const Point& b = rim[(i + 1) % rim.size()];
    shell.push_back({{lifted(a, 0), lifted(b, 0), b, a}});
  }
  shell.push_back({reversed(raised(rim, 0))});
  return shell;
}

Shell voxels(const std::vector<bool>& is_filled, std::size_t n, double size) {
  const auto filled = [&](std::size_t x, std::size_t y, std::size_t z) {
    // A number below 0 wraps around to a large one.
    return x < n && y < n && z < n && is_filled[(x * n + y) * n + z];
  };
  Shell shell;
  for (std::size_t x = 0; x < n; ++x) {
    for (std::size_t y = 0; y < n; ++y) {
      for (std::size_t z = 0; z < n; ++z) {
        if (!filled(x, y, z)) continue;
        const Point low{static_cast<double>(x) * size, static_cast<double>(y) * size,
                        static_cast<double>(z) * size};
        const Shell cube = box(low, {low.x + size, low.y + size, low.z + size});
        const bool is_hidden[6] = {filled(x, y, z - 1), filled(x, y, z + 1), filled(x, y - 1, z),
                                   filled(x + 1, y, z), filled(x, y + 1, z), filled(x - 1, y, z)};
        for (std::size_t side = 0; side < 6; ++side) {
          if (!is_hidden[side]) shell.push_back(cube[side]);
        }
      }
    }
  }
  return shell;
}

Shape triangulated(const Shape& shape) {
  const Solid solid = solid_of(shape);
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  Shape result(shape.size());
  for (std::size_t t = 0; t < facets.triangles.size(); ++t) {
    Ring ring;
    for (const Index vertex : facets.triangles[t]) ring.push_back(solid.vertices()[vertex]);
    result[solid.shell_of(facets.facet_of[t])].push_back({ring});
  }
  return result;
}

Shape with_moved_vertices(const Shape& shape, Random& random, std::size_t count,
                          std::int64_t reach) {
  SolidArrays arrays = solid_of(shape).arrays();
  if (arrays.vertices.empty()) return shape;
  for (std::size_t i = 0; i < count; ++i) {
    Point& p = arrays.vertices[random.below(arrays.vertices.size())];
    for (int axis = 0; axis < 3; ++axis) p[axis] += random.within(-reach, reach);
  }
  // Vertices that met in one point become one vertex, because shapes are written as points.
  return solids::shape_of(solid_of(std::move(arrays), Lattice{}));
}

namespace {

Ring star_outline(Random& random) {
  // The vertices are in rational directions from the centre: the polygon is star-shaped, so it is
  // simple.
  static constexpr std::array<std::array<int, 2>, 12> kDirections{{{12, 0},
                                                                   {10, 6},
                                                                   {6, 10},
                                                                   {0, 12},
                                                                   {-6, 10},
                                                                   {-10, 6},
                                                                   {-12, 0},
                                                                   {-10, -6},
                                                                   {-6, -10},
                                                                   {0, -12},
                                                                   {6, -10},
                                                                   {10, -6}}};
  Ring ring;
  for (const auto& direction : kDirections) {
    const double radius = random.within(3, 60);
    ring.push_back({direction[0] * radius, direction[1] * radius, 0});
  }
  return ring;
}

/// A polygon of two chains over the same stretch of x, one above the other, so it is simple.
Ring zigzag_outline(Random& random) {
  const std::size_t steps = 3 + random.below(6);
  Ring ring;
  for (std::size_t i = 0; i <= steps; ++i) {
    ring.push_back({static_cast<double>(i) * 1000, random.within(0, 3000), 0});
  }
  for (std::size_t i = steps + 1; i > 0; --i) {
    ring.push_back({static_cast<double>(i - 1) * 1000, random.within(3001, 9000), 0});
  }
  return ring;
}

Shell random_house(Random& random) {
  const double eaves = random.within(2, 9) * 100;
  return gable_house(random.within(5, 30) * 100, random.within(2, 12) * 200, eaves,
                     eaves + random.within(1, 8) * 100);
}

Shell random_stairs(Random& random) {
  Ring outline{{0, 0, 0}};
  const std::size_t steps = 2 + random.below(4);
  const auto width = static_cast<double>(steps) * 10;
  outline.push_back({width, 0, 0});
  for (std::size_t i = steps; i > 0; --i) {
    const double y = random.within(1, 4) + (static_cast<double>(steps - i)) * 5;
    outline.push_back({static_cast<double>(i) * 10, y + 5, 0});
    outline.push_back({static_cast<double>(i - 1) * 10, y + 5, 0});
  }
  return prism(outline, 0, random.within(1, 50));
}

Shell random_box(Random& random, std::int64_t size) {
  const Point low{random.within(0, size), random.within(0, size), random.within(0, size)};
  return box(low, {low.x + random.within(1, size), low.y + random.within(1, size),
                   low.z + random.within(1, size)});
}

Shape random_touching_cavity(Random& random) {
  const double s = random.within(4, 50) * 2;
  const Shell outer = box({0, 0, 0}, {2 * s, 2 * s, 2 * s});
  // The cavity has a vertex at a corner, an edge along an edge, or a tip on a wall of the box.
  switch (random.below(3)) {
    case 0:
      return {outer, inside_out(tetrahedron({0, 0, 0}, {s, 1, 1}, {1, s, 1}, {1, 1, s}))};
    case 1:
      return {outer, inside_out(tetrahedron({0, 0, 0}, {s, 1, s}, {1, s, s}, {0, 0, 2 * s}))};
    default:
      return {outer, inside_out(pyramid({{s / 2, s / 2, s}, {s, s / 2, s}, {s, s, s}},
                                        {s, s + 1, 2 * s}))};
  }
}

}  // namespace

Made random_valid(Random& random) {
  switch (random.below(13)) {
    case 0:
      return {"box", {random_box(random, 5000)}};
    case 1:
      return {"zigzag prism", {prism(zigzag_outline(random), 0, random.within(1, 9000))}};
    case 2:
      return {"terrain", {terrain(random, 2 + random.below(3), 100)}};
    case 3:
      return {"pierced block", shape_of(generated::pierced_block(1))};
    case 4:
      return {"box with cavities",
              shape_of(generated::box_with_cavities(static_cast<Index>(1 + random.below(3))))};
    case 5:
      return {"torus",
              shape_of(generated::torus(Index{4} << random.below(2), Index{4} << random.below(2)))};
    case 6:
      return {"gable house", {random_house(random)}};
    case 7:
      return {"stairs", {random_stairs(random)}};
    case 8:
      return {"schoenhardt", shape_of(generated::schoenhardt())};
    case 9:
      return {"pyramid", {pyramid(star_outline(random), {0, 0, random.within(1, 500)})}};
    case 10:
      return {"touching cavity", random_touching_cavity(random)};
    case 11:
      return {"grid cube", shape_of(generated::grid_cube(static_cast<Index>(1 + random.below(2))))};
    default:
      return {"star prism", {prism(star_outline(random), 0, random.within(1, 500))}};
  }
}

Made random_open(Random& random) {
  switch (random.below(5)) {
    case 0: {
      const std::size_t n = 2 + random.below(2);
      std::vector<bool> filled(n * n * n);
      const std::uint64_t share = 2 + random.below(6);
      for (std::size_t i = 0; i < filled.size(); ++i) filled[i] = random.below(8) < share;
      Shell shell = voxels(filled, n, 4);
      if (shell.empty()) shell = box({0, 0, 0}, {1, 1, 1});
      return {"voxels", {shell}};
    }
    case 1: {
      const std::size_t n = 3;
      std::vector<bool> filled(n * n * n);
      for (std::size_t i = 0; i < filled.size(); ++i) filled[i] = random.below(8) < 5;
      Shell shell = voxels(filled, n, 2);
      if (shell.empty()) shell = box({0, 0, 0}, {1, 1, 1});
      return {"moved voxels",
              with_moved_vertices(triangulated({shell}), random, 1 + random.below(3), 2)};
    }
    case 2: {
      Shell shell = random_box(random, 4);
      for (std::size_t i = random.below(2) + 1; i > 0; --i) {
        shell = join(shell, random_box(random, 4));
      }
      return {"joined boxes", {shell}};
    }
    case 3: {
      const Shape shape{terrain(random, 2 + random.below(2), 3)};
      return {"moved terrain",
              with_moved_vertices(triangulated(shape), random, 1 + random.below(4), 12)};
    }
    default: {
      const Made made = random_valid(random);
      return {"moved " + made.family,
              with_moved_vertices(triangulated(made.shape), random, 1 + random.below(3), 600)};
    }
  }
}

Made random_cavities(Random& random) {
  Shape shape{box({0, 0, 0}, {6, 6, 6})};
  for (std::size_t count = 1 + random.below(2); count > 0; --count) {
    Shell cavity = random_box(random, 4);
    if (random.below(3) == 0) {
      const Point a{random.within(0, 6), random.within(0, 6), random.within(0, 3)};
      const Ring base{a, {a.x + 2, a.y, a.z}, {a.x + 2, a.y + 2, a.z}, {a.x, a.y + 2, a.z}};
      cavity = bipyramid(base, {a.x + 1, a.y + 1, a.z + random.within(1, 3)},
                         {a.x + 1, a.y + 1, a.z - random.within(1, 3)});
    }
    shape.push_back(inside_out(cavity));
  }
  return {"cavities", shape};
}

}  // namespace watertight::solids
