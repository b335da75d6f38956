// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/surfaces/checked_solid.h"

#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>

#include "validate/certify.h"

namespace watertight::test {

using surfaces::Vector3;
using surfaces::operator+;
using surfaces::operator*;

namespace {

Solid solid_of(const surfaces::TessellatedBoundary& result) {
  SolidArrays arrays = result.arrays;
  std::array<std::int64_t, 3> low{};
  for (const auto& position : result.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], position[axis]);
  }
  Lattice lattice;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lattice.step[axis] = {1, result.lattice_exponent};
    lattice.origin[axis] = {low[axis], low[axis] == 0 ? 0 : result.lattice_exponent};
    while (lattice.origin[axis].mantissa != 0 && lattice.origin[axis].mantissa % 10 == 0) {
      lattice.origin[axis] = {lattice.origin[axis].mantissa / 10,
                              lattice.origin[axis].exponent + 1};
    }
  }
  for (const auto& position : result.positions) {
    arrays.vertices.push_back({static_cast<double>(position[0] - low[0]),
                               static_cast<double>(position[1] - low[1]),
                               static_cast<double>(position[2] - low[2])});
  }
  auto solid = Solid::make(std::move(arrays), lattice, 0);
  REQUIRE(solid);
  return *std::move(solid);
}

}  // namespace

double farthest(const surfaces::TessellatedBoundary& result, const Distance& distance,
                Points points) {
  const int parts = static_cast<int>(points);
  const SolidArrays& arrays = result.arrays;
  const double step = std::pow(10.0, result.lattice_exponent);
  double most = 0;
  for (std::size_t ring = 0; ring + 1 < arrays.ring_offsets.size(); ++ring) {
    const Index first = arrays.ring_offsets[ring];
    if (arrays.ring_offsets[ring + 1] - first != 3) continue;  // a plane
    std::array<Vector3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        corners[k][axis] =
            step * static_cast<double>(result.positions[arrays.ring_vertices[first + k]][axis]);
      }
    }
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; i + j <= parts; ++j) {
        const double a = static_cast<double>(i) / parts;
        const double b = static_cast<double>(j) / parts;
        most = std::max(most, distance(corners[0] * a + corners[1] * b + corners[2] * (1 - a - b)));
      }
    }
  }
  return most;
}

surfaces::TessellatedBoundary check(const surfaces::BoundaryRepresentation& solid, double chord,
                                    const Wanted& wanted, const Distance& distance) {
  surfaces::TessellateOptions options;
  options.chord = chord;
  auto result = surfaces::tessellate(solid, options);
  if (!result) FAIL(result.error().message);
  for (const auto& face : result->left_out) {
    CAPTURE(face.name, face.reason);
    CHECK(face.reason.empty());
  }
  CHECK(result->measures.chord_error <= chord);
  if (distance) CHECK(farthest(*result, distance) <= chord);
  CertifyOptions certify_options;
  certify_options.proof = Proof::boundary;
  const auto report = certify(solid_of(*result), nullptr, certify_options).report;
  for (const auto& finding : report.findings) {
    CAPTURE(finding.code, finding.detail);
    CHECK(finding.severity != Severity::error);
  }
  REQUIRE(report.measures);
  CHECK(std::abs(report.measures->volume - wanted.volume) < wanted.area * chord);
  CHECK(std::abs(report.measures->area - wanted.area) < 0.1 * wanted.area);
  return *std::move(result);
}

}  // namespace watertight::test
