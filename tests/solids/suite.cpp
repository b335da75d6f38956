// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solids/suite.h"

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <iterator>

#include "tests/solids/builders.h"
#include "tests/solids/touching_rings.h"

namespace watertight::solids {
namespace {

SuiteCase of(std::string name, const Shape& shape, std::set<int> errors = {},
             std::set<int> warnings = {}, Ask ask = Ask::rung_zero) {
  return {std::move(name), solid_of(shape, millimetres()), std::move(errors), std::move(warnings),
          ask};
}

Shell cube(double from, double to) { return box({from, from, from}, {to, to, to}); }

Shell cavity(const Point& low, const Point& high) { return inside_out(box(low, high)); }

/// A room with thick walls, open above: its rim is one facet with a hole.
Shell cup(const Point& low, const Point& high, double wall) {
  Shell shell = box(low, high);
  const Shell inside = inside_out(
      box({low.x + wall, low.y + wall, low.z + wall}, {high.x - wall, high.y - wall, high.z}));
  shell[1].push_back(inside[1][0]);
  shell.push_back(inside[0]);
  shell.insert(shell.end(), inside.begin() + 2, inside.end());
  return shell;
}

/// A square whose opposite corners are at two heights, as on the saddle x y.
Ring saddle(double size, double low, double high) {
  return {{0, 0, low}, {size, 0, high}, {size, size, low}, {0, size, high}};
}

std::string number_text(const GridNumber& number) {
  std::string text = std::to_string(number.mantissa);
  if (number.exponent != 0) text.append("e").append(std::to_string(number.exponent));
  return text;
}

std::string triple_text(const std::array<GridNumber, 3>& numbers) {
  return std::string(1, '[') + number_text(numbers[0]) + "," + number_text(numbers[1]) + "," +
         number_text(numbers[2]) + "]";
}

}  // namespace

std::vector<SuiteCase> shell_cases() {
  const Shell outer = cube(0, 20000);
  const Shell room = cavity({4000, 4000, 4000}, {16000, 16000, 16000});
  const Shell island = box({8000, 8000, 8000}, {12000, 12000, 12000});
  const Shell far = box({30000, 0, 0}, {40000, 10000, 10000});
  const double half = 10000;
  std::vector<SuiteCase> cases;
  cases.push_back(of("sealed-pocket",
                     {outer, inside_out(cup({4000, 4000, 4000}, {16000, 16000, 12000}, 2000)),
                      cavity({4000, 4000, 12000}, {16000, 16000, 14000})},
                     {401}));
  cases.push_back(of("body-in-cavity", {outer, room, island}, {401, 405}));
  cases.push_back(of("cavity-in-cavity", {outer, room, inside_out(island)}, {401}));
  cases.push_back(of("body-in-cavity-one-shell", {join(join(outer, room), island)}, {305}));
  cases.push_back(of("body-in-cavity-two-shells", {join(outer, island), room}, {305}));
  cases.push_back(of("two-bodies-one-shell", {join(outer, far)}, {305}));
  cases.push_back(of("two-bodies-two-shells", {outer, far}, {403, 405}));
  cases.push_back(of("two-bodies-second-turned", {outer, inside_out(far)}, {403}));
  cases.push_back(of("cavity", {outer, room}));
  cases.push_back(of("cavity-in-exterior-shell", {join(outer, room)}, {305}));
  cases.push_back(of("inside-out", {inside_out(outer)}, {405}));
  cases.push_back(of("cavity-outward", {outer, inside_out(room)}, {405}));
  cases.push_back(of("all-inside-out", {inside_out(outer), inside_out(room)}, {405}));
  cases.push_back(of("cavity-twice", {outer, room, room}, {402}));
  cases.push_back(of("cavity-is-exterior", {outer, inside_out(outer)}, {402}));
  const Shell at_vertex = inside_out(
      tetrahedron({0, 0, 0}, {half, 1000, 1000}, {1000, half, 1000}, {1000, 1000, half}));
  cases.push_back(of("cavity-touches-vertex", {outer, at_vertex}, {}, {}, Ask::engines));
  const Shell along_edge =
      inside_out(tetrahedron({0, 0, 0}, {half, 5000, half}, {5000, half, half}, {0, 0, 20000}));
  cases.push_back(of("cavity-touches-edge", {outer, along_edge}, {}, {}, Ask::engines));
  const Shell tip_on_wall = inside_out(
      pyramid({{half, 5000, half}, {15000, half, half}, {half, 15000, half}}, {half, half, 20000}));
  cases.push_back(of("cavity-touches-wall-in-a-point", {outer, tip_on_wall}, {}, {}, Ask::engines));
  cases.push_back(
      of("cavity-shares-face", {outer, cavity({4000, 4000, 4000}, {8000, 8000, 20000})}, {401}));
  const Shell low = cavity({4000, 4000, 4000}, {8000, 8000, 8000});
  cases.push_back(of("cavities-touch-in-vertex",
                     {outer, low, cavity({8000, 8000, 8000}, {12000, 12000, 12000})}));
  cases.push_back(of("cavities-touch-along-edge",
                     {outer, low, cavity({8000, 8000, 4000}, {12000, 12000, 8000})}));
  cases.push_back(of("cavities-share-face",
                     {outer, low, cavity({8000, 4000, 4000}, {12000, 8000, 8000})}, {401}));
  cases.push_back(
      of("cavities-cross", {outer, low, cavity({6000, 6000, 6000}, {12000, 12000, 12000})}, {401}));
  const Ring middle{{0, 0, half}, {20000, 0, half}, {20000, 20000, half}, {0, 20000, half}};
  cases.push_back(
      of("cavity-divides-the-interior",
         {outer, inside_out(bipyramid(middle, {half, half, 14000}, {half, half, 6000}))}, {404}, {},
         Ask::engines));
  cases.push_back(of("bodies-touch-in-vertex",
                     {join(outer, box({20000, 20000, 20000}, {25000, 25000, 25000}))}, {303}));
  cases.push_back(of("bodies-touch-along-edge",
                     {join(outer, box({20000, 20000, 0}, {25000, 25000, 20000}))}, {303}));
  cases.push_back(of("bodies-share-face", {join(outer, box({20000, 0, 0}, {40000, 20000, 20000}))},
                     {303, 306}));
  Shell twice = outer;
  twice.push_back(outer[3]);
  cases.push_back(of("facet-twice", {twice}, {303, 306}));
  cases.push_back(of("all-facets-twice", {join(outer, outer)}, {303, 306}));
  Shell back_to_back = outer;
  back_to_back.push_back(turned_over(outer[3]));
  cases.push_back(of("facet-twice-back-to-back", {back_to_back}, {303, 306}));
  return cases;
}

std::vector<SuiteCase> ring_cases() {
  struct Pit {
    std::string name;
    Ring rim;  // the rim of the pit, counter-clockwise in the top z = 20
    std::set<int> errors;
  };
  const std::vector<Pit> pits{
      {"free", {{6, 6, 20}, {14, 6, 20}, {10, 14, 20}}, {}},
      {"vertex-at-vertex", {{0, 0, 20}, {14, 6, 20}, {6, 14, 20}}, {}},
      {"vertices-at-two-vertices", {{0, 0, 20}, {14, 6, 20}, {20, 20, 20}, {6, 14, 20}}, {205}},
      {"vertex-in-edge", {{10, 0, 20}, {14, 8, 20}, {6, 8, 20}}, {302}},
      {"edge-along-edge", {{6, 0, 20}, {14, 0, 20}, {10, 8, 20}}, {201, 306}},
  };
  std::vector<SuiteCase> cases;
  Random random(7);
  for (const Pit& pit : pits) {
    Shell shell = box({0, 0, 0}, {20, 20, 20});
    shell[1].push_back(reversed(pit.rim));
    const Point bottom{10, 8, 10};
    for (std::size_t i = 0; i < pit.rim.size(); ++i) {
      shell.push_back({{pit.rim[i], pit.rim[(i + 1) % pit.rim.size()], bottom}});
    }
    const Solid solid = solid_of({shell}, millimetres());
    const Ask ask = pit.errors.empty() ? Ask::engines : Ask::rung_zero;
    cases.push_back({"pit-" + pit.name, solid, pit.errors, {}, ask});
    for (int image = 1; image <= 3; ++image) {
      const AffineMap map = image == 1 ? unimodular_map(random, 40) : general_map(random, 40);
      cases.push_back({"pit-" + pit.name + "-image-" + std::to_string(image),
                       mapped(solid, map),
                       pit.errors,
                       {},
                       ask});
    }
  }
  for (const TouchingRings& touching : touching_rings()) {
    const Ask ask = touching.errors.empty() ? Ask::engines : Ask::rung_zero;
    cases.push_back(of(touching.name, touching.shape, touching.errors, {}, ask));
  }
  return cases;
}

std::vector<SuiteCase> surface_cases() {
  std::vector<SuiteCase> cases;
  cases.push_back(of(
      "torus", {tunnelled_box({0, 0, 0}, {9000, 9000, 5000}, {3000, 3000, 0}, {6000, 6000, 0})}));
  Shell many = pierced_box(20);
  for (Facet& facet : many) {
    for (Ring& ring : facet) {
      for (Point& p : ring) p = {1000 * p.x, 1000 * p.y, 1000 * p.z};
    }
  }
  cases.push_back(of("genus-20", {many}));
  cases.push_back(of("schoenhardt", {schoenhardt()}, {}, {}, Ask::engines));
  for (int n = 1; n <= 5; ++n) {
    cases.push_back(of("chazelle-" + std::to_string(n), {chazelle(n)}, {}, {}, Ask::engines));
  }
  cases.push_back(of("chazelle-20", {chazelle(20)}, {}, {}, Ask::boundary));
  cases.push_back(of("moebius-band", {moebius_band()}, {300, 302}));
  cases.push_back(of("klein-bottle", {klein_bottle()}, {300, 306}));
  Random random(3);
  for (int i = 0; i < 4; ++i) {
    cases.push_back(
        of("dent-tip-on-floor-" + std::to_string(i), {dented_block(random, Tip::on_floor)}, {306}));
    cases.push_back(of("dent-tip-above-floor-" + std::to_string(i),
                       {dented_block(random, Tip::above_floor)}, {}, {}, Ask::engines));
  }
  Shell slab{{reversed(saddle(10000, 0, 5))}, {saddle(10000, 2, 7)}};
  const Ring low = saddle(10000, 0, 5), high = saddle(10000, 2, 7);
  for (std::size_t i = 0; i < 4; ++i) {
    slab.push_back({{low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]}});
  }
  cases.push_back(of("slab-depends-on-diagonal", {slab}, {}, {804}, Ask::engines));
  return cases;
}

std::vector<SuiteCase> number_cases() {
  std::vector<SuiteCase> cases;
  Lattice fine;
  fine.step.fill(GridNumber{1, -4});
  cases.push_back({"half-millimetre-cube", solid_of({cube(0, 5)}, fine), {}, {801}});
  Lattice degrees;
  degrees.step = {GridNumber{1, -7}, GridNumber{1, -7}, GridNumber{1, -2}};
  degrees.origin = {GridNumber{43, -1}, GridNumber{52, 0}, GridNumber{0, 0}};
  cases.push_back(
      {"building-in-degrees", solid_of({gable_house(1400, 800, 300, 500)}, degrees, 4979)});
  const Point d{3999999999.0, 2999999999.0, 1999999999.0};
  const auto along = [&](const Point& p) { return Point{p.x + d.x, p.y + d.y, p.z + d.z}; };
  const Point a{0, 0, 0}, b{1000, 0, 0}, c{0, 1000, 0};
  cases.push_back(of("long-thin-planar",
                     {{{{a, c, b}},
                       {{along(a), along(b), along(c)}},
                       {{a, b, along(b), along(a)}},
                       {{b, c, along(c), along(b)}},
                       {{c, a, along(a), along(c)}}}},
                     {}, {}, Ask::engines));
  const double huge = 4503599627370496.0;  // 2^52
  cases.push_back(of("three-units-near-2-52", {cube(huge - 3001, huge - 1)}));
  cases.push_back(of("box-of-2-52", {cube(0, huge)}));
  // The tip of a notch is one unit from the opposite wall, or lies on it.
  for (const double tip : {1.0, 0.0}) {
    const Ring outline{{0, 0, 0}, {huge, 0, 0}, {huge, huge, 0}, {huge / 2, tip, 0}, {0, huge, 0}};
    const bool is_open = tip > 0;
    cases.push_back({is_open ? "notch-one-unit-from-wall" : "notch-on-wall",
                     solid_of({prism(outline, 0, huge)}, fine),
                     is_open ? std::set<int>{} : std::set<int>{104, 306},
                     {},
                     is_open ? Ask::engines : Ask::rung_zero});
  }
  Lattice doubles;
  doubles.kind = LatticeKind::float64;
  const Ring notched{{0, 0, 0}, {2e6, 0, 0}, {2e6, 1e6, 0}, {1e-11, 5e5, 0}, {0, 1e6, 0}};
  cases.push_back(
      {"notch-of-1e-11", solid_of({prism(notched, 0, 100)}, doubles), {}, {}, Ask::engines});
  SolidArrays arrays = solid_of({cube(0, 1000)}).arrays();
  arrays.vertices.push_back({-1e16, 0, 0});
  cases.push_back({"unused-far-vertex", solid_of(std::move(arrays), doubles), {}, {802}});
  return cases;
}

std::vector<SuiteCase> suite() {
  std::vector<SuiteCase> all;
  for (auto* cases : {&shell_cases, &ring_cases, &surface_cases, &number_cases}) {
    std::vector<SuiteCase> list = cases();
    std::move(list.begin(), list.end(), std::back_inserter(all));
  }
  return all;
}

Shape dented_block(Random& random, Tip tip) {
  // The vectors u and v span the floor, the walls rise along w; all are integers, and right-handed.
  AffineMap map;
  do {
    map = general_map(random, 99);
  } while (map.determinant() <= 0);
  const auto at = [&](double u, double v, double w) {
    Point p;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& row = map.matrix[static_cast<std::size_t>(axis)];
      p[axis] = static_cast<double>(row[0]) * u + static_cast<double>(row[1]) * v +
                static_cast<double>(row[2]) * w +
                static_cast<double>(map.shift[static_cast<std::size_t>(axis)]);
    }
    return p;
  };
  const double i = random.within(1, 9), j = random.within(1, 9);
  const Point apex = at(i, j, tip == Tip::on_floor ? 0 : 1);
  const Ring floor{at(0, 0, 0), at(10, 0, 0), at(10, 10, 0), at(0, 10, 0)};
  const Ring roof{at(0, 0, 10), at(10, 0, 10), at(10, 10, 10), at(0, 10, 10)};
  Shell shell{{reversed(floor)}};
  for (std::size_t side = 0; side < 4; ++side) {
    const std::size_t next = (side + 1) % 4;
    shell.push_back({{floor[side], floor[next], roof[next], roof[side]}});
    shell.push_back({{roof[side], roof[next], apex}});
  }
  return {shell};
}

std::string city_json_text(const Solid& solid) {
  std::string text = "{\"type\":\"CityJSON\",\"version\":\"2.0\",\n \"transform\":{\"scale\":";
  text += triple_text(solid.lattice().step) +
          ",\"translate\":" + triple_text(solid.lattice().origin) + "},\n";
  if (solid.srid() != 0) {
    text += " \"metadata\":{\"referenceSystem\":\"https://www.opengis.net/def/crs/EPSG/0/" +
            std::to_string(solid.srid()) + "\"},\n";
  }
  text +=
      " \"CityObjects\":{\"solid\":{\"type\":\"Building\",\"geometry\":[{\"type\":\"Solid\","
      "\"lod\":\"2\",\n  \"boundaries\":[";
  for (Index shell = 0; shell < solid.shell_count(); ++shell) {
    text += shell == 0 ? "[" : ",\n   [";
    for (Index f = solid.facets_of(shell).begin; f < solid.facets_of(shell).end; ++f) {
      text += f == solid.facets_of(shell).begin ? "[" : ",\n    [";
      for (Index r = solid.rings_of(f).begin; r < solid.rings_of(f).end; ++r) {
        text += r == solid.rings_of(f).begin ? "[" : ",[";
        for (const Index vertex : solid.ring(r)) {
          if (text.back() != '[') text += ',';
          text += std::to_string(vertex);
        }
        text += ']';
      }
      text += ']';
    }
    text += ']';
  }
  text += "]}]}},\n \"vertices\":[";
  for (const Point& p : solid.vertices()) {
    if (text.back() != '[') text += ',';
    char buffer[80];
    std::snprintf(buffer, sizeof buffer, "[%" PRId64 ",%" PRId64 ",%" PRId64 "]",
                  static_cast<std::int64_t>(p.x), static_cast<std::int64_t>(p.y),
                  static_cast<std::int64_t>(p.z));
    text += buffer;
  }
  return text + "]}\n";
}

}  // namespace watertight::solids
