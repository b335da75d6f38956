// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>

#include "geometry/canonical_form.h"
#include "repair/repair.h"
#include "repair/summary_json.h"
#include "tests/random.h"
#include "tests/solids/builders.h"

namespace watertight::repair {
namespace {

using Outcome = Repaired::Outcome;
using solids::Facet;
using solids::Shape;
using solids::Shell;

constexpr double kRadius = 1000;

/// A ball of triangles: circles of `around` points, `up` bands from pole to pole. `bumps` moves
/// points outwards by up to this share of the radius.
Shell ball(int around, int up, double bumps = 0, std::uint64_t seed = 1) {
  test::Random random(seed);
  std::vector<std::vector<Point>> circles;
  for (int i = 0; i <= up; ++i) {
    const double polar = std::numbers::pi * i / up;
    auto& circle = circles.emplace_back();
    for (int j = 0; j < around; ++j) {
      const double angle = 2 * std::numbers::pi * j / around;
      const double share = static_cast<double>(random.below(1000)) / 1000;
      const double radius = kRadius * (1 + (i > 0 && i < up ? bumps * share : 0));
      circle.push_back({std::round(radius * std::sin(polar) * std::cos(angle)),
                        std::round(radius * std::sin(polar) * std::sin(angle)),
                        std::round(radius * std::cos(polar))});
    }
  }
  Shell shell;
  for (int i = 0; i < up; ++i) {
    const auto& high = circles[static_cast<std::size_t>(i)];
    const auto& low = circles[static_cast<std::size_t>(i) + 1];
    for (std::size_t j = 0; j < high.size(); ++j) {
      const std::size_t next = (j + 1) % high.size();
      if (i > 0) shell.push_back({{high[j], low[j], high[next]}});
      if (i < up - 1) shell.push_back({{high[next], low[j], low[next]}});
    }
  }
  return shell;
}

/// Without the facets whose corners are all above a height.
Shell without_top(Shell shell, double height) {
  std::erase_if(shell, [&](const Facet& facet) {
    return std::ranges::all_of(facet[0], [&](const Point& p) { return p.z >= height; });
  });
  return shell;
}

RepairOptions smoothly() {
  RepairOptions options;
  options.remedies = {Remedy::smooth};
  options.certify.proof = Proof::boundary;
  return options;
}

const HoleFill& only_hole(const Repaired& repaired) {
  REQUIRE(repaired.holes.size() == 1);
  return repaired.holes[0];
}

/// The places of new vertices in world coordinates.
std::vector<std::array<double, 3>> new_places(const Solid& submitted, const Repaired& repaired) {
  const auto joined = on_submitted_vertices(submitted, *repaired.edits);
  REQUIRE(joined);
  std::vector<std::array<double, 3>> places;
  for (Index v = submitted.vertex_count(); v < joined->solid.vertex_count(); ++v)
    places.push_back(joined->solid.lattice().world(joined->solid.vertices()[v]));
  return places;
}

TEST_CASE("a ball without a cap gets the cap back, rounded") {
  const Solid open = solids::solid_of({without_top(ball(32, 24), 800)});
  const Repaired repaired = repair(open, nullptr, smoothly());
  REQUIRE(repaired.outcome == Outcome::repaired);
  CHECK(repaired.remedies == std::vector{Remedy::smooth});
  const HoleFill& hole = only_hole(repaired);
  CHECK(hole.method == "smooth");
  REQUIRE(hole.smooth);
  CHECK(hole.smooth_refusal.empty());
  CHECK(hole.smooth->vertices > 20);
  CHECK(hole.smooth->value_jump <= 1e-9 * kRadius);
  CHECK(hole.smooth->normal_jump <= 1e-6);
  CHECK(hole.smooth->border_distance < 0.01 * kRadius);
  CHECK(hole.smooth->largest_turn < 25);
  CHECK(hole.smooth->stretch >= 1);
  CHECK(hole.smooth->largest_curvature > 0);
  const auto places = new_places(open, repaired);
  REQUIRE(places.size() == hole.smooth->vertices);
  double largest = 0;
  for (const auto& [x, y, z] : places)
    largest = std::max(largest, std::abs(std::sqrt(x * x + y * y + z * z) / kRadius - 1));
  CHECK(largest < 0.04);  // the flat filling is 0.2 off
}

TEST_CASE("old vertices keep their exact places, and the lattice gets finer for new ones") {
  // Steps of a metre are coarse for edges of some 100 of them in a chord of 1 millimetre.
  const Solid open = solids::solid_of({without_top(ball(24, 16), 700)});
  RepairOptions options = smoothly();
  options.smooth.chord_metres = 1;
  const Repaired repaired = repair(open, nullptr, options);
  REQUIRE(repaired.outcome == Outcome::repaired);
  REQUIRE(only_hole(repaired).smooth);
  const auto joined = on_submitted_vertices(open, *repaired.edits);
  REQUIRE(joined);
  const Lattice& lattice = joined->solid.lattice();
  CHECK(lattice.scale(0) <= 0.1);
  for (Index v = 0; v < open.vertex_count(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(lattice.world_text(joined->solid.vertices()[v][axis], axis) ==
            open.lattice().world_text(open.vertices()[v][axis], axis));
    }
  }
  // No vertex was put on the border: each old facet is one of the new solid.
  std::set<Index> sources(joined->facet_source.begin(), joined->facet_source.end());
  CHECK(sources.size() == open.facet_count() + 1);
}

TEST_CASE("a patch may have vertices much closer than its border has, and does not cross it") {
  // The surface bends over each of the few edges of the border, which stay straight.
  const Shell shell = without_top(ball(9, 8, 0.2, 3), 300);
  const Solid open = solids::solid_of({shell}, solids::millimetres());
  RepairOptions options = smoothly();
  options.smooth.collar.crease_degrees = 90;
  options.smooth.chord_metres = kRadius * 1e-3 / 4000;
  const Repaired repaired = repair(open, nullptr, options);
  REQUIRE(repaired.outcome == Outcome::repaired);
  const HoleFill& hole = only_hole(repaired);
  CHECK(hole.smooth_refusal.empty());
  REQUIRE(hole.smooth);
  CHECK(hole.smooth->vertices > 1000);
}

TEST_CASE("a hole in a plane gets a plane") {
  // A slab of squares as triangles, with a hole of 4 x 4 squares in its upper side.
  Shell slab;
  constexpr int kSize = 12;
  const auto at = [](int x, int y, double z) { return Point{100.0 * x, 100.0 * y, z}; };
  for (int x = 0; x < kSize; ++x) {
    for (int y = 0; y < kSize; ++y) {
      slab.push_back({{at(x, y, 0), at(x, y + 1, 0), at(x + 1, y + 1, 0)}});
      slab.push_back({{at(x, y, 0), at(x + 1, y + 1, 0), at(x + 1, y, 0)}});
      if (x >= 4 && x < 8 && y >= 4 && y < 8) continue;
      slab.push_back({{at(x, y, 500), at(x + 1, y, 500), at(x + 1, y + 1, 500)}});
      slab.push_back({{at(x, y, 500), at(x + 1, y + 1, 500), at(x, y + 1, 500)}});
    }
  }
  for (int i = 0; i < kSize; ++i) {
    slab.push_back({{at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 500), at(i, 0, 500)}});
    slab.push_back(
        {{at(kSize, i, 0), at(kSize, i + 1, 0), at(kSize, i + 1, 500), at(kSize, i, 500)}});
    slab.push_back(
        {{at(i + 1, kSize, 0), at(i, kSize, 0), at(i, kSize, 500), at(i + 1, kSize, 500)}});
    slab.push_back({{at(0, i + 1, 0), at(0, i, 0), at(0, i, 500), at(0, i + 1, 500)}});
  }
  const Solid open = solids::solid_of({slab});
  const Repaired repaired = repair(open, nullptr, smoothly());
  REQUIRE(repaired.outcome == Outcome::repaired);
  const HoleFill& hole = only_hole(repaired);
  REQUIRE(hole.smooth);
  CHECK(hole.smooth->energy < 1e-9);
  CHECK(hole.smooth->stretch < 1 + 1e-9);
  CHECK(hole.smooth->largest_turn < 1e-4);
  for (const auto& place : new_places(open, repaired)) CHECK(place[2] == 500);
}

TEST_CASE("a hole with an island gets one patch around it") {
  // A slab whose upper side has a ring of squares missing.
  Shell slab;
  constexpr int kSize = 16;
  const auto at = [](int x, int y, double z) { return Point{100.0 * x, 100.0 * y, z}; };
  const auto is_between = [](int value, int low, int high) { return value >= low && value < high; };
  for (int x = 0; x < kSize; ++x) {
    for (int y = 0; y < kSize; ++y) {
      slab.push_back({{at(x, y, 0), at(x, y + 1, 0), at(x + 1, y + 1, 0), at(x + 1, y, 0)}});
      const bool is_inside = is_between(x, 4, 12) && is_between(y, 4, 12);
      const bool is_island = is_between(x, 6, 10) && is_between(y, 6, 10);
      if (is_inside && !is_island) continue;
      slab.push_back({{at(x, y, 500), at(x + 1, y, 500), at(x + 1, y + 1, 500)}});
      slab.push_back({{at(x, y, 500), at(x + 1, y + 1, 500), at(x, y + 1, 500)}});
    }
  }
  for (int i = 0; i < kSize; ++i) {
    slab.push_back({{at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 500), at(i, 0, 500)}});
    slab.push_back(
        {{at(kSize, i, 0), at(kSize, i + 1, 0), at(kSize, i + 1, 500), at(kSize, i, 500)}});
    slab.push_back(
        {{at(i + 1, kSize, 0), at(i, kSize, 0), at(i, kSize, 500), at(i + 1, kSize, 500)}});
    slab.push_back({{at(0, i + 1, 0), at(0, i, 0), at(0, i, 500), at(0, i + 1, 500)}});
  }
  const Repaired repaired = repair(solids::solid_of({slab}), nullptr, smoothly());
  REQUIRE(repaired.outcome == Outcome::repaired);
  CHECK(only_hole(repaired).loops == 2);
  CHECK(only_hole(repaired).method == "smooth");
}

TEST_CASE("an edge that is too sharp gets the flat filling, with the reason") {
  // A tall prism over a triangle: its walls turn by 120 degrees.
  Shell prism = solids::prism({{0, 0, 0}, {1000, 0, 0}, {500, 866, 0}}, 0, 2000);
  prism = without_top(std::move(prism), 2000);
  const Repaired repaired = repair(solids::solid_of({prism}), nullptr, smoothly());
  REQUIRE(repaired.outcome == Outcome::repaired);
  CHECK(repaired.remedies == std::vector{Remedy::fill});
  CHECK(only_hole(repaired).method == "facet");
  CHECK(only_hole(repaired).smooth_refusal == "too_sharp");
  CHECK(only_hole(repaired).smooth_detail.find("of the border") != std::string::npos);
}

TEST_CASE("a hole around the whole solid lies in no plane") {
  // A flat bipyramid of which one facet is missing: the collar is all the rest.
  Shell solid = solids::bipyramid({{1000, 0, 0}, {0, 1000, 0}, {-1000, 0, 0}, {0, -1000, 0}},
                                  {0, 0, 700}, {0, 0, -700});
  solid.pop_back();
  const Repaired repaired = repair(solids::solid_of({solid}), nullptr, smoothly());
  REQUIRE(repaired.outcome == Outcome::repaired);
  CHECK(only_hole(repaired).smooth_refusal == "not_flattenable");
  CHECK(only_hole(repaired).facets == 1);
}

TEST_CASE("limits of a patch give the flat filling, with the reason") {
  const Solid open = solids::solid_of({without_top(ball(32, 24), 800)});
  RepairOptions options = smoothly();
  options.smooth.most_triangles = 5;
  CHECK(only_hole(repair(open, nullptr, options)).smooth_refusal == "too_large");
  options = smoothly();
  options.smooth.most_vertices = 5;
  CHECK(only_hole(repair(open, nullptr, options)).smooth_refusal == "too_large");
  options = smoothly();
  options.smooth.collar.most_triangles = 5;
  CHECK(only_hole(repair(open, nullptr, options)).smooth_refusal == "too_large");
  options = smoothly();
  options.smooth.most_triangles = 250;  // collar and border need 200: a coarser domain
  CHECK(only_hole(repair(open, nullptr, options)).method == "smooth");
  options = smoothly();
  options.smooth.density = 1e9;  // no new vertex in the domain
  const Repaired coarse = repair(open, nullptr, options);
  CHECK(coarse.outcome == Outcome::repaired);
  CHECK(only_hole(coarse).smooth_detail == "");
  CHECK(only_hole(coarse).method == "smooth");
}

TEST_CASE("a patch that would meet a facet gives way to the flat filling; other holes go on") {
  Shell shell = without_top(ball(32, 24), 800);
  std::erase_if(shell, [&](const Facet& facet) {
    return std::ranges::all_of(facet[0], [](const Point& p) { return p.z <= -800; });
  });
  // A needle above the flat filling at the top, through the rounded one.
  const Shell needle =
      solids::tetrahedron({0, 0, 900}, {20, 0, 1200}, {0, 20, 1200}, {30, 30, 1200});
  shell.insert(shell.end(), needle.begin(), needle.end());
  EditedSolid solid = edited(solids::solid_of({shell}));
  FillHolesOptions options;
  options.smooth.emplace();
  const auto holes = fill_holes(solid, options);
  REQUIRE(holes.size() == 2);
  CHECK(std::ranges::count(holes, "patch_crosses", &HoleFill::smooth_refusal) == 1);
  CHECK(std::ranges::count(holes, "smooth", &HoleFill::method) == 1);
}

TEST_CASE("a border that passes a vertex twice or has no loops gets no smooth patch") {
  // Two holes that touch in a vertex.
  Shell shell = ball(32, 24);
  const Point meeting = shell[100][0][0];
  std::vector<std::size_t> around;
  for (std::size_t i = 0; i < shell.size(); ++i) {
    if (std::ranges::find(shell[i][0], meeting) != shell[i][0].end()) around.push_back(i);
  }
  REQUIRE(around.size() == 6);
  const Facet first = shell[around[0]];
  const auto apart = std::ranges::find_if(around, [&](std::size_t i) {
    return std::ranges::count_if(shell[i][0], [&](const Point& p) {
             return std::ranges::find(first[0], p) != first[0].end();
           }) == 1;
  });
  REQUIRE(apart != around.end());
  shell.erase(shell.begin() + static_cast<std::ptrdiff_t>(*apart));
  shell.erase(shell.begin() + static_cast<std::ptrdiff_t>(around[0]));
  const Repaired repaired = repair(solids::solid_of({shell}), nullptr, smoothly());
  REQUIRE(repaired.outcome == Outcome::repaired);
  REQUIRE(repaired.holes.size() == 2);
  for (const HoleFill& hole : repaired.holes) CHECK(hole.facets > 0);
}

TEST_CASE("a cancelled repair leaves the holes open") {
  RepairOptions options = smoothly();
  options.certify.ladder.cancel = [] { return true; };
  const Repaired repaired =
      repair(solids::solid_of({without_top(ball(32, 24), 800)}), nullptr, options);
  CHECK(repaired.outcome == Outcome::not_repaired);
  CHECK(repaired.is_stopped);
}

TEST_CASE("the same hole gets the same patch, and its surface as JSON where it is asked for") {
  const Solid open = solids::solid_of({without_top(ball(32, 24), 800)});
  RepairOptions options = smoothly();
  options.smooth.keeps_surface = true;
  const Repaired once = repair(open, nullptr, options);
  const Repaired again = repair(open, nullptr, options);
  CHECK(once.edits->vertices == again.edits->vertices);
  CHECK(once.edits->shells == again.edits->shells);
  CHECK(only_hole(once).spline == only_hole(again).spline);
  const auto json = nlohmann::json::parse(only_hole(once).spline);
  CHECK(json["degree"] == 2);
  CHECK(json["triangles"].size() * 6 > only_hole(once).smooth->unknowns);
  const auto summary = nlohmann::json::parse(summary_json(summary_of(open, once)));
  CHECK(summary["holes"][0]["method"] == "smooth");
  CHECK(summary["holes"][0]["smooth"]["vertices"] == only_hole(once).smooth->vertices);
}

TEST_CASE("'all' leaves smooth out, and its name asks for it") {
  REQUIRE(remedies_of("all"));
  CHECK(std::ranges::count(*remedies_of("all"), Remedy::smooth) == 0);
  CHECK(remedies_of("smooth").value() == std::vector{Remedy::smooth});
  CHECK(remedies_of("all,smooth")->size() == 7);
}

/// WATERTIGHT_SMOOTH_ROUNDS asks for more.
std::uint64_t smooth_rounds() {
  const char* text = std::getenv("WATERTIGHT_SMOOTH_ROUNDS");
  return text == nullptr ? 40 : std::strtoull(text, nullptr, 10);
}

TEST_CASE("random holes get a patch or a filling with the reason, and no NaN") {
  std::size_t patched = 0;
  for (std::uint64_t seed = 1; seed <= smooth_rounds(); ++seed) {
    INFO(seed);
    test::Random random(seed);
    const Shell whole =
        ball(8 + static_cast<int>(random.below(16)), 5 + static_cast<int>(random.below(12)),
             0.05 * static_cast<double>(random.below(4)), seed);
    // Facets near a random one go.
    const Point center = whole[random.below(whole.size())][0][0];
    const double reach = 200 + static_cast<double>(random.below(900));
    Shell shell;
    for (const Facet& facet : whole) {
      const Point& p = facet[0][0];
      const double x = p.x - center.x;
      const double y = p.y - center.y;
      const double z = p.z - center.z;
      if (x * x + y * y + z * z > reach * reach) shell.push_back(facet);
    }
    if (shell.size() < 4 || shell.size() == whole.size()) continue;
    EditedSolid solid = edited(solids::solid_of({shell}));
    FillHolesOptions options;
    options.smooth.emplace();
    for (const HoleFill& hole : fill_holes(solid, options)) {
      const bool has_reason = !hole.smooth_refusal.empty() && !hole.smooth_detail.empty();
      CHECK(hole.smooth.has_value() != has_reason);
      if (!hole.smooth) continue;
      ++patched;
      for (const double measure :
           {hole.smooth->energy, hole.smooth->condition, hole.smooth->stretch,
            hole.smooth->value_jump, hole.smooth->normal_jump, hole.smooth->border_distance,
            hole.smooth->least_curvature, hole.smooth->largest_curvature, hole.smooth->mean_turn,
            hole.smooth->largest_turn}) {
        CHECK(std::isfinite(measure));
      }
    }
    const Box box = geometry::box_of(solid.vertices);
    CHECK(std::isfinite(box.max.x - box.min.x));
  }
  CHECK(patched > smooth_rounds() / 4);
}

}  // namespace
}  // namespace watertight::repair
