// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solids/defects.h"

#include <algorithm>
#include <array>

#include "tests/solids/builders.h"

namespace watertight::solids {
namespace {

/// A box with room for holes and cavities, 1000 to 9000 units wide; sizes are multiples of 20.
struct Block {
  Point low;
  Point high;
  /// The point at the given tenths of the sides.
  Point at(double x, double y, double z) const {
    return {low.x + (high.x - low.x) / 10 * x, low.y + (high.y - low.y) / 10 * y,
            low.z + (high.z - low.z) / 10 * z};
  }
  Shell shell() const { return box(low, high); }
  Shell cavity(const Point& from, const Point& to) const {
    return inside_out(box(at(from.x, from.y, from.z), at(to.x, to.y, to.z)));
  }
  /// The block with a tunnel between the given tenths of its sides.
  Shell tunnelled(double x0, double y0, double x1, double y1) const {
    return tunnelled_box(low, high, at(x0, y0, 0), at(x1, y1, 0));
  }
};

Block random_block(Random& random) {
  const auto coordinate = [&] { return 20 * random.within(-200, 200); };
  const auto length = [&] { return 20 * random.within(50, 450); };
  Block block;
  block.low = {coordinate(), coordinate(), coordinate()};
  block.high = {block.low.x + length(), block.low.y + length(), block.low.z + length()};
  return block;
}

/// A solid that is more complex than a box.
Shell random_base(Random& random) {
  const Block block = random_block(random);
  switch (random.below(4)) {
    case 0:
      return block.tunnelled(2, 3, 7, 6);
    case 1:
      return terrain(random, 3, 100);
    case 2:
      return gable_house(1200, 800, 500, 700);
    default:
      return block.shell();
  }
}

Shell::iterator random_facet(Shell& shell, Random& random) {
  return shell.begin() + static_cast<std::ptrdiff_t>(random.below(shell.size()));
}

Defect missing_facet(Random& random) {
  Shell shell = random_base(random);
  shell.erase(random_facet(shell, random));
  return {"a facet is missing", {shell}, {302}, 302};
}

Defect flipped_facet(Random& random) {
  Shell shell = random_base(random);
  const auto facet = random_facet(shell, random);
  *facet = turned_over(*facet);
  return {"a facet is turned over", {shell}, {307}, 307};
}

Defect repeated_point(Random& random) {
  Shell shell = random_base(random);
  Facet& facet = *random_facet(shell, random);
  Ring& ring = facet[random.below(facet.size())];
  const auto place = static_cast<std::ptrdiff_t>(random.below(ring.size()));
  ring.insert(ring.begin() + place, ring[static_cast<std::size_t>(place)]);
  return {"a ring has a point twice in a row", {shell}, {102}, 102};
}

Defect two_point_hole(Random& random) {
  const Block block = random_block(random);
  Shell shell = block.shell();
  shell[1].push_back({block.at(2, 2, 10), block.at(7, 5, 10)});
  return {"an interior ring has two points", {shell}, {101}, 101};
}

Defect bow_tie(Random& random) {
  Shell shell = random_block(random).shell();
  Ring& ring = (*random_facet(shell, random))[0];
  const std::size_t place = random.below(ring.size());
  std::swap(ring[place], ring[(place + 1) % ring.size()]);
  return {"a ring crosses itself", {shell}, {104, 302}, 104};
}

/// A hole has a corner at a corner of the block, and the exterior ring runs around the hole too.
Defect touching_ring(Random& random) {
  const Block block = random_block(random);
  Shell shell = block.shell();
  const Point corner = block.at(0, 0, 10);
  const Point a = block.at(6, 3, 10), b = block.at(3, 6, 10), apex = block.at(5, 5, 4);
  Ring& top = shell[1][0];
  const auto place = std::find(top.begin(), top.end(), corner);
  top.insert(place, {corner, b, a});
  shell = join(shell, inside_out({{{corner, a, apex}}, {{a, b, apex}}, {{b, corner, apex}}}));
  for (std::size_t i = shell.size() - 3; i < shell.size(); ++i) shell[i] = turned_over(shell[i]);
  return {"a ring touches itself in a vertex", {shell}, {104}, 104};
}

Defect outside_hole(Random& random) {
  Shell shell = random_block(random).tunnelled(12, 3, 15, 6);
  return {"an interior ring lies outside", {shell}, {206}, 206};
}

Defect nested_hole(Random& random) {
  const Block block = random_block(random);
  Shell shell = block.tunnelled(2, 2, 8, 8);
  Shell inner = block.tunnelled(4, 3, 6, 6);
  shell[0].push_back(inner[0][1]);
  shell[1].push_back(inner[1][1]);
  shell.insert(shell.end(), inner.begin() + 6, inner.end());
  return {"interior rings are nested", {shell}, {207}, 207};
}

Defect same_turn_hole(Random& random) {
  Shell shell = random_block(random).tunnelled(2, 3, 7, 6);
  shell[0][1] = reversed(shell[0][1]);
  shell[1][1] = reversed(shell[1][1]);
  for (std::size_t i = 6; i < shell.size(); ++i) shell[i] = turned_over(shell[i]);
  return {"an interior ring turns as the exterior one", {shell}, {208}, 208};
}

Defect doubled_hole(Random& random) {
  Shell shell = random_block(random).tunnelled(2, 3, 7, 6);
  shell[1].push_back(shell[1][1]);
  return {"an interior ring is there twice", {shell}, {202, 303}, 202};
}

/// A pit has a rim that touches the exterior ring in two opposite corners.
Defect cut_facet(Random& random) {
  const Block block = random_block(random);
  Shell shell = block.shell();
  const Ring rim{block.at(0, 0, 10), block.at(6, 4, 10), block.at(10, 10, 10), block.at(4, 6, 10)};
  shell[1].push_back(reversed(rim));
  const Point bottom = block.at(5, 5, 5);
  for (std::size_t i = 0; i < 4; ++i) shell.push_back({{rim[i], rim[(i + 1) % 4], bottom}});
  return {"rings cut the interior of a facet", {shell}, {205}, 205};
}

Defect bent_facet(Random& random) {
  Block block = random_block(random);
  Shell shell = block.shell();
  const Point corner = block.high;
  const double lift = 200 + 20 * random.within(0, 10);  // the lift in millimetres
  for (Facet& facet : shell) {
    for (Point& p : facet[0]) {
      if (p == corner) p.z += lift;
    }
  }
  return {"a vertex is off its facet's plane", {shell}, {203}, 203, true};
}

/// A facet has a ridge of 8 mm on a strip of 20 mm: it is within 10 mm of its plane, but steep.
Defect folded_facet(Random& random) {
  const double length = 20 * random.within(50, 450);
  const Ring profile{{0, 0, 0}, {20, 0, 0}, {20, 0, 1000}, {10, 0, 1008}, {0, 0, 1000}};
  Ring far;
  for (const Point& p : profile) far.push_back({p.x, length, p.z});
  Shell shell{{profile}, {reversed(far)}};
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{4}}) {
    const std::size_t j = (i + 1) % 5;
    shell.push_back({{profile[j], profile[i], far[i], far[j]}});
  }
  shell.push_back({{profile[4], profile[3], profile[2], far[2], far[3], far[4]}});
  return {"a facet is folded within the tolerance", {shell}, {204}, 204, true};
}

Defect too_few_facets(Random& random) {
  Shell shell = tetrahedron({0, 0, 0}, {random.within(1, 99), 0, 0}, {0, random.within(1, 99), 0},
                            {0, 0, random.within(1, 99)});
  shell.erase(random_facet(shell, random));
  return {"three facets", {shell}, {301, 302}, 301};
}

Defect extra_vertex(Random& random) {
  Shell shell = random_base(random);
  for (Facet& facet : shell) {
    for (Ring& ring : facet) {
      for (Point& p : ring) p = {2 * p.x, 2 * p.y, 2 * p.z};
    }
  }
  Facet& facet = *random_facet(shell, random);
  Ring& ring = facet[random.below(facet.size())];
  const std::size_t i = random.below(ring.size());
  const Point a = ring[i];
  const Point b = ring[(i + 1) % ring.size()];
  ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1,
              {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2});
  return {"a vertex on one side of an edge only", {shell}, {302}, 302};
}

Defect edge_of_four(Random& random) {
  const Block block = random_block(random);
  const double height = 20 * random.within(1, 99);
  const Shell second = box({block.high.x, block.high.y, block.low.z},
                           {block.high.x + height, block.high.y + height, block.high.z});
  return {"two boxes touch along an edge", {join(block.shell(), second)}, {303}, 303};
}

Defect pinched_vertex(Random& random) {
  const Block block = random_block(random);
  const Point& p = block.high;
  const double size = 20 * random.within(1, 99);
  return {"two boxes touch in a vertex",
          {join(block.shell(), box(p, {p.x + size, p.y + size, p.z + size}))},
          {303},
          303};
}

Defect inner_wall(Random& random) {
  std::vector<bool> filled(8, false);
  filled[0] = filled[1] = true;
  Shell shell = voxels(filled, 2, 20 * random.within(1, 99));
  const double size = shell[0][0][2].x;
  shell.push_back({{{0, 0, size}, {size, 0, size}, {size, size, size}, {0, size, size}}});
  return {"a wall divides the inside", {shell}, {303}, 303};
}

Defect doubled_facet(Random& random) {
  Shell shell = random_base(random);
  shell.push_back(*random_facet(shell, random));
  return {"a facet is there twice", {shell}, {303, 306}, 303};
}

Defect floating_part(Random& random) {
  const Block block = random_block(random);
  const double gap = 20 * random.within(1, 99);
  const Shell part = box({block.high.x + gap, block.low.y, block.low.z},
                         {block.high.x + 2 * gap, block.low.y + gap, block.low.z + gap});
  return {"a part floats beside the shell", {join(block.shell(), part)}, {305}, 305};
}

Defect pierced_floor(Random& random) {
  Shell shell = terrain(random, 3, 100);
  const Point top = shell[0][0][2];  // the vertex (1, 1) of the grid, which is not on the rim
  const double depth = random.within(1, 300);
  for (Facet& facet : shell) {
    for (Point& p : facet[0]) {
      if (p == top) p.z = -depth;
    }
  }
  return {"a vertex went through the opposite facet", {shell}, {306}, 306};
}

Defect dent_on_floor(Random& random) {
  Shell shell = terrain(random, 3, 100);
  const Point top = shell[0][0][2];
  for (Facet& facet : shell) {
    for (Point& p : facet[0]) {
      if (p == top) p.z = 0;
    }
  }
  return {"the tip of a dent lies on the opposite facet", {shell}, {306}, 306};
}

Defect crossing_cavity(Random& random) {
  const Block block = random_block(random);
  return {"a cavity breaks through the wall",
          {block.shell(), block.cavity({7, 3, 3}, {12, 6, 6})},
          {401},
          401};
}

Defect cavity_at_wall(Random& random) {
  const Block block = random_block(random);
  return {"a cavity shares part of a wall",
          {block.shell(), block.cavity({7, 3, 3}, {10, 6, 6})},
          {401},
          401};
}

Defect nested_cavity(Random& random) {
  const Block block = random_block(random);
  return {"a cavity lies in a cavity",
          {block.shell(), block.cavity({1, 1, 1}, {9, 9, 9}), block.cavity({3, 3, 3}, {6, 6, 6})},
          {401},
          401};
}

Defect doubled_cavity(Random& random) {
  const Block block = random_block(random);
  const Shell cavity = block.cavity({3, 3, 3}, {6, 6, 6});
  return {"a cavity is there twice", {block.shell(), cavity, cavity}, {402}, 402};
}

Defect outer_cavity(Random& random) {
  const Block block = random_block(random);
  return {
      "a cavity lies outside", {block.shell(), block.cavity({12, 3, 3}, {16, 6, 6})}, {403}, 403};
}

/// A bipyramid touches all four walls with its middle square, and the walls are cut there: the
/// interior is divided into a room above and one below.
Defect divided_interior(Random& random) {
  const Block block = random_block(random);
  const Ring middle{block.at(0, 0, 5), block.at(10, 0, 5), block.at(10, 10, 5), block.at(0, 10, 5)};
  const Shell low = box(block.low, block.at(10, 10, 5));
  const Shell high = box(block.at(0, 0, 5), block.high);
  Shell outer{low[0], high[1]};
  outer.insert(outer.end(), low.begin() + 2, low.end());
  outer.insert(outer.end(), high.begin() + 2, high.end());
  const Shell cavity = inside_out(bipyramid(middle, block.at(5, 5, 7), block.at(5, 5, 3)));
  Defect defect{"a cavity divides the interior", {outer, cavity}, {404}, 404};
  defect.needs_tetrahedra = true;
  return defect;
}

Defect inside_out_shell(Random& random) {
  return {"the exterior shell is inside out", {inside_out(random_base(random))}, {405}, 405};
}

Defect outward_cavity(Random& random) {
  const Block block = random_block(random);
  return {"a cavity turns outward",
          {block.shell(), inside_out(block.cavity({3, 3, 3}, {6, 6, 6}))},
          {405},
          405};
}

Defect empty_solid(Random&) { return {"no facets", {Shell{}}, {902}, 902}; }

constexpr std::array kMakers{missing_facet,    flipped_facet,  repeated_point,  two_point_hole,
                             bow_tie,          touching_ring,  outside_hole,    nested_hole,
                             same_turn_hole,   doubled_hole,   cut_facet,       bent_facet,
                             folded_facet,     too_few_facets, extra_vertex,    edge_of_four,
                             pinched_vertex,   inner_wall,     doubled_facet,   floating_part,
                             pierced_floor,    dent_on_floor,  crossing_cavity, cavity_at_wall,
                             nested_cavity,    doubled_cavity, outer_cavity,    divided_interior,
                             inside_out_shell, outward_cavity, empty_solid};

}  // namespace

std::span<const DefectMaker> defect_makers() {
  static constexpr std::array<DefectMaker, kMakers.size()> kList = [] {
    std::array<DefectMaker, kMakers.size()> list{};
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = kMakers[i];
    return list;
  }();
  return kList;
}

}  // namespace watertight::solids
