// SPDX-License-Identifier: GPL-3.0-or-later
#include <catch2/catch_test_macros.hpp>
#include <limits>

#include "delaunay/cdt_frames.h"

namespace watertight {
namespace {

delaunay::CdtJob sample_job() {
  delaunay::CdtJob job;
  job.constraints = delaunay::Constraints::triangles;
  job.complex.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1.5, 0}, {0, 0, -3e300}};
  job.complex.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}};
  job.complex.facet_of = {0, 1, 1};
  return job;
}

delaunay::CdtAnswer sample_answer() {
  delaunay::Tetrahedralization result;
  result.points = sample_job().complex.vertices;
  result.input_count = 4;
  result.points.push_back({0.25, 0.1, -1});
  result.tetrahedra = {{0, 1, 2, 4}, {0, 1, 4, 3}};
  result.constrained = {{{0, 1, 2}, 0}, {{0, 1, 3}, 1}};
  return {result, ""};
}

TEST_CASE("a CDT job comes back from its bytes") {
  const delaunay::CdtJob job = sample_job();
  const Result<delaunay::CdtJob> read = delaunay::read_job(delaunay::write_job(job));
  REQUIRE(read.has_value());
  CHECK(read->constraints == job.constraints);
  CHECK(read->complex.vertices == job.complex.vertices);
  CHECK(read->complex.triangles == job.complex.triangles);
  CHECK(read->complex.facet_of == job.complex.facet_of);
}

TEST_CASE("a CDT answer comes back from its bytes") {
  const delaunay::CdtAnswer answer = sample_answer();
  const Result<delaunay::CdtAnswer> read =
      delaunay::read_answer(delaunay::write_answer(answer), sample_job().complex.vertices, 2);
  REQUIRE(read.has_value());
  REQUIRE(read->tetrahedralization.has_value());
  CHECK(read->tetrahedralization->points == answer.tetrahedralization->points);
  CHECK(read->tetrahedralization->tetrahedra == answer.tetrahedralization->tetrahedra);
  CHECK(read->tetrahedralization->constrained == answer.tetrahedralization->constrained);

  const Result<delaunay::CdtAnswer> refused =
      delaunay::read_answer(delaunay::write_answer({{}, "too thin"}), {}, 2);
  REQUIRE(refused.has_value());
  CHECK_FALSE(refused->tetrahedralization.has_value());
  CHECK(refused->refusal == "too thin");
}

TEST_CASE("truncated and longer CDT frames are malformed") {
  const Bytes job = delaunay::write_job(sample_job());
  const Bytes answer = delaunay::write_answer(sample_answer());
  const std::vector<Point> vertices = sample_job().complex.vertices;
  for (std::size_t length = 0; length < job.size(); ++length) {
    CHECK_FALSE(delaunay::read_job(ByteView(job).first(length)).has_value());
  }
  for (std::size_t length = 0; length < answer.size(); ++length) {
    CHECK_FALSE(delaunay::read_answer(ByteView(answer).first(length), vertices, 2).has_value());
  }
  Bytes longer = job;
  longer.push_back(0);
  CHECK_FALSE(delaunay::read_job(longer).has_value());
  longer = answer;
  longer.push_back(0);
  CHECK_FALSE(delaunay::read_answer(longer, vertices, 2).has_value());
}

TEST_CASE("CDT frames with wrong indices, counts or coordinates are malformed") {
  const std::vector<Point> vertices = sample_job().complex.vertices;
  const auto refuses_job = [](auto change) {
    delaunay::CdtJob job = sample_job();
    change(job);
    return !delaunay::read_job(delaunay::write_job(job)).has_value();
  };
  CHECK(refuses_job([](delaunay::CdtJob& job) { job.complex.triangles[1][2] = 4; }));
  CHECK(refuses_job([](delaunay::CdtJob& job) { job.complex.facet_of = {0, 2, 2}; }));
  CHECK(refuses_job([](delaunay::CdtJob& job) { job.complex.facet_of = {1, 1, 1}; }));
  CHECK(refuses_job([](delaunay::CdtJob& job) { job.complex.facet_of = {0, 1, 0}; }));
  CHECK(refuses_job([](delaunay::CdtJob& job) {
    job.complex.vertices[0].x = std::numeric_limits<double>::quiet_NaN();
  }));
  const auto refuses_answer = [&](auto change) {
    delaunay::CdtAnswer answer = sample_answer();
    change(*answer.tetrahedralization);
    return !delaunay::read_answer(delaunay::write_answer(answer), vertices, 2).has_value();
  };
  CHECK(refuses_answer([](delaunay::Tetrahedralization& t) { t.tetrahedra[0][3] = 5; }));
  CHECK(refuses_answer([](delaunay::Tetrahedralization& t) { t.constrained[0].vertices[0] = 9; }));
  CHECK(refuses_answer([](delaunay::Tetrahedralization& t) { t.constrained[0].facet = 2; }));
  CHECK(refuses_answer([](delaunay::Tetrahedralization& t) {
    t.points[4].z = std::numeric_limits<double>::infinity();
  }));
  // A number of elements that the bytes cannot hold is refused before anything is allocated.
  Bytes bytes = delaunay::write_answer(sample_answer());
  bytes[9] = bytes[10] = bytes[11] = bytes[12] = 0xFF;
  CHECK_FALSE(delaunay::read_answer(bytes, vertices, 2).has_value());
}

TEST_CASE("CDT answers carry the engine's time, and impossible times are malformed") {
  const std::vector<Point> vertices = sample_job().complex.vertices;
  delaunay::CdtAnswer answer = sample_answer();
  answer.engine_seconds = 1.25;
  const Result<delaunay::CdtAnswer> read =
      delaunay::read_answer(delaunay::write_answer(answer), vertices, 2);
  REQUIRE(read.has_value());
  CHECK(read->engine_seconds == 1.25);
  const Result<delaunay::CdtAnswer> refusal =
      delaunay::read_answer(delaunay::write_answer({{}, "no", 0.5}), vertices, 2);
  REQUIRE(refusal.has_value());
  CHECK(refusal->engine_seconds == 0.5);
  CHECK(refusal->refusal == "no");
  for (const double wrong : {-1.0, 1e300, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
    answer.engine_seconds = wrong;
    CHECK_FALSE(delaunay::read_answer(delaunay::write_answer(answer), vertices, 2).has_value());
  }
}

}  // namespace
}  // namespace watertight
