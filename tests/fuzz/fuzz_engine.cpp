// SPDX-License-Identifier: GPL-3.0-or-later
//
// libFuzzer harness of the tetrahedralization in this process: solids that are hard to
// tetrahedralize, with moved vertices. Input: family (1 byte), seed (4), then for each move the
// number of a vertex (1), an axis (1) and a distance (1, signed, shifted by the upper bits of the
// axis). The certificate must not refuse what rung 0 or 1 made, except for a property of the solid,
// and both halves of rung 1 must keep their promises, whatever the exact tests say of the other.
#include <algorithm>
#include <iterator>

#include "base/bytes.h"
#include "delaunay/constrained/constrained_delaunay.h"
#include "fuzz_formats.h"
#include "tessellate/facets.h"
#include "tests/solids/hard_solids.h"
#include "validate/certify.h"

namespace {

using namespace watertight;

/// Larger solids take too long under sanitizers.
constexpr std::size_t kMaxVertices = 160;

Solid moved(const Solid& solid, ByteReader& reader) {
  SolidArrays arrays = solid.arrays();
  while (reader.remaining() >= 3) {
    Point& p = arrays.vertices[reader.u8() % arrays.vertices.size()];
    const std::uint8_t axis = reader.u8();
    const auto distance = static_cast<std::int8_t>(reader.u8());
    p[axis % 3] += static_cast<double>(distance) * static_cast<double>(1U << (axis / 16));
  }
  Result<Solid> result = Solid::make(std::move(arrays), solid.lattice(), solid.srid());
  return result ? *std::move(result) : solid;
}

bool is_of_ours(const delaunay::RungAttempt& attempt) {
  return attempt.rung == delaunay::Rung::delaunay || attempt.rung == delaunay::Rung::recovered;
}

/// The second half of rung 1 alone, which the first half spares most solids.
void check_constrained(const Solid& solid) {
  const auto triangles = tessellate::triangulate_facets(solid);
  const auto made = delaunay::constrained_delaunay(solid, triangles, {}, {});
  if (!made) return;
  fuzz::require(made->triangles.size() == made->facet_of.size());
  fuzz::require(
      std::ranges::equal(std::span(made->points).first(solid.vertex_count()), solid.vertices()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 5) return 0;
  ByteReader reader(ByteView(data, size));
  const auto families = solids::hard_families();
  const solids::HardFamily& family = families[reader.u8() % families.size()];
  const Solid given = solids::hard_solid(family, reader.u32());
  if (given.vertex_count() > kMaxVertices) return 0;
  const Solid solid = moved(given, reader);
  CertifyOptions options;
  options.tolerances.planarity_metres = 1e30;
  options.tolerances.planarity_degrees = 360;
  const Inspection inspection = certify(solid, nullptr, options);
  const Report& report = inspection.report;
  fuzz::require(inspection.certified.has_value() == (report.verdict == Verdict::valid));
  if (report.attempts.empty()) return 0;  // the exact tests refuse it
  for (const delaunay::RungAttempt& attempt : report.attempts) {
    fuzz::require(!is_of_ours(attempt) ||
                  attempt.result != delaunay::RungOutcome::refused_by_certificate);
  }
  options.proof = Proof::boundary;
  fuzz::require(certify(solid, nullptr, options).report.verdict != Verdict::invalid ||
                report.verdict != Verdict::valid);
  check_constrained(solid);
  return 0;
}
