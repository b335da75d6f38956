// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "delaunay/cdt_statistics.h"
#include "delaunay/ladder.h"
#include "unit/delaunay/sample_solids.h"

namespace watertight {
namespace {

using samples::Shape;

delaunay::EngineWorkers& ladder_engines() {
  static delaunay::EngineWorkers workers;
  return workers;
}

delaunay::LadderResult climb(const Shape& shape, const delaunay::LadderOptions& options = {}) {
  const Solid solid = samples::make_solid(shape);
  return delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), &ladder_engines(),
                                options);
}

delaunay::LadderOptions only(delaunay::Engine engine) {
  delaunay::LadderOptions options;
  options.engine = engine;
  if (engine == delaunay::Engine::cgal) options.first_rung = delaunay::Rung::patch;
  if (engine == delaunay::Engine::cgal) options.last_rung = delaunay::Rung::triangles_scaled;
  if (engine == delaunay::Engine::tetgen) options.first_rung = delaunay::Rung::tetgen;
  return options;
}

std::string attempts(const delaunay::LadderResult& result) {
  std::string text = "attempts:";
  for (const delaunay::RungAttempt& attempt : result.attempts) {
    text += " [" + std::string(delaunay::to_string(attempt.rung)) + ": " + attempt.outcome + "]";
  }
  return text;
}

/// Engines whose executables do not work.
delaunay::EngineWorkers broken_engines(const std::string& executable) {
  delaunay::EngineWorkers::Options options;
  options.cgal_executable = executable;
  options.tetgen_executable = executable;
  return delaunay::EngineWorkers(options);
}

Shape torus(int around, int across) {
  Shape shape;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * 3.14159265358979 * i / around;
      const double v = 2 * 3.14159265358979 * j / across;
      const double radius = 3000 + 1000 * std::cos(v);
      shape.vertices.push_back({std::round(radius * std::cos(u)), std::round(radius * std::sin(u)),
                                std::round(1000 * std::sin(v))});
    }
  }
  shape.shells.emplace_back();
  const auto at = [&](int i, int j) { return Index((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      shape.shells[0].push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
      shape.shells[0].push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
    }
  }
  return shape;
}

/// A house with x and y as in degrees and z as in metres, on one lattice of 1e-9.
Shape degrees_house() {
  Shape shape = samples::prism(
      {{0, 0}, {150'000, 9'000}, {140'000, 88'000}, {70'000, 60'000}, {-9'000, 91'000}}, 12.5e9);
  // One wall leans a little, so that the Delaunay tetrahedralization alone is not enough.
  shape.vertices[8].x += 7;
  return shape;
}

TEST_CASE("solids whose rings touch inside edges are proved with divided rings, by every engine") {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Solid solid = samples::make_solid(samples::shuffled(samples::pits_inside_edges(), seed));
    const tessellate::FacetTriangles facets = tessellate::triangulate_facets(solid);
    REQUIRE(facets.divided);
    CHECK(delaunay::climb_ladder(facets.divided_solid(solid), facets, nullptr, {}).certificate);
    for (const delaunay::Engine engine : {delaunay::Engine::cgal, delaunay::Engine::tetgen}) {
      const delaunay::LadderResult result = delaunay::climb_ladder(
          facets.divided_solid(solid), facets, &ladder_engines(), only(engine));
      INFO(attempts(result));
      CHECK(result.certificate);
    }
  }
}

TEST_CASE("rung 0 accepts boxes, cavities, tunnels and facets with holes without an engine") {
  Shape cavity = samples::box({0, 0, 0}, {90, 90, 90});
  samples::add_box(cavity, {30, 30, 30}, {60, 60, 60}, true);
  for (const Shape& shape : {samples::box({0, 0, 0}, {5, 6, 7}), cavity, samples::tunnelled_box(),
                             samples::warped_box(2)}) {
    const Solid solid = samples::make_solid(shape);
    const delaunay::LadderResult result =
        delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), nullptr, {});
    INFO(attempts(result));
    REQUIRE(result.certificate.has_value());
    CHECK(result.certificate->rung == delaunay::Rung::delaunay);
    CHECK(result.certificate->tetrahedralization.points.size() == solid.vertex_count());
    CHECK(result.attempts.size() == 1);
  }
}

/// Leaves out the rungs that need no engine.
delaunay::LadderOptions engines_only() {
  delaunay::LadderOptions options;
  options.first_rung = delaunay::Rung::patch;
  return options;
}

TEST_CASE("engines that are not there leave a solid undecided") {
  const Solid solid = samples::make_solid(samples::schoenhardt());
  const delaunay::LadderResult result =
      delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), nullptr, engines_only());
  CHECK_FALSE(result.certificate.has_value());
  CHECK(result.property == delaunay::CertificateRefusal::none);
  // The rung for triangles alone is left out: all facets are triangles.
  REQUIRE(result.attempts.size() == 3);
  for (const delaunay::RungAttempt& attempt : result.attempts) {
    CHECK(attempt.result == delaunay::RungOutcome::not_started);
    CHECK(attempt.outcome == "not-started: no engine executable");
  }
}

TEST_CASE("Schoenhardt's prism needs Steiner points and gets them on every rung") {
  REQUIRE(ladder_engines().cgal() != nullptr);
  const delaunay::LadderResult automatic = climb(samples::schoenhardt());
  INFO(attempts(automatic));
  REQUIRE(automatic.certificate.has_value());
  CHECK(automatic.certificate->rung == delaunay::Rung::recovered);
  CHECK(automatic.certificate->tetrahedralization.points.size() > 6);
  REQUIRE(automatic.attempts.size() == 2);
  CHECK(automatic.attempts[0].outcome.starts_with("refused: 4 of 8"));
  CHECK(automatic.attempts[0].result == delaunay::RungOutcome::not_delaunay);

  const delaunay::LadderResult patch = climb(samples::schoenhardt(), engines_only());
  INFO(attempts(patch));
  REQUIRE(patch.certificate.has_value());
  CHECK(patch.certificate->rung == delaunay::Rung::patch);
  CHECK(patch.certificate->tetrahedralization.points.size() > 6);
  CHECK(patch.certificate->largest_deviation < 1e-6);

  delaunay::LadderOptions strict = engines_only();
  strict.strict = true;
  const delaunay::LadderResult triangles = climb(samples::schoenhardt(), strict);
  INFO(attempts(triangles));
  REQUIRE(triangles.certificate.has_value());
  CHECK(triangles.certificate->rung == delaunay::Rung::triangles_scaled);
}

TEST_CASE("TetGen's result passes the same certificate") {
  if (ladder_engines().tetgen() == nullptr) SKIP("watertight-tetgen is not built");
  for (const Shape& shape : {samples::schoenhardt(), samples::box({0, 0, 0}, {5, 6, 7}),
                             samples::tunnelled_box(), samples::stairs(4)}) {
    const delaunay::LadderResult result = climb(shape, only(delaunay::Engine::tetgen));
    INFO(attempts(result));
    REQUIRE(result.certificate.has_value());
    CHECK(result.certificate->rung == delaunay::Rung::tetgen);
    CHECK(result.attempts.size() == 1);
  }
}

TEST_CASE("CGAL's result passes the certificate for every sample") {
  for (const Shape& shape :
       {samples::box({0, 0, 0}, {5, 6, 7}), samples::tunnelled_box(), samples::stairs(5),
        samples::warped_box(2), torus(12, 8), samples::schoenhardt()}) {
    const delaunay::LadderResult result = climb(shape, only(delaunay::Engine::cgal));
    INFO(attempts(result));
    REQUIRE(result.certificate.has_value());
    CHECK(result.certificate->rung == delaunay::Rung::patch);
  }
}

TEST_CASE("a torus is one connected interior") {
  const delaunay::LadderResult result = climb(torus(16, 10));
  INFO(attempts(result));
  CHECK(result.certificate.has_value());
}

TEST_CASE("two bodies are invalid on every rung") {
  Shape beside = samples::schoenhardt();
  samples::add_box_facets(beside, {3000, 0, 0}, {4000, 700, 800}, false);
  for (const delaunay::Engine engine :
       {delaunay::Engine::automatic, delaunay::Engine::cgal, delaunay::Engine::tetgen}) {
    if (engine == delaunay::Engine::tetgen && ladder_engines().tetgen() == nullptr) continue;
    const delaunay::LadderResult result = climb(beside, only(engine));
    INFO(attempts(result));
    CHECK_FALSE(result.certificate.has_value());
    CHECK(delaunay::to_string(result.property) == "interior-disconnected");
  }
}

TEST_CASE("a lattice of degrees and metres is decided on the scaled rung") {
  delaunay::LadderOptions options = only(delaunay::Engine::cgal);
  const delaunay::LadderResult result = climb(degrees_house(), options);
  INFO(attempts(result));
  REQUIRE(result.certificate.has_value());
  CHECK(result.certificate->rung == delaunay::Rung::patch_scaled);
  CHECK(result.attempts.size() == 1);
}

TEST_CASE("a strict ladder keeps the canonical triangles of a facet that is not planar") {
  const Solid solid = samples::make_solid(samples::warped_box(9));
  const tessellate::FacetTriangles canonical = tessellate::triangulate_facets(solid);
  delaunay::LadderOptions strict;
  strict.strict = true;
  const delaunay::LadderResult result =
      delaunay::climb_ladder(solid, canonical, &ladder_engines(), strict);
  INFO(attempts(result));
  REQUIRE(result.certificate.has_value());
  CHECK(result.certificate->refilled_facets.empty());
}

TEST_CASE("the ladder's answer does not depend on the numbering of the solid") {
  const auto sorted_points = [](const delaunay::LadderResult& result) {
    REQUIRE(result.certificate.has_value());
    std::vector<Point> points = result.certificate->tetrahedralization.points;
    std::sort(points.begin(), points.end());
    return points;
  };
  const auto expected = sorted_points(climb(samples::schoenhardt()));
  for (unsigned seed = 0; seed < 4; ++seed) {
    CHECK(sorted_points(climb(samples::shuffled(samples::schoenhardt(), seed))) == expected);
  }
}

TEST_CASE("an engine that crashes, answers nonsense or is missing leaves a solid undecided") {
  for (const std::string executable : {"/bin/false", "/bin/true", "/nonexistent/engine"}) {
    delaunay::EngineWorkers workers = broken_engines(executable);
    const Solid solid = samples::make_solid(samples::schoenhardt());
    const delaunay::LadderResult result = delaunay::climb_ladder(
        solid, tessellate::triangulate_facets(solid), &workers, engines_only());
    INFO(executable << " " << attempts(result));
    CHECK_FALSE(result.certificate.has_value());
    CHECK(result.property == delaunay::CertificateRefusal::none);
    REQUIRE(result.attempts.size() == 3);
    const bool is_missing = executable == "/nonexistent/engine";
    for (const delaunay::RungAttempt& attempt : result.attempts) {
      CHECK(attempt.result ==
            (is_missing ? delaunay::RungOutcome::not_started : delaunay::RungOutcome::crashed));
    }
  }
}

TEST_CASE("an engine that takes too long is stopped") {
  // The executable writes for ever; /bin/sleep without an operand would end at once, and /bin/cat
  // too, because its input is /dev/null.
  delaunay::EngineWorkers workers = broken_engines("/usr/bin/yes");
  delaunay::LadderOptions options = engines_only();
  options.seconds_per_rung = 0.2;
  options.last_rung = delaunay::Rung::patch;
  const Solid solid = samples::make_solid(samples::schoenhardt());
  const delaunay::LadderResult result =
      delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), &workers, options);
  INFO(attempts(result));
  REQUIRE(result.attempts.size() == 1);
  CHECK(result.attempts[0].outcome.starts_with("timed-out"));
  CHECK(result.attempts[0].seconds < 5);
}

TEST_CASE("rungs that would give an engine the same task again are left out") {
  delaunay::EngineWorkers workers = broken_engines("/bin/false");
  const auto rungs = [&](const Shape& shape, bool is_strict) {
    delaunay::LadderOptions options = only(delaunay::Engine::cgal);
    options.strict = is_strict;
    const Solid solid = samples::make_solid(shape);
    std::vector<delaunay::Rung> tried;
    for (const delaunay::RungAttempt& attempt :
         delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), &workers, options)
             .attempts) {
      tried.push_back(attempt.rung);
    }
    return tried;
  };
  using enum delaunay::Rung;
  // The extents have one size, so that scaling changes only the unit.
  const Shape cube = samples::box({0, 0, 0}, {64, 64, 64});
  CHECK(rungs(cube, false) == std::vector{patch, triangles_scaled});
  CHECK(rungs(cube, true) == std::vector{triangles_scaled});
  const Shape flat = samples::box({0, 0, 0}, {64, 64, 10});
  CHECK(rungs(flat, false) == std::vector{patch, patch_scaled, triangles_scaled});
  // All facets are triangles.
  CHECK(rungs(samples::schoenhardt(), false) == std::vector{patch, patch_scaled});
  CHECK(rungs(torus(4, 3), true) == std::vector{triangles_scaled});
}

TEST_CASE("all rungs together keep to the time for all") {
  delaunay::EngineWorkers workers =
      broken_engines("/usr/bin/yes");  // the executable writes for ever, and uses CPU time
  delaunay::LadderOptions options;
  options.seconds_in_all = 0.2;
  const Solid solid = samples::make_solid(samples::box({0, 0, 0}, {64, 64, 10}));
  options.first_rung = delaunay::Rung::patch;
  const delaunay::LadderResult result =
      delaunay::climb_ladder(solid, tessellate::triangulate_facets(solid), &workers, options);
  INFO(attempts(result));
  CHECK_FALSE(result.certificate.has_value());
  REQUIRE(result.attempts.size() == 4);
  double used = 0;
  for (const delaunay::RungAttempt& attempt : result.attempts) used += attempt.worker_seconds;
  CHECK(used < 2);
  CHECK(delaunay::default_ladder_seconds(0) == 20);
  CHECK(delaunay::default_ladder_seconds(1000) == 22.5);
}

TEST_CASE("statistics count solids by their result and attempts by class") {
  const Solid needs_steiner = samples::make_solid(samples::schoenhardt());
  const Solid simple = samples::make_solid(samples::box({0, 0, 0}, {5, 6, 7}));
  Shape two_bodies = samples::box({0, 0, 0}, {8, 8, 8});
  samples::add_box_facets(two_bodies, {20, 0, 0}, {30, 7, 8}, false);
  const Solid disconnected = samples::make_solid(two_bodies);
  delaunay::CdtStatistics statistics;
  for (const Solid* solid : {&needs_steiner, &simple, &disconnected}) {
    delaunay::CdtStatistics one;
    one.add(delaunay::climb_ladder(*solid, tessellate::triangulate_facets(*solid), nullptr, {})
                .attempts);
    statistics += one;
  }
  const tessellate::FacetTriangles facets = tessellate::triangulate_facets(needs_steiner);
  statistics.add(delaunay::climb_ladder(needs_steiner, facets, nullptr, engines_only()).attempts);
  statistics.add({});  // a result without attempts
  CHECK(statistics.solids == 4);
  CHECK(statistics.accepted == 2);
  CHECK(statistics.refuted == 1);
  CHECK(statistics.undecided == 1);
  CHECK(statistics.count(delaunay::Rung::delaunay, delaunay::RungOutcome::accepted) == 1);
  CHECK(statistics.count(delaunay::Rung::delaunay, delaunay::RungOutcome::not_delaunay) == 1);
  CHECK(statistics.count(delaunay::Rung::recovered, delaunay::RungOutcome::accepted) == 1);
  CHECK(statistics.count(delaunay::Rung::delaunay, delaunay::RungOutcome::refused_by_certificate) ==
        1);
  CHECK(statistics.count(delaunay::Rung::tetgen, delaunay::RungOutcome::not_started) == 1);
  CHECK(statistics.count(delaunay::Rung::none, delaunay::RungOutcome::accepted) == 0);
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < delaunay::kRungOutcomes; ++i) {
    names.insert(delaunay::to_string(static_cast<delaunay::RungOutcome>(i)));
  }
  CHECK(names.size() == delaunay::kRungOutcomes);
  CHECK_FALSE(names.contains(""));
}

TEST_CASE("a climb that is cancelled within the Delaunay rung reports the cancellation") {
  delaunay::LadderOptions options;
  int asked = 0;
  options.cancel = [&] { return ++asked > 1; };  // the first call comes before the rung
  const delaunay::LadderResult result = climb(torus(90, 60), options);
  CHECK_FALSE(result.certificate.has_value());
  REQUIRE(result.attempts.size() == 1);
  CHECK(result.attempts[0].result == delaunay::RungOutcome::cancelled);
  CHECK(asked == 2);
}

TEST_CASE("a cancelled climb stops") {
  delaunay::LadderOptions options;
  options.cancel = [] { return true; };
  const delaunay::LadderResult result = climb(samples::schoenhardt(), options);
  CHECK_FALSE(result.certificate.has_value());
  CHECK(result.attempts.size() <= 1);
}

TEST_CASE("the last rung is respected") {
  delaunay::LadderOptions options;
  options.last_rung = delaunay::Rung::delaunay;
  const delaunay::LadderResult result = climb(samples::schoenhardt(), options);
  CHECK_FALSE(result.certificate.has_value());
  CHECK(result.attempts.size() == 1);
}

}  // namespace
}  // namespace watertight
