// SPDX-License-Identifier: GPL-3.0-or-later
//
// The functions of the bridge that move solids. What they make is judged as a solid that comes in.
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "codec/blob.h"
#include "codec/page.h"
#include "formats/ewkb.h"
#include "geometry/crs/crs.h"
#include "geometry/lattice/moved_lattice.h"
#include "projection/projection.h"
#include "sql/judge.h"
#include "sql/reply.h"

namespace watertight::sql {
namespace {

// The decimals that coordinates of another reference system are rounded to: 0.1 mm in either case.
constexpr int kDecimalsOfMetres = 4;
constexpr int kDecimalsOfAngles = 9;

void translate_into(const wt_job& job, const double* way, wt_reply* reply) {
  const CallLimits call(job);
  Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  const Solid& solid = decoded->solid;
  const auto lattice = geometry::moved_lattice(solid.lattice(), {way[0], way[1], way[2]});
  if (!lattice) return fail(reply, lattice.error());
  auto moved = Solid::make(solid.arrays(), *lattice, solid.srid());
  if (!moved) return fail(reply, moved.error());
  decoded->solid = *std::move(moved);
  const Result<Bytes> blob = codec::blob_of(*decoded);
  if (!blob) return fail(reply, blob.error());
  wt_job again = job;
  again.bytes = blob->data();
  again.size = blob->size();
  wt_bridge_solid(&again, reply);
}

/// The solid in another reference system: x and y by PROJ, rounded to decimals, z as it is.
Result<Solid> in_system(const Solid& solid, std::uint32_t srid) {
  std::vector<projection::Position> positions;
  for (const Point& vertex : solid.vertices()) positions.push_back(solid.lattice().world(vertex));
  const std::vector<projection::Position> before = positions;
  if (const Status done = projection::transform_between(solid.srid(), srid, positions); !done) {
    return done.error();
  }
  const int decimals = geometry::largest_angle(srid) > 0 ? kDecimalsOfAngles : kDecimalsOfMetres;
  const double steps = std::pow(10.0, decimals);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      positions[i][axis] = std::round(positions[i][axis] * steps) / steps;
    }
    positions[i][2] = before[i][2];
  }
  auto lattice = geometry::lattice_of_doubles(positions);
  if (!lattice) return lattice.error();
  SolidArrays arrays = solid.arrays();
  arrays.vertices = std::move(lattice->points);
  return Solid::make(std::move(arrays), lattice->lattice, srid);
}

void transform_into(const wt_job& job, std::uint32_t srid, wt_reply* reply) {
  const CallLimits call(job);
  const Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  if (decoded->solid.srid() == 0) {
    return fail(reply, "22023", "the solid states no reference system",
                "wt_transform() needs one to start from.");
  }
  const Result<Solid> moved = in_system(decoded->solid, srid);
  if (!moved) return fail(reply, moved.error());
  const Acceptance& acceptance = decoded->info.acceptance;
  wt_rule_choice rules = wt_default_rules();
  rules.planarity = acceptance.tolerances.planarity_metres;
  rules.planarity_angle = acceptance.tolerances.planarity_degrees;
  rules.is_boundary_enough = acceptance.proof == Proof::boundary;
  const Bytes ewkb = formats::write_ewkb(*moved);
  wt_job again = job;
  again.bytes = ewkb.data();
  again.size = ewkb.size();
  again.rules = &rules;
  wt_bridge_solid(&again, reply);
}

}  // namespace
}  // namespace watertight::sql

using watertight::sql::guarded;

void wt_bridge_translate(const wt_job* job, const double way[3], wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::translate_into(*job, way, reply); });
}

void wt_bridge_transform(const wt_job* job, uint32_t srid, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::transform_into(*job, srid, reply); });
}
