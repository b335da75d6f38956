// SPDX-License-Identifier: GPL-3.0-or-later
//
// The functions of the bridge that move and cut solids. What they make is judged as a solid that
// comes in.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
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
#include "tessellate/clip_z.h"

namespace watertight::sql {
namespace {

using tessellate::FacetRest;

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

/// Answers with the value of a solid that was made of a decoded one, judged by the rules of that.
void judge_made(const wt_job& job, const Acceptance& acceptance, const Solid& made,
                wt_reply* reply) {
  wt_rule_choice rules = wt_default_rules();
  rules.planarity = acceptance.tolerances.planarity_metres;
  rules.planarity_angle = acceptance.tolerances.planarity_degrees;
  rules.is_boundary_enough = acceptance.proof == Proof::boundary;
  const Bytes ewkb = formats::write_ewkb(made);
  wt_job again = job;
  again.bytes = ewkb.data();
  again.size = ewkb.size();
  again.rules = &rules;
  wt_bridge_solid(&again, reply);
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
  judge_made(job, decoded->info.acceptance, *moved, reply);
}

/// A reply that is cleared at the end of its scope.
struct OwnReply {
  OwnReply() = default;
  OwnReply(const OwnReply&) = delete;
  OwnReply& operator=(const OwnReply&) = delete;
  ~OwnReply() { wt_reply_clear(&reply); }
  wt_reply reply{};
};

/// The parts of a solid between two heights.
Result<std::vector<Solid>> clipped(const Solid& solid, double low, double high, FacetRest rest) {
  auto below = tessellate::clip_z(solid, high, tessellate::HeightSide::below, rest);
  if (!below) return below;
  std::vector<Solid> parts;
  for (const Solid& part : *below) {
    auto above = tessellate::clip_z(part, low, tessellate::HeightSide::above, rest);
    if (!above) return above;
    std::ranges::move(*above, std::back_inserter(parts));
  }
  return parts;
}

/// Answers with the values of parts; the reply fails as that of the first part that is not
/// accepted.
void values_into(const wt_job& job, const CallLimits& call, const Acceptance& acceptance,
                 const std::vector<Solid>& parts, wt_reply* reply) {
  Bytes values;
  for (const Solid& part : parts) {
    OwnReply judged;
    judge_made(job, acceptance, part, &judged.reply);
    if (judged.reply.failure.sqlstate[0] != '\0') return std::swap(*reply, judged.reply);
    const auto size = static_cast<std::uint32_t>(judged.reply.size);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&size);
    values.insert(values.end(), bytes, bytes + sizeof size);
    values.insert(values.end(), judged.reply.bytes, judged.reply.bytes + size);
    if (const Status in_time = call.check(); !in_time) return fail(reply, in_time.error());
  }
  answer(reply, values);
}

void clip_into(const wt_job& job, double low, double high, wt_reply* reply) {
  const CallLimits call(job);
  const Result<Decoded> decoded = decode(bytes_of(job), call.of_input());
  if (!decoded) return fail(reply, call.of_reading(decoded.error()));
  for (const FacetRest rest : {FacetRest::whole, FacetRest::triangles}) {
    wt_reply_clear(reply);
    const auto parts = clipped(decoded->solid, low, high, rest);
    if (!parts) {
      fail(reply, "22023", parts.error().message);
      continue;
    }
    values_into(job, call, decoded->info.acceptance, *parts, reply);
    if (!reply->failure.is_invalid) return;
  }
  if (!reply->failure.is_invalid) return;
  const std::string detail = reply->failure.detail == nullptr ? "" : reply->failure.detail;
  fail(reply, "22023",
       "a part between the heights is not valid, as where it touches itself; another height may do",
       detail);
}

}  // namespace
}  // namespace watertight::sql

using watertight::sql::guarded;

void wt_bridge_translate(const wt_job* job, const double way[3], wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::translate_into(*job, way, reply); });
}

void wt_bridge_clip_z(const wt_job* job, double low, double high, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::clip_into(*job, low, high, reply); });
}

void wt_bridge_transform(const wt_job* job, uint32_t srid, wt_reply* reply) noexcept {
  guarded(reply, [=] { watertight::sql::transform_into(*job, srid, reply); });
}
