// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <string>

#include "geometry/canonical_form.h"
#include "repair/summary_json.h"
#include "tests/solids/builders.h"
#include "tests/solids/defects.h"

namespace watertight::repair {
namespace {

using Outcome = Repaired::Outcome;
using solids::Shape;

RepairOptions everything(double weld_metres = 0) {
  RepairOptions options;
  options.remedies = {Remedy::rings, Remedy::orientation, Remedy::junctions,
                      Remedy::weld,  Remedy::facets,      Remedy::fill};
  options.weld_metres = weld_metres;
  options.certify.proof = Proof::boundary;
  return options;
}

std::uint64_t hash_of(const Solid& solid) {
  const auto boundary = OrientedBoundary::make(geometry::merge_equal_vertices(solid).solid);
  REQUIRE(boundary);
  return geometry::solid_hash(*boundary);
}

/// The repaired solid; requires that it was repaired with these remedies.
Solid repaired_with(const Shape& shape, const std::vector<Remedy>& remedies,
                    const RepairOptions& options = everything()) {
  const Repaired result = repair(solids::solid_of(shape, solids::millimetres()), nullptr, options);
  REQUIRE(result.outcome == Outcome::repaired);
  REQUIRE(result.after);
  REQUIRE(result.after->certified);
  CHECK(result.remedies == remedies);
  return result.after->certified->solid.solid();
}

Shape a_box() { return {solids::box({0, 0, 0}, {8000, 8000, 8000})}; }

TEST_CASE("a valid solid is not touched") {
  const Repaired result = repair(solids::solid_of(a_box()), nullptr, everything());
  CHECK(result.outcome == Outcome::valid_as_read);
  CHECK(!result.after);
  CHECK(!result.edits);
}

TEST_CASE("a repeated point and a spike go") {
  Shape shape = a_box();
  solids::Ring& ring = shape[0][0][0];
  ring.insert(ring.begin() + 1, ring[0]);
  ring.insert(ring.begin() + 2, {1000, 1000, 0});
  ring.insert(ring.begin() + 3, {2000, 1000, 0});  // a spike on the spike
  ring.insert(ring.begin() + 4, ring[2]);
  ring.insert(ring.begin() + 5, ring[0]);
  const std::uint64_t wanted = hash_of(solids::solid_of(a_box(), solids::millimetres()));
  for (std::size_t start = 0; start < ring.size(); ++start) {
    CHECK(hash_of(repaired_with(shape, {Remedy::rings})) == wanted);
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
  }
}

TEST_CASE("a facet without area and facets back to back go") {
  Shape shape = a_box();
  const solids::Facet facet = shape[0][2];
  shape[0].push_back({{facet[0][0], facet[0][1], facet[0][0]}});
  shape[0].push_back({{{0, 0, 0}, {4000, 4000, 4000}, {8000, 0, 0}}});
  shape[0].push_back(solids::turned_over(shape[0].back()));
  shape[0].push_back(facet);
  CHECK(hash_of(repaired_with(shape, {Remedy::rings})) ==
        hash_of(solids::solid_of(a_box(), solids::millimetres())));
}

TEST_CASE("turned facets are turned back, and a shell inside out is turned") {
  const std::uint64_t wanted = hash_of(solids::solid_of(a_box(), solids::millimetres()));
  for (unsigned chosen = 1; chosen < 64; ++chosen) {
    Shape shape = a_box();
    for (std::size_t i = 0; i < 6; ++i) {
      if ((chosen >> i & 1U) != 0) shape[0][i] = solids::turned_over(shape[0][i]);
    }
    CHECK(hash_of(repaired_with(shape, {Remedy::orientation})) == wanted);
  }
}

TEST_CASE("a cavity that looks outwards is turned, and so is an interior ring") {
  Shape shape = a_box();
  shape.push_back(solids::box({1000, 1000, 1000}, {2000, 2000, 2000}));
  repaired_with(shape, {Remedy::orientation});

  Shape tunnelled{
      solids::tunnelled_box({0, 0, 0}, {8000, 8000, 8000}, {2000, 2000, 0}, {4000, 4000, 8000})};
  const std::uint64_t wanted = hash_of(solids::solid_of(tunnelled, solids::millimetres()));
  tunnelled[0][0][1] = solids::reversed(tunnelled[0][0][1]);
  CHECK(hash_of(repaired_with(tunnelled, {Remedy::orientation})) == wanted);
}

TEST_CASE("a vertex in an edge of a neighbour is inserted there") {
  Shape shape = a_box();
  // The bottom has two more corners in an edge, in the order in which it runs.
  solids::Ring& ring = shape[0][0][0];
  const Point from = ring[0];
  const Point to = ring[1];
  const auto between = [&](double share) {
    return Point{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y),
                 from.z + share * (to.z - from.z)};
  };
  ring.insert(ring.begin() + 1, {between(0.25), between(0.5)});
  const Solid solid = repaired_with(shape, {Remedy::junctions});
  CHECK(solid.vertex_count() == 10);
}

TEST_CASE("vertices closer than the given distance become one, and no others") {
  Shape shape = a_box();
  for (Point& corner : shape[0][1][0]) {
    if (corner == Point{8000, 8000, 8000}) corner = {8000, 8000, 8004};
  }
  CHECK(repair(solids::solid_of(shape, solids::millimetres()), nullptr, everything()).outcome !=
        Outcome::valid_as_read);
  const Solid solid = repaired_with(shape, {Remedy::weld}, everything(0.005));
  CHECK(solid.vertex_count() == 8);
  RepairOptions careful = everything(0.003);
  std::erase(careful.remedies, Remedy::fill);
  std::erase(careful.remedies, Remedy::facets);
  CHECK(repair(solids::solid_of(shape, solids::millimetres()), nullptr, careful).outcome ==
        Outcome::not_repaired);
}

TEST_CASE("a vertex near an edge across is inserted there") {
  Shape shape = a_box();
  solids::Ring& ring = shape[0][0][0];
  ring.insert(ring.begin() + 1, Point{std::round((ring[0].x + ring[1].x) / 2),
                                      std::round((ring[0].y + ring[1].y) / 2), ring[0].z + 2});
  const Solid solid = repaired_with(shape, {Remedy::weld}, everything(0.003));
  CHECK(solid.vertex_count() == 9);
}

TEST_CASE("a facet that is not flat becomes its triangles, and no vertex moves") {
  Shape shape = a_box();
  for (solids::Facet& facet : shape[0]) {
    for (Point& corner : facet[0]) {
      if (corner == Point{8000, 8000, 8000}) corner = {8000, 8000, 8400};
    }
  }
  const Solid solid = repaired_with(shape, {Remedy::facets});
  CHECK(solid.vertex_count() == 8);
  CHECK(solid.facet_count() == 7);
}

TEST_CASE("each facet of random solids that is taken away comes back") {
  solids::Random random(20);
  std::size_t count = 0;
  for (int i = 0; i < 60; ++i) {
    const Shape shape = solids::random_valid(random).shape;
    const std::uint64_t wanted = hash_of(solids::solid_of(shape, solids::millimetres()));
    for (std::size_t shell = 0; shell < shape.size(); ++shell) {
      for (std::size_t facet = 0; facet < std::min<std::size_t>(shape[shell].size(), 12); ++facet) {
        Shape open = shape;
        open[shell].erase(open[shell].begin() + static_cast<std::ptrdiff_t>(facet));
        const Repaired result =
            repair(solids::solid_of(open, solids::millimetres()), nullptr, everything());
        REQUIRE(result.outcome == Outcome::repaired);
        CHECK(hash_of(result.after->certified->solid.solid()) == wanted);
        ++count;
      }
    }
  }
  CHECK(count > 300);
}

TEST_CASE("a hole in a facet that bends is filled by triangles") {
  Shape shape = a_box();
  for (solids::Facet& facet : shape[0]) {
    for (Point& corner : facet[0]) {
      if (corner == Point{8000, 8000, 8000}) corner = {8000, 8000, 8400};
    }
  }
  shape = solids::triangulated(shape);
  const std::size_t before = shape[0].size();
  std::erase_if(shape[0], [](const solids::Facet& facet) {
    return std::ranges::all_of(facet[0], [](const Point& p) { return p.z >= 8000; });
  });
  REQUIRE(shape[0].size() == before - 2);
  const Repaired result =
      repair(solids::solid_of(shape, solids::millimetres()), nullptr, everything());
  REQUIRE(result.outcome == Outcome::repaired);
  REQUIRE(result.holes.size() == 1);
  CHECK(result.holes[0].method == "delaunay");
  CHECK(result.holes[0].facets == 2);
}

TEST_CASE("a court without a floor gets one facet with a ring") {
  Shape shape{
      solids::tunnelled_box({0, 0, 0}, {8000, 8000, 8000}, {2000, 2000, 0}, {4000, 4000, 8000})};
  const std::uint64_t wanted = hash_of(solids::solid_of(shape, solids::millimetres()));
  shape[0].erase(shape[0].begin());
  const Repaired result =
      repair(solids::solid_of(shape, solids::millimetres()), nullptr, everything());
  REQUIRE(result.outcome == Outcome::repaired);
  REQUIRE(result.holes.size() == 1);
  CHECK(result.holes[0].loops == 2);
  CHECK(result.holes[0].method == "facet");
  CHECK(hash_of(result.after->certified->solid.solid()) == wanted);
}

/// A tower of three storeys without the walls of the one in the middle: two parts.
Shape cut_tower() {
  solids::Shell shell = solids::box({0, 0, 0}, {4000, 3000, 3000});
  shell.erase(shell.begin() + 1);  // the top
  solids::Shell upper = solids::box({0, 0, 6000}, {4000, 3000, 9000});
  upper.erase(upper.begin());  // the floor
  shell.insert(shell.end(), upper.begin(), upper.end());
  return {shell};
}

TEST_CASE("two parts of a shell are joined by a tube where caps leave two solids") {
  const Repaired result =
      repair(solids::solid_of(cut_tower(), solids::millimetres()), nullptr, everything());
  REQUIRE(result.outcome == Outcome::repaired);
  REQUIRE(result.holes.size() == 1);
  CHECK(result.holes[0].loops == 2);
  CHECK(result.holes[0].vertices == 8);
  CHECK(result.holes[0].facets == 8);
  REQUIRE(result.after->report.measures);
  CHECK(result.after->report.measures->volume == Catch::Approx(4.0 * 3.0 * 9.0));
}

TEST_CASE("rings without vertices in two parts of a shell are no trouble") {
  Shape shape = cut_tower();
  shape[0].push_back({{}, shape[0][0][0]});
  shape[0].push_back({{}, {}});
  for (const std::vector<Remedy>& remedies : {std::vector{Remedy::fill}, everything().remedies}) {
    RepairOptions options = everything();
    options.remedies = remedies;
    const Repaired result =
        repair(solids::solid_of(shape, solids::millimetres()), nullptr, options);
    CHECK(result.before.verdict == Verdict::invalid);
  }
}

TEST_CASE("a floor with hundreds of courts is one facet with as many rings") {
  constexpr std::size_t kCourts = 300;
  Shape shape{solids::pierced_box(kCourts)};
  const std::uint64_t wanted = hash_of(solids::solid_of(shape));
  shape[0].erase(shape[0].begin());
  const Repaired result = repair(solids::solid_of(shape), nullptr, everything());
  REQUIRE(result.outcome == Outcome::repaired);
  REQUIRE(result.holes.size() == 1);
  CHECK(result.holes[0].loops == kCourts + 1);
  CHECK(result.holes[0].method == "facet");
  CHECK(hash_of(result.after->certified->solid.solid()) == wanted);
}

/// A can without its lid, whose rim goes up and down; the edges of the rim are `count`.
solids::Shell open_can(std::size_t count) {
  std::vector<Point> low(count);
  std::vector<Point> high(count);
  const double radius = 50.0 * static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = 2 * 3.141592653589793 * static_cast<double>(i) / static_cast<double>(count);
    const double x = std::round(radius * std::cos(turn));
    const double y = std::round(radius * std::sin(turn));
    low[i] = {x, y, 0};
    high[i] = {x, y, std::round(radius * (0.5 + 0.05 * std::sin(7 * turn)))};
  }
  solids::Shell shell;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t j = (i + 1) % count;
    shell.push_back({{low[i], low[j], high[j]}});
    shell.push_back({{low[i], high[j], high[i]}});
  }
  shell.push_back({std::vector<Point>(low.rbegin(), low.rend())});
  return shell;
}

TEST_CASE("a wavy rim of very many edges is closed") {
#ifdef __SANITIZE_ADDRESS__
  constexpr std::size_t kEdges = 10'000;
#else
  constexpr std::size_t kEdges = 100'000;
#endif
  const Solid solid = solids::solid_of({open_can(kEdges)}, solids::millimetres());
  const Repaired result = repair(solid, nullptr, everything());
  REQUIRE(result.outcome == Outcome::repaired);
  REQUIRE(result.holes.size() == 1);
  CHECK(result.holes[0].vertices == kEdges);
  CHECK(result.holes[0].facets == kEdges - 2);
}

TEST_CASE("a solid whose mended form is not proven is undecided, with the reason") {
  RepairOptions options = everything();
  options.certify.proof = Proof::tetrahedralization;
  options.certify.ladder.last_rung = delaunay::Rung::delaunay;
  const Solid solid = solids::solid_of({open_can(40)}, solids::millimetres());
  const Repaired result = repair(solid, nullptr, options);
  CHECK(result.outcome == Outcome::not_repaired);
  CHECK(result.before.verdict == Verdict::invalid);
  CHECK(!result.undecided_reason.empty());
  const RepairSummary summary = summary_of(solid, result);
  CHECK(summary.is_undecided);
  CHECK(summary_json(summary).find("\"undecided_reason\":\"") != std::string::npos);
  options.certify.ladder.last_rung = delaunay::Rung::recovered;
  CHECK(repair(solid, nullptr, options).outcome == Outcome::repaired);
}

TEST_CASE("a strip with one side only stays as it is") {
  constexpr std::size_t kQuads = 12;
  solids::Shell strip;
  const auto at = [](std::size_t step, double side) {
    const double turn = 2 * 3.141592653589793 * static_cast<double>(step) / kQuads;
    const double radius = 5000 + side * 1000 * std::cos(turn / 2);
    return Point{std::round(radius * std::cos(turn)), std::round(radius * std::sin(turn)),
                 std::round(side * 1000 * std::sin(turn / 2))};
  };
  for (std::size_t i = 0; i < kQuads; ++i) {
    strip.push_back({{at(i, -1), at(i + 1, -1), at(i, 1)}});
    strip.push_back({{at(i, 1), at(i + 1, -1), at(i + 1, 1)}});
  }
  const Repaired result =
      repair(solids::solid_of({strip}, solids::millimetres()), nullptr, everything());
  CHECK(result.outcome == Outcome::not_repaired);
  CHECK(result.before.verdict == Verdict::invalid);
  CHECK(!result.edits);
}

TEST_CASE("a repair that is cancelled stops, and says that it was stopped") {
  Shape shape = a_box();
  shape[0].erase(shape[0].begin());
  const Solid solid = solids::solid_of(shape, solids::millimetres());
  RepairOptions options = everything();
  std::size_t polls = 0;
  options.certify.ladder.cancel = [&polls] {
    ++polls;
    return false;
  };
  REQUIRE(repair(solid, nullptr, options).outcome == Outcome::repaired);
  REQUIRE(polls > 0);
  const std::size_t all = polls;
  for (std::size_t most = 0; most < all; ++most) {
    polls = 0;
    options.certify.ladder.cancel = [&polls, most] { return ++polls > most; };
    const Repaired result = repair(solid, nullptr, options);
    INFO(most);
    if (result.outcome == Outcome::repaired) continue;
    CHECK(summary_of(solid, result).is_undecided);
  }
}

TEST_CASE("a court on sloping ground is filled together with its border") {
  Shape shape{
      solids::tunnelled_box({0, 0, 0}, {8000, 8000, 8000}, {2000, 2000, 0}, {4000, 4000, 8000})};
  shape[0].erase(shape[0].begin());
  // The ground falls off on one side, so that no plane holds all corners below.
  for (solids::Facet& facet : shape[0]) {
    for (auto& ring : facet) {
      for (Point& corner : ring) {
        if (corner.z == 0 && corner.x == 8000) corner.z = corner.y == 0 ? -900 : -300;
      }
    }
  }
  const Repaired result =
      repair(solids::solid_of(shape, solids::millimetres()), nullptr, everything());
  REQUIRE(result.outcome == Outcome::repaired);
  REQUIRE(result.holes.size() == 1);
  CHECK(result.holes[0].loops == 2);
  CHECK(result.holes[0].method == "delaunay");
  CHECK(result.holes[0].facets == 8);
  CHECK(result.holes[0].angle > 0);
  // Without islands there is no optimum; the canonical triangles of the ring do.
  RepairOptions options = everything();
  options.most_islands = 0;
  const Repaired in_plan = repair(solids::solid_of(shape, solids::millimetres()), nullptr, options);
  REQUIRE(in_plan.outcome == Outcome::repaired);
  CHECK(in_plan.holes[0].method == "plan");
}

TEST_CASE("lists of remedies are read, and others refused") {
  CHECK(remedies_of("rings").value() == std::vector{Remedy::rings});
  CHECK(remedies_of("fill,rings,fill").value() == std::vector{Remedy::rings, Remedy::fill});
  REQUIRE(remedies_of("all"));
  CHECK(remedies_of("all")->size() == 6);
  for (const char* list : {"", "glue", "rings,", ",rings", "rings fill", "All"}) {
    INFO(list);
    CHECK(!remedies_of(list));
  }
}

TEST_CASE("the summary of a repair counts what changed") {
  Shape shape = a_box();
  std::ranges::reverse(shape[0][1][0]);  // turned
  shape[0].erase(shape[0].begin());      // missing, 8 m by 8 m
  const Solid solid = solids::solid_of(shape, solids::millimetres());
  const Repaired result = repair(solid, nullptr, everything());
  REQUIRE(result.outcome == Outcome::repaired);
  const RepairSummary summary = summary_of(solid, result);
  CHECK(summary.facets_added == 1);
  CHECK(summary.facets_removed == 0);
  CHECK(summary.facets_turned == 1);
  CHECK(summary.area_added == Catch::Approx(64));
  REQUIRE(summary.volume);
  CHECK(*summary.volume == Catch::Approx(512));
  CHECK(summary.codes_before.contains(302));
  CHECK(summary.moves.vertices == 0);
  CHECK(summary_json(summary).find(R"("method":"facet")") != std::string::npos);
}

TEST_CASE("a remedy that was not asked for is not applied") {
  Shape shape = a_box();
  shape[0].pop_back();
  RepairOptions options = everything();
  options.remedies = RepairOptions().remedies;
  const Repaired result = repair(solids::solid_of(shape), nullptr, options);
  CHECK(result.outcome == Outcome::not_repaired);
  CHECK(!result.after);
  CHECK(result.before.verdict == Verdict::invalid);
}

/// A sphere of `count` parallels and twice as many meridians, in millimetres.
solids::Shell sphere_of(int count) {
  const double radius = 20'000;
  std::vector<Point> points{{0, 0, radius}, {0, 0, -radius}};
  const auto at = [&](int i, int j) {
    const double u = 3.14159265358979 * i / count;
    const double v = 3.14159265358979 * (j % (2 * count)) / count;
    return Point{std::round(radius * std::sin(u) * std::cos(v)),
                 std::round(radius * std::sin(u) * std::sin(v)), std::round(radius * std::cos(u))};
  };
  solids::Shell shell;
  for (int j = 0; j < 2 * count; ++j) {
    shell.push_back({{points[0], at(1, j), at(1, j + 1)}});
    shell.push_back({{points[1], at(count - 1, j + 1), at(count - 1, j)}});
    for (int i = 1; i + 1 < count; ++i) {
      shell.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      shell.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  return shell;
}

TEST_CASE("a repair ends within 50 ms of processor time after the wish to cancel") {
  // With a hole, a facet that looks inwards, and one twice.
  solids::Shell shell = sphere_of(24);
  shell.erase(shell.begin() + 100, shell.begin() + 120);
  std::reverse(shell[300][0].begin(), shell[300][0].end());
  shell.push_back(shell[700]);
  const Solid solid = solids::solid_of({shell}, solids::millimetres());
  bool has_ended = false;
  for (int polls = 1; !has_ended; polls += 1 + polls / 2) {
    RepairOptions options = everything(0.001);
    int asked = 0;
    std::clock_t wished = 0;
    options.certify.ladder.cancel = [&] {
      if (++asked < polls) return false;
      if (wished == 0) wished = std::clock();
      return true;
    };
    const Repaired result = repair(solid, nullptr, options);
    has_ended = wished == 0;
    if (has_ended) continue;
    CHECK(static_cast<double>(std::clock() - wished) < 0.05 * CLOCKS_PER_SEC);
    CHECK(result.outcome == Outcome::not_repaired);
  }
}

/// How often each kind of defect is made; WATERTIGHT_REPAIR_ROUNDS asks for more.
int rounds() {
  const char* text = std::getenv("WATERTIGHT_REPAIR_ROUNDS");
  return text == nullptr ? 5 : std::stoi(text);
}

TEST_CASE("defects of any kind are repaired or left alone, never made worse") {
  solids::Random random(7);
  std::size_t repaired = 0;
  for (int round = 0; round < rounds(); ++round) {
    for (const solids::DefectMaker make : solids::defect_makers()) {
      const solids::Defect defect = make(random);
      Shape shape = defect.shape;
      // Every other solid loses facets too.
      for (std::uint64_t gone = round % 2 == 0 ? 0 : 1 + random.below(4); gone > 0; --gone) {
        auto& facets = shape[random.below(shape.size())];
        if (facets.size() < 2) continue;
        facets.erase(facets.begin() + static_cast<std::ptrdiff_t>(random.below(facets.size())));
      }
      const Repaired result =
          repair(solids::solid_of(shape, solids::millimetres()), nullptr, everything(0.001));
      if (result.outcome != Outcome::repaired) continue;
      ++repaired;
      REQUIRE(result.after);
      CHECK(result.after->report.verdict == Verdict::valid);
      const Repaired again = repair(result.after->certified->solid.solid(), nullptr, everything());
      CHECK(again.outcome == Outcome::valid_as_read);
    }
  }
  CHECK(repaired > 20);
}

TEST_CASE("how a solid is written does not change what is repaired") {
  solids::Random random(3);
  for (int i = 0; i < 40; ++i) {
    Shape shape = solids::random_valid(random).shape;
    shape[0].erase(shape[0].begin() + static_cast<std::ptrdiff_t>(random.below(shape[0].size())));
    const Solid solid = solids::solid_of(shape, solids::millimetres());
    const Repaired one = repair(solid, nullptr, everything());
    const Repaired other = repair(solids::rewritten(solid, random).solid, nullptr, everything());
    REQUIRE(one.outcome == other.outcome);
    if (one.outcome != Outcome::repaired) continue;
    CHECK(hash_of(one.after->certified->solid.solid()) ==
          hash_of(other.after->certified->solid.solid()));
  }
}

}  // namespace
}  // namespace watertight::repair
