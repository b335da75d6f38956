// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <limits>
#include <map>
#include <numeric>

#include "geometry/measures.h"
#include "geometry/valid_solid.h"
#include "tessellate/clip_z.h"
#include "tessellate/facets.h"

namespace watertight {
namespace {

using Catch::Approx;
using tessellate::HeightSide;

using Ring = std::vector<Point>;
using Facet = std::vector<Ring>;
using Shell = std::vector<Facet>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Solid solid_of(const std::vector<Shell>& shells) {
  SolidArrays arrays;
  std::map<Point, Index> number;
  for (const Shell& shell : shells) {
    for (const Facet& facet : shell) {
      for (const Ring& ring : facet) {
        for (const Point& p : ring) {
          const auto [found, is_new] =
              number.emplace(p, static_cast<Index>(arrays.vertices.size()));
          if (is_new) arrays.vertices.push_back(p);
          arrays.ring_vertices.push_back(found->second);
        }
        arrays.end_ring();
      }
      arrays.end_facet();
    }
    arrays.end_shell();
  }
  auto solid = Solid::make(std::move(arrays), Lattice{}, 7415);
  REQUIRE(solid);
  return *solid;
}

Ring at(Ring ring, double z) {
  for (Point& p : ring) p.z = z;
  return ring;
}

/// A prism over rings: the exterior one turns left, holes turn right.
Shell prism(const std::vector<Ring>& rings, double low, double high) {
  Facet floor;
  Facet roof;
  Shell shell;
  for (const Ring& ring : rings) {
    roof.push_back(at(ring, high));
    floor.push_back(at(ring, low));
    std::ranges::reverse(floor.back());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point a = ring[i];
      const Point b = ring[(i + 1) % ring.size()];
      shell.push_back({{{a.x, a.y, low}, {b.x, b.y, low}, {b.x, b.y, high}, {a.x, a.y, high}}});
    }
  }
  shell.push_back(std::move(floor));
  shell.push_back(std::move(roof));
  return shell;
}

/// What an outline in x and z, seen from the front, is when it is 5 deep.
Shell wall(const Ring& front) {
  Ring back = front;
  for (Point& p : back) p.y = 5;
  Shell shell;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const std::size_t k = (i + 1) % front.size();
    shell.push_back({{front[k], front[i], back[i], back[k]}});
  }
  shell.push_back({front});
  std::ranges::reverse(back);
  shell.push_back({std::move(back)});
  return shell;
}

Ring square(double x, double y, double side, bool is_hole = false) {
  Ring ring{{x, y, 0}, {x + side, y, 0}, {x + side, y + side, 0}, {x, y + side, 0}};
  if (is_hole) std::ranges::reverse(ring);
  return ring;
}

Shell inside_out(Shell shell) {
  for (Facet& facet : shell) {
    for (Ring& ring : facet) std::ranges::reverse(ring);
  }
  return shell;
}

double volume_of(const Solid& solid) {
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
  for (const auto state : facets.state) CHECK(state == tessellate::FacetState::triangulated);
  return geometry::measure(facets.divided_solid(solid), facets.triangles).volume;
}

/// The parts on one side; each edge of each must meet its opposite.
std::vector<Solid> parts_of(const Solid& solid, double height, HeightSide side) {
  auto parts = tessellate::clip_z(solid, height, side);
  INFO((parts ? std::string() : parts.error().message));
  REQUIRE(parts);
  for (const Solid& part : *parts) {
    const auto boundary = OrientedBoundary::make(part);
    INFO((boundary ? std::string() : boundary.error().message));
    CHECK(boundary);
    CHECK(part.srid() == solid.srid());
    CHECK(volume_of(part) > 0);
  }
  return *parts;
}

std::vector<double> volumes(const std::vector<Solid>& parts) {
  std::vector<double> volumes;
  for (const Solid& part : parts) volumes.push_back(volume_of(part));
  std::ranges::sort(volumes);
  return volumes;
}

double sum(const std::vector<double>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0);
}

/// What is below and above a height, which together are the solid.
std::pair<std::vector<Solid>, std::vector<Solid>> halves(const Solid& solid, double height) {
  auto below = parts_of(solid, height, HeightSide::below);
  auto above = parts_of(solid, height, HeightSide::above);
  CHECK(sum(volumes(below)) + sum(volumes(above)) == Approx(volume_of(solid)).epsilon(1e-7));
  return {std::move(below), std::move(above)};
}

TEST_CASE("a box is cut into two boxes") {
  const Solid box = solid_of({prism({square(0, 0, 4)}, 0, 10)});
  const auto [below, above] = halves(box, 3);
  CHECK(volumes(below) == std::vector<double>{48});
  CHECK(volumes(above) == std::vector<double>{112});
  CHECK(below.front().facet_count() == 6);
  CHECK(below.front().vertex_count() == 8);
  CHECK(above.front().facet_count() == 6);
}

TEST_CASE("nothing is cut where a solid is on one side, and its top and floor stay") {
  const Solid box = solid_of({prism({square(0, 0, 4)}, 0, 10)});
  for (const double height : {10.0, 11.0, kInfinity}) {
    const auto [below, above] = halves(box, height);
    CHECK(volumes(below) == std::vector<double>{160});
    CHECK(above.empty());
  }
  for (const double height : {0.0, -1.0, -kInfinity}) {
    const auto [below, above] = halves(box, height);
    CHECK(below.empty());
    CHECK(volumes(above) == std::vector<double>{160});
  }
}

TEST_CASE("a cut along a ridge, an eaves line or through an apex has no slivers") {
  const Ring base = square(0, 0, 6);
  const Point apex{3, 3, 9};
  Shell pyramid{{{at(base, 0)}}};
  std::ranges::reverse(pyramid.front().front());
  for (std::size_t i = 0; i < 4; ++i) pyramid.push_back({{base[i], base[(i + 1) % 4], apex}});
  CHECK(volumes(halves(solid_of({pyramid}), 9).first) == std::vector<double>{108});
  const auto [frustum, tip] = halves(solid_of({pyramid}), 3);
  CHECK(sum(volumes(tip)) == Approx(32));
  CHECK(frustum.front().facet_count() == 6);

  const Shell house{{{{0, 0, 0}, {0, 6, 0}, {9, 6, 0}, {9, 0, 0}}},
                    {{{0, 0, 0}, {9, 0, 0}, {9, 0, 4}, {0, 0, 4}}},
                    {{{9, 6, 0}, {0, 6, 0}, {0, 6, 4}, {9, 6, 4}}},
                    {{{0, 6, 0}, {0, 0, 0}, {0, 0, 4}, {0, 3, 6}, {0, 6, 4}}},
                    {{{9, 0, 0}, {9, 6, 0}, {9, 6, 4}, {9, 3, 6}, {9, 0, 4}}},
                    {{{0, 0, 4}, {9, 0, 4}, {9, 3, 6}, {0, 3, 6}}},
                    {{{0, 3, 6}, {9, 3, 6}, {9, 6, 4}, {0, 6, 4}}}};
  CHECK(volumes(halves(solid_of({house}), 6).first) == std::vector<double>{270});
  const auto [walls, roof] = halves(solid_of({house}), 4);
  CHECK(volumes(walls) == std::vector<double>{216});
  CHECK(walls.front().facet_count() == 6);
  CHECK(volumes(roof) == std::vector<double>{54});
  CHECK(roof.front().facet_count() == 5);
  CHECK(roof.front().vertex_count() == 6);
}

TEST_CASE("a cut separates towers, and joins them below") {
  const Ring u{{0, 0, 0}, {9, 0, 0}, {9, 0, 8}, {6, 0, 8},
               {6, 0, 2}, {3, 0, 2}, {3, 0, 6}, {0, 0, 6}};
  const Solid towers = solid_of({wall(u)});
  CHECK(volumes(halves(towers, 4).second) == std::vector<double>{30, 60});
  CHECK(volumes(halves(towers, 4).first) == std::vector<double>{150});
  CHECK(volumes(halves(towers, 2).second) == std::vector<double>{60, 90});
  CHECK(volumes(halves(towers, 2).first) == std::vector<double>{90});
  CHECK(volumes(halves(towers, 6).second) == std::vector<double>{30});
  CHECK(volumes(halves(towers, 1).second).size() == 1);
}

TEST_CASE("cavities stay, or open into the section") {
  const Solid hollow =
      solid_of({prism({square(0, 0, 9)}, 0, 10), inside_out(prism({square(3, 3, 3)}, 2, 5))});
  const auto [low, rest] = halves(hollow, 4);
  REQUIRE(low.size() == 1);
  CHECK(volumes(low) == std::vector<double>{81 * 4 - 9 * 2});
  CHECK(low.front().shell_count() == 1);
  const auto [most, top] = halves(hollow, 6);
  REQUIRE(most.size() == 1);
  CHECK(most.front().shell_count() == 2);
  CHECK(top.front().shell_count() == 1);
  // A cavity in one of two towers.
  const Ring u{{0, 0, 0}, {9, 0, 0}, {9, 0, 20}, {6, 0, 20},
               {6, 0, 2}, {3, 0, 2}, {3, 0, 20}, {0, 0, 20}};
  const Solid towers = solid_of({wall(u), inside_out(prism({square(7, 1, 1)}, 10, 12))});
  const auto two = halves(towers, 5).second;
  REQUIRE(two.size() == 2);
  CHECK(volumes(two) == std::vector<double>{3 * 5 * 15 - 2, 3 * 5 * 15});
  CHECK(two[0].shell_count() + two[1].shell_count() == 3);
}

TEST_CASE("sections have holes, islands in holes, and rings that touch") {
  const Solid shaft =
      solid_of({prism({square(0, 0, 9), square(1, 1, 3, true), square(4, 4, 4, true)}, 0, 10)});
  const auto [below, above] = halves(shaft, 5);
  REQUIRE(below.size() == 1);
  CHECK(volumes(below) == std::vector<double>{(81 - 9 - 16) * 5});
  CHECK(below.front().ring_count() == shaft.ring_count());
  CHECK(above.front().facet_count() == shaft.facet_count());
  // A tower in a court.
  Shell court = prism({square(0, 0, 9), square(1, 1, 7, true)}, 1, 10);
  court.erase(court.end() - 2);  // its floor is that of the base
  const Shell tower = prism({square(4, 4, 1)}, 1, 8);
  Shell base = prism({square(0, 0, 9)}, 0, 1);
  base.pop_back();
  for (const Facet& facet : court) base.push_back(facet);
  for (std::size_t i = 0; i < 4; ++i) base.push_back(tower[i]);
  base.push_back(tower.back());
  Ring hole = at(square(4, 4, 1), 1);
  std::ranges::reverse(hole);
  base.push_back({at(square(1, 1, 7), 1), hole});
  const Solid yard = solid_of({base});
  const double whole = 81 + 9 * (81 - 49) + 7;
  CHECK(volume_of(yard) == whole);
  CHECK(volumes(halves(yard, 4).second) == std::vector<double>{4, 6 * 32});
  CHECK(volumes(halves(yard, 4).first) == std::vector<double>{81 + 3 * 33});
}

TEST_CASE("facets that are cut into pieces, at heights of no round number") {
  // A comb whose walls have many teeth, cut through the teeth.
  Ring comb{{0, 0, 0}, {20, 0, 0}};
  for (int i = 10; i-- > 0;) {
    comb.push_back({2.0 * i + 2, 0, 9});
    comb.push_back({2.0 * i + 1, 0, 3});
    comb.push_back({2.0 * i, 0, 9});
  }
  comb.erase(std::unique(comb.begin(), comb.end()), comb.end());
  const Solid teeth = solid_of({wall(comb)});
  for (const double height : {3.0, 3.0001, 4.123456789, 7.77, 8.999}) {
    const auto [below, above] = halves(teeth, height);
    CHECK(below.size() == 1);
    CHECK(above.size() == 11);
  }
}

TEST_CASE("a section that is narrower than coordinates are fine is an error or nothing") {
  const Ring base = square(0, 0, 6);
  Shell needle{{{at(base, 0)}}};
  std::ranges::reverse(needle.front().front());
  for (std::size_t i = 0; i < 4; ++i) {
    needle.push_back({{base[i], base[(i + 1) % 4], {3, 3, 9}}});
  }
  const auto tip = tessellate::clip_z(solid_of({needle}), 9 - 1e-12, HeightSide::above);
  if (tip) {
    CHECK(tip->empty());
  } else {
    CHECK(tip.error().code == ErrorCode::malformed);
  }
  CHECK(tessellate::clip_z(solid_of({needle}), 9 - 1e-12, HeightSide::below));
}

}  // namespace
}  // namespace watertight
